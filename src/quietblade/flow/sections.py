# SPDX-License-Identifier: LGPL-2.1-or-later
r"""Material sections of the deformed blade, as the flow sees them.

The nodes of an undeformed section move with the blade. In general they then no longer lie in one
plane, nor in a plane normal to the deformed span. Strip theory needs the plane section normal to
the span, so the nodes are projected along the span tangent on the plane normal to it. This is
exact for a blade that is locally a cylinder along its span: a node and its projection lie on the
same generator. Two consequences:

- A material section whose chord is tilted by the angle :math:`\Lambda` out of the normal plane (a
  swept or sheared blade) keeps its thickness while its chord shrinks by :math:`\cos\Lambda`. With
  the normal velocity :math:`W \cos\Lambda` and the span longer by :math:`1 / \cos\Lambda` this is
  simple sweep theory: the lift falls by :math:`\cos\Lambda`.
- On a tapered blade the generators fan out; the projection then errs by the product of taper and
  tilt. `DeformedSections.tilt` and `DeformedSections.warp` say how far the sections are from the
  case in which the projection does nothing.

The section frame is planar, not the cylinder of constant radius on which propellers are drawn. The
two agree where the chord is short against the radius: the arc of a chord c across the radius r is
longer by the fraction (c/r)^2 / 24, and its ends lie off the plane by c^2 / (8 r).
"""

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from quietblade.errors import GeometryError
from quietblade.typing import FloatArray

AXIS = np.array([1.0, 0.0, 0.0])
"""Direction of the rotor axis, positive downstream."""

_GAUSS_POINTS, _GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(4)


@dataclass(frozen=True, eq=False)
class DeformedSections:
    """M sections with N nodes each, projected on the planes normal to the deformed span.

    Attributes
    ----------
    reference : array (M, 3)
        Mid-chord points [m]: between the nose node and the middle of the trailing edge.
    tangent : array (M, 3)
        Unit tangent of the line through the mid-chord points, from the first section to the last.
    arc_length : array (M,)
        Length of that line from the first section [m].
    chord : array (M,)
        Projected chord [m].
    chord_direction : array (M, 3)
        Unit vector ``t`` of the projected chord, nose to trailing edge.
    normal : array (M, 3)
        Unit vector ``n = tangent x t``, towards the upper side.
    contours : array (M, N, 2)
        Projected nodes in units of the projected chord, the nose node at (0, 0), the middle of
        the trailing edge at (1, 0).
    blade_angle : array (M,)
        Angle of the chord from the rotor axis projected on the section plane, nose up positive
        [rad].
    camber : array (M,)
        Largest distance of the mean line from the chord, in chords, with its sign. The mean line
        is the middle between the nodes that stand opposite, which on NACA sections is their
        camber line.
    tilt : array (M,)
        Angle between the material chord and the section plane [rad], positive if the trailing
        edge is farther along the span; the chord has shrunk by its cosine.
    warp : array (M,)
        Largest distance of a node from the material chord in the direction of the span, beyond
        the tilt, in chords.
    """

    reference: FloatArray
    tangent: FloatArray
    arc_length: FloatArray
    chord: FloatArray
    chord_direction: FloatArray
    normal: FloatArray
    contours: FloatArray
    blade_angle: FloatArray
    camber: FloatArray
    tilt: FloatArray
    warp: FloatArray

    def thickness(self) -> FloatArray:
        """Largest distance between nodes that stand opposite (M,), in chords."""
        result: FloatArray = self.thickness_distribution().max(axis=-1)
        return result

    def thickness_distribution(self) -> FloatArray:
        """Distance between nodes that stand opposite (M, N // 2 + 1), nose to edge, in chords."""
        half = self.contours.shape[1] // 2
        opposite = self.contours[:, half::-1] - self.contours[:, half:]
        result: FloatArray = np.linalg.norm(opposite, axis=-1)
        return result

    def mean_line(self) -> FloatArray:
        """Middles between nodes that stand opposite (M, N // 2 + 1, 2), nose to edge, in chords."""
        half = self.contours.shape[1] // 2
        return 0.5 * (self.contours[:, half::-1] + self.contours[:, half:])


