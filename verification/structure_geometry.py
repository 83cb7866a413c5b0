# SPDX-License-Identifier: LGPL-2.1-or-later
"""Section shapes against published ordinates and section constants."""

from functools import cache

import numpy as np

from quietblade.geometry import NacaFourDigit
from quietblade.geometry.sections import SectionMoments, section_moments
from verification.registry import check

_OPEN_EDGE = 0.0105 * 2  # edge thickness / largest thickness of the original polynomial

# Abbott and von Doenhoff, Theory of Wing Sections (1959), appendix I: NACA 0012, in % of the chord
_NACA_0012 = np.array(
    [
        [1.25, 1.894], [2.5, 2.615], [5.0, 3.555], [7.5, 4.200], [10.0, 4.683], [15.0, 5.345],
        [20.0, 5.737], [25.0, 5.941], [30.0, 6.002], [40.0, 5.803], [50.0, 5.294], [60.0, 4.563],
        [70.0, 3.664], [80.0, 2.623], [90.0, 1.448], [95.0, 0.807], [100.0, 0.126],
    ]
)  # fmt: skip


@cache
def _moments(thickness: float) -> SectionMoments:
    xy = NacaFourDigit().contour(thickness, 0.0, _OPEN_EDGE * thickness, 4001)
    return section_moments(xy)


@check(
    "structure/naca-0012-ordinates",
    quantity="largest difference from the published ordinates (% of the chord)",
    reference=0.0,
    source="Abbott, von Doenhoff (1959), Theory of Wing Sections, appendix I",
    tolerance=5.5e-4,  # half the last digit; at 20 % the table prints 5.737 for 5.73754
)
def naca_0012_ordinates() -> float:
    """Compare the half thickness with the printed table."""
    x, y = _NACA_0012.T
    computed = 100.0 * NacaFourDigit().half_thickness(x / 100.0, 0.12, _OPEN_EDGE * 0.12)
    return float(np.max(np.abs(computed - y)))


@check(
    "structure/naca-4-nose-radius",
    quantity="nose radius / (chord * thickness^2)",
    reference=1.1019,
    source="Abbott, von Doenhoff (1959), eq. 6.3",
    tolerance=5e-5,  # the last printed digit
)
def naca_nose_radius() -> float:
    """Take the limit of y^2 / (2 x) at the nose."""
    x, y = NacaFourDigit().point(-1e-5, 0.06, 0.0, 0.006)
    return float(y**2 / (2.0 * x) / 0.06**2)


@check(
    "structure/naca-4-area",
    quantity="section area / (chord * thickness)",
    reference=0.68508,
    source="integral of the 4-digit polynomial, open edge (NACA Report 460)",
    tolerance=1e-5,  # the last digit of the reference, and the polygon
)
def naca_area() -> float:
    """Integrate over the polygon of the contour."""
    return float(_moments(0.06).area) / 0.06


@check(
    "structure/naca-4-inertia",
    quantity="second moment of area about the chord / (chord * thickness^3)",
    reference=0.039407,
    source="integral of the cubed 4-digit polynomial, open edge (NACA Report 460)",
    tolerance=1e-6,  # the last digit of the reference, and the polygon
)
def naca_inertia() -> float:
    """Integrate over the polygon of the contour."""
    return float(_moments(0.06).ixx) / 0.06**3
