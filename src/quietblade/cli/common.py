# SPDX-License-Identifier: LGPL-2.1-or-later
"""What all commands share: consoles, exit codes, and how errors are shown."""

import json
import sys
from enum import IntEnum
from math import isfinite
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
    """How a command ended; the page "On the command line" has the same table."""

    DONE = 0
    CASE_WRONG = 1
    NOT_CONVERGED = 2
    FAILED = 3
    STOPPED = 130

    @property
    def meaning(self) -> str:
        """What it says, in words."""
        return _MEANING[self]


_MEANING = {
    ExitCode.DONE: "done",
    ExitCode.CASE_WRONG: "wrong case or command",
    ExitCode.NOT_CONVERGED: "not converged but kept",
    ExitCode.FAILED: "failed",
    ExitCode.STOPPED: "stopped by Ctrl-C",
}

EXIT_CODES = f"Exit codes: {', '.join(f'{code} {code.meaning}' for code in ExitCode)}."
"""All of them in one line, for the help."""


class StoppedError(QuietbladeError):
    """The user has stopped a command; the text says what becomes of what was finished."""


def show_error(error: Exception, *, as_json: bool = False) -> ExitCode:
    """Show an error and return the exit code that belongs to it.

    A `CaseError` (and a wrong command line) is 1, every other failure 3. A command that kept an
    unconverged result ends itself with `ExitCode.NOT_CONVERGED`.

    Parameters
    ----------
    error : Exception
    as_json : bool
        Write it to standard output as JSON too.
    """
    code = ExitCode.CASE_WRONG if isinstance(error, CaseError) else ExitCode.FAILED
    _show_lines(str(error).splitlines() or [type(error).__name__])
    if as_json:
        show_json(failure(error, code))
    return code


def show_stop(said: str, *, as_json: bool) -> ExitCode:
    """Say that a command was stopped."""
    error_console.print(said, markup=False, soft_wrap=True)
    if as_json:
        show_json(failure(StoppedError(said), ExitCode.STOPPED))
    return ExitCode.STOPPED


def _show_lines(lines: list[str]) -> None:
    """Write what is wrong to standard error."""
    if len(lines) > 1:
        error_console.print(Text(f"{len(lines)} problems", style="bold red"))
    for line in lines:
        error_console.print(_error_line(line), soft_wrap=True)


def failure(error: Exception, code: ExitCode) -> dict[str, Any]:
    """Return what ``--json`` writes when a command fails: the exit code, and the problems."""
    lines = str(error).splitlines() or [type(error).__name__]
    # of an `InvalidCaseError`, whose module is too heavy to be imported for it
    problems = getattr(error, "problems", None)
    if problems is None:
        found = [{"message": line} for line in lines]
    else:
        found = [problem.as_dict() for problem in problems]
    return {"exit_code": int(code), "problems": found}


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
    """Write JSON to standard output and nothing else; what is not finite is null."""
    sys.stdout.write(json.dumps(_plain(data), indent=2, ensure_ascii=False, allow_nan=False) + "\n")


def _plain(data: Any) -> Any:
    """JSON has no NaN."""
    if isinstance(data, dict):
        return {key: _plain(value) for key, value in data.items()}
    if isinstance(data, list | tuple):
        return [_plain(value) for value in data]
    if isinstance(data, float) and not isfinite(data):
        return None
    return data
