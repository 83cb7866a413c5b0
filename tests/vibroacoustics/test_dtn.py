# SPDX-License-Identifier: LGPL-2.1-or-later
"""The exact condition: coefficients, degree, its place in the system, passivity."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse import csr_matrix
from scipy.special import spherical_jn, spherical_yn

from quietblade.linalg import make_solver
from quietblade.vibroacoustics.complex_modes import complex_modes
from quietblade.vibroacoustics.dtn import Dtn, dtn_coefficients, dtn_degree, fitted_dtn
from quietblade.vibroacoustics.farfield import (
    degree_error,
    degree_notices,
    near_field_tail,
    sphere_waves,
)
from quietblade.vibroacoustics.harmonics import outgoing
from quietblade.vibroacoustics.modes import wet_modes
from quietblade.vibroacoustics.power import power_budget, radiated_power
from quietblade.vibroacoustics.radiation import Bgt1
from quietblade.vibroacoustics.sweep import solve_response
from verification.acoustics_closed_forms import moving_sphere
from verification.acoustics_models import LOSSY, WATER, SphereModel, layered_mesh

OUTER, DEGREE = 0.65, 4


@cache
def close() -> SphereModel:
    """Shell with loss in a sphere of water that is close."""
    mesh = layered_mesh((0.4, 0.5, OUTER), (0.3, 0.16, 0.2), 0.5)
    return SphereModel(mesh, 0.5, OUTER, {"blade": LOSSY}, condition=Dtn(DEGREE, 0.5 / OUTER))


@given(st.integers(0, 8), st.floats(1e-2, 30.0))
def test_coefficients_are_those_of_hankel_functions(degree: int, z: float) -> None:
    degrees = np.arange(degree + 1)
    h = spherical_jn(degrees, z) - 1j * spherical_yn(degrees, z)
    slope = spherical_jn(degrees, z, True) - 1j * spherical_yn(degrees, z, True)
    found = dtn_coefficients(degree, z)
    np.testing.assert_allclose(found, -z * slope / h, rtol=1e-12)
    np.testing.assert_allclose(found.imag, 1.0 / (z * np.abs(h) ** 2), rtol=1e-11)
    assert np.all(found.imag > 0.0)


def test_coefficients_at_rest_and_off_the_real_line() -> None:
    np.testing.assert_array_equal(dtn_coefficients(5, 0.0), np.arange(1, 7))
    # l = 1: R d = 1 + (1 + ...)/..., h_1 = -(z - i) exp(-iz)/z^2 up to a constant.
    z = 1.3 - 0.2j
    expected = 2.0 + 1j * z + (-1.0 / (1.0 + 1j * z)) * 1j * z
    assert dtn_coefficients(1, z)[1] == pytest.approx(expected, rel=1e-13)
    step = 1e-5
    along = (dtn_coefficients(6, z + step) - dtn_coefficients(6, z - step)) / (2.0 * step)
    across = (dtn_coefficients(6, z + 1j * step) - dtn_coefficients(6, z - 1j * step)) / (2j * step)
    np.testing.assert_allclose(along, across, rtol=1e-6)


def test_degree_grows_with_size_frequency_and_accuracy() -> None:
    by_size = [dtn_degree(0.4, q) for q in (0.5, 0.7, 0.8)]
    by_frequency = [dtn_degree(ka, 0.5) for ka in (0.5, 3.0, 10.0)]
    by_accuracy = [dtn_degree(0.4, 0.75, e) for e in (1e-2, 1e-3, 1e-4)]
    for values in (by_size, by_frequency, by_accuracy):
        assert values[0] < values[1] < values[2]
    assert by_frequency[2] > 10
    with pytest.raises(ValueError, match="must lie inside"):
        dtn_degree(0.4, 1.0)
    with pytest.raises(ValueError, match="needs more than 30 degrees; use a larger sphere"):
        dtn_degree(0.4, 0.97)


def test_fitted_degree_measures_the_body() -> None:
    fitted = fitted_dtn(close().fem, 200.0, sound_speed=1500.0, radius=OUTER, wetted="wet")
    assert fitted.size_ratio == pytest.approx(0.5 / OUTER, rel=1e-3)
    assert fitted.degree == dtn_degree(0.5 * 2.0 * np.pi * 200.0 / 1500.0, 0.5 / OUTER)


def test_auxiliary_unknowns_stand_for_the_low_rank_terms() -> None:
    operators, omega = close().operators, 900.0
    rng = np.random.default_rng(3)
    m, n = len(operators.blocks.harmonics), len(operators.free)
    assert (m, operators.size) == ((DEGREE + 1) ** 2, n + (DEGREE + 1) ** 2)
    matrix = operators.at(omega)
    assert abs(matrix - matrix.T).max() == 0.0
    # Eliminate them: A + sum g Y Y^T.
    x = rng.standard_normal(n) + 1j * rng.standard_normal(n)
    whole = matrix[:n][:, :n] @ x
    factors = operators.factors(omega)
    bordered = np.concatenate([x, np.zeros(m)])
    energy = np.vdot(x, whole)
    for degree in range(DEGREE + 1):
        own = n + np.arange(degree**2, (degree + 1) ** 2)
        load = operators.terms[f"Y{degree}"][:n][:, own]
        bordered[own] = load.T @ x
        whole = whole + factors[f"Y{degree}"] * (load @ (load.T @ x))
        energy += factors[f"Y{degree}"] * np.sum(np.abs(load.T @ x) ** 2)
    product = matrix @ bordered
    np.testing.assert_allclose(product[:n], whole, rtol=1e-10, atol=1e-10 * np.abs(whole).max())
    np.testing.assert_allclose(product[n:], 0.0, atol=1e-10 * np.abs(whole).max())
    assert np.vdot(bordered, product) == pytest.approx(energy, rel=1e-10)


@pytest.mark.parametrize("kr", [0.3, 3.0])
def test_power_of_a_moving_sphere(kr: float) -> None:
    omega = kr / OUTER * WATER.sound_speed
    response = close().forced_by_motions((0, 1, 2), omega)
    at = np.full(3, omega)
    waves = sphere_waves(close().operators, at, response)
    for degree in range(3):
        exact = moving_sphere(degree, kr / OUTER, 0.5, OUTER, 1.0, None)
        power = waves.power_by_degree[degree, degree]
        assert power == pytest.approx(exact.power(WATER.density, omega), rel=2e-2)
    np.testing.assert_allclose(
        waves.power, radiated_power(close().operators, at, response), rtol=1e-12
    )
    # The amplitudes are those of the closed form: P_l = sqrt(4 pi/(2 l + 1)) Y_l0.
    exact = moving_sphere(1, kr / OUTER, 0.5, OUTER, 1.0, None).outgoing
    assert waves.amplitudes[1, 2] == pytest.approx(exact * np.sqrt(4.0 * np.pi / 3.0), rel=1e-2)
    assert outgoing(1, np.array([kr]))[0] != 0.0


@settings(max_examples=8, deadline=None)
@given(st.integers(0, 2**31), st.sampled_from([40.0, 300.0, 900.0]))
def test_no_force_draws_power_from_the_sphere(seed: int, frequency: float) -> None:
    operators, rng = close().operators, np.random.default_rng(seed)
    u, omega = operators.blocks.u, 2.0 * np.pi * frequency
    load = np.zeros(operators.size, dtype=complex)
    load[u] = rng.standard_normal(len(u)) + 1j * rng.standard_normal(len(u))
    response = factored(frequency).solve(load)
    budget = power_budget(operators, np.array(omega), response, load)
    assert budget.radiated >= 0.0
    assert budget.dissipated >= 0.0
    assert budget.residual < 1e-8
    assert budget.surface == pytest.approx(budget.radiated, rel=1e-8)


@cache
def factored(frequency: float):  # type: ignore[no-untyped-def]
    return make_solver(precision="double").factor(close().operators.at(2.0 * np.pi * frequency))


def test_sweep_and_modes_take_the_auxiliary_unknowns() -> None:
    operators = close().operators
    load = np.zeros(operators.size)
    load[operators.blocks.u] = close().radial_motion(2)
    response = solve_response(operators, np.array([250.0]), load)
    assert response.solution is not None
    assert response.solution.shape == (1, operators.size)
    modes = wet_modes(operators, 600.0)
    oval = modes.frequency[6:11]
    assert oval == pytest.approx(oval[0], rel=0.05)
    damped = complex_modes(operators, modes, (oval[0] - 1.0, oval[-1] + 1.0))
    assert np.all(damped.converged)
    assert np.all(damped.loss_factor > 0.9 * LOSSY.loss)


def test_static_exterior_is_exact_to_the_degree() -> None:
    # Added mass of P_l on a sphere in infinite water: rho a 4 pi a^2 / ((2 l + 1) (l + 1)).
    operators = close().operators
    assert operators.exterior is not None
    water = operators.blocks.water
    inner = csr_matrix((operators.terms["H"] + operators.exterior)[water][:, water])
    factor = make_solver(precision="double").factor(inner)
    for degree in range(4):
        motion = close().radial_motion(degree)
        flux = operators.terms["C"][water][:, operators.blocks.u] @ motion
        exact = 4.0 * np.pi * 1000.0 * 0.125 / ((2 * degree + 1) * (degree + 1))
        assert flux @ factor.solve(flux) == pytest.approx(exact, rel=2e-2)


def test_too_low_a_degree_is_noticed() -> None:
    omega = np.array([600.0])
    driven = close().forced_by_motions((4,), 600.0)
    operators = close().operators
    assert near_field_tail(operators, driven)[0] == pytest.approx(1.0, abs=1e-2)
    (notice,) = degree_notices(operators, omega, driven)
    assert "its degree, 4, is too low" in notice.message
    assert degree_error(operators, omega, driven)[0] > 1e-2
    dipole = close().forced_by_motions((1,), 600.0)
    assert degree_notices(operators, omega, dipole) == []
    local = replace(close(), condition=Bgt1())
    with pytest.raises(ValueError, match="need the condition DtN, not BGT-1"):
        sphere_waves(local.operators, omega, local.forced_by_motions((1,), 600.0))
