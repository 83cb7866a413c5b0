# SPDX-License-Identifier: LGPL-2.1-or-later
"""A flat cantilever in a stream, as heavy as the water that it carries along."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import csr_matrix

from quietblade.materials import IsotropicSVK
from quietblade.mesh.surface import SurfaceQuadrature
from quietblade.propulsion.structure import Structure
from quietblade.propulsion.tangent import compute_tangent
from quietblade.typing import FloatArray
from quietblade.vibroacoustics.flow_damping import Strips, add_stream, strip_motion
from quietblade.vibroacoustics.operators import Operators
from quietblade.vibroacoustics.point_loads import surface_of
from quietblade.vibroacoustics.vacuum import dry_operators
from verification.structure_models import box_mesh


@dataclass(frozen=True, eq=False)
class StripInStream:
    """A plate along z with its chord along x, clamped at z = 0, without Poisson's effect.

    The solid has the mass pi rho b^2 per span, that of the water around a section: the strip stands
    for a light one in water, whose loss factor in bending is W/(b omega) at any frequency.

    Attributes
    ----------
    span, chord, thickness : float
        [m]
    young : float
        [Pa]
    speed : float
        W [m/s].
    density : float
        Of the water [kg/m3].
    strips : int
        Number of sections.
    """

    span: float = 1.0
    chord: float = 0.1
    thickness: float = 0.01
    young: float = 70e9
    speed: float = 4.0
    density: float = 1000.0
    strips: int = 31

    @cached_property
    def structure(self) -> Structure:
        """The plate."""
        b, t = 0.5 * self.chord, self.thickness
        mesh = box_mesh(
            np.linspace(-b, b, 3), np.array([-0.5, 0.5]) * t, np.linspace(0.0, self.span, 21),
            tetrahedra=True,
        )  # fmt: skip
        own = np.pi * self.density * b**2 / (self.chord * t)
        material = IsotropicSVK("plate", own, self.young, 0.0)
        return Structure(mesh, {"blade": material}, wetted="lower|upper")

    @cached_property
    def still(self) -> Operators:
        """Without the stream."""
        structure = self.structure
        tangent = compute_tangent(structure, structure.rest())
        return dry_operators(
            stiffness=tangent.stiffness(), mass=tangent.mass, free=tangent.free,
            displacements=structure.forms.n_displacement,
        )  # fmt: skip

    @property
    def surface(self) -> SurfaceQuadrature:
        """Lower and upper side."""
        return surface_of(self.structure.basis, "lower|upper")

    @cached_property
    def sections(self) -> Strips:
        """Sections at equal distances."""
        s = np.linspace(0.0, 1.0, self.strips)
        one, zero = np.ones_like(s), np.zeros_like(s)
        return Strips(
            span=s,
            length=s * self.span,
            middle=np.stack([zero, zero, s * self.span], axis=1),
            chordwise=np.stack([one, zero, zero], axis=1),
            normal=np.stack([zero, one, zero], axis=1),
            chord=self.chord * one,
            speed=self.speed * one,
        )

    @cached_property
    def motion(self) -> csr_matrix:
        """Normal motion of the sections at 3/4 chord, from nodal displacements."""
        points = self.structure.basis.points
        return strip_motion(
            self.sections, points, points[:, 2] / self.span, self.surface.nodal_areas()
        )

    @cached_property
    def operators(self) -> Operators:
        """With the stream."""
        return add_stream(
            self.still, self.structure.basis, self.sections, self.motion, self.density
        )

    def loss(self, frequency: FloatArray) -> FloatArray:
        """W/(b omega) at frequencies [Hz]."""
        return np.asarray(self.speed / (0.5 * self.chord * 2.0 * np.pi * np.asarray(frequency)))
