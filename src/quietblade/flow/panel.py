# SPDX-License-Identifier: LGPL-2.1-or-later
"""Inviscid plane flow past many sections at once: a linear-vorticity panel method.

The stream function of the uniform stream, of a vortex sheet on the contour whose strength is
linear on each panel, and of a source sheet on a blunt trailing edge is one constant on all
nodes, so that the fluid inside is at rest and the vortex strength is the surface speed. This is
the inviscid formulation of XFOIL (Drela 1989, doi:10.1007/978-3-642-84010-4_1).
"""

from dataclasses import dataclass

import numpy as np

from quietblade.errors import GeometryError
from quietblade.flow.contours import contour_loads
from quietblade.flow.guards import check_contours
from quietblade.flow.influence import view_panels, vortex_integrals
from quietblade.flow.trailing_edge import (
    base_influence,
    close_sharp_edges,
    sharp_edge_equation,
    trailing_edges,
)
from quietblade.typing import AnyArray, FloatArray

CHUNK = 8
"""Sections that are assembled and solved together; more of them leave the processor's cache."""

QUARTER_CHORD = np.array([0.25, 0.0])
"""Moment reference of sections in units of their chord."""


@dataclass(frozen=True, eq=False)
class PanelSolution:
    """Flow past M sections of N nodes, in a stream of unit speed.

    Coefficients refer to unit length: to the chord, if the contours are in units of the chord.
    All arrays may have leading axes, those of the incidence that was asked for.

    Attributes
    ----------
    gamma : array (..., M, N)
        Vortex strength at the nodes, clockwise positive; its magnitude is the surface speed.
    cp : array (..., M, N)
        Pressure coefficient ``1 - gamma**2``.
    lift : array (..., M)
        Lift coefficient from the pressure, perpendicular to the stream.
    moment : array (..., M)
        Moment coefficient about (0.25, 0) from the pressure, nose up positive.
    drag : array (..., M)
        Drag coefficient from the pressure. Exact for a sharp edge is 0: there it measures the
        discretisation error. On a blunt edge the pressure recovered on the base adds a small
        thrust that more nodes do not remove (-1.2e-3 for a base of 0.6 % of the chord).
    circulation : array (..., M)
        Circulation, clockwise positive; the exact lift coefficient is twice as much.
    stagnation : array (..., M)
        Place of the stagnation point at the nose, as a node number with a fraction: 80.25 lies a
        quarter of the way from node 80 to node 81. See `stagnation_points` for coordinates.
    """

    gamma: FloatArray
    cp: FloatArray
    lift: FloatArray
    moment: FloatArray
    drag: FloatArray
    circulation: FloatArray
    stagnation: FloatArray


class PanelSections:
    """Sections with their solutions in two unit streams, from which any incidence follows.

    Parameters
    ----------
    contours : array (M, N, 2)
        Closed contours in the order upper trailing edge, upper side, nose, lower side, lower
        trailing edge (counter-clockwise), in units of the chord with the middle of the trailing
        edge at (1, 0) if the coefficients are to refer to the chord. The first and the last node
        are the corners of a blunt trailing edge; a sharp one has both at one place.

    Attributes
    ----------
    contours : array (M, N, 2)
        The contours, with edges thinner than `SHARP_GAP` closed.
    unit : array (M, N, 2)
        Vortex strength at the nodes in unit streams along x and along y.

    Raises
    ------
    GeometryError
        If a contour cannot be solved; see `quietblade.flow.guards.check_contours`.
    """

    def __init__(self, contours: FloatArray) -> None:
        contours = np.asarray(contours, dtype=np.float64)
        check_contours(contours)
        self.contours = close_sharp_edges(contours)
        starts = range(0, len(contours), CHUNK)
        self.unit = np.concatenate([_unit_solutions(self.contours[i : i + CHUNK]) for i in starts])

    def solve(self, alpha: FloatArray | float) -> PanelSolution:
        """Superpose the unit solutions (theory: S1-9).

        Parameters
        ----------
        alpha : array (..., M) or float
            Incidence of each section [rad], measured from the x axis of the contours.

        Returns
        -------
        PanelSolution
        """
        alpha = np.broadcast_arrays(np.asarray(alpha, dtype=np.float64), self.unit[:, 0, 0])[0]
        cos, sin = np.cos(alpha), np.sin(alpha)
        gamma = cos[..., None] * self.unit[..., 0] + sin[..., None] * self.unit[..., 1]
        cp = 1.0 - gamma * gamma
        force, moment = contour_loads(self.contours, cp, QUARTER_CHORD)
        return PanelSolution(
            gamma=gamma,
            cp=cp,
            lift=force[..., 1] * cos - force[..., 0] * sin,
            moment=-moment,
            drag=force[..., 0] * cos + force[..., 1] * sin,
            circulation=self._circulation(gamma),
            stagnation=_stagnation(gamma),
        )

    def stagnation_points(self, solution: PanelSolution) -> FloatArray:
        """Coordinates (..., M, 2) of the stagnation points at the nose."""
        before = np.nan_to_num(solution.stagnation).astype(np.int64)
        section = np.arange(len(self.contours))
        start = self.contours[section, before]
        end = self.contours[section, before + 1]
        fraction = (solution.stagnation - before)[..., None]
        result: FloatArray = start + fraction * (end - start)
        return result

    def _circulation(self, gamma: FloatArray) -> FloatArray:
        panels = np.linalg.norm(np.diff(self.contours, axis=1), axis=-1)
        result: FloatArray = np.sum(0.5 * (gamma[..., 1:] + gamma[..., :-1]) * panels, axis=-1)
        return result


