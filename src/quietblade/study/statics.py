# SPDX-License-Identifier: LGPL-2.1-or-later
"""Step 1 of a case: mesh, structure, and the blade in equilibrium with the flow."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from quietblade.card import Card, Shown
from quietblade.case import Case
from quietblade.errors import Notice
from quietblade.flow import limits
from quietblade.flow.performance import ideal_notices, performance
from quietblade.geometry import Blade
from quietblade.linalg import SolverReport, SparseSolver
from quietblade.mesh import Mesh
from quietblade.mesh.surface import SurfaceQuadrature
from quietblade.propulsion.coupling import StaticState, solve_static
from quietblade.propulsion.linear import newton_solver
from quietblade.propulsion.loads_assembly import AppliedLoads, apply_loads
from quietblade.propulsion.strain import FilmShear, compute_film_shear
from quietblade.propulsion.stress import RegionStress, StressReport, compute_stress
from quietblade.propulsion.structure import Structure
from quietblade.propulsion.tensors import principal_values
from quietblade.propulsion.transfer import LoadTransfer
from quietblade.study import solids, translate
from quietblade.study.loads import steady_loads, support
from quietblade.study.viscous import ViscousFlow, viscous_flow, viscous_notices
from quietblade.typing import Progress

POOR_TRANSFER = 0.5
"""Relative correction of the transferred pressure beyond which a notice is given."""


UNBALANCED = 1e-4
"""Relative difference of reaction and loads beyond which a notice is given."""


@dataclass(frozen=True, eq=False, repr=False)
class Statics(Shown):
    """The blade under its own lift.

    Attributes
    ----------
    structure : Structure
        The solid's equations.
    state : StaticState
        Equilibrium and the way to it.
    loads : AppliedLoads or None
        Loads besides those of flow and spin.
    shear : FilmShear or None
        Shear strain of the film in C1.
    stress : StressReport
        Stress, strain and failure indices by region, and the reaction of the root.
    viscous : tuple of ViscousFlow
        Friction on the rigid, the chained and the coupled blade; where there is no chained one,
        the coupled blade stands in its place.
    solver : SolverReport
        What the linear solvers did.
    """

    structure: Structure
    state: StaticState
    loads: AppliedLoads | None
    shear: FilmShear | None
    stress: StressReport
    viscous: tuple[ViscousFlow, ...]
    solver: SolverReport

    def card(self) -> Card:
        """Add to the state's rows the largest stresses and strains."""
        shown = self.state.card()
        rows = [
            (
                f"largest von Mises stress, {name}",
                f"{1e-6 * region.peaks['von_mises'].value:.4g} MPa",
            )
            for name, region in self.stress.regions.items()
        ]
        if self.shear is not None:
            rows.append(("largest shear strain of the film", f"{100.0 * self.shear.maximum:.3f} %"))
        return replace(shown, rows=(*shown.rows, *rows))

    @property
    def blade_shear(self) -> float:
        """Largest engineering shear strain at the nodes outside the film.

        ``max (E_i - E_j)`` of the principal Green-Lagrange strains.
        """
        principal = principal_values(self.stress.regions["blade"].at_nodes.green_lagrange)
        return float(np.max(principal[:, 0] - principal[:, 2]))

    def notices(self, case: Case) -> Iterator[Notice]:
        """Everything about step 1 that the user should know."""
        yield from self.state.notices
        yield from self._stress_notices()
        flow = self.state.coupled.sections, self.state.coupled.loads
        inflow = translate.inflow(case)
        yield from inflow.notices(*flow)
        yield from limits.notices(*flow, translate.environment(case))
        figures = performance(self.state.coupled, inflow)
        yield from ideal_notices(figures, inflow, case.water.density)
        yield from viscous_notices(case, self.viscous[-1])
        correction = self.state.surface.correction
        if correction > POOR_TRANSFER:
            yield Notice(
                "load transfer",
                "the pressure on the elements had to be changed much to carry the sections' loads",
                correction,
                POOR_TRANSFER,
                "Use a smaller mesh size",
            )

    def _stress_notices(self) -> Iterator[Notice]:
        for region in self.stress.regions.values():
            yield from _failure_notices(region)
        reaction = self.stress.reaction
        if reaction.force_imbalance > UNBALANCED:
            yield Notice(
                "root",
                "the reaction does not balance the loads; relative difference",
                reaction.force_imbalance,
                UNBALANCED,
                "Tighten static.newton_tolerance",
            )


def _failure_notices(region: RegionStress) -> Iterator[Notice]:
    for name in region.failure_at_points:
        peak = region.peaks[name]
        if peak.value > 1.0:
            x, y, z = peak.place
            yield Notice(
                f"{region.region} at ({x:.3f}, {y:.3f}, {z:.3f}) m",
                f"failure index {name.replace('_', ' ')} above 1; 99 % of the volume stay below "
                f"{peak.percentile:.3g}",
                peak.value,
                1.0,
                "Lower the load, or use a stronger material; at sharp edges refine the mesh first",
            )


def build_structure(case: Case, blade: Blade, mesh: Mesh, solver: SparseSolver) -> Structure:
    """Make the solid of a case: materials, support and spin."""
    springs = support(case)
    return Structure(
        mesh.fem,
        solids.build_materials(case, blade, mesh.basis),
        clamped="root" if springs is None else None,
        support=springs,
        spin=translate.spin(case),
        basis=mesh.basis,
        solver=solver,
    )


def solve_equilibrium(
    case: Case,
    blade: Blade,
    mesh: Mesh,
    solver: SparseSolver,
    *,
    chained: bool = True,
    progress: Progress,
) -> tuple[Structure, AppliedLoads | None, StaticState]:
    """Find the blade that a case describes under its own lift, with its structure and loads."""
    structure = build_structure(case, blade, mesh, solver)
    loads = apply_loads(structure, steady_loads(case, blade), blade=blade) if case.loads else None
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
        method=case.static.method,
        ramp=case.static.ramp,
        extra=(loads.pressure, loads.dead_load) if loads is not None else None,
        tolerance=case.static.tolerance,
        max_iterations=case.static.max_iterations,
        newton_tolerance=case.static.newton_tolerance,
        chained=chained,
        progress=progress,
    )
    return structure, loads, state


def solve_statics(case: Case, blade: Blade, mesh: Mesh, progress: Progress) -> Statics:
    """Find the equilibrium of blade and flow that a case describes, and what follows from it."""
    solver = newton_solver()
    structure, loads, state = solve_equilibrium(case, blade, mesh, solver, progress=progress)
    shear, axes = None, {}
    if case.film is not None:
        axes = {"film": solids.surface_axes(blade, mesh.basis)}
        shear = compute_film_shear(structure, state.structure, axes["film"])
    plies = solids.blade_plies(case, blade, mesh.basis)
    stress = compute_stress(structure, state.structure, axes=axes, plies=plies)
    # without a chained computation its rows hold what `outcome` replaces by nan
    chained = state.coupled if state.chained_flow is None else state.chained_flow
    viscous = tuple(viscous_flow(case, flow) for flow in (state.rigid, chained, state.coupled))
    # a new structure, since this one keeps the matrices of Newton's method
    step2 = build_structure(case, blade, mesh, newton_solver())
    return Statics(step2, state, loads, shear, stress, viscous, solver.report())
