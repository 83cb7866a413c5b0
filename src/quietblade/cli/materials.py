# SPDX-License-Identifier: LGPL-2.1-or-later
"""``quietblade materials``: the library of named materials."""

from typing import Annotated

import typer

from quietblade.cli.common import ExitCode, console, show_json
from quietblade.errors import CaseError


def materials(
    name: Annotated[
        str | None, typer.Argument(help="Material to show whole; all in short if left out.")
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Write JSON instead of tables.")] = False,
) -> ExitCode:
    """List the named materials with their sources; constants are in SI units."""
    from quietblade.case.library import (  # noqa: PLC0415  # help must stay fast
        LAW_OF,
        NAMES,
        NOTE_OF,
        SOURCE_OF,
        library_material,
    )
    from quietblade.case.problems import suggestion  # noqa: PLC0415

    if name is not None and name not in NAMES:
        raise CaseError(
            f'there is no material "{name}" in the library. {suggestion(name, NAMES)} '
            f"Known: {', '.join(NAMES)}"
        )
    chosen = NAMES if name is None else (name,)
    if as_json:
        constants = {n: library_material(n).model_dump(mode="json") for n in chosen}
        about = {n: {"source": SOURCE_OF[n], "note": NOTE_OF[n]} for n in chosen}
        show_json({n: constants[n] | about[n] for n in chosen})
        return ExitCode.DONE
    for entry in chosen:
        console.print(f"{entry} ({LAW_OF[entry]})", markup=False, style="bold")
        console.print(f"  source: {SOURCE_OF[entry]}", markup=False)
        console.print(f"  note:   {NOTE_OF[entry]}", markup=False)
        if name is not None:
            plain = library_material(entry).model_dump(
                mode="json", exclude_none=True, exclude={"law", "source"}
            )
            for key, value in plain.items():
                console.print(f"  {key} = {value}", markup=False)
    return ExitCode.DONE
