# SPDX-License-Identifier: LGPL-2.1-or-later
"""Boundary layers on sections, and polars with the one-way layer."""

from dataclasses import dataclass, replace

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

from quietblade.errors import GeometryError
from quietblade.flow.boundary_layer import Layer, march_layer
from quietblade.flow.panel import PanelSections
from quietblade.flow.section_stall import is_stalled, nose_radius, suction_limit
from quietblade.typing import BoolArray, FloatArray

STATIONS = 300
"""Stations of the boundary layer on each side, crowded at the stagnation point."""

EDGE_REGION = (0.85, 0.95)
"""Chord fractions over which the edge speed is fitted by a line that replaces it behind: in the
inviscid flow the speed falls to 0 at a sharp trailing edge, in the viscous flow it does not."""


@dataclass(frozen=True, eq=False)
class SideLayer:
    """Boundary layers on one side of the sections of B flows; places are chord fractions.

    Attributes
    ----------
    layer : Layer
        What was marched, over the arc length from the stagnation point.
    x : array (B, S)
        Chord fractions of the stations.
    transition : array (B,)
        Place of transition; 1 if the side is laminar.
    separation : array (B,)
        Place of turbulent separation; nan if attached.
    bubble : array (B,)
        Place where the laminar layer separates ahead of transition; nan if it does not.
    """

    layer: Layer
    x: FloatArray
    transition: FloatArray
    separation: FloatArray
    bubble: FloatArray


@dataclass(frozen=True, eq=False)
class SectionLayer:
    """Boundary layers on both sides of the sections of B flows.

    Attributes
    ----------
    upper, lower : SideLayer
    drag_coefficient : array (B,)
        Profile drag by Squire and Young, both sides.
    """

    upper: SideLayer
    lower: SideLayer
    drag_coefficient: FloatArray


@dataclass(frozen=True, eq=False)
class Polar:
    """Coefficients of one section at A incidences; places are chord fractions.

    Lift, moment and pressure are those of the inviscid flow: the boundary layer does not act back.

    Attributes
    ----------
    alpha : array (A,)
        Incidence [rad].
    reynolds : float or None
        Of the chord; None without a boundary layer, when all that it gives is nan.
    lift_coefficient, drag_coefficient, moment_coefficient : array (A,)
        The moment about the quarter chord, nose up.
    minimum_pressure : array (A,)
        Largest suction -Cp_min.
    transition_upper, transition_lower : array (A,)
        1 if the side is laminar.
    separation_upper, separation_lower : array (A,)
        Turbulent separation; nan if attached.
    stalled : bool array (A,)
        By `quietblade.flow.section_stall`; drag and lift are not to be trusted there.
    """

    alpha: FloatArray
    reynolds: float | None
    lift_coefficient: FloatArray
    drag_coefficient: FloatArray
    moment_coefficient: FloatArray
    minimum_pressure: FloatArray
    transition_upper: FloatArray
    transition_lower: FloatArray
    separation_upper: FloatArray
    separation_lower: FloatArray
    stalled: BoolArray


def boundary_layer(
    contour: FloatArray,
    gamma: FloatArray,
    reynolds: FloatArray | float,
    *,
    n_crit: float = 9.0,
    trip: tuple[float, float] | None = None,
) -> SectionLayer:
    """Boundary layers on both sides of a section, given the inviscid flow.

    Parameters
    ----------
    contour : array (N, 2) or (B, N, 2)
        Nodes in units of the chord as for `PanelSections`: one section, or one for every flow.
    gamma : array (N,) or (B, N)
        Vortex strength at the nodes (`PanelSolution.gamma`): the edge speed with a sign that
        changes at the stagnation point.
    reynolds : float or array (B,)
        Of the stream speed and the chord.
    n_crit : float
        Exponent of the disturbance at transition.
    trip : tuple of two floats, optional
        Chord fractions of a forced transition on the upper and the lower side.

    Returns
    -------
    SectionLayer
        All arrays with the leading axis B (1 for one flow).

    Raises
    ------
    GeometryError
        No stagnation point at the nose: an incidence far beyond any use.
    """
    gamma = np.atleast_2d(np.asarray(gamma, dtype=np.float64))
    contours = np.broadcast_to(np.asarray(contour, dtype=np.float64), (*gamma.shape, 2))
    flows = [_Edge.of(nodes, speed) for nodes, speed in zip(contours, gamma, strict=True)]
    sides = []
    for k, direction in enumerate((-1, 1)):
        fields = (edge.stations(direction) for edge in flows)
        arc, speed, gradient, x = map(np.array, zip(*fields, strict=True))
        forced = np.inf if trip is None else _arc_at(arc, x, trip[k])
        layer = march_layer(arc, speed, gradient, reynolds, n_crit=n_crit, trip=forced)
        sides.append(
            SideLayer(
                layer=layer,
                x=x,
                transition=np.nan_to_num(_x_at(arc, x, layer.transition), nan=1.0),
                separation=_x_at(arc, x, layer.separation),
                bubble=_x_at(arc, x, layer.laminar_separation),
            )
        )
    upper, lower = sides
    return SectionLayer(upper, lower, upper.layer.drag() + lower.layer.drag())


