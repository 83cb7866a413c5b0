# SPDX-License-Identifier: LGPL-2.1-or-later
"""Flow damping of a section."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from quietblade.flow.unsteady import (
    SLOWEST,
    damping_per_length,
    section_force,
    theodorsen_function,
)


def test_theodorsen_function_of_the_report() -> None:
    # NACA Report 496, table of F and G
    k = np.array([0.1, 0.5, 1.0, 4.0])
    expected = [0.8319 - 0.1723j, 0.5979 - 0.1507j, 0.5394 - 0.1003j, 0.5037 - 0.0305j]
    np.testing.assert_allclose(theodorsen_function(k), expected, atol=1.5e-4)
    assert abs(theodorsen_function(np.array([1e-6]))[0] - 1.0) < 1e-4


def test_fast_limit_is_reached_where_it_is_said() -> None:
    k = np.array([SLOWEST, 5.0, 20.0])
    assert np.all(np.abs(theodorsen_function(k).real / 0.5 - 1.0) < 0.04)


@given(
    re=st.floats(0.1, 1.0), im=st.floats(-1.0, 1.0), pitch=st.floats(-3.0, 3.0),
    speed=st.floats(1.0, 10.0),
)  # fmt: skip
def test_power_lost_to_a_fast_stream(re: float, im: float, pitch: float, speed: float) -> None:
    chord, density, omega = 0.16, 1000.0, 1e5  # k > 800: the limit to a per mille
    heave, angle = complex(re, im) * 1e-3, complex(pitch, -im) * 1e-2
    lift, moment = section_force(heave, angle, omega, chord, speed, density)
    given_up = -0.5 * (lift * np.conj(1j * omega * heave) + moment * np.conj(1j * omega * angle))
    velocity = 1j * omega * (heave - 0.25 * chord * angle)  # at three quarters of the chord
    damping = float(damping_per_length(chord, speed, density))
    size = density * speed * chord * omega**2 * (abs(heave) + chord * abs(angle)) ** 2
    assert given_up.real == pytest.approx(0.5 * damping * abs(velocity) ** 2, abs=2e-3 * size)
