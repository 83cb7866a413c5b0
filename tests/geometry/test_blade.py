# SPDX-License-Identifier: LGPL-2.1-or-later
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from quietblade.errors import GeometryError
from quietblade.geometry import Blade, Film, constant, formula, section_family, table

PAPER = Blade(
    hub_radius=0.2,
    span=1.0,
    chord=table([0, 1], [0.25, 0.075]),
    blade_angle=constant(0.0),
    sweep=constant(0.0),
    rake=constant(0.0),
    thickness=constant(0.06),
    camber=constant(0.0),
    family=section_family("naca-4"),
    trailing_edge=0.006,
    alignment=0.5,
    film=Film(span=(0.05, 0.95), chord=(0.15, 0.80), thickness=1.5e-3),
)
TWISTED = replace(
    PAPER,
    blade_angle=formula("0.7*s - 0.2"),
    sweep=formula("0.1*s**2"),
    rake=formula("-0.05*s"),
    camber=constant(0.03),
    thickness=table([0, 1], [0.12, 0.06]),
)


def test_paper_blade_is_valid_and_has_its_size() -> None:
    PAPER.check()
    root, tip = PAPER.section([0.0, 1.0], 161)
    np.testing.assert_allclose([root[80], tip[80]], [[-0.125, 0, 0.2], [-0.0375, 0, 1.2]])
    np.testing.assert_allclose(np.ptp(root[:, 0]), 0.25, rtol=1e-14)
    assert PAPER.planform_area() == pytest.approx(0.1625, rel=1e-14)


def test_volume_of_a_similar_tapered_blade() -> None:
    """Sections are similar, so V = A_1 span (c0^2 + c0 c1 + c1^2) / 3."""
    c0, c1 = 0.25, 0.075
    x = np.linspace(0, 1, 200_001) ** 2
    half = PAPER.family.half_thickness(x, 0.06, 0.006)
    area = np.sum((half[1:] + half[:-1]) * np.diff(x))
    assert PAPER.volume() == pytest.approx(area * (c0**2 + c0 * c1 + c1**2) / 3, rel=2e-6)


def test_frames_are_right_handed_and_a_positive_angle_raises_the_nose() -> None:
    s = np.linspace(0, 1, 11)
    _, t, n = TWISTED.frame(s)
    np.testing.assert_allclose(np.cross(t, n), np.tile([0.0, 0.0, 1.0], (11, 1)), atol=1e-15)
    # the water passes along (V, omega r, 0): incidence = angle of the stream + blade angle
    stream = np.array([5.0, 0.58, 0.0])
    incidence = np.arctan2(n @ stream, t @ stream)
    np.testing.assert_allclose(incidence, np.arctan2(0.58, 5.0) + TWISTED.blade_angle(s))


def test_alignment_point_lies_on_the_reference_line() -> None:
    blade = replace(TWISTED, alignment=0.25, sweep=constant(0.0), rake=constant(0.0))
    points = blade.place(np.linspace(0, 1, 5), np.array([0.25, 0.0]))
    np.testing.assert_allclose(points[:, :2], 0.0, atol=1e-16)


@settings(max_examples=40, deadline=None)
@given(
    s=st.floats(0.0, 1.0), xi=st.floats(-0.1, 1.1), eta=st.floats(-0.2, 0.2), skew=st.floats(-1, 1)
)
def test_locate_inverts_place(s: float, xi: float, eta: float, skew: float) -> None:
    blade = replace(TWISTED, sweep=formula("0.2*s**2", skew), rake=formula("0.3*sin(s)", skew))
    found = np.array(blade.locate(blade.place(s, np.array([xi, eta]))))
    np.testing.assert_allclose(found, [s, xi, eta], atol=2e-15 * 1.2 / 0.075)


