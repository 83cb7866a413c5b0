# SPDX-License-Identifier: LGPL-2.1-or-later
"""The way of flow and structure from rest to the whole dynamic pressure."""

from collections.abc import Sequence
from dataclasses import replace
from time import perf_counter

import numpy as np

from quietblade.errors import Notice
from quietblade.flow.inflow import BladeFlow
from quietblade.propulsion.coupling_newton import solve_by_corrections
from quietblade.propulsion.coupling_passes import solve_by_passes
from quietblade.propulsion.coupling_problem import (
    FAILURES,
    CoupledBlade,
    CouplingStep,
    Limits,
    Method,
    Point,
    Stage,
)
from quietblade.propulsion.newton import Tolerance
from quietblade.propulsion.structure import EquilibriumError
from quietblade.typing import Progress

# Least step of the dynamic pressure that the method "newton" tries.
_SMALLEST_STEP = 1 / 16

# Stops on the way only have to be good first guesses.
_WAYPOINT = 1e-3

# Of the structural solution under the rigid blade's load. The error is about the square of the
# last increment, and only curves are drawn of it.
_CHAINED = Tolerance(residual=1.0, increment=1e-3)


class Ramp:
    """Coupled solutions at increasing fractions of the dynamic pressure.

    Parameters
    ----------
    problem : CoupledBlade
    method : {"newton", "fixed-point", "aitken", "anderson"}
    limits : Limits
    progress : callable

    Attributes
    ----------
    history : list of CouplingStep
    notices : list of Notice
    chained_flow : BladeFlow or None
        The flow about the blade under the rigid blade's load.
    reached : float
        Fraction of the dynamic pressure of the last good state.
    converged : bool
        Whether the coupling converged at the whole pressure.
    reason : str
        Why it did not.
    """

    def __init__(
        self, problem: CoupledBlade, method: Method, limits: Limits, progress: Progress
    ) -> None:
        self.problem, self.method, self.limits, self.progress = problem, method, limits, progress
        self.history: list[CouplingStep] = []
        self.notices: list[Notice] = []
        self.chained_flow: BladeFlow | None = None
        self.reached, self.converged, self.reason = 0.0, False, ""
        self._unchained = ""
        self._good: Point | None = None
        self._start = problem.rest()

    @property
    def good(self) -> Point:
        """Last good state.

        Raises
        ------
        EquilibriumError
            There is none.
        """
        if self._good is None:
            raise EquilibriumError(
                f"flow and structure: no equilibrium at any fraction of the load ({self.reason}). "
                "Lower the speed, stiffen the blade, or refine the mesh.",
                self.problem.structure.rest(),
                0.0,
            )
        return self._good

    def chain(self, rigid: BladeFlow, *, start_there: bool) -> None:
        """Solve the structure under the rigid blade's load; the coupling may start there."""
        began = perf_counter()
        problem, rest = self.problem, self._start
        surface = problem.surface(rigid, rest.displacement)
        try:
            state = problem.structure.solve(
                problem.pressure(surface, 1.0),
                dead_load=problem.dead_load,
                tolerance=_CHAINED,
                progress=lambda stage, _, message: self.progress(stage, None, message),
            )
            point = Point(state, problem.structure.values(state), surface)
            self.chained_flow = problem.flow(point.displacement)
        except FAILURES as error:
            self._unchained = str(error)
            return
        if start_there:
            self._start = point
            tip = problem.tip(point.displacement)
            seconds = perf_counter() - began
            self.history.append(
                CouplingStep(1, np.inf, np.nan, tip, rigid.total.lift, state.newton, seconds)
            )

    def miss_chained(self) -> None:
        """Notice that there is no chained computation, if there is none."""
        if self.chained_flow is None:
            self.notices.append(
                Notice(
                    "flow and structure",
                    "there is no chained computation: the flow about the blade under the rigid "
                    "blade's load was not found "
                    f"({self._unchained or self.reason or 'the coupling ended with one pass'})",
                )
            )

    def climb(self, ramp: Sequence[float]) -> None:
        """Solve at one fraction after the other; "newton" goes between them where it fails."""
        targets = list(ramp)
        while targets:
            target = targets[0]
            stage = self._solve(target)
            number = len(self.history)
            self.history += [
                replace(step, iteration=number + k) for k, step in enumerate(stage.history, 1)
            ]
            self.reason = stage.reason
            if stage.point is not None:
                self._good, self._start, self.reached = stage.point, stage.point, targets.pop(0)
                if not stage.converged:
                    return
            elif self.method == "newton" and target - self.reached > _SMALLEST_STEP:
                self._start = self.problem.rest() if self._good is None else self._good
                targets.insert(0, 0.5 * (self.reached + target))
            else:
                return
        self.converged = True

    def _solve(self, target: float) -> Stage:
        limits = self.limits
        if target < 1.0:
            limits = replace(limits, tolerance=max(_WAYPOINT, limits.tolerance))
        if self.method == "newton":
            return solve_by_corrections(self.problem, self._start, target, limits, self.progress)
        try:
            stage = solve_by_passes(
                self.problem, self._start, target, self.method, limits, self.progress
            )
        except FAILURES as error:
            if self._good is None:
                raise
            return Stage(None, (), False, str(error))
        if self.chained_flow is None and len(self.history) == 0 and target == 1.0:
            self.chained_flow = stage.second
        return stage
