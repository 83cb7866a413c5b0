# SPDX-License-Identifier: LGPL-2.1-or-later
"""Velocity of straight vortices of unit circulation, by Biot and Savart (theory: S1-83)."""

import numpy as np

from quietblade.typing import FloatArray

_ON_LINE = 1e-20
"""Square of the sine below which a point counts as on the vortex's line: no velocity there."""

_TINY = 1e-300


def segment_velocity(points: FloatArray, start: FloatArray, end: FloatArray) -> FloatArray:
    """Velocity at points of vortices from start to end; 0 on the vortex itself.

    Parameters
    ----------
    points, start, end : array (..., 3)
        Broadcast against each other [m].

    Returns
    -------
    array (..., 3)
        [1/m]
    """
    a, b = points - start, points - end
    la, lb = np.linalg.norm(a, axis=-1), np.linalg.norm(b, axis=-1)
    across = np.cross(a, b)
    product = la * lb
    square = np.sum(across * across, axis=-1)
    beside = square > _ON_LINE * product**2
    inner = np.sum(a * b, axis=-1)
    # |a||b| + a.b; beside a long vortex the difference of two large numbers would be left
    opening = np.where(inner < 0.0, square / (product + np.abs(inner) + _TINY), product + inner)
    factor = np.where(beside, (la + lb) / np.where(beside, product * opening, 1.0), 0.0)
    result: FloatArray = factor[..., None] * across / (4.0 * np.pi)
    return result


def ray_velocity(points: FloatArray, start: FloatArray, direction: FloatArray) -> FloatArray:
    """Velocity at points of vortices from start to infinity along unit directions; 0 on them.

    Parameters
    ----------
    points, start, direction : array (..., 3)
        Broadcast against each other [m]; directions without unit.

    Returns
    -------
    array (..., 3)
        [1/m]
    """
    arm = points - start
    length = np.linalg.norm(arm, axis=-1)
    across = np.cross(direction, arm)
    square = np.sum(across * across, axis=-1)
    beside = square > _ON_LINE * length**2
    ahead = 1.0 + np.sum(direction * arm, axis=-1) / np.where(length > 0.0, length, 1.0)
    factor = np.where(beside, ahead / np.where(beside, square, 1.0), 0.0)
    result: FloatArray = factor[..., None] * across / (4.0 * np.pi)
    return result
