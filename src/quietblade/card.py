# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a prompt or a notebook shows of an object: a title, a short table with units, a drawing."""

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

import numpy as np

from quietblade.typing import FloatArray

MOST_ROWS = 12
"""Longer tables are cut in the middle of what they list."""


@dataclass(frozen=True)
class Card:
    """A short description of an object.

    Attributes
    ----------
    title : str
        What it is.
    rows : tuple of tuple of str
        Texts with their units.
    columns : tuple of str
        Heads; empty for rows of name and value.
    drawing : str
        Inline SVG, or empty.
    """

    title: str
    rows: tuple[tuple[str, ...], ...]
    columns: tuple[str, ...] = ()
    drawing: str = ""

    def text(self) -> str:
        """Return aligned lines for a prompt."""
        lines = [row for row in (self.columns, *self.rows) if row]
        count = max(map(len, lines), default=0)
        widths = [max(len(row[k]) for row in lines if k < len(row)) for k in range(count)]
        padded = ("  ".join(map(str.ljust, row, widths)).rstrip() for row in lines)
        return "\n".join([self.title, *(f"  {line}" for line in padded)])

    def html(self) -> str:
        """Return a heading, the drawing and a table, without styles of its own but alignment."""

        def row(cells: Sequence[str], tag: str) -> str:
            inside = (f'<{tag} style="text-align:left">{escape(c)}</{tag}>' for c in cells)
            return f"<tr>{''.join(inside)}</tr>"

        head = f"<thead>{row(self.columns, 'th')}</thead>" if self.columns else ""
        body = "".join(row(cells, "td") for cells in self.rows)
        return (
            f"<div><strong>{escape(self.title)}</strong>{self.drawing}"
            f"<table>{head}<tbody>{body}</tbody></table></div>"
        )


class Shown:
    """Base of what is shown by its card; a data class that has it is made with ``repr=False``."""

    def card(self) -> Card:
        """Return what is shown."""
        raise NotImplementedError(f"{type(self).__name__} has no card")

    def __repr__(self) -> str:
        return self.card().text()

    def __str__(self) -> str:
        return self.card().text()

    def _repr_html_(self) -> str:
        return self.card().html()


def shortened(rows: Sequence[tuple[str, ...]]) -> tuple[tuple[str, ...], ...]:
    """Cut a long list of rows, and say how many are left out."""
    if len(rows) <= MOST_ROWS:
        return tuple(rows)
    return (*rows[: MOST_ROWS - 1], (f"... {len(rows) - MOST_ROWS + 1} more",))


def outlines(*curves: FloatArray, width: int = 320) -> str:
    """Draw plane curves, (n, 2) each, to one scale as inline SVG; the second axis points up."""
    points = np.concatenate(curves)
    low, size = points.min(axis=0), np.ptp(points, axis=0)
    scale = (width - 4) / size[0]
    height = round(scale * size[1]) + 4
    lines = ""
    for curve in curves:
        x, y = 2 + scale * (curve[:, 0] - low[0]), height - 2 - scale * (curve[:, 1] - low[1])
        path = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(x, y, strict=True))
        lines += f'<polyline points="{path}" fill="none" stroke="currentColor"/>'
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
        f'style="display:block">{lines}</svg>'
    )
