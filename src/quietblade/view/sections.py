# SPDX-License-Identifier: LGPL-2.1-or-later
"""Curves of step 1: sections, blade angle and lift along the span, convergence.

One result shows its rigid, chained and coupled states; several show their coupled states beside
the rigid blade.
"""

from collections.abc import Callable, Iterator, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator

from quietblade.results.model import Result, StaticResult, state
from quietblade.results.quantities import LABELS
from quietblade.typing import FloatArray
from quietblade.view.style import BLUE, GREY, SERIES, STATE, VERMILION, Stroke, new_figure, styled

_NAMES = {
    "rigid": "rigid",
    "chained": "chained (rigid blade's load)",
    "coupled": "coupled",
}


@styled
def draw_normalised_section(results: Sequence[Result]) -> Figure:
    """Mid section over its chord, leading edge at the origin, trailing edge at (1, 0)."""
    figure = new_figure(2.7)
    axes = figure.subplots()
    for label, static, row, stroke in _members(results):
        axes.plot(*static.mid_section.normalised[row].T, label=label, **stroke.options())
    stretch = 3.0
    axes.set(
        xlabel="Chord fraction $x/c$ [–]",
        ylabel="Height $y/c$ [–]",
        title=f"Normalised mid section (heights stretched {stretch:g} times)",
        aspect=stretch,
    )
    axes.legend(loc="upper right", ncols=2)
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + 0.35 * (high - low))  # room for the legend
    return figure


@styled
def draw_mid_section(results: Sequence[Result]) -> Figure:
    """Mid section where it is in space, projected on the plane normal to the span."""
    figure = new_figure(3.6)
    axes = figure.subplots()
    for label, static, row, stroke in _members(results):
        contour = 1e3 * static.mid_section.placed[row]
        axes.plot(contour[:, 0], contour[:, 1], label=label, **stroke.options())
    axes.set(
        xlabel="Along the rotor axis, downstream, $x$ [mm]",
        ylabel="Towards the suction side, $y$ [mm]",
        title="Mid section in space",
        aspect="equal",
        adjustable="datalim",
    )
    axes.legend(loc="best")
    return figure


@styled
def draw_blade_angle(results: Sequence[Result]) -> Figure:
    """Blade angle along the span."""
    figure, axes = _spanwise("Blade angle", "Blade angle [°]")
    _plot(axes, results, lambda static: np.degrees(static.sections.blade_angle))
    axes.legend(loc="best")
    return figure


@styled
def draw_lift_coefficient(results: Sequence[Result]) -> Figure:
    """Lift coefficient along the span."""
    figure, axes = _spanwise("Lift coefficient", "Lift coefficient $C_L$ [–]")
    _plot(axes, results, lambda static: static.sections.lift_coefficient)
    axes.legend(loc="best")
    return figure


@styled
def draw_cavitation(result: Result) -> Figure:
    """Suction along the span of each state, against the cavitation number at the top of a turn."""
    figure, axes = _spanwise("Cavitation", r"$-C_{p,\min}$ and $\sigma$ [–]")
    _plot(axes, [result], lambda static: static.sections.suction)
    curves = result.steady.sections
    axes.plot(
        curves.span_fraction, curves.cavitation_number[state("coupled")], color=GREY,
        linestyle=(0, (1, 1)), label=r"$\sigma$, coupled",
    )  # fmt: skip
    axes.set_yscale("log")
    axes.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axes.yaxis.set_major_formatter("{x:g}")
    axes.yaxis.set_minor_formatter("")
    axes.legend(loc="best")
    return figure


@styled
def draw_convergence(result: Result) -> Figure:
    """Change of the displacement pass by pass, with the tip displacement and the lift."""
    history, tolerance = result.steady.history, result.steady.tolerance
    passes = np.arange(1, result.steady.iterations + 1)
    figure = new_figure(2.6)
    left, right = figure.subplots(1, 2)
    left.semilogy(passes, history.relative_change, "o-", color=BLUE, markersize=3.5, label="change")
    left.semilogy(
        passes, history.error, "s--", color=VERMILION, markersize=3.0, label="estimated error"
    )
    left.axhline(
        tolerance, color=GREY, linestyle="--", linewidth=1.0, label=f"tolerance {tolerance:.0e}"
    )
    left.legend(loc="upper right")
    verdict = "converged" if result.steady.converged else "NOT converged"
    left.set(
        xlabel="Pass of the coupling [–]",
        ylabel=r"Relative to $\|u\|$ [–]",
        title=f"Coupling by {result.steady.coupling_method}, {verdict}",
    )
    right.plot(passes, 1e3 * history.tip_displacement[:, 1], "o-", color=BLUE, markersize=3.5)
    right.set(
        xlabel="Pass of the coupling [–]",
        ylabel="Tip displacement $u_y$ [mm]",
        title="Tip displacement and lift",
    )
    right.yaxis.label.set_color(BLUE)
    lift = right.twinx()
    lift.plot(passes, history.lift, "s--", color=VERMILION, markersize=3.0)
    lift.set_ylabel("Applied lift [N]", color=VERMILION)
    lift.grid(visible=False)
    lift.spines["right"].set_visible(True)
    for axes in (left, right):
        axes.xaxis.get_major_locator().set_params(integer=True)
    return figure


def _members(results: Sequence[Result]) -> Iterator[tuple[str, StaticResult, int, Stroke]]:
    if len(results) == 1:
        for name in LABELS["state"]:
            if np.isnan(results[0].steady.lift[state(name)]):
                continue  # it could not be computed
            yield _NAMES[name], results[0].steady, state(name), STATE[name]
        return
    yield "rigid", results[0].steady, state("rigid"), STATE["rigid"]
    for result, stroke in zip(results, SERIES, strict=False):
        yield result.blade or result.title, result.steady, state("coupled"), stroke


def _spanwise(title: str, label: str) -> tuple[Figure, Axes]:
    figure = new_figure(3.0)
    axes = figure.subplots()
    axes.set(xlabel="Span fraction $s$ [–]", ylabel=label, title=title, xlim=(0.0, 1.0))
    return figure, axes


def _plot(
    axes: Axes, results: Sequence[Result], curve: Callable[[StaticResult], FloatArray]
) -> None:
    for label, static, row, stroke in _members(results):
        axes.plot(
            static.sections.span_fraction, curve(static)[row], label=label, **stroke.options()
        )
