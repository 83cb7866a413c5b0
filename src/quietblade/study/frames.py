# SPDX-License-Identifier: LGPL-2.1-or-later
"""Axes in which modes are named and compared: of a blade's sections, or of the mesh."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from scipy.interpolate import make_interp_spline

from quietblade.flow.sections import DeformedSections
from quietblade.geometry import Blade
from quietblade.mesh import Mesh
from quietblade.mesh.surface import SurfaceQuadrature
from quietblade.typing import AnyArray, BoolArray, FloatArray, IntArray
from quietblade.vibroacoustics.degree_naming import name_by_degree
from quietblade.vibroacoustics.naming import name_modes


class Names(Protocol):
    """Names of a set of modes, no two alike."""

    @property
    def name(self) -> tuple[str, ...]:
        """One a mode."""

    @property
    def character(self) -> Sequence[str]:
        """Word for the kind of each mode."""

    @property
    def purity(self) -> FloatArray:
        """Share of each mode in the kind of its name, (m,)."""

    @property
    def shares(self) -> FloatArray:
        """Shares of the families of a blade's modes, (m, 4); nan of another body."""


class Frames(Protocol):
    """Axes at nodes of the solid in which modes are named and compared."""

    @property
    def nodes(self) -> IntArray:
        """Nodes of the mesh, (n,)."""

    def shapes(self, moved: AnyArray) -> AnyArray:
        """Displacements (m, nodes of the mesh, 3) in these axes, (m, n, 3)."""

    def placed(self, shapes: AnyArray) -> AnyArray:
        """Displacements (m, n, 3) in these axes, in those of the mesh (m, n, 3)."""

    def names(self, shapes: FloatArray, masses: FloatArray, rigid: BoolArray) -> Names:
        """Name modes by their shapes (m, n, 3), by the masses of the nodes (n,)."""


@dataclass(frozen=True, eq=False)
class SectionFrames:
    """Where the nodes of the solid are in the blade's sections, and how these stand.

    Attributes
    ----------
    nodes : (n,) int array
        Nodes of the mesh that belong to the solid.
    span, chord : (n,) arrays
        Their span and chord fractions on the undeformed blade.
    axes : (n, 3, 3) array
        Rows: unit vectors along the chord, along the normal and along the span.
    """

    nodes: IntArray
    span: FloatArray
    chord: FloatArray
    axes: FloatArray

    @classmethod
    def of(cls, blade: Blade, mesh: Mesh, sections: DeformedSections | None) -> "SectionFrames":
        """Frames of the undeformed blade, or of deformed sections at even steps of the span."""
        nodes = mesh.basis.nodes_of("|".join(r for r in mesh.cells if r != "water"))
        s, xi, _ = blade.locate(mesh.nodes[nodes])
        if sections is None:
            _, chordwise, normal = blade.frame(s)
            axes = np.stack([chordwise, normal, np.cross(chordwise, normal)], axis=1)
        else:
            rows = np.stack([sections.chord_direction, sections.normal, sections.tangent], axis=1)
            stations = np.linspace(0.0, 1.0, len(rows))
            axes = make_interp_spline(stations, rows, k=1)(np.clip(s, 0.0, 1.0))
        return cls(nodes, s, xi, np.asarray(axes))

    def shapes(self, moved: AnyArray) -> AnyArray:
        """Displacements (m, nodes of the mesh, 3) in the sections' axes, (m, n, 3)."""
        return np.asarray(np.einsum("nai,mni->mna", self.axes, moved[:, self.nodes]))

    def placed(self, shapes: AnyArray) -> AnyArray:
        """Displacements (m, n, 3) in the sections' axes, in those of the blade (m, n, 3)."""
        return np.asarray(np.einsum("nai,mna->mni", self.axes, shapes))

    def names(self, shapes: FloatArray, masses: FloatArray, rigid: BoolArray) -> Names:
        """Name modes by the motion of the sections; a blade that is held has no rigid ones."""
        del rigid
        return name_modes(self.span, self.chord, shapes, masses)


@dataclass(frozen=True, eq=False)
class SphereFrames:
    """Nodes on the outer surface of a spherical shell, in the axes of the mesh.

    Attributes
    ----------
    nodes : (n,) int array
        Nodes of the mesh on the surface.
    points : (n, 3) float array
        Where they are [m].
    triangles : (t, 6) int array
        Triangles of the surface, by places in ``nodes``.
    """

    nodes: IntArray
    points: FloatArray
    triangles: IntArray

    @classmethod
    def of(cls, mesh: Mesh) -> "SphereFrames":
        """Take the wetted surface of a mesh."""
        nodes, triangles = np.unique(mesh.interface, return_inverse=True)
        return cls(nodes, mesh.nodes[nodes], triangles.reshape(mesh.interface.shape))

    def shapes(self, moved: AnyArray) -> AnyArray:
        """Displacements (m, nodes of the mesh, 3) of the surface, (m, n, 3)."""
        return moved[:, self.nodes]

    def placed(self, shapes: AnyArray) -> AnyArray:
        """Return the shapes: their axes are those of the mesh."""
        return shapes

    def names(self, shapes: FloatArray, masses: FloatArray, rigid: BoolArray) -> Names:
        """Name modes by the degree of the surface's motion."""
        del masses
        return name_by_degree(SurfaceQuadrature(self.points, self.triangles), shapes, rigid)
