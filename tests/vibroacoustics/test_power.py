# SPDX-License-Identifier: LGPL-2.1-or-later
"""Powers and their balance."""

from functools import cache

import numpy as np
import pytest

from quietblade.typing import ComplexArray, FloatArray
from quietblade.vibroacoustics.excitation import pressure_force
from quietblade.vibroacoustics.power import (
    dissipated_by_region,
    injected_power,
    level,
    power_budget,
)
from verification.acoustics_models import harmonic_pressure, shell

OMEGA = 2.0 * np.pi * np.array([150.0, 400.0])


@cache
def loaded() -> tuple[FloatArray, ComplexArray]:
    """A load of three degrees on the shell, and its response."""
    model = shell()
    pressure = harmonic_pressure(0) + 2.0 * harmonic_pressure(1) - harmonic_pressure(2)
    load = model.operators.right_hand_side(pressure_force(model.fem, pressure, surface="wet"))
    return load, np.stack([model.forced_by_load(load, w) for w in OMEGA])


def test_injected_power_is_radiated_or_dissipated() -> None:
    load, response = loaded()
    budget = power_budget(shell().operators, OMEGA, response, load)
    assert np.all(budget.residual < 1e-8)
    np.testing.assert_allclose(budget.surface, budget.radiated, rtol=1e-8)
    for part in (budget.injected, budget.radiated, budget.dissipated):
        assert part.shape == OMEGA.shape
        assert np.all(part > 0.0)
    assert np.all(budget.dissipated > 0.01 * budget.injected)


def test_balance_sees_a_wrong_sign_of_a_coupling_block() -> None:
    load, response = loaded()
    operators = shell().operators
    wrong = response.copy()
    wrong[:, operators.blocks.psi] *= -1.0
    budget = power_budget(operators, OMEGA, wrong, load)
    assert np.all(np.abs(budget.surface / budget.radiated - 1.0) > 1.0)


def test_vectorised_and_single_frequency_agree() -> None:
    load, response = loaded()
    together = power_budget(shell().operators, OMEGA, response, load)
    for i, omega in enumerate(OMEGA):
        alone = power_budget(shell().operators, np.array(omega), response[i], load)
        for name in ("injected", "radiated", "surface", "dissipated"):
            assert getattr(alone, name) == pytest.approx(getattr(together, name)[i], rel=1e-12)


def test_loss_by_region_adds_up() -> None:
    load, response = loaded()
    parts = dissipated_by_region(shell().operators, OMEGA, response)
    whole = power_budget(shell().operators, OMEGA, response, load).dissipated
    np.testing.assert_allclose(sum(parts.values()), whole, rtol=1e-12)


def test_injected_power_of_a_known_oscillator() -> None:
    # u = F/(k - w^2 m + i w d): 1/2 |F|^2 w^2 d / |..|^2 with a force that has a phase.
    force = np.array([2.0 + 1.0j])
    omega = np.array(3.0)
    stiffness = 5.0 - 9.0 * 0.4 + 1j * 3.0 * 0.7
    expected = 0.5 * abs(force[0]) ** 2 * 9.0 * 0.7 / abs(stiffness) ** 2
    assert injected_power(force, omega, force / stiffness) == pytest.approx(expected, rel=1e-14)


def test_level_in_decibels() -> None:
    np.testing.assert_allclose(
        level(np.array([1e-12, 1e-6, 2e-12])), [0.0, 60.0, 3.0103], atol=1e-5
    )
    assert np.all(np.isnan(level(np.array([0.0, -1.0]))))
