# SPDX-License-Identifier: LGPL-2.1-or-later
"""Time-averaged powers of a harmonic response, and their balance (theory: S2-8, S2-10).

Amplitudes are peak values.  A response is an array (..., n) of free unknowns, one row a frequency,
beside angular frequencies (...,) [rad/s]; powers have the shape of the frequencies [W].
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from scipy.sparse import csr_matrix

from quietblade.materials.viscoelastic import ModulusRatio
from quietblade.typing import AnyArray, ComplexArray, FloatArray
from quietblade.vibroacoustics.loss import loss_term
from quietblade.vibroacoustics.operators import Blocks, Operators
from quietblade.vibroacoustics.radiation import RadiationCondition

REFERENCE_POWER = 1e-12

Matrix = csr_matrix | AnyArray


class System(Protocol):
    """What the powers need to know: `Operators`, or the same terms on a few columns."""

    @property
    def terms(self) -> Mapping[str, Matrix]:
        """Terms of A(omega), by name."""

    @property
    def moduli(self) -> Mapping[str, ModulusRatio]:
        """Complex modulus of each lossy region."""

    @property
    def blocks(self) -> Blocks:
        """Where the fields are."""

    @property
    def condition(self) -> RadiationCondition:
        """Condition on the sphere."""

    @property
    def sound_speed(self) -> float:
        """Speed of sound [m/s]."""

    @property
    def radius(self) -> float:
        """R of the sphere [m]."""


@dataclass(frozen=True)
class PowerBudget:
    """Where the injected power goes [W].

    Attributes
    ----------
    injected : array
        Power of the excitation.
    radiated : array
        Power that leaves through the sphere, under its radiation condition.
    surface : array
        Power that enters the water through the wetted surface.
    dissipated : array
        Power lost in all lossy regions: in the materials, and to a stream or a shaft if there is
        one.
    """

    injected: FloatArray
    radiated: FloatArray
    surface: FloatArray
    dissipated: FloatArray

    def __add__(self, other: "PowerBudget") -> "PowerBudget":
        """Powers of two independent responses together."""
        return PowerBudget(
            self.injected + other.injected,
            self.radiated + other.radiated,
            self.surface + other.surface,
            self.dissipated + other.dissipated,
        )

    @property
    def residual(self) -> FloatArray:
        """|injected - radiated - dissipated| / |injected|, zero up to the solver's accuracy."""
        lost = self.injected - self.radiated - self.dissipated
        return np.abs(lost) / np.abs(self.injected)


def power_budget(
    operators: System, omega: FloatArray, response: ComplexArray, load: AnyArray
) -> PowerBudget:
    """All powers of a response to a load (n,) or (..., n)."""
    return PowerBudget(
        injected_power(load, omega, response),
        radiated_power(operators, omega, response),
        surface_power(operators, omega, response),
        sum(dissipated_by_region(operators, omega, response).values(), start=np.zeros(omega.shape)),
    )


def injected_power(load: AnyArray, omega: FloatArray, response: ComplexArray) -> FloatArray:
    """Power of a load, 1/2 Re(F^H i omega U).

    Parameters
    ----------
    load : (n,) or (..., n) array
        Right-hand side on the free unknowns [N].
    """
    work = np.sum(np.conj(load) * response, axis=-1)
    return np.asarray(-0.5 * np.asarray(omega) * work.imag)


def dissipated_by_region(
    operators: System, omega: FloatArray, response: ComplexArray
) -> Mapping[str, FloatArray]:
    """Power lost in each lossy region, omega/2 Im(g_r) U^H D_r U (theory: S2-52)."""
    frequencies = np.asarray(omega, dtype=np.float64)
    return {
        region: 0.5
        * frequencies
        * np.reshape([complex(ratio(w)).imag for w in frequencies.flat], frequencies.shape)
        * _real_form(operators.terms[loss_term(region)], response, response)
        for region, ratio in operators.moduli.items()
    }


def radiated_power(operators: System, omega: FloatArray, response: ComplexArray) -> FloatArray:
    """Power through the outer sphere.

    The sphere's part B(omega) of A(omega) lets -omega/2 Im(Psi^H B Psi) pass; for first-order BGT
    that is omega^2/2 Psi^H Q Psi.
    """
    frequencies = np.asarray(omega, dtype=np.float64)
    power = np.zeros(frequencies.shape)
    factors = [
        operators.condition.factors(complex(w), operators.sound_speed, operators.radius)
        for w in frequencies.flat
    ]
    for name in factors[0] if factors else ():
        passing = np.reshape([-complex(f[name]).imag for f in factors], frequencies.shape)
        power += passing * _real_form(operators.terms[name], response, response)
    return 0.5 * frequencies * power


def surface_power(operators: System, omega: FloatArray, response: ComplexArray) -> FloatArray:
    """Power from the moving wetted surface into the water, omega^2/2 Re(U^H C Psi).

    With n out of the fluid this is -1/2 Re of the integral of p v_n* over the surface.
    """
    solid = operators.blocks.solid
    displacement = np.zeros_like(response)
    displacement[..., solid] = response[..., solid]
    potential = np.zeros_like(response)
    potential[..., operators.blocks.psi] = response[..., operators.blocks.psi]
    return 0.5 * np.asarray(omega) ** 2 * _real_form(operators.terms["C"], displacement, potential)


def radiation_efficiency(
    operators: Operators,
    normal_motion: csr_matrix,
    omega: FloatArray,
    response: ComplexArray,
    power: FloatArray,
    columns: AnyArray | None = None,
    carried: csr_matrix | None = None,
) -> FloatArray:
    """Radiated power over that of a piston of the same motion (theory: S2-47).

    sigma = P / (rho c/2 int |v_n|^2 dS): one for a plane wave, small for a body that the water can
    flow around.

    Parameters
    ----------
    normal_motion : csr_matrix
        int (u . n) (du . n) over the wetted surface, `fluid.normal_motion_matrix`.
    power : (...,) array
        Radiated power by any path [W].
    columns : (k, n) array or None
        If the response are coordinates (..., k): the vectors that they are factors of.
    carried : (V.ndof, n) csr_matrix or None
        What a moving root does to the displacement of its nodes, `RootedSystem.carried`.
    """
    u = operators.blocks.u
    places = operators.free[u], u
    shape = normal_motion.shape[0], operators.size
    moving = csr_matrix((np.ones(len(u)), places), shape=shape)
    if carried is not None:
        moving = moving + carried
    form: Matrix = csr_matrix(moving.T @ normal_motion @ moving)
    if columns is not None:
        form = columns @ (form @ columns.T)
    squared = _real_form(form, response, response)
    impedance = operators.density * operators.sound_speed
    return np.asarray(power / (0.5 * impedance * np.asarray(omega) ** 2 * squared))


def level(power: FloatArray) -> FloatArray:
    """Sound power level [dB re 1 pW]; a power that is not positive has none (nan)."""
    positive = np.asarray(power) > 0.0
    safe = np.where(positive, power, 1.0)
    return np.where(positive, 10.0 * np.log10(safe / REFERENCE_POWER), np.nan)


def _real_form(matrix: Matrix, left: AnyArray, right: AnyArray) -> FloatArray:
    """Re(left^H A right) along the last axis."""
    columns = right.reshape(-1, right.shape[-1]).T
    product = (matrix @ columns).T.reshape(right.shape)
    return np.asarray(np.sum(np.conj(left) * product, axis=-1).real)
