# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where the power goes over frequency, and the complex moduli that decide it."""

from itertools import cycle

import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter, StrMethodFormatter

from quietblade.results.model import Dissipation, ModulusTable, Result
from quietblade.typing import FloatArray
from quietblade.view.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    PURPLE,
    SERIES,
    SKY,
    VERMILION,
    new_figure,
    styled,
)

_FREQUENCY = "Frequency [Hz]"
_TITLES = {"C0": "C0, at rest", "C1": "C1, under load"}
_SINKS = {
    "water": (SKY, ""),
    "film": (VERMILION, "//"),
    "blade": (GREY, ".."),
    "stream": (GREEN, "\\\\"),
}
"""Colour and hatching of each part, told apart in print without colours too."""
_LONG = 60.0  # ratio of the ends of a logarithmic axis on which few numbers have room
_OTHERS = ((PURPLE, "xx"), (BLUE, "++"))


@styled
def draw_power_shares(result: Result) -> Figure:
    """Shares of each region and of the water in the injected power, over frequency."""
    figure = new_figure(2.1 * max(len(result.configurations), 1) + 0.5)
    axes = figure.subplots(max(len(result.configurations), 1), sharex=True, squeeze=False)[:, 0]
    for ax, (name, configuration) in zip(axes, result.configurations.items(), strict=False):
        _shares(ax, configuration.dissipation, configuration.spectrum.frequency)
        ax.set(title=_TITLES[name], ylabel="Share of the power [%]")
    handles = {
        label: handle
        for ax in axes
        for handle, label in zip(*ax.get_legend_handles_labels(), strict=True)
    }
    figure.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=4)
    axes[-1].set_xlabel(_FREQUENCY)
    return figure


def _shares(ax: Axes, paths: Dissipation, frequency: FloatArray) -> None:
    solved = np.isfinite(paths.power).all(axis=0)
    shares = 100.0 * paths.power[:, solved] / paths.power[:, solved].sum(axis=0)
    others = cycle(_OTHERS)
    looks = [_SINKS[sink] if sink in _SINKS else next(others) for sink in paths.sink]
    areas = ax.stackplot(
        frequency[solved], shares, labels=paths.sink, colors=[color for color, _ in looks]
    )
    for area, (_, hatch) in zip(areas, looks, strict=True):
        area.set(hatch=hatch, edgecolor="white", linewidth=0.0)
    for peak in paths.peak_frequency:
        ax.axvline(peak, color=BLACK, linewidth=0.6, linestyle=":")
    ax.set(xlim=(frequency[0], frequency[-1]), ylim=(0.0, 100.0))
    ax.grid(visible=False)


@styled
def draw_moduli(result: Result) -> Figure:
    """Storage modulus and loss factor of the regions over frequency, with measured points."""
    table = result.moduli
    figure = new_figure(3.1)
    left, right = figure.subplots(1, 2)
    absolute = bool(np.all(np.isfinite(table.static)))
    scale = table.static / 1e6 if absolute else np.ones(len(table.name))
    for i, stroke in zip(range(len(table.name)), cycle(SERIES), strict=False):
        ratio, label = table.ratio[i], _label(table, i)
        left.plot(table.frequency, scale[i] * ratio.real, label=label, **stroke.options())
        right.plot(table.frequency, ratio.imag / ratio.real, **stroke.options())
        own = table.measured_modulus == i
        f, points = table.measured_frequency[own], table.measured_ratio[own]
        for ax, values in ((left, scale[i] * points.real), (right, points.imag / points.real)):
            ax.plot(f, values, "o", color=stroke.color, markersize=3.5, markerfacecolor="none")
    for ax in (left, right):
        ax.axvspan(*table.band, color="0.92", zorder=0)
        ax.set(xscale="log", xlabel=_FREQUENCY, xlim=table.frequency[[0, -1]])
        _plain_numbers(ax.xaxis)
    left.set(yscale="log", ylabel=f"Storage modulus {'[MPa]' if absolute else 'over static [–]'}")
    _plain_numbers(left.yaxis)
    right.set(ylabel="Loss factor [–]")
    right.set_ylim(bottom=0.0)
    figure.legend(
        *left.get_legend_handles_labels(),
        loc="outside lower center",
        ncols=2,
        title="lines: model; grey: band"
        + ("; circles: measured, moved to that temperature" if table.measured_ratio.size else ""),
        title_fontsize=7.5,
    )
    return figure


def _plain_numbers(axis: Axis) -> None:
    """Write 1, 2, 5, 10 on a logarithmic axis, and 1, 10, 100 on a long one."""
    low, high = axis.get_view_interval()
    axis.set_major_locator(LogLocator(subs=(1.0,) if high > _LONG * low else (1.0, 2.0, 5.0)))
    axis.set_major_formatter(StrMethodFormatter("{x:g}"))
    axis.set_minor_formatter(NullFormatter())


def _label(table: ModulusTable, i: int) -> str:
    text = f"{table.name[i]}: {table.model[i]}"
    if np.isfinite(table.temperature[i]):
        text += f", {table.temperature[i] - 273.15:.1f} °C"
    if np.isfinite(table.fit_error[i]):
        text += f", fit within {100.0 * table.fit_error[i]:.2g} %"
    return text
