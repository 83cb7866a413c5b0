# SPDX-License-Identifier: LGPL-2.1-or-later
"""Curves: what is drawn is the result, with units, references and names."""

from dataclasses import replace

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from quietblade.results.model import path, state, without_state
from quietblade.view import losses, sections, spectra
from quietblade.view.campbell import draw_campbell
from quietblade.view.style import CONFIGURATION, SERIES, STATE
from tests.results.synthetic import make_result

ALUMINIUM, COMPOSITE = make_result("aluminium"), make_result("composite")

FIGURES = {
    "section, one": lambda: sections.draw_normalised_section([COMPOSITE]),
    "section, two": lambda: sections.draw_normalised_section([ALUMINIUM, COMPOSITE]),
    "placed": lambda: sections.draw_mid_section([COMPOSITE]),
    "angle": lambda: sections.draw_blade_angle([ALUMINIUM, COMPOSITE]),
    "lift": lambda: sections.draw_lift_coefficient([COMPOSITE]),
    "convergence": lambda: sections.draw_convergence(COMPOSITE),
    "power": lambda: spectra.draw_sound_power(COMPOSITE),
    "power at rest": lambda: spectra.draw_sound_power_at_rest([ALUMINIUM, COMPOSITE]),
    "campbell": lambda: draw_campbell(ALUMINIUM),
    "paths": lambda: spectra.draw_power_paths(COMPOSITE),
    "shares": lambda: losses.draw_power_shares(COMPOSITE),
    "moduli": lambda: losses.draw_moduli(COMPOSITE),
}


def first_axes(figure: Figure) -> Axes:
    return figure.axes[0]


def texts(figure: Figure) -> str:
    return "\n".join(t.get_text() for t in figure.findobj(mpl.text.Text))


def names(axes: Axes) -> list[mpl.text.Text]:
    """Names at the peaks, without the excess over a limit."""
    return [t for t in axes.texts if not t.get_text().endswith("dB")]


@pytest.mark.parametrize("name", FIGURES)
def test_every_axis_has_a_unit(name: str) -> None:
    figure = FIGURES[name]()
    figure.canvas.draw()
    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            label = axis.get_label_text()
            if not label:  # the shared frequency axis of the upper panel, or of a twin
                assert axis is axes.xaxis
                continue
            assert label.endswith("]"), label
            assert "[" in label


def test_levels_name_their_reference_and_the_radiation_condition() -> None:
    for name in ("power", "power at rest", "paths"):
        written = texts(FIGURES[name]())
        assert "[dB re 1 pW]" in written, name
        condition = "BGT-1 on a sphere of R = 1.3 m, kR = 0.54 to 1.09"
        assert f"{condition} (power wrong by up to 5.2 dB)" in written, name


def test_the_spectra_are_those_of_the_result() -> None:
    axes = first_axes(spectra.draw_sound_power(COMPOSITE))
    curves = {line.get_label(): line for line in axes.lines}
    for label, name in (("C0, at rest", "C0"), ("C1, under load", "C1")):
        spectrum = COMPOSITE.configurations[name].spectrum
        np.testing.assert_array_equal(curves[label].get_xdata(), spectrum.frequency)
        np.testing.assert_array_equal(
            curves[label].get_ydata(), spectrum.power_level[path("sphere")]
        )


def test_peaks_carry_the_names_of_their_modes() -> None:
    axes = first_axes(spectra.draw_sound_power(COMPOSITE))
    named = sorted((t.get_text(), round(t.get_position()[0], 1)) for t in names(axes))
    # E2 of C1 is 1 Hz from that of C0 and shares its name
    assert named == [
        ("B5", 103.2), ("B6", 137.2), ("B6", 148.1), ("B7", 185.5), ("B7", 199.1),
        ("E2", 128.0), ("T2", 155.6), ("T2", 166.9),
    ]  # fmt: skip
    top = axes.get_ylim()[1]
    assert all(t.get_position()[1] < top for t in axes.texts)


def test_curves_differ_by_more_than_colour() -> None:
    for strokes in (CONFIGURATION.values(), SERIES):
        assert len({str(s.linestyle) for s in strokes}) == len(strokes)
    looks = {(str(s.linestyle), s.linewidth) for s in STATE.values()}
    assert len(looks) == len(STATE)


def test_one_result_shows_its_states_and_several_their_coupled_ones() -> None:
    one = first_axes(sections.draw_lift_coefficient([COMPOSITE]))
    assert [line.get_label() for line in one.lines] == [
        "rigid", "chained (rigid blade's load)", "coupled",
    ]  # fmt: skip
    two = first_axes(sections.draw_lift_coefficient([ALUMINIUM, COMPOSITE]))
    curves = {line.get_label(): line.get_ydata() for line in two.lines}
    assert list(curves) == ["rigid", "aluminium", "composite"]
    row = state("coupled")
    np.testing.assert_array_equal(
        curves["composite"], COMPOSITE.static.sections.lift_coefficient[row]
    )


