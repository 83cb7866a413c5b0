# SPDX-License-Identifier: LGPL-2.1-or-later
"""From a blade to a conforming second-order mesh, by gmsh.

One layer of hexahedra in the film, pyramids on its faces, tetrahedra elsewhere.
"""

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace

import gmsh
import numpy as np

from quietblade.errors import InvertedCellError, MeshError
from quietblade.geometry import Blade
from quietblade.mesh.cad import Patch, Solids, build_solids
from quietblade.mesh.cover import clear_size
from quietblade.mesh.growth import GROWTH
from quietblade.mesh.model import CellBlock, Mesh, Quality, patch_name
from quietblade.mesh.quality import poor_cell_notices, region_quality
from quietblade.typing import FloatArray, IntArray

# gmsh's element types: name, and VTK's node order from gmsh's
CELL_KINDS = {
    11: ("tetra10", (0, 1, 2, 3, 4, 5, 6, 7, 9, 8)),
    17: ("hexahedron20", (*range(8), 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15)),
    19: ("pyramid13", (0, 1, 2, 3, 4, 5, 8, 10, 6, 7, 9, 11, 12)),
}
TRIANGLE6 = 9

ATTEMPTS = (1.0, 0.98, 0.96, 0.94)
"""Factors of the cell size that are tried: where the film's cover is thin, a cell that is flat or
inverted is bad luck, which another size does not have. What gmsh refuses to mesh it refuses in any
of these sizes."""


@dataclass(frozen=True)
class MeshSpec:
    """What the mesh shall be.

    Attributes
    ----------
    size : float
        Edge length of the cells on the blade and in the film [m].
    centre : (3,) tuple of float
        Centre of the water sphere [m].
    radius : float
        Its radius [m].
    patches : tuple of Patch
        Excited parts of the blade's surface, which do not touch each other; there may be none.
    water_size : float or None
        Edge length at the sphere [m]; a quarter of the radius if None.
    """

    size: float
    centre: tuple[float, float, float]
    radius: float
    patches: tuple[Patch, ...]
    water_size: float | None = None


def build_mesh(blade: Blade, spec: MeshSpec) -> Mesh:
    """Mesh the blade, its film and the water around it.

    Parameters
    ----------
    blade : Blade
    spec : MeshSpec

    Returns
    -------
    Mesh

    Raises
    ------
    MeshError
        The volumes cannot be made or meshed.
    InvertedCellError
        A cell is inverted (with the place), also after the size was changed a little.
    """
    centre = np.array(spec.centre)
    poor: Mesh | None = None
    failures: list[InvertedCellError] = []
    with gmsh_session():
        try:
            solids = build_solids(blade, centre, spec.radius, spec.patches)
        except Exception as error:  # gmsh raises bare Exception
            raise _explained(error, spec) from error
        _embed_patches(solids)
        for factor in ATTEMPTS:
            gmsh.model.mesh.clear()
            try:
                mesh = _mesh(blade, solids, replace(spec, size=factor * spec.size), centre)
            except InvertedCellError as error:
                failures.append(error)
                continue
            if min(quality.worst for quality in mesh.quality.values()) > 0.0:
                return mesh
            poor = poor or mesh
    if poor is None:
        raise failures[0]
    return poor


def _mesh(blade: Blade, solids: Solids, spec: MeshSpec, centre: FloatArray) -> Mesh:
    try:
        _set_film_layer(blade, solids, spec.size)
        _set_sizes(blade, solids, spec)
        gmsh.model.mesh.generate(3)
        gmsh.model.mesh.setOrder(2)
    except Exception as error:
        raise _explained(error, spec) from error
    return _collect(blade, solids, spec, centre)


def _explained(error: Exception, spec: MeshSpec) -> MeshError:
    if isinstance(error, MeshError):
        return error
    return MeshError(
        f"gmsh could not mesh the blade with cells of {spec.size:g} m: {error}. Cells must "
        "be small enough that the faces of the blade, drawn by straight edges, stay clear "
        "of the film: use a smaller mesh size, or a thinner or smaller film."
    )


@contextmanager
def gmsh_session() -> Iterator[None]:
    """Use gmsh quietly and reproducibly, and leave nothing behind."""
    gmsh.initialize(interruptible=False)
    try:
        gmsh.model.add("blade")
        for option, value in {
            "General.Terminal": 0,
            "General.NumThreads": 1,  # the same mesh on every machine
            "Mesh.SecondOrderIncomplete": 1,
            "Mesh.MeshSizeExtendFromBoundary": 0,
            "Mesh.MeshSizeFromPoints": 0,
            "Mesh.MeshSizeFromCurvature": 0,
        }.items():
            gmsh.option.setNumber(option, value)
        yield
    finally:
        gmsh.finalize()


