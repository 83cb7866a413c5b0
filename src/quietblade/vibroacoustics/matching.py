# SPDX-License-Identifier: LGPL-2.1-or-later
"""Likeness of mode shapes, and partners between two sets of modes (theory: S2-15)."""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment
from scipy.sparse import csr_matrix

from quietblade.typing import AnyArray, FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class Match:
    """Partners of the modes of one set in another.

    Attributes
    ----------
    partner : (n_a,) int array
        Row in the second set of each mode's partner, -1 for none.
    assurance : (n_a,) array
        Modal assurance of the pair; that of the most similar mode where there is no partner.
    table : (n_a, n_b) array
        Assurance of each mode with each.
    """

    partner: IntArray
    assurance: FloatArray
    table: FloatArray


def assurance(a: AnyArray, b: AnyArray, product: csr_matrix) -> FloatArray:
    """Modal assurance |a^H P b|^2 / ((a^H P a) (b^H P b)) of each pair (theory: S2-15).

    Parameters
    ----------
    a : (n_a, n) array
    b : (n_b, n) array
        Real or complex vectors, one a row.
    product : (n, n) csr_matrix
        Mass of the structure; it leaves film pressure and potential out of account.

    Returns
    -------
    (n_a, n_b) array
        Between 0 and 1; 0 for a vector without mass.
    """
    own = np.einsum("ij,ij->i", a.conj(), (product @ a.T).T).real
    momenta = (product @ b.T).T
    other = np.einsum("ij,ij->i", b.conj(), momenta).real
    scale = np.outer(own, other)
    overlap = np.abs(a.conj() @ momenta.T) ** 2
    return np.asarray(np.divide(overlap, scale, out=np.zeros_like(scale), where=scale > 0.0))


def match(a: AnyArray, b: AnyArray, product: csr_matrix, *, least: float = 0.3) -> Match:
    """One-to-one partners with the largest sum of modal assurances.

    Parameters
    ----------
    a, b : (n_a, n), (n_b, n) arrays
        Two sets of modes on the same unknowns, as about C0 and C1.
    product : (n, n) csr_matrix
        As in `assurance`.
    least : float
        Assurance below which two modes are no partners.
    """
    table = assurance(a, b, product)
    partner = np.full(len(a), -1, dtype=np.int64)
    best = table.max(axis=1, initial=0.0)
    rows, columns = linear_sum_assignment(table, maximize=True)
    for row, column in zip(rows, columns, strict=True):
        if table[row, column] >= least:
            partner[row], best[row] = column, table[row, column]
    return Match(partner, best, table)
