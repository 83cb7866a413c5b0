# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sections follow the material and are seen along the deformed span."""

import numpy as np
import pytest

from quietblade.errors import GeometryError
from quietblade.flow import PanelSections, section_frames
from quietblade.geometry import NacaFourDigit
from quietblade.typing import FloatArray
from tests.conftest import make_paper_blade, make_twisted_blade
from tests.flow.shapes import fin, naca, rotation, turn

STATIONS = np.linspace(0.0, 1.0, 21)


def test_undeformed_blade_is_seen_as_it_is_drawn() -> None:
    blade = make_paper_blade()
    sections = section_frames(blade.section(STATIONS, 161))
    np.testing.assert_allclose(sections.chord, blade.chord(STATIONS), rtol=1e-12)
    np.testing.assert_allclose(sections.arc_length, STATIONS * blade.span, atol=1e-12)
    np.testing.assert_allclose(sections.tangent, [[0.0, 0.0, 1.0]] * 21, atol=1e-12)
    np.testing.assert_allclose(sections.chord_direction, [[1.0, 0.0, 0.0]] * 21, atol=1e-12)
    np.testing.assert_allclose(sections.normal, [[0.0, 1.0, 0.0]] * 21, atol=1e-12)
    unit = blade.family.contour(0.06, 0.0, blade.trailing_edge, 161)
    np.testing.assert_allclose(sections.contours, [unit] * 21, atol=1e-12)
    for zero in (sections.blade_angle, sections.camber, sections.tilt, sections.warp):
        np.testing.assert_allclose(zero, 0.0, atol=1e-12)


def test_twist_is_the_blade_angle_and_camber_is_kept() -> None:
    s = np.linspace(0.0, 1.0, 41)
    twist = 0.3 - 0.5 * s
    points = fin(naca(0.06, 0.02), 41)
    points[..., :2] = np.array([turn(p, -a) for p, a in zip(points[..., :2], twist, strict=True)])
    sections = section_frames(points)
    np.testing.assert_allclose(sections.blade_angle, twist, atol=1e-12)
    np.testing.assert_allclose(sections.camber, 0.02, rtol=1e-3)
    np.testing.assert_allclose(sections.thickness(), 0.06, rtol=0.01)


@pytest.mark.parametrize("seed", range(4))
def test_rigid_motion_changes_nothing_but_the_frames(seed: int) -> None:
    points = make_twisted_blade().section(STATIONS, 81)
    turned, moved = rotation(seed), np.array([0.3, -0.2, 1.0])
    before, after = section_frames(points), section_frames(points @ turned.T + moved)
    for name in ("chord", "arc_length", "contours", "camber", "tilt", "warp"):
        np.testing.assert_allclose(getattr(after, name), getattr(before, name), atol=1e-11)
    for name in ("tangent", "chord_direction", "normal"):
        np.testing.assert_allclose(
            getattr(after, name), getattr(before, name) @ turned.T, atol=1e-11
        )
    np.testing.assert_allclose(after.reference, before.reference @ turned.T + moved, atol=1e-11)


def oblique_cylinder(tilt: float, sections: int = 9) -> tuple[FloatArray, FloatArray]:
    """The same cylinder cut normal to its generators, and cut at z = const."""
    contour, chord = naca(0.08, 0.02, 0.002), 0.2
    generator = np.array([np.sin(tilt), 0.0, np.cos(tilt)])
    chordwise = np.array([np.cos(tilt), 0.0, -np.sin(tilt)])
    along = np.linspace(0.3, 1.3, sections)[:, None, None] * generator
    x = chord * (contour[:, 0] - 0.5)
    normal = along + x[:, None] * chordwise + chord * contour[:, 1, None] * [0.0, 1.0, 0.0]
    return normal, normal + (x * np.tan(tilt))[:, None] * generator


@pytest.mark.parametrize("tilt", [0.2, -0.5])
def test_oblique_cuts_of_a_cylinder_are_the_same_sections(tilt: float) -> None:
    square, oblique = (section_frames(points) for points in oblique_cylinder(tilt))
    for name in ("reference", "tangent", "chord", "contours", "normal", "blade_angle", "camber"):
        np.testing.assert_allclose(getattr(oblique, name), getattr(square, name), atol=1e-12)
    # The material chord is longer by 1 / cos(tilt) and leaves the plane towards the tip.
    np.testing.assert_allclose(square.tilt, 0.0, atol=1e-12)
    np.testing.assert_allclose(oblique.tilt, tilt, atol=1e-12)
    np.testing.assert_allclose(oblique.warp, 0.0, atol=1e-12)


def test_warp_is_what_tilt_does_not_explain() -> None:
    points = fin(naca(n=81))
    chordwise = naca(n=81)[:, 0]
    chord = (0.25 - 0.175 * STATIONS)[:, None]
    points[..., 2] += chord * (0.1 * chordwise + 0.03 * np.sin(np.pi * chordwise))
    sections = section_frames(points)
    # The mid-chord points move along their own line, so that the tangents stay.
    np.testing.assert_allclose(sections.tangent, [[0.0, 0.0, 1.0]] * 21, atol=1e-12)
    np.testing.assert_allclose(sections.tilt, np.arctan(0.1), atol=1e-12)
    np.testing.assert_allclose(sections.warp, 0.03, rtol=1e-6)


