# SPDX-License-Identifier: LGPL-2.1-or-later
"""NACA section families, by name and by designation."""

import re
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from quietblade.errors import GeometryError
from quietblade.geometry.mean_lines import DesignLoad, FiveDigitLine, MeanLine, TwoParabolas
from quietblade.geometry.sections import SectionFamily
from quietblade.geometry.thickness_forms import naca_4, naca_16, naca_66
from quietblade.typing import FloatArray


@dataclass(frozen=True)
class NacaFamily(SectionFamily):
    """A thickness form laid off perpendicular to a mean line, with an edge of exact thickness.

    The form gets a linear wedge, so that the edge is ``te`` thick; the wedge alters the largest
    thickness slightly (NACA 0006 with te = 0.6 %: 6.14 % instead of 6 %).

    Attributes
    ----------
    label : str
        Name of the family.
    form : callable
        Half thickness / largest thickness at chord fractions; see `thickness_forms`.
    line : MeanLine
    """

    label: str
    form: Callable[[FloatArray], FloatArray]
    line: MeanLine

    @property
    def name(self) -> str:
        """Name in a case file."""
        return self.label

    def half_thickness(self, x: ArrayLike, thickness: ArrayLike, te: ArrayLike) -> FloatArray:
        """Half thickness y_t(x) = t form(x) + x (te/2 - t form(1)) (theory: S1-5).

        Parameters
        ----------
        x, thickness, te : array_like
            Chord fraction, largest thickness / chord, edge thickness / chord; broadcast.

        Returns
        -------
        ndarray
            Half thickness / chord.
        """
        x, t = np.asarray(x, dtype=np.float64), np.asarray(thickness, dtype=np.float64)
        wedge = 0.5 * np.asarray(te, dtype=np.float64) - t * self.form(np.array(1.0))
        return np.asarray(t * self.form(x) + x * wedge, dtype=np.float64)

    def camber_line(self, x: ArrayLike, camber: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Mean line scaled to the largest camber.

        Parameters
        ----------
        x, camber : array_like
            Chord fraction, largest camber / chord; broadcast.

        Returns
        -------
        tuple of ndarray
            Height / chord and slope dy/dx. Where the line's own slope is infinite, the slope is
            that to which thickness is laid off.
        """
        m = np.asarray(camber, dtype=np.float64)
        height, slope = self.line.unit(np.asarray(x, dtype=np.float64))
        return m * height, m * slope


class NacaFourDigit(NacaFamily):
    """NACA four-digit sections.

    Parameters
    ----------
    camber_position : float
        Chord fraction of the largest camber (second digit / 10).
    """

    def __init__(self, camber_position: float = 0.4) -> None:
        label = "naca-4" if camber_position == 0.4 else f"naca-4-p{100 * camber_position:02.0f}"
        super().__init__(label, naca_4, TwoParabolas(camber_position))


class NacaFiveDigit(NacaFamily):
    """NACA five-digit sections.

    Parameters
    ----------
    position : int
        Second digit: 1 to 5 for the largest camber at 5 to 25 % of the chord.
    reflexed : bool
        Third digit.
    """

    def __init__(self, position: int, reflexed: bool = False) -> None:
        line = FiveDigitLine(position, reflexed)
        super().__init__(f"naca-5-2{position}{int(reflexed)}", naca_4, line)


class NacaSixteen(NacaFamily):
    """NACA 16-series sections on the mean line ``a``."""

    def __init__(self, a: float = 1.0) -> None:
        super().__init__(f"naca-16-a{10 * a:02.0f}", naca_16, DesignLoad(a))


class NacaSixtySix(NacaFamily):
    """NACA 66 (DTMB modified) sections on the mean line ``a``."""

    def __init__(self, a: float = 0.8) -> None:
        super().__init__(f"naca-66-a{10 * a:02.0f}", naca_66, DesignLoad(a))


FAMILIES: dict[str, SectionFamily] = {
    family.name: family
    for family in (
        NacaFourDigit(),
        *(NacaFiveDigit(position) for position in range(1, 6)),
        *(NacaFiveDigit(position, reflexed=True) for position in range(2, 6)),
        NacaSixteen(1.0),
        NacaSixteen(0.8),
        NacaSixtySix(0.8),
        NacaSixtySix(1.0),
    )
}
"""Section families by the name that a case file uses."""


def section_family(name: str) -> SectionFamily:
    """Return a family by name.

    Raises
    ------
    GeometryError
        No such family; the message lists those that exist.
    """
    try:
        return FAMILIES[name]
    except KeyError:
        raise GeometryError(
            f"section family {name!r} does not exist; use one of {', '.join(sorted(FAMILIES))}"
        ) from None


def naca_designation(digits: str) -> tuple[SectionFamily, float, float]:
    """Family, thickness / chord and camber / chord of a designation such as ``"2412"``.

    Parameters
    ----------
    digits : str
        Four digits (camber, its place, thickness), or five that begin with the published design
        lift (``23012``, reflexed ``23112``). Other design lifts (first digit 1 to 9) scale it.

    Raises
    ------
    GeometryError
        No such designation.
    """
    if re.fullmatch(r"\d{4}", digits) and digits[2:] != "00":
        camber, place = int(digits[0]) / 100.0, int(digits[1]) / 10.0
        if (camber > 0.0) == (place > 0.0):
            return NacaFourDigit(place or 0.4), int(digits[2:]) / 100.0, camber
    if re.fullmatch(r"[1-9][1-5][01]\d\d", digits) and digits[3:] != "00":
        family = NacaFiveDigit(int(digits[1]), digits[2] == "1")
        line = FiveDigitLine(int(digits[1]), digits[2] == "1")
        lift = 0.15 * int(digits[0])
        return family, int(digits[3:]) / 100.0, line.camber_at_design_lift * lift / 0.3
    raise GeometryError(
        f"there is no NACA section {digits!r} of four or five digits; examples: 0012, 2412, 23012"
    )
