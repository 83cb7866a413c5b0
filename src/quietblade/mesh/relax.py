# SPDX-License-Identifier: LGPL-2.1-or-later
"""Corners of poor cells put where no cell around them is poor."""

import numpy as np
from scipy.optimize import minimize
from scipy.special import logsumexp, softmax

from quietblade.mesh.quality import TETRA_EDGES, jacobian_derivatives, tetrahedron_jacobians
from quietblade.typing import BoolArray, FloatArray, IntArray

_SHARPNESS = 10.0  # of the soft minimum: a cell of half its volume counts e^5 times a whole one
_ROUNDS = 3


def relax_cells(
    nodes: FloatArray,
    cells: IntArray,
    reference: FloatArray,
    fixed: BoolArray,
    least: float,
) -> FloatArray:
    """Move the free corners of cells whose Jacobian is small somewhere, edges staying straight.

    What is sought is the largest (soft) minimum of the Jacobian over all cells around these
    corners, each in terms of its volume before the mesh was moved.

    Parameters
    ----------
    nodes : (n, 3) float array
        Positions [m].
    cells : (m, 10) int array
        Second-order tetrahedra, VTK node order.
    reference : (m,) float array
        Mean Jacobian of each cell before the motion, above zero [m^3].
    fixed : (n,) bool array
        Nodes that must stay, as those of the surfaces.
    least : float
        Ratio of least to mean Jacobian that a cell shall have.

    Returns
    -------
    (n, 3) float array
        Positions; the given ones where nothing can be moved.
    """
    placed = nodes
    for _ in range(_ROUNDS):
        jacobians = tetrahedron_jacobians(placed, cells)
        poor = jacobians.min(axis=1) < least * np.abs(jacobians.mean(axis=1))
        free = np.unique(cells[poor, :4])
        free = free[~fixed[free]]
        if len(free) == 0:
            break
        around = np.flatnonzero(np.isin(cells[:, :4], free).any(axis=1))
        placed = _relaxed(placed, cells[around], reference[around], fixed, free)
    return placed


def _relaxed(
    nodes: FloatArray, cells: IntArray, reference: FloatArray, fixed: BoolArray, free: IntArray
) -> FloatArray:
    """Best places of some corners; numbers are of the cells around them only."""
    used, local = np.unique(cells, return_inverse=True)
    local = local.reshape(cells.shape)
    start, moved = nodes[used], np.searchsorted(used, free)
    middle, first, second = _free_edges(local, fixed[used])
    size = float(np.cbrt(reference.min()))

    def placed(unknowns: FloatArray) -> FloatArray:
        positions = start.copy()
        positions[moved] += size * unknowns.reshape(-1, 3)
        positions[middle] = 0.5 * (positions[first] + positions[second])
        return positions

    def cost(unknowns: FloatArray) -> tuple[float, FloatArray]:
        positions = placed(unknowns)
        exponent = -_SHARPNESS * tetrahedron_jacobians(positions, local) / reference[:, None]
        weights = -_SHARPNESS * softmax(exponent) / reference[:, None]
        slope = np.zeros_like(start)
        np.add.at(slope, local, jacobian_derivatives(positions, local, weights))
        for corner in (first, second):
            np.add.at(slope, corner, 0.5 * slope[middle])
        return float(logsumexp(exponent)), size * slope[moved].ravel()

    found = minimize(cost, np.zeros(3 * len(moved)), jac=True, method="BFGS")
    positions = nodes.copy()
    positions[used] = placed(found.x)
    return positions


def _free_edges(cells: IntArray, held: BoolArray) -> tuple[IntArray, IntArray, IntArray]:
    """Mid-edge nodes that are not held, each once, and the two corners of each."""
    edges = np.concatenate([cells[:, [4 + k, a, b]] for k, (a, b) in enumerate(TETRA_EDGES)])
    _, once = np.unique(edges[:, 0], return_index=True)
    middle, first, second = edges[once[~held[edges[once, 0]]]].T
    return middle, first, second