def test_blade_bent_to_an_arc() -> None:
    """Sections stay normal to the span: only their frames turn."""
    points, radius = fin(naca(0.06, 0.02), 41), 0.8
    angle = (points[..., 2] - 0.2) / radius
    bent = np.stack(
        [
            points[..., 0],
            radius - (radius - points[..., 1]) * np.cos(angle),
            0.2 + (radius - points[..., 1]) * np.sin(angle),
        ],
        axis=-1,
    )
    straight, sections = section_frames(points), section_frames(bent)
    turned = angle[:, 0]
    exact = np.stack([0.0 * turned, np.sin(turned), np.cos(turned)], axis=-1)
    # A spline through 41 points of an arc of 1.25 rad
    np.testing.assert_allclose(sections.tangent, exact, atol=1e-5)
    np.testing.assert_allclose(sections.arc_length, straight.arc_length, atol=1e-6)
    np.testing.assert_allclose(sections.contours, straight.contours, atol=1e-6)
    np.testing.assert_allclose(sections.blade_angle, 0.0, atol=1e-9)
    np.testing.assert_allclose(sections.warp, 0.0, atol=1e-5)


def test_bending_to_a_mean_line_gives_the_section_of_that_mean_line() -> None:
    family, symmetric = NacaFourDigit(), naca(0.06, 0.0, 0.002)
    height, slope = family.camber_line(symmetric[:, 0], 0.03)
    scale = np.hypot(1.0, slope)
    bent = np.stack(
        [symmetric[:, 0] - symmetric[:, 1] * slope / scale, height + symmetric[:, 1] / scale],
        axis=-1,
    )
    sections = section_frames(fin(bent))
    np.testing.assert_allclose(sections.camber, 0.03, rtol=1e-3)
    lift = PanelSections(sections.contours).solve(0.05).lift
    drawn = PanelSections(naca(0.06, 0.03, 0.002)[None]).solve(0.05).lift
    np.testing.assert_allclose(lift, drawn.item(), rtol=1e-9)


def test_bending_to_an_arc_lifts_like_an_arc() -> None:
    """A thin plate bent over its chord: C_L = 4 pi f at no incidence (Joukowski's arc)."""
    contour, curvature = naca(0.02, n=321), 0.3
    angle = curvature * (contour[:, 0] - 0.5)
    # The convex side is the upper one.
    radius = 1.0 / curvature + contour[:, 1]
    height = radius * np.cos(angle) - 1.0 / curvature
    bent = np.stack([0.5 + radius * np.sin(angle), height], axis=-1)
    sections = section_frames(fin(bent, 3))
    sagitta = np.tan(0.25 * curvature) / 2.0
    np.testing.assert_allclose(sections.camber, sagitta, rtol=1e-3)
    np.testing.assert_allclose(sections.blade_angle, 0.0, atol=1e-3)
    np.testing.assert_allclose(
        sections.chord[0], 0.25 * 2.0 / curvature * np.sin(curvature / 2.0), rtol=1e-3
    )
    lift = PanelSections(sections.contours).solve(0.0).lift
    # The thickness of 2 % adds about 1.6 %.
    np.testing.assert_allclose(lift / (4.0 * np.pi * sagitta), 1.016, atol=0.006)


def test_two_sections_are_enough_and_one_is_not() -> None:
    assert section_frames(fin(naca(), 2)).arc_length[-1] == pytest.approx(1.0)
    with pytest.raises(GeometryError, match="at least 2 sections"):
        section_frames(fin(naca(), 21)[:1])


def test_refusals_name_the_section() -> None:
    points = fin(naca())
    with pytest.raises(GeometryError, match=r"160 nodes.*odd"):
        section_frames(points[:, 1:])
    lost = points.copy()
    lost[3, 5, 1] = np.nan
    with pytest.raises(GeometryError, match=r"section 3 of 21.*not finite"):
        section_frames(lost)
    double = points.copy()
    double[5] = double[4]
    with pytest.raises(GeometryError, match="sections 4 and 5"):
        section_frames(double)
    along = points.copy()
    along[7] = [0.0, 0.0, points[7, 0, 2]] + along[7][:, [2, 1, 0]] * [0.0, 1.0, 1.0]
    along[7][:, 2] -= along[7][:, 2].mean() - points[7, 0, 2]
    with pytest.raises(GeometryError, match="section 7 of 21"):
        section_frames(along)


def test_sections_from_the_tip_to_the_root_are_refused_when_solved() -> None:
    with pytest.raises(GeometryError, match="clockwise"):
        PanelSections(section_frames(fin(naca())[::-1]).contours)


def test_mean_line_and_thickness_are_those_of_the_family() -> None:
    contour = naca(0.12, 0.04, 0.002)
    sections = section_frames(fin(contour, 5))
    x, y = sections.mean_line()[2].T
    height, _ = NacaFourDigit().camber_line(x, 0.04)
    np.testing.assert_allclose(y, height, atol=1e-12)
    half = NacaFourDigit().half_thickness(x, 0.12, 0.002)
    np.testing.assert_allclose(sections.thickness_distribution()[2], 2.0 * half, atol=1e-12)
    assert sections.thickness()[2] == pytest.approx(sections.thickness_distribution()[2].max())
    np.testing.assert_allclose([x[0], y[0], x[-1], y[-1]], [0.0, 0.0, 1.0, 0.0], atol=1e-12)
