# SPDX-License-Identifier: LGPL-2.1-or-later
"""Laws of the boundary layer and of polars; reference figures: verification/flow_layer.py."""

import numpy as np
import pytest

from quietblade.errors import GeometryError
from quietblade.flow import PanelSections
from quietblade.flow.boundary_layer import march_layer
from quietblade.flow.polar import boundary_layer, section_polar
from quietblade.flow.section_stall import nose_radius, suction_limit
from quietblade.typing import FloatArray
from tests.flow.shapes import naca

PLATE = np.linspace(0.0, 1.0, 300)[None] ** 2


def on_plate(reynolds: float, **options: float) -> FloatArray:
    layer = march_layer(PLATE, np.ones_like(PLATE), np.zeros_like(PLATE), reynolds, **options)
    return layer.momentum_thickness[0]


def test_laminar_layers_scale_with_the_root_of_the_reynolds_number() -> None:
    thin, thick = (on_plate(re, n_crit=1e9) for re in (4e6, 1e6))
    np.testing.assert_allclose(thick[1:], 2.0 * thin[1:], rtol=1e-12)


def test_a_laminar_plate_keeps_momentum() -> None:
    layer = march_layer(PLATE, np.ones_like(PLATE), np.zeros_like(PLATE), 1e6, n_crit=1e9)
    friction, arc = layer.friction[0, 20:], layer.arc[0, 20:]
    loss = np.sum(0.5 * (friction[1:] + friction[:-1]) * np.diff(arc))
    gain = 2.0 * (layer.momentum_thickness[0, -1] - layer.momentum_thickness[0, 20])
    assert gain == pytest.approx(loss, rel=2e-3)


def test_stations_hardly_matter() -> None:
    thickness = []
    for stations in (200, 800):
        arc = np.linspace(0.0, 1.0, stations)[None] ** 2
        layer = march_layer(arc, 1.0 - 0.1 * arc, np.full_like(arc, -0.1), 1e6)
        thickness.append(layer.momentum_thickness[0, -1])
    assert thickness[0] == pytest.approx(thickness[1], rel=0.01)


def test_sides_of_a_batch_do_not_know_each_other() -> None:
    arc = np.repeat(PLATE, 3, axis=0)
    slope = np.array([[0.0], [-0.2], [0.1]])
    speed, gradient = 1.0 + slope * arc, slope + 0.0 * arc
    reynolds, trip = np.array([1e6, 3e6, 1e7]), np.array([np.inf, 0.3, 0.05])
    together = march_layer(arc, speed, gradient, reynolds, trip=trip)
    for k in range(3):
        row = slice(k, k + 1)
        alone = march_layer(arc[row], speed[row], gradient[row], reynolds[k], trip=trip[k])
        for name in ("momentum_thickness", "shape", "transition", "separation"):
            np.testing.assert_allclose(getattr(together, name)[k], getattr(alone, name)[0])


def test_noise_of_the_stream_brings_transition_forward() -> None:
    places = [
        march_layer(PLATE, np.ones_like(PLATE), np.zeros_like(PLATE), 1e7, n_crit=n).transition[0]
        for n in (3.0, 6.0, 9.0)
    ]
    assert 0.0 < places[0] < places[1] < places[2] < 0.5


def test_a_trip_forces_transition() -> None:
    layer = march_layer(PLATE, np.ones_like(PLATE), np.zeros_like(PLATE), 1e6, trip=0.2)
    assert layer.transition[0] == pytest.approx(0.2)
    free = march_layer(PLATE, np.ones_like(PLATE), np.zeros_like(PLATE), 1e6)
    assert np.isnan(free.transition[0])
    assert layer.drag()[0] > 2.0 * free.drag()[0]


def test_a_strong_pressure_rise_separates_the_turbulent_layer() -> None:
    speed = 1.0 - 0.6 * PLATE
    layer = march_layer(PLATE, speed, np.full_like(PLATE, -0.6), 1e7, trip=0.05)
    mild = march_layer(PLATE, 1.0 - 0.1 * PLATE, np.full_like(PLATE, -0.1), 1e7, trip=0.05)
    assert 0.2 < layer.separation[0] < 0.9
    assert np.isnan(mild.separation[0])


