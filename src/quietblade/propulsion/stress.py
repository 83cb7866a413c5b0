# SPDX-License-Identifier: LGPL-2.1-or-later
"""Stress and strain of a state, region by region: at integration points, at nodes, and peaks."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from types import MappingProxyType

import numpy as np

from quietblade.materials.axes import Axes
from quietblade.propulsion.failure import failure_indices
from quietblade.propulsion.plies import Plies, ply_failure
from quietblade.propulsion.reactions import Reaction, compute_reaction
from quietblade.propulsion.samples import Samples, take_samples
from quietblade.propulsion.structure import Structure, StructureState
from quietblade.propulsion.tensors import (
    cauchy_stress,
    green_lagrange_strain,
    in_axes,
    logarithmic_strain,
    principal_values,
    von_mises_stress,
)
from quietblade.typing import FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class Fields:
    """Tensors at n places, each (n, 3, 3) and symmetric.

    Attributes
    ----------
    cauchy : float array
        Cauchy stress [Pa]: force per deformed area, in the blade frame (theory: S1-60).
    second_piola : float array
        Second Piola-Kirchhoff stress [Pa], in the blade frame of C0.
    green_lagrange : float array
        Green-Lagrange strain, in the blade frame of C0.
    logarithmic : float array
        Logarithmic strain ``1/2 ln(F^T F)``, in the blade frame of C0 (theory: S1-61).
    material_strain, material_stress : float arrays or None
        Green-Lagrange strain and second Piola-Kirchhoff stress in the material axes, which turn
        with the material (theory: S1-62); None for a material without axes.
    """

    cauchy: FloatArray
    second_piola: FloatArray
    green_lagrange: FloatArray
    logarithmic: FloatArray
    material_strain: FloatArray | None
    material_stress: FloatArray | None

    @cached_property
    def von_mises(self) -> FloatArray:
        """Von Mises stress of the Cauchy stress, (n,) [Pa]."""
        return von_mises_stress(self.cauchy)

    @cached_property
    def principal_logarithmic(self) -> FloatArray:
        """Principal logarithmic strains, greatest first, (n, 3)."""
        return principal_values(self.logarithmic)

    @cached_property
    def principal_stress(self) -> FloatArray:
        """Principal Cauchy stresses, greatest first, (n, 3) [Pa]."""
        return principal_values(self.cauchy)


@dataclass(frozen=True, eq=False)
class Peak:
    """Largest value of a quantity over the integration points of a region.

    Attributes
    ----------
    value : float
        The largest value.
    percentile : float
        Value that 99 % of the region's volume does not exceed; where the continuum is singular
        (corners, edges of the film, the clamped edge) only this one converges with the mesh.
    place : (3,) float array
        Where the largest value is, in the undeformed configuration [m].
    """

    value: float
    percentile: float
    place: FloatArray


@dataclass(frozen=True, eq=False)
class RegionStress:
    """Stress and strain of one region.

    Attributes
    ----------
    region : str
        Name of the region.
    points, volumes : (n, 3) and (n,) float arrays
        Integration points in C0 [m] and the volume each stands for [m3].
    at_points : Fields
        At the integration points, straight from the law.
    failure_at_points : mapping
        Failure indices there, (n,) each; a load grown by 1 / index would bring failure.
    nodes : (k,) int array
        Nodes of the region, numbers in the structure's nodal basis.
    at_nodes : Fields
        At these nodes; other regions have no share.
    failure_at_nodes : mapping
        Failure indices of `at_nodes`.
    peaks : mapping
        `Peak` of ``von_mises`` [Pa], ``principal_stress`` [Pa], ``logarithmic_strain`` (greatest
        principal value), and every failure index.
    """

    region: str
    points: FloatArray
    volumes: FloatArray
    at_points: Fields
    failure_at_points: Mapping[str, FloatArray]
    nodes: IntArray
    at_nodes: Fields
    failure_at_nodes: Mapping[str, FloatArray]

    @cached_property
    def peaks(self) -> Mapping[str, Peak]:
        """Peaks by name of quantity."""
        fields = self.at_points
        quantities = {
            "von_mises": fields.von_mises,
            "principal_stress": fields.principal_stress[:, 0],
            "logarithmic_strain": fields.principal_logarithmic[:, 0],
            **self.failure_at_points,
        }
        return {name: self._peak(values) for name, values in quantities.items()}

    def spread(self, values: FloatArray, count: int) -> FloatArray:
        """Nodal values (k, ...) among all nodes of the mesh, (count, ...); NaN outside."""
        whole = np.full((count, *values.shape[1:]), np.nan)
        whole[self.nodes] = values
        return whole

    def _peak(self, values: FloatArray) -> Peak:
        order = np.argsort(values)
        share = np.cumsum(self.volumes[order]) / self.volumes.sum()
        percentile = values[order][np.searchsorted(share, 0.99)]
        return Peak(float(values[order[-1]]), float(percentile), self.points[order[-1]])


@dataclass(frozen=True, eq=False)
class StressReport:
    """Stress and strain of all regions, and the forces at the support.

    Attributes
    ----------
    regions : mapping
        `RegionStress` by name of region.
    reaction : Reaction
        Forces and moments of the support, and how well they balance the loads.
    converged : bool
        Whether the state is an equilibrium to its tolerance.
    """

    regions: Mapping[str, RegionStress]
    reaction: Reaction
    converged: bool


def compute_stress(
    structure: Structure,
    state: StructureState,
    *,
    axes: Mapping[str, Axes] | None = None,
    plies: Mapping[str, Plies] | None = None,
) -> StressReport:
    """Evaluate stress, strain, failure indices and reactions of a state.

    Parameters
    ----------
    structure : Structure
        Mesh and materials.
    state : StructureState
        An equilibrium.
    axes : mapping or None
        Axes (columns) of regions whose material has none, such as the film; strain and stress are
        then told in them too.

    Raises
    ------
    ValueError
        If ``axes`` names a region without a material.
    """
    axes, plies = axes or {}, plies or {}
    known = structure.forms.materials
    for region in {*axes, *plies} - set(known):
        raise ValueError(f"stress of region {region!r}: materials are only in {[*known]}")
    regions = {
        region: _region_stress(structure, state, region, axes.get(region), plies.get(region))
        for region in known
    }
    reaction = compute_reaction(structure, state)
    return StressReport(MappingProxyType(regions), reaction, state.converged)


def _region_stress(
    structure: Structure,
    state: StructureState,
    region: str,
    axes: Axes | None,
    plies: Plies | None,
) -> RegionStress:
    number = None if plies is None else plies.number
    samples = take_samples(structure, state, region, axes, number)
    at_points = _fields(samples)
    at_nodes = _moved(at_points, samples.at_nodes)
    if plies is None:
        material = structure.forms.materials[region]
        at_both = failure_indices(material, at_points), failure_indices(material, at_nodes)
    elif samples.ply is None:
        at_both = ply_failure(plies.laminate, at_points), ply_failure(plies.laminate, at_nodes)
    else:  # stress jumps from ply to ply, so that the indices are brought to the nodes
        found = ply_failure(plies.laminate, at_points, samples.ply)
        at_both = found, {name: samples.at_nodes(index) for name, index in found.items()}
    return RegionStress(
        region=region,
        points=samples.points,
        volumes=samples.volumes,
        at_points=at_points,
        failure_at_points=at_both[0],
        nodes=samples.nodes,
        at_nodes=at_nodes,
        failure_at_nodes=at_both[1],
    )


def _fields(samples: Samples) -> Fields:
    F, S, axes = samples.gradient, samples.second_piola, samples.axes
    E = green_lagrange_strain(F)
    return Fields(
        cauchy=cauchy_stress(F, S),
        second_piola=S,
        green_lagrange=E,
        logarithmic=logarithmic_strain(F),
        material_strain=None if axes is None else in_axes(E, axes),
        material_stress=None if axes is None else in_axes(S, axes),
    )


def _moved(fields: Fields, to_nodes: Callable[[FloatArray], FloatArray]) -> Fields:
    strain, stress = fields.material_strain, fields.material_stress
    return Fields(
        cauchy=to_nodes(fields.cauchy),
        second_piola=to_nodes(fields.second_piola),
        green_lagrange=to_nodes(fields.green_lagrange),
        logarithmic=to_nodes(fields.logarithmic),
        material_strain=None if strain is None else to_nodes(strain),
        material_stress=None if stress is None else to_nodes(stress),
    )
