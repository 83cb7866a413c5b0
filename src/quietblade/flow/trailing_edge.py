# SPDX-License-Identifier: LGPL-2.1-or-later
"""The trailing edge of the panel method: tangents, blunt base, sharp edge."""

from dataclasses import dataclass

import numpy as np

from quietblade.flow.influence import (
    source_integrals,
    view_panels,
    vortex_gradients,
    vortex_integrals,
)
from quietblade.typing import BoolArray, FloatArray

SHARP_GAP = 1e-4
"""A trailing edge thinner than this fraction of the section's extent counts as sharp."""

PROBE_DEPTH = 0.1
"""Depth of the point without flow inside a sharp edge, in lengths of the shorter last panel."""


@dataclass(frozen=True, eq=False)
class TrailingEdge:
    """Trailing edges of M sections.

    Attributes
    ----------
    centre : array (M, 2)
        Middle of the two corners.
    sharp : bool array (M,)
        Whether the two corners coincide.
    bisector : array (M, 2)
        Unit vector that leaves the body between the two surfaces.
    source, vortex : array (M,)
        Strength of the base panel's source and vortex sheets per unit of the edge speed
        ``(gamma[0] - gamma[-1]) / 2``; 0 for a sharp edge, which has no base.
    """

    centre: FloatArray
    sharp: BoolArray
    bisector: FloatArray
    source: FloatArray
    vortex: FloatArray


def close_sharp_edges(contours: FloatArray) -> FloatArray:
    """Join the corners of edges that are thinner than `SHARP_GAP`; contours (M, N, 2).

    A base so thin is below the resolution of the last panels and would spoil their equations.
    """
    centre = 0.5 * (contours[:, 0] + contours[:, -1])
    extent = np.linalg.norm(contours - centre[:, None], axis=-1).max(axis=-1)
    gap = np.linalg.norm(contours[:, 0] - contours[:, -1], axis=-1)
    sharp = gap < SHARP_GAP * extent
    closed = contours.copy()
    closed[sharp, 0] = closed[sharp, -1] = centre[sharp]
    return closed


def trailing_edges(contours: FloatArray) -> TrailingEdge:
    """Describe the trailing edges of contours (M, N, 2) that run counter-clockwise.

    The dead water behind a blunt base moves with the edge speed along the mean of the two
    surface tangents: its flux through the base is the source, its slip along a slanted base the
    vortex. The mean tangent is not normalised, so that it carries the cosine of half the wedge
    angle (Drela, *XFOIL*, 1989).
    """
    upper = _leaving_tangent(contours[:, :4])
    lower = _leaving_tangent(contours[:, :-5:-1])
    mean = 0.5 * (upper + lower)
    centre = 0.5 * (contours[:, 0] + contours[:, -1])
    base = contours[:, 0] - contours[:, -1]
    gap = np.linalg.norm(base, axis=-1)
    along_base = base / np.where(gap > 0.0, gap, 1.0)[:, None]
    source = mean[:, 0] * along_base[:, 1] - mean[:, 1] * along_base[:, 0]
    vortex = -np.sum(mean * along_base, axis=-1)
    return TrailingEdge(centre, gap == 0.0, _bisector(upper, lower), source, vortex)


def _bisector(upper: FloatArray, lower: FloatArray) -> FloatArray:
    # The sum of the tangents vanishes at a round end, their difference at a cusp; the
    # difference turned by a right angle is parallel to the sum, so both together never vanish.
    across = lower - upper
    direction = upper + lower + np.stack([across[:, 1], -across[:, 0]], axis=-1)
    return _unit(direction)


def _leaving_tangent(nodes: FloatArray) -> FloatArray:
    """Return tangents that leave curves at their first node, from the cubic through four."""
    steps = np.linalg.norm(np.diff(nodes, axis=1), axis=-1)
    s = np.concatenate([np.zeros((len(nodes), 1)), np.cumsum(steps, axis=1)], axis=1)
    apart = s[:, :, None] - s[:, None, :] + np.eye(s.shape[1])
    barycentric = 1.0 / np.prod(apart, axis=2)
    derivative = np.zeros_like(s)
    derivative[:, 1:] = -barycentric[:, 1:] / (barycentric[:, :1] * s[:, 1:])
    derivative[:, 0] = -derivative.sum(axis=1)
    tangent = -np.einsum("mk,mkd->md", derivative, nodes)
    return _unit(tangent)


def _unit(vectors: FloatArray) -> FloatArray:
    result: FloatArray = vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)
    return result


def base_influence(contours: FloatArray, edge: TrailingEdge) -> FloatArray:
    """Stream function of the base panel at the nodes (M, N), per unit of the edge speed."""
    view = view_panels(contours, contours[:, [-1, 0]])
    plain, _ = vortex_integrals(view)
    influence = edge.source[:, None] * source_integrals(view)[..., 0]
    influence += edge.vortex[:, None] * plain[..., 0]
    return influence / (2.0 * np.pi)


def sharp_edge_equation(contour: FloatArray, edge: TrailingEdge, k: int) -> FloatArray:
    """Velocity along the bisector just inside the sharp edge of section ``k``, by node (N,).

    The two corner nodes of a sharp edge coincide and give the same equation; this one takes the
    place of the second. It says that the fluid inside is at rest.
    """
    last = np.linalg.norm(contour[[0, -1]] - contour[[1, -2]], axis=-1)
    probe = edge.centre[k] - PROBE_DEPTH * last.min() * edge.bisector[k]
    plain, weighted = vortex_gradients(view_panels(probe[None], contour))
    # Along the bisector the velocity is the derivative of psi along the bisector's left normal.
    left = np.array([-edge.bisector[k, 1], edge.bisector[k, 0]])
    side = np.diff(contour, axis=0)
    tangent = _unit(side)
    along, across = tangent @ left, tangent[:, 0] * left[1] - tangent[:, 1] * left[0]
    total = (along * plain[0] + across * plain[1])[0]
    growing = (along * weighted[0] + across * weighted[1])[0]
    row = np.zeros(len(contour))
    row[:-1] = total - growing
    row[1:] += growing
    return row / (2.0 * np.pi)
