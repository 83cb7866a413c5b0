# SPDX-License-Identifier: LGPL-2.1-or-later
r"""Monolithic coupling: every correction of Newton's method has the flow of the present shape.

The tangent is the structure's, with the pressure that follows the surface; what it lacks is the
derivative of the flow. Where that is small, as in the paper's blades, the corrections of the
bending, which are needed anyway, converge the coupling at the same time. Where it is not, the
steps so far supply it as a matrix of low rank (theory: S1-96): with the differences of
displacement and pressure of the last corrections, the response of the structure to these
pressures costs a forward and a back substitution each, and no factorisation.
"""

from dataclasses import dataclass
from time import perf_counter

import numpy as np

from quietblade.flow.inflow import BladeFlow
from quietblade.propulsion.acceleration import SecantModel, relative
from quietblade.propulsion.coupling_problem import (
    FAILURES,
    CoupledBlade,
    CouplingStep,
    Limits,
    Point,
    Stage,
)
from quietblade.propulsion.loading import Loading
from quietblade.propulsion.newton import NewtonStep, Solve
from quietblade.typing import FloatArray, Progress

# The tangent is kept where corrections are this small, unless they shrink worse than the ratio.
_KEEP_BELOW = 3e-4
_KEPT_RATIO = 0.5

# Corrections that shrink worse than this need the derivative of the flow, unless its eigenvalues
# turn out to be as small as that.
_SLOW = 0.5
_WEAK = 0.3

# Corrections from farther away than this share of the displacement also mend the bending: they are
# no passes of flow and structure.
_NEAR = 0.05

# Differences below this many tolerances of the structure are noise.
_NOISE = 100.0

# After larger corrections the sections are too distorted to deserve every one of their flows: every
# fourth is solved.
_TRANSIENT = 0.05
_COARSE = 4

# So many corrections in a row may grow.
_GROWING = 3


def solve_by_corrections(
    problem: CoupledBlade,
    start: Point,
    fraction: float,
    limits: Limits,
    progress: Progress,
) -> Stage:
    """Find flow and structure together at a fraction of the dynamic pressure.

    The last pass brings the structure to its own tolerance under the load of the last shape, and
    so checks the estimated error.

    Parameters
    ----------
    problem : CoupledBlade
    start : Point
        First guess.
    fraction : float
    limits : Limits
    progress : callable

    Returns
    -------
    Stage
        Not converged if corrections grow or are used up, or flow or structure fail on the way.
    """
    run = _Corrections(problem, start, fraction, limits)
    history: list[CouplingStep] = []
    while True:
        try:
            history.append(run.correct(history))
            progress("flow and structure", None, str(history[-1]))
            last = len(history) >= limits.max_iterations
            small = limits.done(history[-1].change, history[-1].error)
            if not last and not small:
                if run.grows(history):
                    return Stage(None, tuple(history), False, "the corrections grow")
                continue
            point, step = run.close(history)
            history.append(step)
            progress("flow and structure", None, str(step))
            done = limits.done(step.change, step.error)
            if done or last:
                reason = "" if done else "the corrections are used up"
                return Stage(point, tuple(history), done, reason)
        except FAILURES as error:  # flow or structure at a shape that is not a blade's
            return Stage(None, tuple(history), False, str(error))


@dataclass(frozen=True, eq=False)
class _Seen:
    """Displacement and pressure before a correction, and the correction that they ask for."""

    displacement: FloatArray
    pressure: FloatArray
    change: FloatArray


