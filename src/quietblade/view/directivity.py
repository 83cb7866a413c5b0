# SPDX-License-Identifier: LGPL-2.1-or-later
"""Directivity: polar diagrams by plane, and balloons."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from quietblade.results.excitations import of_signal
from quietblade.results.model import ConfigurationResult, Result
from quietblade.results.peaks import find_peaks
from quietblade.typing import FloatArray
from quietblade.view.style import BLACK, CONFIGURATION, GREY, SEQUENTIAL, new_figure, styled

_DEPTH = 30.0  # dB from the rim to the centre
_COLUMNS, _MOST = 3, 9
_BALLOONS = 3  # of each configuration
_UNIT = "[dB re 1 µPa m]"


@dataclass(frozen=True)
class _Panel:
    """One peak or frequency: the row of the pattern of each configuration."""

    name: str
    rows: Mapping[str, int]


@styled
def draw_polar(result: Result, plane: str) -> Figure:
    """Polar diagrams in one plane at the peaks and the frequencies asked for, the loudest nine.

    Parameters
    ----------
    result : Result
    plane : str
        One of the planes of the result, ``xy``, ``xz`` or ``yz``.
    """
    panels = _loudest(result, list(_panels(result)))
    lines = -(-len(panels) // _COLUMNS)
    figure = new_figure(2.6 * lines + 0.7)
    grid = figure.subplots(lines, _COLUMNS, subplot_kw={"projection": "polar"}, squeeze=False)
    for ax in grid.ravel()[len(panels) :]:
        ax.remove()
    for panel, ax in zip(panels, grid.ravel(), strict=False):
        _draw_polar_panel(ax, panel, result, plane)
    names = {"C0": "C0, at rest", "C1": "C1, under load"}
    handles = [
        mpl.lines.Line2D([], [], label=names[name], **CONFIGURATION[name].options())
        for name in result.configurations
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=2, title=_note(result),
                  title_fontsize=7.5)  # fmt: skip
    title = f"Directivity in the plane {plane}: {result.title}"
    figure.suptitle(title, x=0.01, ha="left", fontsize=9.0)
    return figure


def _draw_polar_panel(ax: Any, panel: _Panel, result: Result, plane: str) -> None:
    for name, row in panel.rows.items():
        pattern = result.configurations[name].directivity
        level = pattern.cut_level[row, pattern.cut.index(plane)] - pattern.level[row].max()
        radius = np.clip(level + _DEPTH, 0.0, None)
        ax.plot(np.append(pattern.angle, pattern.angle[0]), np.append(radius, radius[0]),
                **CONFIGURATION[name].options())  # fmt: skip
    first, second = plane[0], plane[1]
    ax.set_xticks(
        np.radians([0.0, 90.0, 180.0, 270.0]), [f"+{first}", f"+{second}", f"−{first}",
                                                f"−{second}"],
    )  # fmt: skip
    marks = np.arange(0.0, _DEPTH + 1.0, 10.0)
    ax.set_yticks(marks, ["", *(f"{mark - _DEPTH:.0f}" for mark in marks[1:])])
    ax.set_rlabel_position(45.0)
    ax.set_ylim(0.0, _DEPTH)
    ax.tick_params(axis="y", labelsize=6.5, zorder=3)
    for label in ax.get_yticklabels():
        label.set_bbox({"facecolor": "white", "alpha": 0.8, "pad": 0.5, "linewidth": 0.0})
    ax.tick_params(axis="x", labelsize=7.5, pad=0.0)
    ax.set_ylabel("Level [dB re loudest]", fontsize=6.5, labelpad=16.0)
    told = (_told(result.configurations[name], name, row) for name, row in panel.rows.items())
    ax.set_title("\n".join([panel.name, *told]), fontsize=7.5, loc="center")


def _told(configuration: ConfigurationResult, name: str, row: int) -> str:
    """Frequency, and level in the loudest direction."""
    pattern = configuration.directivity
    return f"{name}: {pattern.frequency[row]:.1f} Hz, {pattern.level[row].max():.1f} dB"


@styled
def draw_balloons(result: Result) -> Figure:
    """Sound in all directions at the loudest peaks of each configuration."""
    members = result.configurations
    figure = new_figure(2.6 * len(members) + 0.3)
    norm = Normalize(-_DEPTH, 0.0)
    for line, (name, configuration) in enumerate(members.items()):
        pattern = configuration.directivity
        loudest = np.sort(np.argsort(-pattern.source_level)[:_BALLOONS])
        names = _names(configuration)
        for column, row in enumerate(loudest):
            ax = figure.add_subplot(
                len(members), _BALLOONS, _BALLOONS * line + column + 1, projection="3d"
            )
            _draw_balloon(ax, configuration, int(row), norm)
            whose = (name, names[int(row)]) if int(row) in names else (name,)
            ax.set_title(
                f"{' '.join(whose)}, {pattern.frequency[row]:.1f} Hz\n"
                f"$L_S$ {pattern.source_level[row]:.1f} dB, DI {pattern.index[row]:.1f} dB",
                fontsize=7.5,
                loc="center",
                pad=10.0,
            )
    colours = ScalarMappable(norm, SEQUENTIAL)
    bar = figure.colorbar(colours, ax=figure.axes, shrink=0.6, pad=0.02)
    bar.set_label("Level, also the radius\n[dB re loudest direction]")
    figure.suptitle(f"Directivity: {result.title}\n{_note(result)}", x=0.01, ha="left",
                    fontsize=8.0)  # fmt: skip
    return figure


def _draw_balloon(ax: Any, configuration: ConfigurationResult, row: int, norm: Normalize) -> None:
    pattern = configuration.directivity
    level = np.maximum(pattern.level[row] - pattern.level[row].max(), -_DEPTH)
    level = np.column_stack([level, level[:, :1]])
    azimuth = np.append(pattern.azimuth, pattern.azimuth[0] + 2.0 * np.pi)
    theta, phi = np.meshgrid(pattern.polar, azimuth, indexing="ij")
    radius = level + _DEPTH
    x, y, z = (
        radius * part
        for part in (np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta))
    )
    faces = 0.25 * (level[1:, 1:] + level[:-1, 1:] + level[1:, :-1] + level[:-1, :-1])
    colours = mpl.colormaps[SEQUENTIAL](norm(faces))
    ax.plot_surface(x, y, z, facecolors=colours, rstride=1, cstride=1, linewidth=0.0, shade=True)
    length = 1.2 * _DEPTH
    for axis, label in zip(np.eye(3) * length, "xyz", strict=True):
        ax.plot(*np.stack([np.zeros(3), axis]).T, color=GREY, linewidth=0.8)
        ax.text(*(1.08 * axis), label, fontsize=8.0, color=BLACK)
    ax.set_axis_off()
    ax.set_box_aspect((1.0, 1.0, 1.0), zoom=1.35)
    reach = 0.9 * length
    ax.set(xlim=(-reach, reach), ylim=(-reach, reach), zlim=(-reach, reach))
    ax.view_init(elev=22.0, azim=-55.0)


def _panels(result: Result) -> Iterator[_Panel]:
    """Peaks of the same mode together, then other peaks, then frequencies asked for."""
    by_mode: dict[str, dict[str, int]] = {}
    alone: list[_Panel] = []
    given: dict[float, dict[str, int]] = {}
    for name, configuration in result.configurations.items():
        names, pattern = _names(configuration), configuration.directivity
        for row, reason in enumerate(pattern.reason):
            if reason != "peak":
                given.setdefault(round(float(pattern.frequency[row]), 6), {})[name] = row
            elif row in names:
                by_mode.setdefault(names[row], {})[name] = row
            else:
                alone.append(_Panel("peak", {name: row}))
    yield from (_Panel(f"{mode}", rows) for mode, rows in by_mode.items())
    yield from alone
    yield from (_Panel("given", rows) for rows in given.values())


def _loudest(result: Result, panels: list[_Panel]) -> list[_Panel]:
    """Frequencies asked for, and the loudest peaks, in ascending frequency."""

    def of(panel: _Panel, values: str) -> FloatArray:
        return np.array(
            [
                getattr(result.configurations[name].directivity, values)[row]
                for name, row in panel.rows.items()
            ]
        )

    ordered = sorted(panels, key=lambda p: (p.name != "given", -of(p, "source_level").max()))
    return sorted(ordered[:_MOST], key=lambda p: float(of(p, "frequency").min()))


def _names(configuration: ConfigurationResult) -> dict[int, str]:
    """Mode of each peak, by its place."""
    modes = {peak.frequency: peak.mode for peak in find_peaks(configuration).values()}
    places = {float(f): i for i, f in enumerate(configuration.peaks.frequency)}
    return {places[f]: mode for f, mode in modes.items()}


def _note(result: Result) -> str:
    first = next(iter(result.configurations.values()))
    distance = first.directivity.distance
    place = "far away" if np.isinf(distance) else f"at {distance:g} m from the centre"
    kr, unit = first.kr, of_signal(_UNIT, random=first.random)
    return (
        f"levels relative to the loudest direction; there pressure times distance {place} {unit}\n"
        f"{first.radiation_condition}, kR = {kr[0]:.2f} to {kr[-1]:.2f}"
    )
