# SPDX-License-Identifier: LGPL-2.1-or-later
"""Progress of long work: a live line on a terminal, plain lines elsewhere."""

from time import monotonic
from types import TracebackType
from typing import Self

from rich.console import Console
from rich.progress import (
    BarColumn,
    Progress,
    SpinnerColumn,
    TaskID,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)

_LINE_EVERY = 10.0
"""Seconds between plain lines of one stage."""


class ProgressDisplay:
    """Shows what `quietblade.typing.Progress` callbacks report.

    Parameters
    ----------
    console : rich.console.Console
        Where to write.
    quiet : bool
        Write nothing.
    verbose : bool
        Write a line for every report.
    """

    def __init__(self, console: Console, *, quiet: bool = False, verbose: bool = False) -> None:
        self._console = console
        self._quiet = quiet
        self._verbose = verbose
        self._live = console.is_terminal and not quiet and not verbose
        self._bars = Progress(
            SpinnerColumn(finished_text="[green]done[/]"),
            TextColumn("{task.description:<22}"),
            BarColumn(bar_width=24),
            TimeElapsedColumn(),
            TextColumn("left"),
            TimeRemainingColumn(),
            TextColumn("{task.fields[message]}"),
            console=console,
        )
        self._tasks: dict[str, TaskID] = {}
        self._started: dict[str, float] = {}
        self._last_line = 0.0

    def __enter__(self) -> Self:
        if self._live:
            self._bars.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._live:
            self._bars.stop()

    def __call__(self, stage: str, fraction: float | None, message: str) -> None:
        """Take one report."""
        if self._live:
            self._show_bar(stage, fraction, message)
        elif not self._quiet:
            self._write_line(stage, fraction, message)

    def _show_bar(self, stage: str, fraction: float | None, message: str) -> None:
        if stage not in self._tasks:
            self._tasks[stage] = self._bars.add_task(stage, total=None, message="")
        task = self._tasks[stage]
        if fraction is not None and fraction > 0.0:
            self._bars.update(task, total=1.0, completed=fraction, message=message)
        else:
            self._bars.update(task, message=message)

    def _write_line(self, stage: str, fraction: float | None, message: str) -> None:
        now = monotonic()
        ends = fraction == 1.0
        if stage not in self._started:
            self._started[stage] = now
        elif not ends and not self._verbose and now - self._last_line < _LINE_EVERY:
            return
        self._last_line = now
        line = f"{stage}: {message or '...'}{self._left(stage, fraction, now)}"
        self._console.print(line, soft_wrap=True)

    def _left(self, stage: str, fraction: float | None, now: float) -> str:
        if fraction is None or not 0.0 < fraction < 1.0:
            return ""
        spent = now - self._started[stage]
        return f" ({100 * fraction:.0f} %, about {spent * (1 / fraction - 1):.0f} s left)"
