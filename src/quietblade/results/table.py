# SPDX-License-Identifier: LGPL-2.1-or-later
"""A table of texts, for the screen, for files and for the report."""

from dataclasses import dataclass, replace

NOTHING = "-"
"""What stands for a figure that was not computed."""


@dataclass(frozen=True)
class Table:
    """A titled table of texts.

    Attributes
    ----------
    title : str
    columns : tuple of str
        Heads; empty for a list of name and value.
    rows : tuple of tuple of str
    note : str
        A line that belongs below the table.
    """

    title: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    note: str = ""

    def without_empty_columns(self) -> "Table":
        """Return the table without the columns that hold nothing but dashes."""
        kept = [
            k
            for k in range(len(self.columns))
            if not self.rows or any(row[k] != NOTHING for row in self.rows)
        ]
        rows = tuple(tuple(row[k] for k in kept) for row in self.rows)
        return replace(self, columns=tuple(self.columns[k] for k in kept), rows=rows)


def number(value: float | None, form: str = ".4g") -> str:
    """Format a figure; a dash if it was not computed."""
    return NOTHING if value is None else format(value, form)
