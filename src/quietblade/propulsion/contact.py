# SPDX-License-Identifier: LGPL-2.1-or-later
"""Does the deformed surface cross itself?  There is no contact force: if so, the state is not real.

Cells that are turned inside out are found by det F; this is about distant parts of the surface
that pass through each other, as those of a thin blade that folds back.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from quietblade.propulsion.forms import StructuralForms
from quietblade.typing import BoolArray, FloatArray, IntArray

_QUADRILATERALS = (11, 13, 14)
"""Netgen's types of faces with four corners: of 4, 6 and 8 nodes."""


@dataclass(frozen=True)
class Crossing:
    """Where a surface crosses itself.

    Attributes
    ----------
    pairs : int
        Pairs of triangles that cross.
    places : (2, 3) float array
        Where the two triangles of the first pair are in the undeformed configuration [m].
    """

    pairs: int
    places: FloatArray


class SurfaceCrossing:
    """The wetted surface as flat triangles between the vertices of the mesh.

    Parameters
    ----------
    forms : StructuralForms
        Their wetted boundaries.
    """

    def __init__(self, forms: StructuralForms) -> None:
        self._fem = forms.fem
        self._regions = np.array(forms.boundary(forms.wetted).Mask(), dtype=bool)

    @cached_property
    def points(self) -> FloatArray:
        """Vertices of the mesh, (n, 3) [m]."""
        return np.array(self._fem.ngmesh.Coordinates())

    @cached_property
    def triangles(self) -> IntArray:
        """Vertex numbers, (m, 3); quadrilaterals are two triangles."""
        mesh = self._fem.ngmesh
        faces = mesh.Elements2D().NumPy()
        numbers = range(1, int(faces["index"].max()) + 1)
        boundary = np.array([mesh.FaceDescriptor(number).bc - 1 for number in numbers])
        faces = faces[self._regions[boundary[faces["index"] - 1]]]
        nodes = faces["nodes"].astype(np.int64) - 1
        four = np.isin(faces["type"], _QUADRILATERALS)
        if not four.any():
            return np.asarray(nodes[:, :3])
        quads = nodes[four]
        return np.concatenate([nodes[~four, :3], quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])

    @cached_property
    def _at_rest(self) -> IntArray:
        """Pairs that cross already: chords of curved faces at an edge that is nearly closed."""
        return crossing_pairs(self.points, self.triangles)

    def find(self, displacement: FloatArray) -> Crossing | None:
        """Crossings of a displacement of the displacement unknowns that the surface had not."""
        blocks = displacement.reshape(3, -1)
        moved = self.points.copy()
        count = min(len(moved), self._fem.nv)
        moved[:count] += blocks[:, :count].T
        pairs = crossing_pairs(moved, self.triangles)
        if len(pairs) == 0:
            return None
        n = len(self.triangles)
        new = pairs[~np.isin(pairs @ [n, 1], self._at_rest @ [n, 1])]
        if len(new) == 0:
            return None
        return Crossing(len(new), self.points[self.triangles[new[0]]].mean(axis=1))


def crossing_pairs(points: FloatArray, triangles: IntArray) -> IntArray:
    """Pairs of triangles without a common corner that have a point in common.

    Parameters
    ----------
    points : (n, 3) float array
    triangles : (m, 3) int array

    Returns
    -------
    (k, 2) int array
        The lower number first; pairs in one plane are not found.
    """
    corners = points[triangles]
    centre = corners.mean(axis=1)
    radius = np.linalg.norm(corners - centre[:, None], axis=-1).max(axis=1)
    # each with those that are not larger: a sliver of search where the mesh is fine
    found = cKDTree(centre).query_ball_point(centre, 2.0 * radius, return_sorted=False)
    first = np.repeat(np.arange(len(triangles)), [len(f) for f in found])
    second = np.concatenate([np.asarray(f, dtype=np.int64) for f in found])
    order = (radius[second] < radius[first]) | (
        (radius[second] == radius[first]) & (second > first)
    )
    first, second = first[order], second[order]
    apart = _boxes_apart(corners, first, second)
    first, second = first[~apart], second[~apart]
    shared = (triangles[first][:, :, None] == triangles[second][:, None, :]).any(axis=(1, 2))
    first, second = first[~shared], second[~shared]
    cross = _pierces(corners[first], corners[second]) | _pierces(corners[second], corners[first])
    return np.sort(np.stack([first[cross], second[cross]], axis=1), axis=1)


def _boxes_apart(corners: FloatArray, first: IntArray, second: IntArray) -> BoolArray:
    low, high = corners.min(axis=1), corners.max(axis=1)
    gap = np.maximum(low[first] - high[second], low[second] - high[first])
    return np.asarray((gap > 0.0).any(axis=1))


def _pierces(edges: FloatArray, faces: FloatArray) -> BoolArray:
    """Whether an edge of one triangle of each pair passes through the other one (k, 3, 3).

    Moeller, Trumbore, Journal of Graphics Tools 2 (1997) 21-28.
    """
    a, u, v = faces[:, 0], faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0]
    result = np.zeros(len(faces), dtype=bool)
    for k in range(3):
        start, along = edges[:, k], edges[:, (k + 1) % 3] - edges[:, k]
        normal = np.cross(along, v)
        determinant = np.sum(u * normal, axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            inverse = 1.0 / determinant
            arm = start - a
            first = np.sum(arm * normal, axis=1) * inverse
            turned = np.cross(arm, u)
            second = np.sum(along * turned, axis=1) * inverse
            ahead = np.sum(v * turned, axis=1) * inverse
            result |= (
                (first >= 0.0) & (second >= 0.0) & (first + second <= 1.0)
                & (ahead >= 0.0) & (ahead <= 1.0)
            )  # fmt: skip
    return result
