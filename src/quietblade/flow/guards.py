# SPDX-License-Identifier: LGPL-2.1-or-later
"""Checks of section contours before they are solved."""

import numpy as np

from quietblade.errors import GeometryError
from quietblade.flow.crossing import crossing_panels
from quietblade.flow.trailing_edge import close_sharp_edges
from quietblade.typing import BoolArray, FloatArray, IntArray

MIN_NODES = 20
"""Fewest nodes of a contour."""

MIN_PANEL = 1e-6
"""Shortest panel, as a fraction of the section's extent."""

MAX_OPENING = 0.1
"""Thickest trailing edge, as a fraction of the section's extent."""

NOSE_REGION = 0.02
"""Part of the section, from the nose, that must hold `MIN_NOSE_NODES` nodes."""

MIN_NOSE_NODES = 5
"""With fewer, the lift of a 6 % section is more than 0.5 % wrong and its suction peak arbitrary."""

MAX_TURN = np.radians(40.0)
"""Largest angle between neighbouring panels away from the nose and the trailing edge [rad]."""


class ContourError(GeometryError):
    """A section contour that the panel method cannot solve, or not to a useful accuracy."""


class TooFewNodesError(ContourError):
    """Fewer nodes than `MIN_NODES`."""


class LostNodesError(ContourError):
    """Coordinates that are not finite."""


class ClockwiseContourError(ContourError):
    """Nodes in the wrong order, or a section of no thickness."""


class OpenContourError(ContourError):
    """First and last node farther apart than a trailing edge is thick."""


class ClusteredNodesError(ContourError):
    """Nodes that nearly coincide."""


class UnresolvedNoseError(ContourError):
    """Too few nodes at the nose."""


class KinkedContourError(ContourError):
    """A corner away from the nose and the trailing edge."""


class CrossingContourError(ContourError):
    """Panels that cross."""


def check_contours(contours: FloatArray) -> None:
    """Refuse contours that the panel method cannot solve, or not to a useful accuracy.

    The extent of a section is the distance from the middle of its trailing edge to its farthest
    node, the nose.

    Parameters
    ----------
    contours : array (M, N, 2)
        Nodes in the order upper trailing edge, upper side, nose, lower side, lower trailing edge.

    Raises
    ------
    ContourError
        As one of its kinds: `TooFewNodesError`, `LostNodesError`, `ClockwiseContourError`,
        `OpenContourError`, `ClusteredNodesError`, `UnresolvedNoseError`, `KinkedContourError`,
        `CrossingContourError`. The message names the first section that is wrong, the value and
        the remedy.
    """
    _check_shape(contours)
    edge = 0.5 * (contours[:, :1] + contours[:, -1:])
    distance = np.linalg.norm(contours - edge, axis=-1)
    extent = distance.max(axis=-1)
    _check_order(contours, extent)
    _check_opening(contours, extent)
    _check_spacing(contours, extent)
    _check_nose(contours, edge[:, 0], np.argmax(distance, axis=-1))
    _check_crossing(contours)


def _refuse(
    kind: type[ContourError],
    wrong: BoolArray,
    what: str,
    values: FloatArray,
    limit: str,
    remedy: str,
) -> None:
    """Raise the error for the first section that is wrong."""
    if wrong.any():
        k = int(np.argmax(wrong))
        raise kind(
            f"section {k} of {len(wrong)} (counted from 0): {what}: {values[k]:.4g}, "
            f"limit {limit}. Remedy: {remedy}"
        )


def _check_shape(contours: FloatArray) -> None:
    if contours.ndim != 3 or contours.shape[-1] != 2 or len(contours) == 0:
        raise ContourError(
            f"section contours have shape {contours.shape}, expected (sections, nodes, 2)"
        )
    if contours.shape[1] < MIN_NODES:
        raise TooFewNodesError(
            f"section contours have {contours.shape[1]} nodes, limit at least {MIN_NODES}. "
            "Remedy: use about 160"
        )
    lost = np.count_nonzero(~np.isfinite(contours), axis=(1, 2)).astype(np.float64)
    what = "coordinates that are not finite"
    _refuse(LostNodesError, lost > 0.0, what, lost, "0", "look for NaN in the points")


