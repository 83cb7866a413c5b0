# SPDX-License-Identifier: LGPL-2.1-or-later
"""``quietblade run``: from a case file to a result folder."""

import os
from pathlib import Path
from typing import Annotated

import typer

from quietblade.cli.common import ExitCode, StoppedError, console, error_console, show_json
from quietblade.cli.progress import ProgressDisplay
from quietblade.cli.tables import show_tables


def run(
    case: Annotated[Path, typer.Argument(help="Case file (TOML).")],
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="Folder of the run; default runs/NAME-OF-THE-CASE."),
    ] = None,
    force: Annotated[
        bool, typer.Option("--force", help="Compute all stages, whatever an earlier run has kept.")
    ] = False,
    keep: Annotated[
        bool,
        typer.Option(
            help="Keep what each stage makes in the folder, so that the next run can go on from it."
        ),
    ] = True,
    brief: Annotated[
        bool, typer.Option("--brief", help="Leave out the tables; `quietblade show` prints them.")
    ] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Show errors only.")] = False,
    verbose: Annotated[
        bool, typer.Option("--verbose", "-v", help="Show every step; run.log has them all.")
    ] = False,
    as_json: Annotated[
        bool,
        typer.Option("--json", help="Print what `show --json` prints; progress goes to stderr."),
    ] = False,
) -> ExitCode:
    """Compute a case: deformation, wet modes and radiated sound.

    A run that was stopped goes on from the last stage that it had finished, and a case that has
    changed is computed again only from where the change matters.
    """
    # many small dense systems: threads of the BLAS would only fight with those of the solvers
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    from quietblade.case import load_case  # noqa: PLC0415  # help must stay fast
    from quietblade.results.headline import summarise  # noqa: PLC0415
    from quietblade.results.store import RunFolder  # noqa: PLC0415
    from quietblade.results.tables import summary_tables  # noqa: PLC0415
    from quietblade.study.run import by_other_code, finished, run_case  # noqa: PLC0415
    from quietblade.view.figures import draw_figures  # noqa: PLC0415

    words = load_case(case)
    folder = RunFolder(out or Path("runs") / case.stem)
    teller = error_console if as_json else console
    if not force and (result := finished(words, folder)) is not None:
        if not quiet:
            older = ", by other code than is installed" if by_other_code(words, folder) else ""
            teller.print(
                f"{folder.root} holds the result of this very case{older}; --force computes it"
            )
    else:
        try:
            with ProgressDisplay(teller, quiet=quiet, verbose=verbose) as progress:
                result = run_case(words, folder, progress, force=force, keep=keep)
                draw_figures(folder, progress)
        except KeyboardInterrupt as stop:
            kept = "; what was finished is kept, and the same command goes on from there"
            raise StoppedError(f"stopped{kept if keep else ''}") from stop
    if as_json:
        show_json(summarise(result).model_dump(mode="json"))
    elif not quiet:
        if not brief:
            summary = summarise(result)
            show_tables(summary.title, summary_tables(summary))
        console.print(f"pictures: {folder.figures}\nfields:   {folder.result.parent / 'fields'}")
        console.print(f"summary:  {folder.summary}\nresult:   {folder.result}")
    return ExitCode.DONE if result.converged else ExitCode.NOT_CONVERGED
