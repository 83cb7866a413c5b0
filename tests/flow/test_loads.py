# SPDX-License-Identifier: LGPL-2.1-or-later
"""Signs, invariance and balance of the strip loads."""

import numpy as np
import pytest

from quietblade.flow import (
    BladeFlow,
    PanelSections,
    StripInflow,
    integrate,
    section_frames,
    section_loads,
    span_integral,
    strip_loads,
)
from quietblade.typing import FloatArray
from tests.conftest import make_twisted_blade
from tests.flow.shapes import OMEGA, V, fin, naca, rotation
from tests.flow.test_sections import oblique_cylinder

INFLOW = StripInflow(V, OMEGA)
STATIONS = np.linspace(0.0, 1.0, 21)


def flow(points: FloatArray, velocity: FloatArray) -> BladeFlow:
    sections = section_frames(points)
    loads = section_loads(sections, velocity, density=1000.0, kinematic_viscosity=1e-6)
    return BladeFlow(sections, loads, integrate(sections, loads))


@pytest.fixture(scope="module")
def paper() -> BladeFlow:
    return strip_loads(fin(naca(edge=0.00126)), INFLOW)


def test_water_meets_the_turning_blade_from_its_lower_side(paper: BladeFlow) -> None:
    z = 0.2 + STATIONS
    velocity = INFLOW.velocity(paper.sections.reference)
    exact = np.stack([np.full(21, V), OMEGA * z, np.zeros(21)], axis=-1)
    np.testing.assert_allclose(velocity, exact, atol=1e-12)
    np.testing.assert_allclose(paper.loads.alpha, np.arctan2(OMEGA * z, V), atol=1e-12)
    np.testing.assert_allclose(paper.loads.speed, np.hypot(V, OMEGA * z), rtol=1e-12)
    assert np.degrees(paper.loads.alpha[-1]) == pytest.approx(7.92, abs=0.01)
    assert paper.loads.reynolds[[0, -1]] == pytest.approx([1.25e6, 3.8e5], rel=0.01)


def test_pressure_is_low_on_the_upper_side_and_force_points_to_it(paper: BladeFlow) -> None:
    upper, lower = paper.loads.pressure[:, 40], paper.loads.pressure[:, 120]
    assert np.all(upper < 0.0)
    assert np.all(lower > upper)
    assert np.all(paper.loads.force[:, 1] > 0.0)
    # Lift acts near the quarter chord: ahead of the mid chord it turns the nose up, about -z.
    assert np.all(paper.loads.moment[:, 2] < 0.0)
    arm = -paper.loads.moment[:, 2] / paper.loads.force[:, 1] / paper.sections.chord
    np.testing.assert_allclose(arm, 0.25, atol=0.01)


def test_blade_takes_power_from_the_shaft_and_pushes_the_ship(paper: BladeFlow) -> None:
    total = paper.total
    assert total.force[0] < 0.0 < total.thrust
    assert total.moment[0] < 0.0 < total.torque
    assert total.thrust == -total.force[0]
    assert total.torque == -total.moment[0]
    # Within the numerical drag: a few per cent of the small thrust of this blade.
    assert total.thrust * V == pytest.approx(total.torque * OMEGA, rel=0.03)


def test_turning_the_other_way_gives_the_same_thrust(paper: BladeFlow) -> None:
    other = strip_loads(fin(naca(edge=0.00126)), StripInflow(V, -OMEGA)).total
    assert other.thrust == pytest.approx(paper.total.thrust, rel=1e-9)
    assert other.torque == pytest.approx(-paper.total.torque, rel=1e-9)
    assert other.lift == pytest.approx(-paper.total.lift, rel=1e-9)


def test_force_is_lift_and_numerical_drag(paper: BladeFlow) -> None:
    loads, sections = paper.loads, paper.sections
    stream = INFLOW.velocity(sections.reference)
    stream /= np.linalg.norm(stream, axis=1, keepdims=True)
    scale = loads.dynamic_pressure * sections.chord
    drag = np.sum(loads.force * stream, axis=1)
    lift = np.sum(loads.force * np.cross(sections.tangent, stream), axis=1)
    np.testing.assert_allclose(drag, scale * loads.drag_error, atol=1e-10)
    np.testing.assert_allclose(lift, scale * loads.lift_coefficient, rtol=1e-12)
    np.testing.assert_allclose(lift, loads.lift_per_length, rtol=1e-12)


def test_moment_about_the_mid_chord_is_that_about_the_quarter_chord_moved() -> None:
    blade = strip_loads(make_twisted_blade().section(STATIONS, 161), INFLOW)
    sections, loads = blade.sections, blade.loads
    quarter = -0.25 * sections.chord[:, None] * sections.chord_direction
    scale = loads.dynamic_pressure * sections.chord**2
    nose_down = -(scale * loads.moment_coefficient)[:, None] * sections.tangent
    np.testing.assert_allclose(loads.moment, nose_down + np.cross(quarter, loads.force), atol=1e-9)


@pytest.mark.parametrize("seed", range(4))
def test_turning_blade_and_stream_together_turns_the_loads(seed: int) -> None:
    points, turned = make_twisted_blade().section(STATIONS, 81), rotation(seed)
    velocity = INFLOW.velocity(section_frames(points).reference)
    before, after = flow(points, velocity), flow(points @ turned.T, velocity @ turned.T)
    for name in ("alpha", "cp", "pressure", "lift_coefficient", "moment_coefficient"):
        np.testing.assert_allclose(
            getattr(after.loads, name), getattr(before.loads, name), rtol=1e-8, atol=1e-8
        )
    scale = np.abs(before.loads.force).max()
    for name in ("force", "moment"):
        exact = getattr(before.loads, name) @ turned.T
        np.testing.assert_allclose(getattr(after.loads, name), exact, atol=1e-9 * scale)
        total = turned @ getattr(before.total, name)
        np.testing.assert_allclose(getattr(after.total, name), total, atol=1e-9 * scale)


