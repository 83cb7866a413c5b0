# SPDX-License-Identifier: LGPL-2.1-or-later
"""Files that a user gets beside the results: cases and their schema."""

import json
from pathlib import Path

from quietblade.errors import CaseError
from quietblade.results.files import ResultError, write_text


def case_path(name: str, *, force: bool) -> Path:
    """Path of the file that a case of this name gets.

    Raises
    ------
    CaseError
        The name is none, or the file is there and may not be replaced.
    """
    path = Path(name if name.endswith(".toml") else f"{name}.toml")
    if not name.strip() or path.name == ".toml":
        raise CaseError(f'"{name}" is no name of a file. Write for example my-blade')
    if path.exists() and not force:
        raise CaseError(f"{path} exists already. Choose another name, or replace it with --force")
    return path


def write_file(path: Path, text: str) -> None:
    """Write a file as a whole or not at all.

    Raises
    ------
    CaseError
        It cannot be written.
    """
    try:
        write_text(path, text)
    except ResultError as error:
        raise CaseError(str(error)) from error
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        raise CaseError(f"{path} cannot be written: {reason}") from error


def write_schema(folder: Path) -> Path:
    """Write the JSON schema of case files into a folder, and return its path."""
    from quietblade.case.schema import SCHEMA_FILE, case_schema  # noqa: PLC0415  # heavy

    path = folder / SCHEMA_FILE
    write_file(path, json.dumps(case_schema(), indent=2, ensure_ascii=False) + "\n")
    return path
