# SPDX-License-Identifier: LGPL-2.1-or-later
"""Step 2 of a case: wet modes and sound of the blade about one configuration."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import ngsolve as ngs
import numpy as np
from scipy.sparse import csr_matrix

from quietblade.card import Card, Shown, shortened
from quietblade.case import Case
from quietblade.errors import Notice
from quietblade.geometry import Blade
from quietblade.linalg import Precision, SolverChain, SolverReport, make_solver
from quietblade.mesh import Mesh
from quietblade.mesh.model import INTERFACE
from quietblade.mesh.motion import MeshMotion
from quietblade.propulsion.structure import Structure, StructureState
from quietblade.propulsion.tangent import STIFFNESS, Tangent, compute_tangent
from quietblade.study import losses, translate
from quietblade.study.assumptions import FAST_SPIN
from quietblade.study.clock import within
from quietblade.study.excitations import Excited, excite, needs_root, root_centre
from quietblade.study.frames import SectionFrames
from quietblade.study.statics import Statics
from quietblade.study.stream import with_stream
from quietblade.typing import AnyArray, FloatArray, Progress
from quietblade.vibroacoustics.complex_modes import ComplexModes, complex_modes
from quietblade.vibroacoustics.fluid import normal_motion_matrix
from quietblade.vibroacoustics.grid import refined_grid
from quietblade.vibroacoustics.loss import Lossy
from quietblade.vibroacoustics.modes import WetModes, wet_modes
from quietblade.vibroacoustics.multipoles import CLOSED_SURFACE, SurfaceSources
from quietblade.vibroacoustics.naming import Naming, name_modes
from quietblade.vibroacoustics.operators import CLAMPED, Operators, build_operators
from quietblade.vibroacoustics.reduced import ReducedSweep, reduce_system
from quietblade.vibroacoustics.root import RootedSystem, add_root

ABOVE_BAND = 1.2
"""Wet modes are sought up to this multiple of the band's upper end, so that a mode that the
static load moves into the band keeps its name."""

SPACE_TOLERANCE = 1e-6
"""Residual of the solves that make the space of a reduced sweep.  They say where the solutions
lie, not what they are: these, and the estimate of their error, come from the matrices."""


@dataclass(frozen=True)
class Share:
    """What of the steady load counts in the linear problem about C1 (theory: S2-1).

    Attributes
    ----------
    shape : bool
        Whether the blade, and the water around it, have the deformed shape.
    prestress : bool
        Whether the stress of the load acts, with the loads in balance with it.
    pieces : tuple of str or None
        Pieces of the tangent that are added up; by default those that the case asks for.
    """

    shape: bool = True
    prestress: bool = True
    pieces: tuple[str, ...] | None = None


@dataclass(frozen=True, eq=False, repr=False)
class Vibration(Shown):
    """The linear problem about C0 or C1, and its modes.

    Attributes
    ----------
    name : str
        ``C0`` or ``C1``.
    operators : Operators
        Matrices of eq. (7).
    excited : Excited
        Loads in this configuration.
    sources : SurfaceSources
        For the outgoing waves.
    normal_motion : csr_matrix
        Square of the normal motion of the blade's whole surface, for the radiation efficiency.
    positions : (nodes, 3) float array
        Nodes of the mesh in this configuration [m].
    modes : WetModes
        Real modes, also somewhat above the band.
    frames : SectionFrames
        Places of the solid's nodes in the sections, and the axes of these.
    shapes : (m, solid nodes, 3) float array
        Motion of the modes in the axes of the (deformed) sections: chordwise, normal, along the
        span.
    masses : (solid nodes,) float array
        Mass that each node stands for, up to a common factor.
    naming : Naming
        Names of the modes by that motion.
    damped : ComplexModes
        Modes of the band with loss, compressibility and radiation.
    sweep : ReducedSweep or None
        Certified reduced model of the band, unless the case asks for a direct sweep.
    solver : SolverReport
        What the solvers did for the modes.
    notices : tuple of Notice
    """

    name: str
    operators: Operators
    excited: Excited
    sources: SurfaceSources
    normal_motion: csr_matrix
    positions: FloatArray
    modes: WetModes
    frames: SectionFrames
    shapes: FloatArray
    masses: FloatArray
    naming: Naming
    damped: ComplexModes
    sweep: ReducedSweep | None
    solver: SolverReport
    notices: tuple[Notice, ...]

    def card(self) -> Card:
        """Wet modes by name; with loss and radiation those of the band."""
        modes = self.modes
        damped = dict(zip(self.damped.start.tolist(), self.damped.loss_factor, strict=True))
        rows = [
            (name, f"{f:.4f}", f"{eta:.3e}", f"{damped[k]:.3e}" if k in damped else "-")
            for k, (name, f, eta) in enumerate(
                zip(self.naming.name, modes.frequency, modes.loss_factor, strict=True)
            )
        ]
        return Card(
            f"Modes of {self.name}: {modes.count} below {modes.highest:g} Hz, none missed",
            shortened(rows),
            ("mode", "frequency [Hz]", "loss of the material [1]", "with radiation [1]"),
        )


@dataclass(frozen=True, eq=False)
class SolidMatrices:
    """What the structure brings into eq. (7), made once for the system and for a root that moves.

    Attributes
    ----------
    tangent : Tangent
    stiffness : csr_matrix
    loss : mapping of str to csr_matrix or Lossy
        Lossy parts by region.
    """

    tangent: Tangent
    stiffness: csr_matrix
    loss: Mapping[str, csr_matrix | Lossy]

    @classmethod
    def of(
        cls, case: Case, structure: Structure, state: StructureState, share: Share | None = None
    ) -> "SolidMatrices":
        """Linearise the structure about a state; with a `Share`, only that part of it counts."""
        part = share or Share()
        tangent = compute_tangent(structure, state, shape=part.shape, prestress=part.prestress)
        pieces = STIFFNESS[case.acoustics.tangent] if part.pieces is None else part.pieces
        with ngs.TaskManager():
            loss = losses.loss_parts(case, losses.moduli(case), structure, state, tangent)
        return cls(tangent, tangent.sum(pieces), loss)


def linear_problem(
    case: Case, mesh: Mesh, solid: SolidMatrices, field: ngs.GridFunction | None
) -> Operators:
    """Assemble eq. (7) with the structure's matrices, on the mesh that is moved to its state."""
    on_springs = case.root.support == "elastic"  # then the root face moves in the water too
    with ngs.TaskManager():
        return build_operators(
            mesh.fem,
            stiffness=solid.stiffness,
            loss=solid.loss,
            mass=solid.tangent.mass,
            water=translate.water(case),
            radius=mesh.radius,
            motion=field,
            clamped=None if on_springs else CLAMPED,
            wetted=f"{INTERFACE}|{CLAMPED}" if on_springs else INTERFACE,
            condition=translate.radiation(case, mesh, field),
        )


