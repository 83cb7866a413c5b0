# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fit what a source leaves unstated: a search over evaluations that are kept on disk.

An evaluation is a run of each case on a coarse mesh. Whatever has been evaluated is found again by
its key, so that an interrupted search replays what it knows and goes on from there.
"""

import hashlib
import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from scipy.optimize import least_squares
from scipy.stats import qmc

from quietblade.case import Case, InvalidCaseError
from quietblade.case.study import flat
from quietblade.case.study_calibration import Calibration, changed
from quietblade.errors import QuietbladeError
from quietblade.results.files import write_text
from quietblade.results.model import Result
from quietblade.results.store import RunFolder
from quietblade.results.study_figures import all_figures
from quietblade.study.run import finished, run_case, run_key
from quietblade.typing import FloatArray, Progress, silent

Values = Mapping[str, Any]
Runner = Callable[[Case, RunFolder, Progress], Result]

FAILED = 10.0
"""Deviation, in scales, of every target of an evaluation that failed."""

_SETTLED = 1e-3  # relative change of the cost, and step, at which the search ends


@dataclass(frozen=True)
class Evaluation:
    """What some values of the parameters lead to.

    Attributes
    ----------
    values : mapping
        Keys of the case to values.
    figures : mapping
        Figures by case, then by name.
    failure : str
        Why there are none; empty if all went well.
    """

    values: Values
    figures: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    failure: str = ""

    def figure(self, case: str, name: str) -> float:
        """Return a figure, nan if it was not computed."""
        return self.figures.get(case, {}).get(name, float("nan"))


class Evaluator:
    """Evaluates values of the parameters, each only once.

    Parameters
    ----------
    words : Calibration
    root : Path
        Folder of the evaluations; each has one of its own with its runs and a record.
    cases : sequence of str
        Names of the cases that are computed.
    changes : mapping
        Changes besides those of every evaluation, such as a finer mesh.
    runner : callable
        Computes a case into a folder.
    progress : callable
    """

    def __init__(
        self,
        words: Calibration,
        root: Path,
        cases: Sequence[str],
        changes: Values | None = None,
        runner: Runner = run_case,
        progress: Progress = silent,
    ) -> None:
        self.root = root
        self.computed = 0
        """Evaluations that were not on disk."""
        self._bases = {name: words.base(name).varied(changes or {}) for name in cases}
        self._runner = runner
        self._progress = progress

    def __call__(self, values: Values) -> Evaluation:
        """Find or compute an evaluation; one that fails is kept with its reason."""
        try:
            cases = {name: changed(case, values) for name, case in self._bases.items()}
        except InvalidCaseError as error:
            return Evaluation(dict(values), failure=str(error))
        key = hashlib.sha256("".join(run_key(case) for case in cases.values()).encode())
        folder = self.root / key.hexdigest()[:16]
        record = folder / "evaluation.json"
        known = _read(record)
        if known is not None:
            return known
        self.computed += 1
        made = self._compute(values, cases, folder)
        write_text(record, json.dumps(vars(made), indent=1))
        return made

    def _compute(self, values: Values, cases: Mapping[str, Case], folder: Path) -> Evaluation:
        figures: dict[str, dict[str, float]] = {}
        for name, case in cases.items():
            place = RunFolder(folder / name)
            try:
                result = finished(case, place) or self._runner(case, place, self._progress)
            except QuietbladeError as error:
                return Evaluation(dict(values), failure=f"{name}: {error}")
            known = {**all_figures(result), **case_figures(case)}
            figures[name] = {key: value for key, value in known.items() if np.isfinite(value)}
        return Evaluation(dict(values), figures)


def case_figures(case: Case) -> dict[str, float]:
    """Figures that need no computation: ``film_aspect``, length of the film over its mean width."""
    if case.film is None:
        return {}
    # imported here: geometry of a case is light, the rest of translate is not needed
    from quietblade.study.translate import build_blade  # noqa: PLC0415

    (low, high), (front, back) = case.film.span, case.film.chord
    chord = float(np.mean(build_blade(case).chord(np.linspace(low, high, 101))))
    return {"film_aspect": (high - low) * case.blade.span / ((back - front) * chord)}


def _read(record: Path) -> Evaluation | None:
    try:
        return Evaluation(**json.loads(record.read_text(encoding="utf-8")))
    except (OSError, ValueError, TypeError):
        return None


def stored_evaluations(root: Path) -> list[Evaluation]:
    """Every evaluation of a folder, in the order of their names."""
    found = (_read(record) for record in sorted(root.glob("*/evaluation.json")))
    return [evaluation for evaluation in found if evaluation is not None]


@dataclass(frozen=True)
class Fitted:
    """What a search found.

    Attributes
    ----------
    reading : str
        Reading of the source that was fitted; empty for the first.
    start, best : Evaluation
        Where the search began, and the best that it met.
    residuals : (m,) array
        Deviations of the best one from the targets, in scales.
    cost : tuple of float
        Sum of their squares at the start and at the end.
    evaluations, computed : int
        Evaluations that the search asked for, and those that were not on disk.
    settled : bool
        The search ended by itself, not for want of evaluations.
    correction : mapping
        Ratio of the fine to the coarse figure of each target, by ``case/figure``.
    path : tuple of float
        Cost of each evaluation in the order asked for.
    """

    reading: str
    start: Evaluation
    best: Evaluation
    residuals: FloatArray
    cost: tuple[float, float]
    evaluations: int
    computed: int
    settled: bool
    correction: Mapping[str, float]
    path: tuple[float, ...]


class _SpentError(Exception):
    """The evaluations are used up."""


class _Search:
    """Residuals on the unit cube of the parameters that the search moves."""

    def __init__(
        self,
        words: Calibration,
        evaluate: Callable[[Values], Evaluation],
        correction: Mapping[str, float],
        reading: str,
        progress: Progress,
    ) -> None:
        self.words, self.reading, self.correction = words, reading, correction
        self.moved = [p for p in words.parameters if p.search]
        self.met: dict[tuple[float, ...], tuple[Evaluation, FloatArray]] = {}
        self._evaluate, self._progress = evaluate, progress

    def values(self, x: FloatArray) -> dict[str, Any]:
        return {p.key: p.value(float(xi)) for p, xi in zip(self.moved, x, strict=True)}

    def residuals(self, x: FloatArray) -> FloatArray:
        key = tuple(np.round(x, 6).tolist())
        if key not in self.met:
            most = self.words.search.evaluations
            if len(self.met) >= most:
                raise _SpentError
            self._progress("search", len(self.met) / most, f"evaluation {len(self.met) + 1}")
            evaluation = self._evaluate(self.values(x))
            self.met[key] = evaluation, self.deviations(evaluation)
        return self.met[key][1]

    def deviations(self, evaluation: Evaluation) -> FloatArray:
        """Deviations from the targets, in scales."""
        found = []
        for t in self.words.targets:
            value = evaluation.figure(t.case, t.figure)
            value *= self.correction.get(f"{t.case}/{t.figure}", 1.0)
            off = (value - t.readings.get(self.reading, t.value)) / t.scale
            found.append(off if np.isfinite(off) else FAILED)
        return np.array(found)

    def slopes(self, x: FloatArray) -> FloatArray:
        """Differences over steps that leave the meshes' noise behind, towards the inside."""
        here, columns = self.residuals(x), []
        for k in range(len(x)):
            ahead = self.words.search.step * (1.0 if x[k] <= 0.5 else -1.0)
            column = np.zeros(len(here))
            for step in (ahead, -ahead):
                there = x.copy()
                there[k] = min(max(x[k] + step, 0.0), 1.0)
                moved = self.residuals(there)
                if there[k] != x[k] and not np.all(moved == FAILED):
                    column = (moved - here) / (there[k] - x[k])
                    break
            columns.append(column)
        return np.array(columns).T

    def best(self) -> tuple[Evaluation, FloatArray]:
        return min(self.met.values(), key=lambda pair: float(pair[1] @ pair[1]))