def _stagnation(gamma: FloatArray) -> FloatArray:
    """Place where the strength changes its sign, linear between nodes (..., M)."""
    # On the upper side the strength is positive from the trailing edge to this place. At the edge
    # itself its sign may be lost in rounding.
    upper = gamma[..., 1:-2] > 0.0
    change = upper & (gamma[..., 2:-1] <= 0.0)
    before = 1 + np.argmax(change, axis=-1)
    pair = np.stack([before, before + 1], axis=-1)
    ahead, behind = np.moveaxis(np.take_along_axis(gamma, pair, axis=-1), -1, 0)
    jump = ahead - behind
    fraction = np.where(change.any(axis=-1), ahead / np.where(jump > 0.0, jump, 1.0), np.nan)
    result: FloatArray = before + fraction
    return result


def _unit_solutions(contours: FloatArray) -> FloatArray:
    """Vortex strengths (M, N, 2) in unit streams along x and along y."""
    matrix, streams = _equations(contours)
    try:
        solution: AnyArray = np.linalg.solve(matrix, streams)
    except np.linalg.LinAlgError as error:
        raise GeometryError(
            "panel method: the equations of a section are singular. "
            "Remedy: look for nodes that coincide or for a section of no thickness"
        ) from error
    result: FloatArray = solution[:, :-1]
    return result


def _equations(contours: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Equations (M, N + 1, N + 1) for the strengths and the body's stream function, two streams.

    Rows: constant stream function at the nodes (theory: S1-7), then the Kutta condition
    ``gamma[0] + gamma[-1] = 0`` (theory: S1-8). Right sides (M, N + 1, 2).
    """
    sections, nodes, _ = contours.shape
    edge = trailing_edges(contours)
    plain, weighted = vortex_integrals(view_panels(contours, contours))
    matrix = np.zeros((sections, nodes + 1, nodes + 1))
    plain -= weighted
    matrix[:, :-1, :-2] = plain
    matrix[:, :-1, 1:-1] += weighted
    matrix *= 0.5 / np.pi
    base = 0.5 * base_influence(contours, edge)
    matrix[:, :-1, 0] += base
    matrix[:, :-1, -2] -= base
    matrix[:, :-1, -1] = -1.0
    matrix[:, -1, [0, -2]] = 1.0
    streams = np.zeros((sections, nodes + 1, 2))
    streams[:, :-1, 0] = -contours[..., 1]
    streams[:, :-1, 1] = contours[..., 0]
    for k in np.flatnonzero(edge.sharp).tolist():
        matrix[k, -2, :-1] = sharp_edge_equation(contours[k], edge, k)
        matrix[k, -2, -1] = 0.0
        streams[k, -2] = -edge.bisector[k]
    return matrix, streams
