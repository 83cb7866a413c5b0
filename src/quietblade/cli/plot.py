# SPDX-License-Identifier: LGPL-2.1-or-later
"""``quietblade plot``: draw the figures of runs from their files."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from quietblade.cli.common import ExitCode, console, error_console
from quietblade.cli.progress import ProgressDisplay
from quietblade.cli.written import Written, show_written


class Format(StrEnum):
    """Kind of the files of figures."""

    PNG = "png"
    PDF = "pdf"
    SVG = "svg"
    GIF = "gif"
    MP4 = "mp4"


_MOVING = (Format.GIF, Format.MP4)


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
    formats: Annotated[
        list[Format] | None,
        typer.Option(
            "--format",
            "-f",
            help="Kind of files, may be repeated: png (default), pdf, svg; of moving pictures "
            "gif (default), mp4.",
            show_default=False,
        ),
    ] = None,
    animate: Annotated[
        bool,
        typer.Option("--animate", help="Draw moving pictures of deformation and modes instead."),
    ] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Show errors only.")] = False,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print the files as JSON; progress goes to stderr.")
    ] = False,
) -> ExitCode:
    """Draw the figures of runs again; nothing is computed."""
    from quietblade.results.store import RunFolder  # noqa: PLC0415  # help must stay fast
    from quietblade.view.animation import draw_animations  # noqa: PLC0415
    from quietblade.view.figures import draw_figures, draw_joint_figures  # noqa: PLC0415

    if joint and len(directories) < 2:
        raise typer.BadParameter("--joint needs the folders of at least two runs")
    if animate and joint:
        raise typer.BadParameter("--animate draws single runs: no --joint")
    kinds = formats or [Format.GIF if animate else Format.PNG]
    wrong = [kind.value for kind in kinds if (kind in _MOVING) != animate]
    if wrong:
        known = [kind.value for kind in Format if (kind in _MOVING) == animate]
        raise typer.BadParameter(
            f"{', '.join(wrong)}: {'moving' if animate else 'still'} pictures are "
            f"{', '.join(known)}{'' if animate else '; --animate draws moving ones'}"
        )
    folders = [RunFolder(directory) for directory in directories]
    drawn: list[Path] = []
    with ProgressDisplay(error_console if as_json else console, quiet=quiet) as progress:
        if animate:
            for folder in folders:
                drawn += draw_animations(folder, folder.load(), progress, kinds)
        else:
            for folder in () if joint else folders:
                drawn += draw_figures(folder, progress, kinds)
            if len(folders) > 1:
                together = out or directories[0].parent / "figures"
                drawn += draw_joint_figures(folders, together, progress, kinds)
    if as_json:
        kind = "animation" if animate else "figure"
        show_written(Written(kind, file) for file in drawn)
    elif not quiet:
        for place in dict.fromkeys(file.parent for file in drawn):
            console.print(f"pictures: {place}", soft_wrap=True)
    return ExitCode.DONE
