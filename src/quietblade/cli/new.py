# SPDX-License-Identifier: LGPL-2.1-or-later
"""``quietblade new``: write a case file to start from."""

import sys
from pathlib import Path
from typing import Annotated

import typer

from quietblade.cli.common import console
from quietblade.cli.files import case_path, write_file, write_schema
from quietblade.cli.written import Written, show_written
from quietblade.errors import CaseError


def new(
    name: Annotated[
        str | None, typer.Argument(help="Name of the case; NAME.toml is written.")
    ] = None,
    preset: Annotated[
        str | None,
        typer.Option(
            help="paper-aluminium (the default), paper-composite, hydrofoil, twisted or sphere."
        ),
    ] = None,
    ask: Annotated[
        bool, typer.Option("--ask", help="Ask for the main values; so does no NAME at a terminal.")
    ] = False,
    schema: Annotated[
        bool,
        typer.Option(
            "--schema",
            help="Write the JSON schema beside it, by which editors complete and check keys; "
            "without NAME nothing else.",
        ),
    ] = False,
    force: Annotated[bool, typer.Option("--force", help="Replace a file that is there.")] = False,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print the files as JSON; nothing is asked.")
    ] = False,
) -> None:
    """Write a case file with comments, to start from."""
    from quietblade.case.presets import PRESETS, preset_text  # noqa: PLC0415  # as in check
    from quietblade.case.schema import DIRECTIVE  # noqa: PLC0415

    if ask and as_json:
        raise typer.BadParameter("--ask needs somebody to answer, --json a program: not together")
    if schema and name is None and not ask:
        file = write_schema(Path())
        if as_json:
            show_written([Written("schema", file)])
        else:
            console.print(f"{file}: schema of case files", markup=False)
        return
    if ask or (name is None and not as_json and sys.stdin.isatty()):
        from quietblade.cli.questions import ask_case  # noqa: PLC0415

        path, text = ask_case(name, preset, force=force)
        about = "from your answers"
    elif name is None:
        raise CaseError("new needs the NAME of a case to write, or --ask to be asked for it")
    else:
        preset = preset or next(iter(PRESETS))
        text, path = preset_text(preset), case_path(name, force=force)
        about = PRESETS[preset]
    write_file(path, (DIRECTIVE if schema else "") + text)
    made = [Written("case", path)]
    if schema:
        made.append(Written("schema", write_schema(path.parent)))
    if as_json:
        show_written(made)
    else:
        console.print(f"{path}: {about}", markup=False)
        console.print(f"next: quietblade check {path}", markup=False)
