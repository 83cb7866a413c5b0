# SPDX-License-Identifier: LGPL-2.1-or-later
"""Step 2 of a case: wet modes about one configuration, for blades and other bodies alike."""

from collections.abc import Mapping
from dataclasses import dataclass

import ngsolve as ngs
import numpy as np
from scipy.sparse import csr_matrix

from quietblade.card import Card, Shown, shortened
from quietblade.case import AnyCase
from quietblade.errors import Notice
from quietblade.linalg import Precision, SolverChain, SolverReport, make_solver
from quietblade.mesh import Mesh
from quietblade.mesh.model import INTERFACE
from quietblade.propulsion.structure import Structure, StructureState
from quietblade.propulsion.tangent import STIFFNESS, Tangent, compute_tangent
from quietblade.study import losses, translate
from quietblade.study.clock import within
from quietblade.study.excitations import Excited
from quietblade.study.frames import Frames, Names
from quietblade.typing import AnyArray, FloatArray, Progress
from quietblade.vibroacoustics.complex_modes import ComplexModes, complex_modes
from quietblade.vibroacoustics.grid import refined_grid
from quietblade.vibroacoustics.loss import Lossy
from quietblade.vibroacoustics.modes import WetModes, wet_modes
from quietblade.vibroacoustics.multipoles import SurfaceSources
from quietblade.vibroacoustics.operators import Operators, build_operators
from quietblade.vibroacoustics.reduced import ReducedSweep, reduce_system
from quietblade.vibroacoustics.root import RootedSystem

ABOVE_BAND = 1.2
"""Wet modes are sought up to this multiple of the band's upper end, so that a mode that the
static load moves into the band keeps its name."""

SPACE_TOLERANCE = 1e-6
"""Residual of the solves that make the space of a reduced sweep.  They say where the solutions
lie, not what they are: these, and the estimate of their error, come from the matrices."""


@dataclass(frozen=True, eq=False, repr=False)
class LinearProblem:
    """The linear problem about C0 or C1: what its modes and its sound come from.

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
        Square of the normal motion of the whole wetted surface, for the radiation efficiency.
    positions : (nodes, 3) float array
        Nodes of the mesh in this configuration [m].
    frames : Frames
        Axes in which modes are named and compared: those of the sections, of a blade.
    """

    name: str
    operators: Operators
    excited: Excited
    sources: SurfaceSources
    normal_motion: csr_matrix
    positions: FloatArray
    frames: Frames


@dataclass(frozen=True, eq=False, repr=False)
class Vibration(LinearProblem, Shown):
    """A linear problem and its modes.

    Attributes
    ----------
    modes : WetModes
        Real modes, also somewhat above the band.
    shapes : (m, named nodes, 3) float array
        Motion of the modes in these axes; of a blade chordwise, normal, along the span.
    masses : (named nodes,) float array
        Mass that each node stands for, up to a common factor.
    naming : Names
        Names of the modes by that motion.
    damped : ComplexModes
        Modes of the band with loss, compressibility and radiation.
    sweep : ReducedSweep or None
        Certified reduced model of the band, unless the case asks for a direct sweep.
    solver : SolverReport
        What the solvers did for the modes.
    notices : tuple of Notice
    """

    modes: WetModes
    shapes: FloatArray
    masses: FloatArray
    naming: Names
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
        cls, case: AnyCase, structure: Structure, state: StructureState, share: Share | None = None
    ) -> "SolidMatrices":
        """Linearise the structure about a state; with a `Share`, only that part of it counts."""
        part = share or Share()
        tangent = compute_tangent(structure, state, shape=part.shape, prestress=part.prestress)
        pieces = STIFFNESS[case.acoustics.tangent] if part.pieces is None else part.pieces
        with ngs.TaskManager():
            loss = losses.loss_parts(case, losses.moduli(case), structure, state, tangent)
        return cls(tangent, tangent.sum(pieces), loss)


def assemble(
    case: AnyCase,
    mesh: Mesh,
    solid: SolidMatrices,
    field: ngs.GridFunction | None = None,
    *,
    clamped: str | None,
    wetted: str = INTERFACE,
) -> Operators:
    """Assemble eq. (7) with the structure's matrices, on the mesh that is moved to its state."""
    return build_operators(
        mesh.fem,
        stiffness=solid.stiffness,
        loss=solid.loss,
        mass=solid.tangent.mass,
        water=translate.water(case),
        radius=mesh.radius,
        motion=field,
        clamped=clamped,
        wetted=wetted,
        condition=translate.radiation(case, mesh, field),
    )


def find_modes(case: AnyCase, mesh: Mesh, problem: LinearProblem, progress: Progress) -> Vibration:
    """Find the modes of a linear problem, and the reduced model of its band."""
    operators, frames, excited = problem.operators, problem.frames, problem.excited
    progress(problem.name, 0.2, "matrices assembled")
    low, high = case.acoustics.band
    modes, solver = _modes(case, operators, progress)
    progress(problem.name, 0.5, f"{len(modes.frequency)} wet modes")
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
        **vars(problem),
        modes=modes,
        shapes=shapes,
        masses=masses,
        naming=frames.names(shapes, masses, modes.rigid),
        damped=damped,
        sweep=sweep.without_factor() if sweep else None,
        solver=solver,
        notices=(*modes.notices, *damped.notices),
    )


def _modes(
    case: AnyCase, operators: Operators, progress: Progress
) -> tuple[WetModes, SolverReport]:
    """Wet modes of the band and somewhat above; the solver is gone then."""
    solver = symmetric_solver(case, precision="double")
    low, high = case.acoustics.band
    modes = wet_modes(
        operators, ABOVE_BAND * high, moduli_at=0.5 * (low + high), solver=solver, progress=progress
    )
    return modes, solver.report()


def frequencies(case: AnyCase, vibrations: list[Vibration]) -> FloatArray:
    """Frequencies of the sweep [Hz], refined around the modes of all configurations.

    Those at which the directivity is asked for are among them.
    """
    grid = _refined(case, vibrations)
    return np.union1d(grid, np.array(case.far_field.frequencies))


def _refined(case: AnyCase, vibrations: list[Vibration]) -> FloatArray:
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
    case: AnyCase, *, precision: Precision | None = None, tolerance: float = 0.0
) -> SolverChain:
    """Make the solver of the case for systems of step 2; of the tolerances the larger counts."""
    return make_solver(
        case.solver.name,
        precision=precision or case.solver.precision,
        tolerance=max(case.solver.tolerance, tolerance),
    )


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
