# SPDX-License-Identifier: LGPL-2.1-or-later
"""The steady problem of a case for other programs."""

from pathlib import Path

import ngsolve as ngs

from quietblade.case import Case
from quietblade.linalg import default_threads
from quietblade.mesh import build_mesh
from quietblade.propulsion.deck import write_deck
from quietblade.results.files import replacing
from quietblade.study import translate
from quietblade.study.clock import Clock
from quietblade.study.preflight import preflight
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
