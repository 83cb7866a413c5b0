# SPDX-License-Identifier: LGPL-2.1-or-later
"""A table of texts, for the screen, for files and for the report."""

from dataclasses import dataclass


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


def number(value: float | None, form: str = ".4g") -> str:
    """Format a figure; a dash if it was not computed."""
    return "-" if value is None else format(value, form)
