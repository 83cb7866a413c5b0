# SPDX-License-Identifier: LGPL-2.1-or-later
"""Curves of step 2: sound power over frequency, with the names of the modes at the peaks."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.gridspec import SubplotSpec
from matplotlib.patches import ConnectionPatch

from quietblade.results.excitations import of_signal
from quietblade.results.model import REFERENCE_POWER, ConfigurationResult, Result, path
from quietblade.results.peaks import Peak, find_peaks
from quietblade.typing import AnyArray, FloatArray
from quietblade.view.limits import draw_narrow_limits
from quietblade.view.style import (
    BLACK,
    CONFIGURATION,
    GREEN,
    GREY,
    SERIES,
    VERMILION,
    Stroke,
    new_figure,
    styled,
)

_LEVEL = "Sound power level $L_W$ [dB re 1 pW]"
_SOURCE_LEVEL = "Source level $L_S$ [dB re 1 µPa m]"
_LONG = 24  # letters of a legend's entry of which four do not fit side by side
_FREQUENCY = "Frequency [Hz]"
_WORTH_TELLING = 0.1  # dB of error by the radiation condition
_TITLES = {"C0": "C0, at rest", "C1": "C1, under load"}


@dataclass(frozen=True)
class _Curve:
    label: str
    configuration: ConfigurationResult
    stroke: Stroke
    level: FloatArray
    peaks: Mapping[str, Peak]
    tops: tuple[FloatArray, FloatArray]
    """Frequencies and levels of all peaks, those without a mode too."""

    @classmethod
    def of_power(cls, label: str, configuration: ConfigurationResult, stroke: Stroke) -> Self:
        peaks = configuration.peaks
        return cls(
            label, configuration, stroke, configuration.spectrum.power_level[path("sphere")],
            find_peaks(configuration), (peaks.frequency, peaks.power_level),
        )  # fmt: skip

    @classmethod
    def of_source(cls, label: str, configuration: ConfigurationResult, stroke: Stroke) -> Self:
        frequency = configuration.peaks.frequency
        level = configuration.directivity.source_level[: len(frequency)]  # peaks come first
        at = dict(zip(frequency.tolist(), level.tolist(), strict=True))
        named = {
            name: replace(peak, level=at[peak.frequency])
            for name, peak in find_peaks(configuration).items()
        }
        return cls(
            label, configuration, stroke, configuration.far_field.source_level,
            named, (frequency, level),
        )  # fmt: skip


@styled
def draw_sound_power(result: Result, pictures: Mapping[str, AnyArray] | None = None) -> Figure:
    """Sound power at rest and under load.

    Parameters
    ----------
    result : Result
        The study.
    pictures : mapping, optional
        Pictures (rows, columns, 3 or 4) of the mode shapes at rest by name; those that make a
        peak are drawn above it.
    """
    curves = [
        _Curve.of_power(_TITLES[name], configuration, CONFIGURATION[name])
        for name, configuration in result.configurations.items()
    ]
    title = f"Sound power: {result.title}"
    return _draw_spectra(curves, title, _LEVEL, pictures or {}, limited=(result, "sound-power"))


@styled
def draw_source_level(result: Result) -> Figure:
    """Source level at rest and under load, the mean over all directions."""
    curves = [
        _Curve.of_source(_TITLES[name], configuration, CONFIGURATION[name])
        for name, configuration in result.configurations.items()
    ]
    title = f"Source level, mean over all directions: {result.title}"
    return _draw_spectra(curves, title, _SOURCE_LEVEL, limited=(result, "source-level"))


@styled
def draw_sound_power_at_rest(
    results: Sequence[Result], pictures: Sequence[Mapping[str, AnyArray]] = ()
) -> Figure:
    """Sound power of several blades at rest.

    Parameters
    ----------
    results : sequence of Result
    pictures : sequence of mapping, optional
        Pictures of the mode shapes of the first blade, drawn above, and of the second, below.
    """
    curves = [
        _Curve.of_power(result.blade or result.title, result.configurations["C0"], stroke)
        for result, stroke in zip(results, SERIES, strict=False)
        if "C0" in result.configurations
    ]
    return _draw_spectra(curves, "Sound power at rest (C0)", _LEVEL, *pictures[:2])


@styled
def draw_sound_power_of(
    members: Mapping[str, ConfigurationResult], title: str, strokes: Sequence[Stroke] = SERIES
) -> Figure:
    """Sound power of several configurations by the name that each curve gets."""
    curves = [
        _Curve.of_power(name, configuration, stroke)
        for (name, configuration), stroke in zip(members.items(), strokes, strict=False)
    ]
    return _draw_spectra(curves, title, _LEVEL)


@styled
def draw_power_paths(result: Result) -> Figure:
    """Where the injected power goes, and the radiated power by two independent paths."""
    figure = new_figure(2.6 * max(len(result.configurations), 1))
    axes = figure.subplots(max(len(result.configurations), 1), sharex=True, squeeze=False)[:, 0]
    for ax, (name, configuration) in zip(axes, result.configurations.items(), strict=False):
        spectrum = configuration.spectrum
        radiated = spectrum.power_level
        f = spectrum.frequency
        ax.plot(f, _level(spectrum.injected), color=BLACK, linewidth=1.0, label="injected")
        ax.plot(f, _level(spectrum.dissipated), color=GREEN, linestyle=(0, (5, 1.5, 1, 1.5)),
                label="dissipated")  # fmt: skip
        ax.plot(f, radiated[path("sphere")], **CONFIGURATION["C0"].options(),
                label="radiated, sphere")  # fmt: skip
        ax.plot(f, radiated[path("multipoles")], color=VERMILION, linestyle=(0, (1.2, 1.2)),
                label="radiated, multipoles")  # fmt: skip
        title = f"{_TITLES[name]}; {radiation_note(configuration)}"
        label = of_signal("Power level\n[dB re 1 pW]", random=configuration.random)
        ax.set(title=title, xlim=(f[0], f[-1]), ylabel=label)
        _keep_readable(ax, list(radiated), above=_level(spectrum.injected))
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=4)
    axes[-1].set_xlabel(_FREQUENCY)
    return figure


def _draw_spectra(
    curves: Sequence[_Curve],
    title: str,
    unit: str,
    *pictures: Mapping[str, AnyArray],
    limited: tuple[Result, str] | None = None,
) -> Figure:
    """Draw the spectra, with pictures of modes of the first above them and of the second below.

    ``limited`` is a result with limits, and the quantity of these levels.
    """
    shown = [
        _peaks_with_picture(curve, of_modes)
        for curve, of_modes in zip(curves, pictures, strict=False)
    ]
    above = bool(shown and shown[0])
    below = len(shown) > 1 and bool(shown[1])
    figure = new_figure(3.6 + 1.3 * (above + below))
    ratios = [0.28] * above + [1.0] + [0.28] * below
    grid = figure.add_gridspec(len(ratios), 1, height_ratios=ratios)
    axes = figure.add_subplot(grid[int(above)])
    figure.suptitle(title, x=0.01, ha="left", fontsize=9.0)
    labels = {of_signal(unit, random=curve.configuration.random): None for curve in curves}
    axes.set(xlabel=_FREQUENCY, ylabel=" or ".join(labels or {unit: None}))
    if not curves:
        return figure
    levels = [curve.level for curve in curves]
    frequency = curves[0].configuration.spectrum.frequency
    for curve, level in zip(curves, levels, strict=True):
        f = curve.configuration.spectrum.frequency
        # of a direct sweep the frequencies that were computed; the lines between them are not
        dot = "" if _is_reduced(curve.configuration) else "."
        axes.plot(f, level, label=curve.label, marker=dot, markersize=3.0, **curve.stroke.options())
        axes.plot(*curve.tops, ".", color=curve.stroke.color, markersize=4.0)
    axes.set_xlim(frequency[0], frequency[-1])
    allowed = np.zeros(0)
    if limited is not None:
        allowed = draw_narrow_limits(axes, limited[0].configurations, limited[1])
    _keep_readable(axes, [*levels, *(curve.tops[1] for curve in curves), allowed])
    tops = _name_peaks(axes, curves)
    handles, texts = axes.get_legend_handles_labels()
    figure.legend(
        handles,
        texts,
        loc="outside lower center",
        ncols=4 if max(map(len, texts), default=0) < _LONG else 2,
        title="; ".join(dict.fromkeys(radiation_note(c.configuration) for c in curves))
        + f"\n{_sweep_note([c.configuration for c in curves])}",
        title_fontsize=7.5,
    )
    if above:
        members = [(peak, pictures[0][peak.mode], tops[peak.mode]) for peak in shown[0]]
        _draw_pictures(figure, grid[0], axes, members)
    if below:
        members = [(p, pictures[1][p.mode], (p.frequency, p.level)) for p in shown[1]]
        _draw_pictures(figure, grid[-1], axes, members, below=True)
    return figure


def radiation_note(configuration: ConfigurationResult) -> str:
    """Name the radiation condition, its sphere, kR, and the error that it makes."""
    kr, error = configuration.kr, np.abs(configuration.far_field.condition_error)
    worst = float(np.nanmax(error)) if np.isfinite(error).any() else np.inf
    wrong = f" (power wrong by up to {worst:.1f} dB)" if worst > _WORTH_TELLING else ""
    return (
        f"{configuration.radiation_condition} on a sphere of R = {configuration.outer_radius:.3g} m"
        f", kR = {kr[0]:.2f} to {kr[-1]:.2f}{wrong}"
    )


def _is_reduced(configuration: ConfigurationResult) -> bool:
    return configuration.sweep.method == "reduced"


def _sweep_note(configurations: Sequence[ConfigurationResult]) -> str:
    if all(map(_is_reduced, configurations)):
        worst = max(configuration.sweep.largest_estimate for configuration in configurations)
        return f"reduced model; estimated error of the levels at most {worst:.1e} dB"
    return "dots: computed frequencies; the lines between them only guide the eye"


def _name_peaks(axes: Axes, curves: Sequence[_Curve]) -> dict[str, tuple[float, float]]:
    """Write the names above the peaks; a name close to one that stands there goes higher.

    Returns
    -------
    dict
        Upper end of the names of the first curve: frequency and level.
    """
    low, high = axes.get_xlim()
    bottom, top = axes.get_ylim()
    width, height = 0.035 * (high - low), 0.05 * (top - bottom)  # of a name
    placed: list[tuple[float, float]] = []
    first: dict[str, tuple[float, float]] = {}
    for order, curve in enumerate(curves):
        for name, peak in curve.peaks.items():
            if name in first and abs(first[name][0] - peak.frequency) < 0.35 * width:
                continue  # all but the same peak has this name already
            foot = peak.level + 0.3 * height
            while any(
                abs(f - peak.frequency) < width and abs(h - foot) < height for f, h in placed
            ):
                foot += 0.5 * height
            placed.append((peak.frequency, foot))
            if order == 0:
                first[name] = (peak.frequency, foot + height)
            axes.text(
                peak.frequency, foot, name, color=curve.stroke.color,
                ha="center", va="bottom", fontsize=8.0, fontweight="bold",
            )  # fmt: skip
    axes.set_ylim(bottom, max([top, *(foot + 1.6 * height for _, foot in placed)]))
    return first


def _keep_readable(
    axes: Axes, levels: Sequence[FloatArray], above: FloatArray | None = None
) -> None:
    """Cut what is more than 80 dB below the highest level; ``above`` only raises the upper end."""
    values = np.concatenate(list(levels))
    values = values[np.isfinite(values)]
    if values.size == 0:
        return
    highest = float(values.max())
    lowest = max(float(values.min()), highest - 80.0)
    top = highest if above is None else max(highest, float(np.nanmax(above)))
    axes.set_ylim(lowest - 3.0, top + 2.0)


def _level(power: FloatArray) -> FloatArray:
    positive = np.where(power > 0.0, power, np.nan)
    return np.asarray(10.0 * np.log10(positive / REFERENCE_POWER), dtype=np.float64)


# --- pictures of the modes ---------------------------------------------------------------------


def _peaks_with_picture(curve: _Curve, pictures: Mapping[str, AnyArray]) -> tuple[Peak, ...]:
    """Peaks of a curve that have a picture, at most the six highest, by frequency."""
    peaks = [p for name, p in curve.peaks.items() if name in pictures]
    highest = sorted(peaks, key=lambda p: -p.level)[:6]
    return tuple(sorted(highest, key=lambda p: p.frequency))


def _draw_pictures(
    figure: Figure,
    strip: SubplotSpec,
    axes: Axes,
    members: Sequence[tuple[Peak, AnyArray, tuple[float, float]]],
    *,
    below: bool = False,
) -> None:
    """Draw the pictures in a row, each tied to its peak: above to the name, below to the point."""
    row = strip.subgridspec(1, len(members), wspace=0.05)
    for column, (peak, picture, end) in enumerate(members):
        ax = figure.add_subplot(row[0, column])
        ax.imshow(picture, interpolation="antialiased")
        ax.set_axis_off()
        ax.set_title(f"{peak.mode}, {peak.frequency:.1f} Hz", fontsize=8.0, loc="center")
        tie = ConnectionPatch(
            xyA=(0.5, 1.25 if below else 0.0),  # clear of the title
            coordsA=ax.transAxes,
            xyB=end,
            coordsB=axes.transData,
            color=GREY,
            linewidth=0.6,
            linestyle=":",
        )
        figure.add_artist(tie)
