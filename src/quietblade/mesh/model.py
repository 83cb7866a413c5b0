# SPDX-License-Identifier: LGPL-2.1-or-later
"""The mesh as everybody sees it: nodes, cells by region, faces by name, and the NGSolve mesh."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import ngsolve as ngs
import numpy as np
from netgen.meshing import Element3D, FaceDescriptor, PointId
from netgen.meshing import Mesh as NetgenMesh

from quietblade.card import Card, Shown
from quietblade.errors import Notice
from quietblade.mesh.nodal import NodalBasis
from quietblade.typing import FloatArray, IntArray

REGIONS = ("blade", "film", "body", "water")
"""Materials of the mesh."""

BOUNDARIES = ("wet", "excited", "root", "inside", "outer")
"""Boundaries: wetted surface, its excited patch, clamped root face, hollow, outer sphere."""

EXCITED = r"excited\d*"
"""Name pattern of the excited patches: the first is "excited", then come "excited2" and so on."""

INTERFACE = f"wet|{EXCITED}"
"""Name pattern of the whole fluid-structure interface."""


def patch_name(number: int) -> str:
    """Name of the boundary of an excited patch, by its number from 0."""
    return "excited" if number == 0 else f"excited{number + 1}"


# Netgen's node order of second-order cells, from VTK's (which Mesh.cells uses).
_NETGEN_FROM_VTK = {
    "tetra10": (0, 1, 2, 3, 4, 6, 7, 5, 8, 9),
    "pyramid13": (3, 2, 1, 0, 4, 7, 5, 8, 6, 12, 11, 10, 9),
    "hexahedron20": (0, 1, 5, 4, 3, 2, 6, 7, 8, 12, 16, 17, 10, 14, 19, 18, 11, 9, 13, 15),
    "triangle6": (0, 1, 2, 4, 5, 3),
}


@dataclass(frozen=True)
class CellBlock:
    """Cells of one kind, VTK node order.

    Attributes
    ----------
    kind : str
        ``tetra10``, ``pyramid13``, ``hexahedron20``, or ``triangle6`` for faces.
    connectivity : (n, nodes) int array
        Node numbers of each cell.
    """

    kind: str
    connectivity: IntArray

    def __len__(self) -> int:
        return len(self.connectivity)


@dataclass(frozen=True)
class Quality:
    """Shape figures of the cells of one region.

    Attributes
    ----------
    worst, mean : float
        Least and mean signed inverse condition number (1: regular cell, 0: flat).
    least_jacobian : float
        Least ratio of the Jacobian determinant at a quadrature point to its mean in the cell;
        below zero the cell is inverted.
    """

    worst: float
    mean: float
    least_jacobian: float


@dataclass(frozen=True, repr=False)
class Mesh(Shown):
    """A conforming curved second-order mesh of blade, film and water in configuration C0.

    Attributes
    ----------
    nodes : (n, 3) float array
        Node positions [m], vertices and mid-edge nodes.
    cells : mapping
        Region name to its blocks of cells.
    faces : mapping
        Boundary name to its six-node triangles, (m, 6), VTK node order.
    centre : (3,) float array
        Centre of the outer sphere [m].
    radius : float
        Its radius [m].
    quality : mapping
        Region name to its `Quality`.
    notices : tuple of Notice
        Poor cells, and what else the user should know.
    """

    nodes: FloatArray
    cells: Mapping[str, tuple[CellBlock, ...]]
    faces: Mapping[str, IntArray]
    centre: FloatArray
    radius: float
    quality: Mapping[str, Quality] = field(default_factory=dict)
    notices: tuple[Notice, ...] = ()

    @cached_property
    def fem(self) -> ngs.Mesh:
        """The same mesh for NGSolve, with curved cells."""
        return build_fem_mesh(self.nodes, self.cells, self.faces)

    @cached_property
    def basis(self) -> NodalBasis:
        """Nodes as a basis of second-order fields; numbered like `nodes`."""
        return NodalBasis(self.fem)

    @cached_property
    def interface(self) -> IntArray:
        """Six-node triangles of the whole fluid-structure interface, (m, 6)."""
        return np.concatenate(
            [faces for name, faces in self.faces.items() if re.fullmatch(INTERFACE, name)]
        )

    def card(self) -> Card:
        """Cells and their quality by region."""
        rows = []
        for region, kinds in self.census().items():
            quality = self.quality.get(region)
            cells = ", ".join(f"{count} {kind}" for kind, count in kinds.items())
            rows.append((region, cells, f"{quality.worst:.2g}" if quality else "-"))
        rows.append(("sphere", f"radius {self.radius:g} m", ""))
        title = f"Mesh of {len(self.nodes)} nodes, second order"
        return Card(title, tuple(rows), ("region", "cells", "worst quality (1: regular)"))

    def census(self) -> dict[str, dict[str, int]]:
        """Count the cells of each region and kind."""
        return {
            region: {block.kind: len(block) for block in blocks}
            for region, blocks in self.cells.items()
        }


def build_fem_mesh(
    nodes: FloatArray,
    cells: Mapping[str, tuple[CellBlock, ...]],
    faces: Mapping[str, IntArray],
) -> ngs.Mesh:
    """Make the NGSolve mesh of second-order cells; node numbers become vertex numbers.

    Mid-edge nodes become vertices without cells (see `quietblade.mesh.nodal`).
    """
    netgen = NetgenMesh(dim=3)
    netgen.AddPoints(np.ascontiguousarray(nodes))
    for index, (region, blocks) in enumerate(cells.items(), start=1):
        for block in blocks:
            order = _NETGEN_FROM_VTK[block.kind]
            _add_cells(netgen, 3, index, block.connectivity[:, order])
        netgen.SetMaterial(index, region)
    for index, (name, triangles) in enumerate(faces.items(), start=1):
        netgen.Add(FaceDescriptor(surfnr=index, domin=1, domout=0, bc=index))
        netgen.SetBCName(index - 1, name)
        _add_cells(netgen, 2, index, triangles[:, _NETGEN_FROM_VTK["triangle6"]])
    return ngs.Mesh(netgen)


def _add_cells(netgen: NetgenMesh, dimension: int, index: int, nodes: IntArray) -> None:
    if nodes.shape[1] in (6, 10):
        data = np.ascontiguousarray(nodes, dtype=np.int32)
        netgen.AddElements(dim=dimension, index=index, data=data, base=0)
        return
    for cell in nodes + 1:  # netgen's array interface knows neither pyramid13 nor hexahedron20
        netgen.Add(Element3D(index, [PointId(node) for node in cell.tolist()]))
