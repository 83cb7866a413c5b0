# SPDX-License-Identifier: LGPL-2.1-or-later
"""Checked sparse solves: each residual is measured, and a failure moves on to the next solver."""

import os
from collections import Counter
from dataclasses import dataclass, field
from threading import Lock
from time import perf_counter
from typing import Literal

import numpy as np
from scipy.sparse import csr_matrix

from quietblade.errors import SolverError
from quietblade.linalg import pardiso
from quietblade.linalg.pattern import asymmetry, canonical, same_pattern
from quietblade.linalg.protocol import (
    Backend,
    BackendAnalysis,
    BackendFactor,
    BackendFailed,
    Inertia,
    SparseMatrix,
)
from quietblade.linalg.refinement import System, refined
from quietblade.linalg.report import Level, Log, SolverReport
from quietblade.linalg.rslab import Rslab
from quietblade.linalg.superlu import SuperLu
from quietblade.typing import AnyArray, FloatArray

SolverName = Literal["auto", "rslab", "mkl-pardiso", "superlu"]
Precision = Literal["mixed", "double"]

_STEPS = {True: 16, False: 5}  # substitutions with a factor in single, in double precision
_LONGEST_REST = 16  # factorisations for which a level that keeps failing is not tried


@dataclass(frozen=True)
class SolverChain:
    """Sparse direct solvers in the order in which they are tried."""

    name: str
    levels: tuple[Level, ...]
    symmetric: bool
    tolerance: float
    _log: Log = field(default_factory=Log, repr=False, compare=False)
    _last: "list[ChainAnalysis]" = field(default_factory=list, repr=False, compare=False)
    _lock: Lock = field(default_factory=Lock, repr=False, compare=False)

    def analyse(self, A: SparseMatrix) -> "ChainAnalysis":
        """Take a pattern; each program analyses it when it is first needed.

        Parameters
        ----------
        A : sparse matrix (n, n)
            Both triangles, also if symmetric; its values are looked at to confirm the symmetry.

        Raises
        ------
        SolverError
            If the matrix is not square, not finite, or not symmetric where that was promised.
        """
        A = canonical(A)
        if self.symmetric and (skew := asymmetry(A)) > 1e-8:
            raise SolverError(
                f"linear solver: the matrix is not symmetric (largest |A - A^T| is {skew:.1e} of "
                "the largest entry); use make_solver(symmetric=False)"
            )
        return ChainAnalysis(self, A)

    def factor(self, A: SparseMatrix) -> "ChainFactorization":
        """Factor ``A``; the last analysis is used again if its pattern is the same."""
        A = canonical(A)
        with self._lock:
            last = self._last[0] if self._last else None
            if last is None or not last.fits(A):
                last = self.analyse(A)
                self._last[:] = [last]
        return last.factor(A)

    def report(self) -> SolverReport:
        """Say what was used so far, and every change of solver."""
        return self._log.report()


class ChainAnalysis:
    """One pattern, analysed by those programs of a chain that were needed."""

    def __init__(self, chain: SolverChain, A: csr_matrix) -> None:
        self.chain = chain
        self._indptr, self._indices = A.indptr.copy(), A.indices.copy()
        self._analyses: dict[str, BackendAnalysis] = {}
        self._failures: Counter[Level] = Counter()  # in a row
        self._resting: Counter[Level] = Counter()  # factorisations still to be skipped
        self._lock, self._analysing = Lock(), Lock()

    def fits(self, A: csr_matrix) -> bool:
        """Whether a canonical matrix has this pattern."""
        return same_pattern(A, self._indptr, self._indices)

    def factor(self, A: SparseMatrix) -> "ChainFactorization":
        """Factor new values on the analysed pattern.

        Raises
        ------
        SolverError
            If the pattern is another one, or no solver of the chain can factor the matrix.
        """
        A = canonical(A)
        if not self.fits(A):
            raise SolverError(
                f"linear solver: a matrix of {A.shape[0]} unknowns and {A.nnz} entries was given "
                f"to the analysis of another pattern ({self._indptr.size - 1} unknowns, "
                f"{self._indices.size} entries); analyse it anew"
            )
        return ChainFactorization(self, A)

    def first_level(self) -> int:
        """First level that is not resting after a failure."""
        with self._lock:
            for index, level in enumerate(self.chain.levels[:-1]):
                if self._resting[level] == 0:
                    return index
                self._resting[level] -= 1
        return len(self.chain.levels) - 1

    def judge(self, level: Level, *, failed: bool) -> None:
        """Remember how a level did: with each failure in a row it rests twice as long.

        That is for single precision. In double precision it is the matrix that fails, and the
        next one may be better.
        """
        if not level.single:
            return
        with self._lock:
            self._failures[level] = self._failures[level] + 1 if failed else 0
            if failed:
                self._resting[level] = min(2 ** (self._failures[level] - 1), _LONGEST_REST)

    def backend_factor(self, level: Level, A: csr_matrix) -> tuple[BackendFactor, float]:
        """Factor by one level; returns the factor and the seconds of the numerical part."""
        begin = perf_counter()
        with self._analysing:  # once, even if two threads ask at the same time
            analysis = self._analyses.get(level.backend.name)
            if analysis is None:
                analysis = level.backend.analyse(A)
                self._analyses[level.backend.name] = analysis
        start = perf_counter()
        factor = analysis.factor(A, single=level.single)
        end = perf_counter()
        self.chain._log.factored(level, end - begin, factor.memory_bytes)
        return factor, end - start


