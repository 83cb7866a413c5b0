# SPDX-License-Identifier: LGPL-2.1-or-later
"""Empirical relations of the integral boundary layer, by the shape factor H.

References
----------
Laminar layer and growth of disturbances: Drela and Giles, AIAA Journal 25 (1987) 1347, with the
later fits that Fidkowski, AIAA Journal 60 (2022) 1333 (doi:10.2514/1.J061341) lists. Turbulent
layer: Head, ARC R&M 3152 (1958), fitted by Cebeci and Bradshaw, *Momentum Transfer in Boundary
Layers* (1977), section 7.4; friction: Ludwieg and Tillmann, NACA TM 1285 (1950).
"""

import numpy as np

from quietblade.typing import FloatArray

ENERGY_MINIMUM = 4.35
"""Shape factor at which the laminar energy shape factor is least; near it the layer separates."""

LEAST_ENERGY = 1.528
"""Energy shape factor at `ENERGY_MINIMUM`."""

LARGEST_SHAPE = 2.8
"""Shape factor beyond which Head's separated layer is not followed."""

LEAST_ENTRAINMENT = 3.3
"""Head's H1 at separation, the limit of the fit."""


def laminar_energy(shape: FloatArray) -> FloatArray:
    """Energy shape factor H* of an attached laminar layer (H below `ENERGY_MINIMUM`)."""
    away = shape - ENERGY_MINIMUM
    cubic = (0.0111 * away**2 - 0.0278 * away**3) / (shape + 1.0)
    return np.asarray(LEAST_ENERGY + cubic - 0.0002 * (shape * away) ** 2, dtype=np.float64)


def separated_shape(energy: FloatArray) -> FloatArray:
    """H of a separated laminar layer from its energy shape factor above `LEAST_ENERGY`."""
    b = 2.0 * ENERGY_MINIMUM + (energy - LEAST_ENERGY) / 0.015
    return np.asarray(0.5 * (b + np.sqrt(b**2 - 4.0 * ENERGY_MINIMUM**2)), dtype=np.float64)


def laminar_shear(shape: FloatArray) -> FloatArray:
    """Half the friction coefficient of a laminar layer, times Re_theta."""
    attached = 0.0727 * np.maximum(5.5 - shape, 0.0) ** 3 / (shape + 1.0)
    separated = 0.015 * (1.0 - 1.0 / np.maximum(shape - 4.5, 1.0)) ** 2
    return np.asarray(0.5 * (np.where(shape < 5.5, attached, separated) - 0.07), dtype=np.float64)


def laminar_dissipation(shape: FloatArray) -> FloatArray:
    """Dissipation 2 C_D / H* of a laminar layer, times Re_theta."""
    away = shape - 4.0
    attached = 0.00205 * np.maximum(-away, 0.0) ** 5.5
    separated = -0.0016 * away**2 / (1.0 + 0.02 * away**2)
    return np.asarray(0.207 + np.where(away < 0.0, attached, separated), dtype=np.float64)


def disturbance_growth(shape: FloatArray, reynolds: FloatArray) -> FloatArray:
    """Growth of the exponent n over a length of one momentum thickness.

    Parameters
    ----------
    shape, reynolds : array
        H and the Reynolds number of the momentum thickness.
    """
    h = 1.0 / (shape - 1.0)
    critical = 2.492 * h**0.43 + 0.7 * (np.tanh(14.0 * h - 9.24) + 1.0)
    # The switch is rounded off over a tenth of a decade on either side.
    ramp = np.clip((np.log10(np.maximum(reynolds, 1.0)) - critical + 0.1) / 0.2, 0.0, 1.0)
    per_length = -0.05 + 2.7 * h - 5.5 * h**2 + 3.0 * h**3 + 0.1 * np.exp(-20.0 * h)
    slope = 0.028 * (shape - 1.0) - 0.0345 * np.exp(-((3.87 * h - 2.52) ** 2))
    return np.asarray(ramp**2 * (3.0 - 2.0 * ramp) * per_length * slope, dtype=np.float64)


def entrainment_shape(shape: FloatArray) -> FloatArray:
    """Head's H1 from H."""
    thin = 0.8234 * (np.minimum(shape, 1.6) - 1.1) ** -1.287
    thick = 1.5501 * (np.maximum(shape, 1.6) - 0.6778) ** -3.064
    return np.asarray(LEAST_ENTRAINMENT + np.where(shape <= 1.6, thin, thick), dtype=np.float64)


def turbulent_shape(entrainment: FloatArray) -> FloatArray:
    """H from Head's H1, at most `LARGEST_SHAPE`."""
    rest = np.maximum(entrainment - LEAST_ENTRAINMENT, 1e-6)
    thin = 1.1 + 0.86 * rest**-0.777
    thick = 0.6778 + 1.1536 * rest**-0.326
    shape = np.where(entrainment >= 5.3, thin, thick)
    return np.asarray(np.minimum(shape, LARGEST_SHAPE), dtype=np.float64)


def turbulent_friction(shape: FloatArray, reynolds: FloatArray) -> FloatArray:
    """Friction coefficient of Ludwieg and Tillmann from H and Re_theta."""
    factor = 0.246 * 10.0 ** (-0.678 * shape)
    return np.asarray(factor * np.maximum(reynolds, 1.0) ** -0.268, dtype=np.float64)


def entrainment_rate(entrainment: FloatArray) -> FloatArray:
    """Head's entrainment velocity / edge speed from H1."""
    return np.asarray(0.0306 * np.maximum(entrainment - 3.0, 1e-6) ** -0.6169, dtype=np.float64)