def faces_of(volume: int) -> list[int]:
    """Tags of the faces around one of gmsh's volumes."""
    return [tag for _, tag in gmsh.model.getBoundary([(3, volume)], oriented=False)]


def _set_film_layer(blade: Blade, solids: Solids, size: float) -> None:
    """Prescribe one layer of hexahedra: cells of about ``size`` along span and chord."""
    if solids.film is None or blade.film is None:
        return
    mesh = gmsh.model.mesh
    faces = faces_of(solids.film)
    if len(faces) != 6:
        raise MeshError(f"the film has {len(faces)} faces where a layer of hexahedra needs 6")
    s = np.linspace(*blade.film.span, 11)
    width = float(np.mean(blade.chord(s))) * (blade.film.chord[1] - blade.film.chord[0])
    length = blade.span * (blade.film.span[1] - blade.film.span[0])
    cells = {"span": max(2, round(length / size)), "chord": max(3, round(width / size))}
    curves = gmsh.model.getBoundary([(2, f) for f in faces], combined=False, oriented=False)
    for curve in {tag for _, tag in curves}:
        first, last = (
            blade.locate(np.array(gmsh.model.getValue(0, point, [])))
            for _, point in gmsh.model.getBoundary([(1, curve)])
        )
        ds, dxi = abs(first[0] - last[0]), abs(first[1] - last[1])
        along = "span" if ds * blade.span > blade.film.thickness else "chord"
        across = along == "chord" and dxi < 0.5 * (blade.film.chord[1] - blade.film.chord[0])
        mesh.setTransfiniteCurve(curve, 2 if across else cells[along] + 1)
    for face in faces:
        mesh.setTransfiniteSurface(face)
        mesh.setRecombine(2, face)
    mesh.setTransfiniteVolume(solids.film)


def _wetted_faces(solids: Solids) -> list[int]:
    water = set(faces_of(solids.water))
    return [face for face in faces_of(solids.blade) if face in water]


def _set_sizes(blade: Blade, solids: Solids, spec: MeshSpec) -> None:
    """Cells of one size on the blade, growing linearly towards the sphere.

    They are smaller where faces with longer edges would cut into the film.
    """
    wetted = _wetted_faces(solids)
    set_growth(wetted, spec.size, spec.water_size or 0.25 * spec.radius)
    clear = clear_size(blade)
    if min(clear(s) for s in np.linspace(0.0, 1.0, 101)) < spec.size:
        _keep_clear(blade, wetted, clear)


def _embed_patches(solids: Solids) -> None:
    """Let the faces' cells follow the outlines of the patches."""
    wetted = _wetted_faces(solids)
    for outline in solids.outlines:
        side_faces = [f for f in wetted if _carries(f, outline)]
        if len(side_faces) != 1:
            raise MeshError("the excited patch does not lie on one face of the blade")
        gmsh.model.mesh.embed(1, outline, 2, side_faces[0])


def _keep_clear(blade: Blade, faces: list[int], clear: Callable[[float], float]) -> None:
    """Have cells on faces, and on their edges, no larger than a size by the span fraction."""
    edges = {tag for _, tag in gmsh.model.getBoundary([(2, f) for f in faces], combined=False,
                                                      oriented=False)}  # fmt: skip
    bounded = {1: edges, 2: set(faces)}

    def size(dim: int, tag: int, x: float, y: float, z: float, size: float) -> float:
        if tag not in bounded.get(dim, ()):
            return size
        return min(size, clear(float((z - blade.hub_radius) / blade.span)))

    gmsh.model.mesh.setSizeCallback(size)


def set_growth(surfaces: list[int], size: float, largest: float) -> None:
    """Let cells of one size [m] at surfaces grow linearly with the distance to the largest."""
    field = gmsh.model.mesh.field
    distance, growth = field.add("Distance"), field.add("Threshold")
    field.setNumbers(distance, "SurfacesList", surfaces)
    field.setNumber(distance, "Sampling", 60)
    field.setNumber(growth, "InField", distance)
    limits = {
        "SizeMin": size,
        "SizeMax": largest,
        "DistMin": 0.5 * size,
        "DistMax": 0.5 * size + (largest - size) / GROWTH,
    }
    for name, value in limits.items():
        field.setNumber(growth, name, value)
    field.setAsBackgroundMesh(growth)


