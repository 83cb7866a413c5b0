# SPDX-License-Identifier: LGPL-2.1-or-later
"""Directions of plies and films, constant or turning along the blade."""

from typing import TypeAlias

import ngsolve as ngs
import numpy as np

from quietblade.errors import MaterialError
from quietblade.typing import FloatArray

Axes: TypeAlias = FloatArray | ngs.CoefficientFunction
"""A rotation whose columns are three unit axes: (3, 3) array, or function of place."""

Direction: TypeAlias = FloatArray | ngs.CoefficientFunction
"""A unit vector: (3,) array, or function of place."""

Scalar: TypeAlias = float | ngs.CoefficientFunction

_TOLERANCE = 1e-9


def as_coefficient(axes: Axes) -> ngs.CoefficientFunction:
    """Return the axes as a 3x3 CoefficientFunction."""
    if isinstance(axes, ngs.CoefficientFunction):
        return axes
    return ngs.CF(tuple(np.asarray(axes, dtype=float).ravel()), dims=(3, 3))


def check_axes(owner: str, axes: Axes) -> None:
    """Check that axes have the right shape and, if they are numbers, are a rotation.

    Raises
    ------
    MaterialError
        If they are not.
    """
    if isinstance(axes, ngs.CoefficientFunction):
        if tuple(axes.dims) != (3, 3):
            raise MaterialError(f"{owner!r}: axes have dimensions {tuple(axes.dims)}, not (3, 3)")
        return
    matrix = np.asarray(axes, dtype=float)
    if matrix.shape != (3, 3):
        raise MaterialError(f"{owner!r}: axes have shape {matrix.shape}, not (3, 3)")
    defect = float(np.abs(matrix.T @ matrix - np.eye(3)).max())
    if defect > _TOLERANCE or np.linalg.det(matrix) < 0:
        raise MaterialError(
            f"{owner!r}: axes are not a rotation: |A^T A - 1| = {defect:.3g}, "
            f"det A = {np.linalg.det(matrix):.6g}. Give right-handed unit columns, "
            "for example by ply_axes()."
        )


def section_directions(
    blade_angle: Scalar = 0.0,
) -> tuple[Direction, Direction, Direction]:
    """Span, chordwise and thickness directions of a section of given blade angle.

    Span e_z, chordwise t from leading to trailing edge, thickness n to the upper side:
    ``t = (cos a, -sin a, 0)``, ``n = (sin a, cos a, 0)``.  They are right-handed in the order
    (t, n, span) and therefore also as (span, t, n).

    Parameters
    ----------
    blade_angle : float or CoefficientFunction
        Blade angle [rad], for a twisted blade a function of ``ngsolve.z``.
    """
    if isinstance(blade_angle, ngs.CoefficientFunction):
        c, s = ngs.cos(blade_angle), ngs.sin(blade_angle)
        return ngs.CF((0, 0, 1)), ngs.CF((c, -s, 0)), ngs.CF((s, c, 0))
    c, s = np.cos(blade_angle), np.sin(blade_angle)
    return np.array([0.0, 0.0, 1.0]), np.array([c, -s, 0.0]), np.array([s, c, 0.0])


def ply_axes(angle: float, span: Direction, chordwise: Direction, thickness: Direction) -> Axes:
    """Axes of a ply turned by an angle from the span about the thickness direction.

    Axis 1 is ``cos(angle) span + sin(angle) chordwise``, axis 3 the thickness direction, axis 2
    completes them.

    Parameters
    ----------
    angle : float
        Fibre angle [rad], zero along the span, positive from the span towards `chordwise`.
    span, chordwise, thickness : (3,) array or CoefficientFunction
        Orthonormal directions, right-handed in this order.

    Returns
    -------
    (3, 3) array, or CoefficientFunction if a direction is one
        Its columns are the axes 1, 2, 3.
    """
    c, s = float(np.cos(angle)), float(np.sin(angle))
    directions = (span, chordwise, thickness)
    if any(isinstance(d, ngs.CoefficientFunction) for d in directions):
        e, t, n = (
            d if isinstance(d, ngs.CoefficientFunction) else ngs.CF(tuple(d)) for d in directions
        )
        first, second = c * e + s * t, c * t - s * e
        rows = [v[i] for v in (first, second, n) for i in range(3)]
        return ngs.CF(tuple(rows), dims=(3, 3)).trans
    e, t, n = (np.asarray(d, dtype=float) for d in directions)
    axes: FloatArray = np.stack([c * e + s * t, c * t - s * e, n], axis=1)
    check_axes("ply", axes)
    return axes
