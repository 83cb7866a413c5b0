# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sections and blades for the tests of the flow."""

import numpy as np

from quietblade.geometry import NacaFourDigit
from quietblade.typing import FloatArray

V, OMEGA = 5.0, 0.58


def naca(
    thickness: float = 0.06, camber: float = 0.0, edge: float = 0.0, n: int = 161
) -> FloatArray:
    """Contour (n, 2) on the unit chord."""
    return NacaFourDigit().contour(thickness, camber, edge, n)


def fin(contour: FloatArray, sections: int = 21) -> FloatArray:
    """The paper's planform: chord along x, mid-chords on the z axis (sections, n, 3)."""
    s = np.linspace(0.0, 1.0, sections)
    chord = 0.25 - 0.175 * s
    points = np.zeros((sections, len(contour), 3))
    points[..., :2] = chord[:, None, None] * (contour - [0.5, 0.0])
    points[..., 2] = (0.2 + s)[:, None]
    return points


def turn(plane: FloatArray, angle: float) -> FloatArray:
    """Turn points (..., 2) counter-clockwise."""
    c, s = np.cos(angle), np.sin(angle)
    result: FloatArray = plane @ np.array([[c, s], [-s, c]])
    return result


def rotation(seed: int) -> FloatArray:
    """A random rotation matrix (3, 3)."""
    q, r = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    q = q * np.sign(np.diag(r))
    result: FloatArray = q * np.sign(np.linalg.det(q))
    return result
