# SPDX-License-Identifier: LGPL-2.1-or-later
"""Campbell diagram: wet modes over the speed of the shaft, with the blade rate's multiples."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from quietblade.results.mode_records import CampbellDiagram
from quietblade.results.model import Result
from quietblade.view.style import BLACK, BLUE, GREY, VERMILION, new_figure, styled

_HEADROOM = 1.06
_STAGGER, _LABELS = 0.08, 8  # step of the labels along the rays, and after how many it starts again


@styled
def draw_campbell(result: Result) -> Figure:
    """Modes as curves with their names, orders as rays, crossings as rings.

    Parameters
    ----------
    result : Result
        Of a case with a table ``[campbell]``.
    """
    diagram = result.campbell
    figure = new_figure(4.2)
    axes = figure.subplots()
    highest = _HEADROOM * float(np.nanmax(diagram.frequency))
    first, last = float(diagram.rotation[0]), float(diagram.rotation[-1])
    room = max(0.06 * (last - first), 1e-3 * last)
    axes.set(
        xlim=(first, last + room),
        ylim=(0.0, highest),
        xlabel=r"Speed of the shaft $\Omega_p$ [rad/s]",
        ylabel="Frequency [Hz]",
        title=f"Campbell diagram: {result.title}",
    )
    _draw_rays(axes, diagram, last, highest)
    for name, values in zip(diagram.name, diagram.frequency, strict=True):
        axes.plot(
            diagram.rotation, values, "o-", color=BLUE, markersize=3.0,
            label=f"wet modes, speed of advance {diagram.advance}",
        )  # fmt: skip
        end = int(np.flatnonzero(np.isfinite(values))[-1])
        axes.annotate(
            name, (diagram.rotation[end], values[end]), (4.0, 0.0), textcoords="offset points",
            va="center", fontsize=8.0, fontweight="bold", color=BLACK,
        )  # fmt: skip
    axes.plot(
        diagram.crossing_rotation, diagram.crossing_frequency, "o", color=VERMILION,
        markersize=7.0, markerfacecolor="none", markeredgewidth=1.3, label="crossings",
    )  # fmt: skip
    handles, labels = axes.get_legend_handles_labels()
    known = dict(zip(labels, handles, strict=True))  # one entry for all curves of a kind
    figure.legend(known.values(), known.keys(), loc="outside lower center", ncols=3)
    return figure


def _draw_rays(axes: Axes, diagram: CampbellDiagram, last: float, highest: float) -> None:
    """Rays from the origin, each labelled a little farther from the right than the one before."""
    left = axes.get_xlim()[0]
    for place, order in enumerate(diagram.order.tolist()):
        slope = order * diagram.blades / (2.0 * np.pi)
        end = min(last, highest / slope)
        axes.plot([0.0, end], [0.0, slope * end], color=GREY, linestyle="--", linewidth=0.9,
                  label=f"multiples of the rate of {_blades(diagram)}")  # fmt: skip
        if end <= left:
            continue
        at = end - _STAGGER * (place % _LABELS) * (end - left)
        axes.annotate(
            f"{order} x {diagram.blades}", (at, slope * at), (-2.0, 2.0),
            textcoords="offset points", ha="right", va="bottom", fontsize=7.5, color=GREY,
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.5, "alpha": 0.8},
        )  # fmt: skip


def _blades(diagram: CampbellDiagram) -> str:
    return f"{diagram.blades} blade{'s' if diagram.blades > 1 else ''}"
