# SPDX-License-Identifier: LGPL-2.1-or-later
"""Bands and limits."""

import numpy as np
import pytest

from quietblade.vibroacoustics.bands import Bands, Limit, band_mean


def test_decidecades_are_those_of_the_standard() -> None:
    bands = Bands.between(100.0, 200.0)
    np.testing.assert_allclose(bands.centre, [100.0, 125.893, 158.489, 199.526], atol=1e-3)
    np.testing.assert_allclose(bands.lower, [89.125, 112.202, 141.254, 177.828], atol=1e-3)
    np.testing.assert_allclose(bands.upper[:-1], bands.lower[1:], rtol=1e-12)
    np.testing.assert_allclose(bands.width, bands.upper - bands.lower)
    octaves = Bands.between(31.0, 4000.0, 1)
    np.testing.assert_allclose(octaves.centre[5], 1000.0)
    half = Bands.between(900.0, 1500.0, 2)
    np.testing.assert_allclose(half.lower[0], 1000.0)
    with pytest.raises(ValueError, match="positive frequencies in order"):
        Bands.between(200.0, 100.0)


def test_every_tone_is_in_one_band() -> None:
    rng = np.random.default_rng(4)
    bands = Bands.between(50.0, 500.0)
    frequency = rng.uniform(bands.lower[0], bands.upper[-1], 200)
    power = rng.random(200)
    assert bands.total(frequency, power).sum() == pytest.approx(power.sum())


def test_mean_of_simple_spectra() -> None:
    frequency = np.array([200.0, 90.0, 150.0, 100.0])
    assert band_mean(frequency, np.full(4, 3.0), (95.0, 180.0)) == pytest.approx(3.0)
    decay = np.exp(-0.05 * frequency)
    exact = (np.exp(-5.0) - np.exp(-9.0)) / 0.05 / 80.0
    assert band_mean(frequency, decay, (100.0, 180.0)) == pytest.approx(exact, rel=1e-9)
    assert band_mean(frequency, frequency - 150.0, (100.0, 200.0)) == pytest.approx(0.0, abs=1e-9)
    assert np.isnan(band_mean(frequency, decay, (80.0, 180.0)))
    means = Bands.between(100.0, 200.0).mean(frequency, decay)
    np.testing.assert_array_equal(np.isnan(means), [True, False, False, True])


def test_mean_of_a_needle() -> None:
    # Lorentzian of half-power width 0.1 Hz on the grid that the sweep makes.
    t = np.linspace(-9.0, 9.0, 25)
    frequency = 150.0 + 0.05 * np.sinh(t)
    power = 1.0 / (1.0 + ((frequency - 150.0) / 0.05) ** 2)
    kept = (frequency > 120.0) & (frequency < 180.0)
    grid = np.concatenate([[120.0], frequency[kept], [180.0]])
    power = 1.0 / (1.0 + ((grid - 150.0) / 0.05) ** 2)
    exact = 0.05 * 2.0 * np.arctan(20.0 / 0.05) / 40.0
    assert band_mean(grid, power, (130.0, 170.0)) == pytest.approx(exact, rel=0.04)


def test_limit_and_how_far_a_level_is_above_it() -> None:
    limit = Limit("quiet cruise", np.array([10.0, 1000.0]), np.array([170.0, 160.0]))
    np.testing.assert_allclose(limit.at(np.array([100.0, 1000.0])), [165.0, 160.0])
    np.testing.assert_allclose(
        limit.excess(np.array([5.0, 100.0]), np.array([0.0, 168.0])), [np.nan, 3.0]
    )
    for frequency, level in (([2.0, 1.0], [0.0, 0.0]), ([1.0, 2.0], [0.0]), ([0.0], [1.0])):
        with pytest.raises(ValueError, match="positive ascending"):
            Limit("wrong", np.array(frequency), np.array(level))
