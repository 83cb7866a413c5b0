# SPDX-License-Identifier: LGPL-2.1-or-later
"""Step 1 of a case: mesh, structure, and the blade in equilibrium with the flow."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from quietblade.case import Case
from quietblade.errors import Notice
from quietblade.flow import limits
from quietblade.geometry import Blade
from quietblade.linalg import SolverReport
from quietblade.materials import ply_axes, section_directions
from quietblade.mesh import Mesh
from quietblade.mesh.surface import SurfaceQuadrature
from quietblade.propulsion.coupling import StaticState, solve_static
from quietblade.propulsion.linear import newton_solver
from quietblade.propulsion.strain import FilmShear, compute_film_shear, nodal_strain
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
    blade_shear : float
        Largest engineering shear strain at the nodes outside the film, ``max (E_i - E_j)`` of the
        principal Green-Lagrange strains.
    solver : SolverReport
        What the linear solvers did.
    """

    structure: Structure
    state: StaticState
    shear: FilmShear | None
    blade_shear: float
    solver: SolverReport

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
    solver = newton_solver()
    structure = Structure(
        mesh.fem,
        translate.build_materials(case),
        spin=translate.spin(case),
        basis=mesh.basis,
        solver=solver,
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
    structure.forget()  # its factor is not needed in step 2
    return Statics(structure, state, shear, _blade_shear(structure, state), solver.report())


def _blade_shear(structure: Structure, state: StaticState) -> float:
    strain = nodal_strain(structure, state.structure, region="blade")
    E11, E22, E33, E23, E13, E12 = strain[np.isfinite(strain).all(axis=1)].T
    tensors = np.moveaxis(np.array([[E11, E12, E13], [E12, E22, E23], [E13, E23, E33]]), -1, 0)
    principal = np.linalg.eigvalsh(tensors)
    return float(np.max(principal[:, 2] - principal[:, 0]))
