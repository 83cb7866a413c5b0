# SPDX-License-Identifier: LGPL-2.1-or-later
"""What grids show of a needle of known shape."""

import numpy as np

from quietblade.typing import FloatArray
from quietblade.vibroacoustics.stepped import stepped_peaks

TOP, WIDTH = 150.3, 0.4


def needle(frequency: FloatArray) -> FloatArray:
    return 1.0 / (1.0 + (2.0 * (frequency - TOP) / WIDTH) ** 2)


def test_worst_grid_has_the_peak_half_way_between_its_frequencies() -> None:
    found = stepped_peaks(needle, np.array([TOP]), (100.0, 200.0))
    expected = needle(TOP + 0.5 * found.step)
    np.testing.assert_allclose(found.worst[0], expected, rtol=1e-9)


def test_grid_from_the_lower_end_shows_its_nearest_frequency() -> None:
    found = stepped_peaks(needle, np.array([TOP]), (100.0, 200.0))
    expected = needle(np.array([150.5, 150.0, 150.0]))
    expected[0] = max(needle(np.array([150.0, 150.5])))
    np.testing.assert_allclose(found.aligned[0], expected, rtol=1e-9)
    assert np.all(found.aligned >= found.worst)


def test_no_peaks_make_empty_tables() -> None:
    found = stepped_peaks(needle, np.zeros(0), (100.0, 200.0))
    assert found.worst.shape == (0, 3)
