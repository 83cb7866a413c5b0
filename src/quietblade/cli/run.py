# SPDX-License-Identifier: LGPL-2.1-or-later
"""``quietblade run``: from a case file to a result folder."""

from pathlib import Path
from typing import Annotated

import typer
from rich.text import Text

from quietblade.cli.common import ExitCode, console, show_notices
from quietblade.cli.progress import ProgressDisplay


def run(
    case: Annotated[Path, typer.Argument(help="Case file (TOML).")],
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="Folder of the run; default runs/NAME-OF-THE-CASE."),
    ] = None,
    force: Annotated[
        bool, typer.Option("--force", help="Compute again although the result is there.")
    ] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Show errors only.")] = False,
) -> ExitCode:
    """Compute a case: deformation, wet modes and radiated sound."""
    from quietblade.case import Case  # noqa: PLC0415  # help must stay fast
    from quietblade.results.headline import summarise  # noqa: PLC0415
    from quietblade.results.store import RunFolder  # noqa: PLC0415
    from quietblade.results.tables import as_text, summary_tables  # noqa: PLC0415
    from quietblade.study.run import finished, run_case  # noqa: PLC0415

    words = Case.load(case)
    folder = RunFolder(out or Path("runs") / case.stem)
    if not force and (result := finished(words, folder)) is not None:
        if not quiet:
            console.print(f"{folder.root} holds the result of this very case; --force computes it")
    else:
        with ProgressDisplay(console, quiet=quiet) as progress:
            result = run_case(words, folder, progress=progress)
    if not quiet:
        summary = summarise(result)
        console.print(Text(as_text(summary.title, summary_tables(summary))))
        show_notices(result.run.notices.notices())
        console.print(f"pictures: {folder.figures}\nfields:   {folder.static_fields.parent}")
        console.print(f"summary:  {folder.summary}\nresult:   {folder.result}")
    return ExitCode.DONE if result.static.converged else ExitCode.NOT_CONVERGED
