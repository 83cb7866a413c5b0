# SPDX-License-Identifier: LGPL-2.1-or-later
"""A small layered plate in a state with everything in it, for the structural tests."""

from functools import cache

import ngsolve as ngs
import numpy as np

from quietblade.materials import find_material, ply_axes, section_directions
from quietblade.propulsion.structure import Spin, Structure, StructureState
from quietblade.typing import BoolArray, FloatArray
from verification.structure_models import SURFACE, box_mesh

THICKNESS = np.array([-0.005, -0.0006, 0.0006, 0.005])
ALL_FACES = f"root|{SURFACE}"


def film_cells(centres: FloatArray) -> BoolArray:
    _, y, z = centres.T
    return (np.abs(y) < 0.001) & (z > 0.2) & (z < 0.5)


def plate_mesh() -> ngs.Mesh:
    """Half a metre of plate with a film in its core, twisted a little."""

    def twist(points: FloatArray) -> FloatArray:
        x, y, z = points.T
        angle = 0.05 * z
        c, s = np.cos(angle), np.sin(angle)
        return np.stack([c * x + s * y, c * y - s * x, z], axis=1)

    return box_mesh(
        np.linspace(-0.05, 0.05, 4), THICKNESS, np.linspace(0.1, 0.6, 16),
        in_film=film_cells, move=twist,
    )  # fmt: skip


@cache
def plate(law: str = "woven-carbon-paper") -> Structure:
    material = find_material(law)
    if law.startswith("woven"):
        axes = ply_axes(np.pi / 4, *section_directions(0.05 * ngs.z))
        material = material.oriented(axes)
    materials = {"blade": material, "film": find_material("viscoelastic-paper")}
    return Structure(plate_mesh(), materials, wetted=SURFACE, spin=Spin(20.0))


def lift(structure: Structure, size: float = 4e3) -> FloatArray:
    """A pressure [Pa] that varies along span and chord, on the lower side mostly."""
    x, y, z = structure.basis.points.T
    return size * np.where(y < 0, 1.0, -0.3) * (0.5 + z) * (1 - 4 * x)


@cache
def bent_plate(law: str = "woven-carbon-paper") -> StructureState:
    structure = plate(law)
    return structure.solve(lift(structure), tolerance=1e-10)