class ChainFactorization:
    """A factor whose solves are checked, and which moves to the next solver if one fails."""

    def __init__(self, analysis: ChainAnalysis, A: csr_matrix) -> None:
        self._analysis = analysis
        self._system = System.of(A)
        self._index = analysis.first_level()
        self._reasons: list[str] = []
        self._lock = Lock()
        self.residual = float("nan")
        self.seconds = 0.0
        self._held: BackendFactor | None = self._next_factor()

    @property
    def n(self) -> int:
        """Number of unknowns."""
        return int(self._system.A.shape[0])

    @property
    def scale(self) -> FloatArray:
        """Scales (n,) that equilibrate the matrix from both sides."""
        return self._system.scale

    @property
    def level(self) -> Level:
        """Solver and precision in use."""
        return self._analysis.chain.levels[self._index]

    @property
    def solver(self) -> str:
        """Name of the solver and precision in use."""
        return str(self.level)

    @property
    def _factor(self) -> BackendFactor:
        if self._held is None:
            raise SolverError(f"linear solver: no factor is left ({'; '.join(self._reasons)})")
        return self._held

    @property
    def inertia(self) -> Inertia | None:
        """Positive, negative and zero eigenvalues; None unless real symmetric in double."""
        return self._factor.inertia

    @property
    def memory_bytes(self) -> int:
        """Size of the factor."""
        return self._factor.memory_bytes

    def solve(self, b: AnyArray) -> AnyArray:
        """Solve for one vector or several, and check the residual of each.

        Parameters
        ----------
        b : array (n,) or (n, k)
            Right-hand sides, real or complex.

        Returns
        -------
        array of the shape of b
            Solutions with ``||A x - b|| <= tolerance ||b||``, or at the level of rounding.

        Raises
        ------
        SolverError
            If the right-hand side is not usable, or every solver of the chain has failed.
        """
        b = np.asarray(b)
        if b.shape[0] != self.n or b.ndim > 2:
            raise SolverError(
                f"linear solver: a right-hand side of shape {b.shape} does not fit "
                f"{self.n} unknowns"
            )
        if not np.isfinite(b).all():
            raise SolverError("linear solver: the right-hand side has values that are not finite")
        columns = b[:, None] if b.ndim == 1 else b
        if columns.shape[1] == 0:
            return np.zeros(b.shape, np.result_type(self._system.A.dtype, b.dtype))
        split = np.iscomplexobj(columns) and not np.iscomplexobj(self._system.A.data)
        if split:
            columns = np.concatenate([columns.real, columns.imag], axis=1)
        x = self._checked(columns.astype(np.result_type(columns.dtype, np.float64)))
        if split:
            half = x.shape[1] // 2
            x = x[:, :half] + 1j * x[:, half:]
        return x.reshape(b.shape)

    def substitute(self, b: AnyArray) -> AnyArray:
        """Substitute once for the columns of ``b (n, k)``, unchecked: for iterations that check.

        Raises
        ------
        BackendFailed
            If the solver in use gives up.
        """
        with self._lock:
            return self._factor.apply(b)

    def _checked(self, b: AnyArray) -> AnyArray:
        chain = self._analysis.chain
        with self._lock:
            while True:
                try:
                    result = refined(
                        self._system, self._factor.apply, b,
                        symmetric=chain.symmetric, tolerance=chain.tolerance,
                        steps=_STEPS[self.level.single],
                    )  # fmt: skip
                except BackendFailed as failure:
                    reason = str(failure)
                else:
                    if result.accepted:
                        self.residual = result.residual
                        self._analysis.judge(self.level, failed=False)
                        chain._log.solved(self.level, b.shape[1], result)
                        return result.x
                    reason = (
                        f"residual {result.residual:.1e} after {result.steps} substitutions, "
                        f"wanted {chain.tolerance:.1e}"
                    )
                self._move_on(reason)
                self._held = None  # the next factor needs the memory
                self._held = self._next_factor()

    def _move_on(self, reason: str) -> None:
        """Go to the next level, or give up; the failure is on record in both cases."""
        levels = self._analysis.chain.levels
        self._analysis.judge(self.level, failed=True)
        self._reasons.append(f"{self.level}: {reason}")
        if self._index + 1 == len(levels):
            raise SolverError(
                f"linear solver: none could solve the system of {self.n} unknowns "
                f"({'; '.join(self._reasons)}). Is the matrix singular (unconstrained unknowns)?"
            )
        self._analysis.chain._log.left(self.level, levels[self._index + 1], reason)
        self._index += 1

    def _next_factor(self) -> BackendFactor:
        while True:
            try:
                factor, seconds = self._analysis.backend_factor(self.level, self._system.A)
            except BackendFailed as failure:
                self._move_on(str(failure))
            else:
                self.seconds += seconds
                return factor


