# SPDX-License-Identifier: LGPL-2.1-or-later
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from quietblade.errors import MaterialError
from quietblade.materials import (
    IsotropicSVK,
    Laminate,
    OrthotropicSVK,
    Ply,
    beam_stiffness,
    effective_stiffness,
    find_material,
    plate_stiffness,
)
from quietblade.materials.laminate import IN_PLANE, reduced_stiffness
from quietblade.materials.voigt import in_plane_rotation, turned_stiffness

UD = find_material("carbon-epoxy-t300")
GLASS = find_material("glass-epoxy-woven")
FOAM = IsotropicSVK("foam", 80.0, 80e6, 0.3)
assert isinstance(UD, OrthotropicSVK)
assert isinstance(GLASS, OrthotropicSVK)
angles = st.floats(-np.pi, np.pi)
stacks = st.lists(st.tuples(st.sampled_from([UD, GLASS]), angles), min_size=1, max_size=5)


def laminate(plies, drape="symmetric") -> Laminate:
    share = 1.0 / len(plies)
    return Laminate("stack", tuple(Ply(m, a, fraction=share) for m, a in plies), drape)


@settings(max_examples=40, deadline=None)
@given(angles, st.integers(1, 6))
def test_a_stack_of_identical_plies_is_the_ply(angle, count) -> None:
    ply = Ply(UD, angle, fraction=1.0)
    stack = laminate([(UD, angle)] * count)
    assert stack.stiffness == pytest.approx(ply.stiffness, rel=1e-9, abs=10.0)
    assert stack.bending_error() < 1e-12


@settings(max_examples=40, deadline=None)
@given(stacks, angles)
def test_turning_all_plies_turns_the_stiffness(plies, turn) -> None:
    turned = laminate([(m, a + turn) for m, a in plies])
    wanted = turned_stiffness(laminate(plies).stiffness, in_plane_rotation(turn))
    assert turned.stiffness == pytest.approx(wanted, rel=1e-8, abs=100.0)


@settings(max_examples=40, deadline=None)
@given(stacks)
def test_half_a_turn_changes_nothing(plies) -> None:
    half = laminate([(m, a + np.pi) for m, a in plies])
    assert half.stiffness == pytest.approx(laminate(plies).stiffness, rel=1e-9, abs=100.0)


@settings(max_examples=40, deadline=None)
@given(stacks)
def test_effective_stiffness_is_definite_and_has_the_membrane_stiffness_of_the_stack(plies) -> None:
    stack = laminate(plies)
    assert np.linalg.eigvalsh(stack.stiffness)[0] > 0.0
    membrane = stack.abd(0.02).A / 0.02
    assert reduced_stiffness(stack.stiffness) == pytest.approx(membrane, rel=1e-9, abs=100.0)


@settings(max_examples=40, deadline=None)
@given(stacks)
def test_plies_carry_the_same_stress_out_of_the_plane(plies) -> None:
    # strains in the plane are shared, stresses out of it too: their mean is the effective one
    stack = laminate(plies)
    strain = np.array([1e-3, -4e-4, 7e-4, 2e-4, -3e-4, 5e-4])
    stress = stack.stiffness @ strain
    p, q = list(IN_PLANE), [2, 3, 4]
    mean = np.zeros(6)
    for ply in stack.plies:
        C = ply.stiffness
        own = strain.copy()
        own[q] = np.linalg.solve(C[np.ix_(q, q)], stress[q] - C[np.ix_(q, p)] @ strain[p])
        assert (C @ own)[q] == pytest.approx(stress[q], rel=1e-9, abs=1e-3)
        mean[p] += (C @ own)[p] / len(plies)
        mean[q] += own[q] / len(plies)
    assert mean[p] == pytest.approx(stress[p], rel=1e-9, abs=1.0)
    assert mean[q] == pytest.approx(strain[q], rel=1e-9, abs=1e-12)


def test_many_repeats_bend_as_the_effective_solid() -> None:
    cross = [(UD, 0.0), (UD, np.pi / 2)]
    errors = [laminate(cross * n, "through").bending_error() for n in (1, 4, 16)]
    assert errors[0] > errors[1] > errors[2]
    assert errors[2] < 3e-3


