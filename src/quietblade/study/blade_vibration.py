# SPDX-License-Identifier: LGPL-2.1-or-later
"""Step 2 of a blade: the linear problem at rest (C0) and under its load (C1)."""

from dataclasses import replace

import ngsolve as ngs
import numpy as np

from quietblade.case import Case
from quietblade.errors import Notice
from quietblade.geometry import Blade
from quietblade.mesh import Mesh
from quietblade.mesh.model import INTERFACE
from quietblade.mesh.motion import MeshMotion
from quietblade.propulsion.structure import Structure, StructureState
from quietblade.study import translate
from quietblade.study.assumptions import FAST_SPIN
from quietblade.study.excitations import excite, needs_root, root_centre
from quietblade.study.frames import SectionFrames
from quietblade.study.statics import Statics
from quietblade.study.stream import with_stream
from quietblade.study.vibration import (
    LinearProblem,
    Share,
    SolidMatrices,
    Vibration,
    assemble,
    find_modes,
)
from quietblade.typing import Progress
from quietblade.vibroacoustics.fluid import normal_motion_matrix
from quietblade.vibroacoustics.modes import WetModes
from quietblade.vibroacoustics.multipoles import CLOSED_SURFACE, SurfaceSources
from quietblade.vibroacoustics.operators import CLAMPED, Operators
from quietblade.vibroacoustics.root import RootedSystem, add_root


def linear_problem(
    case: Case, mesh: Mesh, solid: SolidMatrices, field: ngs.GridFunction | None
) -> Operators:
    """Assemble eq. (7) of a blade with its root clamped, or free to move on springs."""
    on_springs = case.root.support == "elastic"  # then the root face moves in the water too
    with ngs.TaskManager():
        return assemble(
            case,
            mesh,
            solid,
            field,
            clamped=None if on_springs else CLAMPED,
            wetted=f"{INTERFACE}|{CLAMPED}" if on_springs else INTERFACE,
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
    problem = LinearProblem(
        name=name,
        operators=operators,
        excited=excited,
        sources=sources,
        normal_motion=normal_motion,
        positions=positions,
        frames=frames,
    )
    found = find_modes(case, mesh, problem, progress)
    fast = coriolis(case.flow.rotation, found.modes, f"modes {name}")
    return replace(found, notices=(*noticed, *slow, *found.notices, *fast))


def displacement_field(mesh: Mesh, motion: MeshMotion) -> ngs.GridFunction:
    """Motion of the mesh as a field."""
    field = ngs.GridFunction(ngs.VectorH1(mesh.fem, order=2))
    field.vec.FV().NumPy()[:] = mesh.basis.to_dofs(motion.displacement)
    return field


def coriolis(rotation: float, modes: WetModes, where: str = "modes") -> tuple[Notice, ...]:
    """Notice where the shaft [rad/s] turns fast against the lowest mode."""
    if len(modes.frequency) == 0 or modes.frequency[0] <= 0.0:
        return ()
    ratio = 2.0 * abs(rotation) / (2.0 * np.pi * modes.frequency[0])
    if ratio <= FAST_SPIN:
        return ()
    remedy = "The modes of a blade that spins this fast need the Coriolis force"
    return (Notice(where, "2 omega_p / omega_1 is not small", ratio, FAST_SPIN, remedy),)
