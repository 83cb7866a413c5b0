# SPDX-License-Identifier: LGPL-2.1-or-later
"""Damping by the stream."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from quietblade.flow.unsteady import damping_per_length
from quietblade.vibroacoustics.complex_modes import complex_modes
from quietblade.vibroacoustics.flow_damping import (
    add_stream,
    stream_loss,
    stream_notices,
    strip_motion,
)
from quietblade.vibroacoustics.loss_shares import loss_shares
from quietblade.vibroacoustics.modes import dry_modes
from quietblade.vibroacoustics.power import dissipated_by_region, power_budget
from verification.acoustics_plate import solve_all
from verification.acoustics_strip import StripInStream


@cache
def strip() -> StripInStream:
    return StripInStream()


def test_rigid_sections_are_read_exactly() -> None:
    model = strip()
    points = model.structure.basis.points
    for heave, pitch in ((1.0, 0.0), (0.0, 1.0), (0.3, -2.0)):
        moved = np.zeros_like(points)
        moved[:, 1] = heave + pitch * points[:, 0]
        moved[:, 0] = -pitch * points[:, 1] + 0.7  # the rest of the rotation, and a chordwise shift
        read = model.motion @ moved.T.ravel()
        np.testing.assert_allclose(read, heave + pitch * 0.25 * model.chord, rtol=1e-10)


def test_dashpots_take_what_the_limit_of_theodorsens_function_says() -> None:
    # a rigid heave of the whole plate: power 1/2 pi rho W b |v|^2 over the span
    model = strip()
    operators, basis = model.operators, model.structure.basis
    moved = np.zeros_like(basis.points)
    moved[:, 1] = 1.0
    x = np.zeros(operators.size, dtype=complex)
    full = basis.to_dofs(moved)
    strips = operators.blocks.strips
    x[operators.blocks.u] = full[operators.free[operators.blocks.u]]
    matrix = operators.terms["D stream"]
    x[strips] = matrix[strips][:, operators.blocks.u] @ x[operators.blocks.u]
    omega = np.array(20.0)
    found = dissipated_by_region(operators, omega, x)["stream"]
    per_length = damping_per_length(np.array([model.chord]), np.array([model.speed]), 1000.0)[0]
    expected = 0.5 * per_length * model.span * omega**2
    # the clamped nodes do not move: half a cell at the root is missing
    assert found == pytest.approx(expected, rel=0.05)


def test_bending_loses_w_over_b_omega() -> None:
    model = strip()
    modes = dry_modes(model.operators, 120.0)
    still = dry_modes(model.still, 120.0)
    np.testing.assert_allclose(modes.frequency, still.frequency, rtol=1e-9)
    ratio = stream_loss(model.operators, modes) / model.loss(modes.frequency)
    # bending, bending, edgewise, bending, and torsion: (b/2)^2 over b^2/3, within its warping
    np.testing.assert_allclose(ratio[[0, 1, 3]], 1.0, atol=0.015)
    assert ratio[2] < 1e-6
    assert ratio[4] == pytest.approx(0.75, rel=0.02)


def test_complex_modes_and_powers_with_a_slow_stream() -> None:
    model = replace(strip(), speed=0.05)
    operators = model.operators
    modes = dry_modes(operators, 120.0)
    damped = complex_modes(operators, modes, (1.0, 120.0), tolerance=1e-6)
    assert damped.converged.all()
    np.testing.assert_allclose(damped.loss_factor, stream_loss(operators, modes), rtol=2e-3)
    shares = loss_shares(operators, damped)
    np.testing.assert_allclose(shares["stream"], damped.loss_factor, rtol=1e-12)
    load = np.zeros((1, operators.size))
    load[0, operators.blocks.u[5]] = 1.0
    frequency = np.array([20.0, 70.0])
    x = solve_all(operators, frequency, load)[:, 0]
    budget = power_budget(operators, 2.0 * np.pi * frequency, x, load[0])
    assert budget.residual.max() < 1e-8
    assert np.all(budget.dissipated > 0.0)


def test_a_heavy_stream_still_converges() -> None:
    model = strip()  # loss factor of the first mode: 9
    modes = dry_modes(model.operators, 120.0)
    damped = complex_modes(model.operators, modes, (40.0, 120.0), tolerance=1e-6)
    assert damped.converged.all()
    assert np.all(damped.omega.imag > 0.0)


def test_slow_vibration_is_noticed() -> None:
    sections = strip().sections
    limit = 3.0 * 4.0 / 0.05 / (2.0 * np.pi)
    assert not stream_notices(sections, np.array([1.01 * limit, 200.0]))
    (notice,) = stream_notices(sections, np.array([200.0, 0.5 * limit]))
    assert notice.value == pytest.approx(1.5)
    assert not stream_notices(sections, np.zeros(0))


def test_what_is_refused() -> None:
    model = strip()
    with pytest.raises(ValueError, match="already"):
        add_stream(
            model.operators, model.structure.basis, model.sections, model.motion, model.density
        )
    points = model.structure.basis.points
    with pytest.raises(ValueError, match="too few nodes"):
        strip_motion(model.sections, points, points[:, 2], np.zeros(len(points)))
