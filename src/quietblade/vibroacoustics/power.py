# SPDX-License-Identifier: LGPL-2.1-or-later
"""Time-averaged powers of a harmonic response, and their balance (theory: S2-8).

Amplitudes are peak values.  A response is an array (..., n) of free unknowns, one row a frequency,
beside angular frequencies (...,) [rad/s]; powers have the shape of the frequencies [W].
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_matrix

from quietblade.typing import AnyArray, ComplexArray, FloatArray
from quietblade.vibroacoustics.operators import Operators

REFERENCE_POWER = 1e-12


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
        Power lost in the material.
    """

    injected: FloatArray
    radiated: FloatArray
    surface: FloatArray
    dissipated: FloatArray

    @property
    def residual(self) -> FloatArray:
        """|injected - radiated - dissipated| / |injected|, zero up to the solver's accuracy."""
        lost = self.injected - self.radiated - self.dissipated
        return np.abs(lost) / np.abs(self.injected)


def power_budget(
    operators: Operators, omega: FloatArray, response: ComplexArray, load: AnyArray
) -> PowerBudget:
    """All powers of a response to a load (n,) or (..., n)."""
    return PowerBudget(
        injected_power(load, omega, response),
        radiated_power(operators, omega, response),
        surface_power(operators, omega, response),
        dissipated_power(operators.terms["L"], omega, response),
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


def dissipated_power(loss: csr_matrix, omega: FloatArray, response: ComplexArray) -> FloatArray:
    """Power lost in the material, omega/2 U^H L U, for L or a part of it."""
    return 0.5 * np.asarray(omega) * _real_form(loss, response, response)


def dissipated_by_region(
    operators: Operators, omega: FloatArray, response: ComplexArray
) -> Mapping[str, FloatArray]:
    """Power lost in each named part of the loss matrix."""
    return {
        name: dissipated_power(part, omega, response) for name, part in operators.losses.items()
    }


def radiated_power(operators: Operators, omega: FloatArray, response: ComplexArray) -> FloatArray:
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
    for name in factors[0]:
        passing = np.reshape([-complex(f[name]).imag for f in factors], frequencies.shape)
        power += passing * _real_form(operators.terms[name], response, response)
    return 0.5 * frequencies * power


def surface_power(operators: Operators, omega: FloatArray, response: ComplexArray) -> FloatArray:
    """Power from the moving wetted surface into the water, omega^2/2 Re(U^H C Psi).

    With n out of the fluid this is -1/2 Re of the integral of p v_n* over the surface.
    """
    displacement = np.zeros_like(response)
    displacement[..., operators.blocks.u] = response[..., operators.blocks.u]
    potential = np.zeros_like(response)
    potential[..., operators.blocks.psi] = response[..., operators.blocks.psi]
    return 0.5 * np.asarray(omega) ** 2 * _real_form(operators.terms["C"], displacement, potential)


def level(power: FloatArray) -> FloatArray:
    """Sound power level [dB re 1 pW]; a power that is not positive has none (nan)."""
    positive = np.asarray(power) > 0.0
    safe = np.where(positive, power, 1.0)
    return np.where(positive, 10.0 * np.log10(safe / REFERENCE_POWER), np.nan)


def _real_form(matrix: csr_matrix, left: AnyArray, right: AnyArray) -> FloatArray:
    """Re(left^H A right) along the last axis."""
    columns = right.reshape(-1, right.shape[-1]).T
    product = (matrix @ columns).T.reshape(right.shape)
    return np.asarray(np.sum(np.conj(left) * product, axis=-1).real)
