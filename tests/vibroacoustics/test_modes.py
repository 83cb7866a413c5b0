# SPDX-License-Identifier: LGPL-2.1-or-later
"""Real and complex modes against dense eigenproblems."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg
import scipy.sparse as sp

from quietblade.errors import ConvergenceError, SolverError
from quietblade.linalg import make_solver
from quietblade.vibroacoustics.complex_modes import complex_modes
from quietblade.vibroacoustics.modes import (
    Pencil,
    dry_modes,
    solve_modes,
    unknowns,
    wet_modes,
    wet_pencil,
)
from quietblade.vibroacoustics.operators import Operators
from quietblade.vibroacoustics.projection import Projection, times

from .small_systems import condensed, random_operators


@pytest.mark.parametrize("water", [True, False])
@pytest.mark.parametrize("highest", [3.2, 25.0, 90.0])
def test_no_mode_is_missed(water: bool, highest: float) -> None:
    operators = random_operators()
    K, M = condensed(operators, water=water)
    exact = np.sqrt(scipy.linalg.eigh(K, M, eigvals_only=True)) / (2.0 * np.pi)
    exact = exact[exact < highest]
    modes = (wet_modes if water else dry_modes)(operators, highest)
    assert modes.count == len(exact) > 0
    np.testing.assert_allclose(modes.frequency, exact, rtol=1e-9)
    assert modes.residual.max() < 2e-6
    assert not modes.notices


def test_vectors_have_unit_modal_mass_and_satisfy_the_water() -> None:
    operators = random_operators()
    modes = wet_modes(operators, 50.0)
    _, M = condensed(operators, water=True)
    u = modes.vectors[:, operators.blocks.u]
    np.testing.assert_allclose(u @ M @ u.T, np.eye(modes.count), atol=1e-8)
    pencil = wet_pencil(operators)
    for frequency, x in zip(modes.frequency, modes.vectors, strict=True):
        s = (2.0 * np.pi * frequency) ** 2
        rest = pencil.at(s) @ x
        assert np.abs(rest).max() < 1e-7 * np.abs(pencil.inertia @ x).max() * s
    lost = np.einsum("ij,ij->i", modes.vectors, (operators.loss(1.0) @ modes.vectors.T).T)
    stored = np.einsum("ij,ij->i", modes.vectors, (operators.terms["K"] @ modes.vectors.T).T)
    np.testing.assert_allclose(modes.loss_factor, lost / stored, rtol=1e-6)


def test_chain_of_masses_in_closed_form() -> None:
    # fixed-free chain: omega_j = 2 sqrt(k/m) sin((2j - 1) pi / (2 (2n + 1)))
    n, k, m = 200, 5.0, 2.0
    main = np.full(n, 2.0)
    main[-1] = 1.0
    K = sp.csr_matrix(k * sp.diags([-np.ones(n - 1), main, -np.ones(n - 1)], [-1, 0, 1]))
    pencil = Pencil(K, sp.csr_matrix(m * sp.eye(n)), np.zeros(0, int), np.zeros(0, int))
    j = np.arange(1, n + 1)
    exact = 2.0 * np.sqrt(k / m) * np.sin((2 * j - 1) * np.pi / (2 * (2 * n + 1))) / (2.0 * np.pi)
    highest = 0.5 * (exact[29] + exact[30])
    modes = solve_modes(pencil, 0.1 * K, highest)
    assert modes.count == 30
    np.testing.assert_allclose(modes.frequency, exact[:30], rtol=1e-10)
    np.testing.assert_allclose(modes.loss_factor, 0.1, rtol=1e-8)


def test_limit_on_a_mode_and_no_modes() -> None:
    operators = random_operators()
    K, M = condensed(operators, water=True)
    first = float(np.sqrt(scipy.linalg.eigh(K, M, eigvals_only=True)[0]) / (2.0 * np.pi))
    assert wet_modes(operators, 0.9 * first).count == 0
    assert wet_modes(operators, 0.9 * first).vectors.shape == (0, operators.size)
    assert wet_modes(operators, first * (1.0 + 1e-9)).count == 1


def test_rigid_and_unstable_motions() -> None:
    operators = random_operators()
    K, M = condensed(operators, water=True)
    s = scipy.linalg.eigh(K, M, eigvals_only=True)
    shifted = dict(operators.terms)
    shifted["K"] = sp.csr_matrix(
        shifted["K"] - 0.5 * (s[0] + s[1]) * _inertia_of_displacement(operators)
    )
    modes = wet_modes(replace(operators, terms=shifted), 30.0)
    exact = s - 0.5 * (s[0] + s[1])
    assert modes.frequency[0] == pytest.approx(-np.sqrt(-exact[0]) / (2.0 * np.pi), rel=1e-8)
    (notice,) = modes.notices
    assert "unstable" in notice.message
    free = dict(operators.terms)
    free["K"] = sp.csr_matrix(free["K"] - s[0] * _inertia_of_displacement(operators))
    modes = wet_modes(replace(operators, terms=free), 30.0)
    assert abs(modes.frequency[0]) < 1e-3
    assert np.isnan(modes.loss_factor[0])
    assert not modes.notices


def _inertia_of_displacement(operators: Operators) -> sp.csr_matrix:
    _, M = condensed(operators, water=True)
    full = np.zeros((operators.size, operators.size))
    full[np.ix_(operators.blocks.u, operators.blocks.u)] = M
    return sp.csr_matrix(full)


def test_what_the_modes_cannot_do_is_said() -> None:
    operators = random_operators()
    with pytest.raises(SolverError, match="no inertia"):
        wet_modes(operators, 30.0, solver=make_solver("superlu"))
    with pytest.raises(ValueError, match="static exterior"):
        wet_modes(replace(operators, exterior=None), 30.0)
    with pytest.raises(ConvergenceError, match="too many"):
        wet_modes(operators, 1e4)


def dense_complex_modes(operators: Operators) -> np.ndarray:
    """Every Omega of the quadratic problem K_0 + Omega K_1 + Omega^2 K_2, by linearisation."""
    K0, plus, minus = (operators.at(omega).toarray() for omega in (0.0, 1.0, -1.0))
    K1, K2 = 0.5 * (plus - minus), 0.5 * (plus + minus) - K0
    n = len(K0)
    zero, one = np.zeros((n, n)), np.eye(n)
    values = scipy.linalg.eig(
        np.block([[zero, one], [-K0, -K1]]), np.block([[one, zero], [zero, K2]]), right=False
    )
    return np.asarray(values[np.isfinite(values) & (np.abs(values) < 1e6)])


@pytest.mark.parametrize("loss", [1e-4, 0.05, 0.4])
def test_complex_modes_are_those_of_the_dense_problem(loss: float) -> None:
    operators = random_operators(loss=loss)
    modes = wet_modes(operators, 45.0)
    found = complex_modes(operators, modes, (5.0, 30.0))
    assert len(found.omega) == 8
    assert found.converged.all()
    assert not found.notices
    assert found.residual.max() < 1e-8
    exact = dense_complex_modes(operators)
    error = np.abs(exact - found.omega[:, None]).min(axis=1) / np.abs(found.omega)
    assert error.max() < 1e-9
    assert len(np.unique(np.round(found.omega, 8))) == len(found.omega)
    assert (found.loss_factor > 0.0).all()
    for omega, x in zip(found.omega, found.vectors, strict=True):
        A = operators.at(omega)
        assert np.linalg.norm(A @ x) < 1e-6 * np.linalg.norm(abs(A) @ np.abs(x))
        slope = (operators.at(omega * 1.001) - operators.at(omega * 0.999)) / (0.002 * omega)
        assert x @ (slope @ x) == pytest.approx(-2.0 * omega, rel=1e-6)


def test_without_water_waves_and_loss_the_complex_modes_are_the_real_ones() -> None:
    operators = random_operators(loss=0.0)
    terms = dict(operators.terms)
    assert operators.exterior is not None
    terms["H"] = sp.csr_matrix(terms["H"] + operators.exterior)
    terms["G"], terms["Q"] = 0.0 * terms["G"], 0.0 * terms["Q"]
    modes = wet_modes(operators, 40.0)
    found = complex_modes(replace(operators, terms=terms), modes, (0.5, 40.0))
    np.testing.assert_allclose(found.frequency, modes.frequency[found.start], rtol=1e-9)
    assert np.abs(found.loss_factor).max() < 1e-9
    np.testing.assert_allclose(found.overlap, 1.0, rtol=1e-8)
    # unit modal mass too, up to the sign
    same = unknowns(modes, operators)[found.start]
    ratio = np.einsum("ij,ij->i", found.vectors, same.conj()) / np.einsum(
        "ij,ij->i", same, same.conj()
    )
    np.testing.assert_allclose(np.abs(ratio), 1.0, rtol=1e-6)


def test_modes_of_equal_frequency_stay_apart() -> None:
    # two copies of one system, uncoupled: each mode twice
    single = random_operators(loss=0.02)
    twice = {name: sp.block_diag([term, term]).tocsr() for name, term in single.terms.items()}
    n = single.size
    blocks = replace(
        single.blocks,
        **{
            name: np.concatenate([getattr(single.blocks, name), n + getattr(single.blocks, name)])
            for name in ("u", "p", "psi")
        },
    )
    double = replace(
        single,
        terms=twice,
        blocks=blocks,
        free=np.arange(2 * n),
        exterior=sp.csr_matrix(sp.block_diag([single.exterior, single.exterior])),
    )
    alone = complex_modes(single, wet_modes(single, 40.0), (1.0, 25.0))
    modes = wet_modes(double, 40.0)
    both = complex_modes(double, modes, (1.0, 25.0))
    assert both.converged.all()
    np.testing.assert_allclose(both.omega, np.repeat(alone.omega, 2), rtol=1e-9)
    gram = np.abs(both.vectors @ (double.terms["M"] @ both.vectors.conj().T))
    for i in range(0, len(both.omega), 2):
        assert gram[i, i + 1] ** 2 < 0.9 * gram[i, i] * gram[i + 1, i + 1]


def test_complex_modes_that_do_not_converge_are_flagged() -> None:
    operators = random_operators(loss=0.4)
    modes = wet_modes(operators, 40.0)
    found = complex_modes(operators, modes, (1.0, 30.0), iterations=1, tolerance=1e-13)
    assert not found.converged.all()
    assert any("did not converge" in notice.message for notice in found.notices)
    none = complex_modes(operators, modes, (1000.0, 2000.0))
    assert none.omega.shape == (0,)
    assert none.vectors.shape == (0, operators.size)


def test_projection_reproduces_what_it_holds() -> None:
    operators = random_operators()
    rng = np.random.default_rng(1)
    vectors = rng.standard_normal((5, operators.size)) + 1j * rng.standard_normal(
        (5, operators.size)
    )
    space = Projection(operators)
    space.extend(vectors)
    space.extend(vectors[:2])  # nothing new
    assert space.size == 20  # real and imaginary part, structure and water
    x = vectors[3]
    np.testing.assert_allclose(space.lift(space.coordinates(x)), x, atol=1e-10)
    omega = 7.0 + 0.3j
    y = space.coordinates(x)
    assert y @ space.at(omega) @ y == pytest.approx(x @ (operators.at(omega) @ x), rel=1e-9)
    other = space.copy()
    other.extend(rng.standard_normal((1, operators.size)))
    assert (other.size, space.size) == (22, 20)
    M = operators.terms["M"]
    np.testing.assert_allclose(times(M, x), M @ x)
