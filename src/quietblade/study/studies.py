# SPDX-License-Identifier: LGPL-2.1-or-later
"""A study of many runs: what is finished is not computed again, what fails does not end it."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

from quietblade.case import AnyCase, InvalidCaseError
from quietblade.case.problems import Problem, shown
from quietblade.case.study import Study, flat
from quietblade.errors import QuietbladeError
from quietblade.results.files import write_text
from quietblade.results.model import Result
from quietblade.results.store import RunFolder
from quietblade.results.study_claims import ClaimTable, claim_table, read_claims, write_claims
from quietblade.results.study_figures import headline_figures
from quietblade.results.study_table import (
    SHOWN,
    StudyRow,
    StudyTable,
    convergence_csv,
    read_study,
    run_name,
    write_study,
)
from quietblade.results.table import Table
from quietblade.results.tables import as_text
from quietblade.study.keeping import StageStore
from quietblade.study.run import finished, run_case
from quietblade.typing import Progress, silent

Runner = Callable[[AnyCase, RunFolder, Progress], Result]
"""Computes a case into a folder."""

Announce = Callable[[int, int, str, str], None]
"""Called with the number of a run, how many there are, its name, and what becomes of it."""

_STAGES = ("blade", "film", "body", "materials", "root", "mesh", "water", "flow", "static", "loads")
"""Tables that the mesh and the equilibrium depend on, before those of vibration and sound."""


@dataclass(frozen=True)
class Planned:
    """One run of a study.

    Attributes
    ----------
    case, variant : str
        Names of the study file.
    changes : mapping
        Keys to what the variant writes.
    words : AnyCase
        The case with these changes.
    """

    case: str
    variant: str
    changes: Mapping[str, str]
    words: AnyCase

    @property
    def name(self) -> str:
        """Name of the run's folder."""
        return run_name(self.case, self.variant)


@dataclass(frozen=True)
class StudyOutcome:
    """What a study made.

    Attributes
    ----------
    table : StudyTable
        Figures of every run.
    claims : ClaimTable or None
        The paper's claims, if the study asks for them.
    computed : int
        Runs that were not there yet.
    """

    table: StudyTable
    claims: ClaimTable | None
    computed: int


def plan(study: Study) -> tuple[Planned, ...]:
    """Every run of a study; those that share mesh and equilibrium stand side by side.

    Raises
    ------
    InvalidCaseError
        Lists every problem of every case and variant.
    """
    runs: list[Planned] = []
    problems: list[Problem] = []
    for name in study.cases:
        try:
            base = study.base(name)
        except InvalidCaseError as error:
            problems.extend(error.problems)
            continue
        for variant, own in study.all_variants().items():
            try:
                words = study.changed(base, variant)
            except InvalidCaseError as error:
                problems.extend(error.problems)
                continue
            changes = {key: shown(value) for key, value in {**flat(study.common), **own}.items()}
            runs.append(Planned(name, variant, changes, words))
    if problems:
        raise InvalidCaseError(problems)
    return tuple(sorted(runs, key=_shared(runs)))


def _shared(runs: list[Planned]) -> Callable[[Planned], tuple[int, int]]:
    """Order by what mesh and equilibrium depend on, in the order of first appearance."""
    seen: dict[str, int] = {}
    places = {id(run): number for number, run in enumerate(runs)}

    def order(run: Planned) -> tuple[int, int]:
        plain = run.words.plain()
        shared = repr([plain.get(table) for table in _STAGES])
        return seen.setdefault(f"{run.case} {shared}", len(seen)), places[id(run)]

    return order


def run_study(
    study: Study,
    root: Path,
    *,
    runner: Runner = run_case,
    announce: Announce = lambda *_: None,
    progress: Progress = silent,
) -> StudyOutcome:
    """Compute what is missing of a study, and its tables.

    Parameters
    ----------
    study : Study
    root : Path
        Folder of the study; every run has a folder in it.
    runner : callable
        Computes a case into a folder.
    announce : callable
        Told of every run.
    progress : callable
        Told of the stages of each run.

    Raises
    ------
    InvalidCaseError
        A case or a variant has problems; nothing is computed then.
    ResultError
        The meshes of the convergence are not in order.
    """
    runs = plan(study)
    results: dict[tuple[str, str], Result] = {}
    rows: list[StudyRow] = []
    lenders: dict[str, RunFolder] = {}  # the run before of each case: often of the same mesh
    computed = 0
    for number, run in enumerate(runs, start=1):
        folder = RunFolder(root / run.name)
        result = finished(run.words, folder)
        announce(number, len(runs), run.name, "is there" if result else "computed")
        message = ""
        if result is None:
            computed += 1
            if run.case in lenders:
                StageStore(folder.stages).borrow(lenders[run.case].stages)
            try:
                result = runner(run.words, folder, progress)
            except (QuietbladeError, MemoryError) as error:
                message = str(error) or "not enough memory"
                announce(number, len(runs), run.name, f"failed: {message}")
        if result is not None:
            results[run.case, run.variant] = result
            lenders[run.case] = folder
        rows.append(_row(run, result, message))
    table = StudyTable(study.title, tuple(rows), study.figures or SHOWN)
    claims = _claims(study, results)
    _write(study, table, claims, root)
    return StudyOutcome(table, claims, computed)


def _row(run: Planned, result: Result | None, message: str) -> StudyRow:
    if result is None:
        return StudyRow(run.case, run.variant, run.changes, "failed", message)
    state = "finished" if result.converged else "not converged"
    return StudyRow(run.case, run.variant, run.changes, state, figures=headline_figures(result))


def _claims(study: Study, results: Mapping[tuple[str, str], Result]) -> ClaimTable | None:
    if study.claims is None:
        return None
    meshes = study.convergence.variants if study.convergence is not None else ()
    return claim_table(study.title, results, study.claims.variants, meshes)


def _write(study: Study, table: StudyTable, claims: ClaimTable | None, root: Path) -> None:
    write_text(root / "study.toml", study.text)
    if study.convergence is not None:
        text = convergence_csv(table, study.convergence.variants)
        write_text(root / "convergence.csv", text)
    if claims is not None:
        write_claims(claims, root)
    write_text(root / "study.txt", as_text(study.title or "Study", study_tables(table, claims)))
    write_study(table, root)


def study_tables(table: StudyTable, claims: ClaimTable | None) -> tuple[Table, ...]:
    """Tables for the screen: the runs, those that failed, and the paper's claims."""
    tables = (table.table(), table.failures(), claims.table() if claims is not None else None)
    return tuple(t for t in tables if t is not None and t.rows)


def read_tables(root: Path) -> tuple[str, tuple[Table, ...]]:
    """Title and tables of a study's folder.

    Raises
    ------
    ResultError
        It has none, or they cannot be read.
    """
    table = read_study(root)
    claims = read_claims(root) if (root / "claims.json").is_file() else None
    return table.title or "Study", study_tables(table, claims)
