# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the structure asks of a material, and the checks that all laws share."""

from typing import Protocol, TypeAlias, runtime_checkable

import ngsolve as ngs
import numpy as np

from quietblade.errors import MaterialError
from quietblade.typing import FloatArray

Density: TypeAlias = float | ngs.CoefficientFunction
"""Mass per undeformed volume [kg/m3]: a number, or a function of place in a stack of plies."""

_ASYMMETRY = 1e-9


@runtime_checkable
class ElasticMaterial(Protocol):
    """A hyperelastic solid that the displacement alone describes."""

    @property
    def name(self) -> str:
        """Name for messages and records."""

    @property
    def density(self) -> Density:
        """Mass per undeformed volume [kg/m3]."""

    @property
    def loss_factor(self) -> float:
        """Loss factor eta of the complex stiffness C (1 + i eta)."""

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


def require_loss_factor(material: str, loss_factor: float) -> None:
    """Raise `MaterialError` unless the loss factor is finite and not negative."""
    require(
        0.0 <= loss_factor < float("inf"),
        material,
        "loss_factor >= 0",
        f"loss_factor = {loss_factor:g}",
        "With exp(+i omega t) a positive loss factor dissipates.",
    )


def require_nearly_incompressible(
    material: str, density: float, shear_modulus: float, bulk_modulus: float, loss_factor: float
) -> None:
    """Raise `MaterialError` unless the constants make a rubber-like solid (theory: S1-49)."""
    require_positive(
        material, density=density, shear_modulus=shear_modulus, bulk_modulus=bulk_modulus
    )
    require(
        bulk_modulus > 2 * shear_modulus / 3,
        material,
        "bulk_modulus > 2/3 shear modulus",
        f"bulk_modulus = {bulk_modulus:g}, shear modulus = {shear_modulus:g}",
        "Poisson's ratio would be negative; check the units of the constants.",
    )
    require_loss_factor(material, loss_factor)


def require_definite(material: str, stiffness: FloatArray) -> None:
    """Raise `MaterialError` unless a stiffness (6, 6) is symmetric and positive definite.

    The matrix is scaled to a unit diagonal first, so that the units of its rows do not matter
    (theory: S1-49).
    """
    C = np.asarray(stiffness, dtype=float)
    require(
        C.shape == (6, 6) and bool(np.isfinite(C).all()),
        material,
        "a stiffness of 6 x 6 finite numbers",
        f"shape {C.shape}",
        "Rows and columns: 11, 22, 33, 23, 13, 12 with engineering shear strains.",
    )
    skew = float(np.abs(C - C.T).max() / np.abs(C).max()) if C.any() else 0.0
    require(
        skew <= _ASYMMETRY,
        material,
        "a symmetric stiffness",
        f"largest difference across the diagonal {skew:.3g} of the largest entry",
        "A strain energy needs C_ij = C_ji.",
    )
    diagonal = np.diag(C)
    require(
        bool((diagonal > 0.0).all()),
        material,
        "a stiffness with a positive diagonal",
        f"diagonal {', '.join(f'{d:g}' for d in diagonal)}",
        "Every strain alone must cost energy.",
    )
    scale = 1.0 / np.sqrt(diagonal)
    least = float(np.linalg.eigvalsh(scale[:, None] * C * scale)[0])
    require(
        least > 0.0,
        material,
        "a positive definite stiffness",
        f"least eigenvalue {least:g} (scaled to a unit diagonal)",
        "Some strain would release energy; check signs and the order 11, 22, 33, 23, 13, 12.",
    )
