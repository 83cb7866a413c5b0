# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pressure of the sections as a finite-element field on the wetted surface.

A point of the upper or lower side takes the pressure at its material place: bilinear in the span
fraction and the contour parameter, which resolves the nose like the square root of the chord
fraction. Two faces lie between the sides, and no section runs along them: points of the tip face
and of the trailing-edge face take the pressures of the upper and the lower side at the same chord
fraction, interpolated by the height between them (at the trailing edge: the mean in the middle).

The nodal field is the least-squares projection of this pressure. Values picked at the nodes would
miss a suction peak narrower than an element; the projection keeps the integral of the pressure
with every shape function. What it cannot keep is the jump of the pressure from the lower to the
upper side over a nose that is one element wide, because a nodal field is continuous.
"""

import numpy as np
from scipy.sparse import csr_array, diags_array
from scipy.sparse.linalg import splu

from quietblade.errors import MeshError
from quietblade.geometry import Blade
from quietblade.mesh.surface import SurfaceQuadrature, shape_derivatives, shape_functions
from quietblade.typing import BoolArray, FloatArray, IntArray

_ON_PLANE = 1e-4  # of the span: nodes of the root and tip faces
_NOSE = 0.1  # chord fraction up to which the suction peak may reach
_DIVISIONS, _NOSE_DIVISIONS = 4, 16  # of an element's edge, for quadrature


class SectionPressure:
    """Projection of section pressures to the nodes of a surface.

    Parameters
    ----------
    surface : SurfaceQuadrature
        Wetted surface in the undeformed configuration, without the root face.
    blade : Blade
    s : ndarray, shape (M,)
        Span fractions of the sections, from 0 to 1.
    count : int
        Nodes a section.

    Raises
    ------
    MeshError
        The surface contains the root face.
    """

    def __init__(self, surface: SurfaceQuadrature, blade: Blade, s: FloatArray, count: int) -> None:
        nodes = surface.nodes
        on_side = _side_triangles(surface, blade)
        at_nose = blade.locate(surface.points)[1][surface.triangles].min(axis=1) < _NOSE
        mass = csr_array((len(nodes), len(nodes)))
        load = csr_array((len(nodes), len(s) * count))
        squares, share = load.copy(), np.zeros(len(nodes))
        for group, divisions in ((~at_nose, _DIVISIONS), (at_nose, _NOSE_DIVISIONS)):
            triangles = surface.triangles[group]
            uv = _midpoints(divisions)
            area = _area(surface.points[triangles], uv).ravel()
            shape = _operator(np.searchsorted(nodes, triangles), uv, len(nodes))
            points = shape @ surface.points[nodes]
            side = np.repeat(on_side[group], len(uv))
            sections = _from_sections(blade, points, side, s, count)
            weighted = shape.T @ diags_array(area)
            weighted_square = weighted.multiply(shape.T)
            mass = mass + weighted @ shape
            load = load + weighted @ sections
            squares = squares + weighted_square @ sections
            share += weighted_square.sum(axis=1)
        self._factor = splu(mass.tocsc())
        self._load = csr_array(load)
        self._squares = csr_array(diags_array(1.0 / share) @ squares)

    def project(self, pressure: FloatArray) -> FloatArray:
        """Nodal pressure (in the order of ``surface.nodes``) from pressures (M, count) [Pa]."""
        load = np.asarray(self._load @ pressure.ravel(), dtype=np.float64)
        return np.asarray(self._factor.solve(load))

    def mean_square(self, pressure: FloatArray) -> FloatArray:
        """Mean of the squared pressure (M, count) around each of ``surface.nodes`` [Pa^2]."""
        return np.asarray(self._squares @ pressure.ravel() ** 2)


def _midpoints(divisions: int) -> FloatArray:
    """Centroids of the equal small triangles of the reference triangle, (divisions^2, 2)."""
    n = divisions
    up = [(3 * i + 1, 3 * j + 1) for i in range(n) for j in range(n - i)]
    down = [(3 * i + 2, 3 * j + 2) for i in range(n - 1) for j in range(n - 1 - i)]
    return np.array(up + down) / (3.0 * n)


def _area(nodes: FloatArray, uv: FloatArray) -> FloatArray:
    tangents = np.einsum("qda,nak->nqdk", shape_derivatives(uv), nodes)
    normal = np.cross(tangents[:, :, 0], tangents[:, :, 1])
    return np.asarray(0.5 / len(uv) * np.linalg.norm(normal, axis=-1))


def _operator(triangles: IntArray, uv: FloatArray, count: int) -> csr_array:
    n = len(triangles) * len(uv)
    columns = np.repeat(triangles, len(uv), axis=0).ravel()
    data = np.tile(shape_functions(uv), (len(triangles), 1)).ravel()
    return csr_array((data, (np.repeat(np.arange(n), 6), columns)), shape=(n, count))


def _from_sections(
    blade: Blade, points: FloatArray, side: BoolArray, s: FloatArray, count: int
) -> csr_array:
    """Matrix from section pressures to the pressure at points, (P, M * count)."""
    place, xi, eta = blade.locate(points)
    place = np.clip(place, 0.0, 1.0)
    shape = (blade.thickness(place), blade.camber(place), blade.trailing_edge)
    upper = eta > blade.family.camber_line(xi, blade.camber(place))[0]
    share = upper.astype(np.float64)
    between = ~side
    inner = tuple(np.broadcast_to(part, place.shape)[between] for part in shape)
    faces = [
        blade.family.point(blade.family.parameter_at(sign, xi[between], *inner), *inner)[..., 1]
        for sign in (1, -1)
    ]
    height = (eta[between] - faces[1]) / np.maximum(faces[0] - faces[1], 1e-12)
    share[between] = np.clip(height, 0.0, 1.0)
    result = csr_array((len(place), len(s) * count))
    for sign, part in ((1, share), (-1, 1.0 - share)):
        used = np.flatnonzero(part > 0.0)
        phi = blade.family.parameter_at(
            sign, xi[used], *(np.broadcast_to(a, place.shape)[used] for a in shape)
        )
        matrix = diags_array(part[used]) @ _bilinear(place[used], phi, s, count)
        spread = csr_array(
            (np.ones(len(used)), (used, np.arange(len(used)))), shape=(len(place), len(used))
        )
        result = result + spread @ matrix
    return csr_array(result)


def _bilinear(place: FloatArray, phi: FloatArray, s: FloatArray, count: int) -> csr_array:
    """Interpolation in span fraction and contour parameter from a grid (M, count)."""
    j = np.clip(np.searchsorted(s, place, side="right") - 1, 0, len(s) - 2)
    a = (place - s[j]) / (s[j + 1] - s[j])
    index = 0.5 * (phi + 1.0) * (count - 1)
    i = np.clip(index.astype(np.int64), 0, count - 2)
    b = index - i
    rows = np.arange(len(place))
    parts = [((1 - a) * (1 - b), 0, 0), ((1 - a) * b, 0, 1), (a * (1 - b), 1, 0), (a * b, 1, 1)]
    return csr_array(
        (
            np.concatenate([value for value, _, _ in parts]),
            (np.tile(rows, 4), np.concatenate([(j + u) * count + i + v for _, u, v in parts])),
        ),
        shape=(len(place), len(s) * count),
    )


def _side_triangles(surface: SurfaceQuadrature, blade: Blade) -> BoolArray:
    """Triangles of the upper and lower side; the others are the tip and trailing-edge face."""
    place, xi, eta = blade.locate(surface.points)
    inside = np.clip(place, 0.0, 1.0)
    edge = blade.family.contour(
        blade.thickness(inside), blade.camber(inside), blade.trailing_edge, 5
    )[:, [0, -1]]
    across = edge[:, 0] - edge[:, 1]
    normal = np.stack([across[:, 1], -across[:, 0]], axis=1) / blade.trailing_edge
    offset = np.sum((np.stack([xi, eta], axis=1) - edge[:, 1]) * normal, axis=1)

    def whole(flag: BoolArray) -> BoolArray:
        return np.asarray(np.all(flag[surface.triangles], axis=1))

    if np.any(whole(np.abs(place) < _ON_PLANE)):
        raise MeshError(
            "load transfer: the wetted surface contains the root face, which is clamped and "
            "carries no load; leave it out"
        )
    tip = whole(np.abs(place - 1.0) < _ON_PLANE)
    trailing = whole(np.abs(offset) < 0.1 * blade.trailing_edge)
    return np.asarray(~tip & ~trailing)
