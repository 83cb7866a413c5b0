# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cells of a structure in the element types of CalculiX and Abaqus.

Neither program has a pyramid of second order.  A pyramid becomes two ten-node tetrahedra; the new
node in the middle of its base moves as the eight-node face says, by linear constraints, so that the
faces fit and a state of uniform stress stays exact (theory: S1-69).
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import ngsolve as ngs
import numpy as np

from quietblade.errors import MeshError
from quietblade.mesh.nodal import NodalBasis
from quietblade.propulsion.cells import EDGES, EdgeNodes, cells_of
from quietblade.typing import FloatArray, IntArray

FACES: Mapping[str, tuple[tuple[int, ...], ...]] = {
    "C3D10": ((0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)),
    "C3D15": ((0, 1, 2), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)),
    "C3D20": (
        (0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0),
    ),
}  # fmt: skip
"""Corners of the faces P1, P2, ... of each element type."""

_TYPES = {ngs.TET: "C3D10", ngs.PRISM: "C3D15", ngs.HEX: "C3D20"}

# The same cell seen from the other side: corners in an order of positive volume.
_FLIPPED = {
    ngs.TET: (1, 0, 2, 3),
    ngs.PYRAMID: (0, 3, 2, 1, 4),
    ngs.PRISM: (3, 4, 5, 0, 1, 2),
    ngs.HEX: (4, 5, 6, 7, 0, 1, 2, 3),
}

_CORNER, _MIDDLE = -0.25, 0.5  # shape functions of the eight-node square at its centre


@dataclass(frozen=True, eq=False)
class Elements:
    """Elements of one type in one region.

    Attributes
    ----------
    region, kind : str
        Name of the region; C3D10, C3D15 or C3D20.
    numbers : (n,) int array
        Element numbers, from 1.
    nodes : (n, k) int array
        Node numbers from 0, corners first.
    rank : (n,) int array
        Cell of the region, in NGSolve's sequence, that each element is (a part of).
    """

    region: str
    kind: str
    numbers: IntArray
    nodes: IntArray
    rank: IntArray


@dataclass(frozen=True, eq=False)
class BaseNodes:
    """New nodes in the middle of pyramid bases, and what they depend on.

    Attributes
    ----------
    points : (m, 3) float array
        Places [m]; their numbers follow those of the nodal basis.
    masters : (m, 8) int array
        Nodes of each base, four corners and four middles.
    """

    points: FloatArray
    masters: IntArray

    weights = (4 * (_CORNER,)) + (4 * (_MIDDLE,))
    """Shares of the masters."""


def collect_elements(
    fem: ngs.Mesh, basis: NodalBasis, regions: list[str]
) -> tuple[list[Elements], BaseNodes]:
    """All cells of the regions as elements.

    Parameters
    ----------
    fem : ngsolve.Mesh
    basis : NodalBasis
        Its nodes.
    regions : list of str
        Names of the solid regions.
    """
    edge_nodes, bases = EdgeNodes(basis), _Bases(basis)
    elements: list[Elements] = []
    first = 1

    def add(region: str, kind: str, nodes: IntArray, rank: IntArray) -> None:
        nonlocal first
        elements.append(Elements(region, kind, first + np.arange(len(nodes)), nodes, rank))
        first += len(nodes)

    for region in regions:
        for block in cells_of(fem, region):
            corners = _positive(block.kind, block.corners, basis.points)
            nodes = edge_nodes.complete(block.kind, corners)
            if block.kind == ngs.PYRAMID:
                add(region, "C3D10", bases.split(nodes, edge_nodes), np.repeat(block.rank, 2))
            else:
                add(region, _TYPES[block.kind], nodes, block.rank)
    return elements, bases.finish()


def face_elements(elements: list[Elements], faces: IntArray) -> Iterator[tuple[int, int]]:
    """Element number and face number (from 1) of each face, given by its corners (n, 3 or 4).

    Raises
    ------
    MeshError
        If a face belongs to no element.
    """
    known: dict[tuple[int, ...], tuple[int, int]] = {}
    for block in elements:
        for number, corners in enumerate(FACES[block.kind], start=1):
            if len(corners) != faces.shape[1]:
                continue
            keys = np.sort(block.nodes[:, corners], axis=1)
            known.update(
                (tuple(key), (element, number))
                for key, element in zip(keys.tolist(), block.numbers.tolist(), strict=True)
            )
    for key in np.sort(faces, axis=1).tolist():
        if tuple(key) not in known:
            raise MeshError(
                f"deck: the loaded face with the corner nodes {key} is a face of no element; "
                "pressure on the base of a pyramid cannot be exported"
            )
        yield known[tuple(key)]


class _Bases:
    """Splits pyramids, with one diagonal for each base even if two pyramids share it."""

    def __init__(self, basis: NodalBasis) -> None:
        self._points = basis.points
        self._number: dict[tuple[int, ...], int] = {}
        self._masters: list[IntArray] = []

    def split(self, nodes: IntArray, edge_nodes: EdgeNodes) -> IntArray:
        """Ten nodes of the two tetrahedra of each pyramid (n, 13), as (2 n, 10)."""
        turn = np.argmin(nodes[:, :4], axis=1)  # the diagonal begins at the least corner
        around = (turn[:, None] + np.arange(4)) % 4
        a, b, c, d = np.take_along_axis(nodes[:, :4], around, axis=1).T
        apex, middle = nodes[:, 4], np.array([self._middle(row) for row in nodes[:, :9]])
        tetrahedra = [np.stack(corners, axis=1) for corners in ((a, b, c, apex), (a, c, d, apex))]
        # the edge a-c is the diagonal: no edge of the mesh
        places = [2, 0]
        split = []
        for corners, diagonal in zip(tetrahedra, places, strict=True):
            ends = corners[:, np.array(EDGES[ngs.TET])]
            ends[:, diagonal] = ends[:, 3]
            edges = edge_nodes.middles(ends)
            edges[:, diagonal] = middle
            split.append(np.concatenate([corners, edges], axis=1))
        return np.stack(split, axis=1).reshape(-1, 10)

    def finish(self) -> BaseNodes:
        masters = np.array(self._masters, dtype=np.int64).reshape(-1, 8)
        points = np.einsum("k,mkd->md", np.array(BaseNodes.weights), self._points[masters])
        return BaseNodes(points, masters)

    def _middle(self, nodes: IntArray) -> int:
        base = np.concatenate([nodes[:4], nodes[5:9]])
        key = tuple(sorted(nodes[:4].tolist()))
        if key not in self._number:
            self._number[key] = len(self._points) + len(self._masters)
            self._masters.append(base)
        return self._number[key]


def _positive(kind: ngs.ET, corners: IntArray, points: FloatArray) -> IntArray:
    """Corners in an order in which every cell has a positive volume."""
    x = points[corners]
    origin, ends = {
        ngs.TET: (0, (1, 2, 3)),
        ngs.PYRAMID: (0, (1, 3, 4)),
        ngs.PRISM: (0, (1, 2, 3)),
        ngs.HEX: (0, (1, 3, 4)),
    }[kind]
    volume = np.linalg.det(x[:, ends] - x[:, origin, None])
    positive: IntArray = np.where(volume[:, None] > 0.0, corners, corners[:, _FLIPPED[kind]])
    return positive
