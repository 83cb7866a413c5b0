# SPDX-License-Identifier: LGPL-2.1-or-later
"""Geometry and mesh for other programs: STEP of blade and film, MSH of the mesh."""

import os
import re
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import gmsh
import numpy as np

from quietblade.errors import MeshError
from quietblade.geometry import Blade
from quietblade.mesh.build import CELL_KINDS, TRIANGLE6, gmsh_session
from quietblade.mesh.cad import build_body
from quietblade.mesh.model import Mesh

_MILLIMETRES = 1e3  # in one metre
_SOLID = re.compile(r"((?:MANIFOLD_SOLID_BREP|BREP_WITH_VOIDS)\(')'")
_PRODUCT = re.compile(r"(PRODUCT\(')[^']*(',\s*')[^']*'")


def write_step(blade: Blade, file: Path) -> None:
    """Write the undeformed blade and its film as solids of a STEP file, in millimetres.

    The solids are those that are meshed; they touch without a gap, and are called ``blade`` and
    ``film``.

    Parameters
    ----------
    blade : Blade
    file : Path
        ``.step`` or ``.stp``; replaced if it is there.

    Raises
    ------
    MeshError
        The geometry kernel cannot make the solids, or cannot write.
    """
    if file.suffix.lower() not in {".step", ".stp"}:
        raise MeshError(f"the name of a STEP file ends with .step or .stp, not {file.suffix!r}")
    with gmsh_session():
        regions = build_body(blade)
        gmsh.model.occ.remove(gmsh.model.occ.getEntities(0))  # those that no solid needs
        every = [(3, tag) for tag in regions.values()]
        gmsh.model.occ.dilate(every, 0.0, 0.0, 0.0, *3 * (_MILLIMETRES,))
        gmsh.model.occ.synchronize()
        with _kernel_silenced():
            _write(file)
    # the kernel writes solids in the order of their tags, without names
    names = sorted(regions, key=lambda name: regions[name])
    text = file.read_text(encoding="utf-8")
    products = ["blade"] if len(names) == 1 else ["blade with film", *names]
    file.write_text(_named(_named(text, _SOLID, names), _PRODUCT, products), encoding="utf-8")


def _named(text: str, pattern: re.Pattern[str], names: list[str]) -> str:
    """Put names into the places that a pattern finds, one each."""
    found = len(pattern.findall(text))
    if found != len(names):
        raise MeshError(f"the STEP file has {found} parts where {', '.join(names)} are expected")
    rest = iter(names)

    def name(match: re.Match[str]) -> str:
        new = next(rest)
        return f"{new}".join([*match.groups(), ""]) + "'"

    return pattern.sub(name, text)


def write_msh(mesh: Mesh, file: Path) -> None:
    """Write the mesh in gmsh's format MSH 4.1, in metres.

    Regions and boundaries are physical groups of their names; cells are of second order.

    Parameters
    ----------
    mesh : Mesh
    file : Path
        ``.msh``; replaced if it is there.

    Raises
    ------
    MeshError
        The file cannot be written.
    """
    if file.suffix.lower() != ".msh":
        raise MeshError(f"the name of a file in gmsh's format ends with .msh, not {file.suffix!r}")
    with gmsh_session():
        _add_cells(mesh)  # with the nodes
        _add_faces(mesh)
        _write(file)


def _add_cells(mesh: Mesh) -> None:
    numbers = {name: (number, order) for number, (name, order) in CELL_KINDS.items()}
    for tag, (region, blocks) in enumerate(mesh.cells.items(), 1):
        gmsh.model.addDiscreteEntity(3, tag)
        gmsh.model.addPhysicalGroup(3, [tag], tag, region)
        if tag == 1:  # one entity may hold the nodes of all
            every = 1 + np.arange(len(mesh.nodes))
            gmsh.model.mesh.addNodes(3, tag, every, mesh.nodes.ravel())
        for block in blocks:
            number, order = numbers[block.kind]
            back = np.argsort(order)  # from VTK's order of nodes to gmsh's
            nodes = 1 + block.connectivity[:, back].ravel()
            gmsh.model.mesh.addElementsByType(tag, number, [], nodes)


def _add_faces(mesh: Mesh) -> None:
    for tag, (name, triangles) in enumerate(mesh.faces.items(), 1):
        gmsh.model.addDiscreteEntity(2, tag)
        gmsh.model.addPhysicalGroup(2, [tag], tag, name)
        gmsh.model.mesh.addElementsByType(tag, TRIANGLE6, [], 1 + triangles.ravel())


def _write(file: Path) -> None:
    try:
        gmsh.write(str(file))
    except Exception as error:  # gmsh raises bare Exception
        raise MeshError(f"{file}: gmsh could not write the file: {error}") from error


@contextmanager
def _kernel_silenced() -> Iterator[None]:
    """Keep what the geometry kernel writes on standard output from the user."""
    sys.stdout.flush()
    kept = os.dup(1)
    with Path(os.devnull).open("w") as nothing:
        os.dup2(nothing.fileno(), 1)
        try:
            yield
        finally:
            os.dup2(kept, 1)
            os.close(kept)
