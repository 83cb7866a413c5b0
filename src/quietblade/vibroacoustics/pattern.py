# SPDX-License-Identifier: LGPL-2.1-or-later
"""One sparsity pattern for all terms of a matrix that depends on frequency."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Self

import numpy as np
from scipy.sparse import csr_matrix

from quietblade.typing import AnyArray, FloatArray, IntArray


@dataclass(frozen=True)
class CommonPattern:
    """Union of the patterns of several matrices, and where the entries of each one lie in it.

    Attributes
    ----------
    indptr, indices : int arrays
        The pattern in compressed rows, columns sorted.
    slots : mapping of name to int array
        Position of each stored entry of the term in the union.
    values : mapping of name to float array
        The stored entries of the term, in the order of ``slots``.
    """

    indptr: AnyArray
    indices: AnyArray
    slots: Mapping[str, IntArray]
    values: Mapping[str, FloatArray]

    @classmethod
    def of(cls, terms: Mapping[str, csr_matrix]) -> Self:
        """Pattern that holds every term.

        Raises
        ------
        ValueError
            If there is no term, or if the terms differ in shape or are not square.
        """
        shapes = {term.shape for term in terms.values()}
        if len(shapes) != 1 or len(set(next(iter(shapes)))) != 1:
            raise ValueError(f"a common pattern needs square terms of one shape, not {shapes}")
        canonical = {name: _canonical(term) for name, term in terms.items()}
        union = sum((_ones(term) for term in canonical.values()), start=csr_matrix(shapes.pop()))
        union.sort_indices()
        # The entries of the union numbered from one: no product with them can vanish.
        numbered = csr_matrix(
            (np.arange(1, union.nnz + 1, dtype=np.int64), union.indices, union.indptr),
            shape=union.shape,
        )
        slots = {}
        for name, term in canonical.items():
            found = csr_matrix(_ones(term).multiply(numbered))
            found.sort_indices()
            slots[name] = found.data - 1
        return cls(
            union.indptr,
            union.indices,
            slots,
            {name: term.data for name, term in canonical.items()},
        )

    def combine(self, factors: Mapping[str, complex]) -> csr_matrix:
        """Linear combination of the terms; a term without a factor is left out.

        Returns
        -------
        csr_matrix
            Real if every factor is a real number type, complex otherwise; the pattern is the same
            object for all combinations, so that a symbolic factorisation can be kept.
        """
        scalars = [np.asarray(factor) for factor in factors.values()]
        data: AnyArray = np.zeros(len(self.indices), dtype=np.result_type(np.float64, *scalars))
        for name, factor in factors.items():
            data[self.slots[name]] += factor * self.values[name]
        n = len(self.indptr) - 1
        return csr_matrix((data, self.indices, self.indptr), shape=(n, n), copy=False)


def _canonical(term: csr_matrix) -> csr_matrix:
    """Sorted, without repeated entries; the caller's matrix stays as it is."""
    copy = csr_matrix(term, copy=not term.has_canonical_format)
    copy.sum_duplicates()
    return copy


def _ones(term: csr_matrix) -> csr_matrix:
    return csr_matrix(
        (np.ones(term.nnz, dtype=np.int64), term.indices, term.indptr), shape=term.shape
    )