def _moving_root(
    case: Case,
    mesh: Mesh,
    solid: SolidMatrices,
    operators: Operators,
    field: ngs.GridFunction | None,
) -> RootedSystem:
    """Let the clamped root of a system move."""
    with ngs.TaskManager():
        return add_root(
            operators,
            mesh.fem,
            mesh.basis,
            stiffness=solid.stiffness,
            mass=solid.tangent.mass,
            loss=solid.loss,
            water=translate.water(case),
            about=root_centre(mesh),
            motion=field,
        )


def _system(
    case: Case,
    mesh: Mesh,
    structure: Structure,
    state: StructureState,
    field: ngs.GridFunction | None,
    share: Share | None,
) -> tuple[Operators, RootedSystem | None, tuple[Notice, ...]]:
    """Matrices of eq. (7), with the root if it moves; the pieces of the tangent are gone then."""
    solid = SolidMatrices.of(case, structure, state, share)
    operators = linear_problem(case, mesh, solid, field)
    if not needs_root(case):
        return operators, None, solid.tangent.notices
    root = _moving_root(case, mesh, solid, operators, field)
    return root.operators, root, solid.tangent.notices


def _modes(case: Case, operators: Operators, progress: Progress) -> tuple[WetModes, SolverReport]:
    """Wet modes of the band and somewhat above; the solver is gone then."""
    solver = symmetric_solver(case, precision="double")
    low, high = case.acoustics.band
    modes = wet_modes(
        operators, ABOVE_BAND * high, moduli_at=0.5 * (low + high), solver=solver, progress=progress
    )
    return modes, solver.report()


