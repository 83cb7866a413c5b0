# SPDX-License-Identifier: LGPL-2.1-or-later
"""Section families made from a table of coordinates."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

from quietblade.errors import GeometryError
from quietblade.geometry.sections import SectionFamily
from quietblade.typing import FloatArray

EDGE_MISFIT = 0.01
"""Largest difference of the chord fractions at which the two sides of a table may end."""

SYMMETRIC = 1e-5
"""Largest camber / chord of a section that counts as symmetric."""

_COINCIDENT = 1e-9  # of the chord: nodes nearer than that are one


@dataclass(frozen=True, eq=False)
class TableFamily(SectionFamily):
    """The family of a table: its thickness and camber distributions, scaled.

    The nose is the point farthest from the middle of the trailing edge. Thickness and camber are
    measured **perpendicular to the chord** between the two, unlike those of the NACA families, so
    that with its own `thickness`, `camber` and `trailing_edge` the family is the table itself.

    Attributes
    ----------
    label : str
        Name.
    height : CubicSpline
        Height / chord over the contour parameter, from -1 (upper trailing edge) to 1.
    thickness, camber, trailing_edge : float
        The table's own values, fractions of the chord. The camber has a sign; 0 if symmetric.
    rotation : float
        Angle of the chord above the table's x axis, from the trailing edge to the nose [rad]: the
        incidence in the table's axes is that of the chord minus this.
    """

    label: str
    height: CubicSpline
    thickness: float
    camber: float
    trailing_edge: float
    rotation: float

    @property
    def name(self) -> str:
        """The label."""
        return self.label

    def half_thickness(self, x: ArrayLike, thickness: ArrayLike, te: ArrayLike) -> FloatArray:
        """Half thickness, scaled; a linear wedge makes the edge ``te`` thick.

        Parameters
        ----------
        x, thickness, te : array_like
            Chord fraction, largest thickness / chord, edge thickness / chord; broadcast.

        Returns
        -------
        ndarray
            Half thickness / chord.
        """
        x = np.asarray(x, dtype=np.float64)
        scale = np.asarray(thickness, dtype=np.float64) / self.thickness
        wedge = 0.5 * np.asarray(te, dtype=np.float64) - 0.5 * scale * self.trailing_edge
        return np.asarray(scale * self._half(_parameter(x)) + x * wedge, dtype=np.float64)

    def camber_line(self, x: ArrayLike, camber: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Mean of the two sides, scaled.

        Parameters
        ----------
        x, camber : array_like
            Chord fraction, largest camber / chord; broadcast.

        Returns
        -------
        tuple of ndarray
            Height / chord and slope dy/dx.

        Raises
        ------
        GeometryError
            A camber is asked of a symmetric table.
        """
        m = np.asarray(camber, dtype=np.float64)
        if self.camber == 0.0:
            if np.any(m != 0.0):
                raise GeometryError(
                    f"section {self.label!r} is symmetric, so that its camber cannot be scaled to "
                    f"{float(np.abs(m).max()):g}. Remedy: use camber 0, or a cambered table"
                )
            scale = m
        else:
            scale = m / self.camber
        phi = np.clip(_parameter(np.asarray(x, dtype=np.float64)), 1e-4, 1.0 - 1e-4)
        slope = 0.5 * (self.height(phi, 1) - self.height(-phi, 1)) / _stretch(phi)
        mean = _parameter(np.asarray(x, dtype=np.float64))
        height = 0.5 * (self.height(mean) + self.height(-mean))
        return np.asarray(scale * height), np.asarray(scale * slope)

    def point(
        self, phi: ArrayLike, thickness: ArrayLike, camber: ArrayLike, te: ArrayLike
    ) -> FloatArray:
        """Point of the contour at the contour parameter ``phi`` (theory: S1-72).

        The parameter is that of `SectionFamily.point`.

        Returns
        -------
        ndarray, shape (..., 2)
            On the unit chord.
        """
        phi = np.asarray(phi, dtype=np.float64)
        x = np.sin(0.5 * np.pi * phi) ** 2
        y = self.camber_line(x, camber)[0] - np.sign(phi) * self.half_thickness(x, thickness, te)
        return np.stack(np.broadcast_arrays(x, y), axis=-1)

    def own_contour(self, n: int) -> FloatArray:
        """Nodes (n, 2) of the table's own section, with cosine spacing."""
        return self.contour(self.thickness, self.camber, self.trailing_edge, n)

    def _half(self, phi: FloatArray) -> FloatArray:
        return np.asarray(0.5 * (self.height(-phi) - self.height(phi)), dtype=np.float64)


