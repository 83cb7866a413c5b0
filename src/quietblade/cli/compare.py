# SPDX-License-Identifier: LGPL-2.1-or-later
"""``quietblade compare``: differences between two runs."""

from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer

from quietblade.cli.common import ExitCode, show_json, show_notices
from quietblade.cli.tables import show_tables


def compare(
    first: Annotated[Path, typer.Argument(help="Folder of a run.")],
    second: Annotated[Path, typer.Argument(help="Folder of another run.")],
    as_json: Annotated[
        bool, typer.Option("--json", help="Print a list of differences as JSON.")
    ] = False,
) -> ExitCode:
    """Show how the headline figures of two runs differ; modes are matched by name."""
    from quietblade.results.comparison import (  # noqa: PLC0415  # help must stay fast
        compare_summaries,
        comparison_table,
        exchanged_names,
    )
    from quietblade.results.headline import summarise  # noqa: PLC0415
    from quietblade.results.store import RunFolder  # noqa: PLC0415

    a, b = (summarise(RunFolder(directory).load()) for directory in (first, second))
    differences = compare_summaries(a, b)
    if as_json:
        show_json([{**asdict(d), "change": d.change, "relative": d.relative} for d in differences])
    else:
        table = comparison_table(differences, (first.name, second.name))
        show_tables(f"{a.title} - {b.title}", [table])
    show_notices(exchanged_names(a, b))
    return ExitCode.DONE