def section_polar(
    contour: FloatArray,
    alpha: FloatArray,
    reynolds: float | None,
    *,
    n_crit: float = 9.0,
    trip: tuple[float, float] | None = None,
) -> Polar:
    """Polar of one section: the panel method with the boundary layer on it.

    Parameters
    ----------
    contour : array (N, 2)
        Nodes in units of the chord, as for `PanelSections`.
    alpha : array (A,)
        Incidences [rad].
    reynolds : float or None
        Of the chord; None: no boundary layer.
    n_crit, trip
        As for `boundary_layer`.

    Returns
    -------
    Polar

    Raises
    ------
    GeometryError
        A contour that cannot be solved, or an incidence without a stagnation point at the nose.
    """
    alpha = np.atleast_1d(np.asarray(alpha, dtype=np.float64))
    solution = PanelSections(np.asarray(contour)[None]).solve(alpha[:, None])
    suction = -solution.cp[:, 0].min(axis=-1)
    none = np.full(len(alpha), np.nan)
    inviscid = Polar(
        alpha=alpha,
        reynolds=reynolds,
        lift_coefficient=solution.lift[:, 0],
        drag_coefficient=none,
        moment_coefficient=solution.moment[:, 0],
        minimum_pressure=suction,
        transition_upper=none,
        transition_lower=none,
        separation_upper=none,
        separation_lower=none,
        stalled=np.zeros(len(alpha), dtype=bool),
    )
    if reynolds is None:
        return inviscid
    layer = boundary_layer(contour, solution.gamma[:, 0], reynolds, n_crit=n_crit, trip=trip)
    upper, lower = layer.upper, layer.lower
    limit = suction_limit(nose_radius(contour), reynolds)
    return replace(
        inviscid,
        drag_coefficient=layer.drag_coefficient,
        transition_upper=upper.transition,
        transition_lower=lower.transition,
        separation_upper=upper.separation,
        separation_lower=lower.separation,
        stalled=is_stalled(suction, limit, upper.separation, lower.separation),
    )


@dataclass(frozen=True, eq=False)
class _Edge:
    """Splines of the edge speed and the chord fraction of one flow over the arc length."""

    speed: CubicSpline
    place: CubicSpline
    origin: float
    length: float

    @classmethod
    def of(cls, nodes: FloatArray, gamma: FloatArray) -> "_Edge":
        arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(nodes, axis=0), axis=1))])
        speed, place = CubicSpline(arc, gamma), CubicSpline(arc, nodes[:, 0])
        change = np.flatnonzero((gamma[1:-2] > 0.0) & (gamma[2:-1] <= 0.0))
        if len(change) == 0:
            raise GeometryError(
                "boundary layer: no stagnation point between the trailing edge's two corners. "
                "Remedy: use an incidence below 45 deg"
            )
        k = int(change[0]) + 1
        origin = brentq(lambda s: float(speed(s)), arc[k], arc[k + 1])
        return cls(speed, place, float(origin), float(arc[-1]))

    def stations(self, direction: int) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Arc length, speed, its derivative and chord fraction, upper (-1) or lower (+1) side."""
        side = self.origin if direction < 0 else self.length - self.origin
        arc = side * np.linspace(0.0, 1.0, STATIONS) ** 2
        along = self.origin + direction * arc
        x = self.place(along)
        speed, gradient = -direction * self.speed(along), -self.speed(along, 1)
        speed[0] = 0.0
        begin, end = EDGE_REGION
        fitted = (x > begin) & (x < end)
        last = int(np.flatnonzero(x < end)[-1])
        fit = np.polynomial.Polynomial.fit(arc[fitted], speed[fitted], 1).convert().coef[1]
        speed[last + 1 :] = speed[last] + fit * (arc[last + 1 :] - arc[last])
        gradient[last + 1 :] = fit
        return arc, speed, gradient, x


def _x_at(arc: FloatArray, x: FloatArray, places: FloatArray) -> FloatArray:
    found = [np.interp(s, a, b) for s, a, b in zip(places, arc, x, strict=True)]
    return np.where(np.isnan(places), np.nan, found)


def _arc_at(arc: FloatArray, x: FloatArray, place: float) -> FloatArray:
    """Arc length behind the nose at a chord fraction."""
    found = []
    for a, b in zip(arc, x, strict=True):
        nose = int(np.argmin(b))
        found.append(float(np.interp(place, b[nose:], a[nose:])))
    return np.array(found)