def test_film_surfaces_lie_half_a_thickness_from_the_camber_surface() -> None:
    s, xi = np.meshgrid(np.linspace(0.05, 0.95, 7), np.linspace(0.15, 0.8, 9), indexing="ij")
    top, middle, bottom = (TWISTED.film_surface(side, s, xi) for side in (1, 0, -1))
    _, _, n = TWISTED.frame(s)
    np.testing.assert_allclose(top - middle, 0.75e-3 * n, atol=1e-15)
    np.testing.assert_allclose(middle - bottom, 0.75e-3 * n, atol=1e-15)
    _, x, y = TWISTED.locate(middle)
    np.testing.assert_allclose(y, TWISTED.family.camber_line(x, 0.03)[0], atol=1e-14)


def test_cover_reaches_from_the_film_to_the_face() -> None:
    s, xi = np.full(5, 0.5), np.linspace(0.2, 0.8, 5)
    above, below = TWISTED.film_cover(s, xi)
    _, _, n = TWISTED.frame(s)
    fine = TWISTED.section([0.5], 20001)[0]
    for side, cover in ((1, above), (-1, below)):
        _, x, y = TWISTED.locate(TWISTED.film_surface(side, s, xi) + side * cover[:, None] * n)
        _, contour_x, contour_y = TWISTED.locate(fine[:10001][::-1] if side > 0 else fine[10000:])
        np.testing.assert_allclose(y, np.interp(x, contour_x, contour_y), atol=1e-8)


def test_film_that_sticks_out_says_where_how_much_and_what_to_do() -> None:
    blade = replace(PAPER, film=replace(PAPER.film, thickness=3e-3))
    with pytest.raises(GeometryError) as caught:
        blade.check()
    # 3 mm film against twice the half thickness at chord fraction 0.8 of the last section
    half = PAPER.family.half_thickness(0.8, 0.06, 0.006) * PAPER.chord(np.array(0.95))
    text = str(caught.value)
    assert "span fraction 0.95 (radius 1.15 m), chord fraction 0.8" in text
    assert f"by {1e3 * (1.5e-3 - half):.3g} mm" in text
    assert f"a film below {2e3 * half:.3g} mm" in text
    replace(blade, film=replace(PAPER.film, thickness=1.999 * half)).check()


def test_minimum_cover() -> None:
    above, below = PAPER.film_cover(0.95, 0.8)
    least = float(min(above, below))
    PAPER.check(0.999 * least)
    with pytest.raises(GeometryError, match=r"only 0\.507 mm of material remain"):
        PAPER.check(1.001 * least)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"chord": formula("0.2 - 0.3*s")}, r"chord is -100 mm at span fraction 1 \(radius 1.2 m"),
        ({"chord": formula("0.2 - 0.2*s")}, "chord is 0 mm"),
        ({"thickness": constant(-0.1)}, "thickness is -0.1 of the chord"),
        ({"thickness": constant(0.006)}, "above the trailing edge's"),
        ({"trailing_edge": 0.0}, "blunt edge"),
        ({"span": -1.0}, "span -1 m"),
        ({"hub_radius": -0.1}, "hub radius -0.1 m"),
        ({"alignment": 1.5}, "alignment 1.5"),
        ({"film": Film((0.0, 0.95), (0.2, 0.8), 1e-3)}, "span range .* inside"),
        ({"film": Film((0.1, 0.95), (0.2, 1.0), 1e-3)}, "chord range .* inside"),
        ({"film": Film((0.9, 0.1), (0.2, 0.8), 1e-3)}, "span range .* reversed"),
        ({"film": Film((0.1, 0.9), (0.8, 0.2), 1e-3)}, "chord range .* reversed"),
        ({"film": Film((0.1, 0.9), (0.2, 0.8), 0.0)}, "thickness 0 mm"),
    ],
)
def test_impossible_blades(change: dict, message: str) -> None:
    with pytest.raises(GeometryError, match=message):
        replace(PAPER, **change).check()


def test_blade_without_film() -> None:
    blade = replace(PAPER, film=None)
    blade.check()
    with pytest.raises(GeometryError, match="no film"):
        blade.film_surface(0, 0.5, 0.5)
