# SPDX-License-Identifier: LGPL-2.1-or-later
"""Curves of the loads and of the transfer functions."""

from collections.abc import Callable, Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator

from quietblade.results.model import REFERENCE_POWER, ConfigurationResult, Result, path
from quietblade.typing import AnyArray, FloatArray
from quietblade.view.style import BLACK, SERIES, Stroke, new_figure, styled

_FREQUENCY = "Frequency [Hz]"
_TITLES = {"C0": "C0, at rest", "C1": "C1, under load"}
_DYNAMIC = 80.0  # dB that a curve of powers may fall below the highest
_AXES = "xyz"


def drawings(result: Result) -> Mapping[str, Callable[[], Figure]]:
    """Figures that the loads and transfer functions of a result give reason for, by name."""
    first = next(iter(result.configurations.values()))
    functions = first.transfer.functions
    found: dict[str, Callable[[], Figure]] = {}
    if len(first.excitations.name) > 1:
        found["power-by-load"] = lambda: draw_power_by_load(result)
    if "mobility" in functions:
        found["mobility"] = lambda: draw_mobility(result)
    if "power-per-force" in functions:
        found["power-per-force"] = lambda: draw_power_per_force(result)
    if "blocked-force" in functions or "shaft" in functions:
        found["root-forces"] = lambda: draw_root_forces(result)
    return found


@styled
def draw_power_by_load(result: Result) -> Figure:
    """Sound power of each load alone, and of all together."""
    figure, axes = _rows(result)
    for ax, (name, configuration) in zip(axes, result.configurations.items(), strict=True):
        loads, f = configuration.excitations, configuration.spectrum.frequency
        total = configuration.spectrum.power[path("sphere")]
        ax.plot(f, _level(total), color=BLACK, linewidth=1.0, label="all together")
        for load, power, stroke in zip(loads.name, loads.radiated, _strokes(), strict=False):
            ax.plot(f, _level(power), label=load, **stroke.options())
        label = f"Sound power level\n[dB re {loads.level_reference}]"
        ax.set(title=_TITLES[name], ylabel=label, xlim=(f[0], f[-1]))
        _keep_readable(ax)
    return _finished(figure, axes)


@styled
def draw_mobility(result: Result) -> Figure:
    """Drive-point mobility of each load."""
    turned = any("rad" in unit for unit in _first(result).excitations.unit)
    label = r"$|Y|$ [m/(s N)]" + (" or [rad/(s N m)]" if turned else "")
    return _by_load(result, lambda c: np.abs(c.transfer.mobility), label)


@styled
def draw_power_per_force(result: Result) -> Figure:
    """Radiated power of each load alone per mean square force."""
    return _by_load(result, lambda c: c.transfer.power_per_force, r"$W/\overline{F^2}$ [W/N$^2$]")


@styled
def draw_root_forces(result: Result) -> Figure:
    """Force and moment on the root, and the power into a shaft beside the sound power."""
    first = _first(result)
    shaft = "shaft" in first.transfer.functions
    per = "/$\\sqrt{Hz}$" if first.random else ""
    count = len(result.configurations)
    figure = new_figure(0.6 + (6.0 if shaft else 4.0))
    grid = figure.subplots(3 if shaft else 2, count, sharex=True, sharey="row", squeeze=False)
    for column, (name, configuration) in enumerate(result.configurations.items()):
        transfer, f = configuration.transfer, configuration.spectrum.frequency
        for ax, values, title in (
            (grid[0, column], transfer.root_force, f"Force [N{per}]"),
            (grid[1, column], transfer.root_moment, f"Moment [N m{per}]"),
        ):
            for axis, value, stroke in zip(_AXES, values, _strokes(), strict=False):
                ax.semilogy(f, value, label=f"along or about {axis}", **stroke.options())
            ax.yaxis.set_major_locator(LogLocator(numticks=6))
            ax.set(ylabel=title if column == 0 else "", xlim=(f[0], f[-1]))
        grid[0, column].set_title(_TITLES[name])
        if shaft:
            ax = grid[2, column]
            sound = configuration.spectrum.power[path("sphere")]
            ax.plot(f, _level(sound), color=BLACK, linewidth=1.0, label="sound, root clamped")
            ax.plot(f, _level(transfer.shaft_power), label="into the shaft", **SERIES[3].options())
            reference = configuration.excitations.level_reference
            ax.set(ylabel=f"Power level\n[dB re {reference}]" if column == 0 else "")
            _keep_readable(ax)
        grid[-1, column].set_xlabel(_FREQUENCY)
    handles, labels = grid[0, 0].get_legend_handles_labels()
    if shaft:
        more = grid[2, 0].get_legend_handles_labels()
        handles, labels = handles + more[0], labels + more[1]
    figure.legend(handles, labels, loc="outside lower center", ncols=3)
    return figure


def _by_load(
    result: Result, values: Callable[[ConfigurationResult], AnyArray], label: str
) -> Figure:
    """One curve a load over frequency, with a logarithmic axis."""
    figure, axes = _rows(result)
    for ax, (name, configuration) in zip(axes, result.configurations.items(), strict=True):
        f, names = configuration.spectrum.frequency, configuration.excitations.name
        for load, value, stroke in zip(names, values(configuration), _strokes(), strict=False):
            ax.semilogy(f, value, label=load, **stroke.options())
        ax.set(title=_TITLES[name], ylabel=label, xlim=(f[0], f[-1]))
    return _finished(figure, axes)


def _first(result: Result) -> ConfigurationResult:
    return next(iter(result.configurations.values()))


def _strokes() -> list[Stroke]:
    """Strokes for any number of curves; more than those of a series come again thin."""
    thin = [Stroke(stroke.color, stroke.linestyle, 0.7) for stroke in SERIES]
    return [*SERIES, *thin] * 4


def _rows(result: Result) -> tuple[Figure, list[Axes]]:
    count = len(result.configurations)
    figure = new_figure(0.5 + 2.3 * count)
    return figure, list(figure.subplots(count, sharex=True, squeeze=False)[:, 0])


def _finished(figure: Figure, axes: list[Axes]) -> Figure:
    axes[-1].set_xlabel(_FREQUENCY)
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return figure


def _level(power: FloatArray) -> FloatArray:
    positive = np.where(power > 0.0, power, np.nan)
    return np.asarray(10.0 * np.log10(positive / REFERENCE_POWER), dtype=np.float64)


def _keep_readable(axes: Axes) -> None:
    """Cut what is far below the highest level."""
    values = np.concatenate([np.asarray(line.get_ydata(), dtype=float) for line in axes.lines])
    values = values[np.isfinite(values)]
    if values.size:
        top = float(values.max())
        axes.set_ylim(max(float(values.min()), top - _DYNAMIC) - 3.0, top + 2.0)
