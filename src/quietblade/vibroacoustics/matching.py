# SPDX-License-Identifier: LGPL-2.1-or-later
"""Likeness of mode shapes, and partners between two sets of modes (theory: S2-15, S2-56)."""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment
from scipy.sparse import csr_matrix
from scipy.sparse.linalg import LinearOperator

from quietblade.linalg import SparseSolver, make_solver
from quietblade.typing import AnyArray, FloatArray, IntArray
from quietblade.vibroacoustics.operators import Operators

Product = csr_matrix | LinearOperator
"""A symmetric matrix, or something that multiplies like one."""


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


def wet_mass(operators: Operators, *, solver: SparseSolver | None = None) -> LinearOperator:
    """Mass of the structure and of the water that moves with it, M + C H'^-1 C^T (theory: S2-13).

    One factorisation of H', that of incompressible water without end, serves all products.

    Parameters
    ----------
    operators : Operators
        With the static exterior.
    solver : SparseSolver, optional
        Symmetric.

    Returns
    -------
    (n, n) LinearOperator
        On all unknowns; only those of the displacement count.
    """
    if operators.exterior is None:
        raise ValueError("the added mass needs the static exterior (operators.exterior)")
    chosen = make_solver(precision="double") if solver is None else solver
    u, water = operators.blocks.u, operators.blocks.water
    own = operators.terms["M"][u][:, u]
    coupling = operators.terms["C"][u][:, water]
    factor = None
    if len(water):
        inertia = operators.terms["H"] + operators.exterior
        factor = chosen.factor(csr_matrix(inertia[water][:, water]))

    def moved(columns: AnyArray) -> AnyArray:
        part = columns[u]
        momenta = np.zeros_like(columns, dtype=np.result_type(columns, float))
        momenta[u] = own @ part
        if factor is not None:
            flux = coupling.T @ part
            # one real factor: real and imaginary parts are solved for side by side
            pair = np.stack([flux.real, flux.imag], axis=-1).reshape(len(water), -1)
            both = factor.solve(pair).reshape(*flux.shape, 2)
            answer = both[..., 0] + 1j * both[..., 1] if np.iscomplexobj(flux) else both[..., 0]
            momenta[u] += coupling @ answer
        return momenta

    size = operators.size
    return LinearOperator((size, size), matvec=moved, matmat=moved, dtype=np.dtype(float))


def assurance(a: AnyArray, b: AnyArray, product: Product) -> FloatArray:
    """Modal assurance |a^H P b|^2 / ((a^H P a) (b^H P b)) of each pair (theory: S2-15).

    Parameters
    ----------
    a : (n_a, n) array
    b : (n_b, n) array
        Real or complex vectors, one a row.
    product : (n, n) csr_matrix or LinearOperator
        Mass of the structure, or with the water's (`wet_mass`); it leaves film pressure and
        potential out of account.

    Returns
    -------
    (n_a, n_b) array
        Between 0 and 1; 0 for a vector without mass.
    """
    if len(a) == 0 or len(b) == 0:
        return np.zeros((len(a), len(b)))
    own = np.einsum("ij,ij->i", a.conj(), (product @ a.T).T).real
    momenta = (product @ b.T).T
    other = np.einsum("ij,ij->i", b.conj(), momenta).real
    scale = np.outer(own, other)
    overlap = np.abs(a.conj() @ momenta.T) ** 2
    return np.asarray(np.divide(overlap, scale, out=np.zeros_like(scale), where=scale > 0.0))


def participation(response: AnyArray, modes: AnyArray, product: Product) -> FloatArray:
    """Share of each mode in the kinetic energy of a response (theory: S2-57).

    Parameters
    ----------
    response : (f, n) array
        Solutions, one a row.
    modes : (m, n) array
        Real modes; orthogonal in the product, so that shares add up to one at most.
    product : (n, n) csr_matrix or LinearOperator
        `wet_mass` for wet modes.

    Returns
    -------
    (f, m) array
    """
    return assurance(response, modes, product)


def match(a: AnyArray, b: AnyArray, product: Product, *, least: float = 0.3) -> Match:
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
