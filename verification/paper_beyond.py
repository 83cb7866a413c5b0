# SPDX-License-Identifier: LGPL-2.1-or-later
"""Composite blade under load: the moved water mesh against one that is made for C1."""

from functools import cache
from pathlib import Path

import numpy as np

from quietblade.case import Case
from quietblade.results.alternatives import AlternativeTable
from quietblade.study.water_check import ANEW, MOVED, compare_water
from verification.paper_coarse import COARSE
from verification.registry import check

CASE = Path(__file__).parents[1] / "cases" / "paper-composite.toml"
SOURCE = "the same blade with the water meshed anew around its deformed surface"


@cache
def table() -> AlternativeTable:
    """Modes and peaks with both meshes."""
    return compare_water(Case.load(CASE).varied(COARSE))


@check(
    "paper/re-meshed-water-peaks",
    quantity="largest change of a peak's frequency, relative",
    reference=0.0,
    source=SOURCE,
    tolerance=1e-3,
    quick=False,
)
def peak_change() -> float:
    """Largest relative change of the frequency of a peak."""
    found = table()
    peaks = found.peak_frequency[[found.row(MOVED), found.row(ANEW)]]
    return float(np.nanmax(np.abs(peaks[1] / peaks[0] - 1.0)))
