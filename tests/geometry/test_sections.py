# SPDX-License-Identifier: LGPL-2.1-or-later
import numpy as np
import pytest

from quietblade.errors import GeometryError
from quietblade.geometry import NacaFourDigit, section_family
from quietblade.geometry.sections import section_moments

NACA = NacaFourDigit()


def test_edge_thickness_is_exact_and_nose_is_the_middle_node() -> None:
    for camber in (0.0, 0.02):
        xy = NACA.contour(0.09, camber, 0.006, 161)
        np.testing.assert_allclose(np.hypot(*(xy[0] - xy[-1])), 0.006, rtol=1e-14)
        np.testing.assert_allclose(xy[[0, -1]].mean(axis=0), [1.0, 0.0], atol=1e-15)
        np.testing.assert_allclose(xy[80], 0.0, atol=1e-15)
        assert xy[40, 1] > 0 > xy[120, 1]
        assert section_moments(xy).area > 0  # counter-clockwise


def test_thickness_is_perpendicular_to_the_camber_line() -> None:
    phi = np.linspace(0.05, 1.0, 20)
    upper, lower = NACA.point(-phi, 0.12, 0.04, 0.006), NACA.point(phi, 0.12, 0.04, 0.006)
    foot = np.sin(0.5 * np.pi * phi) ** 2
    height, slope = NACA.camber_line(foot, 0.04)
    np.testing.assert_allclose(0.5 * (upper + lower), np.stack([foot, height], -1), atol=1e-15)
    np.testing.assert_allclose(
        (upper - lower) @ [1.0, 0.0] + slope * ((upper - lower) @ [0.0, 1.0]), 0.0, atol=1e-15
    )


def test_camber_line_slope_is_its_derivative() -> None:
    x, h = np.linspace(0.01, 0.99, 37), 1e-6
    difference = (NACA.camber_line(x + h, 0.03)[0] - NACA.camber_line(x - h, 0.03)[0]) / (2 * h)
    np.testing.assert_allclose(NACA.camber_line(x, 0.03)[1], difference, atol=1e-9)
    assert NACA.camber_line(0.4, 0.03)[0] == pytest.approx(0.03)


@pytest.mark.parametrize("side", [1, -1])
def test_parameter_above_a_chord_fraction(side: int) -> None:
    x = np.linspace(0.0, 1.0, 41)[1:-1]
    phi = NACA.parameter_at(side, x, 0.1, 0.05, 0.006)
    assert np.all(np.sign(phi) == -side)
    np.testing.assert_allclose(NACA.point(phi, 0.1, 0.05, 0.006)[:, 0], x, atol=1e-14)


def test_contours_of_a_batch() -> None:
    thickness, camber = np.array([0.06, 0.09, 0.12]), np.array([0.0, 0.01, 0.03])
    batch = NACA.contour(thickness, camber, 0.006, 41)
    assert batch.shape == (3, 41, 2)
    for one, t, m in zip(batch, thickness, camber, strict=True):
        np.testing.assert_array_equal(one, NACA.contour(t, m, 0.006, 41))


def test_moments_of_a_rotated_rectangle() -> None:
    a, b, angle = 0.3, 0.1, 0.4
    corners = 0.5 * np.array([[-a, -b], [a, -b], [a, b], [-a, b]])
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    m = section_moments(corners @ turn.T + [2.0, -1.0])
    i_a, i_b = a * b**3 / 12, b * a**3 / 12
    tensor = turn @ np.diag([i_b, i_a]) @ turn.T
    np.testing.assert_allclose([m.area, m.x, m.y], [a * b, 2.0, -1.0], rtol=1e-13)
    np.testing.assert_allclose(
        [m.iyy, m.ixx, m.ixy], [tensor[0, 0], tensor[1, 1], tensor[0, 1]], rtol=1e-10
    )


def test_errors() -> None:
    with pytest.raises(GeometryError, match="160 nodes"):
        NACA.contour(0.06, 0.0, 0.006, 160)
    with pytest.raises(GeometryError, match=r"'naca-5' does not exist.*naca-4"):
        section_family("naca-5")
