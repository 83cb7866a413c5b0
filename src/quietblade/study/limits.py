# SPDX-License-Identifier: LGPL-2.1-or-later
"""Limits of a case, and what can be known of its far field before a run.

The sound is imported where it is needed: a look at a case stays light.
"""
# ruff: noqa: PLC0415

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from quietblade.case import AnyCase, Finding
from quietblade.errors import Notice
from quietblade.typing import FloatArray

if TYPE_CHECKING:
    from quietblade.vibroacoustics.bands import Bands, Limit

COLUMNS = ("frequency", "level")
"""Columns of a file of a limit."""


def bands_of(kind: str, low: float, high: float) -> "Bands":
    """Bands of a kind whose centres lie in a range [Hz]."""
    from quietblade.vibroacoustics.bands import BASE_TEN, BASE_TWO, Bands

    octave = {"decidecade": BASE_TEN, "third-octave": BASE_TWO}[kind]
    return Bands.between(low, high, octave=octave)


def limits(case: AnyCase) -> "tuple[Limit, ...]":
    """Make the limits that the case gives, in its order.

    Raises
    ------
    InvalidCaseError
        A limit cannot be, or its file cannot be read.
    """
    return tuple(_limit(case, number) for number in range(len(case.limits)))


def _limit(case: AnyCase, number: int) -> "Limit":
    from quietblade.vibroacoustics.bands import Limit

    words = case.limits[number]
    if words.table is None:
        return Limit(words.name, np.array(words.frequencies), np.array(words.levels))
    try:
        frequency, level = read_limit(case.files[f"limits[{number}].table"])
        return Limit(words.name, frequency, level)
    except (OSError, ValueError) as error:
        finding = Finding(
            ("limits", number, "table"),
            str(error).rstrip("."),
            f"Write the columns {', '.join(COLUMNS)} (Hz, dB) under a header, separated by commas",
        )
        raise case.invalid(finding) from error


def read_limit(file: Path) -> tuple[FloatArray, FloatArray]:
    """Frequencies [Hz] and levels [dB] of a file of a limit.

    Raises
    ------
    ValueError
        The file is not such a table.
    OSError
        It cannot be read.
    """
    lines = file.read_text("utf-8-sig").splitlines()
    rows = [[cell.strip() for cell in line.split(",")] for line in lines if line.strip()]
    names = rows[0] if rows else []
    if tuple(names) != COLUMNS:
        raise ValueError(f"the columns are {', '.join(names) or 'unnamed'}")
    values = np.array([_pair(row) for row in rows[1:]], dtype=float).reshape(-1, 2)
    return values[:, 0], values[:, 1]


def _pair(row: list[str]) -> tuple[float, float]:
    try:
        frequency, level = map(float, row)
    except ValueError as error:
        raise ValueError(f"the row {','.join(row)!r} is not two numbers") from error
    return frequency, level


def far_field_findings(case: AnyCase, surface: FloatArray) -> Iterator[Finding]:
    """Say what of the far field cannot be: distances, places and frequencies.

    Parameters
    ----------
    case : AnyCase
    surface : (n, 3) float array
        Points of the wetted surface, closer to each other than a cell [m].
    """
    words, radius, (low, high) = case.far_field, case.acoustics.sphere_radius, case.acoustics.band
    if words.distance is not None and words.distance < radius:
        yield Finding(
            ("far_field", "distance"),
            f"is inside the sphere of {radius:g} m",
            "Choose a larger distance, or leave it out for the far field",
        )
    for number, frequency in enumerate(words.frequencies):
        if not low <= frequency <= high:
            yield Finding(
                ("far_field", "frequencies", number),
                f"lies outside the band of {low:g} to {high:g} Hz",
                "Choose a frequency of the band, or widen acoustics.band",
            )
    for number, point in enumerate(words.points):
        distance = float(np.linalg.norm(surface - np.array(point), axis=1).min())
        if distance < case.mesh.size:
            yield Finding(
                ("far_field", "points", number),
                f"is {1e3 * distance:.3g} mm from the wetted surface, less than a cell",
                f"Keep mesh.size ({1e3 * case.mesh.size:.3g} mm) away from it",
            )


def limit_notices(case: AnyCase, held: "tuple[Limit, ...]") -> Iterator[Notice]:
    """Say which limits have nothing to say about the band."""
    low, high = case.acoustics.band
    for number, (words, limit) in enumerate(zip(case.limits, held, strict=True)):
        at = np.linspace(low, high, 101)
        if words.bands != "narrow":
            bands = bands_of(words.bands, low, high)
            at = bands.centre[(bands.lower >= low) & (bands.upper <= high)]
        if not np.isfinite(limit.at(at)).any():
            yield Notice(
                f"limits[{number}]",
                f"{words.name!r} holds for no frequency or whole band of the band of {low:g} to "
                f"{high:g} Hz",
                remedy="Extend its frequencies, or acoustics.band",
            )
