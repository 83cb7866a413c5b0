# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a run would be like: its size and cost, and whether the method's assumptions hold."""

from collections.abc import Iterator
from dataclasses import dataclass

from quietblade.case import AnyCase, BodyCase, Case
from quietblade.errors import GeometryError, Notice
from quietblade.linalg.memory import available_memory
from quietblade.linalg.trial import trial_seconds
from quietblade.study import translate
from quietblade.study.assumptions import (
    Assumption,
    assumptions,
    body_assumptions,
    undeformed_flow,
)
from quietblade.study.costs import Cost, estimate
from quietblade.study.forecast import Size, forecast, forecast_shell
from quietblade.study.preflight import Preflight, Surroundings


@dataclass(frozen=True)
class Outlook:
    """A run that has not begun.

    Attributes
    ----------
    size : Size
        Nodes and unknowns.
    cost : Cost
        Memory, and time by stage on this machine.
    memory_free : int or None
        Memory of this machine that is free [B]; None where the system does not tell.
    assumptions : tuple of Assumption
        With what each comes to.
    notices : tuple of Notice
        Of this outlook, beside those of the case.
    """

    size: Size
    cost: Cost
    memory_free: int | None
    assumptions: tuple[Assumption, ...]
    notices: tuple[Notice, ...]


def look_ahead(case: AnyCase, known: Surroundings, trial: float | None = None) -> Outlook:
    """Say what a run will be like; a second of work.

    Parameters
    ----------
    case : AnyCase
    known : Surroundings
        Of the case.
    trial : float, optional
        Speed of the machine, see `quietblade.linalg.trial.trial_seconds`; measured if left out.
    """
    size = _size(case, known)
    blade = known.blade if isinstance(known, Preflight) else None
    cost = estimate(case, blade, size, trial_seconds() if trial is None else trial)
    free = available_memory()
    judged: tuple[Assumption, ...] = ()
    faults: list[Notice] = []
    if blade is None or not isinstance(case, Case):
        judged = body_assumptions(case, known.clearance)
    else:
        try:
            flow = undeformed_flow(case, blade)
        except GeometryError as error:
            faults.append(Notice("flow", f"the sections cannot be solved: {error}"))
        else:
            judged = assumptions(case, flow, known.clearance)
    doubts = [notice for a in judged if (notice := a.notice()) is not None]
    return Outlook(
        size=size,
        cost=cost,
        memory_free=free,
        assumptions=judged,
        notices=(*faults, *doubts, *_memory_notices(cost, free)),
    )


def _size(case: AnyCase, known: Surroundings) -> Size:
    around = case.mesh.size, known.centre, known.radius, translate.water_size(case)
    if isinstance(known, Preflight):
        return forecast(known.blade, *around)
    assert isinstance(case, BodyCase)
    return forecast_shell(case.body.radius, case.body.thickness, *around)


def _memory_notices(cost: Cost, free: int | None) -> Iterator[Notice]:
    if free is not None and cost.memory > free:
        yield Notice(
            "memory",
            "a run may need more memory [B] than is free",
            cost.memory,
            float(free),
            "Use larger cells (mesh.size, mesh.water_size) or a smaller acoustics.sphere_radius",
        )
