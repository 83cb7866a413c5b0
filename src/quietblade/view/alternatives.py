# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pictures of what parts of a model do to modes and peaks."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from quietblade.results.alternatives import AlternativeTable
from quietblade.typing import AnyArray, FloatArray
from quietblade.view.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    PURPLE,
    SKY,
    VERMILION,
    new_figure,
    styled,
)

STEPS: Mapping[str, tuple[str, str]] = {
    "shape": ("deformed shape", BLUE),
    "both": ("+ stress", VERMILION),
    "load": ("+ stiffness of the pressure", GREEN),
    "C1": ("+ spin softening = C1", PURPLE),
}
"""Alternatives of a decomposition in the order in which they add up, their labels and colours."""

_ALONE = "stress"
_DRAWN = 25.0  # %: a mode that moves farther is another one, and would flatten all the others
_GROUP = 0.8  # width of a group of bars


def modes_with_peak(table: AlternativeTable) -> tuple[int, ...]:
    """Columns of the modes that are in both and make a peak in the first or last alternative."""
    seen = np.isfinite(table.peak_level[[0, -1]]).any(axis=0)
    matched = np.isfinite(table.frequency[[0, -1]]).all(axis=0)
    return tuple(np.flatnonzero(seen & matched).tolist())


def modes_drawn(table: AlternativeTable) -> tuple[int, ...]:
    """Columns of the modes with a peak that keep near their frequency."""
    change = 100.0 * np.abs(table.frequency[-1] / table.frequency[0] - 1.0)
    return tuple(k for k in modes_with_peak(table) if change[k] <= _DRAWN)


@styled
def draw_shift(tables: Mapping[str, AlternativeTable]) -> Figure:
    """Change of frequency and peak level from C0 to C1, step by step; blades side by side.

    Modes that move by more than a quarter are left out (`modes_drawn`).

    Parameters
    ----------
    tables : mapping of str to AlternativeTable
        Decompositions by the name of the blade.
    """
    figure = new_figure(4.4)
    panels = figure.subplots(2, len(tables), squeeze=False, sharex="col")
    for (upper, lower), (name, table) in zip(panels.T, tables.items(), strict=True):
        shown = modes_drawn(table)
        _waterfall(upper, table, shown)
        _levels(lower, table, shown)
        lower.set_xticks(range(len(shown)), [table.mode[k] for k in shown])
        upper.set_title(name)
        for axes in (upper, lower):
            axes.use_sticky_edges = False  # bars keep clear of the frame too
            axes.margins(y=0.1)
    panels[0, 0].set_ylabel("Natural frequency\nagainst C0 [%]")
    panels[1, 0].set_ylabel("Level of the peak\nagainst C0 [dB]")
    figure.legend(*panels[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return figure


def _waterfall(axes: Axes, table: AlternativeTable, shown: Sequence[int]) -> None:
    """Each step begins where the one before ends; the last one ends at C1."""
    shift = 100.0 * (table.frequency / table.frequency[0] - 1.0)[:, list(shown)]
    width = _GROUP / len(STEPS)
    before = np.zeros(len(shown))
    for order, (name, (label, color)) in enumerate(STEPS.items()):
        after = shift[table.row(name)]
        place = np.arange(len(shown)) + (order + 0.5) * width - 0.5 * _GROUP
        axes.bar(place, after - before, width, before, color=color, label=label)
        _join(axes, place, after, width)
        before = after
    left = np.arange(len(shown)) - 0.5 * _GROUP
    axes.hlines(before, left, left + _GROUP, color=BLACK, linewidth=0.8, linestyle=":")
    axes.plot(
        np.arange(len(shown)), shift[table.row(_ALONE)], "D", markersize=4.0,
        markerfacecolor="white", color=BLACK, label="stress alone, on the shape at rest",
    )  # fmt: skip
    axes.axhline(0.0, color=GREY, linewidth=0.7)


def _join(axes: Axes, place: AnyArray, level: AnyArray, width: float) -> None:
    """Thin line from the end of a step to the beginning of the next."""
    axes.hlines(level, place - 0.5 * width, place + 1.5 * width, color=GREY, linewidth=0.6)


def _levels(axes: Axes, table: AlternativeTable, shown: Sequence[int]) -> None:
    rise = (table.peak_level - table.peak_level[0])[:, list(shown)]
    width = _GROUP / len(STEPS)
    for order, (name, (_, color)) in enumerate(STEPS.items()):
        place = np.arange(len(shown)) + (order + 0.5) * width - 0.5 * _GROUP
        axes.bar(place, rise[table.row(name)], width, color=color)
    axes.plot(
        np.arange(len(shown)), rise[table.row(_ALONE)], "D", markersize=4.0,
        markerfacecolor="white", color=BLACK,
    )  # fmt: skip
    axes.axhline(0.0, color=GREY, linewidth=0.7)


@styled
def draw_costs(
    names: Sequence[str], changes: Mapping[str, FloatArray], title: str, unit: str = "dB"
) -> Figure:
    """Bars of what each change does to some figures.

    Parameters
    ----------
    names : (n,) sequence of str
        The figures, such as names of modes.
    changes : mapping of str to (n,) array
        Change of each figure by name of what is changed; nan draws no bar.
    title, unit : str
    """
    figure = new_figure(1.0 + 0.32 * len(changes) + 0.16 * len(changes) * len(names))
    axes = figure.subplots()
    colors = (BLUE, VERMILION, GREEN, PURPLE, SKY, BLACK)
    height = _GROUP / len(names)
    for order, name in enumerate(names):
        values = np.array([change[order] for change in changes.values()])
        place = np.arange(len(changes)) + (order + 0.5) * height - 0.5 * _GROUP
        axes.barh(place, values, height, color=colors[order % len(colors)], label=name)
        for y, value in zip(place, values, strict=True):
            if np.isfinite(value):
                side = "left" if value >= 0.0 else "right"
                axes.annotate(
                    f"{value:+.1f}", (value, y), (3 if value >= 0.0 else -3, 0),
                    textcoords="offset points", va="center", ha=side, fontsize=7.0,
                )  # fmt: skip
    axes.set_yticks(range(len(changes)), list(changes))
    axes.invert_yaxis()
    axes.axvline(0.0, color=GREY, linewidth=0.7)
    axes.margins(x=0.18)
    axes.set(xlabel=f"Change of the level [{unit}]", title=title)
    axes.legend(loc="best")
    return figure
