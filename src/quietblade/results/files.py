# SPDX-License-Identifier: LGPL-2.1-or-later
"""Files that are either whole or not there."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from quietblade.errors import QuietbladeError


class ResultError(QuietbladeError):
    """A result cannot be stored, found or understood."""


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Give a temporary path to write to; it takes the place of ``path`` only if all went well.

    Parameters
    ----------
    path : Path
        File to make or replace; its folder is made if it is missing.

    Yields
    ------
    Path
        Hidden file in the same folder with the same suffix.

    Raises
    ------
    ResultError
        What is there is no regular file: a device, for instance, must not become one.
    """
    if path.exists() and not path.is_file():
        raise ResultError(f"{path} is not a file that could be replaced. Name another")
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f".{os.getpid()}-{path.name}")
    try:
        yield temporary
        with temporary.open("rb+") as file:
            os.fsync(file.fileno())  # the content before the name
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)


def write_text(path: Path, text: str) -> None:
    """Write a text file, whole or not at all."""
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8")
