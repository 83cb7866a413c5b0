# SPDX-License-Identifier: LGPL-2.1-or-later
"""``quietblade report``: one HTML file to hand on."""

from pathlib import Path
from typing import Annotated

import typer

from quietblade.cli.common import ExitCode, console
from quietblade.cli.progress import ProgressDisplay


def report(
    directory: Annotated[Path, typer.Argument(help="Folder of a run.")],
    out: Annotated[
        Path | None, typer.Option("--out", "-o", help="File; default report.html in the folder.")
    ] = None,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Show errors only.")] = False,
) -> ExitCode:
    """Write a report of a run as one self-contained HTML file."""
    from quietblade.results.files import write_text  # noqa: PLC0415  # help must stay fast
    from quietblade.results.store import RunFolder  # noqa: PLC0415
    from quietblade.view.report import render_report  # noqa: PLC0415

    file = out or directory / "report.html"
    with ProgressDisplay(console, quiet=quiet) as progress:
        page = render_report(RunFolder(directory), progress)
    write_text(file, page)
    if not quiet:
        console.print(f"report: {file}", soft_wrap=True)
    return ExitCode.DONE
