# SPDX-License-Identifier: LGPL-2.1-or-later
"""Newton's method with a kept tangent near the solution, and its convergence table."""

from collections.abc import Callable
from dataclasses import dataclass
from math import isnan, nan
from typing import Protocol, runtime_checkable

import numpy as np

from quietblade.errors import SolverError
from quietblade.typing import FloatArray

MAX_ITERATIONS = 20

# Below this relative increment the tangent is kept: the error then falls by a steady factor an
# iteration, for the price of a residual and a solve instead of a factorisation.
_KEEP_BELOW = 1e-3

# A kept tangent that contracts worse than this is replaced.
_POOR_CONTRACTION = 0.05

# Increments above this size have to shrink from one iteration to the next.
_MUST_SHRINK_ABOVE = 1e-2

# Only below this relative increment a residual that stays can be that of rounding.
_ROUNDED_BELOW = 1e-4

Solve = Callable[[FloatArray], FloatArray]


@dataclass(frozen=True)
class Tolerance:
    """When an equilibrium is good enough: residual and last increment both have to be small.

    Attributes
    ----------
    residual : float
        Largest residual relative to the forces (in the film also the volume defect).
    increment : float
        Largest increment relative to the displacement.
    force : float
        Largest residual [N] (Euclidean norm over the displacement unknowns) that is small however
        small the forces are; zero if only the relative size counts.
    motion : float
        Likewise the largest increment of a vertex [m].
    """

    residual: float = 1e-6
    increment: float = 1e-6
    force: float = 0.0
    motion: float = 0.0


@dataclass(frozen=True)
class NewtonStep:
    """A line of the convergence table.

    Attributes
    ----------
    fraction : float
        Fraction of the way from the start's load to the wanted load.
    iteration : int
        Iteration at this load, from 0.
    residual : float
        Relative residual before the correction.
    increment : float
        Correction relative to the displacement; NaN in a line that only checks.
    new_tangent : bool
        Whether the tangent was assembled and factorised for it.
    force : float
        Residual [N]; NaN if the problem does not know it.
    motion : float
        Largest correction of a vertex [m]; NaN likewise.
    energy : float
        Work of the residual on the correction [J].
    """

    fraction: float
    iteration: int
    residual: float
    increment: float
    new_tangent: bool
    force: float = nan
    motion: float = nan
    energy: float = nan

    def __str__(self) -> str:
        mark = "*" if self.new_tangent else " "
        line = (
            f"load {self.fraction:7.4f}  iteration {self.iteration:2d}{mark} "
            f"residual {self.residual:8.2e}"
        )
        if not isnan(self.force):
            line += f" {self.force:8.2e} N"
        if isnan(self.increment):
            return line
        line += f"  increment {self.increment:8.2e}"
        if not isnan(self.motion):
            line += f" {self.motion:8.2e} m"
        return f"{line}  energy {self.energy:8.2e} J"


class Problem(Protocol):
    """Equilibrium at a fixed load, as Newton's method sees it."""

    def residual(self, x: FloatArray) -> tuple[FloatArray, float]:
        """Residual of the free unknowns, and its relative size; zero if there is no force."""

    def tangent(self, x: FloatArray) -> Solve:
        """Solver of the linear system at x."""

    def correct(self, x: FloatArray, step: FloatArray) -> tuple[FloatArray, float]:
        """Corrected x, and the size of the correction relative to the displacement."""


@runtime_checkable
class Measured(Protocol):
    """A problem that also knows sizes in units."""

    def force_size(self, residual: FloatArray) -> float:
        """Size of a residual of the free unknowns [N]."""

    def motion_size(self, step: FloatArray) -> float:
        """Largest displacement of a vertex in a step of the free unknowns [m]."""

    def rounding(self, x: FloatArray) -> float:
        """Bound of the relative residual that rounding makes at x."""


