# SPDX-License-Identifier: LGPL-2.1-or-later
"""The whole study of a case: the only place that knows the order of the stages."""

import hashlib
from functools import partial
from itertools import chain

import ngsolve as ngs

from quietblade import __version__
from quietblade.case import Case
from quietblade.case.presets import PRESETS, preset_text
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
from quietblade.study import losses, outcome, translate
from quietblade.study.campbell import solve_campbell
from quietblade.study.clock import Stages
from quietblade.study.fields import write_static_fields, write_vibration_fields
from quietblade.study.keeping import Makers, StageStore
from quietblade.study.log import logging_to
from quietblade.study.mode_tables import mode_tables
from quietblade.study.preflight import Preflight, preflight
from quietblade.study.sound import Sound, solve_sound
from quietblade.study.stages import origins
from quietblade.study.statics import Statics, build_structure, solve_statics
from quietblade.study.vibration import Vibration, frequencies, solve_vibration
from quietblade.study.viscous import singing
from quietblade.typing import Progress, silent


def run_key(case: Case, version: str = __version__) -> str:
    """Key of a result: the content of the case and the version of the code."""
    return hashlib.sha256(f"{case.content_key()} {version}".encode()).hexdigest()


def finished(case: Case, folder: RunFolder) -> Result | None:
    """Load the result of this very case, if the folder holds it whole."""
    try:
        result = folder.load()
    except ResultError:
        return None
    return result if result.run.content_key == run_key(case) else None


def run_case(
    case: Case,
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
    case : Case
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
    facts = preflight(case)
    with locked(folder.root), logging_to(folder.log, progress) as report:
        store = StageStore(folder.stages) if keep else None
        stages = Stages(report, origins(case), store, force=force)
        result = _run(case, facts, folder, stages)
    return result


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
    with stages.stage("files"):
        write_static_fields(mesh, statics, folder)
        for name, vibration in vibrations.items():
            write_vibration_fields(mesh, vibration, sounds[name], folder)
    notices = (
        *facts.notices,
        *mesh.notices,
        *statics.notices(case),
        *_singing(statics, vibrations),
        *chain.from_iterable(_step2_notices(motions[n], vibrations[n], sounds[n]) for n in motions),
        *diagram_notices,
        *stages.notices,
    )
    reports = {
        "flow and structure": statics.solver,
        **{f"modes {name}": vibration.solver for name, vibration in vibrations.items()},
        **{f"sweep {name}": sound.report for name, sound in sounds.items()},
    }
    result = Result(
        title=case.title,
        blade=paper_blade(case),
        static=outcome.static_result(case, statics),
        configurations={
            name: outcome.configuration_result(case, vibration, sounds[name], tables[name])
            for name, vibration in vibrations.items()
        },
        moduli=losses.modulus_table(facts.moduli, case.acoustics.band),
        mesh=outcome.mesh_result(mesh, next(iter(vibrations.values()))),
        run=outcome.run_record(
            case.text,
            run_key(case),
            stages.laps,
            [sound.report for sound in sounds.values()],
            reports,
            notices,
        ),
        campbell=diagram,
    )
    folder.save(result)
    return result


def paper_blade(case: Case) -> str:
    """Which of the paper's blades a case stands for: shape, material and flow are those.

    What the paper leaves open (film, excitation, mesh, sphere) may be anything.
    """
    for name in PRESETS:
        family, _, blade = name.partition("-")
        if family == "paper" and _stated(case) == _stated(Case.parse(preset_text(name))):
            return blade
    return ""


def _stated(case: Case) -> tuple[object, ...]:
    """Tell apart what the paper says of its blades."""
    plain = case.plain()
    shape = {k: plain["blade"][k] for k in ("hub_radius", "span", "chord", "thickness", "camber")}
    flow = plain["flow"]["speed"], plain["flow"]["rotation"]
    return shape, flow, case.material("blade")


def _motion(case: Case, mesh: Mesh, statics: Statics, stages: Stages) -> MeshMotion:
    displacement = statics.state.displacement
    return stages.make(
        "mesh motion", lambda _: solve_mesh_motion(mesh, displacement, case.acoustics.gap)
    )


def _singing(statics: Statics, vibrations: dict[str, Vibration]) -> tuple[Notice, ...]:
    """Shedding of the trailing edge against the wet modes under load, or at rest without them."""
    if not vibrations:
        return ()
    vibration = vibrations.get("C1", next(iter(vibrations.values())))
    names = vibration.naming.name
    return tuple(singing(statics.viscous[-1], vibration.modes.frequency, names))


def _step2_notices(
    motion: MeshMotion | None, vibration: Vibration, sound: Sound
) -> tuple[Notice, ...]:
    moved = motion.notices if motion is not None else ()
    return (*moved, *vibration.notices, *sound.notices)
