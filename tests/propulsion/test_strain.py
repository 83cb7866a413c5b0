# SPDX-License-Identifier: LGPL-2.1-or-later
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quietblade.materials import ply_axes, section_directions
from quietblade.propulsion.strain import compute_film_shear, green_lagrange_field, nodal_strain
from quietblade.propulsion.structure import StructureState
from quietblade.typing import FloatArray
from tests.propulsion.solid_models import bent_plate, plate
from verification.structure_statics import film_block

AXES = ply_axes(0.0, *section_directions())
"""Span z, chordwise x, thickness y."""


def moved(gradient: FloatArray) -> StructureState:
    structure, rest = film_block(), film_block().rest()
    displacement = structure.basis.to_dofs(structure.basis.points @ (gradient - np.eye(3)).T)
    return StructureState(displacement, rest.film_pressure, rest.loading)


@pytest.mark.parametrize("at", ["quadrature", "nodes"])
def test_slip_of_one_face_over_the_other_is_the_engineering_shear(at) -> None:
    gradient = np.eye(3)
    gradient[2, 1], gradient[0, 1] = 0.08, 0.06  # along the span and along the chord, per thickness
    shear = compute_film_shear(film_block(), moved(gradient), AXES, at=at)
    assert shear.gamma_13 == pytest.approx(0.08)
    assert shear.gamma_23 == pytest.approx(0.06)
    assert shear.maximum == pytest.approx(0.1)
    assert shear.mean == pytest.approx(0.1)
    assert shear.percentile(50.0) == pytest.approx(0.1)
    assert shear.volumes.sum() == pytest.approx(1.0, rel=0.02 if at == "nodes" else 1e-12)


def test_a_rotation_is_no_shear() -> None:
    rotation = Rotation.from_rotvec([0.5, 0.2, -0.7]).as_matrix()
    assert compute_film_shear(film_block(), moved(rotation), AXES).maximum < 1e-12
    gradient = np.eye(3)
    gradient[2, 1] = 0.08
    turned = compute_film_shear(film_block(), moved(rotation @ gradient), AXES)
    assert turned.gamma == pytest.approx(0.08)


def test_shear_is_told_in_the_films_own_axes() -> None:
    gradient = np.eye(3)
    gradient[2, 1] = 0.08
    quarter = ply_axes(np.pi / 2, *section_directions())
    shear = compute_film_shear(film_block(), moved(gradient), quarter)
    assert shear.gamma_13 == pytest.approx(0.0, abs=1e-12)
    assert np.abs(shear.gamma_23) == pytest.approx(0.08)
    in_plane = np.eye(3)
    in_plane[0, 2] = 0.08
    assert compute_film_shear(film_block(), moved(in_plane), AXES).maximum < 1e-12


def test_bent_plate_shears_its_film_and_says_where() -> None:
    structure, state = plate(), bent_plate()
    gauss = compute_film_shear(structure, state, AXES)
    corners = compute_film_shear(structure, state, AXES, at="nodes")
    assert 0.0 < gauss.mean < gauss.percentile(99.0) <= gauss.maximum
    assert corners.maximum == pytest.approx(gauss.maximum, rel=0.1)
    assert gauss.volumes.sum() == pytest.approx(0.0012 * 0.1 * 0.3, rel=1e-2)
    assert 0.2 <= gauss.place[2] <= 0.5
    assert abs(gauss.place[1]) < 0.02
    assert gauss.gamma[np.argmax(gauss.gamma)] == gauss.maximum


def test_nodal_strain_of_a_linear_field_is_exact() -> None:
    gradient = np.array([[1.01, 0.02, 0.0], [0.0, 0.99, 0.03], [0.01, 0.0, 1.0]])
    E = 0.5 * (gradient.T @ gradient - np.eye(3))
    strain = nodal_strain(film_block(), moved(gradient), region="film")
    expected = [E[0, 0], E[1, 1], E[2, 2], E[1, 2], E[0, 2], E[0, 1]]
    assert strain == pytest.approx(np.tile(expected, (len(strain), 1)), abs=1e-12)


def test_nodal_strain_is_not_told_outside_its_region() -> None:
    structure, state = plate(), bent_plate()
    strain = nodal_strain(structure, state, AXES, region="film")
    inside = np.isfinite(strain).all(axis=1)
    assert np.array_equal(np.flatnonzero(inside), structure.basis.nodes_of("film"))
    shear = compute_film_shear(structure, state, AXES)
    nodal = 2 * np.hypot(strain[inside, 4], strain[inside, 3])
    assert nodal.max() == pytest.approx(shear.maximum, rel=0.3)
    assert tuple(green_lagrange_field(structure, state).dims) == (3, 3)


def test_unknown_region_is_refused() -> None:
    with pytest.raises(ValueError, match="no region 'liner'"):
        compute_film_shear(plate(), bent_plate(), AXES, region="liner")
