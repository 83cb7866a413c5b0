# SPDX-License-Identifier: LGPL-2.1-or-later
"""Laws of plane potential flow. Reference figures: verification/flow_exact.py, flow_xfoil.py."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from quietblade.errors import GeometryError
from quietblade.flow import PanelSections
from quietblade.flow.influence import view_panels, vortex_gradients
from quietblade.flow.panel import CHUNK
from tests.flow.shapes import naca, turn

ALPHA = np.radians(5.0)
EDGES = [0.0, 0.00126, 0.006]


@settings(max_examples=12, deadline=None)
@given(st.floats(-3.0, 3.0), st.sampled_from(EDGES))
def test_pressure_does_not_depend_on_the_axes(angle: float, edge: float) -> None:
    contour = naca(0.12, 0.02, edge, 81)
    straight = PanelSections(contour[None]).solve(ALPHA)
    turned = PanelSections(turn(contour, angle)[None]).solve(ALPHA + angle)
    np.testing.assert_allclose(turned.cp, straight.cp, atol=1e-9)
    assert turned.lift == pytest.approx(straight.lift, abs=1e-9)


@settings(max_examples=12, deadline=None)
@given(st.floats(0.01, 100.0), st.floats(-3.0, 3.0), st.sampled_from(EDGES))
def test_pressure_does_not_depend_on_scale_and_place(
    scale: float, shift: float, edge: float
) -> None:
    contour = naca(0.12, 0.02, edge, 81)
    unit = PanelSections(contour[None]).solve(ALPHA)
    other = PanelSections(scale * (contour[None] + shift)).solve(ALPHA)
    np.testing.assert_allclose(other.cp, unit.cp, atol=1e-8)
    assert other.lift == pytest.approx(scale * unit.lift, rel=1e-8)
    assert other.circulation == pytest.approx(scale * unit.circulation, rel=1e-8)


@pytest.mark.parametrize("shape", [(0.06, 0.0), (0.12, 0.0), (0.12, 0.02), (0.15, 0.04)])
@pytest.mark.parametrize("edge", [0.0, 0.00126])
def test_drag_vanishes(shape: tuple[float, float], edge: float) -> None:
    alpha = np.radians([[0.0], [4.0], [8.0]])
    solution = PanelSections(naca(*shape, edge)[None]).solve(alpha)
    assert np.abs(solution.drag).max() < 2e-3


def test_drag_of_a_sharp_section_falls_with_the_square_of_the_panels() -> None:
    drag = [PanelSections(naca(n=n)[None]).solve(ALPHA).drag.item() for n in (161, 321)]
    assert drag[0] / drag[1] == pytest.approx(4.0, abs=0.2)


@pytest.mark.parametrize("edge", EDGES)
def test_lift_is_twice_the_circulation(edge: float) -> None:
    solution = PanelSections(naca(0.12, 0.02, edge)[None]).solve(ALPHA)
    # The source of a thick base blows through the pressure integral.
    assert 2.0 * solution.circulation == pytest.approx(solution.lift, abs=1e-3 + 0.1 * edge)


def test_the_water_inside_is_at_rest() -> None:
    contour = naca(0.12, 0.02)
    gamma = PanelSections(contour[None]).solve(ALPHA).gamma[0]
    inside = np.array([[0.1, 0.01], [0.4, 0.03], [0.7, 0.0]])
    plain, weighted = vortex_gradients(view_panels(inside, contour))
    local = (plain - weighted) * gamma[:-1] + weighted * gamma[1:]
    side = np.diff(contour, axis=0)
    tangent = side / np.linalg.norm(side, axis=1, keepdims=True)
    normal = np.stack([-tangent[:, 1], tangent[:, 0]], axis=1)
    gradient = (local[0] @ tangent + local[1] @ normal) / (2.0 * np.pi)
    stream = np.array([-np.sin(ALPHA), np.cos(ALPHA)])
    # Only the stream function at the nodes is held: between them it leaks with the panel length.
    np.testing.assert_allclose(gradient + stream, 0.0, atol=2e-3)


def test_turning_a_symmetric_section_over_changes_the_sign_of_lift() -> None:
    solution = PanelSections(naca()[None]).solve(np.array([[ALPHA], [-ALPHA], [0.0]]))
    np.testing.assert_allclose(solution.cp[0, 0], solution.cp[1, 0, ::-1], atol=1e-10)
    assert solution.lift[0] == pytest.approx(-solution.lift[1], abs=1e-10)
    assert solution.lift[2] == pytest.approx(0.0, abs=1e-10)


def test_thickness_raises_the_lift_slope() -> None:
    lift = PanelSections(naca()[None]).solve(np.radians(1.0)).lift.item()
    assert lift / (2.0 * np.pi * np.radians(1.0)) == pytest.approx(1.05, abs=0.003)


def test_a_chunk_does_not_know_its_neighbours() -> None:
    rng = np.random.default_rng(1)
    shapes = rng.uniform([0.06, 0.0, 0.0], [0.14, 0.04, 0.004], size=(2 * CHUNK + 3, 3))
    shapes[::5, 2] = 0.0
    contours = np.array([naca(*shape, n=81) for shape in shapes])
    alpha = rng.uniform(-0.1, 0.1, len(contours))
    together = PanelSections(contours).solve(alpha)
    for k, contour in enumerate(contours):
        alone = PanelSections(contour[None]).solve(alpha[k])
        np.testing.assert_allclose(together.cp[k], alone.cp[0], atol=1e-11)
        assert together.moment[k] == pytest.approx(alone.moment[0], abs=1e-11)


def test_sharp_and_nearly_sharp_edges_agree() -> None:
    lift = [
        PanelSections(naca(edge=edge)[None]).solve(ALPHA).lift.item()
        for edge in (0.0, 0.9e-4, 1.1e-4)
    ]
    np.testing.assert_allclose(lift, lift[0], rtol=3e-4)


def test_moment_of_a_thin_section_vanishes_about_the_quarter_chord() -> None:
    moment = PanelSections(naca(0.02, n=321)[None]).solve(ALPHA).moment.item()
    assert abs(moment) < 1e-3


def test_camber_makes_a_moment_nose_down() -> None:
    # Thin-section theory of the NACA 24xx mean line: C_M = -0.0531
    solution = PanelSections(naca(0.02, 0.02, n=321)[None]).solve(0.0)
    assert solution.moment.item() == pytest.approx(-0.0531, abs=1e-3)


def test_many_incidences_from_one_factorisation() -> None:
    sections = PanelSections(np.array([naca(0.12), naca(0.12, 0.02)]))
    alpha = np.radians([-2.0, 0.0, 3.0])
    together = sections.solve(alpha[:, None])
    assert together.cp.shape == (3, 2, 161)
    for k, angle in enumerate(alpha):
        np.testing.assert_array_equal(together.lift[k], sections.solve(angle).lift)


def test_the_stagnation_point_moves_to_the_lower_side_with_incidence() -> None:
    sections = PanelSections(naca(0.12)[None])
    solution = sections.solve(np.radians([[-4.0], [0.0], [4.0]]))
    places = sections.stagnation_points(solution)[:, 0]
    np.testing.assert_allclose(places[1], 0.0, atol=1e-12)
    np.testing.assert_allclose(places[0], places[2] * [1.0, -1.0], atol=1e-12)
    assert places[2, 1] < 0.0 < places[2, 0]
    before = int(solution.stagnation[2, 0])
    assert solution.cp[2, 0, before : before + 2].max() > 0.95


def test_no_stagnation_point_at_the_nose_is_nan() -> None:
    sections = PanelSections(naca(0.12)[None])
    solution = sections.solve(np.radians(180.0))
    assert (
        np.isnan(solution.stagnation).all() == np.isnan(sections.stagnation_points(solution)).all()
    )


def test_sections_of_no_thickness_are_refused() -> None:
    flat = naca() * [1.0, 0.0]
    with pytest.raises(GeometryError, match="no thickness"):
        PanelSections(flat[None])
