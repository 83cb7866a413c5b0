# SPDX-License-Identifier: LGPL-2.1-or-later
"""A study step by step or at once, for notebooks: each step takes what it needs and returns it."""

from collections.abc import Sequence
from dataclasses import replace
from os import PathLike
from pathlib import Path

import ngsolve as ngs

from quietblade.case import AnyCase, BodyCase, Case, parse_case
from quietblade.case.presets import preset_text
from quietblade.errors import CaseError
from quietblade.geometry import Blade
from quietblade.linalg import default_threads
from quietblade.mesh import Mesh, build_mesh
from quietblade.mesh.motion import solve_mesh_motion
from quietblade.results.model import Result, StaticResult
from quietblade.results.store import RunFolder
from quietblade.study import outcome, translate, vibration
from quietblade.study.blade_vibration import solve_vibration
from quietblade.study.gather import gather
from quietblade.study.mode_tables import mode_tables
from quietblade.study.preflight import preflight
from quietblade.study.run import run_case, run_key
from quietblade.study.sound import Sound, solve_sound
from quietblade.study.statics import Statics, solve_statics
from quietblade.study.vibration import Vibration
from quietblade.typing import FloatArray, Progress, silent


def preset(name: str) -> Case | BodyCase:
    """Return a case to start from, by the names that ``quietblade new`` knows.

    All are of blades but ``sphere``, a `BodyCase` for `run`.

    Raises
    ------
    CaseError
        There is no preset of this name.
    """
    return parse_case(preset_text(name), f"{name}.toml")


def make_blade(case: AnyCase) -> Blade:
    """Return the undeformed blade, after everything that can be checked without a mesh.

    Raises
    ------
    CaseError
        The case cannot be, or is of another body.
    """
    if not isinstance(case, Case):
        raise CaseError("this case has no blade; `run` computes it at once")
    return preflight(case).blade


def make_mesh(case: Case, blade: Blade) -> Mesh:
    """Mesh blade, film and water.

    Raises
    ------
    MeshError
        The blade cannot be meshed with cells of this size.
    """
    return build_mesh(blade, translate.mesh_spec(case))


def solve_static(case: Case, blade: Blade, mesh: Mesh, progress: Progress = silent) -> Statics:
    """Find the equilibrium of blade and flow; its ``state`` is the `StaticState`.

    Raises
    ------
    QuietbladeError
        There is no equilibrium, or it is not found.
    """
    ngs.SetNumThreads(default_threads())
    return solve_statics(case, blade, mesh, progress)


def tabulate_static(case: Case, static: Statics) -> StaticResult:
    """Put the equilibrium in tables; their ``to_xarray()`` labels them."""
    return outcome.static_result(case, static)


def solve_modes(
    case: Case,
    blade: Blade,
    mesh: Mesh,
    static: Statics,
    configuration: str = "C1",
    progress: Progress = silent,
) -> Vibration:
    """Find the wet modes about the blade at rest, ``C0``, or under its load, ``C1``.

    Returns
    -------
    Vibration
        Its ``modes`` are the real wet modes, `WetModes`, and ``damped`` those of the band with
        loss and radiation.

    Raises
    ------
    CaseError
        There is no such configuration.
    """
    if configuration not in {"C0", "C1"}:
        raise CaseError(f'configuration "{configuration}"; there are "C0" (at rest) and "C1"')
    ngs.SetNumThreads(default_threads())
    motion = None
    if configuration == "C1":
        motion = solve_mesh_motion(mesh, static.state.displacement, case.acoustics.gap)
    found = solve_vibration(case, blade, mesh, static, motion, progress)
    moved = () if motion is None else motion.notices
    return replace(found, notices=(*moved, *found.notices))


def frequencies(case: Case, *modes: Vibration) -> FloatArray:
    """Return the frequencies of a sweep [Hz]: the case's steps, refined around these modes."""
    return vibration.frequencies(case, list(modes))


def solve_response(
    case: Case,
    modes: Vibration,
    frequency: FloatArray | None = None,
    progress: Progress = silent,
) -> Sound:
    """Find response, powers and sound over the band.

    Parameters
    ----------
    case : Case
    modes : Vibration
        From `solve_modes`.
    frequency : (f,) float array, optional
        [Hz]; by default `frequencies` of these modes. Configurations that are to be collected
        need the same ones.
    progress : callable
    """
    ngs.SetNumThreads(default_threads())
    return solve_sound(case, modes, frequencies(case, modes) if frequency is None else frequency,
                       progress)  # fmt: skip


def collect(
    case: Case,
    mesh: Mesh,
    static: Statics,
    modes: Sequence[Vibration],
    responses: Sequence[Sound],
    progress: Progress = silent,
) -> Result:
    """Collect what the steps have found into the result that a run of the case gives.

    Parameters
    ----------
    case, mesh, static
        As before.
    modes : sequence of Vibration
    responses : sequence of Sound
        Of the same configurations.
    progress : callable

    Raises
    ------
    CaseError
        The responses are not those of the modes.
    """
    vibrations = {m.name: m for m in modes}
    sounds = {r.name: r for r in responses}
    if set(vibrations) != set(sounds):
        raise CaseError(
            f"modes of {', '.join(vibrations)} with responses of {', '.join(sounds)}; give the "
            "response of each configuration"
        )
    tables = mode_tables(case, mesh, vibrations, sounds, progress)
    return gather(
        case, preflight(case), mesh, static, vibrations, sounds, tables, key=run_key(case)
    )


def run(case: AnyCase, folder: str | PathLike[str], progress: Progress = silent) -> Result:
    """Compute a case at once and keep everything in a folder, as ``quietblade run`` does.

    What an earlier run of the folder has computed, and nothing has changed, is used again.

    Raises
    ------
    QuietbladeError
        The case cannot be, or a stage failed.
    """
    return run_case(case, RunFolder(Path(folder)), progress)
