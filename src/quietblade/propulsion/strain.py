# SPDX-License-Identifier: LGPL-2.1-or-later
"""Strains of an equilibrium: Green-Lagrange components and the shear of the film."""

from dataclasses import dataclass
from typing import Literal

import ngsolve as ngs
import numpy as np

from quietblade.materials.axes import Axes, as_coefficient
from quietblade.materials.kinematics import green_lagrange
from quietblade.materials.voigt import PAIRS
from quietblade.propulsion.samples import take_samples
from quietblade.propulsion.structure import Structure, StructureState
from quietblade.propulsion.tensors import green_lagrange_strain, in_axes
from quietblade.typing import FloatArray

Places = Literal["quadrature", "nodes"]

# Gauss points: three in each direction of a hexahedron.
_QUADRATURE_ORDER = 4

_VERTICES = {
    ngs.HEX: [(i, j, k) for i in (0.0, 1.0) for j in (0.0, 1.0) for k in (0.0, 1.0)],
    ngs.PRISM: [(*b, k) for b in ((0.0, 0.0), (1.0, 0.0), (0.0, 1.0)) for k in (0.0, 1.0)],
    # The map of a pyramid is singular at its apex: the base and a point below the apex.
    ngs.PYRAMID: [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (1.0, 1.0, 0.0)],
    ngs.TET: [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)],
}


@dataclass(frozen=True, eq=False)
class FilmShear:
    """Transverse shear of the film, ``sqrt(gamma_13^2 + gamma_23^2)`` (theory: S1-16).

    ``gamma_i3 = 2 E_i3`` is the engineering shear strain: twice the Green-Lagrange component in
    the film's own axes of the undeformed configuration, 1 along the span, 2 chordwise, 3 through
    the thickness.  For a simple shear of one layer over the other it is their relative slip over
    the thickness, exactly.  The tensor component is half of it.

    Attributes
    ----------
    points : (n, 3) float array
        Places in the undeformed configuration [m].
    gamma, gamma_13, gamma_23 : (n,) float arrays
        Shear strains there.
    volumes : (n,) float array
        Undeformed volume that each place stands for [m3].
    """

    points: FloatArray
    gamma: FloatArray
    gamma_13: FloatArray
    gamma_23: FloatArray
    volumes: FloatArray

    @property
    def maximum(self) -> float:
        """Largest shear strain of all places."""
        return float(self.gamma.max())

    @property
    def place(self) -> FloatArray:
        """Where it is, (3,) [m]."""
        where: FloatArray = self.points[np.argmax(self.gamma)]
        return where

    @property
    def mean(self) -> float:
        """Volume mean."""
        return float(np.average(self.gamma, weights=self.volumes))

    def percentile(self, percent: float = 99.0) -> float:
        """Shear strain that a percentage of the film's volume does not exceed.

        At the film's edges the strain of the continuum is singular and its maximum depends on the
        mesh; the 99th percentile hardly does.
        """
        order = np.argsort(self.gamma)
        share = np.cumsum(self.volumes[order]) / self.volumes.sum()
        return float(self.gamma[order][np.searchsorted(share, percent / 100.0)])


def compute_film_shear(
    structure: Structure,
    state: StructureState,
    axes: Axes,
    *,
    region: str = "film",
    at: Places = "quadrature",
) -> FilmShear:
    """Shear strain of the film at the Gauss points or the vertices of its cells.

    Parameters
    ----------
    structure : Structure
        Mesh and materials.
    state : StructureState
        Equilibrium.
    axes : (3, 3) array or CoefficientFunction
        Columns: span, chordwise and thickness directions of the film's mid-surface, as from
        ``ply_axes(0.0, *section_directions(blade_angle))``.
    region : str
        Region of the film.
    at : {"quadrature", "nodes"}
        Gauss points (27 a hexahedron) or vertices of each cell.

    Raises
    ------
    ValueError
        If the mesh has no such region.
    """
    fem = structure.forms.fem
    where = fem.Materials(region)
    if not any(where.Mask()):
        raise ValueError(f"the mesh has no region {region!r}; it has {fem.GetMaterials()}")
    rules = _gauss_rules() if at == "quadrature" else _vertex_rules()
    places = fem.MapToAllElements(rules, where)
    weights = np.concatenate([rules[kind].weights for kind in (e.type for e in where.Elements())])
    volume = np.abs(ngs.Det(ngs.specialcf.JacobianMatrix(3))(places).ravel()) * weights
    E = green_lagrange_field(structure, state, axes)(places).reshape(-1, 3, 3)
    gamma_13, gamma_23 = 2 * E[:, 0, 2], 2 * E[:, 1, 2]
    points: FloatArray = ngs.CF((ngs.x, ngs.y, ngs.z))(places)
    return FilmShear(points, np.hypot(gamma_13, gamma_23), gamma_13, gamma_23, volume)


def green_lagrange_field(
    structure: Structure, state: StructureState, axes: Axes | None = None
) -> ngs.CoefficientFunction:
    """Green-Lagrange strain as a 3x3 CoefficientFunction, in the blade frame or given axes."""
    forms = structure.forms
    E = green_lagrange(forms.gradient(forms.displacement(state.displacement)))
    if axes is None:
        return E
    A = as_coefficient(axes)
    return A.trans * E * A


def nodal_strain(
    structure: Structure, state: StructureState, axes: Axes | None = None, *, region: str
) -> FloatArray:
    """Green-Lagrange strain at the nodes of a region, for pictures and files (theory: S1-63).

    Returns
    -------
    (nodes, 6) array
        E11, E22, E33, E23, E13, E12 in the axes (default: x, y, z of the blade frame) at the
        nodes of `Structure.basis`; NaN outside the region.
    """
    samples = take_samples(structure, state, region, np.eye(3) if axes is None else axes)
    assert samples.axes is not None
    strain = in_axes(green_lagrange_strain(samples.gradient), samples.axes)
    i, j = np.array(PAIRS).T
    values = np.full((len(structure.basis.points), 6), np.nan)
    values[samples.nodes] = samples.at_nodes(strain[:, i, j])
    return values


def _gauss_rules() -> dict[ngs.ET, ngs.IntegrationRule]:
    return {kind: ngs.IntegrationRule(kind, _QUADRATURE_ORDER) for kind in _VERTICES}


def _vertex_rules() -> dict[ngs.ET, ngs.IntegrationRule]:
    """Vertices of the cells, each with an equal share of the reference cell's volume."""
    return {
        kind: ngs.IntegrationRule(
            points, [sum(ngs.IntegrationRule(kind, 1).weights) / len(points)] * len(points)
        )
        for kind, points in _VERTICES.items()
    }
