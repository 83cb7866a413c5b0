# SPDX-License-Identifier: LGPL-2.1-or-later
"""Branches over shaft speed and their crossings with blade-rate orders."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from quietblade.vibroacoustics.campbell import campbell

SPEED = np.linspace(0.0, 40.0, 9)


def southwell(rest: float, factor: float) -> np.ndarray:
    return np.sqrt(rest**2 + factor * (SPEED / (2.0 * np.pi)) ** 2)


@settings(deadline=None)
@given(st.floats(3.0, 30.0), st.floats(0.1, 4.0), st.integers(2, 7))
def test_crossing_of_southwells_law_is_exact(rest: float, factor: float, blades: int) -> None:
    found = campbell(SPEED, [np.array([f]) for f in southwell(rest, factor)], blades, orders=(1, 2))
    for order in (1, 2):
        revolutions = rest / np.sqrt((order * blades) ** 2 - factor) if (
            (order * blades) ** 2 > factor
        ) else np.inf  # fmt: skip
        mine = [c for c in found.crossings if c.order == order]
        if 2.0 * np.pi * revolutions < SPEED[-1] * (1.0 - 1e-9):
            (crossing,) = mine
            assert crossing.speed == pytest.approx(2.0 * np.pi * revolutions, rel=1e-9)
            assert crossing.frequency == pytest.approx(order * blades * revolutions, rel=1e-9)
        elif 2.0 * np.pi * revolutions > SPEED[-1] * (1.0 + 1e-9):
            assert not mine


def test_branches_that_cross_need_their_shapes() -> None:
    rising, level = southwell(10.0, 20.0), southwell(14.0, 0.1)
    order = np.argsort(np.stack([rising, level]), axis=0)
    frequency = list(np.sort(np.stack([rising, level]), axis=0).T)
    tables = [(order[:, [i]] == order[None, :, i + 1]).astype(float) for i in range(8)]
    told = campbell(SPEED, frequency, 3, likeness=tables)
    np.testing.assert_allclose(told.frequency, [rising, level])
    guessed = campbell(SPEED, frequency, 3)
    assert not np.allclose(guessed.frequency, [rising, level])


def test_modes_that_come_and_go() -> None:
    frequency = [np.array([5.0]), np.array([5.1, 20.0]), np.array([20.5])]
    found = campbell(np.array([0.0, 1.0, 2.0]), frequency, 3)
    np.testing.assert_array_equal(found.mode, [[0, 0, -1], [-1, 1, 0]])
    assert np.isnan(found.frequency[0, 2])
    assert not found.crossings


def test_what_is_refused() -> None:
    with pytest.raises(ValueError, match="ascending"):
        campbell(np.array([1.0, 1.0]), [np.ones(1), np.ones(1)], 3)
    with pytest.raises(ValueError, match="tables"):
        campbell(np.array([1.0, 2.0]), [np.ones(1), np.ones(1)], 3, likeness=[])
