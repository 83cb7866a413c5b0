# SPDX-License-Identifier: LGPL-2.1-or-later
"""One run at a time in a folder."""

import os
import sqlite3
from collections.abc import Iterator
from contextlib import closing, contextmanager, suppress
from datetime import datetime
from pathlib import Path
from platform import node

from quietblade.results.files import ResultError, write_text

_LOCK = ".lock.sqlite"
_HOLDER = ".lock.txt"


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Keep other processes from working in a folder; it is made if it is missing.

    The lock is SQLite's on a file, which is the same on all systems and which the system gives
    back when the process ends, however it ends: no lock is ever stale.

    Raises
    ------
    ResultError
        Another process holds the lock; says which.
    """
    folder.mkdir(parents=True, exist_ok=True)
    holder = folder / _HOLDER
    with closing(sqlite3.connect(folder / _LOCK, timeout=0.0, isolation_level=None)) as file:
        try:
            file.execute("BEGIN EXCLUSIVE")
        except sqlite3.OperationalError as error:
            raise ResultError(_refusal(folder, holder, error)) from error
        try:
            now = datetime.now().astimezone().isoformat(sep=" ", timespec="seconds")
            write_text(holder, f"process {os.getpid()} on {node()} since {now}\n")
            yield
        finally:
            holder.unlink(missing_ok=True)


def _refusal(folder: Path, holder: Path, error: sqlite3.OperationalError) -> str:
    if "locked" not in str(error):
        return f"{folder}: cannot be locked for a run ({error}); is it writable?"
    who = "another process"
    with suppress(OSError):
        who = holder.read_text(encoding="utf-8").strip() or who
    return f"{folder}: a run is at work here ({who}); wait for it, or choose another folder (--out)"
