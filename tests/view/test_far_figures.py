# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pictures of the far field: what is drawn is the result, with units, references and limits."""

from dataclasses import replace

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.figure import Figure

from quietblade.results.model import Result
from quietblade.view import bands, directivity, far_spectra, spectra
from quietblade.view.style import CONFIGURATION
from tests.results.synthetic import make_result

RESULT = make_result("composite")

FIGURES = {
    "source level": lambda: spectra.draw_source_level(RESULT),
    "bands": lambda: bands.draw_bands(RESULT),
    "polar": lambda: directivity.draw_polar(RESULT, "xy"),
    "balloons": lambda: directivity.draw_balloons(RESULT),
    "multipoles": lambda: far_spectra.draw_multipoles(RESULT),
    "efficiency": lambda: far_spectra.draw_efficiency(RESULT),
}


def texts(figure: Figure) -> str:
    return "\n".join(t.get_text() for t in figure.findobj(mpl.text.Text))


@pytest.mark.parametrize("name", FIGURES)
def test_axes_have_units_and_the_condition_stands_beside(name: str) -> None:
    figure = FIGURES[name]()
    figure.canvas.draw()
    for axes in figure.axes:
        if axes.name == "3d":  # its axes are directions
            continue
        labels = [axis.get_label_text() for axis in (axes.xaxis, axes.yaxis)]
        assert all(label.endswith("]") for label in labels if label), labels
        assert any(labels)
    assert "BGT-1" in texts(figure)
    assert "kR = 0.54 to 1.09" in texts(figure)


def test_spectra_say_by_how_much_the_condition_is_wrong() -> None:
    assert "power wrong by up to 5.2 dB" in texts(spectra.draw_sound_power(RESULT))
    rest = RESULT.configurations["C0"]
    exact = replace(rest.far_field, condition_error=np.full(len(rest.far_field.kr), 1e-4))
    good = replace(RESULT, configurations={"C0": replace(rest, far_field=exact)})
    assert "wrong" not in texts(spectra.draw_sound_power(good))


def test_source_level_passes_through_its_peaks() -> None:
    axes = spectra.draw_source_level(RESULT).axes[0]
    for name, configuration in RESULT.configurations.items():
        marks = [
            line for line in axes.lines
            if line.get_marker() == "." and line.get_color() == CONFIGURATION[name].color
            and line.get_linestyle() == "None"
        ]  # fmt: skip
        count = len(configuration.peaks.frequency)
        np.testing.assert_array_equal(marks[0].get_xdata(), configuration.peaks.frequency)
        np.testing.assert_array_equal(
            marks[0].get_ydata(), configuration.directivity.source_level[:count]
        )


def test_limits_lie_in_the_spectrum_with_the_worst_excess() -> None:
    axes = spectra.draw_sound_power(RESULT).axes[0]
    (limit,) = [line for line in axes.lines if line.get_label() == "limit: hull"]
    assert np.nanmax(np.asarray(limit.get_ydata())) == 75.0
    assert axes.get_ylim()[0] < 75.0
    for configuration in RESULT.configurations.values():
        told = f"+{configuration.limits.worst_excess[0]:.1f} dB"
        assert any(t.get_text() == told for t in axes.texts)
    assert "limit" not in texts(spectra.draw_source_level(RESULT))  # the other one is for bands


def test_bands_are_drawn_with_their_limits() -> None:
    figure = bands.draw_bands(RESULT)
    source, power = figure.axes
    labels = source.get_legend_handles_labels()[1]
    assert "limit: range" in labels
    assert "limit: range" not in power.get_legend_handles_labels()[1]
    assert sum(t.get_text() == "+2.5 dB" for t in source.texts) == 2
    points = [line for line in power.lines if line.get_label() == "C0, at rest"]
    np.testing.assert_array_equal(points[0].get_ydata(), [70.0, 72.0])


def test_limits_in_other_bands_have_a_panel_of_their_own() -> None:
    def other(result: Result) -> Result:
        members = {
            name: replace(c, limits=replace(c.limits, bands=("narrow", "third-octave")))
            for name, c in result.configurations.items()
        }
        return replace(result, configurations=members)

    figure = bands.draw_bands(other(RESULT))
    assert len(figure.axes) == 3
    assert figure.axes[2].get_xlabel() == "Third-octave band (base two) [Hz]"


def test_polar_diagrams_pair_the_modes_of_both_configurations() -> None:
    figure = directivity.draw_polar(RESULT, "xy")
    titles = [axes.get_title() for axes in figure.axes]
    paired = next(axes for axes in figure.axes if axes.get_title().startswith("B6"))
    assert "C0: 137.2 Hz" in paired.get_title()
    assert "C1: 148.1 Hz" in paired.get_title()
    strokes = {(line.get_color(), str(line._unscaled_dash_pattern)) for line in paired.lines}
    assert len(paired.lines) == 2
    assert len(strokes) == 2  # apart by more than colour
    angle, radius = paired.lines[0].get_data()
    assert angle[np.argmax(radius)] == pytest.approx(np.pi / 2)  # a dipole along y
    assert np.max(radius) == pytest.approx(30.0)
    assert sum(title.startswith("given") for title in titles) == 1
    assert len(titles) <= 9


def test_shares_fill_the_picture() -> None:
    axes = far_spectra.draw_multipoles(RESULT).axes[0]
    tops = [band.get_paths()[0].vertices[:, 1].max() for band in axes.collections]
    assert tops == pytest.approx([2.0, 92.0, 100.0, 100.0])
