# SPDX-License-Identifier: LGPL-2.1-or-later
"""Section coordinates from text files, in the orders of Selig and of Lednicer.

Selig: one run from the upper trailing edge around the nose to the lower trailing edge. Lednicer:
the numbers of points of the two sides, then each side from the nose to the trailing edge. Either
may begin with a title; lines that begin with ``#``, ``!`` or ``%`` are comments.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from quietblade.errors import GeometryError
from quietblade.geometry.table_sections import TableFamily, table_family
from quietblade.typing import FloatArray

MIN_POINTS = 11
"""Fewest points of a table."""

_SEPARATOR = 999.0  # what some files put between the elements of a section with flaps


@dataclass(frozen=True, eq=False)
class SectionTable:
    """What a coordinate file says.

    Attributes
    ----------
    title : str
        Text before the numbers.
    layout : str
        ``"Selig"`` or ``"Lednicer"``.
    points : ndarray, shape (N, 2)
        In the units of the file, from the trailing edge around the nose and back.
    """

    title: str
    layout: str
    points: FloatArray


def read_section(path: str | Path) -> SectionTable:
    """Read a coordinate file.

    Raises
    ------
    GeometryError
        The file cannot be read, or a line of it; the message names the line.
    """
    path = Path(path)
    try:
        lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError as error:
        raise GeometryError(f"section file {path}: {error.strerror or error}") from None
    title: list[str] = []
    numbers: list[int] = []
    rows: list[tuple[float, float]] = []
    for number, line in enumerate(lines, 1):
        text = line.strip().lstrip("\ufeff")
        if not text or text[0] in "#!%":
            continue
        pair = _pair(text)
        if pair is None and not rows:
            title.append(text)
            continue
        if pair is None or not np.all(np.isfinite(pair)):
            raise _wrong(path, number, f"expected two numbers, x and y, found {text[:40]!r}")
        if _SEPARATOR in pair:
            raise _wrong(
                path, number, "sections of several elements are not supported; keep one element"
            )
        rows.append(pair)
        numbers.append(number)
    points = np.array(rows, dtype=np.float64).reshape(-1, 2)
    layout, points = _ordered(path, points, numbers)
    if len(points) < MIN_POINTS:
        raise GeometryError(
            f"section file {path}: {len(points)} points, limit at least {MIN_POINTS}. "
            "Remedy: give more points, crowded at the nose"
        )
    return SectionTable(" ".join(title), layout, points)


def section_from_file(path: str | Path) -> TableFamily:
    """Family of the section of a coordinate file, named by the file.

    Raises
    ------
    GeometryError
        As for `read_section` and `table_family`.
    """
    return table_family(read_section(path).points, Path(path).name)


def _pair(text: str) -> tuple[float, float] | None:
    words = text.replace(",", " ").replace(";", " ").split()
    if len(words) != 2:
        return None
    try:
        return float(words[0]), float(words[1])
    except ValueError:
        return None


def _wrong(path: Path, number: int, what: str) -> GeometryError:
    return GeometryError(f"section file {path}, line {number}: {what}")


def _ordered(path: Path, points: FloatArray, numbers: list[int]) -> tuple[str, FloatArray]:
    """Bring the points in one run from the trailing edge around the nose."""
    if len(points) < 2:
        raise GeometryError(
            f"section file {path}: holds {len(points)} points. Remedy: give a table of x and y"
        )
    counts = points[0]
    if np.all(counts >= 3.0) and np.all(counts == np.round(counts)):
        upper, lower = int(counts[0]), int(counts[1])
        rest = points[1:]
        if upper + lower != len(rest):
            raise _wrong(
                path,
                numbers[0],
                f"announces {upper} + {lower} points of two sides, but {len(rest)} follow",
            )
        return "Lednicer", np.concatenate([rest[:upper][::-1], rest[upper:]])
    x = points[:, 0]
    if x[0] - x.min() < 0.05 * np.ptp(x):  # begins at the nose, without the counts
        second = int(np.argmin(np.diff(x))) + 1
        return "Lednicer", np.concatenate([points[:second][::-1], points[second:]])
    return "Selig", points
