# SPDX-License-Identifier: LGPL-2.1-or-later
"""Levels in frequency bands, with the limits for them."""

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter, NullLocator

from quietblade.results.excitations import of_signal
from quietblade.results.model import ConfigurationResult, Result
from quietblade.typing import FloatArray
from quietblade.view.limits import LIMITS, band_edges, chosen_limits, rows_of
from quietblade.view.spectra import radiation_note
from quietblade.view.style import CONFIGURATION, new_figure, styled

_LABELS = {
    "sound-power": "Sound power level\n$L_W$ [dB re 1 pW]",
    "source-level": "Source level\n$L_S$ [dB re 1 µPa m]",
}
_KINDS = {"decidecade": "Decidecade band", "third-octave": "Third-octave band (base two)"}
_TITLES = {"C0": "C0, at rest", "C1": "C1, under load"}


@dataclass(frozen=True)
class _Panel:
    quantity: str
    kind: str


def has_bands(result: Result) -> bool:
    """Tell whether a band fits into the frequencies of a run."""
    return any(len(c.bands.centre) for c in result.configurations.values())


@styled
def draw_bands(result: Result) -> Figure:
    """Source level and sound power in bands; one panel for each quantity and kind of bands."""
    first = next(iter(result.configurations.values()))
    own = first.bands.kind
    limited = zip(first.limits.quantity, first.limits.bands, strict=True)
    kinds = [("source-level", own), ("sound-power", own), *limited]
    panels = [_Panel(*kind) for kind in dict.fromkeys(kinds) if kind[1] != "narrow"]
    figure = new_figure(2.3 * len(panels) + 0.6)
    for panel, ax in zip(panels, figure.subplots(len(panels), squeeze=False)[:, 0], strict=True):
        _draw_panel(ax, panel, result)
    handles = {
        label: handle
        for ax in figure.axes
        for handle, label in zip(*ax.get_legend_handles_labels(), strict=True)
    }
    notes = dict.fromkeys(radiation_note(c) for c in result.configurations.values())
    figure.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=4,
                  title="; ".join(notes), title_fontsize=7.5)  # fmt: skip
    figure.suptitle(f"Level of the mean power in bands: {result.title}", x=0.01, ha="left",
                    fontsize=9.0)  # fmt: skip
    return figure


def _draw_panel(ax: Axes, panel: _Panel, result: Result) -> None:
    ticks = np.zeros(0)
    for name, configuration in result.configurations.items():
        centre, level = _levels(configuration, panel)
        lower, upper = band_edges(centre, panel.kind)
        stroke = CONFIGURATION[name]
        if len(centre):
            # steps, and a mark in the middle of each that does not lie on another's
            ax.stairs(level, np.append(lower, upper[-1]), baseline=None, color=stroke.color,
                      linestyle=stroke.linestyle, linewidth=stroke.linewidth)  # fmt: skip
            ax.plot(centre, level, "o" if name == "C0" else "s", color=stroke.color,
                    markersize=4.0, label=_TITLES[name])  # fmt: skip
        ticks = np.union1d(ticks, centre)
    first = next(iter(result.configurations.values()))
    for limit in chosen_limits(first, panel.quantity, panel.kind):
        rows = rows_of(first, limit)
        centre, allowed = first.limits.frequency[rows], first.limits.allowed[rows]
        lower, upper = band_edges(centre, panel.kind)
        options = LIMITS[limit % len(LIMITS)].options()
        for a, b, y in zip(lower, upper, allowed, strict=True):
            ax.plot([a, b], [y, y], **options, label=f"limit: {first.limits.name[limit]}")
    _write_excess(ax, panel, result)
    ax.set_xscale("log")
    ax.xaxis.set_major_locator(NullLocator())
    ax.xaxis.set_minor_locator(NullLocator())
    ax.xaxis.set_minor_formatter(NullFormatter())
    ax.set_xticks(ticks, [f"{tick:.4g}" for tick in ticks])
    ax.margins(y=0.15)
    label = of_signal(_LABELS[panel.quantity], random=first.random)
    ax.set(xlabel=f"{_KINDS[panel.kind]} [Hz]", ylabel=label)


def _levels(configuration: ConfigurationResult, panel: _Panel) -> tuple[FloatArray, FloatArray]:
    """Centres of the bands [Hz] and levels in them [dB]."""
    bands = configuration.bands
    if panel.kind == bands.kind:
        source = panel.quantity == "source-level"
        return bands.centre, bands.source_level if source else bands.level
    limit = chosen_limits(configuration, panel.quantity, panel.kind)[0]
    rows = rows_of(configuration, limit)
    return configuration.limits.frequency[rows], configuration.limits.found[rows]


def _write_excess(ax: Axes, panel: _Panel, result: Result) -> None:
    """Write the excess above the bands that exceed a limit."""
    for name, configuration in result.configurations.items():
        table = configuration.limits
        for limit in chosen_limits(configuration, panel.quantity, panel.kind):
            for row in rows_of(configuration, limit):
                if table.excess[row] > 0.0:
                    ax.annotate(
                        f"+{table.excess[row]:.1f} dB", (table.frequency[row], table.found[row]),
                        xytext=(-3 if name == "C0" else 3, 4), textcoords="offset points",
                        ha="right" if name == "C0" else "left", fontsize=7.5,
                        color=CONFIGURATION[name].color,
                    )  # fmt: skip
