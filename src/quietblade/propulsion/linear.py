# SPDX-License-Identifier: LGPL-2.1-or-later
"""Linear systems of Newton's method on the free unknowns."""

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
from quietblade.typing import AnyArray, BoolArray, IntArray

# Newton's method corrects what the linear solver leaves.
_TOLERANCE = 1e-9


def newton_solver() -> SymmetrizedSolver:
    """Solver of Newton's method: symmetric but for the load that follows the surface."""
    return make_nearly_symmetric_solver(_TOLERANCE)


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

    def factor(self, form: ngs.BilinearForm) -> Factorization:
        """Factorise the free part of an assembled form."""
        full = csr_of(form)
        if self._pattern is None:
            self._pattern = _FreePattern.of(full, self._constant, self._free)
        return self._solver.factor(self._pattern.select(full))


@dataclass(frozen=True, eq=False)
class _FreePattern:
    """Free part of a constant matrix plus others of one pattern."""

    entries: IntArray
    """Which data of the whole matrix are in the free part."""
    places: IntArray
    """Where they are in its data."""
    base: csr_matrix
    """The constant matrix, with room for the others."""

    @classmethod
    def of(cls, full: csr_matrix, constant: csr_matrix | None, free: IntArray) -> "_FreePattern":
        numbers = np.arange(full.nnz, dtype=float)  # exact up to 2^53
        inside = csr_matrix((numbers, full.indices, full.indptr), shape=full.shape)[free][:, free]
        inside.sort_indices()
        entries = inside.data.astype(np.int64)
        if constant is None:
            base = csr_matrix((np.zeros(inside.nnz), inside.indices, inside.indptr), inside.shape)
            return cls(entries, np.arange(inside.nnz), base)
        added = constant[free][:, free]
        # the sum of ones keeps entries that might cancel in a sum of values
        base = _ones(inside) + _ones(added)
        base.sort_indices()
        base.data[:] = 0.0
        base.data[_places(base, added)] = added.data
        return cls(entries, _places(base, inside), base)

    def select(self, full: csr_matrix) -> csr_matrix:
        data = self.base.data.copy()
        data[self.places] += full.data[self.entries]
        return csr_matrix((data, self.base.indices, self.base.indptr), shape=self.base.shape)


def _ones(matrix: csr_matrix) -> csr_matrix:
    return csr_matrix((np.ones(matrix.nnz), matrix.indices, matrix.indptr), shape=matrix.shape)


def _places(base: csr_matrix, part: csr_matrix) -> IntArray:
    """Positions of a part's entries in the data of a sorted matrix that holds them all."""

    def keys(matrix: csr_matrix) -> AnyArray:
        rows = np.repeat(np.arange(matrix.shape[0]), np.diff(matrix.indptr))
        return rows * matrix.shape[1] + matrix.indices

    return np.searchsorted(keys(base), keys(part))
