# SPDX-License-Identifier: LGPL-2.1-or-later
"""Formats of the case file: keys that got another name, and files that still have the old one.

Whoever renames a key raises `FORMAT` by one and adds the old name to `RENAMED`. Older files are
then read as before, and ``quietblade check --migrate`` rewrites them.
"""

import re
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass, replace
from typing import Any

from quietblade.case.problems import InvalidCaseError, Path, dotted
from quietblade.case.source import Finding, Source, parse_source

FORMAT = 1
"""Format of the case files of this version; a file that says none has the first."""


@dataclass(frozen=True)
class Renamed:
    """A key that has another name since a format.

    Attributes
    ----------
    format : int
        The first format with the new name.
    key : str
        Old dotted key; ``*`` stands for any name or entry of a list.
    name : str
        New name, in the same table.
    """

    format: int
    key: str
    name: str

    def places(self, data: Mapping[str, Any]) -> Iterator[Path]:
        """Where in a file the old key stands."""
        *tables, last = self.key.split(".")
        found: list[tuple[Path, Any]] = [((), data)]
        for part in tables:
            found = [
                ((*path, name), inner)
                for path, value in found
                for name, inner in _entries(value)
                if part in ("*", name)
            ]
        yield from ((*path, last) for path, table in found if last in dict(_entries(table)))


RENAMED: tuple[Renamed, ...] = ()
"""Renamed keys in the order of their formats; so far none."""


def migrated(source: Source, renamed: Sequence[Renamed] = RENAMED, newest: int = FORMAT) -> Source:
    """Give a file the keys of the newest format, in memory.

    Raises
    ------
    InvalidCaseError
        The file is of a newer version of quietblade, or has a key by both names.
    """
    written = source.data.get("format", 1)
    if isinstance(written, bool) or not isinstance(written, int) or not written >= 1:
        return source  # the words say what is wrong
    if written > newest:
        fault = "is of a newer quietblade: this one reads formats up to " + str(newest)
        remedy = "Update it: pip install --upgrade quietblade"
        raise InvalidCaseError([source.problem(Finding(("format",), fault, remedy))])
    for key in renamed:
        if key.format > written:
            for place in key.places(source.data):
                source = _renamed(source, place, key.name)
    return replace(source, data={**source.data, "format": newest})


def migrated_text(
    text: str, name: str, renamed: Sequence[Renamed] = RENAMED, newest: int = FORMAT
) -> str:
    """Rewrite a file in the newest format; comments and order stay.

    Raises
    ------
    InvalidCaseError
        As by `migrated`; or the file is not TOML, or its layout hides a key.
    """
    source = parse_source(text, name)
    wanted = migrated(source, renamed, newest).data
    rows = text.splitlines(keepends=True)
    for key in renamed:
        for place in key.places(source.data) if key.format > source.data.get("format", 1) else ():
            row = source.lines[place] - 1
            old = rf"(?<![\w.\"'-]){re.escape(str(place[-1]))}(?=\s*[=.\]])"
            rows[row] = re.sub(old, key.name, rows[row], count=1)
        source = parse_source("".join(rows), name)
    if "format" in source.data:
        row = source.lines["format",] - 1
        rows[row] = re.sub(r"\d+", str(newest), rows[row], count=1)
    else:
        row = min(source.lines.values(), default=1) - 1
        rows.insert(row, f"format = {newest}\n")
    new = "".join(rows)
    if tomllib.loads(new) != wanted:
        fault = "cannot be rewritten in the newest format, since keys are hidden by its layout"
        names = ", ".join(f"{key.key} is now {key.name}" for key in renamed)
        raise InvalidCaseError([source.problem(Finding((), fault, f"Write by hand: {names}"))])
    return new


def _renamed(source: Source, place: Path, name: str) -> Source:
    *tables, old = place
    data: Any = deepcopy(dict(source.data))
    table = data
    for part in tables:
        table = table[part]
    new = (*tables, name)
    if name in table:
        fault = Finding(place, f"is the old name of {dotted(new)}, which is given too", "Keep one")
        raise InvalidCaseError([source.problem(fault)])
    table[name] = table.pop(old)
    lines = {
        (*new, *path[len(place) :]) if path[: len(place)] == place else path: line
        for path, line in source.lines.items()
    }
    return replace(source, data=data, lines=lines)


def _entries(value: Any) -> Iterator[tuple[str | int, Any]]:
    if isinstance(value, Mapping):
        yield from value.items()
    elif isinstance(value, list | tuple):
        yield from enumerate(value)
