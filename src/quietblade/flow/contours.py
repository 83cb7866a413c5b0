# SPDX-License-Identifier: LGPL-2.1-or-later
"""Integrals along closed section contours."""

import numpy as np

from quietblade.typing import FloatArray


def contour_loads(
    contours: FloatArray, pressure: FloatArray, centre: FloatArray
) -> tuple[FloatArray, FloatArray]:
    r"""Integrate a pressure over closed contours, the closing panel included.

    .. math:: F = -\oint p\,n\,ds, \qquad m = -\oint p\,(x - x_c) \times n\,ds

    exactly for a pressure that is linear on each panel; n points out of the contour.

    Parameters
    ----------
    contours : array (M, N, 2)
        Nodes, counter-clockwise.
    pressure : array (..., M, N)
        Pressure at the nodes.
    centre : array (2,)
        Point to which the moment refers.

    Returns
    -------
    force : array (..., M, 2)
    moment : array (..., M)
        Counter-clockwise positive.
    """
    side = np.roll(contours, -1, axis=-2) - contours
    middle = contours + 0.5 * side - centre
    following = np.roll(pressure, -1, axis=-1)
    mean, rise = 0.5 * (pressure + following), following - pressure
    # n ds = (dy, -dx) on a counter-clockwise contour
    force = np.stack([-np.sum(mean * side[..., 1], -1), np.sum(mean * side[..., 0], -1)], -1)
    arm = np.sum(middle * side, axis=-1)
    square = np.sum(side * side, axis=-1)
    moment = np.sum(mean * arm + rise * square / 12.0, axis=-1)
    return force, moment
