# SPDX-License-Identifier: LGPL-2.1-or-later
"""Deformation and stress at the integration points of a region, and the way to its nodes.

Two Gauss points a direction (four in a tetrahedron): the derivatives of second-order displacements
are most accurate there.  A field goes to the nodes through its least-squares polynomial in every
cell (linear in tetrahedra, with the products of the coordinates in other cells) and the mean over
the cells of the region that share the node.  Cells of other regions have no say: stress and strain
jump between blade and film (theory: S1-63).
"""

from dataclasses import dataclass

import ngsolve as ngs
import numpy as np
from scipy.sparse import csr_array, diags_array

from quietblade.materials import MixedMaterial
from quietblade.materials.axes import Axes, as_coefficient
from quietblade.propulsion.cells import CORNERS, Cells, EdgeNodes, cells_of, node_places
from quietblade.propulsion.structure import Structure, StructureState
from quietblade.typing import FloatArray, IntArray

_QUADRATURE_ORDER = 2


@dataclass(frozen=True, eq=False)
class Samples:
    """A region's deformation and stress at its integration points.

    Attributes
    ----------
    region : str
        Name of the region.
    points : (n, 3) float array
        Places in the undeformed configuration [m].
    volumes : (n,) float array
        Undeformed volume that each place stands for [m3].
    gradient : (n, 3, 3) float array
        Deformation gradient F.
    second_piola : (n, 3, 3) float array
        Second Piola-Kirchhoff stress ``S = F^-1 dW/dF`` [Pa] (theory: S1-60).
    axes : (n, 3, 3) float array or None
        Material axes (columns), if the material or the caller has given any.
    ply : (n,) int array or None
        Position of the ply at each place in the laminate's list, if it is known.
    nodes : (k,) int array
        Nodes of the region, numbers in the structure's nodal basis.
    recovery : (k, n) sparse array
        Takes a field from the integration points to the nodes; its rows sum to 1.
    """

    region: str
    points: FloatArray
    volumes: FloatArray
    gradient: FloatArray
    second_piola: FloatArray
    axes: FloatArray | None
    ply: IntArray | None
    nodes: IntArray
    recovery: csr_array

    def at_nodes(self, field: FloatArray) -> FloatArray:
        """Values (k, ...) at the nodes of a field (n, ...) at the integration points."""
        flat = self.recovery @ field.reshape(len(field), -1)
        return np.asarray(flat).reshape(len(self.nodes), *field.shape[1:])


def take_samples(
    structure: Structure,
    state: StructureState,
    region: str,
    axes: Axes | None = None,
    ply: ngs.CoefficientFunction | None = None,
) -> Samples:
    """Evaluate deformation and stress of a region.

    Parameters
    ----------
    structure : Structure
        Mesh and materials.
    state : StructureState
        Displacement and film pressure, of an equilibrium or not.
    region : str
        One of the regions with a material.
    axes : (3, 3) array, CoefficientFunction or None
        Axes to report in; those of the material if None.
    ply : CoefficientFunction or None
        Position of the ply at a place in the laminate's list.

    Raises
    ------
    ValueError
        If the region has no material.
    """
    forms = structure.forms
    if region not in forms.materials:
        raise ValueError(f"no region {region!r} with a material; there are {[*forms.materials]}")
    fem, material = forms.fem, forms.materials[region]
    F = forms.gradient(forms.displacement(state.displacement)).MakeVariable()
    if isinstance(material, MixedMaterial):
        pressure = ngs.GridFunction(forms.P)
        pressure.vec.FV().NumPy()[:] = state.film_pressure
        energy = material.energy(F, pressure)
    else:
        energy = material.energy(F)
    rules = {kind: ngs.IntegrationRule(kind, _QUADRATURE_ORDER) for kind in CORNERS}
    where = fem.Materials(region)
    places = fem.MapToAllElements(rules, where)
    gradient = F(places).reshape(-1, 3, 3)
    nominal = energy.Diff(F)(places).reshape(-1, 3, 3)
    stress = np.linalg.solve(gradient, nominal)
    weights = np.concatenate([rules[element.type].weights for element in where.Elements()])
    volumes = np.abs(ngs.Det(ngs.specialcf.JacobianMatrix(3))(places).ravel()) * weights
    chosen = getattr(material, "axes", None) if axes is None else axes
    nodes, recovery = _recovery(structure, region, rules)
    return Samples(
        region=region,
        points=ngs.CF((ngs.x, ngs.y, ngs.z))(places),
        volumes=volumes,
        gradient=gradient,
        second_piola=0.5 * (stress + np.swapaxes(stress, 1, 2)),  # symmetric but for rounding
        axes=None if chosen is None else as_coefficient(chosen)(places).reshape(-1, 3, 3),
        ply=None if ply is None else np.rint(ply(places).ravel()).astype(np.int64),
        nodes=nodes,
        recovery=recovery,
    )


def _recovery(
    structure: Structure, region: str, rules: dict[ngs.ET, ngs.IntegrationRule]
) -> tuple[IntArray, csr_array]:
    """Nodes of a region and the matrix that brings them the fields of the integration points."""
    edge_nodes = EdgeNodes(structure.basis)
    blocks = list(cells_of(structure.forms.fem, region))
    first = _first_samples(blocks, rules)
    rows, columns, entries = [], [], []
    for block in blocks:
        local = _extrapolation(block.kind, rules[block.kind])
        cell_nodes = edge_nodes.complete(block.kind, block.corners)
        samples = first[block.rank][:, None] + np.arange(local.shape[1])
        shape = (len(cell_nodes), *local.shape)
        rows.append(np.broadcast_to(cell_nodes[:, :, None], shape).ravel())
        columns.append(np.broadcast_to(samples[:, None, :], shape).ravel())
        entries.append(np.broadcast_to(local, shape).ravel())
    nodes, row = np.unique(np.concatenate(rows), return_inverse=True)
    places = (row, np.concatenate(columns))
    size = (len(nodes), int(sum(len(b.rank) * len(rules[b.kind].points) for b in blocks)))
    sums = csr_array((np.concatenate(entries), places), shape=size)
    return nodes, csr_array(diags_array(1.0 / sums.sum(axis=1)) @ sums)


def _first_samples(blocks: list[Cells], rules: dict[ngs.ET, ngs.IntegrationRule]) -> IntArray:
    """Find the number of each cell's first integration point, (cells of the region,)."""
    counts = np.zeros(sum(len(block.rank) for block in blocks), dtype=np.int64)
    for block in blocks:
        counts[block.rank] = len(rules[block.kind].points)
    return np.cumsum(counts) - counts


def _extrapolation(kind: ngs.ET, rule: ngs.IntegrationRule) -> FloatArray:
    """Nodal values of the weighted least-squares polynomial through the points, (nodes, points)."""
    root = np.sqrt(np.array(rule.weights))
    fit = np.linalg.pinv(root[:, None] * _polynomials(kind, np.array(rule.points)))
    extrapolation: FloatArray = _polynomials(kind, node_places(kind)) @ fit * root
    return extrapolation


def _polynomials(kind: ngs.ET, at: FloatArray) -> FloatArray:
    """Polynomials that a cell is given, at reference places (n, 3): (n, terms)."""
    x, y, z = at.T
    linear = [np.ones(len(at)), x, y, z]
    products = {
        ngs.TET: [],
        ngs.PYRAMID: [x * y],
        ngs.PRISM: [x * z, y * z],
        ngs.HEX: [x * y, y * z, x * z, x * y * z],
    }
    return np.stack([*linear, *products[kind]], axis=1)
