# SPDX-License-Identifier: LGPL-2.1-or-later
"""Krylov vectors, reduced sweep and its certificate against dense solutions."""

from dataclasses import dataclass

import numpy as np
import pytest

from quietblade.errors import ConvergenceError
from quietblade.linalg import make_solver
from quietblade.materials.viscoelastic import FractionalZener
from quietblade.typing import FloatArray
from quietblade.vibroacoustics.complex_modes import complex_modes
from quietblade.vibroacoustics.krylov import krylov_vectors, taylor_coefficients
from quietblade.vibroacoustics.modes import wet_modes
from quietblade.vibroacoustics.operators import Operators
from quietblade.vibroacoustics.peaks import find_peaks
from quietblade.vibroacoustics.power import level, power_budget
from quietblade.vibroacoustics.projection import Projection
from quietblade.vibroacoustics.reduced import ReducedSweep, reduce_system
from tests.vibroacoustics.small_systems import random_operators
from verification.acoustics_damping import wide_band_error

BAND = (3.0, 9.0)
GRID = np.linspace(*BAND, 61)


def a_load(operators: Operators, seed: int = 1) -> FloatArray:
    load = np.zeros(operators.size)
    load[operators.blocks.u] = np.random.default_rng(seed).standard_normal(len(operators.blocks.u))
    return load


def reduced(operators: Operators, tolerance: float = 1e-3) -> ReducedSweep:
    solver = make_solver(precision="double", tolerance=1e-12)
    return reduce_system(operators, a_load(operators), GRID, tolerance=tolerance, solver=solver)


def direct(operators: Operators, frequency: FloatArray) -> FloatArray:
    load = a_load(operators)
    omega = 2.0 * np.pi * frequency
    x = np.array([np.linalg.solve(operators.at(w).toarray(), load) for w in omega])
    return np.asarray(level(power_budget(operators, omega, x, load).radiated))


def test_series_of_a_rational_function() -> None:
    pole = 30.0 + 40.0j
    series = taylor_coefficients(lambda w: {"one": 1.0, "pole": 1.0 / (w - pole)}, 10.0 + 0j, 8)
    np.testing.assert_allclose(series["one"], [1.0, *8 * [0.0]], atol=1e-9)
    exact = [-(10.0**k) / (pole - 10.0) ** (k + 1) for k in range(9)]
    np.testing.assert_allclose(series["pole"], exact, rtol=1e-9, atol=1e-11)


def test_vectors_are_orthonormal_and_hold_the_solution() -> None:
    operators = random_operators()
    omega, load = 2.0 * np.pi * 5.0 * (1 + 0.02j), a_load(operators)
    factor = make_solver(precision="double").factor(operators.at(omega))
    pairs = zip(range(12), krylov_vectors(operators, omega, factor, load), strict=False)
    basis = np.array([vector for _, vector in pairs])
    np.testing.assert_allclose(basis.conj() @ basis.T, np.eye(12), atol=1e-10)
    x = factor.solve(load.astype(complex))
    assert np.linalg.norm(x - (basis.conj() @ x) @ basis) < 1e-10 * np.linalg.norm(x)


def test_space_ends_when_it_is_complete() -> None:
    operators = random_operators(n_u=5, n_p=1, n_psi=5)
    omega = 2.0 * np.pi * 5.0 * (1 + 0.02j)
    factor = make_solver(precision="double").factor(operators.at(omega))
    assert len(list(krylov_vectors(operators, omega, factor, a_load(operators)))) <= 11


@pytest.mark.parametrize("seed", range(3))
def test_reduced_sweep_agrees_with_dense_solutions(seed: int) -> None:
    operators = random_operators(seed, loss=0.01)
    sweep = reduced(operators)
    held_out = np.linspace(*BAND, 40)[1:-1] + 0.013
    error = np.abs(
        level(sweep.model.radiated(2.0 * np.pi * held_out)) - direct(operators, held_out)
    )
    assert error.max() < 1e-3
    # the estimate is that of a smaller model's error, so it bounds the larger one's
    assert np.all(error <= sweep.estimate(held_out) + 1e-9)
    assert sweep.certificate.factorizations == 1
    assert sweep.certificate.estimate.max() <= 1e-3
    assert sweep.certificate.size == sweep.model.size < operators.size
    assert sweep.model.residual(2.0 * np.pi * 6.0) < 1e-3
    assert sweep.model.budget(2.0 * np.pi * GRID).residual.max() < 1e-8


