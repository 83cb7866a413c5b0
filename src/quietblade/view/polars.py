# SPDX-License-Identifier: LGPL-2.1-or-later
"""Figures of one section by itself: pressure, polars, cavitation bucket."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from quietblade.flow.polar import Polar
from quietblade.typing import FloatArray
from quietblade.view.style import BLACK, GREY, SERIES, VERMILION, Stroke, new_figure, styled


@styled
def draw_pressure(contour: FloatArray, alpha: FloatArray, cp: FloatArray, title: str) -> Figure:
    """Pressure coefficient over the chord, upwards negative, with the section below.

    Parameters
    ----------
    contour : array (N, 2)
        In units of the chord.
    alpha : array (A,)
        Incidences [rad].
    cp : array (A, N)
    title : str
    """
    figure = new_figure(4.6)
    top, bottom = figure.subplots(2, 1, sharex=True, height_ratios=(3.2, 1.0))
    middle = len(contour) // 2
    for k, angle in enumerate(alpha):
        stroke = _stroke(k)
        thin = Stroke(stroke.color, stroke.linestyle, 0.8 * stroke.linewidth)
        label = f"{np.degrees(angle):.4g}°"
        top.plot(contour[: middle + 1, 0], cp[k, : middle + 1], label=label, **stroke.options())
        top.plot(contour[middle:, 0], cp[k, middle:], alpha=0.6, **thin.options())
    top.axhline(0.0, color=GREY, linewidth=0.7)
    top.invert_yaxis()
    top.set(ylabel="Pressure coefficient $C_p$ [–]", title=f"{title}, inviscid")
    top.legend(loc="best", title="Incidence (lower side pale)", ncols=2)
    closed = np.concatenate([contour, contour[:1]])
    bottom.plot(closed[:, 0], closed[:, 1], color=BLACK, linewidth=1.1)
    bottom.set(
        xlabel="Chord fraction $x/c$ [–]",
        ylabel="Height $y/c$ [–]",
        aspect="equal",
        adjustable="datalim",
    )
    return figure


@styled
def draw_polars(polars: Sequence[Polar], title: str) -> Figure:
    """Lift, drag, moment and transition; a polar a Reynolds number, stalled points hollow."""
    viscous = [polar for polar in polars if polar.reynolds is not None]
    figure = new_figure(5.4 if viscous else 2.7)
    axes = np.atleast_2d(figure.subplots(2 if viscous else 1, 2))
    figure.suptitle(title, x=0.01, ha="left", fontsize=9.5)
    # The lift and moment are inviscid, the same for every Reynolds number.
    first = polars[0]
    angle = np.degrees(first.alpha)
    axes[0, 0].plot(angle, first.lift_coefficient, **SERIES[0].options())
    axes[0, 0].set(
        xlabel="Incidence [°]", ylabel="Lift $C_L$ [–]", title="Lift, inviscid (stalled: hollow)"
    )
    axes[0, 1].plot(angle, first.moment_coefficient, **SERIES[0].options())
    axes[0, 1].set(
        xlabel="Incidence [°]",
        ylabel="Moment about $c/4$, $C_M$ [–]",
        title="Moment, nose up, inviscid",
    )
    for k, polar in enumerate(viscous):
        _plot_viscous(axes[0, 0], axes[1, 0], axes[1, 1], polar, _stroke(k))
    if viscous:
        axes[1, 0].set(
            xlabel="Drag $C_D$ [–]", ylabel="Lift $C_L$ [–]", title="Drag (stalled: hollow)"
        )
        axes[1, 0].set_xlim(left=0.0)
        axes[1, 0].legend(loc="best", title="Reynolds number")
        axes[1, 1].set(
            xlabel="Incidence [°]",
            ylabel="Transition $x/c$ [–]",
            title="Transition (lower side pale)",
            ylim=(-0.03, 1.03),
        )
    return figure


@styled
def draw_bucket(polars: Sequence[Polar], title: str) -> Figure:
    """Cavitation bucket: lift over the suction at which inception is predicted."""
    figure = new_figure(3.4)
    axes = figure.subplots()
    first = polars[0]
    axes.plot(first.minimum_pressure, first.lift_coefficient, **SERIES[0].options())
    axes.fill_betweenx(
        first.lift_coefficient, 0.0, first.minimum_pressure, color=VERMILION, alpha=0.07, lw=0.0
    )
    stalled = np.any([polar.stalled for polar in polars], axis=0)
    if stalled.any():
        axes.plot(
            first.minimum_pressure[stalled],
            first.lift_coefficient[stalled],
            linestyle="none",
            marker="o",
            markersize=3.5,
            markerfacecolor="white",
            color=SERIES[0].color,
            label="stalled at one of the Reynolds numbers",
        )
        axes.legend(loc="best")
    axes.set(
        xlabel=r"Cavitation number $\sigma$, or suction $-C_{p,min}$ [–]",
        ylabel="Lift $C_L$ [–]",
        title=f"{title}: cavitation where $\\sigma < -C_{{p,min}}$ (shaded)",
    )
    axes.set_xlim(left=0.0)
    return figure


def _plot_viscous(lift: Axes, drag: Axes, transition: Axes, polar: Polar, stroke: Stroke) -> None:
    angle, attached = np.degrees(polar.alpha), ~polar.stalled
    label = f"{polar.reynolds:.3g}"
    drag.plot(
        np.where(attached, polar.drag_coefficient, np.nan),
        polar.lift_coefficient,
        label=label,
        **stroke.options(),
    )
    # Drag after stall would only stretch the axis.
    limit = 1.3 * float(np.max(polar.drag_coefficient[attached], initial=0.01))
    hollow = polar.stalled & (polar.drag_coefficient < limit)
    mark: dict[str, Any] = {
        "linestyle": "none",
        "marker": "o",
        "markersize": 3.0,
        "markerfacecolor": "white",
    }
    drag.plot(
        polar.drag_coefficient[hollow], polar.lift_coefficient[hollow], color=stroke.color, **mark
    )
    lift.plot(
        angle[polar.stalled], polar.lift_coefficient[polar.stalled], color=stroke.color, **mark
    )
    transition.plot(angle, polar.transition_upper, **stroke.options())
    transition.plot(angle, polar.transition_lower, alpha=0.5, **stroke.options())


def _stroke(k: int) -> Stroke:
    return SERIES[k % len(SERIES)]
