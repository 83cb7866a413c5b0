# SPDX-License-Identifier: LGPL-2.1-or-later
"""``quietblade new``: write a case file to start from."""

from pathlib import Path
from typing import Annotated

import typer

from quietblade.cli.common import console
from quietblade.errors import CaseError


def new(
    name: Annotated[str, typer.Argument(help="Name of the case; NAME.toml is written.")],
    preset: Annotated[
        str, typer.Option(help="paper-aluminium, paper-composite or twisted.")
    ] = "paper-aluminium",
    force: Annotated[bool, typer.Option("--force", help="Replace a file that is there.")] = False,
) -> None:
    """Write a case file with comments, to start from."""
    from quietblade.case.presets import PRESETS, preset_text  # noqa: PLC0415  # as in check

    text = preset_text(preset)
    path = Path(name if name.endswith(".toml") else f"{name}.toml")
    if path.exists() and not force:
        raise CaseError(f"{path} exists already. Choose another name, or replace it with --force")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    except OSError as error:
        raise CaseError(f"{path} cannot be written: {error.strerror}") from error
    console.print(f"{path}: {PRESETS[preset]}", markup=False)
    console.print(f"next: quietblade check {path}", markup=False)
