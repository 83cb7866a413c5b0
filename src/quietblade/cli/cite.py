# SPDX-License-Identifier: LGPL-2.1-or-later
"""``quietblade cite``: what to cite for a run."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from quietblade import __version__
from quietblade.cli.common import ExitCode, console, show_json

if TYPE_CHECKING:
    from quietblade.case import AnyCase


def cite(
    what: Annotated[Path, typer.Argument(help="Folder of a run, or a case file.")],
    bibtex: Annotated[bool, typer.Option("--bibtex", help="Print a bibliography.")] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print a list of references.")] = False,
) -> ExitCode:
    """List what to cite: the program, the two-step paper, and what this run used."""
    from quietblade.study.citations import citations, program  # noqa: PLC0415  # help must stay fast

    case, version = _case(what)
    found = citations(case)
    if as_json:
        rows: list[tuple[str | None, ...]] = [
            ("program", "quietblade", program(version), _software(version))
        ]
        for c in found:
            key, entry = (c.reference.key, c.reference.bibtex) if c.reference else (None, None)
            rows.append((c.why, key, c.text, entry))
        show_json([dict(zip(("why", "key", "text", "bibtex"), row, strict=True)) for row in rows])
    elif bibtex:
        console.print(_software(version), markup=False, soft_wrap=True)
        for c in found:
            if c.reference is None:
                console.print(f"\n% {c.why}: {c.text}", markup=False, soft_wrap=True)
            else:
                text = f"\n% {c.why}\n{c.reference.bibtex}"
                console.print(text, markup=False, soft_wrap=True)
    else:
        console.print(f"program\n  {program(version)}", markup=False, soft_wrap=True)
        for c in found:
            console.print(f"{c.why}\n  {c.text}", markup=False, soft_wrap=True)
    return ExitCode.DONE


def _case(what: Path) -> "tuple[AnyCase, str]":
    """Case of a run, or of a file, and the version that computed it."""
    from quietblade.case import load_case, parse_case  # noqa: PLC0415  # help must stay fast

    if what.is_file():
        return load_case(what), __version__
    from quietblade.results.store import RunFolder  # noqa: PLC0415

    folder = RunFolder(what)
    run = folder.load().run
    return parse_case(run.case_text, str(folder.case)), run.code_version


def _software(version: str) -> str:
    return (
        "@software{quietblade,\n"
        "  author = {{The quietblade developers}},\n"
        "  title = {quietblade: flexible propeller blades in water},\n"
        f"  version = {{{version}}}\n"
        "}"
    )
