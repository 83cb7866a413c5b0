# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tables of texts on the terminal."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from rich.table import Table as RichTable
from rich.text import Text

from quietblade.cli.common import console

if TYPE_CHECKING:  # importing results takes longer than help may
    from quietblade.results.table import Table

_SHORT = 12  # characters of a figure, which must not be broken
_STYLES = {
    "agrees": "green", "DIFFERS": "bold red", "not judged": "dim",
    "kept": "green", "EXCEEDED": "bold red", "not touched": "dim",
}  # fmt: skip


def show_tables(title: str, tables: Iterable[Table]) -> None:
    """Show titled tables, one below the other."""
    console.print(Text(title, style="bold"))
    for table in tables:
        console.print()
        console.print(_rich(table))


def _rich(table: Table) -> RichTable:
    shown = RichTable(
        title=Text(table.title),
        title_justify="left",
        title_style="bold",
        caption=Text(table.note) if table.note else None,
        caption_justify="left",
        show_header=bool(table.columns),
        box=None,
        pad_edge=False,
    )
    heads = table.columns or ("",) * len(table.rows[0])
    for head, texts in zip(heads, zip(*table.rows, strict=True), strict=True):
        width = max(map(len, texts))
        # the head of a column of short texts may wrap, they may not
        least = width if width <= _SHORT else None
        shown.add_column(Text(head, style="cyan"), min_width=least, overflow="fold")
    for row in table.rows:
        shown.add_row(*(Text(text, style=_STYLES.get(text, "")) for text in row))
    return shown