def calibrate(
    words: Calibration,
    root: Path,
    reading: str = "",
    runner: Runner = run_case,
    progress: Progress = silent,
) -> Fitted:
    """Fit the parameters to the targets by least squares within the bounds.

    Spread evaluations, if wanted, are a scrambled Sobol sequence; the search begins at the best of
    them and the start (trust region reflective: Branch, Coleman and Li, SIAM J. Sci. Comput. 21
    (1999) 1-23). Coarse figures are corrected by the ratio of fine to coarse at the start (Bandler
    et al., IEEE Trans. Microw. Theory Tech. 42 (1994) 2536-2544, in its simplest form). Nothing is
    left to chance: the same file gives the same evaluations.

    Parameters
    ----------
    words : Calibration
    root : Path
        Folder that keeps the evaluations.
    reading : str
        Reading of the targets' values; empty for the first.
    runner : callable
        Computes a case into a folder.
    progress : callable

    Raises
    ------
    QuietbladeError
        The start itself cannot be evaluated, or there is no such reading.
    """
    if reading and reading not in words.readings:
        known = ", ".join(words.readings) or "none"
        raise QuietbladeError(f"no target has a reading {reading!r}; known: {known}")
    evaluate = Evaluator(words, root / "evaluations", words.fitted, {}, runner, progress)
    first = np.array([p.first for p in words.parameters if p.search])
    search = _Search(words, evaluate, {}, reading, progress)
    start = evaluate(search.values(first))
    if start.failure:
        raise QuietbladeError(f"the start of the search fails: {start.failure}")
    if words.fine:
        finely = Evaluator(words, root / "fine", words.fitted, flat(words.fine), runner, progress)
        fine = finely(start.values)
        if fine.failure:
            raise QuietbladeError(f"the start fails on the fine mesh: {fine.failure}")
        search.correction = _correction(words, start, fine)
    settled = _run(words, search, first)
    best, residuals = search.best()
    begun = search.deviations(start)
    return Fitted(
        reading,
        start,
        best,
        residuals,
        (float(begun @ begun), float(residuals @ residuals)),
        len(search.met),
        evaluate.computed,
        settled,
        search.correction,
        tuple(float(r @ r) for _, r in search.met.values()),
    )


