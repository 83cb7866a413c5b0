# SPDX-License-Identifier: LGPL-2.1-or-later
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import expm, logm
from scipy.spatial.transform import Rotation

from quietblade.materials import IsotropicSVK, MooneyRivlin, ply_axes, section_directions
from quietblade.propulsion.reactions import compute_reaction
from quietblade.propulsion.samples import take_samples
from quietblade.propulsion.stress import compute_stress
from quietblade.propulsion.structure import Structure
from quietblade.propulsion.supports import ElasticBed
from quietblade.propulsion.tensors import (
    cauchy_stress,
    green_lagrange_strain,
    logarithmic_strain,
    principal_values,
    von_mises_stress,
)
from quietblade.typing import FloatArray
from tests.propulsion.solid_models import bent_plate, plate
from verification.structure_blade import TaperedBlade, mesh_blade
from verification.structure_statics import film_block
from verification.structure_stress import GLASS, cube, deformed

FILM_AXES = ply_axes(0.0, *section_directions())
GRADIENT = np.array([[1.01, 0.02, 0.0], [0.0, 0.99, 0.03], [0.01, 0.0, 1.0]])


def gradients() -> st.SearchStrategy[FloatArray]:
    entries = st.lists(st.floats(-0.4, 0.4), min_size=9, max_size=9)
    return entries.map(lambda values: expm(np.array(values).reshape(3, 3)))


@settings(max_examples=30, deadline=None)
@given(gradients(), st.lists(st.floats(-2.0, 2.0), min_size=3, max_size=3))
def test_measures_agree_and_do_not_see_rotations(F, vector) -> None:
    turned = Rotation.from_rotvec(vector).as_matrix() @ F
    strain = logarithmic_strain(F)
    assert strain == pytest.approx(0.5 * logm(F.T @ F).real, abs=1e-10)
    assert logarithmic_strain(turned) == pytest.approx(strain, abs=1e-10)
    assert green_lagrange_strain(turned) == pytest.approx(green_lagrange_strain(F), abs=1e-10)
    assert principal_values(strain).sum() == pytest.approx(np.log(np.linalg.det(F)), abs=1e-10)
    stress = cauchy_stress(F, np.eye(3) + strain)
    assert von_mises_stress(cauchy_stress(turned, np.eye(3) + strain)) == pytest.approx(
        von_mises_stress(stress), abs=1e-9
    )
    assert stress == pytest.approx(stress.T)


def test_stress_of_a_homogeneous_state_is_that_of_the_law() -> None:
    axes = ply_axes(0.4, *section_directions(0.3))
    material = GLASS.oriented(axes)
    structure = cube(material)
    fields = compute_stress(structure, deformed(structure, GRADIENT)).regions["blade"].at_nodes
    E = green_lagrange_strain(GRADIENT)
    own = axes.T @ E @ axes
    i, j = np.array([0, 1, 2, 1, 0, 0]), np.array([0, 1, 2, 2, 2, 1])
    components = material.stiffness @ (own[i, j] * [1, 1, 1, 2, 2, 2])
    expected = np.zeros((3, 3))
    expected[i, j] = expected[j, i] = components
    assert fields.material_strain == pytest.approx(np.tile(own, (81, 1, 1)))
    assert fields.material_stress == pytest.approx(np.tile(expected, (81, 1, 1)), abs=1e-3)
    second = axes @ expected @ axes.T
    assert fields.second_piola[0] == pytest.approx(second, abs=1e-3)
    assert fields.cauchy[0] == pytest.approx(
        GRADIENT @ second @ GRADIENT.T / np.linalg.det(GRADIENT), abs=1e-3
    )


def test_film_pressure_is_part_of_the_stress() -> None:
    structure = film_block()
    state = deformed(structure, np.eye(3))
    state.film_pressure[:] = 7e4
    fields = compute_stress(structure, state).regions["film"].at_nodes
    assert fields.cauchy == pytest.approx(np.tile(7e4 * np.eye(3), (len(fields.cauchy), 1, 1)))
    assert isinstance(structure.forms.materials["film"], MooneyRivlin)
    assert fields.material_strain is None