def test_a_state_that_could_not_be_computed_is_not_drawn() -> None:
    lost = replace(COMPOSITE, static=without_state(COMPOSITE.static, "chained"))
    one = first_axes(sections.draw_lift_coefficient([lost]))
    assert [line.get_label() for line in one.lines] == ["rigid", "coupled"]


def test_campbell_diagram_has_branches_rays_and_crossings() -> None:
    axes = first_axes(draw_campbell(ALUMINIUM))
    diagram = ALUMINIUM.campbell
    curves = [line for line in axes.lines if str(line.get_label()).startswith("wet modes")]
    assert len(curves) == len(diagram.name)
    np.testing.assert_array_equal(curves[0].get_ydata(), diagram.frequency[0])
    (rings,) = (line for line in axes.lines if line.get_label() == "crossings")
    np.testing.assert_array_equal(rings.get_xdata(), diagram.crossing_rotation)
    rays = [line for line in axes.lines if str(line.get_label()).startswith("multiples")]
    ends = np.array([(line.get_data()[0][-1], line.get_data()[1][-1]) for line in rays])
    slopes = diagram.order * diagram.blades / (2.0 * np.pi)
    np.testing.assert_allclose(ends[:, 1] / ends[:, 0], slopes)
    texts = {text.get_text() for text in axes.texts}
    assert {"B1", "B2", "T1", "1 x 5", "3 x 5"} <= texts


def test_angles_are_drawn_in_degrees() -> None:
    axes = first_axes(sections.draw_blade_angle([COMPOSITE]))
    tip = axes.lines[-1].get_ydata()[-1]  # type: ignore[index]
    assert tip == pytest.approx(1.1)
    assert "[°]" in axes.get_ylabel()


def test_a_run_that_did_not_converge_says_so() -> None:
    stopped = replace(COMPOSITE, static=replace(COMPOSITE.static, converged=False))
    assert "NOT converged" in texts(sections.draw_convergence(stopped))


def test_unsolved_frequencies_and_a_missing_configuration_are_drawn() -> None:
    c0 = COMPOSITE.configurations["C0"]
    power = c0.spectrum.power.copy()
    power[:, 5:9] = np.nan
    holed = replace(c0, spectrum=replace(c0.spectrum, power=power))
    axes = first_axes(spectra.draw_sound_power(replace(COMPOSITE, configurations={"C0": holed})))
    assert np.all(np.isfinite(axes.get_ylim()))
    assert [t.get_text() for t in names(axes)] == ["E2", "B6", "T2", "B7"]


def test_deep_antiresonances_do_not_flatten_the_peaks() -> None:
    c0 = COMPOSITE.configurations["C0"]
    power = c0.spectrum.power.copy()
    power[:, 40] = 1e-30
    deep = replace(c0, spectrum=replace(c0.spectrum, power=power))
    figure = spectra.draw_sound_power(replace(COMPOSITE, configurations={"C0": deep}))
    low, high = first_axes(figure).get_ylim()
    assert high - low < 100.0


def test_the_users_own_settings_neither_matter_nor_change() -> None:
    with mpl.rc_context({"font.size": 33.0, "axes.grid": False}):
        axes = first_axes(sections.draw_blade_angle([COMPOSITE]))
        assert axes.xaxis.label.get_size() == 8.5
        assert mpl.rcParams["font.size"] == 33.0


def test_shares_of_the_power_fill_the_axis_and_are_named() -> None:
    figure = FIGURES["shares"]()
    assert {"blade", "film", "water"} <= set(texts(figure).split("\n"))
    areas = first_axes(figure).collections
    top = max(float(np.max(area.get_paths()[0].vertices[:, 1])) for area in areas)
    assert top == pytest.approx(100.0)


def test_moduli_show_measured_points_temperature_and_fit() -> None:
    figure = FIGURES["moduli"]()
    written = texts(figure)
    assert "film: table, 10.0 °C, fit within 5 %" in written
    assert "over static [–]" in written  # one of them has no static modulus of its own
    circles = [line for line in first_axes(figure).lines if line.get_marker() == "o"]
    assert [len(line.get_xdata()) for line in circles] == [15, 0]
    table = COMPOSITE.moduli
    film = replace(
        table, name=("film",), model=("table",), static=table.static[:1], shift=table.shift[:1],
        temperature=table.temperature[:1], fit_error=table.fit_error[:1], ratio=table.ratio[:1],
        band_ratio=table.band_ratio[:1],
    )  # fmt: skip
    figure = losses.draw_moduli(replace(COMPOSITE, moduli=film))
    assert "Storage modulus [MPa]" in texts(figure)
    line = first_axes(figure).lines[0]
    np.testing.assert_allclose(line.get_ydata(), 1.5 * film.ratio[0].real)
