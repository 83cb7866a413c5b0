# SPDX-License-Identifier: LGPL-2.1-or-later
"""One nonlinear static solution, whole process, against CalculiX on the same mesh and load.

    python -m benchmarks.static [--unknowns 30000 100000 300000] [--limit SECONDS]

The tapered blade of `verification.structure_blade`, isotropic, under a following pressure that
moves its tip by a fifth of the span. Both start as fresh processes with two threads: ours imports,
reads the mesh, solves to a relative residual of 1e-6 and evaluates displacement and stress at the
nodes; CalculiX reads the deck, solves to the same tolerance with its fastest solver here and writes
displacement and stress. A run of CalculiX that takes longer than the limit is stopped; the row then
has the limit as its time and says "more than that".
"""

import argparse
import json
import os
import resource
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np

from quietblade.materials import IsotropicSVK
from quietblade.propulsion.deck import write_deck
from quietblade.propulsion.loading import Loading
from quietblade.propulsion.stress import compute_stress
from verification.calculix import CalculixError, CalculixRun, is_installed, run_calculix, version
from verification.structure_blade import TaperedBlade, TetrahedralMesh, mesh_blade

THREADS = "2"
LIMIT = 270.0
"""Seconds that CalculiX may take; keeps the whole benchmark within about seven minutes."""
OWN_LIMIT = 900.0
# Edge of the tetrahedra [m] for about so many displacement unknowns.
SIZES = {30_000: 0.0195, 100_000: 0.0116, 300_000: 0.0076}
PRESSURE = 1e4
TOLERANCE = 1e-6
PLASTIC = IsotropicSVK("plastic", 1200.0, 2.5e9, 0.35)


def solve_file(folder: Path) -> None:
    """Solve the mesh of a folder; write the nodal results and what took the time."""
    start = perf_counter()
    mesh = TetrahedralMesh.load(folder / "mesh.npz")
    structure = mesh.structure(PLASTIC)
    read = perf_counter()
    state = structure.solve(mesh.pressure(PRESSURE), tolerance=TOLERANCE)
    solved = perf_counter()
    stress = compute_stress(structure, state).regions["blade"].at_nodes.cauchy
    np.savez(folder / "ours.npz", displacement=structure.values(state), stress=stress)
    print(
        json.dumps(
            {
                "read": read - start,
                "solve": solved - read,
                "stress": perf_counter() - solved,
                "tangents": sum(step.new_tangent for step in state.newton),
                "peak_mb": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0,
            }
        )
    )


def measure_ours(folder: Path) -> dict[str, float]:
    """Wall time of a fresh process, and what it says about itself."""
    names = ("OMP_NUM_THREADS", "RAYON_NUM_THREADS", "NGS_NUM_THREADS", "OPENBLAS_NUM_THREADS")
    start = perf_counter()
    done = subprocess.run(
        [sys.executable, "-m", "benchmarks.static", "--solve", str(folder)],
        env={**os.environ, **dict.fromkeys(names, THREADS)},
        cwd=Path(__file__).resolve().parent.parent,
        capture_output=True,
        text=True,
        check=True,
        timeout=OWN_LIMIT,
    )
    return {"seconds": perf_counter() - start, **json.loads(done.stdout)}


def write_input(folder: Path, size: float) -> int:
    """Write mesh and deck to a folder; return the number of free unknowns."""
    mesh = mesh_blade(TaperedBlade(), size)
    mesh.save(folder / "mesh.npz")
    structure = mesh.structure(PLASTIC)
    loading = Loading(mesh.pressure(PRESSURE), np.zeros(structure.forms.n_displacement), 0.0)
    write_deck(folder / "blade.inp", structure, loading, tolerance=TOLERANCE, solver="SPOOLES")
    return int(np.count_nonzero(structure.forms.free))


def row(wanted: int, limit: float) -> dict[str, Any]:
    """Measure both programs at one size."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        unknowns = write_input(folder, SIZES[wanted])
        ours = measure_ours(folder)
        notes = (
            f"two threads, tolerance {TOLERANCE:g}; ours: read {ours['read']:.1f} s, solve "
            f"{ours['solve']:.1f} s with {ours['tangents']:.0f} factorisations, stress "
            f"{ours['stress']:.1f} s, the rest starts Python"
        )
        other: float | None
        try:
            theirs = run_calculix(folder / "blade.inp", threads=int(THREADS), timeout=limit)
        except CalculixError as error:
            other, notes = None, f"{notes}; no comparison: {error}"
        except subprocess.TimeoutExpired:
            other, notes = limit, f"{notes}; CalculiX stopped after {limit:.0f} s: more than that"
        else:
            other = theirs.seconds
            notes += (
                f"; CalculiX: {theirs.iterations} iterations, {theirs.peak_mb:.0f} MB, largest "
                f"difference of displacement {difference(folder, theirs):.0e}"
            )
        return {
            "id": f"structure/static-vs-calculix-{wanted // 1000}k",
            "size": f"{unknowns} unknowns",
            "ours_s": ours["seconds"],
            "other": f"CalculiX {version()}, SPOOLES" if is_installed() else "CalculiX",
            "other_s": other,
            "ratio": None if other is None else other / ours["seconds"],
            "peak_mb": ours["peak_mb"],
            "notes": notes,
        }


def difference(folder: Path, theirs: CalculixRun) -> float:
    """Largest difference of a nodal displacement over the largest displacement."""
    ours = np.load(folder / "ours.npz")["displacement"][theirs.nodes - 1]
    return float(np.abs(ours - theirs.fields["DISP"]).max() / np.abs(ours).max())


def rows(
    sizes: tuple[int, ...] = (30_000, 100_000, 300_000), limit: float = LIMIT
) -> Iterator[dict[str, Any]]:
    """Measure all sizes, the smallest first."""
    for wanted in sizes:
        yield row(wanted, limit)


def main() -> None:
    """Run what the command line selects."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.static", description=__doc__)
    parser.add_argument("--solve", type=Path, metavar="FOLDER", help="solve one mesh and leave")
    parser.add_argument("--unknowns", type=int, nargs="+", choices=SIZES, default=[*SIZES])
    parser.add_argument("--limit", type=float, default=LIMIT, help="seconds that CalculiX may take")
    options = parser.parse_args()
    if options.solve:
        solve_file(options.solve)
        return
    for measured in rows(tuple(options.unknowns), options.limit):
        print(json.dumps(measured, indent=1), flush=True)


if __name__ == "__main__":
    main()