def table_family(points: FloatArray, label: str) -> TableFamily:
    """Family of a section that is given by coordinates.

    Cubic splines: through the nodes over the arc length to find the nose, then of the height over
    the contour parameter, which is smooth around the nose and lets the nodes be spaced anew.

    Parameters
    ----------
    points : ndarray, shape (N, 2)
        From the trailing edge along one side to the nose and back along the other, in any unit,
        place and position.
    label : str
        Name of the family.

    Raises
    ------
    GeometryError
        No thickness, sides that end apart, or that turn back along the chord.
    """
    points = _without_doubles(points)
    x, y = points.T
    if np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)) < 0.0:
        points = points[::-1]
    arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    curve = CubicSpline(arc, points)
    edge = 0.5 * (points[0] + points[-1])
    place = _nose(curve, arc, points, edge)
    chord = edge - curve(place)
    length = float(np.linalg.norm(chord))
    if np.linalg.norm(points[0] - points[-1]) > 0.2 * length:
        raise GeometryError(
            f"section {label!r}: the table begins and ends at {points[0]} and {points[-1]}, far "
            f"apart for a chord of {length:.3g}. Remedy: begin and end it at the trailing edge"
        )
    tangent = chord / length
    local = (points - curve(place)) @ np.array([tangent, [-tangent[1], tangent[0]]]).T / length
    apart = np.abs(arc - place) > _COINCIDENT * length
    upper, lower = local[(arc < place) & apart], local[(arc > place) & apart]
    phi_upper, y_upper = _side(upper[::-1], label)
    phi_lower, y_lower = _side(lower, label)
    phi = np.concatenate([-phi_upper[::-1], [0.0], phi_lower])
    heights = np.concatenate([y_upper[::-1], [0.0], y_lower])
    # The chord fraction does not change to first order at the ends, nor may the height.
    spline = CubicSpline(phi, heights, bc_type="clamped")
    grid = np.linspace(0.0, 1.0, 2001)
    half = 0.5 * (spline(-grid) - spline(grid))
    mean = 0.5 * (spline(-grid) + spline(grid))
    if half[1:-1].min() <= 0.0:
        k = int(np.argmin(half[1:-1])) + 1
        raise GeometryError(
            f"section {label!r}: its sides cross or touch at chord fraction "
            f"{np.sin(0.5 * np.pi * grid[k]) ** 2:.3g}. Remedy: correct the table there"
        )
    camber = _extreme(mean)
    return TableFamily(
        label=label,
        height=spline,
        thickness=2.0 * _extreme(half),
        camber=camber if abs(camber) > SYMMETRIC else 0.0,
        trailing_edge=float(2.0 * half[-1]),
        rotation=float(np.arctan2(-tangent[1], tangent[0])),
    )


def _without_doubles(points: FloatArray) -> FloatArray:
    extent = float(np.ptp(points, axis=0).max())
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    kept: FloatArray = points[np.concatenate([[True], steps > _COINCIDENT * extent])]
    return kept


def _nose(curve: CubicSpline, arc: FloatArray, points: FloatArray, edge: FloatArray) -> float:
    """Arc length of the point farthest from the trailing edge."""

    def approach(s: float) -> float:
        return float((curve(s) - edge) @ curve(s, 1))

    k = int(np.argmax(np.linalg.norm(points - edge, axis=1)))
    k = min(max(k, 1), len(arc) - 2)
    if approach(arc[k - 1]) <= 0.0 or approach(arc[k + 1]) >= 0.0:
        return float(arc[k])  # a pointed nose
    return float(brentq(approach, arc[k - 1], arc[k + 1]))


def _side(nodes: FloatArray, label: str) -> tuple[FloatArray, FloatArray]:
    """Contour parameter (above 0) and height of one side's nodes, nose to trailing edge.

    The side is cut or extended to chord fraction 1 along its last panel: the direction in which it
    leaves the section decides the lift.
    """
    x, y = nodes.T
    if abs(x[-1] - 1.0) > EDGE_MISFIT:
        raise GeometryError(
            f"section {label!r}: one side ends at chord fraction {x[-1]:.4g}, the middle of the "
            "edge is at 1. Remedy: let both sides end at the trailing edge"
        )
    back = np.flatnonzero(np.diff(np.concatenate([[0.0], x])) <= 0.0)
    if len(back):
        raise GeometryError(
            f"section {label!r}: a side turns back along the chord at the point "
            f"({x[back[0]]:.5g}, {y[back[0]]:.5g}), in chords from the nose. Remedy: correct the "
            "order of the points, or smooth the nose"
        )
    inside = np.count_nonzero(x[:-1] < 1.0 - _COINCIDENT)
    last = slice(inside - 1, inside + 1)
    slope = np.diff(y[last])[0] / np.diff(x[last])[0]
    end = y[inside] + slope * (1.0 - x[inside])
    phi = _parameter(np.append(x[:inside], 1.0))
    return phi, np.append(y[:inside], end)


def _parameter(x: FloatArray) -> FloatArray:
    return np.asarray(2.0 / np.pi * np.arcsin(np.sqrt(x)), dtype=np.float64)


def _stretch(phi: FloatArray) -> FloatArray:
    """Derive the chord fraction by the contour parameter."""
    return np.asarray(0.5 * np.pi * np.sin(np.pi * phi), dtype=np.float64)


def _extreme(values: FloatArray) -> float:
    """Value of largest magnitude on a fine grid, with its sign, from the parabola around it."""
    k = int(np.argmax(np.abs(values)))
    if k in (0, len(values) - 1):
        return float(values[k])
    before, top, after = values[k - 1 : k + 2]
    bend = before - 2.0 * top + after
    return float(top if bend == 0.0 else top - (after - before) ** 2 / (8.0 * bend))
