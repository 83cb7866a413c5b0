# SPDX-License-Identifier: LGPL-2.1-or-later
"""A small plate with a root, in water and in vacuo, whose loads and supports can be chosen."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import ngsolve as ngs
import numpy as np
from scipy.sparse import csr_matrix

from quietblade.linalg import make_solver
from quietblade.materials.viscoelastic import ConstantLoss, ModulusRatio
from quietblade.mesh.nodal import NodalBasis
from quietblade.mesh.surface import SurfaceQuadrature
from quietblade.typing import AnyArray, ComplexArray, FloatArray
from quietblade.vibroacoustics.fluid import Water
from quietblade.vibroacoustics.loss import Lossy
from quietblade.vibroacoustics.operators import Operators, build_operators
from quietblade.vibroacoustics.point_loads import surface_of
from quietblade.vibroacoustics.radiation import Bgt1, RadiationCondition
from quietblade.vibroacoustics.root import RootedSystem, add_root
from quietblade.vibroacoustics.sweep import solve_point
from verification.acoustics_body import plate_mesh
from verification.acoustics_models import WATER, Elastic, linear_elastic


@dataclass(frozen=True, eq=False)
class WetPlate:
    """A plate along z, clamped at its lower end, in a sphere of water.

    Attributes
    ----------
    sides : (3,) tuple of float
        Extent along x, y and z [m]; its centre is the origin.
    solid : Elastic
    ratio : ModulusRatio
        Complex modulus over the static one.
    size : float
        Edge length on the plate [m].
    radius : float
        Of the sphere [m].
    water : Water
    condition : RadiationCondition
        On the sphere.
    """

    sides: tuple[float, float, float] = (0.2, 0.03, 0.5)
    solid: Elastic = field(default_factory=lambda: Elastic(3.0e9, 0.3, 1300.0))
    ratio: ModulusRatio = field(default_factory=lambda: ConstantLoss(0.02))
    size: float = 0.12
    radius: float = 0.5
    water: Water = WATER
    condition: RadiationCondition = field(default_factory=Bgt1)

    @cached_property
    def fem(self) -> ngs.Mesh:
        """The mesh."""
        return plate_mesh((self.radius,), self.radius, self.size, self.sides)

    @cached_property
    def basis(self) -> NodalBasis:
        """Its nodes."""
        return NodalBasis(self.fem)

    @cached_property
    def surface(self) -> SurfaceQuadrature:
        """Wetted surface."""
        return surface_of(self.basis, "wet|excited")

    @cached_property
    def matrices(self) -> tuple[csr_matrix, csr_matrix]:
        """Stiffness and mass."""
        return linear_elastic(self.fem, self.solid, "blade")

    @property
    def loss(self) -> Mapping[str, Lossy]:
        """The plate's complex modulus."""
        return {"blade": Lossy(self.matrices[0], self.ratio)}

    @property
    def root(self) -> FloatArray:
        """Middle of the clamped end [m]."""
        return np.array([0.0, 0.0, -0.5 * self.sides[2]])

    @cached_property
    def operators(self) -> Operators:
        """The clamped plate in water."""
        stiffness, mass = self.matrices
        return build_operators(
            self.fem, stiffness=stiffness, mass=mass, loss=self.loss, water=self.water,
            radius=self.radius, condition=self.condition,
        )  # fmt: skip

    @cached_property
    def rooted(self) -> RootedSystem:
        """The plate whose root can move."""
        stiffness, mass = self.matrices
        return add_root(
            self.operators, self.fem, self.basis, stiffness=stiffness, mass=mass, loss=self.loss,
            water=self.water, about=self.root,
        )  # fmt: skip


def solve_all(operators: Operators, frequency: FloatArray, loads: AnyArray) -> ComplexArray:
    """Responses (f, k, n) to loads (k, n) at frequencies [Hz], directly."""
    solver = make_solver(precision="double", tolerance=1e-12)
    points = [solve_point(operators, float(f), loads, solver) for f in np.atleast_1d(frequency)]
    for point in points:
        if point.solution is None:
            raise ValueError(f"no solution at {point.frequency:g} Hz: {point.failure}")
    return np.stack([point.solution for point in points if point.solution is not None])