def test_a_symmetric_section_has_a_symmetric_polar() -> None:
    polar = section_polar(naca(0.12), np.radians([-4.0, 0.0, 4.0]), 1e6)
    assert polar.drag_coefficient[0] == pytest.approx(polar.drag_coefficient[2], rel=1e-6)
    assert polar.transition_upper[0] == pytest.approx(polar.transition_lower[2], abs=1e-6)
    assert polar.lift_coefficient[1] == pytest.approx(0.0, abs=1e-9)
    assert polar.drag_coefficient[1] < polar.drag_coefficient[0]
    assert polar.minimum_pressure[0] == pytest.approx(polar.minimum_pressure[2], rel=1e-9)


def test_polar_without_a_layer() -> None:
    alpha = np.radians([0.0, 2.0])
    bare, full = (section_polar(naca(0.09, 0.02), alpha, re) for re in (None, 2e6))
    np.testing.assert_array_equal(bare.lift_coefficient, full.lift_coefficient)
    np.testing.assert_array_equal(bare.minimum_pressure, full.minimum_pressure)
    assert np.isnan(bare.drag_coefficient).all()
    assert not bare.stalled.any()
    assert np.isfinite(full.drag_coefficient).all()


def test_sections_of_a_batch_and_one_by_one() -> None:
    contours = np.array([naca(0.09), naca(0.12, 0.02)])
    gamma = PanelSections(contours).solve(np.radians([2.0, 1.0])).gamma
    together = boundary_layer(contours, gamma, np.array([1e6, 2e6]))
    for k, reynolds in enumerate((1e6, 2e6)):
        alone = boundary_layer(contours[k], gamma[k], reynolds)
        assert together.drag_coefficient[k] == pytest.approx(alone.drag_coefficient[0])
        assert together.upper.transition[k] == pytest.approx(alone.upper.transition[0])


def test_a_forced_transition_at_a_chord_fraction() -> None:
    polar = section_polar(naca(0.12), np.radians([0.0]), 1e6, trip=(0.1, 0.3))
    assert polar.transition_upper[0] == pytest.approx(0.1, abs=1e-3)
    assert polar.transition_lower[0] == pytest.approx(0.3, abs=1e-3)
    free = section_polar(naca(0.12), np.radians([0.0]), 1e6)
    assert polar.drag_coefficient[0] > 1.2 * free.drag_coefficient[0]


def test_trailing_edge_may_be_blunt_or_sharp() -> None:
    drag = [
        section_polar(naca(0.12, edge=edge), np.radians([2.0]), 1e6).drag_coefficient[0]
        for edge in (0.0, 0.002)
    ]
    assert drag[0] == pytest.approx(drag[1], rel=0.05)


def test_stall_comes_with_incidence_and_goes_with_the_reynolds_number() -> None:
    alpha = np.radians([2.0, 7.0, 12.0])
    low, high = (section_polar(naca(0.06), alpha, re).stalled for re in (3.8e5, 3e6))
    np.testing.assert_array_equal(low, [False, True, True])
    np.testing.assert_array_equal(high, [False, False, True])


def test_nose_radius_of_naca_sections() -> None:
    for n in (121, 160 + 1):
        assert nose_radius(naca(0.12, n=n)) == pytest.approx(1.1019 * 0.12**2, rel=0.01)
    assert nose_radius(naca(0.12, 0.02)) == pytest.approx(1.1019 * 0.12**2, rel=0.1)
    assert suction_limit(0.01, 1e6) == pytest.approx(suction_limit(0.001, 1e7))


def test_a_flow_without_a_stagnation_point_is_refused() -> None:
    with pytest.raises(GeometryError, match="no stagnation point"):
        boundary_layer(naca(0.12), np.ones(161), 1e6)
