# SPDX-License-Identifier: LGPL-2.1-or-later
"""What has no meaning is refused with a reason, not computed."""

from collections.abc import Callable

import numpy as np
import pytest

from quietblade.errors import MaterialError
from quietblade.materials.viscoelastic import ArrheniusShift, ConstantLoss, Shifted, WlfShift
from quietblade.vibroacoustics import Dtn, Multipoles, Water, directivity
from quietblade.vibroacoustics.bands import band_mean
from quietblade.vibroacoustics.directivity import plane_directions
from quietblade.vibroacoustics.dtn import dtn_degree
from quietblade.vibroacoustics.modes import dry_modes
from tests.vibroacoustics.small_systems import random_operators

WATER = Water(1025.0, 1490.0)
MONOPOLE = Multipoles(
    np.array([0.3, 0.0, -2.0]), np.array([700.0]), np.ones((1, 1), dtype=complex), WATER, 0.5
)
ONE = np.ones((1, 3))


@pytest.mark.parametrize(
    ("call", "reason"),
    [
        (lambda: Water(-1.0, 1500.0), "density"),
        (lambda: Water(1000.0, 0.0), "sound speed"),
        (lambda: Dtn(-1), "degree"),
        (lambda: Dtn(2.5), "degree"),  # type: ignore[arg-type]
        (lambda: dtn_degree(1.0, 0.5, 0.0), "accuracy"),
        (lambda: dtn_degree(float("nan"), 0.5), "ka"),
        (lambda: directivity(MONOPOLE, 0.0 * ONE), "without length"),
        (lambda: directivity(MONOPOLE, ONE, -2.0), "inside the ball"),
        (lambda: directivity(MONOPOLE, ONE, 0.2), "inside the ball"),
        (lambda: plane_directions((0.0, 0.0, 0.0), 4), "normal"),
        (lambda: band_mean(np.array([1.0, 2.0]), np.ones(2), (2.0, 1.0)), "not a band"),
        (lambda: dry_modes(random_operators(), -5.0), "positive"),
    ],
)
def test_values_without_a_meaning(call: Callable[[], object], reason: str) -> None:
    with pytest.raises(ValueError, match=reason):
        call()


@pytest.mark.parametrize(
    ("call", "reason"),
    [
        (lambda: ArrheniusShift(1e5, 0.0).factor(300.0), "0 K must be positive"),
        (lambda: ArrheniusShift(1e5, 293.0).factor(1.0), "outside its range"),
        (lambda: WlfShift(17.4, 51.6, 293.0).factor(241.41), "outside its range"),
        (lambda: Shifted(ConstantLoss(0.1), 0.0), "must be positive"),
    ],
)
def test_temperatures_without_a_meaning(call: Callable[[], object], reason: str) -> None:
    with pytest.raises(MaterialError, match=reason):
        call()


def test_sound_of_a_monopole_off_the_origin_in_salt_water() -> None:
    far = directivity(MONOPOLE, np.array([[0.0, 0.0, 3.0], [1.0, -1.0, 0.2]]), 7.0)
    np.testing.assert_allclose(far.index, 0.0, atol=1e-12)
    # p r = rho c a / sqrt(4 pi) of the harmonic of degree 0
    expected = WATER.density * WATER.sound_speed / np.sqrt(4.0 * np.pi)
    np.testing.assert_allclose(np.abs(far.product), expected, rtol=1e-12)
