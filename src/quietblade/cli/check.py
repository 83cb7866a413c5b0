# SPDX-License-Identifier: LGPL-2.1-or-later
"""``quietblade check``: how a case file is understood and what a run of it will be like."""

from pathlib import Path
from typing import Annotated

import typer

from quietblade.cli.common import ExitCode, console, failure, show_json, show_notices, show_table
from quietblade.cli.files import write_file


def check(
    case: Annotated[Path, typer.Argument(help="Case file (TOML).")],
    migrate: Annotated[
        bool,
        typer.Option("--migrate", help="Rewrite an older file in the newest format first."),
    ] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Write JSON instead of tables.")] = False,
) -> int:
    """Say how a case file is understood, what a run will cost, and what the method assumes.

    Nothing heavy is computed. The exit code is 0 unless the case is wrong: warnings do not count.
    """
    # imported here, so that help does not wait for the words, nor a wrong case for the geometry
    from quietblade.case import InvalidCaseError, load_case  # noqa: PLC0415

    try:
        if migrate:
            _migrate(case)
        words = load_case(case)
        from quietblade.cli.describe import case_data, case_tables  # noqa: PLC0415
        from quietblade.cli.describe_outlook import outlook_tables  # noqa: PLC0415
        from quietblade.study.examine import examine  # noqa: PLC0415
        from quietblade.study.outlook import look_ahead  # noqa: PLC0415

        known = examine(words)
        ahead = look_ahead(words, known)
    except InvalidCaseError as error:
        if not as_json:
            raise
        show_json({"valid": False, **failure(error, ExitCode.CASE_WRONG)})
        return ExitCode.CASE_WRONG
    if as_json:
        show_json(case_data(words, known, ahead))
        return ExitCode.DONE
    console.print(f"{case}: {words.title or 'a case'}", markup=False, style="bold")
    for title, rows in (*case_tables(words, known), *outlook_tables(ahead)):
        show_table(title, rows)
    show_notices((*known.notices, *ahead.notices))
    return ExitCode.DONE


def _migrate(path: Path) -> None:
    from quietblade.case import parse_case  # noqa: PLC0415  # help must stay fast
    from quietblade.case.source import read_source  # noqa: PLC0415
    from quietblade.case.versions import migrated_text  # noqa: PLC0415

    old = read_source(path).text
    new = migrated_text(old, str(path))
    parse_case(new, str(path))  # what is not a case is left as it is
    if new != old:
        write_file(path.resolve(), new)
