# SPDX-License-Identifier: LGPL-2.1-or-later
from collections.abc import Iterator

import ngsolve as ngs
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.spatial.transform import Rotation

from quietblade.errors import MaterialError
from quietblade.materials import (
    AnisotropicSVK,
    ElasticMaterial,
    IsotropicSVK,
    MixedMaterial,
    MooneyRivlin,
    NeoHookean,
    OrthotropicSVK,
    find_material,
)
from quietblade.materials.voigt import PAIRS, strain_transformation, turned_stiffness
from quietblade.typing import FloatArray
from verification.structure_models import box_mesh, voigt_stiffness

ALUMINIUM = IsotropicSVK("aluminium", 2700.0, 70e9, 0.33)
CARBON = find_material("woven-carbon-paper")
FILM = find_material("viscoelastic-paper")
RUBBER = NeoHookean("rubber", 1100.0, 1.5e6, 2.2e9, 0.2)
SEED = np.random.default_rng(7).standard_normal((6, 9))
CRYSTAL = AnisotropicSVK("crystal", 3000.0, 1e9 * SEED @ SEED.T)
GRADIENT = np.eye(3) + 0.1 * np.random.default_rng(3).standard_normal((3, 3))
ROTATION = Rotation.from_rotvec([0.5, -0.8, 0.3]).as_matrix()


@pytest.fixture(scope="session")
def point() -> Iterator[ngs.fem.MeshPoint]:
    plane = np.array([0.0, 1.0])
    mesh = box_mesh(plane, plane, plane)  # a point does not keep its mesh alive
    yield mesh(0.3, 0.4, 0.5)


def matrix(values: FloatArray) -> ngs.CoefficientFunction:
    return ngs.CF(tuple(np.asarray(values, dtype=float).ravel()), dims=(3, 3))


@pytest.mark.parametrize("law", [ALUMINIUM, CARBON], ids=lambda law: law.name)
def test_a_rotation_after_the_deformation_changes_no_elastic_energy(law, point) -> None:
    assert law.energy(matrix(ROTATION))(point) == pytest.approx(0.0, abs=1e-12 * 65e9)
    strained = law.energy(matrix(GRADIENT))(point)
    assert law.energy(matrix(ROTATION @ GRADIENT))(point) == pytest.approx(strained, rel=1e-10)


def test_a_rotation_changes_no_film_energy(point) -> None:
    assert FILM.energy(matrix(ROTATION), ngs.CF(3e5))(point) == pytest.approx(-9e10 / 4.4e9)
    strained = FILM.energy(matrix(GRADIENT), ngs.CF(3e5))(point)
    turned = FILM.energy(matrix(ROTATION @ GRADIENT), ngs.CF(3e5))(point)
    assert turned == pytest.approx(strained, rel=1e-10)


def test_orthotropic_with_isotropic_constants_is_isotropic(point) -> None:
    e, nu = ALUMINIUM.youngs_modulus, ALUMINIUM.poisson_ratio
    g = e / (2 * (1 + nu))
    same = OrthotropicSVK("same", 2700.0, e, e, e, g, g, g, nu, nu, nu, axes=ROTATION)
    expected = ALUMINIUM.energy(matrix(GRADIENT))(point)
    assert same.energy(matrix(GRADIENT))(point) == pytest.approx(expected, rel=1e-12)


def test_engineering_constants_come_back_from_the_stiffness() -> None:
    S = np.linalg.inv(voigt_stiffness(CARBON))
    assert 1 / np.diag(S) == pytest.approx([65e9, 65e9, 10e9, 3e9, 3e9, 5e9])
    # nu13 is strain 3 from stress 1
    assert -S[2, 0] / S[0, 0] == pytest.approx(0.2)
    assert -S[1, 0] / S[0, 0] == pytest.approx(0.04)
    assert -S[2, 1] / S[1, 1] == pytest.approx(0.2)


def test_axes_turn_the_stiffness(point) -> None:
    turned = CARBON.oriented(ROTATION)
    strain = 0.5 * (GRADIENT.T @ GRADIENT - np.eye(3))
    expected = CARBON.energy_of_strain(matrix(ROTATION.T @ strain @ ROTATION))(point)
    assert turned.energy_of_strain(matrix(strain))(point) == pytest.approx(expected, rel=1e-12)


def test_isochoric_energy_does_not_see_a_change_of_volume(point) -> None:
    expected = FILM.isochoric_energy(matrix(GRADIENT))(point)
    assert FILM.isochoric_energy(matrix(1.7 * GRADIENT))(point) == pytest.approx(expected)
    assert FILM.isochoric_energy(matrix(1.7 * np.eye(3)))(point) == pytest.approx(0.0, abs=1e-8)
    metric = matrix(GRADIENT.T @ GRADIENT)
    assert FILM.isochoric_energy_of_metric(metric)(point) == pytest.approx(expected, rel=1e-12)


