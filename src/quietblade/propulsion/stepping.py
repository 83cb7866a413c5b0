# SPDX-License-Identifier: LGPL-2.1-or-later
"""The way to a load in steps of automatic size, and what happens on it."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

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

# Ends of intermediate load steps only have to be good first guesses.
_WAYPOINT = 1e-2

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
    """

    x: FloatArray
    fraction: float
    table: tuple[NewtonStep, ...]
    steps: tuple[LoadStep, ...]
    solve: Solve | None

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

    A step that fails is halved, and one that succeeds lets the next be twice as long.

    Parameters
    ----------
    equations : Equations
        The equilibrium, at the load that `load` sets.
    x : (ndof,) float array
        Equilibrium at the start.
    load : callable
        Sets the loads at a fraction of the way.
    tolerance : Tolerance
        At the end; equilibria on the way are found to a looser one.
    solve : callable or None
        Solver of a tangent near the start.
    progress : callable
        Called with the stage, the fraction and the last line of the table.
    """
    done, width = 0.0, 1.0
    table: list[NewtonStep] = []
    steps: list[LoadStep] = []
    while done < 1.0 and width >= SMALLEST_LOAD_STEP:
        fraction = min(1.0, done + width)
        load(fraction)
        outcome = _attempt(equations, x, fraction, tolerance, solve)
        table += outcome.steps
        steps.append(_record(outcome, fraction, equations.negative_pivots))
        progress(_STAGE, fraction if outcome.converged else done, str(table[-1]))
        solve = outcome.solve if fraction == 1.0 else None
        if outcome.converged:
            x, done, width = outcome.x, fraction, 2 * width
        else:
            width /= 2
            equations.forget()
    return Path(x, done, tuple(table), tuple(steps), solve)


def _attempt(
    equations: Equations,
    x: FloatArray,
    fraction: float,
    tolerance: Tolerance,
    solve: Solve | None,
) -> Outcome:
    if fraction == 1.0:
        return solve_newton(
            equations, x, fraction,
            residual_tolerance=tolerance.residual, increment_tolerance=tolerance.increment,
            force_tolerance=tolerance.force, motion_tolerance=tolerance.motion, solve=solve,
        )  # fmt: skip
    return solve_newton(
        equations, x, fraction,
        residual_tolerance=np.inf, increment_tolerance=_WAYPOINT, solve=solve,
    )  # fmt: skip


def _record(outcome: Outcome, fraction: float, negative_pivots: int | None) -> LoadStep:
    return LoadStep(
        fraction,
        outcome.converged,
        sum(step.increment >= 0.0 for step in outcome.steps),
        sum(step.new_tangent for step in outcome.steps),
        negative_pivots,
        outcome.reason,
    )
