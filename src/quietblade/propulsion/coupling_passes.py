# SPDX-License-Identifier: LGPL-2.1-or-later
"""Partitioned coupling: the structure is solved anew for every load of the flow."""

from time import perf_counter

import numpy as np

from quietblade.flow.inflow import BladeFlow
from quietblade.propulsion.acceleration import Method, iterate, make_accelerator
from quietblade.propulsion.coupling_problem import (
    FAILURES,
    CoupledBlade,
    CouplingStep,
    Limits,
    Point,
    Stage,
)
from quietblade.typing import FloatArray, Progress


def solve_by_passes(
    problem: CoupledBlade,
    start: Point,
    fraction: float,
    method: Method,
    limits: Limits,
    progress: Progress,
) -> Stage:
    """Iterate ``u -> S(F(u))`` at a fraction of the dynamic pressure (theory: S1-30).

    Parameters
    ----------
    problem : CoupledBlade
    start : Point
        First displacement, and the structure's first guess.
    fraction : float
    method : {"fixed-point", "aitken", "anderson"}
    limits : Limits
    progress : callable

    Returns
    -------
    Stage
        Not converged if the passes are used up, or flow or structure have no solution at some
        shape on the way.

    Raises
    ------
    EquilibriumError, GeometryError, SolverError
        In the first pass.
    """
    history: list[CouplingStep] = []
    second: BladeFlow | None = None
    last, lift = start, 0.0

    def image(displacement: FloatArray) -> FloatArray:
        nonlocal last, lift, second
        flow = problem.flow(displacement)
        lift = flow.total.lift
        if len(history) == 1:
            second = flow
        surface = problem.surface(flow, displacement)
        state = problem.structure.solve(
            problem.pressure(surface, fraction),
            last.state,
            dead_load=problem.dead_load,
            tolerance=limits.newton_tolerance,
            progress=lambda stage, _, message: progress(stage, None, message),
        )
        last = Point(state, problem.structure.values(state), surface)
        return last.displacement

    best, least = start, np.inf
    rule = make_accelerator(method, limits.depth)
    passes = iterate(image, start.displacement, rule, depth=limits.depth)
    while True:
        began = perf_counter()
        try:
            line, _ = next(passes)
        except FAILURES as error:
            if not history:
                raise
            return Stage(best, tuple(history), False, str(error), second)
        history.append(
            CouplingStep(
                iteration=line.iteration,
                change=line.change,
                rate=line.ratio,
                tip=problem.tip(last.displacement),
                lift=lift,
                newton=last.state.newton,
                seconds=perf_counter() - began,
                fraction=fraction,
                error=line.error,
                eigenvalue=line.eigenvalue,
            )
        )
        progress("flow and structure", None, str(history[-1]))
        if limits.done(line.change, line.error):
            return Stage(last, tuple(history), True, "", second)
        if line.change < least or len(history) == 1:
            best, least = last, line.change
        if line.iteration == limits.max_iterations:
            return Stage(best, tuple(history), False, "the passes are used up", second)
