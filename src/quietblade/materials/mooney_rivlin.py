# SPDX-License-Identifier: LGPL-2.1-or-later
"""Nearly incompressible Mooney-Rivlin solid in mixed displacement-pressure form."""

from dataclasses import dataclass

import ngsolve as ngs

from quietblade.materials.kinematics import volumetric_energy
from quietblade.materials.protocols import require, require_nearly_incompressible


@dataclass(frozen=True)
class MooneyRivlin:
    """Mooney-Rivlin solid with a volumetric multiplier (perturbed Lagrangian).

    Attributes
    ----------
    name : str
        Name for messages and records.
    density : float
        Mass per undeformed volume [kg/m3].
    c10, c01 : float
        Mooney-Rivlin constants [Pa]; the shear modulus is ``2 (c10 + c01)``.
    bulk_modulus : float
        Bulk modulus K [Pa].
    loss_factor : float
        Loss factor eta of the complex shear modulus ``G (1 + i eta)``, zero or positive.

    Raises
    ------
    MaterialError
        If a constant is not admissible.

    Notes
    -----
    ``W(F, p) = W_iso(F) + p (J - 1) - p^2 / (2 K)`` is stationary for ``p = K (J - 1)``: p is a
    mean stress, positive in tension.  Bonet and Wood, Nonlinear Continuum Mechanics for Finite
    Element Analysis, 2nd ed., chapters 6 and 8.
    """

    name: str
    density: float
    c10: float
    c01: float
    bulk_modulus: float
    loss_factor: float = 0.0

    def __post_init__(self) -> None:
        for symbol, value in (("c10", self.c10), ("c01", self.c01)):
            require(
                0.0 <= value < float("inf"),
                self.name,
                f"{symbol} >= 0",
                f"{symbol} = {value:g}",
                "A negative constant loses stability at some strain; refit with both positive.",
            )
        require_nearly_incompressible(
            self.name, self.density, self.shear_modulus, self.bulk_modulus, self.loss_factor
        )

    @property
    def shear_modulus(self) -> float:
        """Shear modulus of small strains [Pa]."""
        return 2 * (self.c10 + self.c01)

    def energy(
        self, F: ngs.CoefficientFunction, p: ngs.CoefficientFunction
    ) -> ngs.CoefficientFunction:
        """Mixed energy [J/m3]; ``p`` [Pa] is positive in tension (theory: S1-15)."""
        return self.isochoric_energy(F) + volumetric_energy(F, p, self.bulk_modulus)

    def isochoric_energy(self, F: ngs.CoefficientFunction) -> ngs.CoefficientFunction:
        """``c10 (J^-2/3 I1 - 3) + c01 (J^-4/3 I2 - 3)`` [J/m3]."""
        return self._isochoric(F.trans * F, ngs.Det(F) ** (-2 / 3))

    def isochoric_energy_of_metric(self, C: ngs.CoefficientFunction) -> ngs.CoefficientFunction:
        """`isochoric_energy` as a function of the metric ``C = F^T F`` (symmetric)."""
        return self._isochoric(C, ngs.Det(C) ** (-1 / 3))

    def _isochoric(
        self, C: ngs.CoefficientFunction, scale: ngs.CoefficientFunction
    ) -> ngs.CoefficientFunction:
        first = ngs.Trace(C)
        second = 0.5 * (first * first - ngs.InnerProduct(C, C))
        return self.c10 * (scale * first - 3) + self.c01 * (scale * scale * second - 3)
