# SPDX-License-Identifier: LGPL-2.1-or-later
"""PARDISO of Intel's Math Kernel Library, through ctypes, if the ``mkl`` wheel is installed."""

import ctypes
import weakref
from dataclasses import dataclass, field
from functools import cache
from importlib import metadata
from pathlib import Path
from threading import Lock

import numpy as np

from quietblade.linalg.pattern import Pattern, canonical
from quietblade.linalg.protocol import BackendFailed, Inertia, SparseMatrix
from quietblade.linalg.refinement import equilibration
from quietblade.typing import AnyArray, FloatArray, IntArray

_ERRORS = {
    -1: "input inconsistent",
    -2: "not enough memory",
    -3: "reordering problem",
    -4: "zero pivot",
    -5: "internal error",
    -6: "reordering failed",
    -7: "diagonal matrix is singular",
    -8: "32-bit integer overflow",
    -9: "not enough memory for out-of-core solution",
}
_TYPES = {(True, False): -2, (True, True): 6, (False, False): 11, (False, True): 13}
"""Matrix type by (symmetric, complex)."""


@cache
def library() -> ctypes.CDLL | None:
    """Load the run-time library of the ``mkl`` wheel; None if it is not installed."""
    try:
        files = metadata.files("mkl") or []
    except metadata.PackageNotFoundError:
        return None
    for file in files:
        if file.name.startswith(("libmkl_rt.", "mkl_rt.")) and ".lib" not in file.name:
            try:
                return ctypes.CDLL(str(Path(str(file.locate())).resolve()))
            except OSError:
                continue
    return None


@dataclass(frozen=True)
class Pardiso:
    """The PARDISO program with a number of threads."""

    symmetric: bool
    threads: int
    name: str = "mkl-pardiso"

    def analyse(self, A: SparseMatrix) -> "PardisoAnalysis":
        """Prepare the pattern; the program analyses at the first factorisation."""
        pattern = Pattern.of(canonical(A), "upper" if self.symmetric else "csr")
        if pattern.indices.size > np.iinfo(np.int32).max:
            raise BackendFailed("analysis: more entries than 32-bit integers can count")
        return PardisoAnalysis(pattern, self.threads, self.symmetric)


@dataclass(frozen=True, eq=False)
class PardisoAnalysis:
    """A pattern, and analysed handles that no living factor uses."""

    pattern: Pattern
    threads: int
    symmetric: bool
    idle: list["_Handle"] = field(default_factory=list)
    lock: Lock = field(default_factory=Lock)

    def factor(self, A: SparseMatrix, *, single: bool) -> "PardisoFactor":
        """Factor on an analysed handle if one is idle, else on a new one."""
        A = canonical(A)
        # Pivots are perturbed relative to the largest entry, which is that of one field only.
        scale = equilibration(A, sweeps=4)
        rows = np.repeat(np.arange(self.pattern.n), np.diff(self.pattern.indptr))
        values = self.pattern.values(A) * scale[rows] * scale[self.pattern.indices]
        dtype = np.result_type(values.dtype, np.float32)
        if single:
            dtype = np.dtype(np.complex64 if np.iscomplexobj(values) else np.float32)
        kind = _TYPES[self.symmetric, np.iscomplexobj(values)]
        with self.lock:
            fits = [handle for handle in self.idle if (handle.kind, handle.dtype) == (kind, dtype)]
            handle = fits[0] if fits else None
            if handle is not None:
                self.idle.remove(handle)
        if handle is None:
            handle = _Handle(self.pattern, kind, dtype, self.threads)
        handle.factor(values.astype(dtype))
        return PardisoFactor(handle, self, scale)


class PardisoFactor:
    """A factor of PARDISO; its handle goes back to the analysis when nobody needs it."""

    def __init__(self, handle: "_Handle", analysis: PardisoAnalysis, scale: FloatArray) -> None:
        self._handle, self._scale = handle, scale[:, None]
        self.inertia = handle.inertia()
        self.memory_bytes = handle.memory_bytes()
        weakref.finalize(self, analysis.idle.append, handle)

    def apply(self, b: AnyArray) -> AnyArray:
        """Substitute for the columns of ``b``."""
        return self._scale * self._handle.solve(self._scale * b)


