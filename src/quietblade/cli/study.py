# SPDX-License-Identifier: LGPL-2.1-or-later
"""``quietblade study``: many runs and their tables, a calibration, or sensitivities."""

import os
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from quietblade.cli.common import ExitCode, console, error_console, show_json
from quietblade.cli.progress import ProgressDisplay
from quietblade.cli.tables import show_tables

if TYPE_CHECKING:
    from quietblade.case.study import Study
    from quietblade.results.study_table import StudyTable


def study(
    file: Annotated[Path, typer.Argument(help="Study file (TOML), or a calibration file.")],
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="Folder of the study; default runs/NAME-OF-THE-FILE."),
    ] = None,
    plan: Annotated[
        bool, typer.Option("--plan", help="List the runs and compute nothing.")
    ] = False,
    calibrate: Annotated[
        bool, typer.Option("--calibrate", help="Fit what a calibration file leaves open.")
    ] = False,
    sensitivities: Annotated[
        bool, typer.Option("--sensitivities", help="Change each open choice of it by itself.")
    ] = False,
    reading: Annotated[
        str, typer.Option("--reading", help="Reading of the targets that is fitted.")
    ] = "",
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Show errors only.")] = False,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print runs and figures as JSON; progress on stderr.")
    ] = False,
) -> ExitCode:
    """Compute the variants of some cases, and their tables; what is there is kept.

    A run that fails is reported and does not end the study. The exit code is 2 if a run did not
    converge or a search did not settle, 3 if a run failed.
    """
    # many small dense systems: threads of the BLAS would only fight with those of the solvers
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    folder = out or Path("runs") / file.stem
    if calibrate or sensitivities:
        from quietblade.cli.study_fit import fit  # noqa: PLC0415  # help must stay fast

        return fit(file, folder, reading, search=calibrate, quiet=quiet, as_json=as_json)
    return _study(file, folder, only_plan=plan, quiet=quiet, as_json=as_json)


def _study(file: Path, folder: Path, *, only_plan: bool, quiet: bool, as_json: bool) -> ExitCode:
    from quietblade.case.study import Study  # noqa: PLC0415
    from quietblade.study.studies import run_study, study_tables  # noqa: PLC0415

    words = Study.load(file)
    if only_plan:
        return _show_plan(words, as_json=as_json)
    teller = error_console if as_json else console

    def announce(number: int, count: int, name: str, what: str) -> None:
        if what.startswith("failed"):
            error_console.print(f"{name}: {what}", style="red", markup=False)
        elif not quiet:
            teller.print(f"{number} of {count}: {name}, {what}", markup=False)

    with ProgressDisplay(teller, quiet=quiet) as progress:
        made = run_study(words, folder, announce=announce, progress=progress)
    if as_json:
        show_json(_rows(made.table))
    elif not quiet:
        show_tables(words.title or file.stem, study_tables(made.table, made.claims))
        console.print(f"tables: {folder}", markup=False)
    return _ended(made.table)


def _show_plan(words: "Study", *, as_json: bool) -> ExitCode:
    from quietblade.study.studies import plan  # noqa: PLC0415

    runs = plan(words)
    if as_json:
        show_json([{"run": run.name, "changes": dict(run.changes)} for run in runs])
        return ExitCode.DONE
    for number, run in enumerate(runs, start=1):
        changes = ", ".join(f"{key} = {value}" for key, value in run.changes.items())
        line = f"{number} {run.name}: {changes or 'as it is'}"
        console.print(line, markup=False, soft_wrap=True)  # one run a line, for grep
    return ExitCode.DONE


def _rows(table: "StudyTable") -> list[dict[str, Any]]:
    return [
        {
            "case": row.case,
            "variant": row.variant,
            "state": row.state,
            "message": row.message,
            "changes": dict(row.changes),
            "figures": {f.name: f.value for f in row.figures},
        }
        for row in table.rows
    ]


def _ended(table: "StudyTable") -> ExitCode:
    states = {row.state for row in table.rows}
    if "failed" in states:
        return ExitCode.FAILED
    return ExitCode.NOT_CONVERGED if "not converged" in states else ExitCode.DONE


def show_study(folder: Path, *, as_json: bool) -> ExitCode:
    """Show the tables of a study's folder."""
    from quietblade.results.study_table import read_study  # noqa: PLC0415
    from quietblade.study.studies import read_tables  # noqa: PLC0415

    if as_json:
        show_json(_rows(read_study(folder)))
    else:
        show_tables(*read_tables(folder))
    return ExitCode.DONE
