# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which unstated choice moves which figure, and how far: one choice changed at a time."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from quietblade.case.problems import shown
from quietblade.case.study import flat
from quietblade.case.study_calibration import Calibration
from quietblade.errors import QuietbladeError
from quietblade.results.study_table import as_csv
from quietblade.results.table import Table, number
from quietblade.study.calibration import Evaluation, Evaluator, Runner
from quietblade.study.run import run_case
from quietblade.typing import Progress, silent

_TOLD = 3  # choices that the printed table names for a figure


@dataclass(frozen=True)
class Effect:
    """What one value of one choice does.

    Attributes
    ----------
    key : str
        Key of the case.
    value : str
        As it is written.
    step : float
        Its place minus that of the start, as a share of the bounds; nan of a choice without any.
    evaluation : Evaluation
    """

    key: str
    value: str
    step: float
    evaluation: Evaluation


@dataclass(frozen=True)
class Sensitivities:
    """One-at-a-time changes around the start.

    Attributes
    ----------
    start : Evaluation
    effects : tuple of Effect
    """

    start: Evaluation
    effects: tuple[Effect, ...]

    def names(self) -> tuple[tuple[str, str], ...]:
        """Case and name of every figure of the start."""
        return tuple((case, name) for case, figures in self.start.figures.items()
                     for name in figures)  # fmt: skip

    def change(self, effect: Effect, case: str, name: str) -> float:
        """Change of a figure, nan if it is not there any more."""
        return effect.evaluation.figure(case, name) - self.start.figure(case, name)

    def slope(self, key: str, case: str, name: str) -> float:
        """Signed derivative over the whole range of a parameter, by its two ends; nan if none."""
        ends = [(e.step, self.change(e, case, name)) for e in self.effects if e.key == key]
        known = [(step, change) for step, change in ends if np.isfinite(step * change)]
        if not known:
            return float("nan")
        (a, low), (b, high) = (known[0], known[-1]) if len(known) > 1 else ((0.0, 0.0), known[0])
        return (high - low) / (b - a)

    def to_csv(self) -> str:
        """One row a change of one figure."""

        def row(effect: Effect, case: str, name: str) -> list[str]:
            there, start = effect.evaluation.figure(case, name), self.start.figure(case, name)
            numbers = (start, there, there - start, self.slope(effect.key, case, name))
            failure = effect.evaluation.failure
            return [effect.key, effect.value, case, name, *map(_digits, numbers), failure]

        rows = [row(effect, *name) for effect in self.effects for name in self.names()]
        heads = ("key", "value", "case", "figure", "start", "there", "change", "slope", "failure")
        return as_csv(heads, rows)

    def table(self, wanted: Sequence[str] = ()) -> Table:
        """Largest movers of each figure; of the paper's claims unless others are wanted."""
        rows = []
        for case, name in self.names():
            if name not in wanted if wanted else not name.startswith("paper/"):
                continue
            moves = [(self.change(e, case, name), e) for e in self.effects]
            known = sorted(
                ((c, e) for c, e in moves if np.isfinite(c)), key=lambda move: -abs(move[0])
            )
            told = "; ".join(f"{c:+.3g} by {e.key} = {e.value}" for c, e in known[:_TOLD])
            rows.append((case, name, number(self.start.figure(case, name)), told or "-"))
        return Table("What moves what", ("case", "figure", "start", "largest changes"), tuple(rows))


def _digits(value: float) -> str:
    return f"{value:.8g}" if np.isfinite(value) else ""


def sensitivities(
    words: Calibration,
    root: Path,
    runner: Runner = run_case,
    progress: Progress = silent,
) -> Sensitivities:
    """Change each parameter to both bounds, and each choice, by itself.

    Parameters
    ----------
    words : Calibration
    root : Path
        Folder that keeps the evaluations.
    runner : callable
        Computes a case into a folder.
    progress : callable

    Raises
    ------
    QuietbladeError
        The start itself cannot be evaluated.
    """
    changes = flat(words.sensitivities)
    cases = tuple(words.cases)
    evaluate = Evaluator(words, root / "sensitivities", cases, changes, runner, progress)
    first = {p.key: p.value(p.first) for p in words.parameters}
    start = evaluate(first)
    if start.failure:
        raise QuietbladeError(f"the start of the sensitivities fails: {start.failure}")
    wanted = list(_changes(words, first))
    effects = []
    for number_, (key, value, step) in enumerate(wanted):
        progress("sensitivities", number_ / len(wanted), f"{key} = {shown(value)}")
        effects.append(Effect(key, shown(value), step, evaluate({**first, key: value})))
    return Sensitivities(start, tuple(effects))


def _changes(words: Calibration, first: Mapping[str, Any]) -> Iterator[tuple[str, Any, float]]:
    for p in words.parameters:
        for place in (0.0, 1.0):
            if p.value(place) != first[p.key]:
                yield p.key, p.value(place), place - p.first
    for choice in words.choices:
        for value in choice.values:
            yield choice.key, value, float("nan")
