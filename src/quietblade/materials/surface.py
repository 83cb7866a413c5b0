# SPDX-License-Identifier: LGPL-2.1-or-later
"""Directions and depths that follow the surface of a blade, as functions of place in C0.

The camber surface of the blade gives the directions, so that plies and film lie in it: axis 3 is
its normal, the zero of the ply angle the reference line's tangent projected on it.  Material off
the camber surface has the directions of the point under it, along the section's normal.

Both are exact at the nodes of a mesh and second-order polynomials between them.  Energies are
evaluated dozens of times at each quadrature point, and fields on the mesh are by far the cheapest
functions of place there.
"""

from collections.abc import Callable
from dataclasses import dataclass

import ngsolve as ngs
import numpy as np
from numpy.typing import ArrayLike

from quietblade.errors import GeometryError
from quietblade.geometry import Blade
from quietblade.materials.axes import Axes, as_coefficient
from quietblade.materials.voigt import in_plane_rotation
from quietblade.mesh.nodal import NodalBasis
from quietblade.typing import FloatArray, IntArray

# Step of the span fraction for differences: truncation and rounding both stay below 1e-9.
_STEP = 1e-5

_CONSTANT = 1e-9

# Cosine of half the largest turn from the middle of the blade that can be interpolated (150 deg).
_LEAST_COSINE = 0.25


def surface_frame(blade: Blade, s: ArrayLike, xi: ArrayLike) -> FloatArray:
    """Directions of the camber surface (theory: S1-46).

    Parameters
    ----------
    blade : Blade
    s, xi : array_like
        Span and chord fraction, 0 to 1; broadcast to shape (...).

    Returns
    -------
    ndarray, shape (..., 3, 3)
        Columns: along the span, chordwise (towards the trailing edge) and normal (to the upper
        side); a rotation.  Where a table of the blade has a kink along the span, the mean of both
        sides.
    """
    s, xi = np.broadcast_arrays(np.asarray(s, dtype=float), np.asarray(xi, dtype=float))
    on_line = np.broadcast_to([blade.alignment, 0.0], (*s.shape, 2))
    reference = _along_span(lambda at: blade.place(at, on_line), s)
    normal = _normal(blade, s, xi)
    span = reference - np.sum(reference * normal, axis=-1, keepdims=True) * normal
    span /= np.linalg.norm(span, axis=-1, keepdims=True)
    return np.stack([span, np.cross(normal, span), normal], axis=-1)


def surface_axes(blade: Blade, basis: NodalBasis, region: str, angle: float = 0.0) -> Axes:
    """Axes of a ply or film that lies in the blade, as a function of place in C0.

    Parameters
    ----------
    blade : Blade
    basis : NodalBasis
        Nodes of the mesh.
    region : str
        Name pattern of the regions where the axes are wanted.
    angle : float
        Ply angle [rad], zero along the span, positive towards the trailing edge.

    Returns
    -------
    (3, 3) float array, or CoefficientFunction
        Columns: axes 1, 2, 3; a rotation everywhere.  An array if they are the same everywhere, as
        on a blade without twist, camber, rake and sweep.

    Raises
    ------
    GeometryError
        If the surface turns by more than 150 degrees from the middle of its nodes.
    """
    nodes = basis.nodes_of(region)
    s, xi = _clipped(blade, basis.points[nodes])
    frames = surface_frame(blade, s, xi)
    middle = surface_frame(blade, np.mean(s), np.mean(xi))
    turned = in_plane_rotation(angle)
    if float(np.abs(frames - middle).max()) < _CONSTANT:
        return np.asarray(middle @ turned)
    turn = _field(basis, nodes, _turn(np.einsum("ji,njk->nik", middle, frames)))
    return as_coefficient(middle) * _rotation(turn) * as_coefficient(turned)


@dataclass(frozen=True, eq=False)
class Depth:
    """Distances [m] from the faces, along the section's normal, as functions of place in C0.

    Attributes
    ----------
    region : str
        Name pattern of the regions where they are known.
    below, above : GridFunction
        From the lower and from the upper face, positive inside the blade.
    """

    region: str
    below: ngs.GridFunction
    above: ngs.GridFunction

    @property
    def fem(self) -> ngs.Mesh:
        """The mesh."""
        return self.below.space.mesh

    @classmethod
    def of_nodes(
        cls, basis: NodalBasis, region: str, below: FloatArray, above: FloatArray
    ) -> "Depth":
        """Make it from distances (n,) at the nodes of a region, in the order of `nodes_of`."""
        nodes = basis.nodes_of(region)
        return cls(region, _field(basis, nodes, below), _field(basis, nodes, above))


