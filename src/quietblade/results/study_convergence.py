# SPDX-License-Identifier: LGPL-2.1-or-later
"""Numerical uncertainty of a figure from three meshes: the grid convergence index.

I. B. Celik, U. Ghia, P. J. Roache, C. J. Freitas, H. Coleman and P. E. Raad, Procedure for
Estimation and Reporting of Uncertainty Due to Discretization in CFD Applications, J. Fluids Eng.
130 (2008) 078001.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

Behaviour = Literal["monotonic", "oscillatory", "diverging", "settled"]

SAFETY = 1.25
"""Factor of the index for three meshes (Celik et al., step 5)."""

LEAST_ORDER, LARGEST_ORDER = 0.5, 4.0
"""Orders beyond which the index is not believed: they are clipped to this range, which lies around
the two to four of second-order elements (Eca and Hoekstra, J. Comput. Phys. 262 (2014) 104)."""

_PASSES = 200


@dataclass(frozen=True)
class GridConvergence:
    """What three meshes say about a figure.

    Attributes
    ----------
    values : (float, float, float)
        On the finest mesh first.
    ratios : (float, float)
        Size of the medium over the fine cells, and of the coarse over the medium.
    behaviour : {"monotonic", "oscillatory", "diverging", "settled"}
        ``diverging``: the finer pair differs more than the coarser one; ``settled``: the three
        values are the same to rounding.
    order : float
        Observed order p; nan if there is none.
    extrapolated : float
        Value on a mesh of vanishing size; nan if there is none.
    uncertainty : float
        Half width of the range in which the exact value of the model is expected, in the unit of
        the values. Without an order it is that of first order.
    """

    values: tuple[float, float, float]
    ratios: tuple[float, float]
    behaviour: Behaviour
    order: float
    extrapolated: float
    uncertainty: float

    @property
    def relative_error(self) -> float:
        """Change from the medium to the fine mesh over the fine value, e_a."""
        fine, medium, _ = self.values
        return abs((fine - medium) / fine) if fine else float("nan")

    @property
    def extrapolated_error(self) -> float:
        """Difference of fine and extrapolated over the extrapolated value, e_ext."""
        exact = self.extrapolated
        return abs((exact - self.values[0]) / exact) if exact else float("nan")

    @property
    def index(self) -> float:
        """Grid convergence index of the fine mesh: the uncertainty over the fine value."""
        return self.uncertainty / abs(self.values[0]) if self.values[0] else float("nan")


def grid_convergence(
    sizes: Sequence[float], values: Sequence[float], *, clip: bool = True
) -> GridConvergence:
    """Estimate the uncertainty of a figure from three meshes.

    Parameters
    ----------
    sizes : sequence of 3 floats
        Representative cell sizes h, the smallest first; ``nodes**(-1/3)`` in three dimensions, as
        only their ratios matter.
    values : sequence of 3 floats
        The figure on these meshes.
    clip : bool
        Whether the order is clipped to a range that is believed.

    Raises
    ------
    ValueError
        There are not three different sizes in ascending order, or a value is not finite.
    """
    (h1, h2, h3), (f1, f2, f3) = sizes, values
    if not 0.0 < h1 < h2 < h3:
        raise ValueError(f"grid convergence: sizes {h1:g}, {h2:g}, {h3:g} do not ascend")
    if not np.all(np.isfinite(values)):
        raise ValueError("grid convergence: a value is not finite")
    ratios = (h2 / h1, h3 / h2)
    fine, coarse = f2 - f1, f3 - f2
    given = (float(f1), float(f2), float(f3))
    if max(abs(fine), abs(coarse)) <= 1e-12 * max(abs(f1), abs(f2), abs(f3)):
        return GridConvergence(given, ratios, "settled", float("nan"), float(f1), 0.0)
    order = _order(ratios, fine, coarse)
    behaviour: Behaviour = "monotonic" if fine * coarse > 0.0 else "oscillatory"
    if not order > 0.0:
        uncertainty = SAFETY * abs(fine) / (ratios[0] - 1.0)
        nan = float("nan")
        return GridConvergence(given, ratios, "diverging", nan, nan, uncertainty)
    used = min(max(order, LEAST_ORDER), LARGEST_ORDER) if clip else order
    growth = ratios[0] ** used
    extrapolated = (growth * f1 - f2) / (growth - 1.0)
    uncertainty = SAFETY * abs(fine) / (growth - 1.0)
    if behaviour == "oscillatory":  # the spread of the values is the least that can be said
        uncertainty = max(uncertainty, 0.5 * (max(values) - min(values))) if clip else uncertainty
    return GridConvergence(given, ratios, behaviour, order, float(extrapolated), float(uncertainty))


def _order(ratios: tuple[float, float], fine: float, coarse: float) -> float:
    """Observed order p by fixed-point iteration (Celik et al., eqs 3a to 3c); nan if none."""
    if fine == 0.0 or coarse == 0.0:
        return LARGEST_ORDER if fine == 0.0 else float("nan")
    r21, r32 = ratios
    sign = np.sign(coarse / fine)
    spread = np.log(abs(coarse / fine))
    order = abs(spread) / np.log(r21)
    for _ in range(_PASSES):
        upper, lower = r21**order - sign, r32**order - sign
        if upper <= 0.0 or lower <= 0.0:
            return float("nan")
        new = abs(spread + np.log(upper / lower)) / np.log(r21)
        if abs(new - order) < 1e-10:
            break
        order = 0.5 * (order + new)
    # |.| hides a finer pair that differs more than the coarser: then nothing converges
    grows = spread + np.log((r21**order - sign) / (r32**order - sign)) < 0.0
    return float("nan") if grows else float(order)
