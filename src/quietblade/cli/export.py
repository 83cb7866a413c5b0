# SPDX-License-Identifier: LGPL-2.1-or-later
"""``quietblade export``: a case or a run for other programs."""

import os
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from quietblade.cli.common import ExitCode, console, error_console, show_notices
from quietblade.cli.progress import ProgressDisplay
from quietblade.cli.written import Written, show_written
from quietblade.errors import CaseError

if TYPE_CHECKING:
    from quietblade.case import Case
    from quietblade.typing import Progress


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
    vtkhdf: Annotated[
        Path | None,
        typer.Option(help="Fields of the run as VTKHDF files, into a folder.", metavar="DIR"),
    ] = None,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Show errors only.")] = False,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print the files as JSON; progress goes to stderr.")
    ] = False,
) -> ExitCode:
    """Write a case or a run for other programs: deck, STEP, MSH, CSV, universal files, VTKHDF.

    The fields of a run are VTU files already, in its folder fields/.
    """
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    from quietblade.case import Case, load_case  # noqa: PLC0415  # help must stay fast

    run = source if source.is_dir() else None
    file = source if run is None else source / "case.toml"
    teller = error_console if as_json else console
    written: list[Written] = []

    def add(kind: str, files: Iterable[Path], said: str) -> None:
        written.extend(Written(kind, file) for file in files)
        if not quiet and not as_json:
            console.print(f"{kind}: {said}", soft_wrap=True)

    if csv is not None:
        tables = _csv(_run(run, source, "--csv"), csv)
        add("csv", tables, f"{len(tables)} files in {csv}, listed in {tables[-1].name}")
    if uff is not None:
        files = _uff(_run(run, source, "--uff"), uff)
        add("uff", files, ", ".join(map(str, files)))
    if vtkhdf is not None:
        files = _vtkhdf(_run(run, source, "--vtkhdf"), vtkhdf)
        add("vtkhdf", files, ", ".join(map(str, files)))
    if step is not None:
        from quietblade.study.export import export_step  # noqa: PLC0415

        export_step(Case.load(file), step)
        add("step", [step], str(step))
    if msh is not None:
        from quietblade.study.export import export_msh  # noqa: PLC0415

        export_msh(load_case(file), msh)
        add("msh", [msh], str(msh))
    equilibrium: dict[str, Any] = {}
    if out is not None or not written:
        out = out or Path(f"{source.resolve().stem}.inp")
        with ProgressDisplay(teller, quiet=quiet) as progress:
            equilibrium = _deck(Case.load(file), out, progress)
        add("deck", [out], str(out))
    if as_json:
        show_written(written, **equilibrium)
    elif equilibrium and not quiet:
        x, y, z = (1e3 * shift for shift in equilibrium["tip_displacement_m"])
        console.print(f"tip displacement to be found again: {x:.2f}, {y:.2f}, {z:.2f} mm")
    return ExitCode.DONE if equilibrium.get("converged", True) else ExitCode.NOT_CONVERGED


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


def _vtkhdf(run: Path, out: Path) -> tuple[Path, ...]:
    from quietblade.results.store import RunFolder  # noqa: PLC0415
    from quietblade.results.vtkhdf import write_vtkhdf  # noqa: PLC0415

    return write_vtkhdf(RunFolder(run), out)


def _deck(case: "Case", file: Path, progress: "Progress") -> dict[str, Any]:
    """Write a deck and say of its equilibrium what the other program should find again."""
    from quietblade.study.export import export_deck  # noqa: PLC0415

    state = export_deck(case, file, progress).state
    show_notices(state.notices)
    return {"tip_displacement_m": state.tip_displacement.tolist(), "converged": state.converged}
