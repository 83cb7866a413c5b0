# SPDX-License-Identifier: LGPL-2.1-or-later
"""The log of a run in its folder."""

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from datetime import datetime
from pathlib import Path
from platform import node
from typing import TextIO

from quietblade import __version__
from quietblade.typing import Progress


@contextmanager
def logging_to(file: Path, progress: Progress) -> Iterator[Progress]:
    """Write every report into a file, behind what earlier runs have written there.

    Parameters
    ----------
    file : Path
        Its folder exists.
    progress : callable
        Called with each report too.

    Yields
    ------
    callable
        Progress callback that does both.
    """
    with _opened(file) as log:

        def write(text: str) -> None:
            with suppress(OSError):  # a full disk ends no run for a line of its log
                log.write(f"{datetime.now().astimezone().isoformat(timespec='seconds')} {text}\n")

        def report(stage: str, fraction: float | None, message: str) -> None:
            share = "" if fraction is None else f" {100.0 * fraction:3.0f} %"
            write(f"{stage}{share}: {message or 'begins'}")
            progress(stage, fraction, message)

        write(f"quietblade {__version__}, process {os.getpid()} on {node()}")
        try:
            yield report
        except BaseException as error:
            write(f"ended by {type(error).__name__}: {error}")
            raise
        write("done")


@contextmanager
def _opened(file: Path) -> Iterator[TextIO]:
    log = file.open("a", encoding="utf-8", buffering=1)  # a killed run keeps its lines
    try:
        yield log
    finally:
        with suppress(OSError):
            log.close()
