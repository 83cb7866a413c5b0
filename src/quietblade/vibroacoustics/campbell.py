# SPDX-License-Identifier: LGPL-2.1-or-later
"""Campbell diagram: modes over shaft speed, and where blade-rate orders meet them."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment

from quietblade.typing import FloatArray, IntArray

_FAR = 0.5  # relative change of frequency between two speeds beyond which modes are not the same


@dataclass(frozen=True)
class Crossing:
    """A shaft speed at which a multiple of the blade rate meets a mode.

    Attributes
    ----------
    branch : int
        Row of the branch.
    order : int
        n of the n-th multiple of the blade rate.
    speed : float
        Shaft speed [rad/s].
    frequency : float
        [Hz]
    """

    branch: int
    order: int
    speed: float
    frequency: float


@dataclass(frozen=True, eq=False)
class Campbell:
    """Branches of modes over shaft speed, and their crossings.

    Attributes
    ----------
    speed : (s,) array
        Shaft speeds [rad/s].
    frequency : (b, s) array
        Of each branch [Hz], nan where it has no mode.
    mode : (b, s) int array
        Row of the mode at each speed, -1 for none.
    crossings : tuple of Crossing
        In ascending speed.
    """

    speed: FloatArray
    frequency: FloatArray
    mode: IntArray
    crossings: tuple[Crossing, ...]


def campbell(
    speed: FloatArray,
    frequency: Sequence[FloatArray],
    blades: int,
    *,
    orders: Sequence[int] = (1, 2, 3, 4),
    likeness: Sequence[FloatArray] | None = None,
) -> Campbell:
    """Trace modes over shaft speed, and find where n Z Omega / (2 pi) meets them (theory: S2-58).

    Parameters
    ----------
    speed : (s,) array
        Shaft speeds [rad/s], ascending, not negative.
    frequency : sequence of (m_i,) arrays
        Frequencies of the modes at each speed [Hz].
    blades : int
        Z, the number of blades.
    orders : sequence of int
        Multiples n of the blade rate.
    likeness : sequence of (m_i, m_i+1) arrays, optional
        Modal assurance of the modes at each speed with those at the next; without it the nearest
        frequencies belong together.

    Raises
    ------
    ValueError
        If the speeds do not ascend, or the lists do not fit each other.
    """
    at = np.asarray(speed, dtype=float)
    if at.ndim != 1 or len(at) != len(frequency) or np.any(at < 0.0) or np.any(np.diff(at) <= 0.0):
        raise ValueError("Campbell diagram: one list of modes for each of some ascending speeds")
    if likeness is not None and len(likeness) != len(at) - 1:
        raise ValueError(f"Campbell diagram: {len(likeness)} tables between {len(at)} speeds")
    mode = _traced(frequency, likeness)
    traced = np.full(mode.shape, np.nan)
    for column, values in enumerate(frequency):
        known = mode[:, column] >= 0
        traced[known, column] = np.asarray(values)[mode[known, column]]
    found = [
        crossing
        for branch, values in enumerate(traced)
        for order in orders
        for crossing in _crossings(branch, order, at, values, order * blades / (2.0 * np.pi))
    ]
    return Campbell(at, traced, mode, tuple(sorted(found, key=lambda c: (c.speed, c.order))))


def _traced(frequency: Sequence[FloatArray], likeness: Sequence[FloatArray] | None) -> IntArray:
    """Rows of the modes along each branch, (b, s)."""
    branches = [[k] for k in range(len(frequency[0]))]
    for step in range(1, len(frequency)):
        before, after = np.asarray(frequency[step - 1]), np.asarray(frequency[step])
        distance = np.abs(after[None] / before[:, None] - 1.0)
        alike = -distance if likeness is None else np.asarray(likeness[step - 1]) - distance
        rows, columns = linear_sum_assignment(alike, maximize=True)
        follows = {
            int(r): int(c) for r, c in zip(rows, columns, strict=True) if distance[r, c] <= _FAR
        }
        for branch in branches:
            branch.append(follows.get(branch[-1], -1) if branch[-1] >= 0 else -1)
        new = sorted(set(range(len(after))) - set(follows.values()))
        branches += [[-1] * step + [k] for k in new]
    return np.array(branches, dtype=np.int64).reshape(len(branches), len(frequency))


def _crossings(
    branch: int, order: int, speed: FloatArray, frequency: FloatArray, slope: float
) -> list[Crossing]:
    """Crossings of f(Omega) with slope Omega; f^2 is linear in Omega^2 between two speeds."""
    found = []
    squares, own = speed**2, frequency**2
    gap = own - slope**2 * squares
    for i in range(len(speed) - 1):
        # nan on either side is no crossing; a zero counts once, on the left
        if not (gap[i] == 0.0 or gap[i] * gap[i + 1] < 0.0):
            continue
        share = gap[i] / (gap[i] - gap[i + 1]) if gap[i] != 0.0 else 0.0
        at = float(np.sqrt(squares[i] + share * (squares[i + 1] - squares[i])))
        found.append(Crossing(branch, order, at, slope * at))
    if len(speed) and gap[-1] == 0.0:
        found.append(Crossing(branch, order, float(speed[-1]), slope * float(speed[-1])))
    return found