def solve_vibration(
    case: Case,
    blade: Blade,
    mesh: Mesh,
    statics: Statics,
    motion: MeshMotion | None,
    progress: Progress,
    share: Share | None = None,
) -> Vibration:
    """Set up the linear problem about C0 (no motion) or C1, and find its modes.

    With a `Share`, only that part of the steady load counts; without the deformed shape the
    problem is on the mesh of C0.
    """
    name = "C0" if motion is None else "C1"
    loaded = motion is not None
    if share is not None and not share.shape:
        motion = None
    structure = statics.structure
    state = statics.state.structure if loaded else structure.rest()
    field = None if motion is None else displacement_field(mesh, motion)
    positions = mesh.nodes if motion is None else mesh.nodes + motion.displacement
    bent = None if motion is None else statics.state.coupled.sections
    frames = SectionFrames.of(blade, mesh, bent)
    operators, root, noticed = _system(case, mesh, structure, state, field, share)
    slow: tuple[Notice, ...] = ()
    if case.acoustics.flow_damping:
        flow = statics.state.rigid if motion is None else statics.state.coupled
        operators, slow = with_stream(case, mesh, operators, flow, positions, frames)
        root = None if root is None else replace(root, operators=operators)
    with ngs.TaskManager():
        excited = excite(case, blade, mesh, positions, operators, root, field)
        carried = None if root is None else root.carried
        sources = SurfaceSources.of(mesh.fem, mesh.basis, operators, motion=field, carried=carried)
        normal_motion = normal_motion_matrix(mesh.fem, CLOSED_SURFACE, field)
    progress(name, 0.2, "matrices assembled")
    low, high = case.acoustics.band
    modes, solver = _modes(case, operators, progress)
    progress(name, 0.5, f"{len(modes.frequency)} wet modes")
    sweep = None
    if case.acoustics.sweep == "reduced":
        sweep = reduce_system(
            operators,
            excited.every,
            translate.base_frequencies(case),
            power=excited.powers,
            tolerance=case.acoustics.accuracy,
            solver=symmetric_solver(case, tolerance=SPACE_TOLERANCE),
            progress=progress,
        )
    shapes = frames.shapes(nodal_shapes(mesh, operators, modes.vectors))
    masses = nodal_masses(mesh, operators)[frames.nodes]
    reach = (low / 1.02, high * 1.02)
    damped = complex_modes(
        operators,
        modes,
        reach,
        solver=symmetric_solver(case),
        space=sweep.model.space if sweep else None,
        factor=sweep.factor if sweep else None,
        progress=within(progress, 0.8, 1.0),
    )
    return Vibration(
        name=name,
        operators=operators,
        excited=excited,
        sources=sources,
        normal_motion=normal_motion,
        positions=positions,
        modes=modes,
        frames=frames,
        shapes=shapes,
        masses=masses,
        naming=name_modes(frames.span, frames.chord, shapes, masses),
        damped=damped,
        sweep=sweep.without_factor() if sweep else None,
        solver=solver,
        notices=(
            *noticed,
            *slow,
            *modes.notices,
            *damped.notices,
            *coriolis(case.flow.rotation, modes),
        ),
    )


def frequencies(case: Case, vibrations: list[Vibration]) -> FloatArray:
    """Frequencies of the sweep [Hz], refined around the modes of all configurations.

    Those at which the directivity is asked for are among them.
    """
    grid = _refined(case, vibrations)
    return np.union1d(grid, np.array(case.far_field.frequencies))


def _refined(case: Case, vibrations: list[Vibration]) -> FloatArray:
    damped = [vibration.damped for vibration in vibrations]
    modes = (
        np.concatenate([d.frequency for d in damped]),
        np.concatenate([d.loss_factor for d in damped]),
    )
    if case.acoustics.points_per_mode == 0:
        return refined_grid(case.acoustics.band, case.acoustics.step)
    return refined_grid(
        case.acoustics.band, case.acoustics.step, modes, case.acoustics.points_per_mode
    )


def symmetric_solver(
    case: Case, *, precision: Precision | None = None, tolerance: float = 0.0
) -> SolverChain:
    """Make the solver of the case for systems of step 2; of the tolerances the larger counts."""
    return make_solver(
        case.solver.name,
        precision=precision or case.solver.precision,
        tolerance=max(case.solver.tolerance, tolerance),
    )


def displacement_field(mesh: Mesh, motion: MeshMotion) -> ngs.GridFunction:
    """Motion of the mesh as a field."""
    field = ngs.GridFunction(ngs.VectorH1(mesh.fem, order=2))
    field.vec.FV().NumPy()[:] = mesh.basis.to_dofs(motion.displacement)
    return field


def nodal_shapes(
    mesh: Mesh, operators: Operators, vectors: AnyArray, root: RootedSystem | None = None
) -> AnyArray:
    """Displacement of all nodes, (m, nodes, 3), from vectors (m, n) of free unknowns.

    Those of a root that moves come from its motion.
    """
    full = np.zeros((len(vectors), 3 * mesh.basis.ndof), dtype=vectors.dtype)
    full[:, operators.free[operators.blocks.u]] = vectors[:, operators.blocks.u]
    if root is not None:
        full += (root.carried @ vectors.T).T
    return np.array([mesh.basis.to_values(row) for row in full])


def nodal_masses(mesh: Mesh, operators: Operators) -> FloatArray:
    """Mass that each node stands for, up to a common factor: the diagonal of the nodal matrix.

    Of the motion along the span, which the clamped root and the water do not touch elsewhere.
    """
    u, basis = operators.blocks.u, mesh.basis
    mass = operators.terms["M"][u][:, u]
    last = operators.free[u] - 2 * basis.ndof
    kept = np.flatnonzero(last >= 0)
    to_unknowns = basis.interpolation[last[kept]]
    inertia = mass[kept][:, kept] @ to_unknowns
    return np.asarray(to_unknowns.multiply(inertia).sum(axis=0)).ravel()


def coriolis(rotation: float, modes: WetModes) -> tuple[Notice, ...]:
    """Notice where the shaft [rad/s] turns fast against the lowest mode."""
    if len(modes.frequency) == 0 or modes.frequency[0] <= 0.0:
        return ()
    ratio = 2.0 * abs(rotation) / (2.0 * np.pi * modes.frequency[0])
    if ratio <= FAST_SPIN:
        return ()
    remedy = "The modes of a blade that spins this fast need the Coriolis force"
    return (Notice("modes", "2 omega_p / omega_1 is not small", ratio, FAST_SPIN, remedy),)
