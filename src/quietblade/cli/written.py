# SPDX-License-Identifier: LGPL-2.1-or-later
"""Files that a command has written, as ``--json`` tells them: one shape for all commands."""

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from quietblade.cli.common import show_json


@dataclass(frozen=True)
class Written:
    """One file that a command has made.

    Attributes
    ----------
    kind : str
        What it holds: ``case``, ``figure``, ``report``, ``step`` ...; its suffix tells the format.
    path : Path
    """

    kind: str
    path: Path


def show_written(files: Iterable[Written], **more: Any) -> None:
    """Write the files of a command to standard output as JSON.

    Parameters
    ----------
    files : iterable of Written
    **more
        What else the command has to say.
    """
    rows = [
        {"kind": file.kind, "path": str(file.path), "bytes": file.path.stat().st_size}
        for file in files
    ]
    show_json({"files": rows, **more})
