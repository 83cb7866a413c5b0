# SPDX-License-Identifier: LGPL-2.1-or-later
"""The lifting line: closed forms, symmetry, bending, what it says of its own limits."""

import numpy as np
import pytest

from quietblade.errors import GeometryError
from quietblade.flow import (
    LiftingLineInflow,
    PanelSections,
    StripInflow,
    circulation_response,
    integrate,
    section_frames,
    strip_loads,
)
from quietblade.flow.lifting_line import VortexLine, line_parameter, to_angle
from quietblade.flow.vortices import ray_velocity, segment_velocity
from quietblade.typing import FloatArray
from tests.flow.shapes import OMEGA, V, fin, naca

STREAM = np.array([1.0, 0.0, 0.0])


def line(span: float, elements: int = 40) -> VortexLine:
    vertices, centres = line_parameter(elements, "free")
    z = np.array([0.0, 0.0, span])
    return VortexLine(
        vertices=vertices[:, None] * z,
        centres=centres[:, None] * z,
        offset=np.zeros((elements, 3)),
        wake=np.broadcast_to(STREAM, (elements + 1, 3)),
    )


def test_endless_vortex_from_a_segment_and_from_two_rays() -> None:
    points = np.array([[0.3, -0.4, 0.1], [2.0, 0.0, -1.0]])
    up = np.array([0.0, 0.0, 1.0])
    square = np.sum(points[:, :2] ** 2, axis=1, keepdims=True)
    exact = np.cross(up, points) / (2.0 * np.pi * square)
    long = segment_velocity(points, -1e6 * up, 1e6 * up)
    rays = ray_velocity(points, 0.0 * up, up) - ray_velocity(points, 0.0 * up, -up)
    np.testing.assert_allclose(long, exact, rtol=1e-9)
    np.testing.assert_allclose(rays, exact, rtol=1e-12)


def test_a_ray_is_a_very_long_segment_and_nothing_happens_on_the_vortex() -> None:
    start, along = np.array([1.0, 2.0, 3.0]), np.array([0.6, 0.0, 0.8])
    point = np.array([0.5, 1.0, 4.0])
    np.testing.assert_allclose(
        ray_velocity(point, start, along),
        segment_velocity(point, start, start + 1e7 * along),
        rtol=1e-6,
    )
    assert np.all(ray_velocity(start + 2.0 * along, start, along) == 0.0)
    assert np.all(segment_velocity(start + 0.5 * along, start, start + along) == 0.0)
    assert np.all(segment_velocity(start, start, start + along) == 0.0)


def test_elliptic_circulation_makes_a_constant_downwash() -> None:
    span, elements = 2.0, 40
    _, centres = line_parameter(elements, "free")
    circulation = np.sqrt(1.0 - (2.0 * centres - 1.0) ** 2)
    wash = line(span, elements).influence() @ np.eye(3)
    induced = np.einsum("ijd,j->id", wash, circulation)
    np.testing.assert_allclose(induced[:, 1], induced[0, 1], rtol=1e-10)
    assert induced[0, 1] == pytest.approx(-1.0 / (2.0 * span), rel=1e-3)
    np.testing.assert_allclose(induced[:, [0, 2]], 0.0, atol=1e-12)


@pytest.mark.parametrize("root", ["free", "mirrored"])
def test_angle_is_the_inverse_of_the_span_parameter(root: str) -> None:
    vertices, centres = line_parameter(10, root)  # type: ignore[arg-type]
    np.testing.assert_allclose(to_angle(vertices, root), np.arange(11) / 10, atol=1e-12)  # type: ignore[arg-type]
    np.testing.assert_allclose(to_angle(centres, root), (np.arange(10) + 0.5) / 10)  # type: ignore[arg-type]


def rectangle(
    span: float, offset: float = 0.0, n: int = 61, incidence: float = 0.05, camber: float = 0.0
) -> FloatArray:
    """Straight wing (sections, n, 3) of chord 1 between z = offset and offset + span."""
    contour = naca(0.06, camber, n=n) - [0.5, 0.0]
    c, s = np.cos(incidence), np.sin(incidence)
    stations = 0.5 * (1.0 - np.cos(np.linspace(0.0, np.pi, 41)))
    points = np.zeros((41, n, 3))
    points[..., :2] = contour @ np.array([[c, -s], [s, c]])
    points[..., 2] = offset + span * stations[:, None]
    return points


@pytest.mark.parametrize("control", ["prandtl", "weissinger"])
def test_mirrored_half_is_half_of_the_whole_wing(control: str) -> None:
    half = strip_loads(rectangle(3.0), LiftingLineInflow(5.0, 0.0, control=control))  # type: ignore[arg-type]
    whole = strip_loads(
        rectangle(6.0, -3.0),
        LiftingLineInflow(5.0, 0.0, root="free", control=control, elements=120),  # type: ignore[arg-type]
    )
    assert 2.0 * half.total.lift == pytest.approx(whole.total.lift, rel=1e-4)
    assert 2.0 * half.total.force[0] == pytest.approx(whole.total.force[0], rel=1e-3)


def test_a_cambered_foil_may_begin_on_the_axis() -> None:
    model = LiftingLineInflow(5.0, 0.0)
    on_axis, away = (strip_loads(rectangle(3.0, z, camber=0.04), model) for z in (0.0, 7.0))
    np.testing.assert_allclose(on_axis.loads.induced, away.loads.induced, atol=1e-9)
    swept = rectangle(3.0, camber=0.04) + np.array([0.0, 0.2, 0.0])  # its root lies beside the axis
    np.testing.assert_allclose(
        strip_loads(swept, model).loads.induced, away.loads.induced, atol=1e-9
    )


