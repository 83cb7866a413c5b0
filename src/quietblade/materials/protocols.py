# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the structure asks of a material, and the checks that all laws share."""

from typing import Protocol, runtime_checkable

import ngsolve as ngs

from quietblade.errors import MaterialError


@runtime_checkable
class ElasticMaterial(Protocol):
    """A hyperelastic solid that the displacement alone describes."""

    @property
    def name(self) -> str:
        """Name for messages and records."""

    @property
    def density(self) -> float:
        """Mass per undeformed volume [kg/m3]."""

    def energy(self, F: ngs.CoefficientFunction) -> ngs.CoefficientFunction:
        """Strain energy per undeformed volume [J/m3] of the deformation gradient F."""

    def energy_of_strain(self, E: ngs.CoefficientFunction) -> ngs.CoefficientFunction:
        """Strain energy per undeformed volume [J/m3] of the Green-Lagrange strain E."""


@runtime_checkable
class MixedMaterial(Protocol):
    """A nearly incompressible solid with a volumetric multiplier, and loss in shear."""

    @property
    def name(self) -> str:
        """Name for messages and records."""

    @property
    def density(self) -> float:
        """Mass per undeformed volume [kg/m3]."""

    @property
    def loss_factor(self) -> float:
        """Loss factor eta of the complex modulus G (1 + i eta)."""

    def energy(
        self, F: ngs.CoefficientFunction, p: ngs.CoefficientFunction
    ) -> ngs.CoefficientFunction:
        """Mixed energy per undeformed volume [J/m3]; stationary in the multiplier p [Pa]."""

    def isochoric_energy(self, F: ngs.CoefficientFunction) -> ngs.CoefficientFunction:
        """Part of the energy [J/m3] that a pure change of volume leaves unchanged."""

    def isochoric_energy_of_metric(self, C: ngs.CoefficientFunction) -> ngs.CoefficientFunction:
        """`isochoric_energy` as a function of the metric C = F^T F."""


Material = ElasticMaterial | MixedMaterial
"""Any material of the structure."""


def require(holds: bool, material: str, condition: str, values: str, remedy: str) -> None:
    """Raise `MaterialError` with the condition, the values and the remedy unless it holds."""
    if not holds:
        raise MaterialError(f"material {material!r}: {condition} is violated: {values}. {remedy}")


def require_positive(material: str, **constants: float) -> None:
    """Raise `MaterialError` unless every constant is finite and positive."""
    for symbol, value in constants.items():
        require(
            0.0 < value < float("inf"),
            material,
            f"{symbol} > 0",
            f"{symbol} = {value:g}",
            "Give a positive value in SI units.",
        )
