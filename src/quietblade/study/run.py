# SPDX-License-Identifier: LGPL-2.1-or-later
"""The whole study of a case: the only place that knows the order of the stages."""

import hashlib
from itertools import chain

import ngsolve as ngs

from quietblade import __version__
from quietblade.case import Case
from quietblade.case.presets import PRESETS, preset_text
from quietblade.errors import Notice
from quietblade.linalg import default_threads
from quietblade.mesh import Mesh, build_mesh
from quietblade.mesh.motion import MeshMotion, solve_mesh_motion
from quietblade.results import mode_records as records
from quietblade.results.files import ResultError
from quietblade.results.model import Result
from quietblade.results.store import RunFolder
from quietblade.study import losses, outcome, translate
from quietblade.study.campbell import solve_campbell
from quietblade.study.clock import Clock
from quietblade.study.fields import write_static_fields, write_vibration_fields
from quietblade.study.mode_tables import mode_tables
from quietblade.study.preflight import preflight
from quietblade.study.sound import Sound, solve_sound
from quietblade.study.statics import Statics, solve_statics
from quietblade.study.vibration import Vibration, frequencies, solve_vibration
from quietblade.study.viscous import singing
from quietblade.typing import Progress, silent


def run_key(case: Case) -> str:
    """Key of a result: the content of the case and the version of the code."""
    return hashlib.sha256(f"{case.content_key()} {__version__}".encode()).hexdigest()


def finished(case: Case, folder: RunFolder) -> Result | None:
    """Load the result of this very case, if the folder holds it whole."""
    try:
        result = folder.load()
    except ResultError:
        return None
    return result if result.run.content_key == run_key(case) else None


def run_case(case: Case, folder: RunFolder, progress: Progress = silent) -> Result:
    """Compute a case and write everything into its folder.

    Parameters
    ----------
    case : Case
    folder : RunFolder
        Made if need be; files of an earlier run are replaced.
    progress : callable

    Returns
    -------
    Result

    Raises
    ------
    CaseError
        The case cannot be.
    QuietbladeError
        A stage failed.
    """
    ngs.SetNumThreads(default_threads())
    clock = Clock(progress)
    facts = preflight(case)
    folder.root.mkdir(parents=True, exist_ok=True)
    with clock.stage("mesh"):
        mesh = build_mesh(facts.blade, translate.mesh_spec(case))
        _ = mesh.basis
    with clock.stage("flow and structure") as report:
        statics = solve_statics(case, facts.blade, mesh, report)
    motions = _motions(case, mesh, statics, clock)
    vibrations: dict[str, Vibration] = {}
    for name, motion in motions.items():
        with clock.stage(f"modes {name}") as report:
            vibrations[name] = solve_vibration(case, facts.blade, mesh, statics, motion, report)
    grid = frequencies(case, list(vibrations.values()))
    sounds: dict[str, Sound] = {}
    for name, vibration in vibrations.items():
        with clock.stage(f"sweep {name}") as report:
            sounds[name] = solve_sound(case, vibration, grid, report)
    with clock.stage("mode tables") as report:
        tables = mode_tables(case, mesh, vibrations, sounds, report)
    diagram = records.CampbellDiagram.none()
    diagram_notices: tuple[Notice, ...] = ()
    if case.campbell is not None:
        with clock.stage("Campbell diagram") as report:
            diagram, diagram_notices = solve_campbell(
                case, case.campbell, facts.blade, mesh, report
            )
    with clock.stage("files"):
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
            clock.seconds,
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


def _motions(
    case: Case, mesh: Mesh, statics: Statics, clock: Clock
) -> dict[str, MeshMotion | None]:
    """Mesh motion of each wanted configuration; none at rest."""
    motions: dict[str, MeshMotion | None] = {}
    for name in case.acoustics.configurations:
        if name == "C0":
            motions[name] = None
            continue
        with clock.stage("mesh motion"):
            displacement = statics.state.displacement
            motions[name] = solve_mesh_motion(mesh, displacement, case.acoustics.gap)
    return motions


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
