# SPDX-License-Identifier: LGPL-2.1-or-later
"""Nodal values of second-order fields, whose degrees of freedom are hierarchical in NGSolve.

In an order-2 ``H1`` space a vertex unknown is the value there, an edge unknown the coefficient of
a bubble: value at the middle of the edge = mean of its ends - coefficient / 8.  Face and cell
bubbles of hexahedra and pyramids vanish at vertices and edge midpoints.
"""

from functools import cached_property

import ngsolve as ngs
import numpy as np
from scipy.sparse import coo_array, csr_matrix
from scipy.spatial import cKDTree

from quietblade.errors import MeshError
from quietblade.typing import AnyArray, FloatArray, IntArray

_EDGE_BUBBLE_AT_MIDPOINT = -0.125


class NodalBasis:
    """Vertices and edge midpoints of a curved second-order mesh as nodes.

    Meshes read from second-order files keep their mid-edge points as vertices without elements;
    there the nodes are numbered as in the file.  Otherwise the vertices come first, then the edges.

    Parameters
    ----------
    fem : ngsolve.Mesh
        The mesh, curved or not.

    Attributes
    ----------
    points : (n, 3) float array
        Position of the nodes in the undeformed configuration [m].
    ndof : int
        Unknowns of the scalar order-2 ``H1`` space (not compressed).
    """

    def __init__(self, fem: ngs.Mesh) -> None:
        self.fem = fem
        space = ngs.VectorH1(fem, order=2)
        self.ndof = space.ndof // 3
        ends = np.array([[v.nr for v in edge.vertices] for edge in fem.edges], dtype=np.int64)
        coordinates = ngs.GridFunction(space)
        coordinates.Set(ngs.CF((ngs.x, ngs.y, ngs.z)))
        dofs = np.array(coordinates.vec).reshape(3, self.ndof).T
        vertices = np.unique(ends)
        middles = dofs[ends].mean(axis=1) + _EDGE_BUBBLE_AT_MIDPOINT * dofs[fem.nv :][: len(ends)]
        edge_nodes, n_nodes = _number_edges(fem, vertices, middles)
        self.points: FloatArray = np.zeros((n_nodes, 3))
        self.points[vertices] = dofs[vertices]
        self.points[edge_nodes] = middles
        self._vertices, self._ends, self._edge_nodes = vertices, ends, edge_nodes

    @property
    def edge_ends(self) -> IntArray:
        """Node numbers of the two ends of each edge, (edges, 2)."""
        return self._ends

    @property
    def edge_nodes(self) -> IntArray:
        """Node number of the middle of each edge, (edges,)."""
        return self._edge_nodes

    def to_dofs(self, values: AnyArray) -> AnyArray:
        """Unknowns of the order-2 interpolant of nodal values.

        Parameters
        ----------
        values : (n,) or (n, k) array
            Nodal values of a scalar, or of k components.

        Returns
        -------
        (ndof,) or (k * ndof,) array
            One block of ``ndof`` a component, as in ``VectorH1``.
        """
        nodal = values if values.ndim == 2 else values[:, None]
        dofs = np.zeros((self.ndof, nodal.shape[1]), dtype=nodal.dtype)
        dofs[self._vertices] = nodal[self._vertices]
        bubble = nodal[self._edge_nodes] - nodal[self._ends].mean(axis=1)
        dofs[self.fem.nv :][: len(self._ends)] = bubble / _EDGE_BUBBLE_AT_MIDPOINT
        return dofs.T.reshape(-1)

    def to_values(self, dofs: AnyArray) -> AnyArray:
        """Nodal values, (n,) or (n, k), of the unknowns of a scalar or k-component field."""
        blocks = np.reshape(dofs, (-1, self.ndof)).T
        values = np.zeros((len(self.points), blocks.shape[1]), dtype=blocks.dtype)
        values[self._vertices] = blocks[self._vertices]
        edge = blocks[self.fem.nv :][: len(self._ends)]
        values[self._edge_nodes] = blocks[self._ends].mean(axis=1) + _EDGE_BUBBLE_AT_MIDPOINT * edge
        return values[:, 0] if values.shape[1] == 1 else values

    @cached_property
    def interpolation(self) -> csr_matrix:
        """`to_dofs` of a scalar as a matrix, (ndof, n)."""
        edges = self.fem.nv + np.arange(len(self._ends))
        # vertex unknowns are values; an edge unknown is 8 (mean of the ends - value in the middle)
        rows = np.concatenate([self._vertices, edges, edges, edges])
        columns = [self._vertices, self._ends[:, 0], self._ends[:, 1], self._edge_nodes]
        bubble = 1.0 / _EDGE_BUBBLE_AT_MIDPOINT
        counts = [len(self._vertices), *3 * [len(edges)]]
        weights = np.repeat([1.0, -0.5 * bubble, -0.5 * bubble, bubble], counts)
        shape = (self.ndof, len(self.points))
        return csr_matrix(coo_array((weights, (rows, np.concatenate(columns))), shape=shape))

    def nodes_of(self, region: str, codimension: int = 0) -> IntArray:
        """Sorted node numbers of a material (codimension 0) or a boundary (1), by name pattern.

        Raises
        ------
        MeshError
            If no region matches.
        """
        where = self.fem.Materials(region) if codimension == 0 else self.fem.Boundaries(region)
        if not any(where.Mask()):
            raise MeshError(f"no region matches {region!r} (codimension {codimension})")
        dofs = np.flatnonzero(np.array(self._scalar_space.GetDofs(where), dtype=bool))
        vertices = dofs[dofs < self.fem.nv]
        edges = dofs[(dofs >= self.fem.nv) & (dofs < self.fem.nv + len(self._ends))] - self.fem.nv
        return np.union1d(vertices, self._edge_nodes[edges])

    @cached_property
    def _scalar_space(self) -> ngs.H1:
        return ngs.H1(self.fem, order=2)


def _number_edges(fem: ngs.Mesh, vertices: IntArray, middles: FloatArray) -> tuple[IntArray, int]:
    """Node number of each edge midpoint: the file's own number where the mesh has it."""
    coordinates = np.array(fem.ngmesh.Coordinates())
    loose = np.setdiff1d(np.arange(len(coordinates)), vertices)
    if len(loose) == 0:
        return fem.nv + np.arange(len(middles)), fem.nv + len(middles)
    points = coordinates[loose]
    found = cKDTree(points).query(middles)
    distance, nearest = np.asarray(found[0]), np.asarray(found[1])
    scale = np.ptp(points, axis=0).max()
    if distance.max() > 1e-9 * scale or len(np.unique(nearest)) != len(middles):
        raise MeshError(
            "the second-order nodes of the mesh do not match its edges one to one "
            f"(largest distance {distance.max():.3g} m); was the mesh written with order 2?"
        )
    return loose[nearest].astype(np.int64), len(coordinates)
