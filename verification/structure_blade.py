# SPDX-License-Identifier: LGPL-2.1-or-later
"""A solid tapered blade of second-order tetrahedra, for comparisons with other programs."""

from dataclasses import dataclass
from pathlib import Path

import gmsh
import ngsolve as ngs
import numpy as np

from quietblade.materials import Material
from quietblade.mesh import CellBlock
from quietblade.mesh.model import build_fem_mesh
from quietblade.propulsion.structure import Structure
from quietblade.typing import FloatArray, IntArray

_TETRA10, _TRIANGLE6 = 11, 9
_FROM_GMSH = (0, 1, 2, 3, 4, 5, 6, 7, 9, 8)
_CONTOUR = 31


@dataclass(frozen=True)
class TaperedBlade:
    """A straight blade along z with symmetric four-digit NACA sections and a blunt edge.

    Attributes
    ----------
    span, root_chord, tip_chord : float
        Lengths [m].
    thickness : float
        Thickness over chord.
    """

    span: float = 1.0
    root_chord: float = 0.3
    tip_chord: float = 0.15
    thickness: float = 0.12

    def contour(self, z: float) -> FloatArray:
        """Points (31, 3) around a section, from the trailing edge over the upper side [m]."""
        phi = np.linspace(-1.0, 1.0, _CONTOUR)
        xi = phi**2
        form = 0.2969 * np.abs(phi) - 0.126 * xi - 0.3516 * xi**2 + 0.2843 * xi**3 - 0.1015 * xi**4
        form += 0.03 * xi  # blunt trailing edge
        chord = self.root_chord + (self.tip_chord - self.root_chord) * z / self.span
        y = -np.sign(phi) * 5.0 * self.thickness * form
        return np.stack([chord * (xi - 0.5), chord * y, np.full(len(xi), z)], axis=1)


@dataclass(frozen=True, eq=False)
class TetrahedralMesh:
    """Ten-node tetrahedra and six-node triangles.

    Attributes
    ----------
    nodes : (n, 3) float array
        Places [m].
    cells : (m, 10) int array
        Nodes of the tetrahedra, VTK order.
    lower, rest, root : (k, 6) int arrays
        Triangles of the pressed face, of the other faces and of the clamped face.
    """

    nodes: FloatArray
    cells: IntArray
    lower: IntArray
    rest: IntArray
    root: IntArray

    def save(self, path: Path) -> None:
        """Write all arrays to an ``.npz`` file."""
        np.savez(path, **vars(self))

    @classmethod
    def load(cls, path: Path) -> "TetrahedralMesh":
        """Read what `save` wrote."""
        with np.load(path) as file:
            return cls(**file)

    def fem(self) -> ngs.Mesh:
        """Mesh with the region ``blade`` and the boundaries ``lower``, ``rest`` and ``root``."""
        faces = {"lower": self.lower, "rest": self.rest, "root": self.root}
        return build_fem_mesh(self.nodes, {"blade": (CellBlock("tetra10", self.cells),)}, faces)

    def structure(self, material: Material) -> Structure:
        """Clamp the root; pressure may act on the lower face."""
        return Structure(self.fem(), {"blade": material}, wetted="lower")

    def pressure(self, value: float) -> FloatArray:
        """Nodal pressures [Pa]: ``value`` on the lower face, zero elsewhere."""
        pressure = np.zeros(len(self.nodes))
        pressure[self.lower] = value
        return pressure


def mesh_blade(blade: TaperedBlade, size: float) -> TetrahedralMesh:
    """Mesh a blade with straight-edged second-order tetrahedra of about one size [m].

    Straight edges give every program the same polyhedron, and no cell can be inverted.
    """
    gmsh.initialize(interruptible=False)
    try:
        for option, value in {
            "General.Terminal": 0,
            "General.NumThreads": 1,
            "Mesh.SecondOrderLinear": 1,
            "Mesh.MeshSizeMin": size,
            "Mesh.MeshSizeMax": size,
        }.items():
            gmsh.option.setNumber(option, value)
        occ = gmsh.model.occ
        wires = []
        for z in (0.0, blade.span):
            points = [occ.addPoint(*x) for x in blade.contour(z)]
            nose = _CONTOUR // 2
            halves = [occ.addSpline(points[: nose + 1]), occ.addSpline(points[nose:])]
            wires.append(occ.addWire([*halves, occ.addLine(points[-1], points[0])]))
        ((_, solid),) = occ.addThruSections(wires, makeSolid=True, makeRuled=True)
        occ.synchronize()
        gmsh.model.mesh.generate(3)
        gmsh.model.mesh.setOrder(2)
        return _collect(blade, solid)
    finally:
        gmsh.finalize()


def _collect(blade: TaperedBlade, solid: int) -> TetrahedralMesh:
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    position = np.zeros((int(tags.max()) + 1, 3))
    position[tags] = coordinates.reshape(-1, 3)
    _, tetrahedra = gmsh.model.mesh.getElementsByType(_TETRA10, solid)
    cells = tetrahedra.astype(np.int64).reshape(-1, 10)[:, _FROM_GMSH]
    number = np.full(len(position), -1)
    used = np.unique(cells)
    number[used] = np.arange(len(used))
    faces: dict[str, list[IntArray]] = {"lower": [], "rest": [], "root": []}
    for _, face in gmsh.model.getBoundary([(3, solid)], oriented=False):
        _, nodes = gmsh.model.mesh.getElementsByType(_TRIANGLE6, face)
        triangles = number[nodes.astype(np.int64).reshape(-1, 6)]
        _, y, z = position[used][triangles].reshape(-1, 3).mean(axis=0)
        if z < 1e-9 * blade.span:
            faces["root"].append(triangles)
        elif y < -1e-3 * blade.root_chord:
            faces["lower"].append(triangles)
        else:
            faces["rest"].append(triangles)
    joined = {name: np.concatenate(parts) for name, parts in faces.items()}
    return TetrahedralMesh(position[used], number[cells], **joined)
