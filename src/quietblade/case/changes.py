# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a study or a script has changed in a case, kept as comments below the text of its file."""

from ast import literal_eval
from collections.abc import Mapping
from typing import Any

_MARK = "# changed in memory: "


def with_changes(text: str, changes: Mapping[str, Any]) -> str:
    """Add the changes, by dotted key, to the text of a case."""
    return text + "".join(f"{_MARK}{key} = {value!r}\n" for key, value in changes.items())


def read_changes(text: str) -> dict[str, Any]:
    """Read back by dotted key what was changed; later changes of a key replace earlier ones."""
    lines = [line.removeprefix(_MARK) for line in text.splitlines() if line.startswith(_MARK)]
    pairs = (line.partition(" = ") for line in lines)
    return {key: literal_eval(value) for key, _, value in pairs}