class _Corrections:
    """State of the iteration."""

    def __init__(
        self,
        problem: CoupledBlade,
        start: Point,
        fraction: float,
        limits: Limits,
    ) -> None:
        self.problem, self.fraction, self.limits = problem, fraction, limits
        self.structure, self.equations = problem.structure, problem.structure.equations
        self.x, self.displacement = start.state.unknowns, start.displacement
        self.solve: Solve | None = self.structure.kept(start.state)
        self.size = np.nan
        self.strong = False
        self.model = self.latest = SecantModel([], [])
        self.equations.begin(self.x)
        self.seen: list[_Seen] = []

    def correct(self, history: list[CouplingStep]) -> CouplingStep:
        began = perf_counter()
        problem, equations = self.problem, self.equations
        coarse = (
            len(history) > 1 and history[-1].change > _TRANSIENT and not self._needs_flow(history)
        )
        flow = problem.flow(self.displacement, every=_COARSE if coarse else 1)
        surface = problem.surface(flow, self.displacement)
        equations.set_loading(problem.loading(surface, self.fraction))
        force, residual = equations.residual(self.x)
        solve, fresh = self.solve, False
        if solve is None or not self._kept(history):
            solve, fresh = equations.tangent(self.x), True
            self.solve = solve
        step = np.asarray(solve(force))
        change = self._nodal(-step)
        seen = _Seen(self.displacement.ravel(), surface.values, change)
        self.seen = [*self.seen[-self.limits.depth :], seen]
        model, strong = self._observed(), False
        if self._needs_flow(history):
            model, responses = self._derived(solve)
            strong = abs(model.dominant) > _WEAK
        self.strong, self.latest = strong, model
        if strong:
            step = step - model.completion(change, responses)
            change = self._nodal(-step)
        self.x, increment = equations.correct(self.x, step)
        self.displacement = problem.values(self.x)
        line = NewtonStep(
            self.fraction,
            len(history),
            residual,
            increment,
            fresh,
            equations.force_size(force),
            equations.motion_size(step),
            float(abs(force @ step)),
        )
        return self._step(history, change, flow, model, (line,), began, strong=strong)

    def close(self, history: list[CouplingStep]) -> tuple[Point, CouplingStep]:
        """Bring the structure to its tolerance under the load of the present shape."""
        began = perf_counter()
        problem, structure = self.problem, self.structure
        flow = problem.flow(self.displacement)
        surface = problem.surface(flow, self.displacement)
        loading = problem.loading(surface, self.fraction)
        near = problem.state(self.x, loading)
        # `Structure.solve` starts with the tangent of its last result
        structure.keep(near, self.solve)
        state = structure.solve(
            loading.pressure,
            near,
            dead_load=loading.dead_load,
            tolerance=self.limits.newton_tolerance,
        )
        self.x, before = state.unknowns, self.displacement
        self.displacement = problem.values(self.x)
        change = (self.displacement - before).ravel()
        self.seen = [
            *self.seen[-self.limits.depth :],
            _Seen(before.ravel(), surface.values, change),
        ]
        model = self.latest if self.strong else self._observed()
        step = self._step(history, change, flow, model, state.newton, began)
        return Point(state, self.displacement, surface), step

    def _step(
        self,
        history: list[CouplingStep],
        change: FloatArray,
        flow: BladeFlow,
        model: SecantModel,
        table: tuple[NewtonStep, ...],
        began: float,
        *,
        strong: bool = False,
    ) -> CouplingStep:
        size = float(np.linalg.norm(change))
        ratio = size / self.size if history and self.size > 0.0 else np.nan
        self.size = size
        # by the observed ratio while there is no model of two directions, and where the model is
        # part of the step, so that what it knows is no error any more
        error = ratio / (1.0 - ratio) * size if ratio < 1.0 else np.inf
        if not strong:
            known = model.beyond(change, ratio)
            error = known if len(model.kept) > 1 else max(known, error)
        return CouplingStep(
            iteration=len(history) + 1,
            change=relative(size, self.displacement) if history else np.inf,
            rate=ratio,
            tip=self.problem.tip(self.displacement),
            lift=flow.total.lift,
            newton=table,
            seconds=perf_counter() - began,
            fraction=self.fraction,
            error=relative(error, self.displacement),
            eigenvalue=model.dominant,
        )

    def grows(self, history: list[CouplingStep]) -> bool:
        """Whether the last corrections only grew, or the last one is not finite."""
        rates = [step.rate for step in history[-_GROWING:]]
        return not np.isfinite(self.displacement).all() or (
            len(rates) == _GROWING and all(rate > 1.0 for rate in rates)
        )

    def _needs_flow(self, history: list[CouplingStep]) -> bool:
        """Whether a correction needs the derivative of the flow, and has a difference for it."""
        if not history or len(self.seen) == 0:
            return False
        return self.strong or not history[-1].rate <= _SLOW

    def _kept(self, history: list[CouplingStep]) -> bool:
        if not history:
            return True
        last = history[-1]
        if last.change >= _KEEP_BELOW:
            return False
        return last.factorizations > 0 or last.rate < _KEPT_RATIO

    def _observed(self) -> SecantModel:
        """Model of a pass of flow and structure from small corrections, which are such passes."""
        newest = self.seen[-1]
        size = float(np.linalg.norm(newest.displacement))
        steps, images = [], []
        for older in self.seen[-2::-1]:
            step = newest.displacement - older.displacement
            if float(np.linalg.norm(step)) > _NEAR * size:
                break
            steps.append(step)
            images.append(step + newest.change - older.change)
        # the longest first: the last steps are little more than the structure's tolerance
        noise = _NOISE * self.limits.newton_tolerance * size
        found = SecantModel(steps[::-1], images[::-1], noise)
        self.model = found if found.kept or not steps else self.model
        return self.model

    def _derived(self, solve: Solve) -> tuple[SecantModel, list[FloatArray]]:
        """Model from the flow's differences alone, and the free unknowns that answer them."""
        *older, newest = self.seen
        steps = [newest.displacement - s.displacement for s in older[::-1]]
        responses = [self._respond(solve, newest.pressure - s.pressure) for s in older[::-1]]
        return SecantModel(steps, [self._nodal(r) for r in responses]), responses

    def _respond(self, solve: Solve, pressure: FloatArray) -> FloatArray:
        """Free unknowns that answer a small change of the flow's pressure, by the tangent."""
        n = self.structure.forms.n_displacement
        self.equations.set_loading(Loading(self.fraction * pressure, np.zeros(n), 0.0))
        force = self.equations.external(self.x)[self.structure.forms.free]
        return np.asarray(solve(force))

    def _nodal(self, step: FloatArray) -> FloatArray:
        full = np.zeros(self.structure.forms.ndof)
        full[self.structure.forms.free] = step
        return self.problem.values(full).ravel()
