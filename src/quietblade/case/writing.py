# SPDX-License-Identifier: LGPL-2.1-or-later
"""From what a case says to the text of a case file, each key with its meaning as a comment."""

import textwrap
from collections.abc import Iterator, Mapping
from inspect import cleandoc
from typing import Any

from pydantic import BaseModel

from quietblade.case.explain import model_at
from quietblade.case.model import Case
from quietblade.case.problems import Path, dotted, literal

_WIDTH = 100
_COLUMN = 40
_HOW = """\
Every value that has a unit stands in quotes with it. A quantity along the span is one value, a \
table { s = [0, 1], values = [...] } or a formula { formula = "...", unit = "..." }, where the \
span fraction s is 0 at the root and 1 at the tip. Chord fractions run from 0 at the leading edge \
to 1 at the trailing edge. "quietblade check FILE" tells how a file is understood."""


def case_text(data: Mapping[str, Any], about: str = "") -> str:
    """Write a case file.

    Parameters
    ----------
    data : mapping
        What the file says, as `tomllib` would read it.
    about : str
        What stands at its top, as a comment.
    """
    top = [*_comment(about), "#"] if about else []
    keys = {key: value for key, value in data.items() if not _is_table(value)}
    rows = [*top, *_comment(_HOW), "", *_keys((), keys, data)]
    for name in sorted(set(data) - set(keys), key=_order):
        if name == "materials":
            for inner, value in data[name].items():
                rows += _table((name, inner), value, data)
        elif isinstance(data[name], list):
            for number, entry in enumerate(data[name]):
                rows += _table((name, number), entry, data)
        else:
            rows += _table((name,), data[name], data)
    return "\n".join(rows) + "\n"


def _table(path: Path, table: Mapping[str, Any], data: Mapping[str, Any]) -> Iterator[str]:
    """Write a table below its header, and what is too long for a line as tables of their own."""
    name = dotted(tuple(part for part in path if isinstance(part, str)))
    listed = isinstance(path[-1], int)
    long = {
        key: value
        for key, value in table.items()
        if isinstance(value, Mapping) and len(f"{key} = {literal(value)}") > _WIDTH
    }
    short = {key: value for key, value in table.items() if key not in long}
    meaning = _table_meaning(path, data)
    yield ""
    yield from _with_comment(f"[[{name}]]" if listed else f"[{name}]", meaning)
    yield from _keys(path, short, data)
    for key, value in long.items():
        yield from _table((*path, key), value, data)


def _is_table(value: Any) -> bool:
    return isinstance(value, Mapping) or (
        isinstance(value, list) and bool(value) and isinstance(value[0], Mapping)
    )


def _order(name: str) -> int:
    names = list(Case.model_fields)
    return names.index(name) if name in names else len(names)


def _keys(path: Path, table: Mapping[str, Any], data: Mapping[str, Any]) -> Iterator[str]:
    model = _model(path, data)
    fields = model.model_fields if model else {}
    for key, value in table.items():
        meaning = fields[key].description if key in fields else ""
        yield from _with_comment(f"{dotted((key,))} = {literal(value)}", meaning or "")


def _table_meaning(path: Path, data: Mapping[str, Any]) -> str:
    *around, key = path
    outer = _model(tuple(around), data)
    if outer is not None and key in outer.model_fields and around:
        return outer.model_fields[str(key)].description or ""
    model = _model(path, data)
    return cleandoc(model.__doc__ or "").split("\n")[0].rstrip(".") if model else ""


def _model(path: Path, data: Mapping[str, Any]) -> type[BaseModel] | None:
    # one table may stand for a list of one, whose entries have the model
    return model_at(path, data, Case) or model_at((*path, 0), data, Case)


def _with_comment(row: str, meaning: str) -> Iterator[str]:
    behind = f"{row:<{_COLUMN}}  # {meaning}"
    if not meaning or len(behind) <= _WIDTH:
        yield behind if meaning else row
    else:
        yield from _comment(meaning)
        yield row


def _comment(text: str) -> list[str]:
    return textwrap.wrap(
        text, _WIDTH, initial_indent="# ", subsequent_indent="# ", break_on_hyphens=False
    )
