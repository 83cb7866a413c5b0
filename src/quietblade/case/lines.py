# SPDX-License-Identifier: LGPL-2.1-or-later
"""Line numbers of the keys of a TOML document, which the standard reader does not tell."""

import re

from quietblade.case.problems import Path

_BLANK = re.compile(r"[ \t\r\n]*(?:#[^\n]*[ \t\r\n]*)*")
_SPACE = re.compile(r"[ \t]*")
_BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")
_SCALAR = re.compile(r"[^\s,\]}#]+(?: \d[^\s,\]}#]*)?")  # a date may have one space
_STRINGS = (
    re.compile(r'"""(?:[^\\]|\\.)*?"{3,5}', re.DOTALL),
    re.compile(r"'''.*?'{3,5}", re.DOTALL),
    re.compile(r'"(?:[^"\\]|\\.)*"'),
    re.compile(r"'[^']*'"),
)
_ESCAPE = re.compile(r'\\(u[0-9A-Fa-f]{4}|U[0-9A-Fa-f]{8}|[btnfre"\\]|x[0-9A-Fa-f]{2})')
_ESCAPED = {"b": "\b", "t": "\t", "n": "\n", "f": "\f", "r": "\r", "e": "\x1b"}


def locate_lines(text: str) -> dict[Path, int]:
    """Find the line of every key and list entry of a valid TOML document.

    Parameters
    ----------
    text : str
        A document that ``tomllib`` has accepted; anything else gives a partial answer.

    Returns
    -------
    dict
        Path (keys, and positions in lists) to line number, counted from 1. A table stands on
        the line of its header, or of the first dotted key that makes it.
    """
    scanner = _Scanner(text)
    scanner.document()
    return scanner.lines


class _Scanner:
    def __init__(self, text: str) -> None:
        self.text = text
        self.at = 0
        self.lines: dict[Path, int] = {}
        self.tables: dict[Path, int] = {}  # how many tables an array of tables has so far
        self.line, self.counted = 1, 0

    def document(self) -> None:
        table: Path = ()
        self.skip(_BLANK)
        while self.at < len(self.text):
            start = self.at
            if self.peek("[["):
                table = self.array_header()
            elif self.peek("["):
                self.at += 1
                table = self.known(self.key())
                self.note(table)
                self.accept("]")
            else:
                self.pair(table)
            self.skip(_BLANK)
            if self.at == start:  # not TOML: the reader says so better
                return

    def array_header(self) -> Path:
        self.at += 2
        name = self.key()
        *parents, last = name
        array = (*self.known(tuple(parents)), last)
        position = self.tables.get(array, 0)
        self.tables[array] = position + 1
        self.note(array)
        table = (*array, position)
        self.note(table)
        self.accept("]]")
        return table

    def known(self, name: Path) -> Path:
        """Insert into a header's name the position of the latest table of each array."""
        path: Path = ()
        for part in name:
            path = (*path, part)
            if path in self.tables:
                path = (*path, self.tables[path] - 1)
            self.note(path)
        return path

    def pair(self, table: Path) -> None:
        path = table
        for part in self.key():
            path = (*path, part)
            self.note(path)
        self.accept("=")
        self.skip(_SPACE)
        self.value(path)

    def key(self) -> Path:
        parts: list[str] = []
        while True:
            self.skip(_SPACE)
            found = self.string()
            if found is not None:
                parts.append(_unescaped(found[1:-1]) if found[0] == '"' else found[1:-1])
            else:
                parts.append(self.skip(_BARE_KEY))
            self.skip(_SPACE)
            if not self.accept("."):
                return tuple(parts)

    def value(self, path: Path) -> None:
        if self.accept("["):
            self.entries(path, "]")
        elif self.accept("{"):
            self.entries(path, "}")
        elif self.string() is None:
            self.skip(_SCALAR)

    def entries(self, path: Path, close: str) -> None:
        position = 0
        self.skip(_BLANK)
        while self.at < len(self.text) and not self.accept(close):
            start = self.at
            if close == "]":
                entry = (*path, position)
                self.note(entry)
                self.value(entry)
            else:
                self.pair(path)
            position += 1
            self.skip(_BLANK)
            self.accept(",")
            self.skip(_BLANK)
            if self.at == start:
                return

    def string(self) -> str | None:
        if not (self.peek('"') or self.peek("'")):
            return None
        for pattern in _STRINGS:
            match = pattern.match(self.text, self.at)
            if match:
                self.at = match.end()
                return match.group()
        return None

    def note(self, path: Path) -> None:
        self.line += self.text.count("\n", self.counted, self.at)
        self.counted = self.at
        self.lines.setdefault(path, self.line)

    def peek(self, token: str) -> bool:
        return self.text.startswith(token, self.at)

    def accept(self, token: str) -> bool:
        if not self.peek(token):
            return False
        self.at += len(token)
        return True

    def skip(self, pattern: re.Pattern[str]) -> str:
        match = pattern.match(self.text, self.at)
        if match is None:
            return ""
        self.at = match.end()
        return match.group()


def _unescaped(text: str) -> str:
    def replace(match: re.Match[str]) -> str:
        code = match.group(1)
        if len(code) > 1:
            number = int(code[1:], 16)
            return chr(number) if number < 0x110000 else ""
        return _ESCAPED.get(code, code)

    return _ESCAPE.sub(replace, text)