def test_cross_ply_by_hand() -> None:
    # [0/90]s of 0.25 mm: A11 = h/2 (Q11 + Q22), D11 = (Q11 (h^3 - (h/2)^3) + Q22 (h/2)^3) / 12
    stack = Laminate(
        "cross", (Ply(UD, 0.0, thickness=0.25e-3), Ply(UD, np.pi / 2, thickness=0.25e-3))
    )
    q11, q22 = (e / (1 - 0.28**2 * 11 / 138) for e in (138e9, 11e9))
    h, plate = 1e-3, stack.abd()
    assert plate.A[0, 0] == pytest.approx(0.5 * h * (q11 + q22))
    assert plate.D[0, 0] == pytest.approx((q11 * 7 / 8 + q22 / 8) * h**3 / 12)
    assert plate.D[1, 1] == pytest.approx((q22 * 7 / 8 + q11 / 8) * h**3 / 12)
    assert np.abs(plate.B).max() < 1e-9
    assert plate.A[0, 2] == pytest.approx(0.0, abs=1e-3)


def test_sense_of_the_ply_angle_decides_the_sign_of_the_coupling() -> None:
    # fibres from the span towards the trailing edge: stretching along 1 shears by +12
    ply = laminate([(UD, np.radians(30.0))]).abd(1.0)
    assert ply.A[0, 2] > 0.0
    mirrored = laminate([(UD, np.radians(-30.0))]).abd(1.0)
    assert mirrored.A[0, 2] == pytest.approx(-ply.A[0, 2])


def test_one_drape_lays_the_stack_once_the_other_from_both_faces() -> None:
    plies = [(UD, 0.0), (GLASS, 0.3)]
    assert [p.material.name for p in laminate(plies, "through").stack()] == [UD.name, GLASS.name]
    both = laminate(plies, "symmetric").stack()
    assert [p.material.name for p in both] == [UD.name, GLASS.name, GLASS.name, UD.name]
    assert np.abs(laminate(plies, "symmetric").abd(1.0).B).max() < 1e-3


def test_density_is_the_mean_of_the_shares() -> None:
    stack = Laminate("w", (Ply(UD, 0.0, fraction=0.2), Ply(FOAM, 0.0, fraction=0.8)), loss_factor=0)
    assert stack.density == pytest.approx(0.2 * 1550 + 0.8 * 80)


def test_isotropic_strip_has_the_stiffness_of_a_beam() -> None:
    metal = IsotropicSVK("metal", 2700.0, 70e9, 0.33)
    beam = beam_stiffness(plate_stiffness([metal.stiffness], [0.01]).D, 0.2)
    assert beam.bending == pytest.approx(70e9 * 0.2 * 0.01**3 / 12)
    assert beam.torsion == pytest.approx(70e9 / 2.66 * 0.2 * 0.01**3 / 3)
    assert beam.coupling == 0.0


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: Ply(UD, 0.0), "either a thickness or a fraction"),
        (lambda: Ply(UD, 0.0, 1e-3, 0.5), "either a thickness or a fraction"),
        (lambda: Ply(UD, 0.0, thickness=-1e-3), "thickness or fraction > 0"),
        (lambda: Ply(UD, float("nan"), thickness=1e-3), "finite angle"),
        (lambda: Laminate("l", ()), "at least one ply"),
        (
            lambda: Laminate("l", (Ply(UD, 0.0, 1e-3), Ply(UD, 0.0, fraction=1.0))),
            "thicknesses or fractions",
        ),
        (lambda: Laminate("l", (Ply(UD, 0.0, fraction=0.9),)), "sum to 0.9"),
        (
            lambda: Laminate(
                "l",
                (
                    Ply(UD, 0.0, fraction=0.5),
                    Ply(IsotropicSVK("m", 1.0, 1e9, 0.3, loss_factor=0.1), 0.0, fraction=0.5),
                ),
            ),
            "plies have 0, 0.1",
        ),
        (lambda: Laminate("l", (Ply(UD, 0.0, fraction=1.0),)).abd(), "give the plate's thickness"),
    ],
)
def test_impossible_stacks_are_refused(make, words) -> None:
    with pytest.raises(MaterialError, match=words):
        make()


def test_plies_pass_on_their_common_loss_factor() -> None:
    lossy = OrthotropicSVK(
        "lossy", 1500.0, 65e9, 65e9, 10e9, 5e9, 3e9, 3e9, 0.04, 0.2, 0.2, loss_factor=0.01
    )
    assert Laminate("l", (Ply(lossy, 0.3, fraction=1.0),)).loss == 0.01
    assert Laminate("l", (Ply(lossy, 0.3, fraction=1.0),), loss_factor=0.02).loss == 0.02


def test_effective_stiffness_of_layers_in_series_is_that_of_reuss() -> None:
    soft = IsotropicSVK("soft", 1.0, 1e9, 0.0)
    stiff = IsotropicSVK("stiff", 1.0, 9e9, 0.0)
    C = effective_stiffness([soft.stiffness, stiff.stiffness], [0.5, 0.5])
    assert C[2, 2] == pytest.approx(1.8e9)
    assert C[0, 0] == pytest.approx(5e9)
    assert C[3, 3] == pytest.approx(0.9e9)