def surface_depth(blade: Blade, basis: NodalBasis, region: str) -> Depth:
    """Return how deep a place lies in the blade, from either face (theory: S1-47).

    Parameters
    ----------
    blade : Blade
    basis : NodalBasis
        Nodes of the mesh.
    region : str
        Name pattern of the regions where the depth is wanted.
    """
    points = basis.points[basis.nodes_of(region)]
    s, xi = _clipped(blade, points)
    chord, height = blade.chord(s), blade.locate(points)[2]
    below, above = (chord * side * (blade.face_height(side, s, xi) - height) for side in (-1, +1))
    return Depth.of_nodes(basis, region, below, above)


def _clipped(blade: Blade, points: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Span and chord fractions, on the blade even if rounding or camber puts them beside it."""
    s, xi, _ = blade.locate(points)
    return np.clip(s, 0.0, 1.0), np.clip(xi, 0.0, 1.0)


def _field(basis: NodalBasis, nodes: IntArray, values: FloatArray) -> ngs.GridFunction:
    """Scalar or vector field with values at some nodes, zero at the others."""
    every = np.zeros((len(basis.points), *values.shape[1:]))
    every[nodes] = values
    space = ngs.H1 if values.ndim == 1 else ngs.VectorH1
    field = ngs.GridFunction(space(basis.fem, order=2))
    field.vec.FV().NumPy()[:] = basis.to_dofs(every)
    return field


def _turn(rotations: FloatArray) -> FloatArray:
    """``tan(angle / 2) axis`` of rotations, (n, 3): they interpolate to rotations."""
    # twice the cosine of half the angle is sqrt(1 + trace)
    double = np.sqrt(np.maximum(1.0 + np.trace(rotations, axis1=1, axis2=2), 0.0))
    if float(double.min()) < 2.0 * _LEAST_COSINE:
        raise GeometryError(
            "blade: its surface turns by more than 150 degrees from the middle; fibres cannot "
            "follow a blade twisted so much"
        )
    R = rotations
    skew = np.stack([R[:, 2, 1] - R[:, 1, 2], R[:, 0, 2] - R[:, 2, 0], R[:, 1, 0] - R[:, 0, 1]], 1)
    turn: FloatArray = skew / double[:, None] ** 2
    return turn


def _rotation(turn: ngs.CoefficientFunction) -> ngs.CoefficientFunction:
    """Rotation of ``g = tan(angle / 2) axis`` (Cayley's formula, Gibbs' vector)."""
    x, y, z = (turn[i] for i in range(3))
    square = x * x + y * y + z * z
    cross = ngs.CF((0.0, -z, y, z, 0.0, -x, -y, x, 0.0), dims=(3, 3))
    dyad = ngs.OuterProduct(turn, turn)
    return ((1.0 - square) * ngs.Id(3) + 2.0 * dyad + 2.0 * cross) / (1.0 + square)


def _normal(blade: Blade, s: FloatArray, xi: FloatArray) -> FloatArray:
    """Return the unit normal of the camber surface to the upper side, (..., 3)."""

    def camber_surface(at: FloatArray) -> FloatArray:
        height = blade.family.camber_line(xi, blade.camber(at))[0]
        return blade.place(at, np.stack(np.broadcast_arrays(xi, height), axis=-1))

    _, t, n = blade.frame(s)
    slope = np.broadcast_to(blade.family.camber_line(xi, blade.camber(s))[1], s.shape)
    chordwise = t + slope[..., None] * n
    normal = np.cross(_along_span(camber_surface, s), chordwise)
    unit: FloatArray = normal / np.linalg.norm(normal, axis=-1, keepdims=True)
    return unit


def _along_span(place: Callable[[FloatArray], FloatArray], s: FloatArray) -> FloatArray:
    """Differentiate points by the span fraction, by central differences inside the blade."""
    after, before = np.minimum(s + _STEP, 1.0), np.maximum(s - _STEP, 0.0)
    slope: FloatArray = (place(after) - place(before)) / (after - before)[..., None]
    return slope
