# SPDX-License-Identifier: LGPL-2.1-or-later
"""Names of the excitations of a case, and their tables over frequency."""

from pathlib import Path
from typing import TypeAlias

import numpy as np

from quietblade.case import AnyCase, Finding
from quietblade.study.columns import read_columns
from quietblade.typing import AnyArray, FloatArray

HARMONIC_COLUMNS = ("frequency", "amplitude", "phase")
RANDOM_COLUMNS = ("frequency", "density")

Table: TypeAlias = tuple[FloatArray, AnyArray]
"""Frequencies [Hz], and complex amplitudes or real densities."""


def names(case: AnyCase) -> tuple[str, ...]:
    """Names of the excitations: as given, or the kind, with a number where that is not enough."""
    taken = [words.name for words in case.excitation if words.name]
    found: list[str] = []
    for words in case.excitation:
        name, count = words.name or words.kind, 1
        while not words.name and name in (*taken, *found):
            count += 1
            name = f"{words.kind} {count}"
        found.append(name)
    return tuple(found)


def spectra(case: AnyCase) -> dict[int, Table]:
    """Frequencies and values of the excitations that have a table, by number.

    Raises
    ------
    InvalidCaseError
        A file cannot be read, is not such a table, or does not cover the band.
    """
    random = case.acoustics.signal == "random"
    columns = ", ".join(RANDOM_COLUMNS if random else HARMONIC_COLUMNS)
    found, findings = {}, []
    for number, words in enumerate(case.excitation):
        if words.table is None:
            continue
        at = ("excitation", number, "table")
        try:
            found[number] = read_spectrum(case.files[f"excitation[{number}].table"], random=random)
        except (OSError, ValueError) as error:
            remedy = f"Write the columns {columns} under a header, separated by commas"
            findings.append(Finding(at, str(error).rstrip("."), remedy))
            continue
        (low, high), known = case.acoustics.band, found[number][0]
        if low < known[0] or high > known[-1]:
            fault = (
                f"is for {known[0]:g} to {known[-1]:g} Hz, and the band for {low:g} to {high:g} Hz"
            )
            findings.append(Finding(at, fault, "Extend the table, or narrow the band"))
    if findings:
        raise case.invalid(*findings)
    return found


def read_spectrum(file: Path, *, random: bool = False) -> Table:
    """Read amplitudes or densities over frequency.

    Parameters
    ----------
    file : Path
        Columns frequency [Hz], amplitude [SI] and, if need be, phase [deg]; for random loads
        frequency and density [SI unit squared per Hz].
    random : bool

    Raises
    ------
    ValueError
        The file is not such a table.
    OSError
        It cannot be read.
    """
    known = (RANDOM_COLUMNS,) if random else (HARMONIC_COLUMNS, HARMONIC_COLUMNS[:2])
    table = read_columns(file, *known)
    titles = table.dtype.names or ()
    if not all(np.all(np.isfinite(table[title])) for title in titles):
        raise ValueError("an entry is missing or is not a finite number")
    frequency, value = table["frequency"], table[titles[1]]
    if len(table) < 2 or np.any(np.diff(frequency) <= 0.0):
        raise ValueError("two or more ascending frequencies are needed")
    if random:
        if np.any(value < 0.0):
            raise ValueError("a density is negative")
        return frequency, value
    phase = np.radians(table["phase"]) if "phase" in titles else np.zeros(len(table))
    return frequency, value * np.exp(1j * phase)
