# SPDX-License-Identifier: LGPL-2.1-or-later
"""Mean lines on the unit chord, scaled to a largest camber of 1.

References
----------
Abbott, von Doenhoff, *Theory of Wing Sections* (1959), sections 4.4, 4.5 and 6.4 to 6.6;
Jacobs, Pinkerton, NACA Report 537 (1935) for the five-digit lines, straight and reflexed.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
from scipy.special import xlogy

from quietblade.errors import GeometryError
from quietblade.typing import FloatArray

NOSE_SLOPE = 0.005
"""Chord fraction at which the infinite slopes at the ends of mean lines of constant load are taken,
as Abbott and von Doenhoff do to draw the nose."""


class MeanLine(Protocol):
    """A mean line of largest height 1 on the chord from 0 to 1."""

    def unit(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Height and slope at chord fractions (...)."""
        ...


@dataclass(frozen=True)
class TwoParabolas:
    """Two parabolas that meet at the highest point: NACA four-digit sections.

    Attributes
    ----------
    position : float
        Chord fraction of the largest camber.
    """

    position: float

    def __post_init__(self) -> None:
        if not 0.0 < self.position < 1.0:
            raise GeometryError(
                f"mean line: largest camber at chord fraction {self.position:g}; "
                "it must lie between 0 and 1"
            )

    def unit(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Height and slope at chord fractions (...)."""
        p = self.position
        curvature = 1.0 / np.where(x < p, p**2, (1.0 - p) ** 2)
        return 1.0 - curvature * (x - p) ** 2, -2.0 * curvature * (x - p)


@dataclass(frozen=True)
class DesignLoad:
    """NACA mean line of constant load from the nose to x = a, and falling to 0 from there.

    (theory: S1-70). The slope is infinite at the nose, and at the trailing edge if a = 1. Thickness
    is laid off perpendicular to a slope whose logarithms are rounded off within `NOSE_SLOPE` of
    the ends; heights are exact.

    Attributes
    ----------
    a : float
        Chord fraction to which the load is constant, from 0 to 1.
    """

    a: float

    def __post_init__(self) -> None:
        if not 0.0 <= self.a <= 1.0:
            raise GeometryError(f"mean line: a = {self.a:g}; it must lie between 0 and 1")

    @property
    def ideal_incidence(self) -> float:
        """Incidence of the chord at the ideal lift coefficient 1, in thin-section theory [rad]."""
        return -self._constants[1] / (2.0 * np.pi * (1.0 + self.a))

    @property
    def camber_at_unit_lift(self) -> float:
        """Largest camber / chord whose ideal lift coefficient is 1: 0.0679 for a = 0.8."""
        return self._largest

    def unit(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Height and slope at chord fractions (...)."""
        height, slope = self.at_unit_lift(x)
        return height / self._largest, slope / self._largest

    def at_unit_lift(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Height and slope at chord fractions (...), for the ideal lift coefficient 1."""
        a, (g, h) = self.a, self._constants
        near = 0.5 * np.log(x**2 + NOSE_SLOPE**2)
        if a == 1.0:
            far = 0.5 * np.log((1.0 - x) ** 2 + NOSE_SLOPE**2)
            height = -(xlogy(1.0 - x, 1.0 - x) + xlogy(x, x)) / (4.0 * np.pi)
            return np.asarray(height), np.asarray((far - near) / (4.0 * np.pi))
        head, tail = a - x, 1.0 - x
        rounded = 0.5 * xlogy(head**2, np.abs(head)) - 0.5 * xlogy(tail**2, tail)
        height = (rounded + 0.25 * tail**2 - 0.25 * head**2) / (1.0 - a) - xlogy(x, x) + g - h * x
        bend = (xlogy(tail, tail) - xlogy(head, np.abs(head))) / (1.0 - a)
        factor = 1.0 / (2.0 * np.pi * (1.0 + a))
        slope = bend - near - 1.0 - h
        return np.asarray(factor * height), np.asarray(factor * slope)

    @cached_property
    def _constants(self) -> tuple[float, float]:
        a = self.a
        if a == 1.0:
            return 0.0, 0.0
        g = -(0.5 * xlogy(a**2, a) - 0.25 * a**2 + 0.25) / (1.0 - a)
        rest = 1.0 - a
        return float(g), float(0.5 * rest * np.log(rest) - 0.25 * rest + g)

    @cached_property
    def _largest(self) -> float:
        low, high = 0.05, 0.95  # the slope falls through 0 once
        for _ in range(60):
            middle = 0.5 * (low + high)
            rises = self.at_unit_lift(np.array(middle))[1] > 0.0
            low, high = (middle, high) if rises else (low, middle)
        return float(self.at_unit_lift(np.array(low))[0])


@dataclass(frozen=True)
class FiveDigitLine:
    """Mean line of NACA five-digit sections: a cubic, and a straight line or a second cubic.

    Attributes
    ----------
    position : int
        Second digit, twenty times the chord fraction of the largest camber: 1 to 5.
    reflexed : bool
        Whether the line turns up at the trailing edge, so that thin-section theory gives no
        moment about the quarter chord.
    """

    position: int
    reflexed: bool = False

    def __post_init__(self) -> None:
        if self.position not in (_REFLEXED if self.reflexed else _STRAIGHT):
            raise GeometryError(
                f"mean line: there is no NACA mean line 2{self.position}{int(self.reflexed)}; use "
                "210, 220, 230, 240, 250 or, reflexed, 221, 231, 241, 251"
            )

    def unit(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Height and slope at chord fractions (...)."""
        height, slope = self._cubics(x)
        return height / self._largest, slope / self._largest

    @property
    def camber_at_design_lift(self) -> float:
        """Largest camber / chord of the published lines, whose design lift coefficient is 0.3."""
        constant = _REFLEXED[self.position][2] if self.reflexed else _STRAIGHT[self.position][1]
        return constant / 6.0 * self._largest

    def _cubics(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return height and slope for the constant k1 = 6."""
        m = _REFLEXED[self.position][0] if self.reflexed else _STRAIGHT[self.position][0]
        ratio = _REFLEXED[self.position][1] if self.reflexed else 0.0
        cube = np.where(x < m, 1.0, ratio) * (x - m) ** 3
        steep = -ratio * (1.0 - m) ** 3 - m**3
        slope = 3.0 * np.where(x < m, 1.0, ratio) * (x - m) ** 2 + steep
        return cube + steep * x + m**3, slope

    @cached_property
    def _largest(self) -> float:
        m = _REFLEXED[self.position][0] if self.reflexed else _STRAIGHT[self.position][0]
        ratio = _REFLEXED[self.position][1] if self.reflexed else 0.0
        top = m - np.sqrt((ratio * (1.0 - m) ** 3 + m**3) / 3.0)
        return float(self._cubics(np.array(top))[0])


# Published constants (NACA Report 537): end m of the first cubic, [ratio k2/k1,] k1 for C_L = 0.3
_STRAIGHT = {
    1: (0.0580, 361.400),
    2: (0.1260, 51.640),
    3: (0.2025, 15.957),
    4: (0.2900, 6.643),
    5: (0.3910, 3.230),
}
_REFLEXED = {
    2: (0.1300, 0.000764, 51.990),
    3: (0.2170, 0.00677, 15.793),
    4: (0.3180, 0.0303, 6.520),
    5: (0.4410, 0.1355, 3.191),
}