def test_mixed_energy_is_stationary_at_bulk_modulus_times_dilatation(point) -> None:
    p = FILM.bulk_modulus * (np.linalg.det(GRADIENT) - 1)
    F = matrix(GRADIENT)
    at, above, below = (FILM.energy(F, ngs.CF(p * f))(point) for f in (1.0, 1.01, 0.99))
    assert above == pytest.approx(below, rel=1e-10)
    assert at > above
    stored = 0.5 * FILM.bulk_modulus * (np.linalg.det(GRADIENT) - 1) ** 2
    assert at == pytest.approx(FILM.isochoric_energy(F)(point) + stored, rel=1e-12)


def test_laws_tell_whether_they_are_mixed() -> None:
    assert isinstance(FILM, MixedMaterial)
    assert not isinstance(FILM, ElasticMaterial)
    for law in (ALUMINIUM, CARBON):
        assert isinstance(law, ElasticMaterial)
        assert not isinstance(law, MixedMaterial)


CARBON_CONSTANTS = {
    "density": 1500.0, "e1": 65e9, "e2": 65e9, "e3": 10e9, "g12": 5e9, "g23": 3e9, "g13": 3e9,
    "nu12": 0.04, "nu23": 0.2, "nu13": 0.2,
}  # fmt: skip


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"e3": 0.0}, "e3 > 0"),
        ({"g23": -3e9}, "g23 > 0"),
        ({"density": float("nan")}, "density > 0"),
        ({"nu13": 2.6}, r"\|nu13\| < sqrt\(e1/e3\).*2\.6.*limit 2\.5495"),
        ({"nu12": 0.7, "nu13": 1.9, "nu23": 1.9}, "positive determinant"),
    ],
)
def test_inadmissible_orthotropic_constants_are_refused(wrong, words) -> None:
    with pytest.raises(MaterialError, match=f"'weave'.*{words}"):
        OrthotropicSVK("weave", **{**CARBON_CONSTANTS, **wrong})


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda C: C[:5], r"6 x 6 finite numbers.*\(5, 6\)"),
        (lambda C: C + np.triu(np.full((6, 6), 1e9), 1), "symmetric stiffness"),
        (lambda C: C - 40e9 * np.eye(6), "positive"),
        (lambda C: np.full((6, 6), np.nan), "finite numbers"),
        (lambda C: np.zeros((6, 6)), "positive diagonal"),
    ],
)
def test_inadmissible_stiffness_is_refused(change, words) -> None:
    with pytest.raises(MaterialError, match=f"'crystal'.*{words}"):
        AnisotropicSVK("crystal", 3000.0, change(np.asarray(CRYSTAL.stiffness)))


def test_a_stiffness_field_needs_six_rows() -> None:
    with pytest.raises(MaterialError, match=r"dimensions \(3, 3\)"):
        AnisotropicSVK("crystal", 3000.0, ngs.Id(3))


@pytest.mark.parametrize(
    ("constants", "words"),
    [
        ({"shear_modulus": 0.0}, "shear_modulus > 0"),
        ({"bulk_modulus": 1e5}, "bulk_modulus > 2/3"),
        ({"loss_factor": float("nan")}, "loss_factor >= 0"),
        ({"density": -1.0}, "density > 0"),
    ],
)
def test_inadmissible_rubber_is_refused(constants, words) -> None:
    good = {"density": 1.0, "shear_modulus": 1e6, "bulk_modulus": 2e9, "loss_factor": 0.2}
    with pytest.raises(MaterialError, match=words):
        NeoHookean("rubber", **{**good, **constants})


def test_elastic_loss_factors_are_not_negative() -> None:
    with pytest.raises(MaterialError, match="loss_factor >= 0"):
        IsotropicSVK("solid", 1.0, 1.0, 0.3, loss_factor=-0.01)
    with pytest.raises(MaterialError, match="loss_factor >= 0"):
        OrthotropicSVK("weave", **CARBON_CONSTANTS, loss_factor=-0.01)


@pytest.mark.parametrize(("ratio", "ok"), [(0.499, True), (0.5, False), (-1.0, False)])
def test_poissons_ratio_of_an_isotropic_solid_is_bounded(ratio, ok) -> None:
    if ok:
        assert IsotropicSVK("solid", 1.0, 1.0, ratio).lame[0] > 0
    else:
        with pytest.raises(MaterialError, match="-1 < poisson_ratio < 1/2"):
            IsotropicSVK("solid", 1.0, 1.0, ratio)


@pytest.mark.parametrize(
    ("constants", "words"),
    [
        ({"c10": -1.0}, "c10 >= 0"),
        ({"c10": 0.0, "c01": 0.0}, "shear_modulus > 0"),
        ({"bulk_modulus": 100.0}, "bulk_modulus > 2/3"),
        ({"loss_factor": -0.2}, "loss_factor >= 0"),
    ],
)
def test_inadmissible_film_constants_are_refused(constants, words) -> None:
    good = {"density": 1.0, "c10": 1e6, "c01": 1e6, "bulk_modulus": 2e9, "loss_factor": 0.2}
    with pytest.raises(MaterialError, match=words):
        MooneyRivlin("film", **{**good, **constants})