def test_position_around_the_axis_does_not_matter(paper: BladeFlow) -> None:
    c, s = np.cos(0.7), np.sin(0.7)
    turned = np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])
    other = strip_loads(fin(naca(edge=0.00126)) @ turned.T, INFLOW)
    np.testing.assert_allclose(other.loads.cp, paper.loads.cp, atol=1e-8)
    np.testing.assert_allclose(other.total.force, turned @ paper.total.force, atol=1e-6)
    assert other.total.torque == pytest.approx(paper.total.torque, rel=1e-9)


def test_raising_the_nose_adds_to_the_incidence() -> None:
    theta = 0.05
    points = fin(naca())
    turned = np.array(
        [[np.cos(theta), np.sin(theta), 0.0], [-np.sin(theta), np.cos(theta), 0.0], [0.0, 0.0, 1.0]]
    )
    level, raised = strip_loads(points, INFLOW), strip_loads(points @ turned.T, INFLOW)
    np.testing.assert_allclose(raised.sections.blade_angle, theta, atol=1e-12)
    np.testing.assert_allclose(raised.loads.alpha, level.loads.alpha + theta, atol=1e-12)


@pytest.mark.parametrize("tilt", [0.2, -0.5])
def test_simple_sweep_theory(tilt: float) -> None:
    """Swept cylinder in a straight stream: the normal velocity decides, however it is cut."""
    stream = np.array([4.0, 0.3, 0.0])
    straight = flow(oblique_cylinder(0.0)[0], np.broadcast_to(stream, (9, 3)))
    square, oblique = (
        flow(points, np.broadcast_to(stream, (9, 3))) for points in oblique_cylinder(tilt)
    )
    np.testing.assert_allclose(oblique.loads.force, square.loads.force, atol=1e-9)
    np.testing.assert_allclose(oblique.loads.pressure, square.loads.pressure, atol=1e-7)
    assert oblique.total.lift == pytest.approx(square.total.lift, rel=1e-10)
    ratio = oblique.total.lift / straight.total.lift
    assert ratio == pytest.approx(lift_ratio(tilt, stream), rel=1e-10)
    # To first order in the incidence: W_n falls by cos, the incidence grows by 1 / cos.
    small = lift_ratio(tilt, np.array([4.0, 0.01, 0.0]), camber=0.0)
    assert small == pytest.approx(np.cos(tilt), rel=1e-3)


def lift_ratio(tilt: float, stream: FloatArray, camber: float = 0.02) -> float:
    """Lift of the swept over that of the straight cylinder from the section alone."""
    speeds = np.array([stream[0] * np.cos(tilt), stream[0]])
    section = PanelSections(naca(0.08, camber, 0.002)[None])
    lift = section.solve(np.arctan2(stream[1], speeds)[:, None]).lift[:, 0]
    pressure = speeds**2 + stream[1] ** 2
    return float(lift[0] * pressure[0] / (lift[1] * pressure[1]))


def test_power_of_the_pressure_is_that_of_the_numerical_drag() -> None:
    """Thrust V - torque omega = - drag W, summed, for a blade without moment about the axis."""
    blade = strip_loads(make_twisted_blade().section(STATIONS, 161), INFLOW)
    sections, loads = blade.sections, blade.loads
    drag = loads.dynamic_pressure * sections.chord * loads.drag_error
    lost = span_integral(sections, drag * loads.speed)
    about_span = span_integral(sections, loads.moment)[0]
    gained = blade.total.thrust * V - (blade.total.torque + about_span) * OMEGA
    assert gained == pytest.approx(-lost, rel=1e-9)


def test_integral_does_not_depend_on_the_number_of_sections(paper: BladeFlow) -> None:
    fine = strip_loads(fin(naca(edge=0.00126), 81), INFLOW).total
    assert paper.total.lift == pytest.approx(fine.lift, rel=1e-5)
    np.testing.assert_allclose(paper.total.moment, fine.moment, rtol=1e-4)


def test_moment_is_force_times_arm() -> None:
    """Shift the blade along its span: the moment changes by the shift times the force."""
    points, velocity = fin(naca()), np.broadcast_to([V, 0.4, 0.0], (21, 3))
    shift = np.array([0.1, -0.3, 0.7])
    here, there = flow(points, velocity).total, flow(points + shift, velocity).total
    np.testing.assert_allclose(there.force, here.force, atol=1e-9)
    np.testing.assert_allclose(there.moment, here.moment + np.cross(shift, here.force), atol=1e-8)


def test_water_at_rest_loads_nothing() -> None:
    still = strip_loads(fin(naca()), StripInflow(0.0, 0.0))
    assert np.all(still.loads.pressure == 0.0)
    assert still.total.lift == 0.0


def test_pressure_scales_with_density_and_speed_squared(paper: BladeFlow) -> None:
    double = strip_loads(fin(naca(edge=0.00126)), StripInflow(2 * V, 2 * OMEGA, 500.0))
    np.testing.assert_allclose(double.loads.pressure, 2.0 * paper.loads.pressure, rtol=1e-12)
