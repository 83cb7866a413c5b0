# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is wrong with a case file: one problem, one message, all of them at once."""

import json
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from difflib import get_close_matches
from typing import Any

from quietblade.errors import CaseError

Path = tuple[str | int, ...]
"""Keys and list positions from the top of the file: ``("blade", "chord", "values", 1)``."""

_LONGEST_VALUE = 70


@dataclass(frozen=True)
class Problem:
    """One thing that is wrong.

    Attributes
    ----------
    file : str
        Name of the case file as the user gave it.
    line : int or None
        Line number from 1; None if nothing in the file can be pointed at.
    key : str
        Dotted key, for example ``blade.chord.values[1]``; empty for the file as a whole.
    value : str
        The value as it would stand in the file; empty if there is none.
    message, remedy : str
        What is wrong, and what to do.
    """

    file: str
    line: int | None
    key: str
    value: str
    message: str
    remedy: str

    def __str__(self) -> str:
        place = self.file if self.line is None else f"{self.file}:{self.line}"
        subject = f"{self.key} = {self.value}" if self.key and self.value else self.key
        parts = [part for part in (place, subject, self.message) if part]
        return _printable(": ".join(parts) + (f". {self.remedy}" if self.remedy else ""))

    def as_dict(self) -> dict[str, str | int | None]:
        """Plain data, for ``--json``."""
        return asdict(self)


class InvalidCaseError(CaseError):
    """A case file with problems; its text lists them, one a line, in the order of the file.

    Attributes
    ----------
    problems : tuple of Problem
    """

    def __init__(self, problems: Iterable[Problem]) -> None:
        self.problems = tuple(sorted(set(problems), key=_place))
        super().__init__("\n".join(map(str, self.problems)))


def _place(problem: Problem) -> tuple[float, str, str]:
    line = float("inf") if problem.line is None else problem.line
    return line, problem.key, problem.message


def dotted(path: Path) -> str:
    """Write a path as a user would: ``blade.chord.values[1]``."""
    text = ""
    for part in path:
        if isinstance(part, int):
            text += f"[{part}]"
        else:
            text += ("." if text else "") + (part if _is_bare(part) else json.dumps(part))
    return text


def _is_bare(key: str) -> bool:
    return bool(key) and all(c.isascii() and (c.isalnum() or c in "-_") for c in key)


def shown(value: Any) -> str:
    """Write a value as it stands in a case file, shortened to fit on a line."""
    return shortened(literal(value))


def shortened(text: str) -> str:
    """Return a text that fits on a line of a message."""
    return text if len(text) <= _LONGEST_VALUE else text[: _LONGEST_VALUE - 4] + " ..."


def _printable(text: str) -> str:
    """Return a text without what a terminal would obey instead of showing."""
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in text)


def literal(value: Any) -> str:
    """Write a value as TOML."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(literal, value)) + "]"
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{dotted((k,))} = {literal(v)}" for k, v in value.items()) + " }"
    return str(value)


def nearest(word: str, known: Iterable[str]) -> str | None:
    """Return the known word that was probably meant, if there is one."""
    by_lower = {name.lower(): name for name in known}
    near = get_close_matches(word.lower(), by_lower, n=1, cutoff=0.6)
    return by_lower[near[0]] if near else None


def suggestion(word: str, known: Iterable[str]) -> str:
    """Return ``Did you mean "..."?`` for the nearest known word, or nothing."""
    near = nearest(word, known)
    return f'Did you mean "{near}"?' if near else ""
