# SPDX-License-Identifier: LGPL-2.1-or-later
"""The whole study of a case: the only place that knows the order of the stages."""

import hashlib
from collections.abc import Callable
from functools import partial
from itertools import chain

import ngsolve as ngs

from quietblade import __version__
from quietblade.case import AnyCase, BodyCase, Case
from quietblade.errors import Notice
from quietblade.geometry import Blade
from quietblade.linalg import default_threads
from quietblade.mesh import Mesh, build_mesh
from quietblade.mesh.motion import MeshMotion, solve_mesh_motion
from quietblade.mesh.nodal import NodalBasis
from quietblade.propulsion.linear import newton_solver
from quietblade.propulsion.structure import Structure
from quietblade.results import mode_records as records
from quietblade.results.files import ResultError
from quietblade.results.lock import locked
from quietblade.results.model import Result
from quietblade.results.store import RunFolder
from quietblade.study import translate
from quietblade.study.blade_vibration import solve_vibration
from quietblade.study.body_preflight import body_preflight
from quietblade.study.body_run import run_body
from quietblade.study.campbell import solve_campbell
from quietblade.study.clock import Stages
from quietblade.study.fields import write_static_fields, write_vibration_fields
from quietblade.study.gather import gather
from quietblade.study.keeping import Makers, StageStore
from quietblade.study.log import logging_to
from quietblade.study.mode_tables import mode_tables
from quietblade.study.preflight import Preflight, preflight
from quietblade.study.sound import solve_sound
from quietblade.study.stages import code_version, origins
from quietblade.study.statics import Statics, build_structure, solve_statics
from quietblade.study.vibration import frequencies
from quietblade.typing import Progress, silent


def run_key(case: AnyCase, version: str = __version__) -> str:
    """Key of a result: the content of the case and the version of the code."""
    return hashlib.sha256(f"{case.content_key()} {version}".encode()).hexdigest()


def finished(case: AnyCase, folder: RunFolder) -> Result | None:
    """Load the result of this very case, if the folder holds it whole."""
    try:
        result = folder.load()
    except ResultError:
        return None
    return result if result.run.content_key == run_key(case) else None


def by_other_code(case: AnyCase, folder: RunFolder) -> bool:
    """Whether a stage that the folder keeps was computed by another source or other packages.

    The key of a result has the version of quietblade only; that of a stage has all of it.
    """
    store = StageStore(folder.stages)
    kept = (store.known(stage) for stage in origins(case))
    return any(known is not None and known.origin.code != code_version() for known in kept)


def run_case(
    case: AnyCase,
    folder: RunFolder,
    progress: Progress = silent,
    *,
    force: bool = False,
    keep: bool = True,
) -> Result:
    """Compute a case and write everything into its folder.

    Stages that an earlier run of the folder has finished, and on which nothing has changed since,
    are not computed again.

    Parameters
    ----------
    case : AnyCase
    folder : RunFolder
        Made if need be; files of an earlier run are replaced.
    progress : callable
    force : bool
        Compute all stages.
    keep : bool
        Keep what the stages make, and use what is kept.

    Returns
    -------
    Result

    Raises
    ------
    CaseError
        The case cannot be.
    ResultError
        Another run is at work in the folder.
    QuietbladeError
        A stage failed.
    """
    ngs.SetNumThreads(default_threads())
    compute = _planned(case)
    with locked(folder.root), logging_to(folder.log, progress) as report:
        folder.tidy()
        store = StageStore(folder.stages) if keep else None
        stages = Stages(report, origins(case), store, force=force)
        result = compute(folder, stages)
    return result


def _planned(case: AnyCase) -> Callable[[RunFolder, Stages], Result]:
    """Check a case, and say what is to be done of it."""
    if isinstance(case, BodyCase):
        return partial(run_body, case, body_preflight(case), run_key(case))
    assert isinstance(case, Case)
    return partial(_run, case, preflight(case))


def _run(case: Case, facts: Preflight, folder: RunFolder, stages: Stages) -> Result:
    """All stages, then everything that is made from what they found."""
    blade = facts.blade
    mesh = stages.make("mesh", lambda _: build_mesh(blade, translate.mesh_spec(case)))
    parts: Makers = {
        Mesh: lambda: mesh,
        ngs.Mesh: lambda: mesh.fem,
        NodalBasis: lambda: mesh.basis,
        Blade: lambda: blade,
        Structure: lambda: build_structure(case, blade, mesh, newton_solver()),
    }
    statics = stages.make(
        "flow and structure", lambda report: solve_statics(case, blade, mesh, report), parts
    )
    motions: dict[str, MeshMotion | None] = {
        name: _motion(case, mesh, statics, stages) if name == "C1" else None
        for name in case.acoustics.configurations
    }
    # the matrices of one configuration are not in memory while another's are factorised
    shelf = {
        name: stages.shelve(
            f"modes {name}", partial(solve_vibration, case, blade, mesh, statics, motion), parts
        )
        for name, motion in motions.items()
    }
    vibrations = {name: take() for name, take in shelf.items()}
    grid = frequencies(case, list(vibrations.values()))
    sounds = {
        name: stages.make(f"sweep {name}", partial(solve_sound, case, vibration, grid), parts)
        for name, vibration in vibrations.items()
    }
    tables = stages.make(
        "mode tables", lambda report: mode_tables(case, mesh, vibrations, sounds, report), parts
    )
    diagram = records.CampbellDiagram.none()
    diagram_notices: tuple[Notice, ...] = ()
    if case.campbell is not None:
        solve = partial(solve_campbell, case, case.campbell, blade, mesh)
        diagram, diagram_notices = stages.make("Campbell diagram", solve, parts)
    if account := stages.account():
        stages.tell(account)
    with stages.stage("files"):
        write_static_fields(mesh, statics, folder)
        for name, vibration in vibrations.items():
            write_vibration_fields(mesh, vibration, sounds[name], folder)
    result = gather(
        case,
        facts,
        mesh,
        statics,
        vibrations,
        sounds,
        tables,
        key=run_key(case),
        laps=stages.laps,
        moved=tuple(chain.from_iterable(m.notices for m in motions.values() if m is not None)),
        diagram=diagram,
        others=(*diagram_notices, *stages.notices),
    )
    folder.save(result)
    return result


def _motion(case: Case, mesh: Mesh, statics: Statics, stages: Stages) -> MeshMotion:
    displacement = statics.state.displacement
    return stages.make(
        "mesh motion", lambda _: solve_mesh_motion(mesh, displacement, case.acoustics.gap)
    )
