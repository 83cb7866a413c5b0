# SPDX-License-Identifier: LGPL-2.1-or-later
"""Forces at points and along lines of the blade's surface (theory: S2-75)."""

import numpy as np
from scipy.sparse import coo_array, csr_matrix

from quietblade.errors import MeshError
from quietblade.mesh.boundaries import boundary
from quietblade.mesh.nodal import NodalBasis
from quietblade.mesh.surface import SurfaceQuadrature
from quietblade.typing import FloatArray

_POINTS_A_SEGMENT = 8
_REACH = 1e-2  # of the surface's size: farther from it a place is a mistake


def evaluation_matrix(basis: NodalBasis) -> csr_matrix:
    """`NodalBasis.to_values` of a scalar as a matrix, (n, ndof).

    Its transpose takes forces at the nodes to forces on the unknowns.
    """
    edges = basis.fem.nv + np.arange(len(basis.edge_ends))
    vertices = np.unique(basis.edge_ends)
    one = np.ones(len(edges))
    rows = [vertices, basis.edge_nodes, basis.edge_nodes, basis.edge_nodes]
    columns = [vertices, basis.edge_ends[:, 0], basis.edge_ends[:, 1], edges]
    values = [np.ones(len(vertices)), 0.5 * one, 0.5 * one, -0.125 * one]
    places = np.concatenate(rows), np.concatenate(columns)
    shape = (len(basis.points), basis.ndof)
    return csr_matrix(coo_array((np.concatenate(values), places), shape=shape))


def point_force(
    basis: NodalBasis, surface: SurfaceQuadrature, places: FloatArray, forces: FloatArray
) -> FloatArray:
    """Force of point forces on a surface, consistent with the elements' shape functions.

    Parameters
    ----------
    basis : NodalBasis
        Nodes of the mesh.
    surface : SurfaceQuadrature
        Of the undeformed blade, on the nodes of the basis.
    places : (k, 3) or (3,) array
        On the undeformed surface [m].
    forces : (k, 3) or (3,) array
        Amplitudes [N], in fixed directions.

    Returns
    -------
    (V.ndof,) array
        On the unknowns of ``VectorH1(fem, order=2)`` [N].

    Raises
    ------
    MeshError
        If a place is not on the surface.
    """
    where, force = np.atleast_2d(places), np.atleast_2d(forces)
    found = surface.locate(where)
    size = float(np.ptp(surface.points[surface.nodes], axis=0).max())
    worst = int(np.argmax(found.distance))
    if found.distance[worst] > _REACH * size:
        raise MeshError(
            f"the force at {np.round(where[worst], 4)} m is {found.distance[worst]:.3g} m away "
            "from the surface; give a place on it"
        )
    nodal = surface.interpolation(where).T @ force
    return np.asarray((evaluation_matrix(basis).T @ nodal).T.reshape(-1))


def line_force(
    basis: NodalBasis, surface: SurfaceQuadrature, path: FloatArray, force: FloatArray
) -> FloatArray:
    """Force of a constant force per length along a line on the surface.

    Parameters
    ----------
    basis, surface
        As in `point_force`.
    path : (k, 3) array
        Corners of the line [m]; straight in between, on the surface.
    force : (3,) array
        Amplitude per length [N/m].

    Returns
    -------
    (V.ndof,) array
    """
    corners = np.asarray(path, dtype=float)
    at, weights = np.polynomial.legendre.leggauss(_POINTS_A_SEGMENT)
    steps = np.diff(corners, axis=0)
    places = corners[:-1, None] + 0.5 * (1.0 + at)[None, :, None] * steps[:, None]
    lengths = 0.5 * np.linalg.norm(steps, axis=1)[:, None] * weights
    forces = lengths.reshape(-1, 1) * np.asarray(force, dtype=float)
    return point_force(basis, surface, places.reshape(-1, 3), forces)


def surface_of(basis: NodalBasis, pattern: str) -> SurfaceQuadrature:
    """Boundary triangles of a mesh, by name pattern, as a surface on the nodes of the basis.

    Raises
    ------
    MeshError
        If no boundary matches, or it has faces that are not triangles.
    """
    region = boundary(basis.fem, pattern)
    middle = {
        (int(min(ends)), int(max(ends))): node
        for ends, node in zip(basis.edge_ends, basis.edge_nodes, strict=True)
    }
    triangles = []
    for element in region.Elements():
        corners = [vertex.nr for vertex in element.vertices]
        if len(corners) != 3:
            raise MeshError(f"the boundary {pattern!r} has faces that are not triangles")
        a, b, c = corners
        pairs = ((a, b), (b, c), (c, a))
        triangles.append([*corners, *(middle[min(pair), max(pair)] for pair in pairs)])
    return SurfaceQuadrature(basis.points, np.array(triangles, dtype=np.int64))
