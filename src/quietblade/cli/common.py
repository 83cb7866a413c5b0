# SPDX-License-Identifier: LGPL-2.1-or-later
"""What all commands share: consoles, exit codes, and how errors are shown."""

import json
import sys
from enum import IntEnum
from typing import Any

from rich.console import Console
from rich.table import Table
from rich.text import Text

from quietblade.errors import CaseError, Notice, QuietbladeError

_UNWATCHED_WIDTH = 140
"""Width of tables that go into a file or a pipe."""

console = Console(highlight=False, width=None if sys.stdout.isatty() else _UNWATCHED_WIDTH)
"""Results, on standard output."""

error_console = Console(stderr=True, highlight=False)
"""Errors and notices, on standard error."""


class ExitCode(IntEnum):
    """How a command ended."""

    DONE = 0
    CASE_WRONG = 1
    NOT_CONVERGED = 2
    FAILED = 3
    STOPPED = 130


def show_error(error: QuietbladeError) -> ExitCode:
    """Show an error and return the exit code that belongs to it.

    A `CaseError` (and a wrong command line) is 1, every other failure 3. A command that kept an
    unconverged result ends itself with `ExitCode.NOT_CONVERGED`.
    """
    wrong = isinstance(error, CaseError)
    lines = str(error).splitlines() or [type(error).__name__]
    if len(lines) > 1:
        error_console.print(Text(f"{len(lines)} problems", style="bold red"))
    for line in lines:
        error_console.print(_error_line(line), soft_wrap=True)
    return ExitCode.CASE_WRONG if wrong else ExitCode.FAILED


def _error_line(line: str) -> Text:
    return Text.assemble(("error ", "bold red"), line)


def show_notices(notices: tuple[Notice, ...]) -> None:
    """List notices on standard error."""
    for notice in notices:
        error_console.print(Text.assemble(("notice ", "bold yellow"), str(notice)), soft_wrap=True)


def show_table(title: str, rows: list[tuple[str, str]]) -> None:
    """Show names and values side by side."""
    table = Table(
        title=title, title_justify="left", title_style="bold", show_header=False, box=None
    )
    table.add_column(style="cyan", no_wrap=True)
    table.add_column()
    for name, value in rows:
        table.add_row(Text(name), Text(value))
    console.print(table)


def show_json(data: Any) -> None:
    """Write JSON to standard output and nothing else."""
    sys.stdout.write(json.dumps(data, indent=2, ensure_ascii=False, allow_nan=False) + "\n")
