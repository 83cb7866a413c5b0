# SPDX-License-Identifier: LGPL-2.1-or-later
"""The text that a case came from, so that every message can point into it."""

import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path as FilePath
from typing import Any

from quietblade.case.lines import locate_lines
from quietblade.case.problems import InvalidCaseError, Path, Problem, dotted, shortened, shown

_ABSENT = object()
_TOML_PLACE = re.compile(r" \(at (?:line (\d+), column \d+|end of document)\)")
_BARE_QUANTITY = re.compile(r"""\s*[\w."'-]+\s*=\s*[+-]?[\d.][\d.eE+-]*\s*[A-Za-z%°µ]""")


@dataclass(frozen=True)
class Finding:
    """Something wrong at a key, before it is known where in which file that key stands."""

    path: Path
    message: str
    remedy: str = ""


@dataclass(frozen=True)
class Source:
    """Where a case came from. All sources are equal: a case is what it says.

    Attributes
    ----------
    file : str
        Name for messages.
    data : mapping
        What the file says, as plain data.
    lines : mapping
        Path of each key to its line number.
    si : bool
        Bare numbers are SI values, because a program wrote them.
    text : str
        The file as it stands; changes made in memory follow as comments.
    """

    file: str = field(default="case", compare=False)
    data: Mapping[str, Any] = field(default_factory=dict, compare=False)
    lines: Mapping[Path, int] = field(default_factory=dict, compare=False)
    si: bool = field(default=False, compare=False)
    text: str = field(default="", compare=False)

    def line(self, path: Path) -> int | None:
        """Line of a key, or of the nearest table around it."""
        while path and path not in self.lines:
            path = path[:-1]
        return self.lines.get(path)

    def value(self, path: Path) -> Any:
        """Value at a key; a private sentinel (shown as nothing) if there is none."""
        value: Any = self.data
        for part in path:
            if isinstance(value, Mapping):
                value = value.get(part, _ABSENT)
            elif isinstance(value, list | tuple) and isinstance(part, int) and part < len(value):
                value = value[part]
            else:
                return _ABSENT
        return value

    def problem(self, finding: Finding) -> Problem:
        """Turn a finding into a problem with file, line, key and value."""
        path = as_written(finding.path, self.data)
        value = self.value(path)
        whole = value is _ABSENT or (isinstance(value, Mapping) and len(path) < 2)
        text = "" if whole else shown(value)
        line = self.line(path)
        return Problem(self.file, line, dotted(path), text, finding.message, finding.remedy)


def as_written(path: Path, data: Any) -> Path:
    """Path in the file: one table may stand where a list of tables is meant."""
    kept: list[str | int] = []
    for part in path:
        if isinstance(part, int) and isinstance(data, Mapping):
            continue
        kept.append(part)
        try:
            data = data[part]
        except (LookupError, TypeError):
            data = None
    return tuple(kept)


def read_source(path: FilePath) -> Source:
    """Read a case file.

    Raises
    ------
    InvalidCaseError
        There is no such file, it is not text, or it is not TOML.
    """
    name = str(path)
    try:
        text = path.read_text(encoding="utf-8-sig")
    except FileNotFoundError:
        fault, remedy = "there is no such file", "quietblade new NAME writes one to start from"
    except IsADirectoryError:
        fault, remedy = "is a folder", "Name the case file in it"
    except UnicodeDecodeError:
        fault, remedy = "is not a text file in UTF-8", "Save it as UTF-8 text"
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        fault, remedy = f"cannot be read: {reason}", ""
    else:
        return parse_source(text, name)
    raise InvalidCaseError([Problem(name, None, "", "", fault, remedy)])


def parse_source(text: str, name: str) -> Source:
    """Parse the text of a case file.

    Raises
    ------
    InvalidCaseError
        It is not TOML.
    """
    try:
        data = tomllib.loads(text)
        return Source(name, data, locate_lines(text), text=text)
    except RecursionError:
        fault = Problem(name, None, "", "", "is nested too deeply", "Write plain tables and lists")
    except ValueError as error:  # tomllib.TOMLDecodeError, or a number beyond all limits
        fault = _not_toml(text, name, str(error))
    raise InvalidCaseError([fault])


def _not_toml(text: str, name: str, message: str) -> Problem:
    place = _TOML_PLACE.search(message)
    rows = text.splitlines()
    line = int(place.group(1)) if place and place.group(1) else (len(rows) if place else None)
    row = rows[line - 1] if line is not None and 0 < line <= len(rows) else ""
    fault = _TOML_PLACE.sub("", message)
    fault = f"is not valid TOML: {fault[:1].lower()}{fault[1:]}"
    remedy = f"Look at: {shortened(row.strip())}" if row.strip() else ""
    if _BARE_QUANTITY.match(row):
        remedy = f'A value with its unit stands in quotes, as in speed = "5 m/s". {remedy}'
    elif "overwrite" in fault or "twice" in fault:
        remedy = f"Each key and each table may stand only once. {remedy}".strip()
    return Problem(name, line, "", "", fault, remedy)
