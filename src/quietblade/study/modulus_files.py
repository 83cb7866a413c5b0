# SPDX-License-Identifier: LGPL-2.1-or-later
"""Files of measured complex moduli."""

import csv
import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from quietblade.case import units
from quietblade.case.problems import suggestion
from quietblade.case.units import Kind, UnitError
from quietblade.typing import ComplexArray, FloatArray

FREQUENCY, STORAGE, LOSS, FACTOR, SHEAR = COLUMNS = (
    "frequency", "storage modulus", "loss modulus", "loss factor", "static shear",
)  # fmt: skip
"""Columns that a file may have."""

EXAMPLE = "frequency [Hz], storage modulus [MPa], loss modulus [MPa]"
"""A header."""

_KINDS: dict[str, Kind] = {FREQUENCY: units.FREQUENCY, STORAGE: units.MODULUS, LOSS: units.MODULUS}


@dataclass(frozen=True, eq=False)
class MeasuredModulus:
    """Complex moduli at frequencies, at one static shear.

    Attributes
    ----------
    shear : float
        Static shear of the points; zero if the file does not say.
    frequency : (f,) float array
        [Hz]
    modulus : (f,) complex array
        Storage + i loss modulus [Pa].
    """

    shear: float
    frequency: FloatArray
    modulus: ComplexArray


def read_moduli(file: Path) -> tuple[MeasuredModulus, ...]:
    """Read a table of moduli; one entry a static shear, ascending.

    Raises
    ------
    ValueError
        The file is not such a table; says the line.
    OSError
        It cannot be read.
    """
    try:
        lines = file.read_text(encoding="utf-8-sig").splitlines()
        rows = [
            (number, [cell.strip() for cell in row])
            for number, row in enumerate(csv.reader(lines), start=1)
            if any(cell.strip() for cell in row) and not row[0].lstrip().startswith("#")
        ]
    except (UnicodeDecodeError, csv.Error) as error:
        raise ValueError("it is not a table of text in UTF-8") from error
    if not rows:
        raise ValueError("the file has no table")
    columns = _columns(rows[0][1])
    table = np.array([_numbers(number, row, columns) for number, row in rows[1:]], dtype=float)
    if len(table) == 0:
        raise ValueError("there is no row below the header")
    values = dict(zip((name for name, _ in columns), table.T, strict=True))
    storage = values[STORAGE]
    modulus = storage + 1j * (values[LOSS] if LOSS in values else values[FACTOR] * storage)
    shear = values.get(SHEAR, np.zeros(len(table)))
    groups = []
    for amount in np.unique(shear):
        own = np.flatnonzero(shear == amount)
        own = own[np.argsort(values[FREQUENCY][own], kind="stable")]
        if len(own) < 2:
            raise ValueError(f"there are fewer than two points at the static shear {amount:g}")
        groups.append(MeasuredModulus(float(amount), values[FREQUENCY][own], modulus[own]))
    return tuple(groups)


def _columns(header: list[str]) -> list[tuple[str, float]]:
    """Name of each column, and the SI value of one of its unit."""
    columns = [_column(cell) for cell in header]
    names = [name for name, _ in columns]
    if len(set(names)) < len(names):
        raise ValueError(f"the columns are {', '.join(names)}: one stands twice")
    for wanted in ({FREQUENCY}, {STORAGE}, {LOSS, FACTOR}):
        if len(wanted & set(names)) != 1:
            raise ValueError(
                f"the columns are {', '.join(names)}: exactly one {' or '.join(sorted(wanted))} is "
                "needed"
            )
    return columns


def _column(cell: str) -> tuple[str, float]:
    label, bracket, rest = cell.partition("[")
    name, unit = " ".join(label.lower().replace("_", " ").split()), rest.rstrip("] ").strip()
    if name not in COLUMNS:
        near = suggestion(name, COLUMNS)
        raise ValueError(f'the header has a column "{cell}". {near}'.rstrip())
    kind = _KINDS.get(name)
    if kind is None:
        if unit not in ("", "1"):
            raise ValueError(f'the column "{cell}" is a plain number and has no unit')
        return name, 1.0
    if not bracket:
        raise ValueError(f'the column "{cell}" has no unit; write "{name} [{kind.usual[-1]}]"')
    try:
        return name, units.convert_factor(unit, kind)
    except UnitError as error:
        raise ValueError(f'the column "{cell}": {error.message}') from error


def _numbers(line: int, row: list[str], columns: list[tuple[str, float]]) -> list[float]:
    if len(row) != len(columns):
        raise ValueError(f"line {line} has {len(row)} values for {len(columns)} columns")
    values = []
    for cell, (name, factor) in zip(row, columns, strict=True):
        try:
            value = factor * float(cell)
        except ValueError:
            value = math.nan
        positive = name in (FREQUENCY, STORAGE)
        if not math.isfinite(value) or value < 0.0 or (positive and value == 0.0):
            what = "positive" if positive else "zero or positive"
            raise ValueError(f'line {line}: the {name} is "{cell}" and must be {what}')
        values.append(value)
    return values
