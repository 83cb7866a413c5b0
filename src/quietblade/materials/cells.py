# SPDX-License-Identifier: LGPL-2.1-or-later
"""Functions that jump inside cells, as polynomials with the same moments in each cell.

The quadrature of a finite element knows nothing of a jump inside its cell.  The polynomial of
degree 2 that fits a function best in a cell has the same integrals against all polynomials of
degree 2; where strains are linear, as in a tetrahedron of second order, the energy is exact.

Cells are divided into small tetrahedra, in which the levels at which the function jumps are planes;
what lies beyond a plane is integrated exactly.
"""

from collections.abc import Sequence
from functools import cache
from itertools import permutations

import ngsolve as ngs
import numpy as np

from quietblade.typing import BoolArray, FloatArray, IntArray

_PARTS = 2  # of an edge: levels of second order have their nodes there
_KINDS = (ngs.TET, ngs.PYRAMID, ngs.PRISM, ngs.HEX)


def fit_in_cells(
    fem: ngs.Mesh,
    region: str,
    levels: Sequence[ngs.CoefficientFunction],
    jumps: FloatArray,
) -> list[ngs.GridFunction]:
    """Fit sums of steps in each cell of a region.

    Parameters
    ----------
    fem : ngsolve.Mesh
    region : str
        Name pattern of the materials.
    levels : sequence of CoefficientFunction
        The l-th step is 1 where the l-th level is positive, and 0 elsewhere.
    jumps : (n, 1 + levels) float array
        The functions: a constant, and the height of each step.

    Returns
    -------
    list of GridFunction
        n discontinuous fields of order 2; zero outside the region.
    """
    where = fem.Materials(region)
    space = ngs.L2(fem, order=2, definedon=where)
    fits = [ngs.GridFunction(space) for _ in jumps]
    if not levels:
        for fit, constant in zip(fits, jumps[:, 0], strict=True):
            fit.Set(float(constant), definedon=where)
        return fits
    cells = list(where.Elements())
    kinds = [cell.type for cell in cells]
    for kind, values in _at_corners(fem, where, kinds, levels).items():
        moments = np.empty((len(values), 10, 1 + len(levels)))
        moments[:, :, 0] = _moments(_simplices(kind)).sum(axis=0)
        for column in range(len(levels)):
            moments[:, :, column + 1] = _positive_moments(kind, values[:, :, column])
        numbers = [ngs.ElementId(cell) for cell in cells if cell.type == kind]
        _set(space, fits, kind, numbers, moments @ jumps.T)
    return fits


def _at_corners(
    fem: ngs.Mesh, where: ngs.Region, kinds: list[ngs.ET], levels: Sequence[ngs.CoefficientFunction]
) -> dict[ngs.ET, FloatArray]:
    """Levels at the corners of the small tetrahedra: (cells, corners, levels) for each kind."""
    corners = {kind: _lattice(kind)[0] for kind in _KINDS}
    rules = {k: ngs.IntegrationRule(p.tolist(), [1.0] * len(p)) for k, p in corners.items()}
    places = fem.MapToAllElements(rules, where)
    flat = np.stack([np.asarray(level(places)).ravel() for level in levels], axis=-1)
    counts = np.array([len(corners[kind]) for kind in kinds])
    starts = np.cumsum(counts) - counts
    return {
        kind: flat[starts[[k == kind for k in kinds]][:, None] + np.arange(len(corners[kind]))]
        for kind in set(kinds)
    }


def _set(
    space: ngs.L2,
    fits: Sequence[ngs.GridFunction],
    kind: ngs.ET,
    cells: Sequence[ngs.ElementId],
    moments: FloatArray,
) -> None:
    """Set the unknowns of cells of one kind so that the fields have these moments."""
    rule = ngs.IntegrationRule(kind, 4)
    points, weights = np.array(rule.points), np.array(rule.weights)
    monomials = _monomials(points)
    gram = monomials.T @ (weights[:, None] * monomials)
    wanted = monomials @ np.linalg.solve(gram, moments)
    # the shape functions depend on the numbers of the cell's vertices: ask them once a sorting
    known: dict[tuple[int, ...], FloatArray] = {}
    unknowns = [fit.vec.FV().NumPy() for fit in fits]
    for cell, values in zip(cells, wanted, strict=True):
        order = tuple(np.argsort([v.nr for v in space.mesh[cell].vertices]))
        if order not in known:
            element = space.GetFE(cell)
            shapes = np.array([np.array(element.CalcShape(*p)) for p in points])
            known[order] = np.linalg.pinv(shapes)
        dofs = list(space.GetDofNrs(cell))
        for vector, column in zip(unknowns, (known[order] @ values).T, strict=True):
            vector[dofs] = column


