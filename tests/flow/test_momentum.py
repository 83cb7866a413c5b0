# SPDX-License-Identifier: LGPL-2.1-or-later
"""Blade-element momentum: balance, existence of the root in every state, signs, losses."""

from dataclasses import replace

import numpy as np
import pytest

from quietblade.errors import GeometryError
from quietblade.flow import (
    DeformedSections,
    Environment,
    MomentumInflow,
    PanelSections,
    StripInflow,
    inception_depth,
    inception_ship_speed,
    integrate,
    section_frames,
)
from quietblade.flow.cavitation import is_judged
from quietblade.flow.momentum import buhl, prandtl_factor
from quietblade.flow.sections import AXIS
from quietblade.typing import FloatArray
from tests.flow.shapes import naca, turn

RADIUS, HUB, PITCH = 0.5, 0.1, 1.0
N = 8.0  # turns a second
OMEGA = 2.0 * np.pi * N


def propeller(
    sections: int = 21, chord: float = 0.08, pitch: float = PITCH, camber: float = 0.02
) -> FloatArray:
    """Blade of constant pitch over diameter (sections, 81, 3)."""
    r = np.linspace(HUB, RADIUS, sections)
    contour = chord * (naca(0.08, camber, n=81) - [0.5, 0.0])
    angle = 0.5 * np.pi - np.arctan2(2.0 * RADIUS * pitch, 2.0 * np.pi * r)
    points = np.zeros((sections, 81, 3))
    for k in range(sections):
        points[k, :, :2] = turn(contour, angle[k])
    points[..., 2] = r[:, None]
    return points


@pytest.fixture(scope="module")
def blade() -> tuple[DeformedSections, PanelSections]:
    sections = section_frames(propeller())
    return sections, PanelSections(sections.contours)


def model(advance: float, sense: float = 1.0, blades: int = 4) -> MomentumInflow:
    return MomentumInflow(advance * N * 2.0 * RADIUS, sense * OMEGA, blades=blades)


def test_propeller_pushes_and_momentum_lowers_the_load(
    blade: tuple[DeformedSections, PanelSections],
) -> None:
    inflow = model(0.6)
    induced = inflow.loads(*blade)
    strip = StripInflow(inflow.speed, inflow.rotation).loads(*blade)
    total = integrate(blade[0], induced)
    assert total.thrust > 0.0
    assert total.torque > 0.0
    assert total.thrust < integrate(blade[0], strip).thrust
    assert np.all(induced.induced[1:-1] @ AXIS > 0.0)
    assert np.all(induced.alpha < strip.alpha)


def test_an_end_without_lift_does_not_say_where_cavitation_begins(
    blade: tuple[DeformedSections, PanelSections],
) -> None:
    sections, panels = blade
    induced = model(0.6).loads(sections, panels)
    judged = is_judged(induced)
    assert judged[1:-1].all()
    assert not judged[[0, -1]].any()
    assert abs(induced.lift_coefficient[-1]) < 1e-2
    water = Environment(depth=2.0)
    depth = inception_depth(sections, induced, water)
    speed = inception_ship_speed(sections, induced, water, 5.0)
    assert np.all(np.isneginf(depth[[0, -1]]))
    assert np.all(np.isposinf(speed[[0, -1]]))
    assert np.all(np.isfinite(depth[1:-1]))
    assert np.all(np.isfinite(speed[1:-1]))
    assert is_judged(StripInflow(5.0, OMEGA).loads(sections, panels)).all()


@pytest.mark.parametrize("advance", [-0.8, -0.3, 0.0, 0.05, 0.5, 0.9, 1.1, 1.3, 1.8, 4.0, 50.0])
@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_a_root_exists_in_every_state(
    blade: tuple[DeformedSections, PanelSections], advance: float, sense: float
) -> None:
    rings, axial, tangential = model(advance, sense).rings(*blade)
    phi, speed = rings.solve()
    assert np.all(np.isfinite(speed))
    assert np.all(speed > 0.0)
    # the axial and the tangential balance, each by itself; at the ends F = 0 replaces them
    a, t = rings.balance(phi)
    np.testing.assert_allclose((speed * a)[1:-1], rings.axial[1:-1], atol=1e-8 * OMEGA)
    np.testing.assert_allclose((speed * t)[1:-1], rings.tangential[1:-1], rtol=1e-8)
    np.testing.assert_allclose(np.linalg.norm(axial, axis=1), 1.0)
    np.testing.assert_allclose(np.sum(axial * tangential, axis=1), 0.0, atol=1e-12)


def test_thrust_and_torque_of_a_ring_are_its_momentum(
    blade: tuple[DeformedSections, PanelSections],
) -> None:
    sections, _ = blade
    inflow = replace(model(0.7), tip_loss=False, hub_loss=False)
    loads = inflow.loads(*blade)
    r = sections.reference[:, 2]
    axial = inflow.speed + loads.induced @ AXIS
    pushed = 4.0 * np.pi * r * inflow.density * axial * (loads.induced @ AXIS)
    np.testing.assert_allclose(-4.0 * loads.force @ AXIS, pushed, rtol=0.01)
    # swirl of the water in the sense of the rotation; W's y component is + omega r
    swirl = 4.0 * np.pi * r * inflow.density * axial * -loads.induced[:, 1]
    np.testing.assert_allclose(4.0 * loads.force[:, 1], swirl, rtol=0.015)


