# SPDX-License-Identifier: LGPL-2.1-or-later
"""Alternative linear problems about one blade, mode by mode: what each part of a model does."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from quietblade.case import Case
from quietblade.geometry import Blade
from quietblade.mesh import Mesh, build_mesh
from quietblade.mesh.motion import MeshMotion, solve_mesh_motion
from quietblade.results.alternatives import AlternativeTable
from quietblade.results.peaks import assign_peaks
from quietblade.study import translate
from quietblade.study.blade_vibration import solve_vibration
from quietblade.study.mode_tables import carried
from quietblade.study.outcome import peak_table
from quietblade.study.preflight import preflight
from quietblade.study.run import run_key
from quietblade.study.sound import Sound, solve_sound
from quietblade.study.statics import Statics, solve_statics
from quietblade.study.vibration import Share, Vibration, frequencies, symmetric_solver
from quietblade.typing import FloatArray, Progress, silent
from quietblade.vibroacoustics.bands import band_mean
from quietblade.vibroacoustics.matching import Match, Product, match, wet_mass
from quietblade.vibroacoustics.power import level

NAN = float("nan")


@dataclass(frozen=True, eq=False)
class LoadedBlade:
    """A blade in equilibrium with the flow, and the water mesh around it.

    Attributes
    ----------
    case : Case
    blade : Blade
    mesh : Mesh
    statics : Statics
    motion : MeshMotion
        From C0 to C1.
    """

    case: Case
    blade: Blade
    mesh: Mesh
    statics: Statics
    motion: MeshMotion


@dataclass(frozen=True, eq=False)
class Alternative:
    """One of several linear problems that are compared.

    Attributes
    ----------
    name, description : str
    vibration : Vibration
    """

    name: str
    description: str
    vibration: Vibration


def load_blade(case: Case, progress: Progress = silent) -> LoadedBlade:
    """Mesh the blade of a case and find its equilibrium.

    Raises
    ------
    CaseError
        The case cannot be.
    QuietbladeError
        A stage failed.
    """
    blade = preflight(case).blade
    mesh = build_mesh(blade, translate.mesh_spec(case))
    statics = solve_statics(case, blade, mesh, progress)
    motion = solve_mesh_motion(mesh, statics.state.displacement, case.acoustics.gap)
    return LoadedBlade(case, blade, mesh, statics, motion)


def vibrate(
    loaded: LoadedBlade, share: Share | None = None, *, at_rest: bool = False, progress: Progress
) -> Vibration:
    """Linear problem about C1, or a share of it, or about C0."""
    motion = None if at_rest else loaded.motion
    return solve_vibration(
        loaded.case, loaded.blade, loaded.mesh, loaded.statics, motion, progress, share
    )


def tabulate(
    title: str,
    loaded: LoadedBlade,
    alternatives: Iterable[Alternative],
    progress: Progress = silent,
) -> AlternativeTable:
    """Modes and peaks of alternatives on the nodes of one solid mesh; the first is the reference.

    Modes are matched by the modal assurance criterion as in a run, in the mass of the reference
    with the water's, each in the axes of its own sections (theory: S2-15).

    Parameters
    ----------
    title : str
        What is compared.
    loaded : LoadedBlade
        Band and sweep of its case count, and the mesh, which is that of the reference.
    alternatives : iterable of Alternative
        Taken one after the other, so that a generator needs the memory of two only.
    progress : callable
    """
    case = loaded.case
    first: Vibration | None = None
    product: Product | None = None
    names, descriptions, rows = [], [], []
    for alternative in alternatives:
        vibration = alternative.vibration
        grid = frequencies(case, [vibration])
        sound = solve_sound(case, vibration, grid, progress)
        if first is None or product is None:
            first = vibration
            product = wet_mass(first.operators, solver=symmetric_solver(case))
        shapes = carried(loaded.mesh, vibration, first)
        names.append(alternative.name)
        descriptions.append(alternative.description)
        found = match(shapes, first.modes.vectors, product)
        rows.append(
            (_columns(vibration, sound, found, len(first.modes.vectors)), _mean_level(sound))
        )
    if first is None:
        raise ValueError("there is no alternative to tabulate")
    columns = np.array([row for row, _ in rows])
    return AlternativeTable(
        title=title,
        name=tuple(names),
        description=tuple(descriptions),
        mode=first.naming.name,
        frequency=columns[:, 0],
        loss_factor=columns[:, 1],
        assurance=columns[:, 2],
        peak_frequency=columns[:, 3],
        peak_level=columns[:, 4],
        mean_level=np.array([level for _, level in rows]),
        element_size=case.mesh.size,
        content_key=run_key(case),
    )


def _columns(vibration: Vibration, sound: Sound, found: Match, count: int) -> FloatArray:
    """Frequency, loss, similarity, peak and its level of each mode of the reference, (5, m)."""
    modes, damped = vibration.modes, vibration.damped
    loss = modes.loss_factor.copy()
    loss[damped.start[damped.converged]] = damped.loss_factor[damped.converged]
    names = vibration.naming.name
    peaks = assign_peaks(names, modes.frequency, peak_table(sound))
    columns = np.full((5, count), NAN)
    for k in np.flatnonzero(found.partner >= 0):
        peak = peaks.get(names[k])
        columns[:, found.partner[k]] = (
            modes.frequency[k],
            loss[k],
            found.assurance[k],
            peak.frequency if peak else NAN,
            peak.level if peak else NAN,
        )
    return columns


def _mean_level(sound: Sound) -> float:
    """Level of the mean power over the band [dB re 1 pW]."""
    solved = np.isfinite(sound.budget.radiated)
    frequency, power = sound.frequency[solved], sound.budget.radiated[solved]
    return float(level(np.array(band_mean(frequency, power, (frequency[0], frequency[-1])))))