class _Handle:
    """PARDISO's own state: one analysis and one factor in its memory."""

    def __init__(
        self, pattern: Pattern, kind: int, dtype: np.dtype[np.generic], threads: int
    ) -> None:
        self.kind, self.dtype, self.n = kind, np.dtype(dtype), pattern.n
        self._threads = threads
        self._indptr: IntArray | AnyArray = pattern.indptr.astype(np.int32)
        self._indices = pattern.indices.astype(np.int32)
        self._values: AnyArray = np.zeros(0, dtype)
        self._state = np.zeros(64, np.int64)
        self._control = np.zeros(64, np.int32)
        control = self._control
        control[0] = 1  # the values below, not the defaults
        control[1] = 2  # nested dissection (METIS); minimum degree costs ten times as much in 3D
        control[9] = 13 if kind in (11, 13) else 8  # perturb pivots below 10^-this
        control[10] = control[12] = int(kind in (11, 13))  # scaling and matching, if unsymmetric
        control[17] = -1  # count the entries of the factor
        control[20] = 1  # Bunch-Kaufman pivots
        control[27] = int(self.dtype in (np.dtype(np.float32), np.dtype(np.complex64)))
        control[34] = 1  # indices from zero
        self._analysed = False
        weakref.finalize(self, _release, self._state, self._control, kind, self.n)

    def factor(self, values: AnyArray) -> None:
        self._values = np.ascontiguousarray(values)
        nothing = np.zeros(1, self.dtype)
        if not self._analysed:
            self._call(11, nothing, nothing, 1)
            self._analysed = True
        self._call(22, nothing, nothing, 1)

    def solve(self, b: AnyArray) -> AnyArray:
        # PARDISO reads the columns one after the other.
        right = np.asfortranarray(b, dtype=self.dtype)
        x = np.zeros_like(right, order="F")
        self._call(33, right, x, right.shape[1])
        return x.astype(np.result_type(self.dtype, np.float64))

    def inertia(self) -> Inertia | None:
        if self.kind != -2 or self.dtype != np.dtype(np.float64):
            return None
        positive, negative = int(self._control[21]), int(self._control[22])
        return positive, negative, self.n - positive - negative

    def memory_bytes(self) -> int:
        return 1024 * int(max(self._control[14], self._control[15] + self._control[16]))

    def _call(self, phase: int, b: AnyArray, x: AnyArray, columns: int) -> None:
        mkl = library()
        if mkl is None:
            raise BackendFailed("the mkl wheel is not installed")
        mkl.MKL_Set_Num_Threads_Local(ctypes.c_int(self._threads))
        error = _pardiso(
            mkl, self._state, self._control, self.kind, phase, self.n,
            self._values, self._indptr, self._indices, columns, b, x,
        )  # fmt: skip
        if error:
            raise BackendFailed(f"PARDISO phase {phase}: {_ERRORS.get(error, f'error {error}')}")


def _pardiso(
    mkl: ctypes.CDLL, state: AnyArray, control: AnyArray, kind: int, phase: int, n: int,
    values: AnyArray, indptr: AnyArray, indices: AnyArray, columns: int, b: AnyArray, x: AnyArray,
) -> int:  # fmt: skip
    def integer(value: int) -> "ctypes._CArgObject":  # type: ignore[name-defined, unused-ignore]
        return ctypes.byref(ctypes.c_int32(value))

    def address(array: AnyArray) -> ctypes.c_void_p:
        return ctypes.c_void_p(array.ctypes.data)

    error = ctypes.c_int32(0)
    no_permutation = np.zeros(1, np.int32)
    mkl.pardiso(
        address(state), integer(1), integer(1), integer(kind), integer(phase), integer(n),
        address(values), address(indptr), address(indices), address(no_permutation),
        integer(columns), address(control), integer(0), address(b), address(x),
        ctypes.byref(error),
    )  # fmt: skip
    return error.value


def _release(state: AnyArray, control: AnyArray, kind: int, n: int) -> None:
    mkl = library()
    if mkl is not None and state.any():
        nothing = np.zeros(1, np.int64)
        _pardiso(mkl, state, control, kind, -1, n, nothing, nothing, nothing, 1, nothing, nothing)


def available() -> bool:
    """Whether the optional ``mkl`` wheel can be loaded."""
    return library() is not None
