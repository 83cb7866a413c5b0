# SPDX-License-Identifier: LGPL-2.1-or-later
"""``quietblade show``: the headline figures of a run."""

from pathlib import Path
from typing import Annotated

import typer

from quietblade.cli.common import ExitCode, error_console, show_json
from quietblade.cli.tables import show_tables


def show(
    directory: Annotated[Path, typer.Argument(help="Folder of a run or of a study.")],
    as_json: Annotated[
        bool, typer.Option("--json", help="Print JSON (docs: result-schema) and nothing else.")
    ] = False,
) -> ExitCode:
    """Show the headline figures of a run, or the tables of a study."""
    if (directory / "study.nc").is_file():
        from quietblade.cli.study import show_study  # noqa: PLC0415

        return show_study(directory, as_json=as_json)
    from quietblade.results.headline import summarise  # noqa: PLC0415  # help must stay fast
    from quietblade.results.store import RunFolder  # noqa: PLC0415
    from quietblade.results.tables import summary_tables  # noqa: PLC0415

    folder = RunFolder(directory)
    summary = summarise(folder.load())
    if folder.overtaken():
        error_console.print(
            f"{directory}: a later run has not finished; these are the figures of the one before"
        )
    if as_json:
        show_json(summary.model_dump(mode="json"))
    else:
        show_tables(summary.title, summary_tables(summary))
    return ExitCode.DONE
