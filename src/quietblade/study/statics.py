# SPDX-License-Identifier: LGPL-2.1-or-later
"""Step 1 of a case: mesh, structure, and the blade in equilibrium with the flow."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from quietblade.case import Case
from quietblade.errors import Notice
from quietblade.flow import limits
from quietblade.geometry import Blade
from quietblade.materials import ply_axes, section_directions
from quietblade.mesh import Mesh
from quietblade.mesh.surface import SurfaceQuadrature
from quietblade.propulsion.coupling import StaticState, solve_static
from quietblade.propulsion.strain import FilmShear, compute_film_shear
from quietblade.propulsion.structure import Structure
from quietblade.propulsion.transfer import LoadTransfer
from quietblade.study import translate
from quietblade.typing import Progress

POOR_TRANSFER = 0.5
"""Relative correction of the transferred pressure beyond which a notice is given."""


@dataclass(frozen=True, eq=False)
class Statics:
    """The blade under its own lift.

    Attributes
    ----------
    structure : Structure
        The solid's equations.
    state : StaticState
        Equilibrium and the way to it.
    shear : FilmShear or None
        Shear strain of the film in C1.
    """

    structure: Structure
    state: StaticState
    shear: FilmShear | None

    def notices(self, environment: limits.Environment) -> Iterator[Notice]:
        """Everything about step 1 that the user should know."""
        yield from self.state.notices
        coupled = self.state.coupled
        yield from limits.notices(coupled.sections, coupled.loads, environment)
        correction = self.state.surface.correction
        if correction > POOR_TRANSFER:
            yield Notice(
                "load transfer",
                "the pressure on the elements had to be changed much to carry the sections' loads",
                correction,
                POOR_TRANSFER,
                "Use a smaller mesh size",
            )


def solve_statics(case: Case, blade: Blade, mesh: Mesh, progress: Progress) -> Statics:
    """Find the equilibrium of blade and flow that a case describes."""
    structure = Structure(
        mesh.fem, translate.build_materials(case), spin=translate.spin(case), basis=mesh.basis
    )
    stations = np.linspace(0.0, 1.0, case.flow.sections)
    sections = blade.section(stations, case.flow.section_nodes)
    transfer = LoadTransfer(
        SurfaceQuadrature(mesh.nodes, mesh.interface),
        blade,
        stations,
        sections,
    )
    state = solve_static(
        structure,
        transfer,
        translate.inflow(case),
        tolerance=case.static.tolerance,
        max_iterations=case.static.max_iterations,
        newton_tolerance=case.static.newton_tolerance,
        progress=progress,
    )
    shear = None
    if case.film is not None:
        directions = section_directions(translate.blade_angle_field(case))
        shear = compute_film_shear(structure, state.structure, ply_axes(0.0, *directions))
    return Statics(structure, state, shear)
