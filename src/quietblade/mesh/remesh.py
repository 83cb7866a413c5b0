# SPDX-License-Identifier: LGPL-2.1-or-later
"""Water meshed anew around the deformed blade: an independent way to the water of C1.

The moved mesh (`quietblade.mesh.motion`) stretches and shears the cells of C0.  Here the cells of
the water are made for C1, between the deformed second-order surface of the blade and the sphere.
"""

from dataclasses import replace

import gmsh
import numpy as np

from quietblade.errors import MeshError
from quietblade.mesh.build import gmsh_session, set_growth
from quietblade.mesh.model import CellBlock, Mesh, Quality
from quietblade.mesh.motion import MeshMotion, solve_mesh_motion
from quietblade.mesh.quality import TETRA_EDGES, tetrahedron_jacobians
from quietblade.typing import FloatArray, IntArray

_TETRA4 = 4
_TRIANGLE3 = 2
_TRIANGLE_EDGES = ((0, 1), (1, 2), (2, 0))


def remesh_water(
    mesh: Mesh, displacement: FloatArray, *, size: float, water_size: float
) -> tuple[Mesh, MeshMotion]:
    """Mesh the water anew around the deformed blade.

    Solid cells and the triangles of both surfaces stay; the cells between are new, and moved back
    to C0, so that the result can be used as any mesh.

    Parameters
    ----------
    mesh : Mesh
    displacement : (n, 3) float array
        Displacement at its nodes [m]; only the blade's nodes are read.
    size, water_size : float
        Edge length of the cells at the blade and at the sphere [m].

    Returns
    -------
    Mesh
        On C0: the same solid with the new water, moved back.
    MeshMotion
        From there to C1.

    Raises
    ------
    MeshError
        The water cannot be meshed, or a cell is inverted there or when it is moved back.
    """
    solid = [block for name, blocks in mesh.cells.items() if name != "water" for block in blocks]
    solid_nodes = np.unique(np.concatenate([block.connectivity.ravel() for block in solid]))
    kept = np.union1d(solid_nodes, mesh.faces["outer"])
    number = np.full(len(mesh.nodes), -1, dtype=np.int64)
    number[kept] = np.arange(len(kept))
    u = np.zeros((len(kept), 3))
    u[number[solid_nodes]] = displacement[solid_nodes]
    faces = {name: number[triangles] for name, triangles in mesh.faces.items()}
    inner = np.concatenate([number[mesh.interface], faces["root"]])
    corners, tetrahedra, quality = _fill(
        mesh.nodes[kept] + u, inner, faces["outer"], size, water_size
    )
    placed, water = _second_order(corners, tetrahedra, np.concatenate([inner, faces["outer"]]))
    least = _least_jacobian(placed, water)
    there = np.zeros_like(placed)
    there[: len(kept)] = u
    cells = {
        name: tuple(CellBlock(block.kind, number[block.connectivity]) for block in blocks)
        for name, blocks in mesh.cells.items()
    }
    deformed = replace(
        mesh,
        nodes=placed,
        cells={**cells, "water": (CellBlock("tetra10", water),)},
        faces=faces,
        quality={**mesh.quality, "water": replace(quality, least_jacobian=least)},
    )
    back = solve_mesh_motion(deformed, -there, 0.0)
    nodes = placed + back.displacement
    nodes[: len(kept)] = mesh.nodes[kept]
    gap = float(mesh.radius - np.linalg.norm(placed[inner] - mesh.centre, axis=-1).max())
    volumes = (1.0 / back.volume_ratio[1], 1.0 / back.volume_ratio[0])
    motion = MeshMotion(placed - nodes, least, volumes, gap, back.steps)
    return replace(deformed, nodes=nodes), motion


