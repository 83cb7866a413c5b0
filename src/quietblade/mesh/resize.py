# SPDX-License-Identifier: LGPL-2.1-or-later
"""The same blade, cell by cell, in a sphere of water of another radius.

Two meshes of one blade in two spheres differ in every cell, and their peak levels by more than the
sphere is worth.  Here the cells of blade and film, and those of the water beside them, stay.
"""

from dataclasses import replace

import numpy as np

from quietblade.errors import MeshError
from quietblade.mesh.model import Mesh
from quietblade.mesh.quality import poor_cell_notices, tetrahedron_quality
from quietblade.typing import FloatArray

# Ends of the edges that carry a tetrahedron's nodes 4 to 9
_ENDS = [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]]


def resize_sphere(mesh: Mesh, radius: float, fixed: float | None = None) -> Mesh:
    """Move the water's nodes far from the blade along their rays to a sphere of another radius.

    Parameters
    ----------
    mesh : Mesh
        In configuration C0.
    radius : float
        Of the new sphere, around the same centre [m].
    fixed : float or None
        Distance from the centre within which every cell stays [m]; the blade has to lie inside.
        None takes the middle between the blade's farthest node and the smaller sphere.

    Returns
    -------
    Mesh
        With the same numbers of nodes and cells: fields and matrices of the blade are those of
        ``mesh``.

    Raises
    ------
    MeshError
        If ``fixed`` does not lie between the blade and both spheres, or a cell would be inverted.

    Examples
    --------
    >>> larger = resize_sphere(mesh, 1.2)  # doctest: +SKIP
    >>> np.array_equal(larger.nodes[larger.interface], mesh.nodes[mesh.interface])  # doctest: +SKIP
    True
    """
    away = mesh.nodes - mesh.centre
    distance = np.linalg.norm(away, axis=1)
    reach = _reach(mesh, distance)
    smaller = min(radius, mesh.radius)
    kept = 0.5 * (reach + smaller) if fixed is None else fixed
    if not reach <= kept < smaller:
        raise MeshError(
            f"the water within {kept:.4g} m of the sphere's centre cannot be kept: the blade "
            f"reaches {reach:.4g} m and the smaller sphere has {smaller:.4g} m. Use a larger "
            "sphere radius, or a distance between the two"
        )
    stretch = (radius - kept) / (mesh.radius - kept)
    water = np.concatenate([block.connectivity for block in mesh.cells["water"]])
    outwards = (stretch - 1.0) * np.maximum(distance - kept, 0.0) / np.maximum(distance, kept)
    moved = outwards[:, None] * away
    # the edges inside follow their ends, so that those through the kept sphere stay straight
    inner = np.setdiff1d(water[:, 4:], mesh.faces["outer"])
    ends = np.zeros((len(mesh.nodes), 2), dtype=np.int64)
    ends[water[:, 4:]] = water[:, _ENDS]
    moved[inner] = moved[ends[inner]].mean(axis=1)
    nodes = mesh.nodes + moved
    quality = dict(mesh.quality) | {"water": tetrahedron_quality(nodes, water)}
    if quality["water"].least_jacobian <= 0.0:
        raise MeshError(
            f"a water cell is inverted in a sphere of {radius:.4g} m; use a radius that is nearer "
            f"to that of the mesh, {mesh.radius:.4g} m"
        )
    return replace(
        mesh, nodes=nodes, radius=radius, quality=quality, notices=poor_cell_notices(quality)
    )


def _reach(mesh: Mesh, distance: FloatArray) -> float:
    """Distance of the blade's farthest node from the centre [m]."""
    blade = [block.connectivity.ravel() for block in mesh.cells["blade"]]
    return float(distance[np.concatenate(blade)].max())
