# SPDX-License-Identifier: LGPL-2.1-or-later
"""One sparsity pattern and the order in which a solver program wants its values."""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.sparse import csr_matrix

from quietblade.errors import SolverError
from quietblade.linalg.protocol import SparseMatrix
from quietblade.typing import AnyArray, IntArray


def canonical(A: SparseMatrix) -> csr_matrix:
    """Return ``A`` as a square CSR matrix with sorted indices and no duplicates.

    Raises
    ------
    SolverError
        If the matrix is not square, or has values that are not finite.
    """
    A = A if isinstance(A, csr_matrix) else csr_matrix(A)  # one object remembers its format
    if A.shape[0] != A.shape[1]:
        raise SolverError(f"linear solver: the matrix must be square, got {A.shape}")
    if not A.has_canonical_format:
        A = A.copy()
        A.sum_duplicates()
    if not np.isfinite(A.data).all():
        row = int(np.searchsorted(A.indptr, np.flatnonzero(~np.isfinite(A.data))[0], "right")) - 1
        raise SolverError(
            f"linear solver: the matrix has a value that is not finite in row {row} of {A.shape[0]}"
        )
    return A


def asymmetry(A: csr_matrix) -> float:
    """Largest ``|A - A^T|`` relative to the largest entry of ``A`` (canonical)."""
    scale = float(np.abs(A.data).max(initial=0.0))
    if scale == 0.0:
        return 0.0
    T = A.T.tocsr()
    T.sort_indices()
    if np.array_equal(T.indptr, A.indptr) and np.array_equal(T.indices, A.indices):
        return float(np.abs(T.data - A.data).max(initial=0.0)) / scale
    return float(np.abs((A - T).data).max(initial=0.0)) / scale


@dataclass(frozen=True, eq=False)
class Pattern:
    """Compressed pattern with every diagonal entry present, and the way its values are found.

    Attributes
    ----------
    n : int
        Number of unknowns.
    indptr, indices : integer arrays
        The compressed pattern in the wanted layout, sorted.
    gather : integer array
        Position of each value in the data of the canonical CSR matrix; one past its end means zero.
    """

    n: int
    indptr: IntArray
    indices: IntArray
    gather: IntArray

    @classmethod
    def of(cls, A: csr_matrix, layout: Literal["upper", "csr", "csc"]) -> "Pattern":
        """Take the pattern of a canonical matrix.

        ``upper`` is the upper triangle by rows, which for a symmetric matrix is also its lower
        triangle by columns; ``csr`` and ``csc`` are the whole matrix by rows and by columns.
        """
        n = A.shape[0]
        rows = np.repeat(np.arange(n), np.diff(A.indptr))
        columns = A.indices.astype(np.int64)
        source = np.arange(A.nnz)
        missing = np.setdiff1d(np.arange(n), rows[rows == columns])
        rows = np.concatenate([rows, missing])
        columns = np.concatenate([columns, missing])
        source = np.concatenate([source, np.full(missing.size, A.nnz)])
        if layout == "upper":
            keep = columns >= rows
            rows, columns, source = rows[keep], columns[keep], source[keep]
        if layout == "csc":
            rows, columns = columns, rows
        indptr = np.concatenate([[0], np.cumsum(np.bincount(rows, minlength=n))]).astype(np.int64)
        if layout != "csc" and missing.size == 0:  # as sorted as the canonical matrix
            return cls(n, indptr, columns, source)
        order = np.lexsort((columns, rows))
        return cls(n, indptr, columns[order], source[order])

    def values(self, A: csr_matrix) -> AnyArray:
        """Values of a canonical matrix on this pattern, in the order of the layout."""
        return np.append(A.data, A.data.dtype.type(0))[self.gather]


def same_pattern(A: csr_matrix, indptr: AnyArray, indices: AnyArray) -> bool:
    """Whether a canonical matrix has exactly this CSR pattern."""
    return np.array_equal(A.indptr, indptr) and np.array_equal(A.indices, indices)
