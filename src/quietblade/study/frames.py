# SPDX-License-Identifier: LGPL-2.1-or-later
"""Axes of the blade's sections at the nodes of the solid, at rest and deformed."""

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import make_interp_spline

from quietblade.flow.sections import DeformedSections
from quietblade.geometry import Blade
from quietblade.mesh import Mesh
from quietblade.typing import AnyArray, FloatArray, IntArray


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
