# SPDX-License-Identifier: LGPL-2.1-or-later
"""Nearly symmetric matrices: the symmetric part is factorised, Krylov steps do the rest.

A symmetric factor costs half the time and memory of an unsymmetric one, and its pivots count the
negative eigenvalues.  Where the skew part is small beside it, as the stiffness of a pressure that
follows a surface is, a few substitutions reach the solution of the whole system.
"""

from collections import Counter
from dataclasses import dataclass, field
from functools import cached_property
from threading import Lock

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.linalg import LinearOperator, gmres

from quietblade.errors import SolverError
from quietblade.linalg.chain import ChainFactorization, SolverChain, make_solver
from quietblade.linalg.pattern import canonical, same_pattern
from quietblade.linalg.protocol import BackendFailed, Factorization, Inertia, SparseMatrix
from quietblade.linalg.refinement import Refined, System, refined
from quietblade.linalg.report import Fallback, SolverReport
from quietblade.typing import AnyArray, FloatArray, IntArray

_SYMMETRIC = 1e-13
"""Relative asymmetry that is rounding."""

_MOST_STEPS = 30
"""Krylov steps of one refinement; beyond, a factor of the whole matrix is cheaper."""

_REFINEMENTS = 6
_KRYLOV = 1e-4
"""Relative change of the solution that one refinement may leave."""


@dataclass(frozen=True)
class SymmetrizedSolver:
    """Solver of real matrices whose skew part is zero or small; a `SparseSolver`.

    Attributes
    ----------
    symmetric, general : SolverChain
        For the symmetric part, and for whole matrices on which the iteration fails.
    accuracy : float or None
        Relative error of the solution that is enough, as the Krylov steps measure it; None if the
        residual has to reach the tolerance of `symmetric`.
    """

    symmetric: SolverChain
    general: SolverChain
    accuracy: float | None = None
    _transposed: "list[_Transposition]" = field(default_factory=list, repr=False, compare=False)
    _fallbacks: list[Fallback] = field(default_factory=list, repr=False, compare=False)
    _lock: Lock = field(default_factory=Lock, repr=False, compare=False)

    @property
    def name(self) -> str:
        """Name of the chain of programs."""
        return self.symmetric.name

    def analyse(self, A: SparseMatrix) -> "SymmetrizedAnalysis":
        """Take a pattern, which has to be symmetric."""
        return SymmetrizedAnalysis(self, _Transposition.of(canonical(A)))

    def factor(self, A: SparseMatrix) -> "SymmetrizedFactor":
        """Factor ``A``; what is known of its pattern is used again if it is the last one's."""
        A = canonical(A)
        with self._lock:
            last = self._transposed[0] if self._transposed else None
            if last is None or not same_pattern(A, last.indptr, last.indices):
                last = _Transposition.of(A)
                self._transposed[:] = [last]
        return SymmetrizedAnalysis(self, last).factor(A)

    def report(self) -> SolverReport:
        """Say what both chains did, and where the whole matrix had to be factorised."""
        reports = [self.symmetric.report(), self.general.report()]
        counts = [
            dict(sum((Counter(getattr(r, name)) for r in reports), Counter[str]()))
            for name in ("factorizations", "solves")
        ]
        return SolverReport(
            counts[0],
            counts[1],
            max(r.worst_residual for r in reports),
            max(r.most_steps for r in reports),
            (*(f for r in reports for f in r.fallbacks), *self._fallbacks),
            sum(r.seconds for r in reports),
            max(r.largest_factor for r in reports),
        )


@dataclass(frozen=True, eq=False)
class SymmetrizedAnalysis:
    """A pattern, ready for values."""

    solver: SymmetrizedSolver
    transposition: "_Transposition"

    def factor(self, A: SparseMatrix) -> "SymmetrizedFactor":
        """Factor the symmetric part of new values."""
        A = canonical(A)
        part, skew = self._split(A)
        return SymmetrizedFactor(self.solver, A, self.solver.symmetric.factor(part), skew)

    def _split(self, A: csr_matrix) -> tuple[csr_matrix, csr_matrix | None]:
        """Symmetric and skew part; None for a skew part that is rounding."""
        mean = A.data[self.transposition.order]
        mean += A.data
        mean *= 0.5
        part = csr_matrix((mean, A.indices, A.indptr), shape=A.shape)
        rest = A.data - mean
        size = float(np.abs(A.data).max(initial=0.0))
        if np.abs(rest).max(initial=0.0) <= _SYMMETRIC * size:
            return part, None
        kept = rest != 0.0
        starts = np.concatenate([[0], np.cumsum(kept)])[A.indptr]
        return part, csr_matrix((rest[kept], A.indices[kept], starts), shape=A.shape)


