# SPDX-License-Identifier: LGPL-2.1-or-later
"""``quietblade plot``: draw the figures of runs from their files."""

from pathlib import Path
from typing import Annotated

import typer

from quietblade.cli.common import ExitCode, console
from quietblade.cli.progress import ProgressDisplay


def plot(
    directories: Annotated[
        list[Path], typer.Argument(help="Folders of runs; several are also drawn together.")
    ],
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", "-o", help="Folder of the joint figures; default figures/ beside the first."
        ),
    ] = None,
    joint: Annotated[bool, typer.Option("--joint", help="Draw the joint figures only.")] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Show errors only.")] = False,
) -> ExitCode:
    """Draw the figures of runs again; nothing is computed."""
    from quietblade.results.store import RunFolder  # noqa: PLC0415  # help must stay fast
    from quietblade.view.figures import draw_figures, draw_joint_figures  # noqa: PLC0415

    if joint and len(directories) < 2:
        raise typer.BadParameter("--joint needs the folders of at least two runs")
    folders = [RunFolder(directory) for directory in directories]
    drawn: list[Path] = []
    with ProgressDisplay(console, quiet=quiet) as progress:
        for folder in () if joint else folders:
            drawn += draw_figures(folder, progress)
        if len(folders) > 1:
            together = out or directories[0].parent / "figures"
            drawn += draw_joint_figures(folders, together, progress)
    if not quiet:
        for place in dict.fromkeys(file.parent for file in drawn):
            console.print(f"pictures: {place}", soft_wrap=True)
    return ExitCode.DONE
