# SPDX-License-Identifier: LGPL-2.1-or-later
"""Point and line forces, amplitudes over frequency, random loads."""

from functools import cache

import numpy as np
import pytest
import scipy.sparse as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from quietblade.errors import MeshError
from quietblade.typing import AnyArray, FloatArray
from quietblade.vibroacoustics.excitation import pressure_force
from quietblade.vibroacoustics.loads import (
    Excitation,
    Spectrum,
    band_integral,
    harmonic_amplitudes,
    load_vectors,
    power_density,
    response_density,
    spectral_matrix,
    superposed,
)
from quietblade.vibroacoustics.loss import Lossy, Viscous
from quietblade.vibroacoustics.operators import Operators
from quietblade.vibroacoustics.point_loads import (
    evaluation_matrix,
    line_force,
    point_force,
    surface_of,
)
from quietblade.vibroacoustics.power import power_budget
from quietblade.vibroacoustics.vacuum import dry_operators
from verification.acoustics_oscillators import random_mean_square
from verification.acoustics_plate import WetPlate, solve_all
from verification.structure_models import Beam


@cache
def plate() -> WetPlate:
    return WetPlate(sides=(0.2, 0.04, 0.3), size=0.2, radius=0.3)


def resultant(force: FloatArray) -> FloatArray:
    """Force and moment about the origin."""
    basis = plate().basis
    fields = [np.tile(axis, (len(basis.points), 1)) for axis in np.eye(3)]
    fields += [np.cross(axis, basis.points) for axis in np.eye(3)]
    return np.array([basis.to_dofs(field) @ force for field in fields])


def test_evaluation_matrix_is_to_values() -> None:
    basis = plate().basis
    values = np.random.default_rng(0).standard_normal(len(basis.points))
    dofs = basis.to_dofs(values)
    used = np.unique(np.concatenate([basis.edge_ends.ravel(), basis.edge_nodes]))
    np.testing.assert_allclose((evaluation_matrix(basis) @ dofs)[used], values[used], atol=1e-12)


@settings(max_examples=20, deadline=None)
@given(st.floats(-0.09, 0.09), st.floats(-0.1, 0.14))
def test_point_force_has_its_force_and_moment(x: float, z: float) -> None:
    model = plate()
    place, force = np.array([x, 0.02, z]), np.array([1.0, -2.0, 0.5])
    found = resultant(point_force(model.basis, model.surface, place, force))
    expected = np.concatenate([force, np.cross(place, force)])
    np.testing.assert_allclose(found, expected, atol=1e-9)


def test_line_force_adds_up() -> None:
    model = plate()
    path = np.array([[-0.05, 0.02, -0.1], [0.05, 0.02, -0.1], [0.05, 0.02, 0.1]])
    force = np.array([0.0, 3.0, 0.0])
    found = resultant(line_force(model.basis, model.surface, path, force))
    centre = np.array([0.2 * 0.05, 0.3 * 0.02, -0.1 * 0.1]) / 0.3
    expected = 0.3 * np.concatenate([force, np.cross(centre, force)])
    np.testing.assert_allclose(found, expected, atol=1e-9)


def test_places_off_the_surface_are_refused() -> None:
    model = plate()
    with pytest.raises(MeshError, match="away from the surface"):
        point_force(model.basis, model.surface, np.array([0.0, 0.1, 0.0]), np.ones(3))
    structure = Beam(cells=2).structure()
    with pytest.raises(MeshError, match="not triangles"):
        surface_of(structure.basis, "left")


def two() -> list[Excitation]:
    """A patch whose pressure has a table, and a force."""
    model = plate()
    rhs = model.operators.right_hand_side
    patch = rhs(pressure_force(model.fem, 1.0))
    force = rhs(point_force(model.basis, model.surface, [0.0, 0.02, 0.1], [0.0, 1.0, 0.0]))
    table = Spectrum(np.array([20.0, 100.0, 200.0]), np.array([2.0, 4.0j, 4.0j]))
    return [Excitation("patch", patch, table), Excitation("force", force, 5.0)]