class SymmetrizedFactor:
    """Factor of the symmetric part, with the whole matrix to iterate on."""

    def __init__(
        self,
        solver: SymmetrizedSolver,
        A: csr_matrix,
        half: ChainFactorization,
        skew: csr_matrix | None,
    ) -> None:
        self._solver, self._A, self._half, self._skew = solver, A, half, skew
        self._whole: Factorization | None = None
        self.residual = float("nan")

    @property
    def n(self) -> int:
        """Number of unknowns."""
        return self._half.n

    @property
    def solver(self) -> str:
        """Program and precision of the factor in use."""
        return self._half.solver if self._whole is None else self._whole.solver

    @property
    def inertia(self) -> Inertia | None:
        """Positive, negative and zero eigenvalues of the symmetric part."""
        return self._half.inertia

    @property
    def seconds(self) -> float:
        """Time spent on numerical factorisations."""
        return self._half.seconds + (0.0 if self._whole is None else self._whole.seconds)

    @property
    def memory_bytes(self) -> int:
        """Size of the factors."""
        return self._half.memory_bytes + (0 if self._whole is None else self._whole.memory_bytes)

    def solve(self, b: AnyArray) -> AnyArray:
        """Solve for one vector ``(n,)`` or for the columns of ``(n, k)``."""
        b = np.asarray(b)
        if self._skew is None:
            x = self._half.solve(b)
            self.residual = self._half.residual
            return x
        columns = b[:, None] if b.ndim == 1 else b
        return np.stack([self._column(c) for c in columns.T], axis=1).reshape(b.shape)

    def _column(self, b: AnyArray) -> AnyArray:
        if self._whole is None:
            try:
                result = self._iterated(b[:, None])
            except BackendFailed as failure:
                self._take_the_whole(str(failure))
            else:
                if result.accepted:
                    self.residual = result.residual
                    self._solver.symmetric._log.solved(self._half.level, 1, result)
                    return np.asarray(result.x[:, 0])
                self._take_the_whole(
                    f"residual {result.residual:.1e} with the symmetric part and {_MOST_STEPS} "
                    "Krylov steps"
                )
        assert self._whole is not None
        x = self._whole.solve(b)
        self.residual = self._whole.residual
        return x

    def _iterated(self, b: AnyArray) -> Refined:
        """Solve to the wanted accuracy or, if none is given, to the wanted residual."""
        accuracy = self._solver.accuracy
        if accuracy is None:
            return refined(
                self._system, lambda r: self._krylov(r, _KRYLOV).x, b,
                symmetric=False, tolerance=self._solver.symmetric.tolerance, steps=_REFINEMENTS,
            )  # fmt: skip
        return self._krylov(b, accuracy)

    def _krylov(self, b: AnyArray, accuracy: float) -> Refined:
        """Solve ``(1 + S^-1 N) x = S^-1 b``; S is the symmetric part, N the skew one.

        The relative residual is of this system, where it is about the error of the solution.
        """
        half, skew = self._half, self._skew
        assert skew is not None
        # scaled, so that no field of the solution hides behind another one's unit
        d = self._half.scale[:, None]

        def product(y: FloatArray) -> FloatArray:
            return np.asarray(y + (half.substitute(skew @ (d * y[:, None])) / d)[:, 0])

        operator = LinearOperator((self.n, self.n), matvec=product, dtype=np.float64)
        start = (half.substitute(b) / d)[:, 0]
        sizes = [0.0]
        y, unfinished = gmres(
            operator, start, rtol=accuracy, restart=_MOST_STEPS, maxiter=1,
            callback=sizes.append, callback_type="pr_norm",
        )  # fmt: skip
        converged = unfinished == 0 and bool(np.isfinite(y).all())
        return Refined(d * y[:, None], float(sizes[-1]), len(sizes), converged)

    @cached_property
    def _system(self) -> System:
        return System.of(self._A)

    def _take_the_whole(self, reason: str) -> None:
        self._whole = self._solver.general.factor(self._A)
        self._solver._fallbacks.append(
            Fallback(f"{self._half.solver}, symmetric part", self._whole.solver, reason)
        )


@dataclass(frozen=True, eq=False)
class _Transposition:
    """Where the values of the transposed matrix are in a symmetric pattern."""

    indptr: AnyArray
    indices: AnyArray
    order: IntArray

    @classmethod
    def of(cls, A: csr_matrix) -> "_Transposition":
        numbers = np.arange(A.nnz, dtype=A.indices.dtype)
        numbered = csr_matrix((numbers, A.indices, A.indptr), shape=A.shape)
        turned = numbered.T.tocsr()
        turned.sort_indices()
        if not same_pattern(turned, A.indptr, A.indices):
            raise SolverError("linear solver: the pattern of the matrix is not symmetric")
        return cls(A.indptr.copy(), A.indices.copy(), np.asarray(turned.data))


def make_nearly_symmetric_solver(
    tolerance: float = 1e-9, *, accuracy: float | None = None
) -> SymmetrizedSolver:
    """Make a solver of real matrices that are symmetric or nearly so, with inertia.

    Parameters
    ----------
    tolerance : float
        Largest relative residual.
    accuracy : float or None
        If given, matrices with a skew part are solved until the error of the solution is about
        this share of it (then `residual` means that), which takes half the substitutions of a
        small residual.
    """
    chains = [
        make_solver(symmetric=symmetric, precision="double", tolerance=tolerance)
        for symmetric in (True, False)
    ]
    return SymmetrizedSolver(chains[0], chains[1], accuracy)
