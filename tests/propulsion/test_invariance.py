# SPDX-License-Identifier: LGPL-2.1-or-later
"""Objectivity and symmetry of the assembled structure over random states."""

from dataclasses import replace
from functools import cache

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from quietblade.materials import find_material, ply_axes, section_directions
from quietblade.propulsion.structure import Structure, StructureState
from quietblade.propulsion.tangent import compute_tangent
from quietblade.typing import FloatArray
from verification.structure_models import SURFACE, box_mesh

FEW = settings(max_examples=8, deadline=None)
seeds = st.integers(0, 2**31)
angles = st.lists(st.floats(-3.0, 3.0), min_size=3, max_size=3)
sizes = st.floats(0.001, 0.03)
FILM_VOLUME = 0.2 * 0.02 * 0.3


@cache
def sandwich() -> Structure:
    """A block of woven laminate with a film in its middle, held on one side."""
    mesh = box_mesh(
        np.linspace(0.0, 0.2, 3), np.array([0.0, 0.04, 0.06, 0.1]), np.linspace(0.0, 0.3, 3),
        in_film=lambda c: np.abs(c[:, 1] - 0.05) < 0.01,
    )  # fmt: skip
    weave = find_material("woven-carbon-paper").oriented(ply_axes(0.4, *section_directions()))
    return Structure(
        mesh, {"blade": weave, "film": find_material("viscoelastic-paper")}, wetted=SURFACE
    )


def random_state(seed: int, size: float) -> StructureState:
    """A smooth large deformation with a random film pressure; no equilibrium."""
    structure, generator = sandwich(), np.random.default_rng(seed)
    X = structure.basis.points
    linear = generator.standard_normal((3, 3))
    waves = np.sin(X @ generator.normal(0.0, 8.0, (3, 3)) + generator.uniform(0, 6, 3))
    values = size * (X @ linear.T + 0.1 * waves)
    pressure = 1e5 * generator.standard_normal(structure.forms.n_pressure)
    return replace(
        structure.rest(), displacement=structure.basis.to_dofs(values), film_pressure=pressure
    )


def turned(state: StructureState, rotation: FloatArray, shift: FloatArray) -> StructureState:
    """The same deformed body, rotated and moved."""
    basis = sandwich().basis
    moved = basis.points + basis.to_values(state.displacement)
    values = moved @ rotation.T + shift - basis.points
    return replace(state, displacement=basis.to_dofs(values))


def split(force: FloatArray) -> tuple[FloatArray, FloatArray]:
    n = sandwich().forms.n_displacement
    return force[:n].reshape(3, -1), force[n:]


@FEW
@given(angles)
def test_a_rigid_motion_makes_no_force(angle: list[float]) -> None:
    structure = sandwich()
    rotation = Rotation.from_rotvec(angle).as_matrix()
    rigid = turned(structure.rest(), rotation, np.array([0.3, -0.2, 0.1]))
    force, volume = split(structure.internal_force(rigid))
    stretched = replace(rigid, displacement=structure.basis.to_dofs(1e-3 * structure.basis.points))
    scale = np.abs(split(structure.internal_force(stretched))[0]).max()
    assert np.abs(force).max() < 1e-9 * scale
    assert np.abs(volume).max() < 1e-12 * FILM_VOLUME


@FEW
@given(seeds, sizes, angles)
def test_the_internal_force_turns_with_the_body(seed: int, size: float, angle: list[float]) -> None:
    state, rotation = random_state(seed, size), Rotation.from_rotvec(angle).as_matrix()
    force, volume = split(sandwich().internal_force(state))
    moved = turned(state, rotation, np.array([0.1, 0.4, -0.2]))
    turned_force, same_volume = split(sandwich().internal_force(moved))
    assert np.abs(turned_force - rotation @ force).max() < 1e-9 * np.abs(force).max()
    assert np.abs(same_volume - volume).max() < 1e-12 * FILM_VOLUME


@FEW
@given(seeds, sizes, angles)
def test_the_tangent_is_symmetric_and_turns_with_the_body(
    seed: int, size: float, angle: list[float]
) -> None:
    structure, state = sandwich(), random_state(seed, size)
    rotation = Rotation.from_rotvec(angle).as_matrix()
    here = compute_tangent(structure, state)
    there = compute_tangent(structure, turned(state, rotation, np.zeros(3)))
    direction = np.random.default_rng(seed).standard_normal(structure.forms.ndof)
    n = structure.forms.n_displacement
    turned_direction = direction.copy()
    turned_direction[:n] = (rotation @ direction[:n].reshape(3, -1)).ravel()
    for name in ("elastic", "film", "film_isochoric_material"):
        matrix, other = getattr(here, name), getattr(there, name)
        largest = float(abs(matrix).max())
        assert abs(matrix - matrix.T).max() <= 1e-11 * largest
        force, same = split(matrix @ direction), split(other @ turned_direction)
        scale = np.abs(force[0]).max()
        assert np.abs(same[0] - rotation @ force[0]).max() < 1e-8 * scale
        # Volumes over forces: compared by themselves, where there are any.
        assert np.abs(same[1] - force[1]).max() <= 1e-8 * np.abs(force[1]).max()


@FEW
@given(seeds, sizes)
def test_the_tangent_is_the_derivative_of_the_force(seed: int, size: float) -> None:
    structure, state = sandwich(), random_state(seed, size)
    tangent = compute_tangent(structure, state)
    generator = np.random.default_rng(seed + 1)
    X = structure.basis.points
    wave = np.sin(X @ generator.normal(0.0, 8.0, (3, 3)) + generator.uniform(0, 6, 3))
    direction = structure.basis.to_dofs(wave)
    step = 1e-6

    def force(factor: float) -> FloatArray:
        moved = state.displacement + factor * step * direction
        return structure.internal_force(replace(state, displacement=moved))

    change = split((force(1.0) - force(-1.0)) / (2 * step))
    full = np.append(direction, np.zeros(structure.forms.n_pressure))
    expected = split((tangent.elastic + tangent.film) @ full)
    for found, wanted in zip(change, expected, strict=True):
        assert np.abs(found - wanted).max() < 1e-6 * np.abs(wanted).max()