@dataclass(frozen=True, eq=False)
class Outcome:
    """End of Newton's method at one load.

    Attributes
    ----------
    x : (ndof,) float array
        Last iterate.
    converged : bool
        Whether the tolerances are met.
    steps : tuple of NewtonStep
        Convergence table.
    solve : callable or None
        Solver of the last tangent, after convergence.
    reason : str
        Why it did not converge.
    rounding : float or None
        If it converged to the level of rounding, short of the tolerances: the bound of that level,
        relative as the residual.
    """

    x: FloatArray
    converged: bool
    steps: tuple[NewtonStep, ...]
    solve: Solve | None = None
    reason: str = ""
    rounding: float | None = None


def solve_newton(
    problem: Problem,
    x: FloatArray,
    fraction: float,
    *,
    residual_tolerance: float,
    increment_tolerance: float,
    force_tolerance: float = 0.0,
    motion_tolerance: float = 0.0,
    solve: Solve | None = None,
) -> Outcome:
    """Iterate until the residual and the last increment are small.

    Parameters
    ----------
    problem : Problem
        Equilibrium at the load; if it is also `Measured`, the table has sizes in units.
    x : (ndof,) float array
        First guess.
    fraction : float
        Fraction of the load path, for the table.
    residual_tolerance, increment_tolerance : float
        Largest relative residual, and largest relative increment before it.
    force_tolerance, motion_tolerance : float
        Residual [N] and increment [m] that count as small whatever their relative sizes.
    solve : callable or None
        Solver of a tangent near x, if there is one, for the first correction.

    Returns
    -------
    Outcome
        Converged also if the residual stays where rounding is as large as it is.  Not converged
        if a residual is not finite, large increments do not shrink, a linear system cannot be
        solved, or the iterations are used up.
    """
    units = problem if isinstance(problem, Measured) else None
    steps: list[NewtonStep] = []
    last = before = motion = least = np.inf
    for iteration in range(MAX_ITERATIONS + 1):
        force, residual = problem.residual(x)
        newtons = nan if units is None else units.force_size(force)
        settled = residual == 0.0 or (
            (residual <= residual_tolerance or newtons <= force_tolerance)
            and (last <= increment_tolerance or motion <= motion_tolerance)
        )
        if settled or not np.isfinite(residual) or iteration == MAX_ITERATIONS:
            steps.append(NewtonStep(fraction, iteration, residual, nan, False, newtons))
            if settled:
                return Outcome(x, True, tuple(steps), solve)
            reason = "the iterations are used up"
            if not np.isfinite(residual):
                reason = "an element is turned inside out: the residual is not finite"
            return Outcome(x, False, tuple(steps), reason=reason)
        if units is not None and last <= _ROUNDED_BELOW and residual > 0.5 * least:
            level = units.rounding(x)
            if residual <= level:
                steps.append(NewtonStep(fraction, iteration, residual, nan, False, newtons))
                return Outcome(x, True, tuple(steps), solve, rounding=level)
        least = min(least, residual)
        near = last < _KEEP_BELOW and last < _POOR_CONTRACTION * before
        new_tangent = solve is None or not (near or iteration == 0)
        try:
            if solve is None or new_tangent:
                solve = None  # frees the memory of the last one
                solve = problem.tangent(x)
            step = solve(force)
        except SolverError as error:
            steps.append(NewtonStep(fraction, iteration, residual, nan, new_tangent, newtons))
            return Outcome(x, False, tuple(steps), reason=str(error))
        x, increment = problem.correct(x, step)
        motion = nan if units is None else units.motion_size(step)
        energy = float(abs(force @ step))
        steps.append(
            NewtonStep(
                fraction, iteration, residual, increment, new_tangent, newtons, motion, energy
            )
        )
        before, last = last, increment
        if not np.isfinite(last) or last > max(before, _MUST_SHRINK_ABOVE):
            break
    return Outcome(x, False, tuple(steps), reason="the increments grow")
