# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pressure at points, directivity, levels, efficiency, and what approximate conditions cost."""

import numpy as np
import pytest

from quietblade.vibroacoustics.directivity import (
    directivity,
    plane_directions,
    pressure_level,
    source_level,
)
from quietblade.vibroacoustics.fluid import normal_motion_matrix
from quietblade.vibroacoustics.multipoles import Multipoles
from quietblade.vibroacoustics.power import level, radiated_power, radiation_efficiency
from quietblade.vibroacoustics.radiation import Bgt1, Bgt2
from quietblade.vibroacoustics.radiation_check import (
    estimated_error,
    power_ratio,
    radiation_notices,
)
from verification import acoustics_closed_forms as closed
from verification.acoustics_models import WATER, ball

OMEGA = 1500.0


def wave(*amplitudes: float, omega: float = OMEGA) -> Multipoles:
    """Waves about a point with given amplitudes, in order of (l, m)."""
    values = np.array([amplitudes], dtype=complex)
    return Multipoles(np.array([0.1, 0.0, 0.0]), np.array([omega]), values, WATER, 0.5)


def test_pressure_at_points_by_waves_and_by_the_surface() -> None:
    model = ball()
    response = model.forced_by_motion(1, OMEGA)[None]
    waves = model.sources.multipoles(np.array([OMEGA]), response)
    points = np.array([[0.0, 0.2, 0.9], [0.3, 0.0, 1.5], [3.0, -1.0, 2.0]])
    by_waves = waves.pressure(points)
    np.testing.assert_allclose(
        model.sources.pressure(np.array([OMEGA]), response, points), by_waves, rtol=5e-3
    )
    # The singular part A - B of the closed form with the reflected wave.
    field = closed.moving_sphere(1, 1.0, 0.5, 1.0, 1.0)
    strength = field.outgoing - field.incoming
    r = np.linalg.norm(points, axis=1)
    exact = [
        -1j * OMEGA * 1000.0 * strength * closed.h2(1, x) * z / x
        for x, z in zip(r, points[:, 2], strict=True)
    ]
    np.testing.assert_allclose(by_waves[0], exact, rtol=1e-2)
    with pytest.raises(ValueError, match="inside the ball"):
        waves.pressure(np.array([[0.0, 0.0, 0.3]]))


def test_far_field_is_the_limit_of_the_pressure() -> None:
    waves = wave(0.3, 1.0, -0.4, 0.2, 0.1, 0.0, 0.5, 0.0, 0.0)
    _, directions = plane_directions((1.0, 2.0, 0.5), 7)
    far, near = directivity(waves, directions), directivity(waves, directions, 1e4)
    np.testing.assert_allclose(near.product, far.product, rtol=2e-3)
    np.testing.assert_allclose(near.level, far.level, atol=0.01)
    np.testing.assert_allclose(near.index, far.index, atol=0.01)
    np.testing.assert_allclose(np.linalg.norm(directions, axis=1), 1.0)
    np.testing.assert_allclose(directions @ [1.0, 2.0, 0.5], 0.0, atol=1e-12)


def test_directivity_of_a_monopole_and_of_a_dipole() -> None:
    axes = 2.0 * np.eye(3)
    alone = wave(0.7)
    found = directivity(alone, axes)
    np.testing.assert_allclose(found.index, 0.0, atol=1e-12)
    np.testing.assert_allclose(found.level, source_level(alone.power, WATER)[0], atol=1e-9)
    dipole = directivity(wave(0.0, 0.0, 1.0, 0.0), axes, 1.0)
    assert dipole.index[0, 2] == pytest.approx(10.0 * np.log10(3.0), abs=1e-9)
    assert dipole.index[0, 0] < -100.0
    np.testing.assert_allclose(wave(0.0, 0.0, 2.0, 0.0).share, [[0.0, 1.0]])


def test_levels() -> None:
    assert pressure_level(np.array([np.sqrt(2.0)]))[0] == pytest.approx(120.0)
    power = np.array([1e-12, 3e-6, -1.0])
    np.testing.assert_allclose(
        source_level(power, WATER)[:2], level(power)[:2] + 50.7688, atol=1e-3
    )
    assert np.isnan(source_level(power, WATER)[2])
    with pytest.raises(ValueError, match="parallel"):
        plane_directions((0.0, 0.0, 1.0), 4, (0.0, 0.0, 3.0))


def test_radiation_efficiency_of_a_pulsating_sphere() -> None:
    model = ball()
    response = model.forced_by_motion(0, OMEGA)
    squared = normal_motion_matrix(model.fem, "wet")
    omega = np.array(OMEGA)
    power = radiated_power(model.operators, omega, response)
    found = radiation_efficiency(model.operators, squared, omega, response, power)
    assert found == pytest.approx(0.25 / 1.25, rel=5e-3)  # (ka)^2/(1 + (ka)^2) at ka = 0.5


@pytest.mark.parametrize("kr", [0.25, 1.0, 3.0])
def test_ratios_of_the_conditions(kr: float) -> None:
    for condition, form in ((Bgt1(), closed.bgt1), (Bgt2(), closed.bgt2)):
        expected = [closed.power_ratio(n, kr, form) for n in range(4)]
        np.testing.assert_allclose(power_ratio(condition, 3, kr), expected, rtol=1e-5)


def test_size_of_the_error_is_in_the_notice() -> None:
    dipole = wave(0.0, 0.0, 1.0, 0.0, omega=0.5 * 1500.0)
    assert estimated_error(Bgt1(), 1.0, dipole)[0] == pytest.approx(9.70, abs=0.01)
    (notice,) = radiation_notices(Bgt1(), 1.0, dipole)
    assert notice.value == pytest.approx(9.70, abs=0.01)
    assert radiation_notices(Bgt1(), 12.0, dipole) == []
    assert radiation_notices(Bgt2(), 1.0, dipole) == []
    quadrupole = wave(0, 0, 1.0, 0, 0, 0, 1e-1, 0, 0, omega=0.5 * 1500.0)
    active, wrong = radiation_notices(Bgt2(), 1.0, quadrupole)
    assert "degree 2 and higher ones feed power in" in active.message
    assert active.value is not None
    assert active.value < 0.0
    assert wrong.limit == 0.5


def test_estimate_of_the_error_is_the_error() -> None:
    model = ball()
    omega = np.array([1500.0, 2500.0])
    response = np.stack([model.forced_by_motion(1, w) for w in omega])
    waves = model.sources.multipoles(omega, response)
    through = radiated_power(model.operators, omega, response)
    np.testing.assert_allclose(
        estimated_error(Bgt1(), 1.0, waves), 10.0 * np.log10(through / waves.power), atol=0.02
    )
