# SPDX-License-Identifier: LGPL-2.1-or-later
"""From a spherical shell to a conforming second-order mesh of wall and water, by gmsh."""

from dataclasses import dataclass, replace

import gmsh
import numpy as np

from quietblade.errors import InvertedCellError, MeshError
from quietblade.mesh.build import (
    ATTEMPTS,
    collect_cells,
    faces_of,
    gmsh_session,
    set_growth,
    surface_triangles,
)
from quietblade.mesh.model import Mesh, patch_name
from quietblade.mesh.quality import poor_cell_notices
from quietblade.typing import FloatArray, IntArray

BODY = "body"
"""Region of the wall."""

_CUTTER = 1.2
"""Radius of the disk that cuts a cap off its sphere, over that of the cap's rim."""


@dataclass(frozen=True)
class Cap:
    """Part of the outer surface that is excited.

    Attributes
    ----------
    axis : (3,) tuple of float
        From the centre of the body to that of the cap, of any length.
    half_angle : float
        Between the axis and the rim [rad].
    """

    axis: tuple[float, float, float]
    half_angle: float


@dataclass(frozen=True)
class ShellSpec:
    """A spherical shell about the origin in a sphere of water, and its mesh.

    Attributes
    ----------
    outer, thickness : float
        Outer radius of the wall, and its thickness [m].
    size, water_size : float
        Edge length of the cells in the wall and at the water's sphere [m].
    centre : (3,) tuple of float
        Centre of the water's sphere [m].
    radius : float
        Its radius [m].
    caps : tuple of Cap
        Which do not touch each other; there may be none.
    """

    outer: float
    thickness: float
    size: float
    water_size: float
    centre: tuple[float, float, float]
    radius: float
    caps: tuple[Cap, ...] = ()


@dataclass(frozen=True)
class _Solids:
    """Tags of gmsh's volumes, and of the faces of the wall and of the water's sphere."""

    wall: int
    water: int
    wetted: tuple[int, ...]
    inner: int
    outer: int


def build_shell(spec: ShellSpec) -> Mesh:
    """Mesh the wall, with nothing inside, and the water around it.

    Raises
    ------
    MeshError
        The volumes cannot be made or meshed.
    InvertedCellError
        A cell is inverted, also after the size was changed a little.
    """
    with gmsh_session():
        try:
            solids = _build_solids(spec)
        except Exception as error:  # gmsh raises bare Exception
            raise _explained(error, spec) from error
        failures: list[InvertedCellError] = []
        for factor in ATTEMPTS:
            gmsh.model.mesh.clear()
            try:
                return _meshed(solids, replace(spec, size=factor * spec.size))
            except InvertedCellError as error:
                failures.append(error)
    raise failures[0]


def _build_solids(spec: ShellSpec) -> _Solids:
    occ = gmsh.model.occ
    balls = {
        "wetted": occ.addSphere(0.0, 0.0, 0.0, spec.outer),
        "inner": occ.addSphere(0.0, 0.0, 0.0, spec.outer - spec.thickness),
        "outer": occ.addSphere(*spec.centre, spec.radius),
    }
    occ.synchronize()
    faces = {
        name: gmsh.model.getBoundary([(3, ball)], oriented=False)[0][1]
        for name, ball in balls.items()
    }
    occ.remove([(3, ball) for ball in balls.values()])
    wetted = _cut(faces["wetted"], spec)
    shell = occ.addSurfaceLoop(wetted)
    wall = occ.addVolume([shell, occ.addSurfaceLoop([faces["inner"]])])
    water = occ.addVolume([occ.addSurfaceLoop([faces["outer"]]), shell])
    occ.synchronize()
    # sewing may have replaced faces by copies, so that only the volumes know theirs
    around = {volume: set(faces_of(volume)) for volume in (wall, water)}
    common = around[wall] & around[water]
    (inner,), (outer,) = around[wall] - common, around[water] - common
    return _Solids(wall, water, tuple(sorted(common)), inner, outer)


def _cut(sphere: int, spec: ShellSpec) -> list[int]:
    """Cut the rims of the caps into the outer surface."""
    if not spec.caps:
        return [sphere]
    occ = gmsh.model.occ
    disks = []
    for cap in spec.caps:
        axis = np.array(cap.axis) / np.linalg.norm(cap.axis)
        centre = spec.outer * np.cos(cap.half_angle) * axis
        radius = _CUTTER * spec.outer * np.sin(cap.half_angle)
        disks.append((2, occ.addDisk(*centre, radius, radius, zAxis=axis.tolist())))
    _, pieces = occ.fragment([(2, sphere)], disks)
    wetted = [tag for _, tag in pieces[0]]
    occ.remove([pair for piece in pieces[1:] for pair in piece], recursive=True)
    return wetted


def _meshed(solids: _Solids, spec: ShellSpec) -> Mesh:
    set_growth([*solids.wetted, solids.inner], spec.size, spec.water_size)
    try:
        gmsh.model.mesh.generate(3)
        gmsh.model.mesh.setOrder(2)
        made = collect_cells({BODY: solids.wall, "water": solids.water})
    except Exception as error:  # also of a mesh without nodes, of which gmsh says nothing
        raise _explained(error, spec) from error
    worst = min(quality.worst for quality in made.quality.values())
    if worst <= 0.0:
        raise MeshError(
            f"a cell of the shell's mesh is inverted (quality {worst:.2g}). Use another mesh size, "
            f"near the thickness of the wall ({1e3 * spec.thickness:g} mm) or below it."
        )
    wetted = np.concatenate([surface_triangles(face, made.number) for face in solids.wetted])
    faces = {
        **_named(wetted, made.nodes, spec),
        "inside": surface_triangles(solids.inner, made.number),
        "outer": surface_triangles(solids.outer, made.number),
    }
    return Mesh(
        made.nodes, made.cells, faces, np.array(spec.centre), spec.radius, made.quality,
        poor_cell_notices(made.quality),
    )  # fmt: skip


def _named(triangles: IntArray, nodes: FloatArray, spec: ShellSpec) -> dict[str, IntArray]:
    """Triangles of each cap, and of what is left of the outer surface."""
    middle = nodes[triangles[:, 3:]].mean(axis=1)
    middle /= np.linalg.norm(middle, axis=1)[:, None]
    inside = [
        middle @ (np.array(cap.axis) / np.linalg.norm(cap.axis)) > np.cos(cap.half_angle)
        for cap in spec.caps
    ]
    rest = ~np.any([np.zeros(len(triangles), dtype=bool), *inside], axis=0)
    named = {patch_name(k): triangles[own] for k, own in enumerate(inside)}
    return {"wet": triangles[rest], **named}


def _explained(error: Exception, spec: ShellSpec) -> MeshError:
    if isinstance(error, MeshError):
        return error
    return MeshError(
        f"gmsh could not mesh the shell with cells of {spec.size:g} m: {error}. Use another mesh "
        f"size, near the thickness of the wall ({spec.thickness:g} m) or below it."
    )
