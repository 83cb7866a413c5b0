# SPDX-License-Identifier: LGPL-2.1-or-later
"""Friction, singing and the figures of the rotor."""

from dataclasses import replace

import numpy as np
import pytest

from quietblade.errors import GeometryError
from quietblade.flow import (
    BladeFlow,
    Environment,
    LiftingLineInflow,
    MomentumInflow,
    StripInflow,
    form_factor,
    friction_coefficient,
    friction_notices,
    operating_curves,
    performance,
    radial_wake,
    section_drag,
    section_shedding,
    section_table,
    shedding_frequency,
    singing_notices,
    strip_loads,
    viscous_loads,
)
from quietblade.flow.performance import DEFINITIONS, ideal_efficiency, ideal_notices
from quietblade.flow.singing import displacement_thickness
from tests.flow.shapes import OMEGA, V, fin, naca
from tests.flow.test_momentum import N, propeller

TURNING = 2.0 * np.pi * N


@pytest.fixture(scope="module")
def blade() -> BladeFlow:
    return strip_loads(fin(naca(edge=0.006, n=81)), StripInflow(V, OMEGA))


def test_friction_lines() -> None:
    assert friction_coefficient(1e7) == pytest.approx(0.003)
    assert friction_coefficient(1e6, "prandtl-schlichting") == pytest.approx(0.455 / 6.0**2.58)
    assert friction_coefficient(1e6, "laminar") == pytest.approx(1.328e-3)
    with pytest.raises(GeometryError, match="'prandtl-schlichting', 'laminar'"):
        friction_coefficient(1e6, "schoenherr")


def test_friction_falls_with_the_reynolds_number_and_stays_finite() -> None:
    reynolds = np.logspace(0.0, 9.0, 91)
    for line in ("ittc-1957", "prandtl-schlichting", "laminar"):
        friction = friction_coefficient(reynolds, line)
        assert np.all(np.isfinite(friction))
        assert np.all(np.diff(friction[reynolds > 1.1e4]) < 0.0)
    assert friction_coefficient(0.0) == 0.0


def test_form_factor() -> None:
    assert form_factor([0.0, 0.1]) == pytest.approx([1.0, 1.206])


def test_drag_pulls_along_the_stream_and_costs_thrust_and_torque(blade: BladeFlow) -> None:
    sections, loads = blade.sections, blade.loads
    drag = viscous_loads(sections, loads)
    np.testing.assert_allclose(drag.drag_coefficient, section_drag(sections, loads))
    np.testing.assert_allclose(np.cross(drag.force, loads.velocity), 0.0, atol=1e-10)
    along = np.sum(drag.force * loads.velocity, axis=1) / np.linalg.norm(loads.velocity, axis=1)
    per_length = loads.dynamic_pressure * sections.chord * drag.drag_coefficient
    np.testing.assert_allclose(along, per_length)
    inflow = StripInflow(V, OMEGA)
    ideal, real = performance(blade, inflow), performance(blade, inflow, drag)
    assert real.thrust < ideal.thrust
    assert real.torque > ideal.torque
    assert real.efficiency < ideal.efficiency


def test_given_drag_coefficients_replace_the_line(blade: BladeFlow) -> None:
    once = viscous_loads(blade.sections, blade.loads, 0.008)
    twice = viscous_loads(blade.sections, blade.loads, np.full(21, 0.016))
    np.testing.assert_allclose(twice.force, 2.0 * once.force)


def test_laminar_sections_are_noticed(blade: BladeFlow) -> None:
    (notice,) = friction_notices(blade.sections, blade.loads)
    assert notice.value == pytest.approx(3.8e5, rel=0.01)
    assert "section 20" in notice.where
    fast = strip_loads(fin(naca(n=61)), StripInflow(20.0, OMEGA))
    assert friction_notices(fast.sections, fast.loads) == []
    still = strip_loads(fin(naca(n=61)), StripInflow(0.0, 0.0))
    assert friction_notices(still.sections, still.loads) == []
    assert np.all(viscous_loads(still.sections, still.loads).force == 0.0)


def test_shedding_frequency_is_a_strouhal_number_of_the_wake(blade: BladeFlow) -> None:
    assert shedding_frequency(5.0, 0.002, 0.001, 0.2) == pytest.approx(1000.0 / 3.0)
    assert shedding_frequency(0.0, 0.002, 0.001) == 0.0
    sections, loads = blade.sections, blade.loads
    displacement = 2.0 * displacement_thickness(sections.chord, loads.reynolds)
    exact = 0.21 * loads.speed / (0.006 * sections.chord + displacement)
    np.testing.assert_allclose(section_shedding(sections, loads), exact, rtol=1e-6)
    sharp = section_shedding(sections, loads, displacement=np.zeros(21), strouhal=0.2)
    np.testing.assert_allclose(sharp, 0.2 * loads.speed / (0.006 * sections.chord), rtol=1e-6)


def test_singing_names_the_mode_and_the_section(blade: BladeFlow) -> None:
    shedding = section_shedding(blade.sections, blade.loads)
    middle = float(shedding[10])
    (notice,) = singing_notices(
        blade.sections, shedding, [0.1 * middle, middle, 50.0 * middle], ["B1", "B5", "T9"]
    )
    assert "section 10" in notice.where
    assert "B5" in notice.message
    assert notice.value == notice.limit == pytest.approx(middle)
    assert singing_notices(blade.sections, shedding, []) == []
    (numbered,) = singing_notices(blade.sections, shedding, middle)
    assert "mode 1" in numbered.message
    with pytest.raises(GeometryError, match="2 names for 1"):
        singing_notices(blade.sections, shedding, middle, ["B1", "B2"])


