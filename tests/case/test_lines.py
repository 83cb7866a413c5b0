# SPDX-License-Identifier: LGPL-2.1-or-later
"""The line of every key, against the standard reader and against an editor's own count."""

import json
import tomllib
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from quietblade.case.lines import locate_lines
from quietblade.case.problems import Path

DOCUMENT = '''\
# a comment with [brackets] and key = 1
title = "one"  # = [x]

[blade]
chord = { s = [0, 1], values = [
    "250 mm",  # ] }
    "75 mm",
], interpolation = "linear" }
"quoted key".'dotted.one' = 3
span.low = 1
span.high = """
many
lines """
after = '#'

[materials."my alloy"]
law = 'isotropic'
note = \'\'\'
literal \\ text
\'\'\'
when = 1979-05-27 07:32:00
[[runs]]
name = "a"
[runs.inner]
x = 1
[[runs]]
name = "b"
[[runs.parts]]
n = 1
[[runs.parts]]
n = [[1, 2],
  [3]]
'''

EXPECTED: dict[Path, int] = {
    ("title",): 2,
    ("blade",): 4,
    ("blade", "chord"): 5,
    ("blade", "chord", "s", 1): 5,
    ("blade", "chord", "values", 0): 6,
    ("blade", "chord", "values", 1): 7,
    ("blade", "chord", "interpolation"): 8,
    ("blade", "quoted key", "dotted.one"): 9,
    ("blade", "span"): 10,
    ("blade", "span", "low"): 10,
    ("blade", "span", "high"): 11,
    ("blade", "after"): 14,
    ("materials", "my alloy"): 16,
    ("materials", "my alloy", "law"): 17,
    ("materials", "my alloy", "when"): 21,
    ("runs", 0): 22,
    ("runs", 0, "name"): 23,
    ("runs", 0, "inner", "x"): 25,
    ("runs", 1): 26,
    ("runs", 1, "name"): 27,
    ("runs", 1, "parts", 0, "n"): 29,
    ("runs", 1, "parts", 1): 30,
    ("runs", 1, "parts", 1, "n", 0, 1): 31,
    ("runs", 1, "parts", 1, "n", 1, 0): 32,
}


def paths(value: Any, path: Path = ()) -> set[Path]:
    """All paths of a document."""
    if isinstance(value, dict):
        inner = {(*path, key): entry for key, entry in value.items()}
    elif isinstance(value, list):
        inner = {(*path, i): entry for i, entry in enumerate(value)}
    else:
        return set()
    return set(inner).union(*(paths(entry, p) for p, entry in inner.items()))


@pytest.mark.parametrize(("path", "line"), EXPECTED.items(), ids=str)
def test_line_of_key(path: Path, line: int) -> None:
    assert locate_lines(DOCUMENT)[path] == line


def test_every_key_has_a_line() -> None:
    assert set(locate_lines(DOCUMENT)) == paths(tomllib.loads(DOCUMENT))


def test_windows_line_ends() -> None:
    assert locate_lines(DOCUMENT.replace("\n", "\r\n")) == locate_lines(DOCUMENT)


def written(text: str) -> str:
    """A basic string of TOML."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def inline(value: Any) -> str:
    """A value on one line, lists on several."""
    if isinstance(value, dict):
        pairs = (f"{written(key)} = {inline(entry)}" for key, entry in value.items())
        return "{ " + ", ".join(pairs) + " }"
    if isinstance(value, list):
        return "[ # list\n" + ",\n".join(map(inline, value)) + "]"
    if isinstance(value, str):
        return written(value)
    return str(value).lower() if isinstance(value, bool) else str(value)


def document(data: dict[str, Any], header: str = "") -> str:
    """A document: tables with headers, everything below the first two levels inline."""
    rows, tables = [], []
    for key, value in data.items():
        name = f"{header}.{written(key)}" if header else written(key)
        if isinstance(value, dict) and header.count(".") < 1:
            tables.append(f"\n[{name}] # {key!r}\n{document(value, name)}")
        elif isinstance(value, list) and value and all(isinstance(v, dict) for v in value):
            deep = f'{name}."x"."y"'  # far enough down for everything in it to be inline
            tables.extend(f"\n[[{name}]]\n{document(v, deep)}" for v in value)
        else:
            rows.append(f"{written(key)}={inline(value)}\n")
    return "".join(rows + tables)


characters = st.characters(codec="utf-8", exclude_categories=["Cc"])
keys = st.text(characters, max_size=5)
texts = st.text(st.one_of(characters, st.sampled_from("\n\t\"'#[]{}=,.\\\x7f")), max_size=8)
scalars = st.one_of(st.integers(-(2**40), 2**40), st.booleans(), st.floats(), st.dates(), texts)
values = st.recursive(
    scalars,
    lambda inner: st.one_of(st.lists(inner, max_size=3), st.dictionaries(keys, inner, max_size=3)),
    max_leaves=8,
)


@settings(max_examples=150, deadline=None)
@given(st.dictionaries(keys, values, max_size=4))
def test_finds_the_keys_of_any_document(data: dict[str, Any]) -> None:
    text = document(data)
    lines = locate_lines(text)
    assert set(lines) == paths(tomllib.loads(text))
    rows = text.split("\n")
    for path, line in lines.items():
        if isinstance(path[-1], str):
            assert written(path[-1]) in rows[line - 1]


@given(st.text(max_size=60))
def test_ends_on_any_text(text: str) -> None:
    locate_lines(text)
