# SPDX-License-Identifier: LGPL-2.1-or-later
"""The panel method against XFOIL on the same nodes.

Tables: ``tests/data/xfoil``, made by ``tools/make_xfoil_tables.py``. The formulations are the same,
so that the differences are the rounding of XFOIL's print: half a unit of the last decimal.
"""

import csv
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from quietblade.flow import PanelSections, PanelSolution
from verification.registry import check

FOLDER = Path(__file__).resolve().parent.parent / "tests" / "data" / "xfoil"
SOURCE = "XFOIL 6.99 (Drela 1989), inviscid, the same nodes"
CP_ROUNDING = 5.0e-6 * (1.0 + 1e-3)  # five decimals; the rest is for the binary print
COEFFICIENT_ROUNDING = 5.0e-5 * (1.0 + 1e-3)  # four decimals
DRAG_ROUNDING = 5.0e-6 * (1.0 + 1e-3)  # five decimals


def pressure_table(section: str, edge: str) -> NDArray[np.float64]:
    """Columns x, y and Cp at the incidences (160, 2 + A)."""
    return np.loadtxt(FOLDER / f"{section}-{edge}.csv", delimiter=",", skiprows=1)


@cache
def coefficient_table(section: str, edge: str) -> NDArray[np.float64]:
    """Columns incidence [rad], C_L, pressure drag, C_M about the quarter chord (A, 4)."""
    with (FOLDER / "coefficients.csv").open(encoding="utf-8", newline="") as file:
        rows = [row for row in csv.reader(file) if row[:2] == [section, edge]]
    table = np.array([[float(figure) for figure in row[2:]] for row in rows])
    table[:, 0] = np.radians(table[:, 0])
    return table


@cache
def solved(section: str, edge: str) -> PanelSolution:
    """Panel solution with leading axes (A, 1)."""
    nodes = pressure_table(section, edge)[:, :2]
    return PanelSections(nodes[None]).solve(coefficient_table(section, edge)[:, :1])


def enter(section: str, edge: str) -> None:
    """Register the rows of one section."""
    name = f"flow/xfoil-{section}" + ("" if edge == "blunt" else f"-{edge}")
    where = f"{section.upper()} with {edge} edge at 0, 4 and 8 deg, 160 nodes"

    @check(
        f"{name}-cp",
        quantity=f"largest difference of Cp, {where}",
        reference=0.0,
        source=SOURCE,
        tolerance=CP_ROUNDING,
    )
    def cp() -> float:
        table = pressure_table(section, edge)[:, 2:].T
        return float(np.abs(solved(section, edge).cp[:, 0] - table).max())

    @check(
        f"{name}-cl",
        quantity=f"largest difference of C_L, {where}",
        reference=0.0,
        source=SOURCE,
        tolerance=COEFFICIENT_ROUNDING,
    )
    def cl() -> float:
        return difference(solved(section, edge).lift, 1)

    @check(
        f"{name}-cd",
        quantity=f"largest difference of the pressure drag, {where}",
        reference=0.0,
        source=SOURCE,
        tolerance=DRAG_ROUNDING,
    )
    def cd() -> float:
        return difference(solved(section, edge).drag, 2)

    @check(
        f"{name}-cm",
        quantity=f"largest difference of C_M about the quarter chord, {where}",
        reference=0.0,
        source=SOURCE,
        tolerance=COEFFICIENT_ROUNDING,
    )
    def cm() -> float:
        return difference(solved(section, edge).moment, 3)

    def difference(ours: NDArray[np.float64], column: int) -> float:
        return float(np.abs(ours[:, 0] - coefficient_table(section, edge)[:, column]).max())


for _section in ("naca0006", "naca0012", "naca2412", "naca4415"):
    for _edge in ("blunt", "sharp"):
        enter(_section, _edge)