def _run(words: Calibration, search: _Search, first: FloatArray) -> bool:
    """Search until it settles (true) or the evaluations are used up."""
    try:
        begin = first
        least = float(np.sum(search.residuals(first) ** 2))
        for x in _spread(words.search.samples, len(first), words.search.seed):
            cost = float(np.sum(search.residuals(x) ** 2))
            if cost < least:
                begin, least = x, cost
        least_squares(
            search.residuals,
            np.clip(begin, 1e-6, 1.0 - 1e-6),  # strictly inside, as the method needs it
            jac=search.slopes,
            bounds=(0.0, 1.0),
            method="trf",
            ftol=_SETTLED,
            xtol=_SETTLED,
            gtol=_SETTLED,
        )
    except _SpentError:
        return False
    return True


def _spread(count: int, dimensions: int, seed: int) -> FloatArray:
    if count == 0:
        return np.zeros((0, dimensions))
    sequence = qmc.Sobol(dimensions, scramble=True, seed=seed)
    return np.asarray(sequence.random_base2(max(0, int(np.ceil(np.log2(count)))))[:count])


def _correction(words: Calibration, coarse: Evaluation, fine: Evaluation) -> dict[str, float]:
    factors = {}
    for target in words.targets:
        ratio = fine.figure(target.case, target.figure) / coarse.figure(target.case, target.figure)
        if np.isfinite(ratio) and ratio > 0.0:
            factors[f"{target.case}/{target.figure}"] = float(ratio)
    return factors
