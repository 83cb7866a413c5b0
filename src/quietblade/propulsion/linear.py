# SPDX-License-Identifier: LGPL-2.1-or-later
"""Linear systems of Newton's method on the free unknowns."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import ngsolve as ngs
import numpy as np
from scipy.sparse import csr_matrix

from quietblade.linalg import (
    Factorization,
    SparseSolver,
    SymmetrizedSolver,
    make_nearly_symmetric_solver,
)
from quietblade.mesh.assembly import csr_of
from quietblade.typing import AnyArray, BoolArray, FloatArray, IntArray

# Newton's method corrects what the linear solver leaves.
_TOLERANCE = 1e-9

# What the load's skew part adds to a correction is iterated to this share of the correction: so
# much less than a correction misses by the curvature of the path that none more is needed.
_ACCURACY = 1e-5


def newton_solver() -> SymmetrizedSolver:
    """Solver of Newton's method: symmetric but for the load that follows the surface."""
    return make_nearly_symmetric_solver(_TOLERANCE, accuracy=_ACCURACY)


class FreeSystem:
    """Free rows and columns of matrices that share one pattern.

    Parameters
    ----------
    free : (ndof,) bool array
        Unknowns to solve for.
    solver : SparseSolver
        Linear solver; its analysis is used again while the pattern stays.
    constant : csr array or None
        Matrix (ndof, ndof) that is added to each one, as of elastic supports.
    """

    def __init__(
        self, free: BoolArray, solver: SparseSolver, constant: csr_matrix | None = None
    ) -> None:
        self._free = np.flatnonzero(free)
        self._solver = solver
        self._constant = constant
        self._pattern: _FreePattern | None = None

    def factor(self, *forms: ngs.BilinearForm) -> Factorization:
        """Factorise the free part of the sum of assembled forms, the same ones each time."""
        if self._pattern is None:
            self._pattern = _FreePattern.of(map(csr_of, forms), self._constant, self._free)
        # a view: the matrices are the largest arrays of a process
        values = [np.asarray(form.mat.AsVector().FV().NumPy()) for form in forms]
        return self._solver.factor(self._pattern.select(values))


@dataclass(frozen=True, eq=False)
class _FreePattern:
    """Free part of a constant matrix plus others, each of a pattern of its own."""

    entries: tuple[IntArray, ...]
    """Which data of each matrix are in its free part."""
    places: tuple[IntArray, ...]
    """Where they are in the data of the sum."""
    base: csr_matrix
    """The constant matrix, with room for the others."""

    @classmethod
    def of(
        cls, parts: Iterable[csr_matrix], constant: csr_matrix | None, free: IntArray
    ) -> "_FreePattern":
        inside = [_numbered(part, free) for part in parts]
        entries = tuple(part.data for part in inside)
        added = [] if constant is None else [constant[free][:, free]]
        # the sum of ones keeps entries that might cancel in a sum of values
        base = sum(map(_ones, [*inside, *added]), csr_matrix((len(free), len(free))))
        base.sort_indices()
        base.data[:] = 0.0
        for part in added:
            base.data[_places(base, part)] = part.data
        return cls(entries, tuple(_places(base, part) for part in inside), base)

    def select(self, values: Sequence[FloatArray]) -> csr_matrix:
        data = self.base.data.copy()
        for entries, places, data_of in zip(self.entries, self.places, values, strict=True):
            data[places] += data_of[entries]
        return csr_matrix((data, self.base.indices, self.base.indptr), shape=self.base.shape)


def _numbered(matrix: csr_matrix, free: IntArray) -> csr_matrix:
    """Free part of a matrix, with the positions of the entries in its data as values."""
    numbers = np.arange(matrix.nnz, dtype=matrix.indices.dtype)
    numbered = csr_matrix((numbers, matrix.indices, matrix.indptr), shape=matrix.shape)
    inside = numbered[free][:, free]
    inside.sort_indices()
    return inside


def _ones(matrix: csr_matrix) -> csr_matrix:
    return csr_matrix((np.ones(matrix.nnz), matrix.indices, matrix.indptr), shape=matrix.shape)


def _places(base: csr_matrix, part: csr_matrix) -> IntArray:
    """Positions of a part's entries in the data of a sorted matrix that holds them all."""
    if base.nnz == part.nnz:
        return np.arange(part.nnz, dtype=base.indices.dtype)

    def keys(matrix: csr_matrix) -> AnyArray:
        rows = np.repeat(np.arange(matrix.shape[0]), np.diff(matrix.indptr))
        return rows * matrix.shape[1] + matrix.indices

    places = np.searchsorted(keys(base), keys(part))
    return places.astype(base.indices.dtype)
