# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cells of the solid as lists of nodes: corners, then the middles of the edges."""

from collections.abc import Iterator
from dataclasses import dataclass

import ngsolve as ngs
import numpy as np

from quietblade.mesh.nodal import NodalBasis
from quietblade.typing import FloatArray, IntArray

EDGES = {
    ngs.TET: ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)),
    ngs.PYRAMID: ((0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 4), (2, 4), (3, 4)),
    ngs.PRISM: ((0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)),
    ngs.HEX: (
        (0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4),
        (0, 4), (1, 5), (2, 6), (3, 7),
    ),
}  # fmt: skip
"""Ends of the edges of each kind of cell, in VTK's and Abaqus' order of the mid-edge nodes."""

CORNERS = {
    ngs.TET: ((1, 0, 0), (0, 1, 0), (0, 0, 1), (0, 0, 0)),
    ngs.PYRAMID: ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1)),
    ngs.PRISM: ((1, 0, 0), (0, 1, 0), (0, 0, 0), (1, 0, 1), (0, 1, 1), (0, 0, 1)),
    ngs.HEX: (
        (0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1),
    ),
}  # fmt: skip
"""Reference coordinates of the corners in NGSolve's order."""


@dataclass(frozen=True, eq=False)
class Cells:
    """All cells of one kind in a region.

    Attributes
    ----------
    kind : ngsolve.ET
        TET, PYRAMID, PRISM or HEX.
    rank : (n,) int array
        Place of each cell in NGSolve's sequence of the region's cells.
    corners : (n, k) int array
        Node numbers in the nodal basis, NGSolve's order.
    """

    kind: ngs.ET
    rank: IntArray
    corners: IntArray


def cells_of(fem: ngs.Mesh, region: str) -> Iterator[Cells]:
    """Cells of a region by kind.

    Raises
    ------
    ValueError
        If the mesh has no such region.
    """
    where = fem.Materials(region)
    if not any(where.Mask()):
        raise ValueError(f"the mesh has no region {region!r}; it has {fem.GetMaterials()}")
    found: dict[ngs.ET, tuple[list[int], list[list[int]]]] = {}
    for rank, element in enumerate(where.Elements()):
        ranks, corners = found.setdefault(element.type, ([], []))
        ranks.append(rank)
        corners.append([vertex.nr for vertex in element.vertices])
    for kind, (ranks, corners) in found.items():
        yield Cells(kind, np.array(ranks), np.array(corners))


class EdgeNodes:
    """Finds the node in the middle of the edge between two nodes.

    Parameters
    ----------
    basis : NodalBasis
        Nodes of the mesh.
    """

    def __init__(self, basis: NodalBasis) -> None:
        self._count = len(basis.points)
        keys = self._key(basis.edge_ends)
        order = np.argsort(keys)
        self._keys, self._nodes = keys[order], basis.edge_nodes[order]

    def middles(self, ends: IntArray) -> IntArray:
        """Nodes (...,) in the middle of edges (..., 2) of the mesh."""
        middles: IntArray = self._nodes[np.searchsorted(self._keys, self._key(ends))]
        return middles

    def complete(self, kind: ngs.ET, corners: IntArray) -> IntArray:
        """Corners (n, k) followed by the middles of the edges, in the order of `EDGES`."""
        ends = corners[:, np.array(EDGES[kind])]
        return np.concatenate([corners, self.middles(ends)], axis=1)

    def _key(self, ends: IntArray) -> IntArray:
        key: IntArray = np.min(ends, axis=-1) * self._count + np.max(ends, axis=-1)
        return key


def node_places(kind: ngs.ET) -> FloatArray:
    """Return the reference coordinates of corners and mid-edge nodes, (nodes, 3)."""
    corners = np.array(CORNERS[kind], dtype=float)
    return np.concatenate([corners, corners[np.array(EDGES[kind])].mean(axis=1)])