def section_frames(points: FloatArray) -> DeformedSections:
    """Project deformed sections on the planes normal to the deformed span.

    Parameters
    ----------
    points : array (M, N, 3)
        Deformed nodes [m]: sections from the root to the tip, each in the order upper trailing
        edge, upper side, nose, lower side, lower trailing edge. N is odd and the middle node the
        nose of the undeformed section.

    Returns
    -------
    DeformedSections

    Raises
    ------
    GeometryError
        Fewer than two sections, N even, values that are not finite, sections at the same place,
        or a chord along the span.
    """
    points = np.asarray(points, dtype=np.float64)
    _check(points)
    nose = points[:, points.shape[1] // 2]
    chord_vector = 0.5 * (points[:, 0] + points[:, -1]) - nose
    reference = nose + 0.5 * chord_vector
    tangent, arc_length = _span_line(reference)

    out_of_plane = _dot(chord_vector, tangent)
    in_plane = chord_vector - out_of_plane[:, None] * tangent
    chord = np.linalg.norm(in_plane, axis=-1)
    if not np.all(chord > 1e-9 * np.linalg.norm(chord_vector, axis=-1)):
        k = int(np.argmin(chord))
        raise GeometryError(
            f"section {k} of {len(points)} (counted from 0): its chord is 0 or runs along the "
            "span. Remedy: check the order of the nodes and the deformation"
        )
    chord_direction = in_plane / chord[:, None]
    normal = np.cross(tangent, chord_direction)

    arm = (points - nose[:, None]) / chord[:, None, None]
    axes = np.stack([chord_direction, normal], axis=-1)
    contours = arm @ axes
    height = (
        np.einsum("mnd,md->mn", arm, tangent) - contours[..., 0] * (out_of_plane / chord)[:, None]
    )
    return DeformedSections(
        reference=reference,
        tangent=tangent,
        arc_length=arc_length,
        chord=chord,
        chord_direction=chord_direction,
        normal=normal,
        contours=contours,
        blade_angle=np.arctan2(normal @ AXIS, chord_direction @ AXIS),
        camber=_camber(contours),
        tilt=np.arctan2(out_of_plane, chord),
        warp=np.abs(height).max(axis=-1),
    )


def _check(points: FloatArray) -> None:
    if points.ndim != 3 or points.shape[-1] != 3 or points.shape[0] < 2:
        raise GeometryError(
            f"deformed sections have shape {points.shape}, expected (sections, nodes, 3) with at "
            "least 2 sections"
        )
    if points.shape[1] % 2 == 0:
        raise GeometryError(
            f"deformed sections have {points.shape[1]} nodes. "
            "Remedy: use an odd number, so that the middle node is the nose"
        )
    if not np.isfinite(points).all():
        k = int(np.argmin(np.isfinite(points).all(axis=(1, 2))))
        raise GeometryError(
            f"section {k} of {len(points)} (counted from 0) has coordinates that are not finite. "
            "Remedy: look for NaN in the displacement"
        )


def _span_line(reference: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return tangents (M, 3) and arc length (M,) of the cubic spline through the points."""
    steps = np.linalg.norm(np.diff(reference, axis=0), axis=-1)
    if not np.all(steps > 0.0):
        k = int(np.argmin(steps))
        raise GeometryError(
            f"sections {k} and {k + 1} (counted from 0) have the same mid-chord point. "
            "Remedy: give sections at different places of the span"
        )
    parameter = np.concatenate([[0.0], np.cumsum(steps)])
    slope = CubicSpline(parameter, reference).derivative()
    tangent = slope(parameter)
    tangent /= np.linalg.norm(tangent, axis=-1, keepdims=True)
    inside = parameter[:-1, None] + 0.5 * steps[:, None] * (1.0 + _GAUSS_POINTS)
    speed = np.linalg.norm(slope(inside), axis=-1)
    lengths = 0.5 * steps * (speed @ _GAUSS_WEIGHTS)
    return tangent, np.concatenate([[0.0], np.cumsum(lengths)])


def _camber(contours: FloatArray) -> FloatArray:
    half = contours.shape[1] // 2
    mean_line = 0.5 * (contours[:, : half + 1, 1] + contours[:, : half - 1 : -1, 1])
    largest = np.argmax(np.abs(mean_line), axis=1)
    result: FloatArray = np.take_along_axis(mean_line, largest[:, None], axis=1)[:, 0]
    return result


def _dot(a: FloatArray, b: FloatArray) -> FloatArray:
    result: FloatArray = np.sum(a * b, axis=-1)
    return result
