# SPDX-License-Identifier: LGPL-2.1-or-later
"""Limits laid over levels."""

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes

from quietblade.results.model import ConfigurationResult
from quietblade.typing import FloatArray, IntArray
from quietblade.view.style import BLACK, CONFIGURATION, GREY, Stroke

LIMITS = (
    Stroke(BLACK, (0, (6.0, 1.5, 1.0, 1.5)), 1.1),
    Stroke(BLACK, (0, (1.0, 1.5)), 1.3),
    Stroke(GREY, (0, (8.0, 3.0)), 1.3),
)
"""One limit after the other."""

_HALF = {"decidecade": 10.0**0.05, "third-octave": 2.0 ** (1.0 / 6.0)}  # centre to edge


def chosen_limits(configuration: ConfigurationResult, quantity: str, bands: str) -> list[int]:
    """Places of the limits of a quantity in a kind of bands, or narrow ones."""
    table = configuration.limits
    kinds = zip(table.quantity, table.bands, strict=True)
    return [i for i, kind in enumerate(kinds) if kind == (quantity, bands)]


def rows_of(configuration: ConfigurationResult, limit: int) -> IntArray:
    """Rows of a limit."""
    return np.flatnonzero(configuration.limits.row_of == limit)


def draw_narrow_limits(
    axes: Axes, members: Mapping[str, ConfigurationResult], quantity: str
) -> FloatArray:
    """Draw the limits of each frequency, shade what is above them, and tell the worst excess.

    Returns
    -------
    (n,) array
        The levels of the limits, to keep them in sight.
    """
    drawn = [np.zeros(0)]
    first = next(iter(members.values()))
    for limit in chosen_limits(first, quantity, "narrow"):
        stroke = LIMITS[limit % len(LIMITS)]
        for name, configuration in members.items():
            table, rows = configuration.limits, rows_of(configuration, limit)
            f, found, allowed = (
                values[rows] for values in (table.frequency, table.found, table.allowed)
            )
            axes.fill_between(
                f, allowed, found, where=found > allowed,
                color=CONFIGURATION[name].color, alpha=0.3, linewidth=0.0,
            )  # fmt: skip
            if configuration is first:
                label = f"limit: {table.name[limit]}"
                axes.plot(f, allowed, label=label, **stroke.options())
            drawn.append(allowed)
            _mark_worst(axes, name, configuration, limit)
    return np.concatenate(drawn)


def _mark_worst(axes: Axes, name: str, configuration: ConfigurationResult, limit: int) -> None:
    table, rows = configuration.limits, rows_of(configuration, limit)
    if not table.worst_excess[limit] > 0.0:
        return
    row = rows[np.nanargmax(table.excess[rows])]
    rest = name == "C0"
    axes.annotate(
        f"+{table.worst_excess[limit]:.1f} dB", (table.frequency[row], table.found[row]),
        xytext=(-5 if rest else 5, -3), textcoords="offset points", va="top",
        ha="right" if rest else "left", fontsize=7.5, color=CONFIGURATION[name].color,
        bbox={"facecolor": "white", "alpha": 0.8, "pad": 0.5, "linewidth": 0.0},
    )  # fmt: skip
    axes.plot(
        table.frequency[row], table.found[row], "^", color=CONFIGURATION[name].color,
        markersize=5.0, markerfacecolor="white",
    )  # fmt: skip


def band_edges(centre: FloatArray, kind: str) -> tuple[FloatArray, FloatArray]:
    """Lower and upper edges of bands of a kind [Hz]."""
    return centre / _HALF[kind], centre * _HALF[kind]
