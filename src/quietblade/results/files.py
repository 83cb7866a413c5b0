# SPDX-License-Identifier: LGPL-2.1-or-later
"""Files that are either whole or not there."""

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from quietblade.errors import QuietbladeError


class ResultError(QuietbladeError):
    """A result cannot be stored, found or understood."""


class WriteError(ResultError, OSError):
    """A file could not be written, as on a full disk; there is none, or still the old one.

    Parameters
    ----------
    path : Path
        The file.
    cause : OSError
        Why.
    """

    def __init__(self, path: Path, cause: OSError) -> None:
        super().__init__(cause.errno, cause.strerror or str(cause), str(path))
        self._path = path

    def __str__(self) -> str:
        return (
            f"{self._path.parent}: {self._path.name} cannot be written: {self.strerror}. Make room "
            "there, or see that you may write there, and give the same command again: what is "
            "finished is kept"
        )


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
    WriteError
        The file cannot be written, whichever part of it.
    """
    temporary = path.with_name(f".{os.getpid()}-{path.name}")
    try:
        if path.exists() and not path.is_file():
            raise ResultError(f"{path} is not a file that could be replaced. Name another")
        path.parent.mkdir(parents=True, exist_ok=True)
        yield temporary
        with temporary.open("rb+") as file:
            os.fsync(file.fileno())  # the content before the name
        temporary.replace(path)
    except (FileNotFoundError, WriteError):
        raise
    except OSError as error:
        raise WriteError(path, error) from error
    finally:
        with suppress(OSError):
            temporary.unlink(missing_ok=True)


def remove_leftovers(folder: Path) -> None:
    """Remove what killed processes have left half-written in a folder; none may be at work."""
    for file in folder.glob(".[0-9]*-*"):
        file.unlink(missing_ok=True)


def write_text(path: Path, text: str) -> None:
    """Write a text file, whole or not at all."""
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8")
