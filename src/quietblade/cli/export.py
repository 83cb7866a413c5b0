# SPDX-License-Identifier: LGPL-2.1-or-later
"""``quietblade export``: a case or a run for other programs."""

import os
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from quietblade.cli.common import ExitCode, console, show_notices
from quietblade.cli.progress import ProgressDisplay
from quietblade.errors import CaseError

if TYPE_CHECKING:
    from quietblade.case import Case


def export(
    source: Annotated[
        Path, typer.Argument(help="Case file (TOML), or folder of a run.", metavar="CASE_OR_RUN")
    ],
    out: Annotated[
        Path | None,
        typer.Option(
            "--out",
            "-o",
            help="Steady problem as a CalculiX or Abaqus deck; without any option NAME.inp.",
            metavar="FILE.inp",
        ),
    ] = None,
    step: Annotated[
        Path | None,
        typer.Option(help="Solids of blade and film, in mm.", metavar="FILE.step"),
    ] = None,
    msh: Annotated[
        Path | None,
        typer.Option(help="Mesh of the solid and the water for gmsh.", metavar="FILE.msh"),
    ] = None,
    csv: Annotated[
        Path | None,
        typer.Option(help="Every array of the run as tables, into a folder.", metavar="DIR"),
    ] = None,
    uff: Annotated[
        Path | None,
        typer.Option(
            help="Modes and functions of the run as universal files, into a folder.", metavar="DIR"
        ),
    ] = None,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Show errors only.")] = False,
) -> ExitCode:
    """Write a case or a run for other programs: deck, STEP, MSH, CSV, universal files.

    The fields of a run are VTU files already, in its folder fields/.
    """
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    from quietblade.case import Case, load_case  # noqa: PLC0415  # help must stay fast

    run = source if source.is_dir() else None
    file = source if run is None else source / "case.toml"
    written = []
    if csv is not None:
        tables = _csv(_run(run, source, "--csv"), csv)
        written.append(f"csv: {len(tables)} files in {csv}, listed in {tables[-1].name}")
    if uff is not None:
        files = _uff(_run(run, source, "--uff"), uff)
        written.append(f"uff: {', '.join(map(str, files))}")
    if step is not None:
        from quietblade.study.export import export_step  # noqa: PLC0415

        export_step(Case.load(file), step)
        written.append(f"step: {step}")
    if msh is not None:
        from quietblade.study.export import export_msh  # noqa: PLC0415

        export_msh(load_case(file), msh)
        written.append(f"msh: {msh}")
    if not quiet:
        for line in written:
            console.print(line, soft_wrap=True)
    if out is None and written:
        return ExitCode.DONE
    return _deck(Case.load(file), out or Path(f"{source.resolve().stem}.inp"), quiet=quiet)


def _run(run: Path | None, source: Path, option: str) -> Path:
    if run is None:
        raise CaseError(
            f"{source}: {option} needs results; give the folder of a finished run, or make one "
            f"with `quietblade run {source}`"
        )
    return run


def _csv(run: Path, out: Path) -> tuple[Path, ...]:
    from quietblade.results.curves import write_curves  # noqa: PLC0415
    from quietblade.results.store import RunFolder  # noqa: PLC0415

    return write_curves(RunFolder(run).load(), out)


def _uff(run: Path, out: Path) -> tuple[Path, ...]:
    from quietblade.results.store import RunFolder  # noqa: PLC0415
    from quietblade.results.uff import write_uff  # noqa: PLC0415

    return write_uff(RunFolder(run), out)


def _deck(case: "Case", file: Path, *, quiet: bool) -> ExitCode:
    from quietblade.study.export import export_deck  # noqa: PLC0415

    with ProgressDisplay(console, quiet=quiet) as progress:
        statics = export_deck(case, file, progress)
    if not quiet:
        x, y, z = 1e3 * statics.state.tip_displacement
        console.print(f"deck: {file}")
        console.print(f"tip displacement to be found again: {x:.2f}, {y:.2f}, {z:.2f} mm")
        show_notices(statics.state.notices)
    return ExitCode.DONE if statics.state.converged else ExitCode.NOT_CONVERGED
