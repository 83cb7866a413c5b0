# SPDX-License-Identifier: LGPL-2.1-or-later
"""Stream function of straight panels, the integrals of the panel method.

A panel runs from its start ``a`` to its end ``b``; ``x1`` and ``x2`` are the distances of the
field point from ``a`` and ``b`` along the panel, ``y`` its distance to the left of the panel,
``r1`` and ``r2`` its distances from the two ends. A vortex of unit strength, clockwise
positive, has the stream function ``ln r / 2 pi``, a source of unit strength ``theta / 2 pi``.
The factor ``1 / 2 pi`` is left to the caller. Integrals: Katz and Plotkin, *Low-Speed
Aerodynamics* (2001), section 11.4; stream-function form: Drela, *XFOIL* (1989).
"""

from dataclasses import dataclass

import numpy as np

from quietblade.typing import FloatArray


@dataclass(frozen=True, eq=False)
class PanelView:
    """P field points seen from the N - 1 panels between N consecutive nodes.

    Attributes
    ----------
    start, height : array (..., P, N - 1)
        ``x1`` and ``y`` of each point; ``y`` is positive to the left of the panel.
    square, log : array (..., P, N)
        Square and logarithm of the distance of each point from each node. At the node itself the
        logarithm is finite: there it only occurs multiplied with a distance that is 0.
    length : array (..., 1, N - 1)
        Panel lengths; 0 is allowed.
    """

    start: FloatArray
    height: FloatArray
    square: FloatArray
    log: FloatArray
    length: FloatArray

    @property
    def end(self) -> FloatArray:
        """Return ``x2`` of each point (..., P, N - 1)."""
        return self.start - self.length

    def angle(self) -> FloatArray:
        """Angle under which each point sees each panel, positive on its left [rad]."""
        cosine = self.start * self.length  # y^2 + x1 x2 = r1^2 - x1 L
        np.subtract(self.square[..., :-1], cosine, out=cosine)
        sine = self.height * self.length
        # arctan costs less than arctan2. Only points within the circle over a panel, few and near,
        # see it under more than a right angle; its own nodes lie on that circle.
        wide = np.flatnonzero(cosine <= 0.0)
        flat_sine, flat_cosine = sine.reshape(-1), cosine.reshape(-1)
        angles = np.arctan2(flat_sine[wide], flat_cosine[wide])
        flat_cosine[wide] = 1.0
        sine /= cosine
        np.arctan(sine, out=sine)
        flat_sine[wide] = angles
        return sine

    def log_ratio(self) -> FloatArray:
        """Return ``ln(r1 / r2)`` (..., P, N - 1)."""
        return self.log[..., :-1] - self.log[..., 1:]

    def divisor(self) -> FloatArray:
        """Return the lengths, with 1 for panels of no length, whose integrals are 0."""
        return np.where(self.length > 0.0, self.length, 1.0)


def view_panels(points: FloatArray, nodes: FloatArray) -> PanelView:
    """See points (..., P, 2) from the panels between consecutive nodes (..., N, 2)."""
    side = np.diff(nodes, axis=-2)
    length = np.hypot(side[..., 0], side[..., 1])
    # Any direction serves a panel of no length.
    side[length == 0.0] = (1.0, 0.0)
    tangent = side / np.where(length > 0.0, length, 1.0)[..., None]
    # The last node has no panel of its own; for its distance any direction serves.
    tangent = np.concatenate([tangent, tangent[..., -1:, :]], axis=-2)
    normal = np.stack([-tangent[..., 1], tangent[..., 0]], axis=-1)
    start = _distance(points, nodes, tangent)
    height = _distance(points, nodes, normal)
    square = start * start
    square += height * height
    log = np.maximum(square, np.finfo(np.float64).tiny)
    np.log(log, out=log)
    log *= 0.5
    return PanelView(start[..., :-1], height[..., :-1], square, log, length[..., None, :])


def _distance(points: FloatArray, nodes: FloatArray, direction: FloatArray) -> FloatArray:
    """Distance of each point from each node (..., P, N) in the direction that the node has."""
    # One product of (x, y, 1) with (direction, -offset): no temporary arrays of this size.
    ones = np.ones((*points.shape[:-1], 1))
    offset = np.sum(nodes * direction, axis=-1, keepdims=True)
    plane = np.concatenate([direction, -offset], axis=-1)
    result: FloatArray = np.concatenate([points, ones], axis=-1) @ plane.swapaxes(-1, -2)
    return result


def vortex_integrals(view: PanelView) -> tuple[FloatArray, FloatArray]:
    r"""Integrate the logarithm over panels, plain and weighted with the panel coordinate.

    With the substitution ``s = x1 - X``,

    .. math:: I_0 = \int_0^L \ln r\,ds = x_1 \ln r_1 - x_2 \ln r_2 - L + y \Delta\varphi,
    .. math:: I_1 = \int_0^L \frac{s}{L} \ln r\,ds = \frac{1}{L}\left[x_1 I_0
              - \tfrac14 r_1^2 (2 \ln r_1 - 1) + \tfrac14 r_2^2 (2 \ln r_2 - 1)\right].

    Returns
    -------
    plain, weighted : array (..., P, N - 1)
        ``I0`` and ``I1``: a strength that falls linearly from 1 at the start to 0 at the end
        has the integral ``I0 - I1``, one that grows from 0 to 1 has ``I1``.
    """
    # In place, because to make an array of this size costs more than to compute it.
    plain = view.angle()
    plain *= view.height
    term = view.start * view.log[..., :-1]
    plain += term
    np.subtract(view.start, view.length, out=term)
    term *= view.log[..., 1:]
    plain -= term
    plain -= view.length
    weighted = np.multiply(view.start, plain, out=term)
    moment = view.log - 0.5
    moment *= view.square
    moment *= 0.5
    weighted -= moment[..., :-1]
    weighted += moment[..., 1:]
    weighted /= view.divisor()
    return plain, weighted


def vortex_gradients(view: PanelView) -> tuple[FloatArray, FloatArray]:
    r"""Derive the vortex integrals with respect to the field point.

    Along the panel, :math:`\partial I_0 = \ln(r_1 / r_2)` and
    :math:`\partial I_1 = I_0 / L - \ln r_2`; across it, :math:`\partial I_0 = \Delta\varphi` and
    :math:`\partial I_1 = (x_1 \Delta\varphi - y \ln(r_1 / r_2)) / L`. No point may lie on a
    panel.

    Returns
    -------
    plain, weighted : array (2, ..., P, N - 1)
        Gradients of ``I0`` and ``I1`` in the local directions of each panel: along, across.
    """
    angle, ratio = view.angle(), view.log_ratio()
    integral, _ = vortex_integrals(view)
    along = integral / view.length - view.log[..., 1:]
    across = (view.start * angle - view.height * ratio) / view.length
    return np.stack([ratio, angle]), np.stack([along, across])


def source_integrals(view: PanelView) -> FloatArray:
    r"""Integrate the angle over panels (..., P, N - 1), up to a constant.

    .. math:: \int_0^L \theta\,ds = \text{const}
              - \left[X \operatorname{atan2}(X, y) - y \ln r\right]_{x_2}^{x_1}

    The angle is measured from the left normal, so that its branch cut leaves the panel to the
    right: away from the body when the panel closes a counter-clockwise contour.
    """
    start = view.start * np.arctan2(view.start, view.height)
    end = view.end * np.arctan2(view.end, view.height)
    return end - start + view.height * view.log_ratio()
