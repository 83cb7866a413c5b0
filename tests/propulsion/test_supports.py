# SPDX-License-Identifier: LGPL-2.1-or-later
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse import csr_matrix

from quietblade.errors import CaseError
from quietblade.propulsion.loads_assembly import resultant
from quietblade.propulsion.structure import Structure
from quietblade.propulsion.supports import (
    ElasticBed,
    RootSpring,
    Support,
    assemble_support,
    rotation_stiffness,
)
from quietblade.propulsion.tangent import compute_tangent
from quietblade.typing import FloatArray
from verification.structure_loads import supported_beam
from verification.structure_models import Beam

BEAM = Beam(length=1.0, height=0.1, cells=3, youngs_modulus=70e9)
SPRING = RootSpring((2e5, 3e5, 4e5), (5e4, 6e4, 7e4), centre=(0.01, -0.02, 0.03))


@cache
def beam(support: Support | None) -> Structure:
    return supported_beam(BEAM, support)


def stiffness_of(structure: Structure) -> csr_matrix:
    assert structure.elastic_support is not None
    return structure.elastic_support.stiffness


def rigid(structure: Structure, motion: FloatArray, centre: FloatArray) -> FloatArray:
    """Unknowns of a translation and a small rotation (6,) about a centre."""
    moved = motion[:3] + np.cross(motion[3:], structure.basis.points - centre)
    return structure.basis.to_dofs(moved)


@settings(max_examples=15, deadline=None)
@given(st.tuples(*6 * [st.floats(-1.0, 1.0)]))
def test_rigid_motions_store_the_springs_energy(values: tuple[float, ...]) -> None:
    structure, motion = beam(SPRING), np.array(values)
    stiffness = stiffness_of(structure)
    x = rigid(structure, motion, np.array(SPRING.centre))
    energy = 0.5 * x @ (stiffness @ x)
    springs = np.array([*SPRING.translation, *SPRING.rotation])
    # the flange is 1e7 times stiffer than the springs
    assert energy == pytest.approx(0.5 * springs @ motion**2, rel=1e-6, abs=1e-4)


@pytest.mark.parametrize("support", [SPRING, RootSpring(), ElasticBed(1e9)])
def test_the_energy_is_symmetric_and_never_negative(support: Support) -> None:
    stiffness = stiffness_of(beam(support))
    assert abs(stiffness - stiffness.T).max() <= 1e-12 * abs(stiffness).max()
    touched = np.flatnonzero(stiffness.diagonal())
    values = np.linalg.eigvalsh(stiffness[touched][:, touched].toarray())
    assert values[0] > -1e-10 * values[-1]


def test_a_bed_answers_a_translation_with_its_modulus_times_the_area() -> None:
    structure = beam(ElasticBed(1e9))
    x = rigid(structure, np.array([0.0, 1e-3, 0, 0, 0, 0]), np.zeros(3))
    stiffness = stiffness_of(structure)
    force, moment = resultant(structure.forms, stiffness @ x)
    assert force == pytest.approx([0.0, 1e9 * 0.01 * 1e-3, 0.0], abs=1e-6)
    assert moment == pytest.approx([0.0, 0.0, 0.0], abs=1e-6)


def test_springs_that_are_held_are_a_clamp() -> None:
    load = BEAM.tip_load(beam(None), np.array([0.0, 1e3, 5e2]))
    tips = []
    for support in (None, RootSpring()):
        structure = beam(support)
        state = structure.solve(np.zeros(len(structure.basis.points)), dead_load=load)
        tips.append(structure.values(state)[structure.basis.nodes_of("tip", 1)].mean(axis=0))
    assert tips[1] == pytest.approx(tips[0], rel=2e-3)
    assert tips[1][1] > tips[0][1]


def test_support_forces_are_the_reactions() -> None:
    structure = beam(SPRING)
    load = BEAM.tip_load(structure, np.array([2.0, 3.0, 4.0]))
    state = structure.solve(np.zeros(len(structure.basis.points)), dead_load=load, tolerance=1e-8)
    difference = structure.internal_force(state) - structure.external_force(state)
    held = structure.support_force(state)
    assert held == pytest.approx(difference, abs=1e-6)
    force, moment = resultant(structure.forms, held)
    assert force == pytest.approx([-2.0, -3.0, -4.0], rel=1e-6)
    assert moment == pytest.approx(-np.cross([0, 0, 1.0], [2.0, 3.0, 4.0]), rel=1e-3, abs=1e-3)


def test_the_support_is_a_piece_of_the_tangent() -> None:
    structure = beam(SPRING)
    tangent = compute_tangent(structure, structure.rest())
    stiffness = stiffness_of(structure)
    for form in ("full", "paper"):
        without = tangent.elastic
        assert abs(tangent.stiffness(form) - without - stiffness).max() < 1e-3
    assert abs(tangent.pieces["support"] - stiffness).max() == 0.0


def test_compliances_of_root_and_blade_add() -> None:
    lever, clamped, spring = 0.3, 25e3, 9e3
    measured = 1.0 / (1.0 / clamped + lever**2 / spring)
    assert rotation_stiffness(measured, clamped, lever) == pytest.approx(spring)
    with pytest.raises(CaseError, match="is not below that of the clamped model"):
        rotation_stiffness(clamped, clamped, lever)


def test_wrong_supports_are_refused() -> None:
    with pytest.raises(CaseError, match="positive and finite"):
        ElasticBed(0.0)
    with pytest.raises(CaseError, match="against rotation has to be three"):
        RootSpring(rotation=(1.0, -2.0, 3.0))
    with pytest.raises(CaseError, match="that face is clamped"):
        assemble_support(beam(None).forms, ElasticBed(1.0))