def test_projected_terms_are_those_of_the_columns() -> None:
    operators = random_operators(3)
    rng = np.random.default_rng(0)
    space = Projection(operators)
    parts = rng.standard_normal((5, 2, operators.size))
    vectors = parts[:, 0] + 1j * parts[:, 1]
    vectors[3] = vectors[1] * (2.0 - 1j)  # nothing new
    vectors[4, operators.blocks.u] = 0.0  # new in water and pressure only
    space.extend(vectors[:2])
    space.extend(vectors[2:])
    columns = space.lift(np.eye(space.size))
    for name, term in space.terms.items():
        dense = columns @ operators.terms[name].toarray() @ columns.T
        np.testing.assert_allclose(term, dense, atol=1e-12 * np.abs(dense).max())
    solid, water, _ = space.places
    assert (len(solid), len(water)) == (6, 8)  # the last one has no mass
    mass = columns[solid] @ operators.terms["M"].toarray() @ columns[solid].T
    np.testing.assert_allclose(mass, np.eye(6), atol=1e-12)
    omega = np.array([20.0, 50.0 + 1.0j])
    for matrix, w in zip(space.at_each(omega, 5), omega, strict=True):
        dense = columns[:5] @ operators.at(w).toarray() @ columns[:5].T
        np.testing.assert_allclose(matrix, dense, atol=1e-10 * np.abs(dense).max())


def test_reduced_model_is_passive() -> None:
    sweep = reduced(random_operators(loss=0.0), tolerance=10.0)  # far from converged
    budget = sweep.model.budget(2.0 * np.pi * np.linspace(1.0, 100.0, 200))
    assert np.all(budget.radiated >= 0.0)


@dataclass(frozen=True)
class Rational:
    """A condition that is not a polynomial of omega."""

    name: str = "rational"
    boundary: str = ""

    def factors(self, omega: complex, sound_speed: float, radius: float) -> dict[str, complex]:
        s = 1j * omega * radius / sound_speed
        return {"Q": -(s * s / (s + 0.05)) * sound_speed / radius}


def test_factors_that_are_not_polynomial() -> None:
    base = random_operators(4)
    operators = Operators(
        base.terms, base.blocks, base.free, base.first_potential, base.sound_speed, base.density,
        base.radius, condition=Rational(), moduli=base.moduli,
    )  # fmt: skip
    sweep = reduced(operators)
    held_out = np.linspace(*BAND, 20)
    error = level(sweep.model.radiated(2.0 * np.pi * held_out)) - direct(operators, held_out)
    assert np.abs(error).max() < 1e-3
    assert sweep.model.budget(2.0 * np.pi * held_out).residual.max() < 1e-8


def test_another_factorisation_where_the_first_does_not_reach() -> None:
    operators = random_operators(loss=0.01)
    solver = make_solver(precision="double")
    sweep = reduce_system(
        operators, a_load(operators), np.linspace(1.0, 60.0, 60), tolerance=1e-3, solver=solver,
        most_vectors=10, most_factorizations=8,
    )  # fmt: skip
    assert sweep.certificate.factorizations > 1
    with pytest.raises(ConvergenceError, match=r"Hz after 5 vectors from 1 factorisations"):
        reduce_system(
            operators, a_load(operators), GRID, tolerance=1e-9, solver=solver, most_vectors=5,
            most_factorizations=1,
        )  # fmt: skip
    with pytest.raises(ValueError, match="positive"):
        reduce_system(operators, a_load(operators), np.zeros(3), solver=solver)