def _carries(face: int, curves: list[int]) -> bool:
    """Whether the middles of all curves lie on the face."""
    for curve in curves:
        (low,), (high,) = gmsh.model.getParametrizationBounds(1, curve)
        middle = gmsh.model.getValue(1, curve, [0.5 * (low + high)])
        closest, _ = gmsh.model.getClosestPoint(2, face, middle)
        size = gmsh.model.occ.getMass(1, curve)
        if np.linalg.norm(np.array(closest) - middle) > 1e-3 * size:
            return False
    return True


@dataclass(frozen=True)
class Collected:
    """What is read out of gmsh.

    Attributes
    ----------
    nodes : (n, 3) float array
        Positions [m], numbered from zero.
    number : int array
        Number of a node by gmsh's tag, -1 where it belongs to no cell.
    cells, quality : mappings
        By region, as in `Mesh`.
    """

    nodes: FloatArray
    number: IntArray
    cells: Mapping[str, tuple[CellBlock, ...]]
    quality: Mapping[str, Quality]


def collect_cells(volumes: Mapping[str, int]) -> Collected:
    """Read the cells of gmsh's volumes, by the names of their regions.

    Raises
    ------
    MeshError
        A cell is inverted (with the place).
    """
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    position = np.zeros((int(tags.max()) + 1, 3))
    position[tags] = coordinates.reshape(-1, 3)
    raw = {name: _blocks(volume) for name, volume in volumes.items()}
    used = np.unique(np.concatenate([c.ravel() for b in raw.values() for _, c in b]))
    number = np.full(len(position), -1, dtype=np.int64)
    number[used] = np.arange(len(used))
    cells = {
        name: tuple(CellBlock(kind, number[nodes_]) for kind, nodes_ in blocks)
        for name, blocks in raw.items()
    }
    quality = {name: region_quality(name, volume, position) for name, volume in volumes.items()}
    return Collected(position[used], number, cells, quality)


def _collect(blade: Blade, solids: Solids, spec: MeshSpec, centre: FloatArray) -> Mesh:
    """Read the mesh out of gmsh, with nodes numbered from zero."""
    made = collect_cells(solids.volumes())
    faces = _named_faces(blade, solids, spec.patches, made.nodes, made.number)
    notices = poor_cell_notices(made.quality)
    return Mesh(made.nodes, made.cells, faces, centre, spec.radius, made.quality, notices)


def _blocks(volume: int) -> list[tuple[str, IntArray]]:
    blocks = []
    for kind, _, nodes in zip(*gmsh.model.mesh.getElements(3, volume), strict=True):
        if kind not in CELL_KINDS:
            raise MeshError(f"gmsh made cells of an unexpected type {kind}")
        name, order = CELL_KINDS[kind]
        blocks.append((name, nodes.astype(np.int64).reshape(-1, len(order))[:, order]))
    return blocks


def surface_triangles(face: int, number: IntArray) -> IntArray:
    """Six-node triangles (m, 6) of a face of gmsh's, by the numbers of `Collected`."""
    kinds, _, nodes = gmsh.model.mesh.getElements(2, face)
    if list(kinds) != [TRIANGLE6]:
        raise MeshError("a wetted face is not meshed by six-node triangles")
    return np.asarray(number[nodes[0].astype(np.int64).reshape(-1, 6)])


def _named_faces(
    blade: Blade,
    solids: Solids,
    patches: tuple[Patch, ...],
    nodes: FloatArray,
    number: IntArray,
) -> dict[str, IntArray]:
    """Triangles of each boundary; which side they point to is left open."""
    wetted = _wetted_faces(solids)
    outer = [face for face in faces_of(solids.water) if face not in wetted]
    triangles = np.concatenate([surface_triangles(face, number) for face in wetted])
    at_root = np.abs(nodes[triangles, 2] - blade.hub_radius).max(axis=1) < 1e-9 * blade.span
    middle = nodes[triangles[:, 3:]].mean(axis=1)
    s, xi, eta = blade.locate(middle)
    mean_line = blade.family.camber_line(xi, blade.camber(s))[0]
    excited = {
        patch_name(k): (s > patch.span[0]) & (s < patch.span[1])
        & (xi > patch.chord[0]) & (xi < patch.chord[1])
        & (patch.side * (eta - mean_line) > 0.0)
        & ~at_root
        for k, patch in enumerate(patches)
    }  # fmt: skip
    rest = ~at_root & ~np.any([*excited.values(), np.zeros_like(at_root)], axis=0)
    return {
        "wet": triangles[rest],
        **{name: triangles[inside] for name, inside in excited.items()},
        "root": triangles[at_root],
        "outer": np.concatenate([surface_triangles(face, number) for face in outer]),
    }
