# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether the moved water mesh of C1 gives what a mesh made for C1 gives."""

from collections.abc import Iterator
from dataclasses import replace

from quietblade.case import Case
from quietblade.mesh.remesh import remesh_water
from quietblade.results.alternatives import AlternativeTable
from quietblade.study import translate
from quietblade.study.alternatives import Alternative, LoadedBlade, load_blade, tabulate, vibrate
from quietblade.study.statics import solve_statics
from quietblade.typing import Progress, silent

MOVED, ANEW = "moved", "re-meshed"
"""Names of the alternatives."""


def compare_water(
    case: Case, progress: Progress = silent, loaded: LoadedBlade | None = None
) -> AlternativeTable:
    """Modes and peaks of C1 with the moved water mesh, and with one that is made around it.

    The solid and its surface are the same, the cells of the water have nothing in common.

    Parameters
    ----------
    case : Case
    progress : callable
    loaded : LoadedBlade, optional
        Its equilibrium, if it is known.

    Returns
    -------
    AlternativeTable
        Rows `MOVED` and `ANEW`.

    Raises
    ------
    CaseError
        The case cannot be.
    MeshError
        The water cannot be meshed around the deformed blade.
    """
    known = load_blade(case, progress) if loaded is None else loaded
    return tabulate("Water mesh of C1", known, _alternatives(known, progress), progress)


def remeshed(loaded: LoadedBlade, progress: Progress = silent) -> LoadedBlade:
    """Return the same equilibrium with the water meshed anew on C1."""
    case = loaded.case
    mesh, motion = remesh_water(
        loaded.mesh,
        loaded.statics.state.displacement,
        size=case.mesh.size,
        water_size=translate.water_size(case),
    )
    # the unknowns have other numbers on the new mesh: found anew, which costs less than the rest
    statics = solve_statics(case, loaded.blade, mesh, progress)
    return replace(loaded, mesh=mesh, statics=statics, motion=motion)


def _alternatives(loaded: LoadedBlade, progress: Progress) -> Iterator[Alternative]:
    yield Alternative(MOVED, "water mesh of C0, moved", vibrate(loaded, progress=progress))
    anew = remeshed(loaded, progress)
    yield Alternative(ANEW, "water meshed on C1", vibrate(anew, progress=progress))
