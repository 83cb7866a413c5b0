# SPDX-License-Identifier: LGPL-2.1-or-later
"""``quietblade new``: write a case file to start from."""

from pathlib import Path
from typing import Annotated

import typer

from quietblade.cli.common import console
from quietblade.cli.files import write_file, write_schema
from quietblade.errors import CaseError


def new(
    name: Annotated[
        str | None, typer.Argument(help="Name of the case; NAME.toml is written.")
    ] = None,
    preset: Annotated[
        str | None,
        typer.Option(help="paper-aluminium (the default), paper-composite, hydrofoil or twisted."),
    ] = None,
    schema: Annotated[
        bool,
        typer.Option(
            "--schema",
            help="Write the JSON schema beside it, by which editors complete and check keys; "
            "without NAME nothing else.",
        ),
    ] = False,
    force: Annotated[bool, typer.Option("--force", help="Replace a file that is there.")] = False,
) -> None:
    """Write a case file with comments, to start from."""
    from quietblade.case.presets import PRESETS, preset_text  # noqa: PLC0415  # as in check
    from quietblade.case.schema import DIRECTIVE  # noqa: PLC0415

    if schema and name is None:
        console.print(f"{write_schema(Path())}: schema of case files", markup=False)
        return
    if name is None:
        raise CaseError("new needs the NAME of a case to write")
    chosen = preset or next(iter(PRESETS))
    about, text = PRESETS.get(chosen, ""), preset_text(chosen)
    path = target(name, force=force)
    write_file(path, (DIRECTIVE if schema else "") + text)
    if schema:
        write_schema(path.parent)
    console.print(f"{path}: {about}", markup=False)
    console.print(f"next: quietblade check {path}", markup=False)


def target(name: str, *, force: bool) -> Path:
    """Path of the file that a case of this name gets.

    Raises
    ------
    CaseError
        The name is none, or the file is there and may not be replaced.
    """
    path = Path(name if name.endswith(".toml") else f"{name}.toml")
    if not name.strip() or path.name == ".toml":
        raise CaseError(f'"{name}" is no name of a file. Write for example my-blade')
    if path.exists() and not force:
        raise CaseError(f"{path} exists already. Choose another name, or replace it with --force")
    return path
