# SPDX-License-Identifier: LGPL-2.1-or-later
"""Campbell diagram of a case: equilibrium and wet modes at each speed of the shaft."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from quietblade.case import Case
from quietblade.case.campbell import CampbellWords
from quietblade.errors import ConvergenceError, GeometryError, MeshError, Notice, SolverError
from quietblade.geometry import Blade
from quietblade.mesh import Mesh
from quietblade.mesh.motion import solve_mesh_motion
from quietblade.propulsion.linear import newton_solver
from quietblade.propulsion.structure import EquilibriumError
from quietblade.results import mode_records as records
from quietblade.study.blade_vibration import coriolis, displacement_field, linear_problem
from quietblade.study.frames import SectionFrames
from quietblade.study.statics import solve_equilibrium
from quietblade.study.vibration import (
    ABOVE_BAND,
    SolidMatrices,
    nodal_masses,
    nodal_shapes,
    symmetric_solver,
)
from quietblade.typing import FloatArray, Progress
from quietblade.vibroacoustics.campbell import Campbell, campbell
from quietblade.vibroacoustics.modes import WetModes, wet_modes
from quietblade.vibroacoustics.naming import Naming, name_modes
from quietblade.vibroacoustics.operators import Operators

_WHERE = "Campbell diagram"

FAILURES = (EquilibriumError, GeometryError, MeshError, ConvergenceError, SolverError)
"""What may go wrong at one speed without a fault of the others."""


@dataclass(frozen=True, eq=False)
class ShaftSpeed:
    """Wet modes of the blade in the equilibrium of one speed of the shaft.

    Attributes
    ----------
    rotation, advance : float
        [rad/s], [m/s]
    tip : (3,) array
        Displacement of the tip [m].
    modes : WetModes
        Without their vectors.
    naming : Naming
    shapes : (m, n, 3) array
        Displacement of the nodes of the solid in the axes of the deformed sections [m], unit modal
        mass.
    momenta : (m, n, 3) array
        Forces on the nodes, in the same axes, by which such a motion is multiplied in the product
        of mass and moved water.
    notices : tuple of Notice
    """

    rotation: float
    advance: float
    tip: FloatArray
    modes: WetModes
    naming: Naming
    shapes: FloatArray
    momenta: FloatArray
    notices: tuple[Notice, ...]


def solve_campbell(
    case: Case, words: CampbellWords, blade: Blade, mesh: Mesh, progress: Progress
) -> tuple[records.CampbellDiagram, tuple[Notice, ...]]:
    """Find the modes at each speed, and where multiples of the blade rate meet them.

    A speed at which the blade has no equilibrium is left out, with a notice.
    """
    points: list[ShaftSpeed] = []
    notices: list[Notice] = []
    for number, speed in enumerate(words.speeds):
        progress(_WHERE, number / len(words.speeds), f"shaft at {speed:.4g} rad/s")
        try:
            points.append(_at_speed(case, words, blade, mesh, speed))
        except FAILURES as error:
            notices.append(
                Notice(f"{_WHERE} at {speed:.4g} rad/s", f"this speed is left out: {error}")
            )
    notices += _worst(points)
    if not points:
        return records.CampbellDiagram.none(), tuple(notices)
    traced = campbell(
        np.array([abs(point.rotation) for point in points]),
        [point.modes.frequency for point in points],
        case.flow.blades,
        orders=words.orders,
        likeness=[likeness(before, after) for before, after in pairwise(points)],
    )
    return _diagram(case, words, points, traced), tuple(notices)


def likeness(before: ShaftSpeed, after: ShaftSpeed) -> FloatArray:
    """Modal assurance of the modes at two speeds close to each other, (m, m').

    In the mass of the first and of the water that it moves (theory: S2-56), for modes that have
    unit modal mass each at its own speed: the difference of these masses is left out, which saves
    a factorisation of the water for each speed.
    """
    overlap = np.einsum("ani,bni->ab", before.momenta, after.shapes)
    return np.asarray(np.minimum(overlap**2, 1.0))


def _at_speed(
    case: Case, words: CampbellWords, blade: Blade, mesh: Mesh, speed: float
) -> ShaftSpeed:
    rotation = speed * (-1.0 if case.flow.rotation < 0.0 else 1.0)
    advance = case.flow.speed
    if words.advance == "scaled":
        advance *= rotation / case.flow.rotation
    there = case.varied({"flow.rotation": f"{rotation!r} rad/s", "flow.speed": f"{advance!r} m/s"})
    solver = newton_solver()
    structure, _, state = solve_equilibrium(
        there, blade, mesh, solver, chained=False, progress=lambda *_: None
    )
    structure.forget()
    if not state.converged:
        raise ConvergenceError("; ".join(str(notice) for notice in state.notices))
    motion = solve_mesh_motion(mesh, state.displacement, case.acoustics.gap)
    field = displacement_field(mesh, motion)
    solid = SolidMatrices.of(there, structure, state.structure)
    operators = linear_problem(there, mesh, solid, field)
    modes = wet_modes(
        operators,
        ABOVE_BAND * case.acoustics.band[1],
        moduli_at=0.5 * sum(case.acoustics.band),
        solver=symmetric_solver(case, precision="double"),
    )
    frames = SectionFrames.of(blade, mesh, state.coupled.sections)
    shapes = frames.shapes(nodal_shapes(mesh, operators, modes.vectors))
    masses = nodal_masses(mesh, operators)[frames.nodes]
    return ShaftSpeed(
        rotation=rotation,
        advance=advance,
        tip=state.tip_displacement,
        modes=modes,
        naming=name_modes(frames.span, frames.chord, shapes, masses),
        shapes=shapes,
        momenta=_momenta(mesh, operators, frames, modes),
        notices=(*state.notices, *modes.notices, *coriolis(rotation, modes)),
    )


def _momenta(
    mesh: Mesh, operators: Operators, frames: SectionFrames, modes: WetModes
) -> FloatArray:
    """M u + C phi of each mode, which is its share of mass and moved water, on the nodes."""
    u, water = operators.blocks.u, operators.blocks.water
    own = operators.terms["M"][u][:, u] @ modes.vectors[:, u].T
    moved = operators.terms["C"][u][:, water] @ modes.vectors[:, water].T
    forces = np.zeros((len(modes.vectors), 3 * mesh.basis.ndof))
    forces[:, operators.free[u]] = (own + moved).T
    # a functional of the unknowns as one of nodal values
    transpose = mesh.basis.interpolation.T
    on_nodes = [
        np.stack([transpose @ part for part in row.reshape(3, -1)], axis=1) for row in forces
    ]
    return np.asarray(frames.shapes(np.array(on_nodes)))


def _worst(points: Sequence[ShaftSpeed]) -> list[Notice]:
    """Notices of all speeds; of those that differ in value only the last, the fastest."""
    found: dict[tuple[str, str], tuple[float, Notice]] = {}
    for point in points:
        for notice in point.notices:
            found[notice.where, notice.message] = (point.rotation, notice)
    return [
        Notice(
            f"{_WHERE} at {rotation:.4g} rad/s, {notice.where}",
            notice.message,
            notice.value,
            notice.limit,
            notice.remedy,
        )
        for rotation, notice in found.values()
    ]


def _diagram(
    case: Case, words: CampbellWords, points: Sequence[ShaftSpeed], traced: Campbell
) -> records.CampbellDiagram:
    first = [int(np.argmax(row >= 0)) for row in traced.mode]
    names = tuple(points[k].naming.name[row[k]] for row, k in zip(traced.mode, first, strict=True))
    crossings = traced.crossings
    return records.CampbellDiagram(
        advance=words.advance,
        blades=case.flow.blades,
        rotation=traced.speed,
        advance_speed=np.array([point.advance for point in points]),
        tip_displacement=np.array([point.tip for point in points]),
        order=np.array(words.orders),
        name=names,
        frequency=traced.frequency,
        crossing_mode=tuple(names[c.branch] for c in crossings),
        crossing_order=np.array([c.order for c in crossings], dtype=np.int64),
        crossing_rotation=np.array([c.speed for c in crossings]),
        crossing_frequency=np.array([c.frequency for c in crossings]),
    )
