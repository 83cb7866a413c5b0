# SPDX-License-Identifier: LGPL-2.1-or-later
"""Thickness forms: half thickness / largest thickness over the chord fraction."""

from functools import cache

import numpy as np
from scipy.interpolate import CubicSpline

from quietblade.typing import FloatArray

# Jacobs, Ward, Pinkerton, NACA Report 460 (1933): open trailing edge
_NACA_4 = (0.2969, -0.1260, -0.3516, 0.2843, -0.1015)

# Brockett, DTMB Report 1780 (1966): NACA 66 (DTMB modified), half thickness / largest thickness
_NACA_66 = np.array(
    [
        [0.0, 0.0], [0.005, 0.0665], [0.0075, 0.0812], [0.0125, 0.1044], [0.025, 0.1466],
        [0.05, 0.2066], [0.075, 0.2525], [0.10, 0.2907], [0.15, 0.3521], [0.20, 0.4000],
        [0.25, 0.4363], [0.30, 0.4637], [0.35, 0.4832], [0.40, 0.4952], [0.45, 0.5000],
        [0.50, 0.4962], [0.55, 0.4846], [0.60, 0.4653], [0.65, 0.4383], [0.70, 0.4035],
        [0.75, 0.3612], [0.80, 0.3110], [0.85, 0.2532], [0.90, 0.1877], [0.95, 0.1143],
        [1.0, 0.0333],
    ]
)  # fmt: skip


def naca_4(x: FloatArray) -> FloatArray:
    """NACA four- and five-digit sections (the polynomial with the open edge)."""
    root, *powers = _NACA_4
    result = root * np.sqrt(x) + np.polynomial.polynomial.polyval(x, [0.0, *powers])
    return np.asarray(5.0 * result, dtype=np.float64)


def naca_16(x: FloatArray) -> FloatArray:
    """NACA 16-series: Lindsey, Stevenson, Daley, NACA Technical Note 1546 (1948)."""
    polyval = np.polynomial.polynomial.polyval
    ahead = 0.989665 * np.sqrt(x) + polyval(x, [0.0, -0.239250, -0.041000, -0.559400])
    behind = polyval(1.0 - x, [0.010000, 2.325000, -3.420000, 1.460000])
    return np.asarray(np.where(x <= 0.5, ahead, behind), dtype=np.float64)


def naca_66(x: FloatArray) -> FloatArray:
    """NACA 66 (DTMB modified), the usual thickness of propeller sections: Brockett (1966).

    A cubic spline through the table, over the contour parameter.
    """
    parameter = 2.0 / np.pi * np.arcsin(np.sqrt(x))
    return np.asarray(_naca_66_spline()(parameter), dtype=np.float64)


@cache
def _naca_66_spline() -> CubicSpline:
    x, y = _NACA_66.T
    phi = 2.0 / np.pi * np.arcsin(np.sqrt(x))
    # Odd about the nose; the chord fraction does not change to first order at the trailing edge.
    return CubicSpline(phi, y, bc_type=("natural", "clamped"))
