# SPDX-License-Identifier: LGPL-2.1-or-later
"""The way to a load in steps of automatic size, and what happens on it."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from quietblade.propulsion.newton import (
    Measured,
    NewtonStep,
    Outcome,
    Problem,
    Solve,
    Tolerance,
    solve_newton,
)
from quietblade.typing import FloatArray, Progress

SMALLEST_LOAD_STEP = 1 / 256
"""Part of the way below which a step is not tried."""

# Ends of intermediate load steps only have to be good first guesses.  A small increment alone does
# not make one: a thin structure may be stretched by it, with forces far from balance.
_WAYPOINT = Tolerance(1e-2, 1e-2)

_STAGE = "structure"


class Equations(Problem, Measured, Protocol):
    """Equilibrium equations that can be taken along a path of loads."""

    negative_pivots: int | None

    def forget(self) -> None:
        """Forget the last correction."""


@dataclass(frozen=True)
class LoadStep:
    """One attempt on the way to the load.

    Attributes
    ----------
    fraction : float
        Fraction of the way from the start's load to the wanted one.
    converged : bool
        Whether an equilibrium was found there.
    iterations, tangents : int
        Newton iterations, and how many of them factorised a new tangent.
    negative_pivots : int or None
        Negative eigenvalues of the last tangent of the attempt beyond those of the film pressure;
        above zero it is past a limit or bifurcation point.  None if not known.
    reason : str
        Why it failed, if it did.
    """

    fraction: float
    converged: bool
    iterations: int
    tangents: int
    negative_pivots: int | None
    reason: str = ""


@dataclass(frozen=True, eq=False)
class Path:
    """Where the steps led.

    Attributes
    ----------
    x : (ndof,) float array
        Last equilibrium.
    fraction : float
        Its fraction of the way; 1 if the wanted load was reached.
    table : tuple of NewtonStep
        Convergence table of all attempts.
    steps : tuple of LoadStep
        The attempts.
    solve : callable or None
        Solver of the last tangent.
    rounding : float or None
        Where the end is not to the tolerance because of rounding: `Outcome.rounding`.
    """

    x: FloatArray
    fraction: float
    table: tuple[NewtonStep, ...]
    steps: tuple[LoadStep, ...]
    solve: Solve | None
    rounding: float | None = None

    @property
    def converged(self) -> bool:
        """Whether the wanted load was reached."""
        return self.fraction == 1.0


def follow(
    equations: Equations,
    x: FloatArray,
    load: Callable[[float], None],
    tolerance: Tolerance,
    *,
    solve: Solve | None,
    progress: Progress,
) -> Path:
    """Go to the full load: at once if Newton's method converges, else in smaller steps.

    A step that fails is halved, and one that succeeds lets the next be twice as long.  Equilibria
    on the way are found to a looser tolerance.  After a failure the last one is brought to the
    wanted tolerance; if that fails too, the path goes back to the last one that has it, and is
    exact from there on.

    Parameters
    ----------
    equations : Equations
        The equilibrium, at the load that `load` sets.
    x : (ndof,) float array
        Equilibrium at the start.
    load : callable
        Sets the loads at a fraction of the way.
    tolerance : Tolerance
        At the end, and of the state that is returned.
    solve : callable or None
        Solver of a tangent near the start.
    progress : callable
        Called with the stage, the fraction and the last line of the table.
    """
    walk = _Walk(equations, load, tolerance, progress)
    sure, exact = (x, 0.0), False
    done, width = 0.0, 1.0
    rounding = None
    while done < 1.0 and width >= SMALLEST_LOAD_STEP:
        fraction = min(1.0, done + width)
        outcome = walk.attempt(x, fraction, solve, exact=exact or fraction == 1.0)
        solve = outcome.solve if fraction == 1.0 else None
        if outcome.converged:
            x, done, width, rounding = outcome.x, fraction, 2 * width, outcome.rounding
            if exact:
                sure = (x, done)
            continue
        width /= 2
        if done == sure[1]:
            continue
        outcome = walk.attempt(x, done, None, exact=True)
        if outcome.converged:
            sure = (outcome.x, done)
        else:
            exact, width = True, max(width, 0.5 * (done - sure[1]))
        x, done = sure
    return Path(x, done, tuple(walk.table), tuple(walk.steps), solve, rounding)


class _Walk:
    """Attempts at single loads, and their record."""

    def __init__(
        self,
        equations: Equations,
        load: Callable[[float], None],
        tolerance: Tolerance,
        progress: Progress,
    ) -> None:
        self._equations, self._load = equations, load
        self._tolerance, self._progress = tolerance, progress
        self.table: list[NewtonStep] = []
        self.steps: list[LoadStep] = []

    def attempt(
        self, x: FloatArray, fraction: float, solve: Solve | None, *, exact: bool
    ) -> Outcome:
        """Find the equilibrium at a fraction of the way, from x."""
        equations = self._equations
        wanted = self._tolerance if exact else _WAYPOINT
        self._load(fraction)
        outcome = solve_newton(
            equations, x, fraction,
            residual_tolerance=wanted.residual, increment_tolerance=wanted.increment,
            force_tolerance=wanted.force, motion_tolerance=wanted.motion, solve=solve,
        )  # fmt: skip
        if not outcome.converged:
            equations.forget()
        self.table += outcome.steps
        self.steps.append(_record(outcome, fraction, equations.negative_pivots))
        self._progress(_STAGE, fraction, str(self.table[-1]))
        return outcome


def _record(outcome: Outcome, fraction: float, negative_pivots: int | None) -> LoadStep:
    return LoadStep(
        fraction,
        outcome.converged,
        sum(step.increment >= 0.0 for step in outcome.steps),
        sum(step.new_tangent for step in outcome.steps),
        negative_pivots,
        outcome.reason,
    )
