# SPDX-License-Identifier: LGPL-2.1-or-later
"""Every section family; published ordinates: verification/flow_sections.py."""

import pickle

import numpy as np
import pytest

from quietblade.errors import GeometryError
from quietblade.flow import PanelSections
from quietblade.geometry import naca_designation, section_family
from quietblade.geometry.mean_lines import DesignLoad, FiveDigitLine, TwoParabolas
from quietblade.geometry.naca import FAMILIES
from quietblade.geometry.sections import SectionFamily, section_moments

EVERY = pytest.mark.parametrize("family", FAMILIES.values(), ids=FAMILIES)


@EVERY
def test_edge_nose_and_order(family: SectionFamily) -> None:
    xy = family.contour([0.06, 0.12], [0.0, 0.03], [0.006, 0.002], 161)
    np.testing.assert_allclose(np.linalg.norm(xy[:, 0] - xy[:, -1], axis=-1), [0.006, 0.002])
    np.testing.assert_allclose(0.5 * (xy[:, 0] + xy[:, -1]), [[1.0, 0.0]] * 2, atol=1e-14)
    np.testing.assert_allclose(xy[:, 80], 0.0, atol=1e-14)
    assert np.all(section_moments(xy).area > 0.0)
    assert np.isfinite(xy).all()


@EVERY
def test_largest_thickness_and_camber_are_those_asked_for(family: SectionFamily) -> None:
    x = np.linspace(0.0, 1.0, 4001)
    assert family.half_thickness(1.0, 0.1, 0.0) == pytest.approx(0.0, abs=1e-15)
    # A sharp edge cuts a wedge off the form; NACA 66 has the thickest edge of its own.
    assert 2.0 * family.half_thickness(x, 0.1, 0.0).max() == pytest.approx(0.1, rel=0.035)
    assert family.camber_line(x, 0.03)[0].max() == pytest.approx(0.03, rel=1e-5)


@EVERY
def test_slope_is_the_derivative_of_the_camber_line(family: SectionFamily) -> None:
    x, h = np.linspace(0.1, 0.9, 41) + 1e-4, 1e-6
    rise = family.camber_line(x + h, 0.03)[0] - family.camber_line(x - h, 0.03)[0]
    np.testing.assert_allclose(family.camber_line(x, 0.03)[1], rise / (2.0 * h), atol=3e-4)


@EVERY
def test_the_panel_method_takes_it(family: SectionFamily) -> None:
    contours = family.contour([0.04, 0.09, 0.18], [0.0, 0.02, 0.04], 0.002, 161)
    solution = PanelSections(contours).solve(np.radians(2.0))
    assert np.all(np.diff(solution.lift) > 0.0)
    assert np.abs(solution.drag).max() < 5e-3


@EVERY
def test_a_family_can_be_sent_to_another_process(family: SectionFamily) -> None:
    again = pickle.loads(pickle.dumps(family))
    np.testing.assert_array_equal(
        again.contour(0.1, 0.02, 0.01, 41), family.contour(0.1, 0.02, 0.01, 41)
    )


def test_pressure_of_naca_66_does_not_ripple_between_the_points_of_its_table() -> None:
    contour = section_family("naca-66-a08").contour(0.08, 0.0, 0.0, 321)
    x, cp = contour[:160, 0], PanelSections(contour[None]).solve(0.0).cp[0, :160]
    assert np.all(np.diff(cp[x > 0.46]) < 0.0)  # from the trailing edge to the largest thickness
    assert np.all(np.diff(cp[(x < 0.44) & (x > 0.01)]) > 0.0)


def test_a_mean_line_of_constant_load_carries_it() -> None:
    camber = DesignLoad(1.0).camber_at_unit_lift * 0.1
    contour = section_family("naca-16-a10").contour(0.03, camber, 0.0, 321)
    cp = PanelSections(contour[None]).solve(0.0).cp[0]
    upper, lower = cp[40:120], cp[-41:-121:-1]
    np.testing.assert_allclose(lower - upper, 0.1, rtol=0.08)


def test_designations() -> None:
    family, thickness, camber = naca_designation("2412")
    assert (family.name, thickness, camber) == ("naca-4", 0.12, 0.02)
    family, thickness, camber = naca_designation("0006")
    assert (family.name, thickness, camber) == ("naca-4", 0.06, 0.0)
    assert naca_designation("6309")[0].name == "naca-4-p30"
    family, thickness, camber = naca_designation("23012")
    assert (family.name, thickness) == ("naca-5-230", 0.12)
    assert camber == pytest.approx(0.0184, abs=5e-5)
    assert naca_designation("43012")[2] == pytest.approx(2.0 * camber)
    assert naca_designation("23112")[0].name == "naca-5-231"


@pytest.mark.parametrize("digits", ["0000", "2012", "0412", "26012", "21112", "23212", "abc", "12"])
def test_wrong_designations(digits: str) -> None:
    with pytest.raises(GeometryError):
        naca_designation(digits)


def test_wrong_mean_lines() -> None:
    with pytest.raises(GeometryError, match=r"a = 1\.2"):
        DesignLoad(1.2)
    with pytest.raises(GeometryError, match="between 0 and 1"):
        TwoParabolas(0.0)
    with pytest.raises(GeometryError, match="211"):
        FiveDigitLine(1, reflexed=True)


def test_lines_for_every_a_meet_the_chord() -> None:
    for a in (0.0, 0.3, 0.7, 0.8, 0.95, 1.0):
        height, slope = DesignLoad(a).unit(np.array([0.0, 1.0]))
        np.testing.assert_allclose(height, 0.0, atol=1e-12)
        assert np.isfinite(slope).all()
