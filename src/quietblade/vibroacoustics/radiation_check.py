# SPDX-License-Identifier: LGPL-2.1-or-later
"""What an approximate radiation condition does to the power of each multipole."""

import numpy as np
from scipy.special import spherical_jn

from quietblade.errors import Notice
from quietblade.typing import FloatArray
from quietblade.vibroacoustics.multipoles import Multipoles
from quietblade.vibroacoustics.radiation import RadiationCondition

_DECIBELS = 0.5  # error of the power that is worth a notice


def power_ratio(condition: RadiationCondition, degree: int, kr: float) -> FloatArray:
    """Power through the sphere over the true one of compact sources of fixed strength.

    With the condition's coefficient b on degree l and z = k R, the reflected wave makes it
    Im(R b) / (z |R b j_l(z) + z j_l'(z)|^2) (theory: S2-48).

    Returns
    -------
    (degree + 1,) array
        By degree; negative where the condition is active, that is, feeds power in.
    """
    b, degrees = condition.coefficients(degree, kr), np.arange(degree + 1)
    value, slope = spherical_jn(degrees, kr), spherical_jn(degrees, kr, derivative=True)
    return np.asarray(b.imag / (kr * np.abs(b * value + kr * slope) ** 2))


def estimated_error(condition: RadiationCondition, radius: float, waves: Multipoles) -> FloatArray:
    """Error of the power through the sphere by the ratios of the waves that are there [dB].

    Parameters
    ----------
    condition : RadiationCondition
    radius : float
        R of the sphere [m].
    waves : Multipoles
        Outgoing waves by the Kirchhoff-Helmholtz integral, which sees no reflection.

    Returns
    -------
    (f,) array
        10 lg (sum ratio_l P_l / sum P_l); nan where the sphere would take no power.
    """
    kr = waves.omega * radius / waves.water.sound_speed
    ratios = np.array([power_ratio(condition, waves.degree, float(value)) for value in kr])
    total = np.sum(ratios * waves.power_by_degree, axis=1) / waves.power
    positive = total > 0.0
    return np.where(positive, 10.0 * np.log10(np.where(positive, total, 1.0)), np.nan)


def radiation_notices(
    condition: RadiationCondition, radius: float, waves: Multipoles, limit: float = _DECIBELS
) -> list[Notice]:
    """Says where a condition makes levels wrong, and where it is active."""
    kr = waves.omega * radius / waves.water.sound_speed
    where, cure = f"radiation condition {condition.name}", "Use DtN, or a larger sphere."
    notices = []
    lowest = int(np.argmin(kr))
    ratios = power_ratio(condition, waves.degree, float(kr[lowest]))
    if np.any(ratios < 0.0):
        first = int(np.argmax(ratios < 0.0))
        notices.append(
            Notice(
                f"{where} at kR = {kr[lowest]:.3g}",
                f"degree {first} and higher ones feed power in; the ratio of their power to the "
                "true one, at the worst, is",
                float(ratios.min()),
                0.0,
                cure,
            )
        )
    error = estimated_error(condition, radius, waves)
    size = np.where(np.isnan(error), np.inf, np.abs(error))
    worst = int(np.argmax(size))
    if size[worst] > limit:
        reading = "is wrong by so many dB" if np.isfinite(size[worst]) else "is not even positive"
        notices.append(
            Notice(
                f"{where} at kR = {kr[worst]:.3g}",
                f"the power through the sphere {reading}, by the multipoles that are there",
                float(error[worst]) if np.isfinite(size[worst]) else None,
                limit,
                cure,
            )
        )
    return notices
