# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which solver did what, and why another one had to."""

from collections import Counter
from dataclasses import dataclass, field
from threading import Lock

from quietblade.linalg.protocol import Backend
from quietblade.linalg.refinement import Refined


@dataclass(frozen=True)
class Level:
    """A solver program in one precision."""

    backend: Backend
    single: bool

    def __str__(self) -> str:
        return f"{self.backend.name} ({'mixed' if self.single else 'double'})"


@dataclass(frozen=True)
class Fallback:
    """One change of solver, and why."""

    left: str
    entered: str
    reason: str


@dataclass(frozen=True)
class SolverReport:
    """What a chain has done so far.

    Attributes
    ----------
    factorizations, solves : dict of str to int
        Numbers by solver; a solve counts its right-hand sides.
    worst_residual : float
        Largest ``||A x - b|| / ||b||`` of a solution that was returned.
    most_steps : int
        Most substitutions that one solve took.
    fallbacks : tuple of Fallback
        Changes of solver in the order of time.
    seconds : float
        Time spent in analyses and factorisations.
    largest_factor : int
        Size of the largest factor [bytes].
    """

    factorizations: dict[str, int]
    solves: dict[str, int]
    worst_residual: float
    most_steps: int
    fallbacks: tuple[Fallback, ...]
    seconds: float
    largest_factor: int

    def __str__(self) -> str:
        used = ", ".join(f"{name}: {count}" for name, count in self.factorizations.items())
        text = f"factorisations {used or 'none'}; worst residual {self.worst_residual:.1e}"
        for fallback in self.fallbacks:
            text += f"; {fallback.left} -> {fallback.entered}: {fallback.reason}"
        return text


@dataclass
class Log:
    """The growing side of a report; several threads write it."""

    factorizations: Counter[str] = field(default_factory=Counter)
    solves: Counter[str] = field(default_factory=Counter)
    worst_residual: float = 0.0
    most_steps: int = 0
    fallbacks: list[Fallback] = field(default_factory=list)
    seconds: float = 0.0
    largest_factor: int = 0
    lock: Lock = field(default_factory=Lock)

    def factored(self, level: Level, seconds: float, memory_bytes: int) -> None:
        """Count a factorisation."""
        with self.lock:
            self.largest_factor = max(self.largest_factor, memory_bytes)
            self.factorizations[str(level)] += 1
            self.seconds += seconds

    def solved(self, level: Level, columns: int, result: Refined) -> None:
        """Count solutions."""
        with self.lock:
            self.solves[str(level)] += columns
            self.worst_residual = max(self.worst_residual, result.residual)
            self.most_steps = max(self.most_steps, result.steps)

    def left(self, old: Level, new: Level, reason: str) -> None:
        """Enter a change of solver."""
        with self.lock:
            self.fallbacks.append(Fallback(str(old), str(new), reason))

    def report(self) -> SolverReport:
        """Freeze what is known now."""
        with self.lock:
            return SolverReport(
                dict(self.factorizations),
                dict(self.solves),
                self.worst_residual,
                self.most_steps,
                tuple(self.fallbacks),
                self.seconds,
                self.largest_factor,
            )