def test_sections_carry_the_circulation_of_the_line_and_the_tip_none() -> None:
    blade = strip_loads(fin(naca()), LiftingLineInflow(V, OMEGA))
    sections, loads = blade.sections, blade.loads
    panels = PanelSections(sections.contours)
    gamma = np.sum(circulation_response(sections, panels) * loads.velocity, axis=1)
    lift = loads.density * gamma * loads.speed
    # by circulation and by pressure, which agree to a thousandth of the largest
    np.testing.assert_allclose(lift, loads.lift_per_length, atol=2e-3 * lift.max())
    assert abs(gamma[-1]) < 0.05 * gamma.max()
    # the force is perpendicular to the stream that includes the downwash
    assert np.all(loads.induced[7:, 1] < 0.0)
    drag = np.sum(loads.force * loads.velocity, axis=1) / loads.speed
    scale = loads.dynamic_pressure * sections.chord
    np.testing.assert_allclose(drag, scale * loads.drag_error, atol=1e-9)


def test_induced_drag_costs_power() -> None:
    paper = strip_loads(fin(naca()), LiftingLineInflow(V, OMEGA)).total
    assert 0.8 < paper.thrust * V / (paper.torque * OMEGA) < 0.9


def test_few_sections_give_the_same_lift() -> None:
    model = LiftingLineInflow(V, OMEGA)
    coarse, fine = (strip_loads(fin(naca(n=81), n), model).total.lift for n in (15, 61))
    # the sum over the sections feels the steep fall at the tip, the line itself does not
    assert coarse == pytest.approx(fine, rel=1e-2)


def test_position_around_the_axis_does_not_matter() -> None:
    c, s = np.cos(0.7), np.sin(0.7)
    turned = np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])
    model, points = LiftingLineInflow(V, OMEGA), fin(naca(n=81))
    here, there = strip_loads(points, model), strip_loads(points @ turned.T, model)
    np.testing.assert_allclose(there.loads.alpha, here.loads.alpha, atol=1e-10)
    np.testing.assert_allclose(there.total.force, turned @ here.total.force, atol=1e-7)


def test_bending_keeps_a_smooth_flow() -> None:
    points = fin(naca(n=81), 41)
    z = points[..., 2] - 0.2
    bent = points + np.stack([0.0 * z, 0.3 * z**2, -0.06 * z**3], axis=-1)
    straight, curved = (strip_loads(p, LiftingLineInflow(V, OMEGA)) for p in (points, bent))
    assert curved.total.lift == pytest.approx(straight.total.lift, rel=0.1)
    # elements of half the size hardly alter it
    fine = strip_loads(bent, LiftingLineInflow(V, OMEGA, elements=120))
    assert fine.total.lift == pytest.approx(curved.total.lift, rel=2e-3)


def test_swept_wing_converges_with_weissinger_points() -> None:
    points = rectangle(4.0, n=61)
    points[..., 0] += np.tan(np.radians(30.0)) * points[..., 2]
    coarse, fine = (
        strip_loads(points, LiftingLineInflow(5.0, 0.0, control="weissinger", elements=n)).total
        for n in (40, 80)
    )
    assert coarse.lift == pytest.approx(fine.lift, rel=3e-3)


def test_without_span_effects_it_is_strip_theory() -> None:
    long = rectangle(2000.0)
    line_lift = strip_loads(long, LiftingLineInflow(5.0, 0.0)).total.lift
    assert line_lift == pytest.approx(strip_loads(long, StripInflow(5.0, 0.0)).total.lift, rel=2e-3)


def test_it_is_quick_on_solved_sections() -> None:
    sections = section_frames(fin(naca(n=81)))
    panels = PanelSections(sections.contours)
    again = LiftingLineInflow(V, OMEGA).loads(sections, panels)
    assert integrate(sections, again).lift == pytest.approx(
        strip_loads(fin(naca(n=81)), LiftingLineInflow(V, OMEGA)).total.lift
    )


def test_what_lies_outside_is_noticed() -> None:
    def messages(points: FloatArray, model: LiftingLineInflow) -> str:
        sections = section_frames(points)
        return " ".join(n.message for n in model.notices(sections, model.loads(sections)))

    assert messages(fin(naca(n=61)), LiftingLineInflow(V, OMEGA)) == ""
    assert "aspect ratio" in messages(rectangle(1.5), LiftingLineInflow(5.0, 0.0))
    swept = rectangle(4.0)
    swept[..., 0] += 0.5 * swept[..., 2]
    assert "sweep" in messages(swept, LiftingLineInflow(5.0, 0.0))
    assert "sweep" not in messages(swept, LiftingLineInflow(5.0, 0.0, control="weissinger"))
    assert "wake turns" in messages(fin(naca(n=61)), LiftingLineInflow(V, 10.0))
    assert "between the 5 blades" in messages(
        fin(naca(n=61)), LiftingLineInflow(V, OMEGA, blades=5)
    )


def test_impossible_lines_are_refused() -> None:
    with pytest.raises(GeometryError, match="'wall' is unknown"):
        LiftingLineInflow(V, OMEGA, root="wall")  # type: ignore[arg-type]
    with pytest.raises(GeometryError, match="at least 4"):
        LiftingLineInflow(V, OMEGA, elements=2)
    with pytest.raises(GeometryError, match="at rest"):
        strip_loads(fin(naca(n=61)), LiftingLineInflow(0.0, 0.0))
