# SPDX-License-Identifier: LGPL-2.1-or-later
"""``quietblade export``: the steady problem as an input deck of another program."""

import os
from pathlib import Path
from typing import Annotated

import typer

from quietblade.cli.common import ExitCode, console, show_notices
from quietblade.cli.progress import ProgressDisplay


def export(
    case: Annotated[Path, typer.Argument(help="Case file (TOML).")],
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="File to write; default NAME-OF-THE-CASE.inp."),
    ] = None,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Show errors only.")] = False,
) -> ExitCode:
    """Write blade, film and steady loads in equilibrium as a CalculiX or Abaqus deck."""
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    from quietblade.case import Case  # noqa: PLC0415  # help must stay fast
    from quietblade.study.export import export_deck  # noqa: PLC0415

    words = Case.load(case)
    file = out or Path(f"{case.stem}.inp")
    with ProgressDisplay(console, quiet=quiet) as progress:
        statics = export_deck(words, file, progress)
    if not quiet:
        x, y, z = 1e3 * statics.state.tip_displacement
        console.print(f"deck: {file}")
        console.print(f"tip displacement to be found again: {x:.2f}, {y:.2f}, {z:.2f} mm")
        show_notices(statics.state.notices)
    return ExitCode.DONE if statics.state.converged else ExitCode.NOT_CONVERGED
