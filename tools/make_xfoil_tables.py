# SPDX-License-Identifier: LGPL-2.1-or-later
"""Make the tables of ``tests/data/xfoil`` with the program XFOIL (Drela, MIT; tried: 6.99).

    python -m tools.make_xfoil_tables

Needs the programs ``xfoil`` and ``gcc``. Debian's XFOIL traps floating-point exceptions and dies at
its first solution; a small library that is loaded before it takes the traps out.

Files made: ``<section>-<edge>.csv`` with the nodes and XFOIL's Cp at `ALPHAS`,
``coefficients.csv`` with its C_L, pressure drag and C_M about the quarter chord,
``viscous.csv`` with polars and the places of free transition (N = 9) of sharp sections,
``layer-<section>.csv`` with a boundary layer at Re = 1e6 without incidence,
``stall-reynolds.csv`` with the incidence of greatest lift of viscous sweeps.
"""

import contextlib
import csv
import os
import shutil
import subprocess
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

FOLDER = Path(__file__).resolve().parent.parent / "tests" / "data" / "xfoil"
SECTIONS = ("0006", "0012", "2412", "4415")
EDGES = ("blunt", "sharp")
ALPHAS = (0.0, 4.0, 8.0)
NODES = 160
STALL_SECTIONS = ("0006", "0009", "0012")
STALL_REYNOLDS = (3.8e5, 1.2e6, 3e6)
VISCOUS_SECTIONS = {
    "0006": 4.0,
    "0009": 6.0,
    "0012": 6.0,
    "2412": 6.0,
}  # largest incidence, degrees
VISCOUS_REYNOLDS = (4e5, 1e6, 3e6)
LAYER_SECTION, LAYER_REYNOLDS = "0012", 1e6

_NO_TRAPS = """
void _gfortran_set_fpe(int traps) { (void)traps; }
int feenableexcept(int traps) { (void)traps; return 0; }
"""


class XfoilError(RuntimeError):
    """XFOIL is not there, or did not give a solution."""


@dataclass(frozen=True)
class Solution:
    """Inviscid results at A incidences on N nodes."""

    cp: Array
    lift: Array
    drag: Array
    moment: Array


class Xfoil:
    """XFOIL in a working folder, one process a call."""

    def __init__(self, folder: Path) -> None:
        for program in ("xfoil", "gcc"):
            if shutil.which(program) is None:
                raise XfoilError(f"the program {program} is not installed")
        self.folder = folder
        source, self.library = folder / "no_traps.c", folder / "no_traps.so"
        source.write_text(_NO_TRAPS, encoding="utf-8")
        subprocess.run(["gcc", "-shared", "-fPIC", "-o", self.library, source], check=True)

    def inviscid(self, nodes: Array, alphas: Sequence[float]) -> Solution:
        """Solve the section (N, 2) as given, at incidences in degrees."""
        sweep = [line for k, a in enumerate(alphas) for line in (f"ALFA {a:g}", f"CPWR cp{k}.txt")]
        for k in range(len(alphas)):
            (self.folder / f"cp{k}.txt").unlink(missing_ok=True)
        polar = self._run(nodes, ["OPER", "PACC", "polar.txt", "", *sweep], timeout=60.0)
        if len(polar) != len(alphas):
            raise XfoilError(f"XFOIL solved {len(polar)} of {len(alphas)} incidences")
        tables = [np.loadtxt(self.folder / f"cp{k}.txt", skiprows=1) for k in range(len(alphas))]
        cp = np.array([table[:, -1] for table in tables])
        return Solution(cp, polar[:, 1], polar[:, 3], polar[:, 4])

    def viscous_sweep(
        self, nodes: Array, reynolds: float, last: float, step: float = 0.25
    ) -> Array:
        """Polar of the incidences from 0 that converge, free transition with N = 9.

        Columns: incidence [deg], C_L, C_D, pressure drag, C_M, transition on the upper and on the
        lower side (x/c).
        """
        sweep = f"ASEQ 0 {last:g} {step:g}"
        commands = ["OPER", "ITER 200", f"VISC {reynolds:g}", "PACC", "polar.txt", "", sweep]
        return self._run(nodes, commands, timeout=120.0)[:, :7]

    def layer(self, nodes: Array, reynolds: float, alpha: float) -> Array:
        """Boundary layer of the upper side, from the stagnation point to the trailing edge.

        Columns: arc length on the contour, x, edge speed, momentum thickness, shape factor.
        """
        commands = ["ITER 200", f"VISC {reynolds:g}", "PACC", "polar.txt", "", f"ALFA {alpha:g}"]
        self._run(nodes, ["OPER", *commands, "DUMP layer.txt"], timeout=60.0)
        lines = (self.folder / "layer.txt").read_text(encoding="utf-8").splitlines()[1:]
        table = np.array([line.split()[:8] for line in lines[: len(nodes)]], dtype=np.float64)
        return table[table[:, 3] > 0.0][:, [0, 1, 3, 5, 7]]

    def _run(self, nodes: Array, commands: Sequence[str], timeout: float) -> Array:
        """Run commands on the nodes; return the polar's rows."""
        (self.folder / "polar.txt").unlink(missing_ok=True)
        np.savetxt(self.folder / "section.dat", nodes, fmt="%.8f", header="section", comments="")
        start = ["PLOP", "G F", "", "LOAD section.dat", "PCOP"]
        # Beyond stall XFOIL may never return; the polar holds what it solved before.
        with contextlib.suppress(subprocess.TimeoutExpired):
            subprocess.run(
                ["xfoil"],
                input="\n".join([*start, *commands, "", "QUIT", ""]),
                text=True,
                cwd=self.folder,
                env={**os.environ, "LD_PRELOAD": str(self.library)},
                capture_output=True,
                timeout=timeout,
                check=False,
            )
        polar = self.folder / "polar.txt"
        if not polar.exists():
            raise XfoilError("XFOIL gave no solution (floating-point trap?)")
        return np.loadtxt(polar, skiprows=12, ndmin=2)


