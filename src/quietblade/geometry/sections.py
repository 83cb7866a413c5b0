# SPDX-License-Identifier: LGPL-2.1-or-later
"""Section families: thickness laid off perpendicular to a camber line, on the unit chord."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from quietblade.errors import GeometryError
from quietblade.typing import FloatArray


class SectionFamily(Protocol):
    """A family of sections on the unit chord: nose (0, 0), middle of the trailing edge (1, 0).

    A new family derives from this class and says its name, half thickness and camber line; the
    contour follows, with the thickness perpendicular to the camber line (theory: S1-71). All
    arguments broadcast against each other. ``thickness``, ``camber`` and ``te`` (thickness of
    the blunt trailing edge) are fractions of the chord.
    """

    @property
    def name(self) -> str:
        """Name in a case file."""
        ...

    def half_thickness(self, x: ArrayLike, thickness: ArrayLike, te: ArrayLike) -> FloatArray:
        """Half thickness at chord fraction ``x``; ``te / 2`` at 1, like sqrt(x) at 0."""
        ...

    def camber_line(self, x: ArrayLike, camber: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Height of the camber line and its slope dy/dx at chord fraction ``x``."""
        ...

    def point(
        self, phi: ArrayLike, thickness: ArrayLike, camber: ArrayLike, te: ArrayLike
    ) -> FloatArray:
        """Point of the contour at the contour parameter ``phi``.

        phi = -1 is the upper trailing edge, 0 the nose, +1 the lower trailing edge. The foot on
        the chord is sin^2(pi phi / 2), so that x and y are smooth in phi around the nose.

        Parameters
        ----------
        phi, thickness, camber, te : array_like
            Contour parameter, and fractions of the chord; broadcast to shape (...).

        Returns
        -------
        ndarray, shape (..., 2)
            On the unit chord.
        """
        phi = np.asarray(phi, dtype=np.float64)
        x = np.sin(0.5 * np.pi * phi) ** 2
        height, slope = self.camber_line(x, camber)
        offset = -np.sign(phi) * self.half_thickness(x, thickness, te) / np.hypot(1.0, slope)
        return np.stack(np.broadcast_arrays(x - offset * slope, height + offset), axis=-1)

    def contour(self, thickness: ArrayLike, camber: ArrayLike, te: ArrayLike, n: int) -> FloatArray:
        """Nodes of the contour, clustered (cosine) at the nose and the trailing edge.

        Order: upper trailing edge, upper side, nose, lower side, lower trailing edge
        (counter-clockwise). The trailing-edge face is left open.

        Parameters
        ----------
        thickness, camber, te : array_like
            Fractions of the chord; broadcast to shape (...).
        n : int
            Number of nodes; odd, so that the middle node is the nose.

        Returns
        -------
        ndarray, shape (..., n, 2)

        Raises
        ------
        GeometryError
            ``n`` is even or below 5.
        """
        if n < 5 or n % 2 == 0:
            raise GeometryError(f"section contour of {n} nodes; give an odd number of at least 5")
        t, m, edge = (np.asarray(a, dtype=np.float64)[..., None] for a in (thickness, camber, te))
        return self.point(np.linspace(-1.0, 1.0, n), t, m, edge)

    def parameter_at(
        self, side: int, x: ArrayLike, thickness: ArrayLike, camber: ArrayLike, te: ArrayLike
    ) -> FloatArray:
        """Contour parameter of the point above (side +1) or below (-1) the chord fraction ``x``.

        Bisection: on a cambered section the contour point above x has another foot than x.
        Beyond the ends of the side it is the end's parameter.

        Parameters
        ----------
        side : {+1, -1}
            Upper or lower side.
        x, thickness, camber, te : array_like
            Chord fraction and fractions of the chord; broadcast to shape (...).

        Returns
        -------
        ndarray, shape (...)
        """
        x, thickness, camber, te = np.broadcast_arrays(x, thickness, camber, te)
        low, high = np.zeros(x.shape), np.ones(x.shape)
        for _ in range(54):  # one bit of the mantissa a step
            middle = 0.5 * (low + high)
            before = self.point(-side * middle, thickness, camber, te)[..., 0] < x
            low, high = np.where(before, middle, low), np.where(before, high, middle)
        return np.asarray(-side * 0.5 * (low + high), dtype=np.float64)


@dataclass(frozen=True)
class SectionMoments:
    """Area, centroid and second moments of area about the centroid, for the unit chord.

    Each has the shape of the batch; ``ixx`` is the integral of y^2, ``iyy`` of x^2, ``ixy`` of xy.
    """

    area: FloatArray
    x: FloatArray
    y: FloatArray
    ixx: FloatArray
    iyy: FloatArray
    ixy: FloatArray


def section_moments(points: FloatArray) -> SectionMoments:
    """Moments of closed polygons (Green's theorem).

    Parameters
    ----------
    points : ndarray, shape (..., n, 2)
        Counter-clockwise nodes; the last is joined to the first.

    Returns
    -------
    SectionMoments
        In units of the points' length: area, length and fourth powers.
    """
    x, y = points[..., 0], points[..., 1]
    x1, y1 = np.roll(x, -1, axis=-1), np.roll(y, -1, axis=-1)
    cross = x * y1 - x1 * y
    area = 0.5 * np.sum(cross, axis=-1)
    cx = np.sum((x + x1) * cross, axis=-1) / (6.0 * area)
    cy = np.sum((y + y1) * cross, axis=-1) / (6.0 * area)
    ixx = np.sum((y * y + y * y1 + y1 * y1) * cross, axis=-1) / 12.0 - area * cy**2
    iyy = np.sum((x * x + x * x1 + x1 * x1) * cross, axis=-1) / 12.0 - area * cx**2
    mixed = (x * y1 + 2.0 * x * y + 2.0 * x1 * y1 + x1 * y) * cross
    return SectionMoments(area, cx, cy, ixx, iyy, np.sum(mixed, axis=-1) / 24.0 - area * cx * cy)