def _fill(
    nodes: FloatArray, inner: IntArray, outer: IntArray, size: float, water_size: float
) -> tuple[FloatArray, IntArray, Quality]:
    """Tetrahedra between two closed surfaces: nodes, new ones last, and corners of each cell."""
    with gmsh_session():
        gmsh.option.setNumber("Mesh.Renumber", 0)  # nodes of the surfaces keep their tags
        try:
            surfaces = [_add_surface(nodes, outer), _add_surface(nodes, inner)]
            loops = [gmsh.model.geo.addSurfaceLoop([surface]) for surface in surfaces]
            volume = gmsh.model.geo.addVolume(loops)
            gmsh.model.geo.synchronize()
            set_growth([surfaces[1]], size, water_size)
            gmsh.model.mesh.generate(3)
        except Exception as error:  # gmsh raises bare Exception
            raise MeshError(
                f"gmsh could not mesh the water around the deformed blade: {error}"
            ) from error
        tags, coordinates, _ = gmsh.model.mesh.getNodes()
        kinds, elements, connectivity = gmsh.model.mesh.getElements(3, volume)
        if list(kinds) != [_TETRA4]:
            raise MeshError("gmsh made no tetrahedra around the deformed blade")
        shapes = np.asarray(gmsh.model.mesh.getElementQualities(elements[0], "minSICN"))
    position = np.zeros((int(tags.max()) + 1, 3))
    position[tags] = coordinates.reshape(-1, 3)
    cells = connectivity[0].astype(np.int64).reshape(-1, 4)
    number = np.full(len(position), -1, dtype=np.int64)
    given = np.unique(np.concatenate([inner[:, :3], outer[:, :3]]))
    number[given + 1] = given  # as `_add_surface` has tagged them
    new = np.setdiff1d(cells, given + 1)
    number[new] = len(nodes) + np.arange(len(new))
    quality = Quality(float(shapes.min()), float(shapes.mean()), float("nan"))
    return np.concatenate([nodes, position[new]]), number[cells], quality


def _add_surface(nodes: FloatArray, triangles: IntArray) -> int:
    """Discrete surface of the corners of second-order triangles; tags are node numbers plus one."""
    surface = int(gmsh.model.addDiscreteEntity(2))
    used = np.unique(triangles[:, :3])
    gmsh.model.mesh.addNodes(2, surface, used + 1, nodes[used].ravel())
    corners = (triangles[:, :3] + 1).ravel()
    gmsh.model.mesh.addElementsByType(surface, _TRIANGLE3, [], corners)
    return surface


def _second_order(
    nodes: FloatArray, tetrahedra: IntArray, triangles: IntArray
) -> tuple[FloatArray, IntArray]:
    """Mid-edge nodes: those of the given triangles on the surfaces, new ones elsewhere."""
    edges = np.sort(tetrahedra[:, TETRA_EDGES], axis=2)
    unique, place = np.unique(edges.reshape(-1, 2), axis=0, return_inverse=True)
    known = np.sort(triangles[:, _TRIANGLE_EDGES], axis=2).reshape(-1, 2)
    key = unique[:, 0] * len(nodes) + unique[:, 1]
    wanted = known[:, 0] * len(nodes) + known[:, 1]
    at = np.minimum(np.searchsorted(key, wanted), len(key) - 1)
    if np.any(key[at] != wanted):
        raise MeshError("the new water mesh does not keep the edges of the surfaces")
    middle = np.full(len(unique), -1, dtype=np.int64)
    middle[at] = triangles[:, 3:].ravel()
    free = np.flatnonzero(middle < 0)
    middle[free] = len(nodes) + np.arange(len(free))
    added = nodes[unique[free]].mean(axis=1)
    return (
        np.concatenate([nodes, added]),
        np.concatenate([tetrahedra, middle[place.reshape(-1, 6)]], axis=1),
    )


def _least_jacobian(nodes: FloatArray, cells: IntArray) -> float:
    """Least ratio of a Jacobian to its mean in the cell; inverted cells are refused."""
    jacobians = tetrahedron_jacobians(nodes, cells)
    worst = int(jacobians.min(axis=1).argmin())
    if jacobians[worst].min() <= 0.0:
        x, y, z = nodes[cells[worst]].mean(axis=0)
        raise MeshError(
            f"a new water cell is inverted at x = {x:.4f} m, y = {y:.4f} m, z = {z:.4f} m; "
            "use a smaller mesh size"
        )
    return float((jacobians.min(axis=1) / jacobians.mean(axis=1)).min())