def _positive_moments(kind: ngs.ET, level: FloatArray) -> FloatArray:
    """Moments (cells, 10) of the part of each cell in which the level is positive."""
    corners, members = _lattice(kind)
    at = level[:, members]
    simplices = np.broadcast_to(corners[members], (*at.shape, 3))
    above = np.count_nonzero(at > 0.0, axis=-1)
    total = np.einsum("ct,tm->cm", (above >= 3).astype(float), _moments(_simplices(kind)))
    order = np.argsort(-at, axis=-1)
    for count in (1, 2, 3):
        cell, simplex = np.nonzero(above == count)
        if len(cell) == 0:
            continue
        sort = order[cell, simplex]
        v = np.take_along_axis(at[cell, simplex], sort, axis=1)
        P = np.take_along_axis(simplices[cell, simplex], sort[..., None], axis=1)
        for part in _parts(count, v, P):
            np.add.at(total, cell, (-1.0 if count == 3 else 1.0) * _moments(part))
    return np.asarray(total)


def _parts(count: int, v: FloatArray, P: FloatArray) -> list[FloatArray]:
    """Tetrahedra of a cut one: the positive part, or for three positive corners the negative one.

    Values (n, 4) fall; corners (n, 4, 3).
    """

    def cut(i: int, j: int) -> FloatArray:
        t = (v[:, i] / (v[:, i] - v[:, j]))[:, None]
        return np.asarray((1.0 - t) * P[:, i] + t * P[:, j])

    a, b, _, d = (P[:, i] for i in range(4))
    if count == 1:
        return [np.stack([a, cut(0, 1), cut(0, 2), cut(0, 3)], axis=1)]
    if count == 3:
        return [np.stack([d, cut(0, 3), cut(1, 3), cut(2, 3)], axis=1)]
    ac, ad, bc, bd = cut(0, 2), cut(0, 3), cut(1, 2), cut(1, 3)
    return [np.stack(t, axis=1) for t in ((a, ac, ad, bd), (a, ac, bc, bd), (a, b, bc, bd))]


def _moments(simplices: FloatArray) -> FloatArray:
    """Integrals (n, 10) of 1, x, y, z, xx, yy, zz, yz, xz, xy over tetrahedra (n, 4, 3)."""
    edges = simplices[:, 1:] - simplices[:, :1]
    volume = np.abs(np.linalg.det(edges)) / 6.0
    first = simplices.sum(axis=1)
    second = np.einsum("nvi,nvj->nij", simplices, simplices) + first[:, :, None] * first[:, None]
    i, j = np.array(_SECOND).T
    means = [np.ones((len(volume), 1)), first / 4.0, second[:, i, j] / 20.0]
    return np.asarray(volume[:, None] * np.concatenate(means, axis=1))


_SECOND = ((0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1))


def _monomials(points: FloatArray) -> FloatArray:
    i, j = np.array(_SECOND).T
    return np.concatenate([np.ones((len(points), 1)), points, points[:, i] * points[:, j]], axis=1)


@cache
def _simplices(kind: ngs.ET) -> FloatArray:
    """Small tetrahedra (n, 4, 3) that fill the reference cell (Kuhn's division of a grid)."""
    line = np.arange(_PARTS)
    grid = np.stack(np.meshgrid(line, line, line, indexing="ij"), axis=-1).reshape(-1, 1, 3)
    paths = []
    for order in permutations(range(3)):
        path = np.zeros((4, 3))
        for step, axis in enumerate(order, start=1):
            path[step:, axis] = 1.0
        paths.append(path)
    cube = (np.concatenate([grid + path for path in paths]) / _PARTS).astype(float)
    return _placed(kind, cube[_inside(kind, cube.mean(axis=1))])


@cache
def _lattice(kind: ngs.ET) -> tuple[FloatArray, IntArray]:
    """Corners (m, 3) of the small tetrahedra, and their numbers (n, 4)."""
    simplices = _simplices(kind)
    corners, members = np.unique(simplices.reshape(-1, 3), axis=0, return_inverse=True)
    return corners, np.asarray(members).reshape(-1, 4)


def _inside(kind: ngs.ET, points: FloatArray) -> BoolArray:
    """Which points of the unit cube belong to the piece that makes a cell."""
    x, y, z = points.T
    if kind == ngs.TET:
        return np.asarray((x > y) & (y > z))
    if kind == ngs.PRISM:
        return np.asarray(x > y)
    if kind == ngs.PYRAMID:
        return np.asarray(z < np.minimum(x, y))
    return np.ones(len(points), dtype=bool)


def _placed(kind: ngs.ET, points: FloatArray) -> FloatArray:
    """Map the piece of the unit cube linearly to the reference cell, (..., 3)."""
    x, y, z = np.moveaxis(points, -1, 0)
    if kind == ngs.TET:
        return np.stack([x - y, y - z, z], axis=-1)
    if kind == ngs.PRISM:
        return np.stack([x - y, y, z], axis=-1)
    if kind == ngs.PYRAMID:
        return np.stack([1.0 - x, 1.0 - y, z], axis=-1)
    return points
