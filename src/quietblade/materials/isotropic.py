# SPDX-License-Identifier: LGPL-2.1-or-later
"""Isotropic Saint-Venant-Kirchhoff solid."""

from dataclasses import dataclass

import ngsolve as ngs
import numpy as np

from quietblade.materials.kinematics import green_lagrange
from quietblade.materials.protocols import require, require_loss_factor, require_positive
from quietblade.typing import FloatArray


@dataclass(frozen=True)
class IsotropicSVK:
    """Isotropic solid, linear between Green-Lagrange strain and second Piola-Kirchhoff stress.

    For large rotations and small strains.

    Attributes
    ----------
    name : str
        Name for messages and records.
    density : float
        Mass per undeformed volume [kg/m3].
    youngs_modulus : float
        Young's modulus E [Pa].
    poisson_ratio : float
        Poisson's ratio nu, -1 < nu < 1/2.
    loss_factor : float
        Loss factor eta of the complex modulus ``E (1 + i eta)``, zero or positive.
    yield_strength : float or None
        Proof stress of a metal [Pa], for failure indices.

    Raises
    ------
    MaterialError
        If the energy is not positive for every strain.
    """

    name: str
    density: float
    youngs_modulus: float
    poisson_ratio: float
    loss_factor: float = 0.0
    yield_strength: float | None = None

    def __post_init__(self) -> None:
        require_positive(self.name, density=self.density, youngs_modulus=self.youngs_modulus)
        require(
            -1.0 < self.poisson_ratio < 0.5,
            self.name,
            "-1 < poisson_ratio < 1/2",
            f"poisson_ratio = {self.poisson_ratio:g}",
            "A nearly incompressible solid needs a mixed law such as MooneyRivlin.",
        )
        require_loss_factor(self.name, self.loss_factor)
        if self.yield_strength is not None:
            require_positive(self.name, yield_strength=self.yield_strength)

    @property
    def lame(self) -> tuple[float, float]:
        """Lame's constants lambda and mu [Pa]."""
        nu = self.poisson_ratio
        mu = self.youngs_modulus / (2 * (1 + nu))
        return 2 * mu * nu / (1 - 2 * nu), mu

    @property
    def stiffness(self) -> FloatArray:
        """Stiffness (6, 6) [Pa] for strains 11, 22, 33, 23, 13, 12 (engineering shears)."""
        lam, mu = self.lame
        C = np.diag([2 * mu] * 3 + [mu] * 3)
        C[:3, :3] += lam
        return C

    def energy(self, F: ngs.CoefficientFunction) -> ngs.CoefficientFunction:
        """Strain energy per undeformed volume [J/m3] of the deformation gradient."""
        return self.energy_of_strain(green_lagrange(F))

    def energy_of_strain(self, E: ngs.CoefficientFunction) -> ngs.CoefficientFunction:
        """``lambda/2 (tr E)^2 + mu E:E`` [J/m3] of the Green-Lagrange strain (theory: S1-13)."""
        lam, mu = self.lame
        return 0.5 * lam * ngs.Trace(E) ** 2 + mu * ngs.InnerProduct(E, E)