def test_peaks_are_maxima_with_their_half_power_width() -> None:
    operators = random_operators(loss=0.004)
    sweep = reduced(operators, 1e-4)
    peaks = find_peaks(sweep, BAND)
    fine = np.linspace(*BAND, 3001)
    power = sweep.model.radiated(2.0 * np.pi * fine)
    tops = fine[1:-1][(power[1:-1] > power[:-2]) & (power[1:-1] > power[2:])]
    assert len(tops) > 0
    np.testing.assert_allclose(peaks.frequency, tops, atol=fine[1] - fine[0])
    for frequency, power, width in zip(peaks.frequency, peaks.power, peaks.width, strict=True):
        near = frequency * (1.0 + np.linspace(-1e-4, 1e-4, 21))
        assert sweep.model.radiated(2.0 * np.pi * near).max() <= power * (1 + 1e-9)
        if np.isfinite(width):
            around = np.linspace(frequency - width, frequency + width, 4001)
            above = around[sweep.model.radiated(2.0 * np.pi * around) >= 0.5 * power]
            assert above[-1] - above[0] == pytest.approx(width, rel=2e-3)


def test_modes_that_climb_to_one_top_make_one_peak() -> None:
    sweep = reduced(random_operators(11, loss=0.1), 1.0)
    middle = float(np.mean(BAND))
    peaks = find_peaks(sweep, BAND, lambda omega: 1.0 / (1.0 + (omega / np.pi / middle - 2.0) ** 2))
    assert len(sweep.model.light_modes(BAND)[0]) > 1
    np.testing.assert_allclose(peaks.frequency, [middle], rtol=1e-6)


def test_complex_modes_start_from_the_reduced_space() -> None:
    operators = random_operators(2, loss=0.02)
    modes = wet_modes(operators, 1.5 * BAND[1], solver=make_solver(precision="double"))
    sweep = reduced(operators)
    solver = make_solver(precision="double")
    plain = complex_modes(operators, modes, BAND, solver=solver)
    from_space = complex_modes(
        operators, modes, BAND, solver=solver, space=sweep.model.space, factor=sweep.factor
    )
    assert from_space.converged.all()
    np.testing.assert_allclose(from_space.omega, plain.omega, rtol=1e-8)


def test_one_factor_serves_the_modes_of_a_wide_band() -> None:
    operators = random_operators(3, loss=0.02)
    band = (2.0, 25.0)  # far more than an octave on either side of the factor
    solver = make_solver(precision="double", tolerance=1e-12)
    modes = wet_modes(operators, band[1], solver=solver)
    sweep = reduce_system(
        operators, a_load(operators), np.linspace(*band, 30), tolerance=1.0, solver=solver
    )
    found = complex_modes(
        operators, modes, band, solver=solver, space=sweep.model.space, factor=sweep.factor
    )
    plain = complex_modes(operators, modes, band, solver=solver)
    both = found.converged & plain.converged
    assert np.mean(both) > 0.9
    np.testing.assert_allclose(found.omega[both], plain.omega[both], rtol=1e-7)


def test_band_without_a_resonance_in_any_order() -> None:
    operators = random_operators()
    solver = make_solver(precision="double", tolerance=1e-12)
    frequency = np.array([1.2, 1.0, 1.0, 1.1])
    sweep = reduce_system(operators, a_load(operators), frequency, solver=solver)
    assert len(sweep.model.light_modes((1.0, 1.2))[0]) == 0
    assert len(find_peaks(sweep, (1.0, 1.2)).frequency) == 0
    assert sweep.model.radiated(np.zeros(0)).shape == (0,)
    found = level(sweep.model.radiated(2.0 * np.pi * frequency))
    np.testing.assert_allclose(found, direct(operators, frequency), atol=0.01)


@pytest.mark.parametrize("factor", [0.0, np.nan])
def test_load_without_a_meaning_is_refused(factor: float) -> None:
    operators = random_operators()
    with pytest.raises(ValueError, match="zero or not finite"):
        reduce_system(operators, factor * a_load(operators), GRID)


@pytest.mark.parametrize("band", [(50.0, 3000.0), (0.0, 400.0), (330.0, 350.0)])
def test_modes_of_any_band_have_the_moduli_of_their_own_frequency(
    band: tuple[float, float],
) -> None:
    assert wide_band_error(FractionalZener(1.4, 1e-3, 0.6), band) < 1e-9


@pytest.mark.parametrize("band", [(200.0, 100.0), (-1.0, 100.0), (0.0, 0.0)])
def test_what_is_not_a_band_is_refused(band: tuple[float, float]) -> None:
    with pytest.raises(ValueError, match="not a band"):
        wide_band_error(FractionalZener(1.4, 1e-3, 0.6), band)
