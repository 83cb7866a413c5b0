# SPDX-License-Identifier: LGPL-2.1-or-later
import ngsolve as ngs
import numpy as np
import pytest

from quietblade.materials import IsotropicSVK, ply_axes, section_directions
from quietblade.materials.draping import homogenised
from quietblade.materials.laminate import Laminate, Ply
from quietblade.materials.strength import PlyStrength
from quietblade.propulsion.failure import (
    failure_indices,
    margin_to_yield,
    maximum_strain,
    strain_limits,
    tsai_hill,
)
from quietblade.propulsion.plies import Plies, ply_failure, ply_state
from quietblade.propulsion.stress import RegionStress, compute_stress
from verification.structure_stress import GLASS, cube, deformed, pulled

STRENGTH = PlyStrength(1000.0, 600.0, 40.0, 150.0, 70.0)


def stress(s11=0.0, s22=0.0, s12=0.0):
    return np.array([[s11, s12, 0.0], [s12, s22, 0.0], [0.0, 0.0, 99.0]])


@pytest.mark.parametrize(
    ("state", "index"),
    [
        (stress(s11=500.0), 0.5),
        (stress(s11=-600.0), 1.0),
        (stress(s22=20.0), 0.5),
        (stress(s22=-150.0), 1.0),
        (stress(s12=-35.0), 0.5),
        (stress(), 0.0),
        (stress(s22=20.0, s12=35.0), np.sqrt(0.5)),
    ],
)
def test_tsai_hill_of_single_stresses(state, index) -> None:
    assert tsai_hill(state, STRENGTH) == pytest.approx(index)
    assert tsai_hill(3 * state, STRENGTH) == pytest.approx(3 * index)


def test_maximum_strain_takes_the_worst_component_and_its_sign() -> None:
    limits = PlyStrength(0.01, 0.006, 0.004, 0.015, 0.02)
    strains = np.array([stress(0.005, -0.003), stress(-0.003, 0.004), stress(0.0, 0.0, -0.015)])
    assert maximum_strain(strains, limits) == pytest.approx([0.5, 1.0, 1.5])


def test_strain_limits_are_strengths_over_moduli() -> None:
    limits = strain_limits(GLASS)
    assert limits.xt == pytest.approx(1035e6 / 54e9)
    assert limits.s12 == pytest.approx(41e6 / 9e9)
    bare = type(GLASS)(
        "bare", 2000.0, e1=54e9, e2=18e9, e3=18e9, g12=9e9, g23=6e9, g13=9e9,
        nu12=0.25, nu23=0.4, nu13=0.25,
    )  # fmt: skip
    with pytest.raises(ValueError, match="'bare' has no strengths"):
        strain_limits(bare)


def test_yield_of_a_metal_and_its_margin() -> None:
    bronze = IsotropicSVK("bronze", 7600.0, 120e9, 0.33, yield_strength=250e6)
    region = pulled(bronze, 100e6)
    assert region.failure_at_nodes["yield"] == pytest.approx(0.4, rel=1e-6)
    assert region.peaks["yield"].value == pytest.approx(0.4, rel=1e-6)
    assert margin_to_yield(np.array([100e6, 0.0]), 250e6) == pytest.approx([1.5, np.inf])
    plain = IsotropicSVK("plain", 7600.0, 120e9, 0.33)
    assert failure_indices(plain, region.at_nodes) == {}


LAMINATE = Laminate(
    "quasi", tuple(Ply(GLASS, angle, fraction=0.25) for angle in np.radians([0, 45, -45, 90]))
)
STRETCH = np.diag([1.0005, 0.9990, 1.002])


def laminated(plies: Plies) -> RegionStress:
    structure = cube(homogenised(LAMINATE, ply_axes(0.0, *section_directions())))
    state = deformed(structure, STRETCH)
    return compute_stress(structure, state, plies={"blade": plies}).regions["blade"]


def test_plies_share_their_strain_and_average_to_the_laminates_stress() -> None:
    fields = laminated(Plies(LAMINATE)).at_points
    strain, stress = fields.material_strain, fields.material_stress
    total = np.zeros_like(stress)
    for ply in LAMINATE.plies:
        own_strain, own_stress = ply_state(ply, strain, stress)
        c, s = np.cos(ply.angle), np.sin(ply.angle)
        turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        back = turn @ own_strain @ turn.T
        assert back[:, :2, :2] == pytest.approx(strain[:, :2, :2], abs=1e-12)
        total += 0.25 * turn @ own_stress @ turn.T
    assert total == pytest.approx(stress, rel=1e-9, abs=1.0)


def test_worst_ply_is_reported_and_every_ply_by_its_number() -> None:
    indices = laminated(Plies(LAMINATE)).failure_at_nodes
    single = [indices[f"tsai_hill, ply {number}"] for number in (1, 2, 3, 4)]
    assert indices["tsai_hill"] == pytest.approx(np.max(single, axis=0))
    # pulled along the span: the plies across are the first to crack
    assert np.argmax(np.max(single, axis=1)) == 3
    assert set(indices) >= {"maximum_strain", "maximum_strain, ply 4"}


def test_a_known_ply_counts_only_where_it_is() -> None:
    everywhere = laminated(Plies(LAMINATE))
    in_place = laminated(Plies(LAMINATE, ngs.IfPos(ngs.y - 0.5, 3.0, 0.0)))
    upper = in_place.points[:, 1] > 0.5
    fourth = "tsai_hill, ply 4"
    assert np.all(in_place.failure_at_points[fourth][~upper] == 0.0)
    assert in_place.failure_at_points[fourth][upper] == pytest.approx(
        everywhere.failure_at_points[fourth][upper]
    )
    assert np.all(in_place.failure_at_points["tsai_hill, ply 2"] == 0.0)
    assert np.all(in_place.failure_at_points["tsai_hill"] > 0.0)


def test_a_laminate_needs_axes() -> None:
    plastic = IsotropicSVK("plastic", 1200.0, 2.5e9, 0.35)
    structure = cube(plastic)
    with pytest.raises(ValueError, match="'quasi': the material of its region has no axes"):
        compute_stress(structure, structure.rest(), plies={"blade": Plies(LAMINATE)})
    metal = Laminate("foil", (Ply(plastic, 0.0, fraction=1.0),))
    fields = laminated(Plies(LAMINATE)).at_points
    assert ply_failure(metal, fields) == {}
