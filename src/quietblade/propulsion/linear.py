# SPDX-License-Identifier: LGPL-2.1-or-later
"""Linear systems of Newton's method on the free unknowns."""

from dataclasses import dataclass

import ngsolve as ngs
import numpy as np
from scipy.sparse import csr_matrix

from quietblade.linalg import Factorization, SolverChain, SparseSolver, make_solver
from quietblade.mesh.assembly import csr_of
from quietblade.typing import AnyArray, BoolArray, IntArray

# Newton's method corrects what the linear solver leaves.
_TOLERANCE = 1e-9


def newton_solver() -> SolverChain:
    """Solver of Newton's method: unsymmetric, since the load follows the surface."""
    return make_solver(symmetric=False, precision="double", tolerance=_TOLERANCE)


class FreeSystem:
    """Free rows and columns of matrices that share one pattern.

    Parameters
    ----------
    free : (ndof,) bool array
        Unknowns to solve for.
    solver : SparseSolver
        Linear solver; its analysis is used again while the pattern stays.
    """

    def __init__(self, free: BoolArray, solver: SparseSolver) -> None:
        self._free = np.flatnonzero(free)
        self._solver = solver
        self._pattern: _FreePattern | None = None

    def factor(self, form: ngs.BilinearForm) -> Factorization:
        """Factorise the free part of an assembled form."""
        full = csr_of(form)
        if self._pattern is None:
            self._pattern = _FreePattern.of(full, self._free)
        return self._solver.factor(self._pattern.select(full))


@dataclass(frozen=True, eq=False)
class _FreePattern:
    """Where the entries of the free part are in the data of the whole matrix."""

    entries: IntArray
    indices: AnyArray
    indptr: AnyArray

    @classmethod
    def of(cls, full: csr_matrix, free: IntArray) -> "_FreePattern":
        numbers = np.arange(full.nnz)
        numbered = csr_matrix((numbers, full.indices, full.indptr), shape=full.shape)
        reduced = numbered[free][:, free]
        reduced.sort_indices()
        return cls(np.array(reduced.data, dtype=np.int64), reduced.indices, reduced.indptr)

    def select(self, full: csr_matrix) -> csr_matrix:
        n = len(self.indptr) - 1
        return csr_matrix((full.data[self.entries], self.indices, self.indptr), shape=(n, n))