def test_losses_unload_tip_and_hub(blade: tuple[DeformedSections, PanelSections]) -> None:
    loads = model(0.6).loads(*blade)
    circulation = loads.lift_per_length / loads.speed
    np.testing.assert_allclose(circulation[[0, -1]], 0.0, atol=1e-2 * circulation.max())
    without = replace(model(0.6), tip_loss=False, hub_loss=False).loads(*blade)
    assert np.all((without.lift_per_length / without.speed)[[0, -1]] > 0.2 * circulation.max())


def test_prandtl_factor_and_buhls_fit() -> None:
    assert prandtl_factor(np.array([0.0, np.inf])) == pytest.approx([0.0, 1.0])
    assert prandtl_factor(np.array([1.0])) == pytest.approx(2 / np.pi * np.arccos(np.exp(-1.0)))
    for factor in (1.0, 0.6, 0.1):
        f = np.array([factor])
        # it joins momentum theory at an induction of 0.4 and loads a plate with C_T = 2
        assert buhl(np.array([2.0 / 3.0]), f) == pytest.approx(0.6)
        heavy = np.array([1e6])
        thrust = 4.0 * heavy * buhl(heavy, f) ** 2 * factor
        assert thrust == pytest.approx(2.0, rel=2e-2)
    pole = np.array([25.0 / 18.0 - 1.0])  # third = 0 for F = 1
    assert buhl(pole, np.ones(1)) == pytest.approx(buhl(pole + 1e-6, np.ones(1)), abs=1e-4)


def test_turning_the_other_way_mirrors_a_mirrored_blade(
    blade: tuple[DeformedSections, PanelSections],
) -> None:
    mirrored = propeller() * [1.0, -1.0, 1.0]
    other = section_frames(mirrored[:, ::-1])
    loads = model(0.6, sense=-1.0).loads(other)
    total, exact = integrate(other, loads), integrate(blade[0], model(0.6).loads(*blade))
    assert total.thrust == pytest.approx(exact.thrust, rel=1e-9)
    assert total.torque == pytest.approx(-exact.torque, rel=1e-9)


def test_bollard_pull_and_no_rotation(blade: tuple[DeformedSections, PanelSections]) -> None:
    bollard = model(0.0).loads(*blade)
    assert integrate(blade[0], bollard).thrust > 0.0
    assert np.all(bollard.induced[1:-1] @ AXIS > 0.0)
    towed = MomentumInflow(5.0, 0.0, blades=4).loads(*blade)
    assert integrate(blade[0], towed).thrust < 0.0
    still = MomentumInflow(0.0, 0.0, blades=4).loads(*blade)
    assert np.all(still.pressure == 0.0)


def test_windmilling_brakes_the_water_and_drives_the_shaft(
    blade: tuple[DeformedSections, PanelSections],
) -> None:
    loads = model(1.6).loads(*blade)
    total = integrate(blade[0], loads)
    assert total.thrust < 0.0
    assert total.torque < 0.0
    assert np.all(loads.induced[1:-1] @ AXIS < 0.0)


def test_coned_blade_keeps_its_balance(blade: tuple[DeformedSections, PanelSections]) -> None:
    points = propeller()
    points[..., 0] += 0.3 * points[..., 2]
    sections = section_frames(points)
    inflow = replace(model(0.7), tip_loss=False, hub_loss=False)
    loads = inflow.loads(sections)
    r = np.hypot(sections.reference[:, 1], sections.reference[:, 2])
    per_radius = loads.force / sections.tangent[:, 2:]
    axial = inflow.speed + loads.induced @ AXIS
    pushed = 4.0 * np.pi * r * inflow.density * axial * (loads.induced @ AXIS)
    np.testing.assert_allclose(-4.0 * per_radius @ AXIS, pushed, rtol=0.01)


def test_what_lies_outside_is_noticed(blade: tuple[DeformedSections, PanelSections]) -> None:
    def messages(inflow: MomentumInflow, sections: DeformedSections) -> str:
        return " ".join(n.message for n in inflow.notices(sections, inflow.loads(sections)))

    slender = blade[0]
    assert messages(model(0.7), slender) == ""
    assert "number of blades" in messages(model(0.7, blades=1), slender)
    assert "flat sheets" in messages(model(2.0), slender)
    wide = section_frames(propeller(chord=0.2, sections=9))
    assert "chord over tip radius" in messages(model(0.7), wide)
    flat = section_frames(propeller(chord=0.2, sections=9, pitch=0.3))
    assert "brakes" in messages(model(1.2, blades=12), flat)


def test_impossible_rings_are_refused() -> None:
    with pytest.raises(GeometryError, match="0 blades"):
        MomentumInflow(1.0, OMEGA, blades=0).loads(section_frames(propeller(5)))
    points = propeller(5)
    points[..., 2] -= HUB
    with pytest.raises(GeometryError, match="rotor axis"):
        model(0.7).loads(section_frames(points))
    lying = propeller(9)
    lying[..., 0] += 100.0 * (lying[..., 2] - HUB)
    with pytest.raises(GeometryError, match="degrees off the radius"):
        model(0.7).loads(section_frames(lying))
