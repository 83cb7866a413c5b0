# SPDX-License-Identifier: LGPL-2.1-or-later
"""The steady problem, the shape and the mesh of a case for other programs."""

from pathlib import Path

import ngsolve as ngs

from quietblade.case import AnyCase, BodyCase, Case
from quietblade.linalg import default_threads
from quietblade.mesh import build_mesh
from quietblade.mesh.exchange import write_msh, write_step
from quietblade.mesh.shell import build_shell
from quietblade.propulsion.deck import write_deck
from quietblade.results.files import replacing
from quietblade.study import translate
from quietblade.study.body import shell_spec
from quietblade.study.clock import Clock
from quietblade.study.examine import examine
from quietblade.study.preflight import Preflight, preflight
from quietblade.study.statics import Statics, solve_statics
from quietblade.typing import Progress, silent


def export_deck(case: Case, file: Path, progress: Progress = silent) -> Statics:
    """Write the blade with the loads of its equilibrium as a CalculiX or Abaqus input deck.

    Parameters
    ----------
    case : Case
    file : Path
        ``.inp`` file; replaced if it is there.
    progress : callable

    Returns
    -------
    Statics
        The equilibrium, whose displacements the other program should find again.

    Raises
    ------
    CaseError
        The case cannot be.
    QuietbladeError
        No equilibrium is found, or the model has no counterpart in the other program.
    """
    ngs.SetNumThreads(default_threads())
    clock = Clock(progress)
    blade = preflight(case).blade
    with clock.stage("mesh"):
        mesh = build_mesh(blade, translate.mesh_spec(case))
    with clock.stage("flow and structure") as report:
        statics = solve_statics(case, blade, mesh, report)
    with clock.stage("deck"), replacing(file) as temporary:
        title = case.title or "quietblade"
        write_deck(temporary, statics.structure, statics.state.structure, title=title)
    return statics


def export_step(case: Case, file: Path) -> None:
    """Write the undeformed blade and its film as solids of a STEP file, in millimetres.

    Raises
    ------
    CaseError
        The case cannot be.
    MeshError
        The solids cannot be made or written.
    """
    blade = preflight(case).blade
    with replacing(file) as temporary:
        write_step(blade, temporary)


def export_msh(case: AnyCase, file: Path) -> None:
    """Write the mesh of a case in gmsh's format, in metres.

    Raises
    ------
    CaseError
        The case cannot be.
    MeshError
        The mesh cannot be made or written.
    """
    known = examine(case)
    if isinstance(known, Preflight) and isinstance(case, Case):
        mesh = build_mesh(known.blade, translate.mesh_spec(case))
    else:
        assert isinstance(case, BodyCase)
        mesh = build_shell(shell_spec(case))
    with replacing(file) as temporary:
        write_msh(mesh, temporary)