def test_linear_fields_reach_the_nodes_of_every_kind_of_cell_exactly() -> None:
    tetrahedra = mesh_blade(TaperedBlade(), 0.15).structure(GLASS)
    for structure in (film_block(), tetrahedra):
        region = next(iter(structure.forms.materials))
        samples = take_samples(structure, structure.rest(), region)
        slope = np.array([[1.0, 2.0, -3.0]]).T
        nodal = samples.at_nodes(samples.points @ slope + 4.0)
        assert nodal == pytest.approx(structure.basis.points[samples.nodes] @ slope + 4.0)


def test_regions_do_not_mix_at_the_interface() -> None:
    structure, state = plate(), bent_plate()
    report = compute_stress(structure, state, axes={"film": FILM_AXES})
    blade, film = report.regions["blade"], report.regions["film"]
    shared = np.intersect1d(blade.nodes, film.nodes)
    assert len(shared) > 20
    stiff = blade.at_nodes.von_mises[np.isin(blade.nodes, shared)]
    soft = film.at_nodes.von_mises[np.isin(film.nodes, shared)]
    assert stiff.max() > 5 * soft.max()
    spread = film.spread(film.at_nodes.von_mises, len(structure.basis.points))
    assert np.array_equal(np.flatnonzero(np.isfinite(spread)), film.nodes)
    strain = film.at_nodes.material_strain
    assert strain is not None
    shear = 2 * np.abs(strain[:, 0, 2])
    assert shear.max() > 5 * np.abs(strain[:, 0, 0]).max()


def test_peaks_say_how_much_and_where() -> None:
    region = compute_stress(plate(), bent_plate()).regions["blade"]
    peak = region.peaks["von_mises"]
    assert peak.value == region.at_points.von_mises.max()
    assert 0.5 * peak.value < peak.percentile < peak.value
    assert peak.place[2] < 0.3  # near the root
    assert region.volumes.sum() == pytest.approx(0.5 * 0.1 * 0.01 - 0.3 * 0.1 * 0.0012, rel=1e-2)


def test_reactions_balance_pressure_and_spin_about_any_point() -> None:
    structure, state = plate(), bent_plate()
    for about in (None, np.array([0.3, -2.0, 1.0])):
        reaction = compute_reaction(structure, state, about)
        assert reaction.force_imbalance < 1e-9
        assert reaction.moment_imbalance < 1e-9
        assert np.linalg.norm(reaction.applied_force) > 100.0
    at_rest = compute_reaction(structure, structure.rest())
    assert np.isnan(at_rest.force_imbalance)


def test_an_elastic_support_reacts_too() -> None:
    mesh = mesh_blade(TaperedBlade(), 0.15)
    plastic = IsotropicSVK("plastic", 1200.0, 2.5e9, 0.35)
    structure = Structure(
        mesh.fem(), {"blade": plastic}, clamped=None, wetted="lower", support=ElasticBed(1e12)
    )
    reaction = compute_reaction(structure, structure.solve(mesh.pressure(500.0), tolerance=1e-9))
    assert reaction.force_imbalance < 1e-7
    assert np.linalg.norm(reaction.force) > 50.0


def test_a_state_that_is_no_equilibrium_is_out_of_balance() -> None:
    structure, state = plate(), bent_plate()
    moved = structure.rest()
    wrong = type(state)(moved.displacement, moved.film_pressure, state.loading)
    assert compute_reaction(structure, wrong).force_imbalance > 0.9


def test_unknown_regions_are_refused() -> None:
    structure, state = plate(), bent_plate()
    with pytest.raises(ValueError, match="region 'liner'"):
        compute_stress(structure, state, axes={"liner": FILM_AXES})
    with pytest.raises(ValueError, match="region 'liner'"):
        take_samples(structure, state, "liner")
