# SPDX-License-Identifier: LGPL-2.1-or-later
"""Blades of hexahedra for tests: the faces and directions of a real one, a few cells."""

from dataclasses import replace

import ngsolve as ngs
import numpy as np

from quietblade.geometry import Blade, constant, formula, section_family
from quietblade.mesh.nodal import NodalBasis
from quietblade.typing import BoolArray, FloatArray
from verification.structure_models import box_mesh

FLAT = Blade(
    hub_radius=0.2,
    span=1.0,
    chord=formula("0.25 - 0.175*s"),
    blade_angle=constant(0.0),
    sweep=constant(0.0),
    rake=constant(0.0),
    thickness=constant(0.12),
    camber=constant(0.0),
    family=section_family("naca-4"),
    trailing_edge=0.02,
)
"""Tapered, symmetric sections, no twist."""

TWISTED = replace(
    FLAT,
    blade_angle=formula("0.3 - 0.8*s"),
    sweep=formula("0.1*s**2"),
    rake=formula("-0.05*s**2"),
    camber=constant(0.03),
)
"""With everything that turns its surface."""


def blade_mesh(
    blade: Blade, cells: tuple[int, int, int] = (6, 2, 8), film: bool = False
) -> ngs.Mesh:
    """Hexahedra between the faces of a blade, chord fractions 0.1 to 0.9; film: the middle."""
    chordwise, across, along = cells

    def move(points: FloatArray) -> FloatArray:
        xi, zeta, s = points.T
        lower, upper = (blade.face_height(side, s, xi) for side in (-1, +1))
        return blade.place(s, np.stack([xi, lower + zeta * (upper - lower)], axis=-1))

    def in_film(centres: FloatArray) -> BoolArray:
        return np.all(np.abs(centres - 0.5) < 0.3, axis=1)

    return box_mesh(
        np.linspace(0.1, 0.9, chordwise + 1),
        np.linspace(0.0, 1.0, across + 1),
        np.linspace(0.0, 1.0, along + 1),
        move=move,
        in_film=in_film if film else None,
    )


def blade_basis(
    blade: Blade, cells: tuple[int, int, int] = (6, 2, 8), film: bool = False
) -> NodalBasis:
    """Nodes of `blade_mesh`."""
    return NodalBasis(blade_mesh(blade, cells, film))
