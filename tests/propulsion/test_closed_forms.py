# SPDX-License-Identifier: LGPL-2.1-or-later
"""The references of the structural checks against published or independent figures."""

import numpy as np
import pytest

from verification.structure_beam_theory import (
    axially_loaded_cantilever,
    elastica,
    follower_elastica,
    rolled,
    rotating_cantilever,
    simply_supported_beam,
    southwell,
)
from verification.structure_elastica import cantilever_path
from verification.structure_models import Beam
from verification.structure_solid_theory import (
    ThickTube,
    laminate_beam,
    ply_compliance,
    rectangle_torsion,
    uniaxial_stress,
)


# K. Mattiasson, Int. J. Numer. Methods Eng. 17 (1981) 145-153
@pytest.mark.parametrize(
    ("k", "u", "w"),
    [(0.2, 0.00265, 0.06636), (1.0, 0.05643, 0.30172), (4.0, 0.32894, 0.66996),
     (10.0, 0.55500, 0.81061)],
)  # fmt: skip
def test_elastica_table(k: float, u: float, w: float) -> None:
    tip = elastica(k)
    assert (tip.u, tip.w) == pytest.approx((u, w), abs=1e-5)


def test_small_loads_bend_linearly() -> None:
    for bend, factor in ((elastica, 1 / 3), (follower_elastica, 1 / 3)):
        assert bend(1e-4).w == pytest.approx(factor * 1e-4, rel=1e-5)
        assert bend(line=1e-4).w == pytest.approx(1e-4 / 8, rel=1e-5)
        assert bend(1e-4).angle == pytest.approx(0.5e-4, rel=1e-5)
    assert rolled(1e-4).w == pytest.approx(0.5e-4, rel=1e-6)


@pytest.mark.parametrize("bend", [elastica, follower_elastica])
def test_no_load_bends_nothing(bend: object) -> None:
    tip = bend()  # type: ignore[operator]
    assert (tip.u, tip.w, tip.angle) == pytest.approx((0.0, 0.0, 0.0), abs=1e-12)


def test_a_whole_turn_ends_where_it_begins() -> None:
    tip = rolled(2 * np.pi)
    assert (tip.u, tip.w) == pytest.approx((1.0, 0.0), abs=1e-12)
    assert rolled(0.0).u == 0.0


# A. D. Wright, C. E. Smith, R. W. Thresher and J. L. C. Wang, J. Appl. Mech. 49 (1982), table 1
@pytest.mark.parametrize(
    ("speed", "flap"),
    [(0, (3.5160, 22.0345, 61.6972)), (3, (4.7973, 23.3203, 62.9850)),
     (12, (13.1702, 37.6031, 79.6145))],
)  # fmt: skip
def test_rotating_cantilever_table(speed: float, flap: tuple[float, ...]) -> None:
    assert rotating_cantilever(speed)[0] == pytest.approx(flap, abs=6e-5)


def test_southwells_coefficient_is_the_slope_at_rest() -> None:
    rest, slow = rotating_cantilever(0.0)[0], rotating_cantilever(0.02)[0]
    assert (slow**2 - rest**2) / 4e-4 == pytest.approx(southwell(), rel=1e-3)
    assert (southwell(hub_ratio=1.0) > southwell()).all()


def test_lead_lag_of_a_fast_beam_is_not_real() -> None:
    edge = rotating_cantilever(3.0)[1]
    assert edge**2 == pytest.approx(rotating_cantilever(3.0)[0] ** 2 - 9.0)


def test_columns_buckle_where_euler_says() -> None:
    assert axially_loaded_cantilever(-(np.pi**2) / 4)[0] == pytest.approx(0.0, abs=1e-6)
    assert axially_loaded_cantilever(-3.0)[0] < 0.0
    assert simply_supported_beam(-(np.pi**2))[0] == pytest.approx(0.0, abs=1e-9)
    assert simply_supported_beam(0.0) == pytest.approx(np.array([1, 4, 9]) ** 2 * np.pi**4)


def test_thick_tube() -> None:
    tube = ThickTube(7.0, 18.625, 80.0, 20.0, 150.0)
    assert tube.displacement(7.0) == pytest.approx(7.18187, abs=1e-5)
    assert tube.radial_stress(8.16) == pytest.approx(-121.634, abs=1e-3)
    assert tube.radial_stress(7.0) == pytest.approx(-150.0)
    assert tube.radial_stress(18.625) == 0.0
    small = ThickTube(7.0, 18.625, 80.0, 20.0, 0.1)
    shear = 2 * (80.0 + 20.0)
    lame = 0.1 * 7.0**2 * 18.625**2 / (18.625**2 - 49.0) / (2 * shear) / 7.0
    assert small.displacement(7.0) == pytest.approx(lame, rel=1e-3)
    with pytest.raises(ValueError, match="cannot carry"):
        ThickTube(7.0, 18.625, 80.0, 20.0, 1e4).displacement(7.0)


def test_uniaxial_stress_has_youngs_modulus_at_first() -> None:
    assert uniaxial_stress(1.0001, 1.0, 2.0) == pytest.approx(18.0 * 1e-4, rel=1e-3)


def test_a_strip_compliance_is_that_of_its_plies() -> None:
    ply = {"e1": 117.8e9, "e2": 13.4e9, "g12": 3.9e9, "nu12": 0.25}
    stiffness = laminate_beam(0.1, 0.012, 0.5, **ply)
    S = ply_compliance(0.5, **ply)
    inertia = 0.1 * 0.012**3 / 12
    bend, twist = stiffness.compliance()[0, 0], stiffness.compliance()[1, 1]
    assert bend == pytest.approx(S[0, 0] / inertia)
    assert twist == pytest.approx(S[2, 2] / (4 * inertia))


def test_torsion_of_rectangles() -> None:
    # I. S. Sokolnikoff, Mathematical Theory of Elasticity: square 0.1406, 2:1 0.2287
    assert rectangle_torsion(1.0, 1.0, 1.0, 1.0) == pytest.approx(0.14058, abs=1e-5)
    assert rectangle_torsion(2.0, 1.0, 1.0, 1.0) == pytest.approx(2 * 0.22868, abs=2e-5)
    one, other = rectangle_torsion(0.1, 0.02, 3e9, 5e9), rectangle_torsion(0.02, 0.1, 5e9, 3e9)
    assert one == pytest.approx(other, rel=1e-5)
    assert rectangle_torsion(100.0, 0.01, 2.0, 3.0) == pytest.approx(2 * 100 * 1e-6 / 3, rel=1e-3)


@pytest.mark.parametrize("load", ["dead line", "follower force", "end moment"])
def test_any_load_of_a_short_path(load: str) -> None:
    theory = {
        "dead line": elastica(line=1.0), "follower force": follower_elastica(1.0),
        "end moment": rolled(1.0),
    }[load]  # fmt: skip
    (tip,) = cantilever_path(load, [1.0], Beam(cells=20))
    assert tip.w == pytest.approx(theory.w, rel=2e-3)
    assert tip.u == pytest.approx(theory.u, rel=5e-3)
    assert tip.angle == pytest.approx(theory.angle, rel=5e-3)


def test_unknown_loads_are_refused() -> None:
    with pytest.raises(ValueError, match="none of dead force"):
        cantilever_path("live load", [1.0])
