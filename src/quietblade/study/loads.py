# SPDX-License-Identifier: LGPL-2.1-or-later
"""Steady loads and support of a case, besides the flow and the spin."""

from math import inf
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from quietblade.case import Case, Finding
from quietblade.case.structure import (
    GravityWords,
    HydrostaticWords,
    LineForceWords,
    PointForceWords,
    PressureLoadWords,
)
from quietblade.geometry import Blade
from quietblade.propulsion.loads import (
    Gravity,
    HydrostaticPressure,
    LineForce,
    Load,
    LoadError,
    PointForce,
    PressureTable,
    UniformPressure,
)
from quietblade.study.columns import read_columns
from quietblade.typing import FloatArray

if TYPE_CHECKING:
    from quietblade.propulsion.supports import RootSpring

COLUMNS = ("span", "chord", "upper", "lower")
"""Columns of a file of pressures."""

_CORNERS = 33  # of a line on the curved face
_OFF = 0.02  # of the chord: how far the mesh's faces may be from the blade's


def support(case: Case) -> "RootSpring | None":
    """Springs under the root, None if it is clamped."""
    from quietblade.propulsion.supports import RootSpring  # noqa: PLC0415  # finite elements

    if case.root.support == "clamped":
        return None
    held = (inf, inf, inf)
    return RootSpring(case.root.translation or held, case.root.rotation or held)


def steady_loads(case: Case, blade: Blade) -> tuple[Load, ...]:
    """Make the loads that the case gives, in its order.

    Raises
    ------
    InvalidCaseError
        A load is impossible, or its file cannot be read.
    """
    return tuple(_load(case, blade, number) for number in range(len(case.loads)))


def _load(case: Case, blade: Blade, number: int) -> Load:
    words = case.loads[number]
    match words:
        case PressureLoadWords():
            if words.value is not None:
                return UniformPressure(words.value)
            key = f"loads[{number}].table"
            try:
                return read_pressures(case.files[key])
            except (LoadError, OSError, ValueError) as error:
                finding = Finding(
                    ("loads", number, "table"),
                    str(error).rstrip("."),
                    f"Write the columns {', '.join(COLUMNS)} under a header, separated by commas",
                )
                raise case.invalid(finding) from error
        case PointForceWords():
            x, y, z = on_face(blade, words.face, np.array([words.at]))[0].tolist()
            return PointForce((x, y, z), words.force, _tolerance(blade))
        case LineForceWords():
            path = line_on_face(blade, words.face, words.start, words.end)
            return LineForce(path, np.array(words.force), _tolerance(blade))
        case GravityWords():
            return Gravity(words.acceleration)
        case HydrostaticWords():
            return HydrostaticPressure(case.water.density, words.depth)


def read_pressures(file: Path) -> PressureTable:
    """Read a table of pressures over span and chord fraction, on both faces.

    Raises
    ------
    ValueError
        The file is not such a table, or its places are not a full grid.
    OSError
        It cannot be read.
    LoadError
        The grid does not reach from 0 to 1, or a value is not finite.
    """
    table = read_columns(file, COLUMNS)
    s, xi = np.unique(table["span"]), np.unique(table["chord"])
    order = np.lexsort((table["chord"], table["span"]))
    grid = np.stack(np.meshgrid(s, xi, indexing="ij"), axis=-1).reshape(-1, 2)
    places = np.stack([table["span"], table["chord"]], axis=1)[order]
    if grid.shape != places.shape or not np.array_equal(grid, places):
        raise ValueError(
            f"{len(table)} rows are not a grid of {len(s)} span by {len(xi)} chord fractions"
        )
    upper, lower = (table[side][order].reshape(len(s), len(xi)) for side in ("upper", "lower"))
    return PressureTable(s, xi, upper, lower)


def line_on_face(
    blade: Blade, face: str, start: tuple[float, float], end: tuple[float, float]
) -> FloatArray:
    """Corners (n, 3) of a line on a face that is straight in the planform [m]."""
    share = np.linspace(0.0, 1.0, _CORNERS)[:, None]
    return on_face(blade, face, (1.0 - share) * np.array(start) + share * np.array(end))


def on_face(blade: Blade, face: str, places: FloatArray) -> FloatArray:
    """Points (n, 3) of a face at span and chord fractions (n, 2)."""
    s, xi = places.T
    height = blade.face_height(1 if face == "upper" else -1, s, xi)
    return np.asarray(blade.place(s, np.stack([xi, height], axis=-1)))


def _tolerance(blade: Blade) -> float:
    return _OFF * float(blade.chord(np.linspace(0.0, 1.0, 11)).max())
