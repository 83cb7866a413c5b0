# SPDX-License-Identifier: LGPL-2.1-or-later
from collections.abc import Iterator

import ngsolve as ngs
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quietblade.errors import MaterialError
from quietblade.materials import (
    ElasticMaterial,
    IsotropicSVK,
    MixedMaterial,
    MooneyRivlin,
    OrthotropicSVK,
    find_material,
)
from quietblade.typing import FloatArray
from verification.structure_models import box_mesh, voigt_stiffness

ALUMINIUM = IsotropicSVK("aluminium", 2700.0, 70e9, 0.33)
CARBON = find_material("woven-carbon-paper")
FILM = find_material("viscoelastic-paper")
GRADIENT = np.eye(3) + 0.1 * np.random.default_rng(3).standard_normal((3, 3))
ROTATION = Rotation.from_rotvec([0.5, -0.8, 0.3]).as_matrix()


@pytest.fixture(scope="module")
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
