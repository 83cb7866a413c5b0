# SPDX-License-Identifier: LGPL-2.1-or-later
"""Nearly incompressible neo-Hookean solid in mixed displacement-pressure form."""

from dataclasses import dataclass

import ngsolve as ngs

from quietblade.materials.kinematics import volumetric_energy
from quietblade.materials.protocols import require_nearly_incompressible


@dataclass(frozen=True)
class NeoHookean:
    """Neo-Hookean solid with a volumetric multiplier (perturbed Lagrangian).

    Attributes
    ----------
    name : str
        Name for messages and records.
    density : float
        Mass per undeformed volume [kg/m3].
    shear_modulus : float
        Shear modulus mu [Pa].
    bulk_modulus : float
        Bulk modulus K [Pa].
    loss_factor : float
        Loss factor eta of the complex shear modulus ``mu (1 + i eta)``, zero or positive.

    Raises
    ------
    MaterialError
        If a constant is not admissible.

    Notes
    -----
    ``W(F, p) = mu/2 (J^-2/3 I1 - 3) + p (J - 1) - p^2 / (2 K)`` (theory: S1-40).  Bonet and
    Wood, Nonlinear Continuum Mechanics for Finite Element Analysis, 2nd ed., chapter 6.
    """

    name: str
    density: float
    shear_modulus: float
    bulk_modulus: float
    loss_factor: float = 0.0

    def __post_init__(self) -> None:
        require_nearly_incompressible(
            self.name, self.density, self.shear_modulus, self.bulk_modulus, self.loss_factor
        )

    def energy(
        self, F: ngs.CoefficientFunction, p: ngs.CoefficientFunction
    ) -> ngs.CoefficientFunction:
        """Mixed energy per undeformed volume [J/m3]; ``p`` [Pa] is positive in tension."""
        return self.isochoric_energy(F) + volumetric_energy(F, p, self.bulk_modulus)

    def isochoric_energy(self, F: ngs.CoefficientFunction) -> ngs.CoefficientFunction:
        """``mu/2 (J^-2/3 I1 - 3)`` [J/m3]."""
        first = ngs.InnerProduct(F, F)
        return 0.5 * self.shear_modulus * (ngs.Det(F) ** (-2 / 3) * first - 3)

    def isochoric_energy_of_metric(self, C: ngs.CoefficientFunction) -> ngs.CoefficientFunction:
        """`isochoric_energy` as a function of the metric ``C = F^T F`` (symmetric)."""
        return 0.5 * self.shear_modulus * (ngs.Det(C) ** (-1 / 3) * ngs.Trace(C) - 3)