def default_threads() -> int:
    """Threads to use: ``OMP_NUM_THREADS`` if it is set, else the processors of this process."""
    asked = os.environ.get("OMP_NUM_THREADS", "").split(",")[0]
    if asked.isdigit() and int(asked) > 0:
        return int(asked)
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def make_solver(
    name: SolverName = "auto",
    *,
    symmetric: bool = True,
    precision: Precision = "mixed",
    tolerance: float = 1e-9,
    threads: int | None = None,
) -> SolverChain:
    """Make a chain of sparse direct solvers.

    Parameters
    ----------
    name : {"auto", "rslab", "mkl-pardiso", "superlu"}
        One program, or all that are installed: rslab, PARDISO of the ``mkl`` wheel, SuperLU.
    symmetric : bool
        LDL^T of a real or complex symmetric matrix (``A = A^T``, not Hermitian), else LU.
    precision : {"mixed", "double"}
        ``mixed`` factors in single precision and refines against the matrix in double, which
        halves time and memory; where that fails the double factor follows. `inertia` needs
        ``double``.
    tolerance : float
        Largest ``||A x - b|| / ||b||`` accepted. A larger one passes only if it is as small as
        rounding allows (the solution is exact for a matrix changed in its last digits).
    threads : int, optional
        Threads of one factorisation, `default_threads` if left out.

    Raises
    ------
    SolverError
        If the named solver is unknown or not installed.
    """
    threads = default_threads() if threads is None else threads
    made: dict[str, Backend] = {"rslab": Rslab(symmetric, threads)}
    if name == "mkl-pardiso" or (name == "auto" and pardiso.available()):
        if not pardiso.available():
            raise SolverError("linear solver: mkl-pardiso needs the mkl wheel; pip install mkl")
        made["mkl-pardiso"] = pardiso.Pardiso(symmetric, threads)
    made["superlu"] = SuperLu(symmetric)
    if name != "auto":
        if name not in made:
            raise SolverError(
                f"linear solver {name!r} is unknown; choose auto, rslab, mkl-pardiso or superlu"
            )
        made = {name: made[name]}
    levels: list[Level] = []
    for backend in made.values():
        first = not levels
        if precision == "mixed" and first and backend.name != "superlu":
            levels.append(Level(backend, single=True))
        levels.append(Level(backend, single=False))
    return SolverChain(name, tuple(levels), symmetric, tolerance)
