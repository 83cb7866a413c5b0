# SPDX-License-Identifier: LGPL-2.1-or-later
"""Points of the solid by their place: which cell, and the basis functions there."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import ngsolve as ngs
import numpy as np
from scipy.spatial import cKDTree

from quietblade.propulsion.forms import StructuralForms
from quietblade.typing import FloatArray, IntArray

_CELLS = 30  # cells with the nearest middles that may hold a place
_SAMPLES = 12  # samples of the surface from which the closest point is sought
_ON_FACE = 1e-9
_MIDDLE = (0.3, 0.3, 0.25)
_STEPS = 30
_CONVERGED = 1e-12  # of the reference face

_TRIANGLE = np.array([[0.05, 0.05], [0.9, 0.05], [0.05, 0.9], [0.48, 0.48], [0.48, 0.04],
                      [0.04, 0.48], [0.33, 0.33]])  # fmt: skip
_SQUARE = np.array([[a, b] for a in (0.05, 0.35, 0.65, 0.95) for b in (0.05, 0.35, 0.65, 0.95)])

_Samples = tuple[cKDTree, list[ngs.ElementId]]
"""Places, and the elements that they are in."""


@dataclass(frozen=True, eq=False)
class SolidPoint:
    """A point of the solid as the unknowns see it.

    Attributes
    ----------
    unknowns : (k,) int array
        Unknowns of a scalar order-2 field that have a share in its value there.
    shape : (k,) float array
        Their basis functions there.
    place : (3,) float array
        The point [m].
    distance : float
        Distance from the place that was asked for [m]; zero inside the solid.
    """

    unknowns: IntArray
    shape: FloatArray
    place: FloatArray
    distance: float


class SolidPlaces:
    """Finds places in or on the solid of a structure, in the undeformed configuration."""

    def __init__(self, forms: StructuralForms) -> None:
        self._fem, self._forms = forms.fem, forms
        self._space = ngs.H1(forms.fem, order=2)

    def find(self, place: FloatArray) -> SolidPoint:
        """Find a place in the solid, or the nearest point of its surface."""
        # NGSolve's own search does not know all kinds of cells
        for cell in _nearest(self._cells, place, _CELLS):
            inside = self._inside(cell, place)
            if inside is not None:
                return self._point(cell, inside, np.asarray(place, dtype=float), 0.0)
        faces = _nearest(self._faces, place, _SAMPLES)
        found = [self._closest(face, place) for face in faces]
        face, reference, point, distance = min(found, key=lambda entry: entry[3])
        return self._point(face, (*reference, 0.0), point, distance)

    def _point(
        self,
        element: ngs.ElementId,
        reference: Sequence[float] | FloatArray,
        place: FloatArray,
        distance: float,
    ) -> SolidPoint:
        shape = np.array(self._space.GetFE(element).CalcShape(*reference))
        return SolidPoint(np.array(self._space.GetDofNrs(element)), shape, place, distance)

    @cached_property
    def _cells(self) -> _Samples:
        """Middles of the cells of the solid."""
        cells = [
            ngs.ElementId(element)
            for element in self._fem.Elements(ngs.VOL)
            if element.mat in self._forms.materials
        ]
        middles = [_mapped(self._fem.GetTrafo(cell), _MIDDLE)[0] for cell in cells]
        return cKDTree(np.array(middles)), cells

    @cached_property
    def _faces(self) -> _Samples:
        """Some points on every face of the solid's surface, and their faces."""
        solid = np.zeros(self._space.ndof, dtype=bool)
        solid[np.array(self._space.GetDofs(self._forms.solid), dtype=bool)] = True
        points, owners = [], []
        for element in self._fem.Elements(ngs.BND):
            face = ngs.ElementId(element)
            if not solid[list(self._space.GetDofNrs(face))].all():
                continue  # a boundary of the water
            mapped = self._fem.GetTrafo(face)
            for reference in _TRIANGLE if element.type == ngs.ET.TRIG else _SQUARE:
                points.append(_mapped(mapped, reference)[0])
                owners.append(face)
        return cKDTree(np.array(points)), owners

    def _inside(self, cell: ngs.ElementId, place: FloatArray) -> FloatArray | None:
        """Find a place's reference coordinates in a cell, if it is there (Newton's method)."""
        mapped, reference = self._fem.GetTrafo(cell), np.array(_MIDDLE)
        for _ in range(_STEPS):
            point, tangents = _mapped(mapped, reference)
            step = np.linalg.lstsq(tangents, place - point, rcond=None)[0]
            reference = reference + np.clip(step, -0.5, 0.5)
            if np.abs(step).max() < _CONVERGED:
                return reference if _in_reference(self._fem[cell].type, reference) else None
        return None

    def _closest(
        self, face: ngs.ElementId, place: FloatArray
    ) -> tuple[ngs.ElementId, FloatArray, FloatArray, float]:
        """Closest point of a face, by Gauss-Newton steps that stay on it."""
        mapped = self._fem.GetTrafo(face)
        triangle = self._fem[face].type == ngs.ET.TRIG
        starts = _TRIANGLE if triangle else _SQUARE
        reach = [np.linalg.norm(_mapped(mapped, r)[0] - place) for r in starts]
        reference = starts[int(np.argmin(reach))]
        for _ in range(_STEPS):
            point, tangents = _mapped(mapped, reference)
            step = np.linalg.lstsq(tangents, place - point, rcond=None)[0]
            moved = _onto(reference + step, tangents, triangle=triangle)
            change = np.abs(moved - reference).max()
            reference = moved
            if change < _CONVERGED:
                break
        point = _mapped(mapped, reference)[0]
        return face, reference, point, float(np.linalg.norm(point - place))


def _mapped(
    trafo: ngs.fem.ElementTransformation, reference: Sequence[float] | FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Point and tangents (3, d) at reference coordinates; the objects in between do not outlive."""
    at = trafo(*reference)
    return np.array(at.point), np.array(at.jacobi)


def _nearest(samples: _Samples, place: FloatArray, count: int) -> list[ngs.ElementId]:
    """Elements with the samples nearest to a place, in order, each once."""
    tree, owners = samples
    near = np.atleast_1d(tree.query(place, k=min(count, len(owners)))[1])
    return list(dict.fromkeys(owners[n] for n in near))


def _in_reference(kind: ngs.ET, reference: FloatArray) -> bool:
    """Whether a point lies in a reference cell of a kind."""
    x, y, z = reference
    if kind == ngs.ET.TET:
        left = 1.0 - x - y - z
    elif kind == ngs.ET.PYRAMID:
        left = min(1.0 - z - x, 1.0 - z - y)
    elif kind == ngs.ET.PRISM:
        left = min(1.0 - x - y, 1.0 - z)
    else:
        left = 1.0 - reference.max()
    return bool(min(left, reference.min()) >= -_ON_FACE)


def _onto(reference: FloatArray, tangents: FloatArray, *, triangle: bool) -> FloatArray:
    """Nearest point of the reference face, measured in space by its tangents (3, 2)."""
    if not triangle:
        corners = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
        inside = bool(np.all((reference >= 0.0) & (reference <= 1.0)))
    else:
        corners = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
        inside = bool(np.all(reference >= 0.0) and reference.sum() <= 1.0)
    if inside:
        return reference
    metric = tangents.T @ tangents
    candidates = []
    for start, end in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        along = end - start
        share = np.clip(along @ metric @ (reference - start) / (along @ metric @ along), 0.0, 1.0)
        candidates.append(start + share * along)
    gaps = [(c - reference) @ metric @ (c - reference) for c in candidates]
    return np.asarray(candidates[int(np.argmin(gaps))])
