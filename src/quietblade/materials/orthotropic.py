# SPDX-License-Identifier: LGPL-2.1-or-later
"""Orthotropic Saint-Venant-Kirchhoff solid: a woven fabric as one homogeneous material."""

from dataclasses import dataclass, field, replace
from itertools import combinations
from math import sqrt

import ngsolve as ngs
import numpy as np

from quietblade.materials.axes import Axes, as_coefficient, check_axes
from quietblade.materials.kinematics import green_lagrange
from quietblade.materials.protocols import require, require_loss_factor, require_positive
from quietblade.materials.strength import PlyStrength
from quietblade.typing import FloatArray


@dataclass(frozen=True, eq=False)
class OrthotropicSVK:
    """Orthotropic solid, linear between Green-Lagrange strain and second Piola-Kirchhoff stress.

    Attributes
    ----------
    name : str
        Name for messages and records.
    density : float
        Mass per undeformed volume [kg/m3].
    e1, e2, e3 : float
        Young's moduli along the material axes [Pa].
    g12, g23, g13 : float
        Shear moduli [Pa].
    nu12, nu23, nu13 : float
        Poisson's ratios; ``nu_ij`` is minus the strain along j for a unit strain along i under a
        stress along i, so that ``nu_ij / e_i = nu_ji / e_j``.
    axes : (3, 3) float array or CoefficientFunction
        Its columns are the unit material axes 1, 2, 3 in the blade frame (undeformed
        configuration); a CoefficientFunction may turn from place to place.
    loss_factor : float
        Loss factor eta of the complex stiffness ``C (1 + i eta)``, zero or positive.
    strength : PlyStrength or None
        For failure indices.

    Raises
    ------
    MaterialError
        If the energy is not positive for every strain, or the axes are not a rotation.
    """

    name: str
    density: float
    e1: float
    e2: float
    e3: float
    g12: float
    g23: float
    g13: float
    nu12: float
    nu23: float
    nu13: float
    axes: Axes = field(default_factory=lambda: np.eye(3))
    loss_factor: float = 0.0
    strength: PlyStrength | None = None

    def __post_init__(self) -> None:
        require_positive(
            self.name, density=self.density, e1=self.e1, e2=self.e2, e3=self.e3,
            g12=self.g12, g23=self.g23, g13=self.g13,
        )  # fmt: skip
        moduli, ratios = {1: self.e1, 2: self.e2, 3: self.e3}, self._ratios
        for i, j in combinations((1, 2, 3), 2):
            limit = sqrt(moduli[i] / moduli[j])
            require(
                abs(ratios[i, j]) < limit,
                self.name,
                f"|nu{i}{j}| < sqrt(e{i}/e{j})",
                f"nu{i}{j} = {ratios[i, j]:g}, limit {limit:g}",
                f"nu{i}{j} is strain {j} from stress {i}; some tables print nu{j}{i} instead.",
            )
        scale = np.prod(list(moduli.values())) ** (1 / 3)
        determinant = float(np.linalg.det(scale * self.compliance))
        require(
            determinant > 0.0,
            self.name,
            "a positive determinant of the 3x3 compliance",
            f"scaled determinant {determinant:g} for nu12 = {self.nu12:g}, nu23 = {self.nu23:g}, "
            f"nu13 = {self.nu13:g}",
            "The three Poisson's ratios together are too large.",
        )
        require_loss_factor(self.name, self.loss_factor)
        check_axes(self.name, self.axes)

    @property
    def _ratios(self) -> dict[tuple[int, int], float]:
        return {(1, 2): self.nu12, (2, 3): self.nu23, (1, 3): self.nu13}

    @property
    def compliance(self) -> FloatArray:
        """Strains of the three normal stresses, (3, 3) [1/Pa]."""
        S = np.diag([1 / self.e1, 1 / self.e2, 1 / self.e3])
        for (i, j), ratio in self._ratios.items():
            S[i - 1, j - 1] = S[j - 1, i - 1] = -ratio * S[i - 1, i - 1]
        return S

    @property
    def stiffness(self) -> FloatArray:
        """Stiffness (6, 6) [Pa] in the material axes, for strains 11, 22, 33, 23, 13, 12."""
        C = np.diag([0.0, 0.0, 0.0, self.g23, self.g13, self.g12])
        C[:3, :3] = np.linalg.inv(self.compliance)
        return C

    def oriented(self, axes: Axes) -> "OrthotropicSVK":
        """Return the same material with other axes."""
        return replace(self, axes=axes)

    def energy(self, F: ngs.CoefficientFunction) -> ngs.CoefficientFunction:
        """Strain energy per undeformed volume [J/m3] of the deformation gradient."""
        return self.energy_of_strain(green_lagrange(F))

    def energy_of_strain(self, E: ngs.CoefficientFunction) -> ngs.CoefficientFunction:
        """Strain energy [J/m3] of the strain in the blade frame (theory: S1-14).

        ``1/2 sum_ij c_ij E_ii E_jj + 2 (g12 E_12^2 + g23 E_23^2 + g13 E_13^2)`` with the strain in
        the material axes and c the inverse of the compliance.
        """
        axes = as_coefficient(self.axes)
        e = axes.trans * E * axes
        c = np.linalg.inv(self.compliance)
        normal = sum(0.5 * c[i, i] * e[i, i] ** 2 for i in range(3)) + sum(
            c[i, j] * e[i, i] * e[j, j] for i, j in combinations(range(3), 2)
        )
        shear = self.g12 * e[0, 1] ** 2 + self.g23 * e[1, 2] ** 2 + self.g13 * e[0, 2] ** 2
        return normal + 2 * shear
