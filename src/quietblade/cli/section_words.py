# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the words of ``quietblade section`` mean."""

import csv
import math
import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from quietblade.case.units import ANGLE, FRACTION, UnitError, read_quantity
from quietblade.errors import CaseError, GeometryError
from quietblade.geometry import (
    SectionFamily,
    naca_designation,
    section_family,
    section_from_file,
)
from quietblade.geometry.naca import FAMILIES
from quietblade.typing import FloatArray

MAX_ANGLES = 500


@dataclass(frozen=True, eq=False)
class Section:
    """A section to be solved.

    Attributes
    ----------
    title : str
        For people.
    thickness, camber, trailing_edge : float
        Fractions of the chord.
    contour : ndarray, shape (N, 2)
        In units of the chord.
    """

    title: str
    thickness: float
    camber: float
    trailing_edge: float
    contour: FloatArray

    @property
    def slug(self) -> str:
        """The title as part of a file name."""
        return re.sub(r"[^a-z0-9]+", "-", self.title.lower()).strip("-")


@contextmanager
def refused() -> Iterator[None]:
    """Turn what is wrong with a section or a folder into a wrong command."""
    try:
        yield
    except GeometryError as error:
        raise CaseError(str(error)) from error
    except OSError as error:
        raise CaseError(f"{error.filename}: cannot be written ({error.strerror})") from error


def make_section(
    shape: str, thickness: str | None, camber: str | None, edge: str | None, nodes: int
) -> Section:
    """Make the section that the words describe.

    Raises
    ------
    CaseError
        A word that cannot be understood, or a section that cannot be.
    """
    t, m, te = (
        _fraction(name, text)
        for name, text in (("thickness", thickness), ("camber", camber), ("trailing-edge", edge))
    )
    family: SectionFamily
    digits = re.fullmatch(r"(?:naca[ -]?)?(\d{4,5})", shape.strip().lower())
    with refused():
        if Path(shape).is_file():
            table = section_from_file(shape)
            family, title = table, Path(shape).stem
            own = (table.thickness, table.camber, table.trailing_edge)
        elif digits:
            named, t_own, m_own = naca_designation(digits[1])
            if t is not None or m is not None:
                raise CaseError(
                    f"{shape} has its thickness and camber in its name. Leave --thickness and "
                    f"--camber out, or name the family, {named.name}"
                )
            family, title, own = named, f"NACA {digits[1]}", (t_own, m_own, 0.0)
        elif shape in FAMILIES:
            family, title = section_family(shape), shape
            if t is None:
                raise CaseError(f'the family {shape} needs a thickness: --thickness "6 %"')
            own = (t, 0.0, 0.0)
        else:
            raise CaseError(
                f"{shape} is no file, no NACA designation of four or five digits (naca2412), and "
                f"no family; families: {', '.join(FAMILIES)}"
            )
        t, m, te = (own[k] if value is None else value for k, value in enumerate((t, m, te)))
        if not te < t < 0.5:
            raise CaseError(
                f"thickness {t:g} of the chord: it must lie between the trailing edge's, {te:g}, "
                "and 0.5"
            )
        contour = family.contour(t, m, te, nodes)
    if shape in FAMILIES:
        title = f"{shape}, {100 * t:.4g} % thick, {100 * m:.4g} % cambered"
    return Section(title, t, m, te, contour)


def angle(text: str) -> float:
    """Angle in rad of words such as ``"4 deg"``.

    Raises
    ------
    CaseError
        The words are no angle.
    """
    try:
        return read_quantity(text, ANGLE)
    except UnitError as error:
        raise CaseError(f'angle "{text}": {error.message}. {error.remedy}') from error


def angle_range(text: str) -> FloatArray:
    """Angles in rad of one angle, or of ``"first:last:step unit"``.

    Raises
    ------
    CaseError
        The words are neither, or too many angles.
    """
    parts = re.fullmatch(r"\s*([^:\s]+):([^:\s]+):([^:\s]+)\s+(\S+)\s*", text)
    if parts is None:
        if ":" in text:
            raise CaseError(f'angles "{text}": write first:last:step unit, such as "-4:10:0.5 deg"')
        return np.array([angle(text)])
    first, last, step = (angle(f"{parts[k]} {parts[4]}") for k in (1, 2, 3))
    if step <= 0.0 or last < first:
        raise CaseError(f'angles "{text}": the last lies before the first, or the step is not > 0')
    count = math.floor((last - first) / step * (1.0 + 1e-9) + 1e-9) + 1
    if count > MAX_ANGLES:
        raise CaseError(f'angles "{text}": {count} of them, at most {MAX_ANGLES}')
    return np.asarray(first + step * np.arange(count), dtype=np.float64)


def write_table(file: Path, heads: Sequence[str], rows: Sequence[Sequence[Any]]) -> None:
    """Write a table with commas."""
    with file.open("w", encoding="utf-8", newline="") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(heads)
        writer.writerows(rows)


def _fraction(name: str, text: str | None) -> float | None:
    if text is None:
        return None
    try:
        return float(text)
    except ValueError:
        pass
    try:
        return read_quantity(text, FRACTION)
    except UnitError as error:
        raise CaseError(f'--{name} "{text}": {error.message}. Write 0.06 or "6 %"') from error