def test_several_loads_with_tables_superpose() -> None:
    frequency, excitations = np.array([60.0, 150.0]), two()
    amplitude = harmonic_amplitudes(excitations, frequency)
    np.testing.assert_allclose(amplitude, [[1.0 + 2.0j, 5.0], [4.0j, 5.0]])
    vectors = load_vectors(excitations)
    operators = plate().operators
    together = superposed(amplitude, solve_all(operators, frequency, vectors))
    for i, f in enumerate(frequency):
        alone = solve_all(operators, np.array([f]), (amplitude[i] @ vectors)[None])[0, 0]
        np.testing.assert_allclose(together[i], alone, atol=1e-9 * np.abs(alone).max())
    omega = 2.0 * np.pi * frequency
    assert power_budget(operators, omega, together, amplitude @ vectors).residual.max() < 1e-8
    with pytest.raises(ValueError, match="covers 20 to 200 Hz"):
        harmonic_amplitudes(excitations, np.array([201.0]))
    with pytest.raises(ValueError, match="ascending"):
        Spectrum(np.array([1.0, 1.0]), np.ones(2))


@pytest.mark.parametrize("correlation", ["none", "full"])
def test_random_loads_as_sums_of_harmonic_ones(correlation: str) -> None:
    generator = np.random.default_rng(3)
    frequency = np.array([10.0, 20.0])
    density = np.array([2.0, 5.0])
    excitations = [Excitation(str(k), np.eye(2)[k], density[k]) for k in range(2)]
    matrix = spectral_matrix(excitations, frequency, correlation)  # type: ignore[arg-type]
    transfer = generator.standard_normal((2, 2, 3)) + 1j * generator.standard_normal((2, 2, 3))
    found = response_density(transfer, matrix)
    root = np.sqrt(density)[None, :, None]
    parts = transfer * root
    expected = (
        np.abs(parts.sum(axis=1)) ** 2
        if correlation == "full"
        else np.sum(np.abs(parts) ** 2, axis=1)
    )
    np.testing.assert_allclose(found, expected, rtol=1e-12)
    # a quadratic power agrees with the density of the square it is made of
    power = power_density(
        lambda a: 0.5 * np.sum(np.abs(superposed(a, transfer)) ** 2, axis=1), matrix
    )
    np.testing.assert_allclose(power, expected.sum(axis=1), rtol=1e-12)
    with pytest.raises(ValueError, match="not negative"):
        spectral_matrix([Excitation("", np.ones(1), -1.0)], frequency, "none")


def oscillator(mass: float, damping: float, stiffness: float) -> Operators:
    one = sp.csr_matrix(np.ones((1, 1)))
    return dry_operators(
        stiffness=stiffness * one, mass=mass * one, free=np.ones(1, dtype=bool), displacements=1,
        loss={"dashpot": Lossy(damping * one, Viscous())},
    )  # fmt: skip


def test_mean_square_of_an_oscillator_is_the_closed_form() -> None:
    mass, damping, stiffness = 2.0, 0.3, 5e3
    operators = oscillator(mass, damping, stiffness)
    natural = np.sqrt(stiffness / mass) / (2.0 * np.pi)

    def density(frequency: FloatArray) -> FloatArray:
        transfer = np.array([1.0 / operators.at(2.0 * np.pi * f)[0, 0] for f in frequency])
        force = spectral_matrix([Excitation("white", np.ones(1), 7.0)], frequency, "none")
        return response_density(transfer[:, None], force)

    loss = np.array([damping / np.sqrt(stiffness * mass)])
    found = band_integral(density, (0.0, 1000.0 * natural), np.array([natural]), loss)
    assert found == pytest.approx(random_mean_square(7.0, damping, stiffness), rel=1e-6)


def test_white_noise_puts_the_same_power_into_any_oscillator_of_a_mass() -> None:
    # S/(4 m) whatever stiffness and damping
    mass, damping, stiffness = 2.0, 0.1, 3e3
    operators = oscillator(mass, damping, stiffness)
    natural = np.sqrt(stiffness / mass) / (2.0 * np.pi)

    def density(frequency: FloatArray) -> FloatArray:
        omega = 2.0 * np.pi * frequency
        x = np.array([[1.0 / operators.at(w)[0, 0]] for w in omega])
        force = spectral_matrix([Excitation("white", np.ones(1), 7.0)], frequency, "none")

        def power(a: AnyArray) -> FloatArray:
            return power_budget(operators, omega, a * x, np.ones(1)).dissipated

        return power_density(power, force)

    found = band_integral(density, (1e-6, 3000.0 * natural), np.array([natural]), np.array([1e-3]))
    assert found == pytest.approx(7.0 / (4.0 * mass), rel=1e-5)