def test_figures_follow_their_definitions() -> None:
    inflow = MomentumInflow(0.7 * N, TURNING, density=1025.0, blades=4)
    flow = strip_loads(propeller(11), inflow)
    p = performance(flow, inflow)
    assert p.diameter == pytest.approx(1.0)
    assert p.thrust == pytest.approx(4.0 * flow.total.thrust)
    assert p.blade_torque == flow.total.torque
    assert p.advance_ratio == pytest.approx(0.7)
    assert p.thrust_coefficient == pytest.approx(p.thrust / (1025.0 * N**2))
    assert p.torque_coefficient == pytest.approx(p.torque / (1025.0 * N**2))
    ideal = p.advance_ratio * p.thrust_coefficient / (2.0 * np.pi * p.torque_coefficient)
    assert p.efficiency == pytest.approx(ideal)
    assert 0.5 < p.efficiency < 1.0
    assert [row[0] for row in p.table()] == [symbol for symbol, _, _ in DEFINITIONS.values()]
    assert "T V_A / (Q omega)" in str(p)


def test_no_rotor_is_better_than_the_actuator_disk() -> None:
    inflow = MomentumInflow(0.7 * N, TURNING, density=1025.0, blades=4)
    p = performance(strip_loads(propeller(11), inflow), inflow)
    ideal = ideal_efficiency(p, 1025.0)
    # the disk: eta = 1 / (1 + a) where T = 2 rho A V^2 a (1 + a)
    a = 1.0 / ideal - 1.0
    disk = 0.25 * np.pi * p.diameter**2
    assert 2.0 * 1025.0 * disk * p.advance_speed**2 * a * (1.0 + a) == pytest.approx(p.thrust)
    assert p.efficiency < ideal
    assert not list(ideal_notices(p, inflow, 1025.0))
    better = replace(p, efficiency=1.01 * ideal)
    (notice,) = ideal_notices(better, inflow, 1025.0)
    assert notice.limit == ideal
    # blade elements induce nothing: 1 is theirs by construction
    assert not list(ideal_notices(better, StripInflow(V, OMEGA), 1025.0))
    assert np.isnan(ideal_efficiency(replace(p, thrust=-1.0), 1025.0))


def test_advance_speed_behind_a_ship_is_the_mean_inflow() -> None:
    wake = radial_wake([0.1, 0.5], [0.7, 0.7])
    behind = MomentumInflow(5.0, TURNING, blades=4, wake=wake)
    open_water = MomentumInflow(3.5, TURNING, blades=4)
    flows = [strip_loads(propeller(11), m) for m in (behind, open_water)]
    a, b = performance(flows[0], behind), performance(flows[1], open_water)
    assert a.advance_speed == pytest.approx(3.5)
    assert a.efficiency == pytest.approx(b.efficiency)


def test_figures_without_rotation_are_not_numbers() -> None:
    inflow = LiftingLineInflow(5.0, 0.0)
    p = performance(strip_loads(fin(naca(n=61)), inflow), inflow)
    assert np.isnan([p.advance_ratio, p.thrust_coefficient, p.efficiency]).all()


def test_section_table(blade: BladeFlow) -> None:
    table = section_table(blade.sections, blade.loads, Environment(depth=3.0), 0.008)
    np.testing.assert_allclose(table.radius, 0.2 + np.linspace(0.0, 1.0, 21))
    np.testing.assert_allclose(table.incidence, blade.loads.alpha)
    assert np.all(table.drag_coefficient == 0.008)
    assert np.all(table.suction > 0.0)
    assert table.cavitation_number[0] > table.cavitation_number[-1]


def test_operating_curves_are_single_points_in_a_grid() -> None:
    points = propeller(11)
    speeds, rotations = np.array([[4.0], [6.0]]), np.array([40.0, 50.0, 60.0])
    curves = operating_curves(
        points, lambda v, w: MomentumInflow(v, w, blades=4), speeds, rotations
    )
    assert curves.thrust.shape == (2, 3)
    np.testing.assert_array_equal(curves.speed[:, 0], [4.0, 6.0])
    inflow = MomentumInflow(6.0, 50.0, blades=4)
    flow = strip_loads(points, inflow)
    single = performance(flow, inflow, viscous_loads(flow.sections, flow.loads))
    assert curves.thrust[1, 1] == pytest.approx(single.thrust)
    assert curves.efficiency[1, 1] == pytest.approx(single.efficiency)
    assert np.all(np.diff(curves.thrust, axis=1) > 0.0)
    # one advance ratio, one set of coefficients, but for the Reynolds number of the friction
    again = operating_curves(
        points, lambda v, w: MomentumInflow(v, w, blades=4), [4.0, 6.0], [40.0, 60.0], friction=None
    )
    assert again.thrust_coefficient[0] == pytest.approx(again.thrust_coefficient[1])
    assert again.incidence[0] == pytest.approx(again.incidence[1])
    assert again.inception_depth[1] > again.inception_depth[0]
