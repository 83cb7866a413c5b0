# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tables of the inflow along the radius."""

import numpy as np
import pytest

from quietblade.errors import GeometryError
from quietblade.flow import (
    INFLOWS,
    LiftingLineInflow,
    MomentumInflow,
    StripInflow,
    radial_wake,
    strip_loads,
    wake_of_angles,
)
from quietblade.flow.inflow import Stream
from tests.flow.shapes import OMEGA, V, fin, naca

R = np.array([0.1, 0.5, 0.9, 1.3])


@pytest.mark.parametrize("model", INFLOWS.values())
def test_uniform_table_changes_nothing(model: type[Stream]) -> None:
    plain = model(V, OMEGA, blades=3)
    table = model(V, OMEGA, blades=3, wake=radial_wake(R, np.ones(4)))
    points = fin(naca(n=61))
    a, b = strip_loads(points, plain), strip_loads(points, table)
    np.testing.assert_allclose(b.loads.pressure, a.loads.pressure, rtol=1e-12, atol=1e-9)


def test_axial_and_tangential_velocity_add_to_the_blades_own() -> None:
    wake = radial_wake([0.2, 1.2], [0.6, 1.0], [0.1, 0.1])
    stream = StripInflow(V, OMEGA, wake=wake)
    velocity = stream.velocity(np.array([[0.3, 0.0, 0.7], [0.0, -0.7, 0.0]]))
    np.testing.assert_allclose(velocity[:, 0], 0.8 * V)
    # swirl in the sense of the rotation lowers the speed that the blade meets
    relative = OMEGA * 0.7 - 0.1 * V
    np.testing.assert_allclose(velocity[0, 1:], [relative, 0.0], atol=1e-12)
    np.testing.assert_allclose(velocity[1, 1:], [0.0, relative], atol=1e-12)


def test_water_on_the_axis_has_no_swirl() -> None:
    stream = StripInflow(V, OMEGA, wake=radial_wake([0.1, 1.0], [0.5, 1.0], [0.2, 0.0]))
    np.testing.assert_allclose(stream.velocity(np.zeros((1, 3))), [[0.5 * V, 0.0, 0.0]])


@pytest.mark.parametrize("rotation", [OMEGA, -OMEGA])
def test_table_of_angles_gives_the_stream_back(rotation: float) -> None:
    speed = np.array([3.0, 4.0, 4.5, 5.0])
    angle = np.radians([80.0, 75.0, 70.0, 60.0])
    wake = wake_of_angles(R, speed, angle, speed=V, rotation=rotation)
    points = R[:, None] * np.array([0.0, 0.0, 1.0])
    velocity = StripInflow(V, rotation, wake=wake).velocity(points)
    np.testing.assert_allclose(np.linalg.norm(velocity, axis=1), speed)
    np.testing.assert_allclose(np.arctan2(velocity[:, 0], np.abs(velocity[:, 1])), angle)
    assert np.all(np.sign(velocity[:, 1]) == np.sign(rotation))


def test_mean_is_weighted_with_the_area() -> None:
    wake = radial_wake([0.0, 1.0], [0.0, 1.0])  # straight: a table of two is linear
    assert wake.mean(0.0, 1.0) == pytest.approx(2.0 / 3.0)
    assert radial_wake(R, np.full(4, 0.7)).mean(0.2, 1.2) == pytest.approx(0.7)


def test_end_values_are_held_and_noticed() -> None:
    short = radial_wake([0.4, 0.8], [0.5, 1.0])
    np.testing.assert_allclose(short.at([0.1, 2.0])[0], [0.5, 1.0])
    for model in (LiftingLineInflow(V, OMEGA, wake=short), MomentumInflow(V, OMEGA, wake=short)):
        blade = strip_loads(fin(naca(n=61)), model)
        found = [n for n in model.notices(blade.sections, blade.loads) if "table" in n.where]
        assert [n.limit for n in found] == [0.4, 0.8]
    enough = StripInflow(V, OMEGA, wake=radial_wake([0.2, 1.2], [0.5, 1.0]))
    blade = strip_loads(fin(naca(n=61)), enough)
    assert not [n for n in enough.notices(blade.sections, blade.loads) if "table" in n.where]


def test_strip_theory_says_by_how_much_it_overestimates() -> None:
    blade = strip_loads(fin(naca(n=61)), StripInflow(V, OMEGA))
    (notice,) = StripInflow(V, OMEGA).notices(blade.sections, blade.loads)
    assert notice.value == pytest.approx(1.0 / 0.1625, rel=1e-3)
    assert "1.33" in notice.message


def test_impossible_tables_are_refused() -> None:
    with pytest.raises(GeometryError, match="at least two"):
        radial_wake([0.1], [1.0])
    with pytest.raises(GeometryError, match="must increase"):
        radial_wake([0.3, 0.2], [1.0, 1.0])
    with pytest.raises(GeometryError, match="2 axial"):
        radial_wake([0.1, 0.2, 0.3], [1.0, 1.0])
    with pytest.raises(GeometryError, match="speed of advance is 0"):
        wake_of_angles(R, np.ones(4), np.ones(4), speed=0.0, rotation=1.0)
