# SPDX-License-Identifier: LGPL-2.1-or-later
"""Edges of the outer faces of second-order cells, as curved lines for pictures of a mesh."""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import pyvista as pv

from quietblade.results.vtk import CELL_TYPES
from quietblade.typing import IntArray

_POINTS = 5  # as many as `curved_surface` has along an edge


@dataclass(frozen=True)
class _Cell:
    """Corners of the faces, and the ends of the edges in the order of the mid-edge nodes."""

    corners: int
    faces: tuple[tuple[int, ...], ...]
    edges: tuple[tuple[int, int], ...]

    def middle(self, a: int, b: int) -> int:
        """Node in the middle of an edge."""
        return self.corners + self.edges.index((min(a, b), max(a, b)))


# VTK's numbering (VTK User's Guide, quadratic cells)
_CELLS: Mapping[int, _Cell] = {
    CELL_TYPES["tetra10"]: _Cell(
        4,
        ((0, 1, 2), (0, 1, 3), (1, 2, 3), (0, 2, 3)),
        ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)),
    ),
    CELL_TYPES["pyramid13"]: _Cell(
        5,
        ((0, 1, 2, 3), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)),
        ((0, 1), (1, 2), (2, 3), (0, 3), (0, 4), (1, 4), (2, 4), (3, 4)),
    ),
    CELL_TYPES["hexahedron20"]: _Cell(
        8,
        ((0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)),
        ((0, 1), (1, 2), (2, 3), (0, 3), (4, 5), (5, 6), (6, 7), (4, 7),
         (0, 4), (1, 5), (2, 6), (3, 7)),
    ),
}  # fmt: skip


def outer_edges(grid: pv.UnstructuredGrid) -> pv.PolyData:
    """Edges of the faces that belong to one cell only.

    Parameters
    ----------
    grid : UnstructuredGrid
        Cells of kinds ``tetra10``, ``pyramid13`` and ``hexahedron20``.

    Returns
    -------
    PolyData
        Each edge as a line of `_POINTS` points on its parabola.
    """
    faces, edges = _faces(grid)
    _, first, count = np.unique(faces, axis=0, return_index=True, return_counts=True)
    lines = edges[first[count == 1]].reshape(-1, 3)
    backwards = lines[:, 0] > lines[:, 2]
    lines[backwards] = lines[backwards, ::-1]
    ends = np.moveaxis(grid.points[np.unique(lines, axis=0)], 1, 0)
    t = np.linspace(0.0, 1.0, _POINTS)[:, None]
    weights = ((1.0 - t) * (1.0 - 2.0 * t), 4.0 * t * (1.0 - t), t * (2.0 * t - 1.0))
    curves = sum(w * node[:, None, :] for w, node in zip(weights, ends, strict=True))
    points = np.reshape(curves, (-1, 3))
    numbers = np.arange(len(points)).reshape(-1, _POINTS)
    return pv.PolyData(points, lines=np.c_[np.full(len(numbers), _POINTS), numbers].ravel())


def _faces(grid: pv.UnstructuredGrid) -> tuple[IntArray, IntArray]:
    """Sorted corners of every face of every cell, (n, 4), and its edges, (n, 4, 3).

    A triangle has a corner -1, and its first edge twice.
    """
    corners, edges = [], []
    for kind, nodes in grid.cells_dict.items():
        cell = _CELLS[int(kind)]
        for face in cell.faces:
            closed = (*face, face[0], face[1])[:5]
            own = np.full((len(nodes), 4), -1)
            own[:, : len(face)] = nodes[:, face]
            corners.append(np.sort(own, axis=1))
            ring = [(a, cell.middle(a, b), b) for a, b in pairwise(closed)]
            edges.append(nodes[:, ring])
    return np.concatenate(corners), np.concatenate(edges)