def naca(digits: str, edge: str, n: int = NODES) -> Array:
    """NACA 4-digit section (n, 2) from the upper to the lower trailing edge, cosine spacing.

    The blunt edge is that of the original polynomial; for the sharp one its last coefficient is
    0.1036, as usual. Jacobs, Ward, Pinkerton, NACA Report 460 (1933).
    """
    m, p, t = int(digits[0]) / 100.0, int(digits[1]) / 10.0, int(digits[2:]) / 100.0
    turn = np.linspace(0.0, 2.0 * np.pi, n)
    x, side = 0.5 * (1.0 + np.cos(turn)), np.sign(np.pi - turn)
    last = 0.1036 if edge == "sharp" else 0.1015
    half = 0.2969 * np.sqrt(x) - 0.126 * x - 0.3516 * x**2 + 0.2843 * x**3 - last * x**4
    curvature = m / np.where(x < p, max(p, 0.1) ** 2, (1.0 - p) ** 2)
    slope = -2.0 * curvature * (x - p)
    offset = 5.0 * t * side * half / np.hypot(1.0, slope)
    nodes = np.stack([x - offset * slope, m - curvature * (x - p) ** 2 + offset], axis=-1)
    if edge == "sharp":
        nodes[0] = nodes[-1] = 0.5 * (nodes[0] + nodes[-1])
    return nodes.round(8)


def write(path: Path, header: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
    """Write a small table."""
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        writer.writerows(rows)


def make_inviscid_tables(xfoil: Xfoil) -> None:
    """Cp at the nodes in a file for each section, coefficients in one file."""
    coefficients = []
    for name in SECTIONS:
        for edge in EDGES:
            nodes = naca(name, edge)
            solution = xfoil.inviscid(nodes, ALPHAS)
            rows = [
                [f"{x:.8f}", f"{y:.8f}", *(f"{value:.5f}" for value in cp)]
                for (x, y), cp in zip(nodes, solution.cp.T, strict=True)
            ]
            header = ["x", "y", *(f"cp_{alpha:g}" for alpha in ALPHAS)]
            write(FOLDER / f"naca{name}-{edge}.csv", header, rows)
            for alpha, cl, cd, cm in zip(
                ALPHAS, solution.lift, solution.drag, solution.moment, strict=True
            ):
                figures = (f"{alpha:g}", f"{cl:.4f}", f"{cd:.5f}", f"{cm:.4f}")
                coefficients.append([f"naca{name}", edge, *figures])
    header = ["section", "edge", "alpha_deg", "cl", "cd_pressure", "cm_quarter"]
    write(FOLDER / "coefficients.csv", header, coefficients)


def stall_row(xfoil: Xfoil, name: str, reynolds: float) -> list[str]:
    """Incidence of greatest lift of a symmetric section."""
    sweep = xfoil.viscous_sweep(naca(name, "sharp"), reynolds, last=20.0)
    alpha, lift = sweep[np.argmax(sweep[:, 1]), :2]
    figures = (f"{int(name) / 100:g}", f"{reynolds:g}", f"{alpha:.2f}", f"{lift:.4f}")
    return [f"naca{name}", *figures]


def make_stall_table(xfoil: Xfoil) -> None:
    """Incidence of greatest lift of symmetric sections."""
    rows = [stall_row(xfoil, name, re) for name in STALL_SECTIONS for re in STALL_REYNOLDS]
    header = ["section", "thickness", "reynolds", "alpha_deg", "cl"]
    write(FOLDER / "stall-reynolds.csv", header, rows)


def make_viscous_table(xfoil: Xfoil) -> None:
    """Drag and transition of attached flow."""
    rows = []
    for name, last in VISCOUS_SECTIONS.items():
        for reynolds in VISCOUS_REYNOLDS:
            polar = xfoil.viscous_sweep(naca(name, "sharp"), reynolds, last, step=1.0)
            for alpha, cl, cd, _, cm, upper, lower in polar:
                figures = (f"{alpha:g}", f"{cl:.4f}", f"{cd:.5f}", f"{cm:.4f}")
                places = (f"{upper:.4f}", f"{lower:.4f}")
                rows.append([f"naca{name}", f"{reynolds:g}", *figures, *places])
    header = [
        "section",
        "reynolds",
        "alpha_deg",
        "cl",
        "cd",
        "cm_quarter",
        "upper_xtr",
        "lower_xtr",
    ]
    write(FOLDER / "viscous.csv", header, rows)


def make_layer_table(xfoil: Xfoil) -> None:
    """One boundary layer station by station, with XFOIL's edge speed."""
    table = xfoil.layer(naca(LAYER_SECTION, "sharp"), LAYER_REYNOLDS, 0.0)
    rows = [[f"{value:.6g}" for value in row] for row in table]
    write(FOLDER / f"layer-naca{LAYER_SECTION}.csv", ["s", "x", "speed", "theta", "h"], rows)


def main() -> None:
    """Make all tables."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        xfoil = Xfoil(Path(folder))
        make_inviscid_tables(xfoil)
        make_viscous_table(xfoil)
        make_layer_table(xfoil)
        make_stall_table(xfoil)


if __name__ == "__main__":
    main()