def _check_order(contours: FloatArray, extent: FloatArray) -> None:
    x, y = contours[..., 0], contours[..., 1]
    area = 0.5 * np.sum(x * np.roll(y, -1, axis=1) - y * np.roll(x, -1, axis=1), axis=1)
    relative = area / np.where(extent > 0.0, extent, 1.0) ** 2
    _refuse(
        ClockwiseContourError,
        relative <= 0.0,
        "clockwise contour or no thickness (area / extent^2)",
        relative,
        "above 0",
        "order the nodes upper trailing edge -> nose -> lower trailing edge, and the sections "
        "from the root to the tip",
    )


def _check_opening(contours: FloatArray, extent: FloatArray) -> None:
    gap = np.linalg.norm(contours[:, 0] - contours[:, -1], axis=-1) / extent
    _refuse(
        OpenContourError,
        gap > MAX_OPENING,
        "open contour (distance of its ends / extent)",
        gap,
        f"at most {MAX_OPENING:g}",
        "begin and end the contour at the trailing edge",
    )


def _check_spacing(contours: FloatArray, extent: FloatArray) -> None:
    shortest = np.linalg.norm(np.diff(contours, axis=1), axis=-1).min(axis=-1) / extent
    _refuse(
        ClusteredNodesError,
        shortest < MIN_PANEL,
        "nodes that nearly coincide (shortest panel / extent)",
        shortest,
        f"at least {MIN_PANEL:g}",
        "use fewer nodes or spread them",
    )


def _check_nose(contours: FloatArray, edge: FloatArray, nose: IntArray) -> None:
    tip = np.take_along_axis(contours, nose[:, None, None], axis=1)[:, 0]
    chord = edge - tip
    position = np.einsum("mnd,md->mn", contours - tip[:, None], chord)
    position /= np.sum(chord * chord, axis=-1)[:, None]
    inside = position < NOSE_REGION
    count = np.count_nonzero(inside, axis=-1).astype(np.float64)
    _refuse(
        UnresolvedNoseError,
        count < MIN_NOSE_NODES,
        f"unresolved nose (nodes in the first {NOSE_REGION:g} of the section)",
        count,
        f"at least {MIN_NOSE_NODES}",
        "use more nodes or cluster them at the nose",
    )
    side = np.diff(contours, axis=1)
    before, after = side[:, :-1], side[:, 1:]
    turn = np.abs(
        np.arctan2(
            before[..., 0] * after[..., 1] - before[..., 1] * after[..., 0],
            np.sum(before * after, axis=-1),
        )
    )
    # Noise on the short last panels turns them by a lot without harm: edge excluded.
    smooth = ~inside[:, 1:-1] & (position[:, 1:-1] < 1.0 - NOSE_REGION)
    largest = np.where(smooth, turn, 0.0).max(axis=-1)
    _refuse(
        KinkedContourError,
        largest > MAX_TURN,
        "kink (angle between neighbouring panels [rad])",
        largest,
        f"at most {MAX_TURN:.2f}",
        "smooth the contour; a section cut from a faceted mesh does not serve",
    )


def _check_crossing(contours: FloatArray) -> None:
    # The corners of a sharp edge may have changed places by rounding.
    for k, contour in enumerate(close_sharp_edges(contours)):
        sides = crossing_panels(contour)
        if sides is not None:
            raise CrossingContourError(
                f"section {k} of {len(contours)} (counted from 0): panels {sides[0]} and "
                f"{sides[1]} cross. Remedy: look for a thickness below zero, or for a "
                "deformation too large for the section"
            )