ELASTIC = [ALUMINIUM, CARBON, CARBON.oriented(ROTATION), CRYSTAL, CRYSTAL.oriented(ROTATION)]
MIXED = [FILM, RUBBER]
small = arrays(float, (3, 3), elements=st.floats(-0.2, 0.2))
turns = arrays(float, 3, elements=st.floats(-3.0, 3.0))


def stress(law, E: FloatArray, point) -> FloatArray:
    """Second Piola-Kirchhoff stress by differentiation of the energy."""
    field = matrix(E).MakeVariable()
    S = np.array(law.energy_of_strain(field).Diff(field)(point)).reshape(3, 3)
    return 0.5 * (S + S.T)


@settings(max_examples=10, deadline=None)
@given(small, turns)
def test_energies_do_not_see_a_rotation(point, gradient, turn) -> None:
    F, Q = np.eye(3) + gradient, Rotation.from_rotvec(turn).as_matrix()
    for law in ELASTIC:
        assert law.energy(matrix(Q @ F))(point) == pytest.approx(
            law.energy(matrix(F))(point), rel=1e-8, abs=1e-4
        )
    for law in MIXED:
        p = ngs.CF(2e5)
        assert law.energy(matrix(Q @ F), p)(point) == pytest.approx(
            law.energy(matrix(F), p)(point), rel=1e-8, abs=1e-4
        )


@settings(max_examples=8, deadline=None)
@given(small, small)
def test_stress_is_the_derivative_of_the_energy_and_the_stiffness_symmetric(
    point, first, second
) -> None:
    E, d = 0.5 * (first + first.T), 0.5 * (second + second.T)
    rounding = 1e-13 * 1e12 * (np.abs(E).max() + np.abs(d).max() + 1e-9) ** 2
    for law in (ALUMINIUM, CARBON.oriented(ROTATION), CRYSTAL.oriented(ROTATION)):
        along = float(np.sum(stress(law, E, point) * d))
        # the energies are quadratic in the strain: differences are exact
        ahead, behind = (law.energy_of_strain(matrix(E + sign * d))(point) for sign in (1, -1))
        assert along == pytest.approx(0.5 * (ahead - behind), rel=1e-9, abs=rounding)
        # the work of one strain against the stress of the other is the same
        back = float(np.sum(stress(law, d, point) * E))
        assert along == pytest.approx(back, rel=1e-9, abs=rounding)


def test_nothing_is_stored_at_rest(point) -> None:
    for law in ELASTIC:
        assert law.energy(matrix(np.eye(3)))(point) == 0.0
        assert stress(law, np.zeros((3, 3)), point) == pytest.approx(np.zeros((3, 3)))
    for law in MIXED:
        F = matrix(np.eye(3)).MakeVariable()
        assert law.energy(F, ngs.CF(0.0))(point) == pytest.approx(0.0, abs=1e-8)
        first = np.array(law.energy(F, ngs.CF(0.0)).Diff(F)(point))
        assert first == pytest.approx(np.zeros(9), abs=1e-7 * law.shear_modulus)


def test_energy_of_each_law_is_that_of_its_stiffness() -> None:
    for law in (ALUMINIUM, CARBON, CRYSTAL):
        C = np.asarray(law.stiffness)
        assert voigt_stiffness(law) == pytest.approx(C, rel=1e-9, abs=1e-3)
        assert np.linalg.eigvalsh(C)[0] > 0.0
    turned = turned_stiffness(np.asarray(CRYSTAL.stiffness), ROTATION)
    assert voigt_stiffness(CRYSTAL.oriented(ROTATION)) == pytest.approx(turned, rel=1e-9, abs=1.0)


@settings(max_examples=50, deadline=None)
@given(small, turns)
def test_strain_transformation_turns_the_tensor(gradient, turn) -> None:
    E, A = 0.5 * (gradient + gradient.T), Rotation.from_rotvec(turn).as_matrix()

    def six(T: FloatArray) -> FloatArray:
        return np.array([T[i, j] * (1.0 if i == j else 2.0) for i, j in PAIRS])

    assert strain_transformation(A) @ six(E) == pytest.approx(six(A.T @ E @ A), abs=1e-12)


def test_neo_hookean_is_mooney_rivlin_without_its_second_constant(point) -> None:
    same = MooneyRivlin("same", 1100.0, 0.75e6, 0.0, 2.2e9, 0.2)
    F, p = matrix(GRADIENT), ngs.CF(-4e5)
    assert RUBBER.energy(F, p)(point) == pytest.approx(same.energy(F, p)(point), rel=1e-12)
    metric = matrix(GRADIENT.T @ GRADIENT)
    expected = same.isochoric_energy_of_metric(metric)(point)
    assert RUBBER.isochoric_energy_of_metric(metric)(point) == pytest.approx(expected, rel=1e-12)
    assert isinstance(RUBBER, MixedMaterial)
