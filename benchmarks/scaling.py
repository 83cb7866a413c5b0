# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cost of one frequency of the composite blade in water against the number of unknowns.

    python -m benchmarks.scaling [--sizes 28 20 14 10] [--precision double]

Time of analysis and factorisation, of one more solution, and memory, with the exponents of a
straight line through their logarithms.  The blade is at rest, so that no steady solution has to be
found first; the sphere has a radius of 3 m.  Each size is a process of its own with two threads; it
is stopped, and none larger is tried, if its memory would pass the limit.  To the limit of 20 GB:

    python -m benchmarks.scaling --sizes 34 20 14 10.5 8.5 7 6 5.2
"""

import argparse
import json
import os
import resource
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np

from benchmarks.run import RECORD, record
from quietblade.linalg import make_solver
from quietblade.vibroacoustics.reduced import ASIDE
from verification.acoustics_blade import resting_blade

THREADS = "2"
SIZES = (34.0, 20.0, 14.0, 10.5)
"""Mesh sizes on the blade [mm]: about 30 000 to 200 000 unknowns."""
MEMORY = 20e9
"""Bytes that one process may take."""
LIMIT = 1800.0
"""Seconds that one process may take."""
FREQUENCY = 150.0
MEASURED = {
    "factor_s": "analysis and factorisation",
    "solve_s": "solution",
    "factor_mb": "size of the factor",
    "peak_mb": "peak memory",
}


def measure(size: float, precision: str) -> dict[str, float]:
    """Factor and solve at one frequency, in this process; ``size`` in millimetres."""
    resource.setrlimit(resource.RLIMIT_DATA, (int(MEMORY), int(MEMORY)))
    blade = resting_blade(
        {
            "mesh.size": f"{size:g} mm",
            "acoustics.radiation": "bgt1",
            "acoustics.sphere_radius": "3 m",
        }
    )
    operators = blade.system()
    load = blade.load(operators).astype(complex)
    matrix = operators.at(2.0 * np.pi * FREQUENCY * ASIDE)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
    solver = make_solver(
        "rslab", precision="mixed" if precision == "mixed" else "double", tolerance=1e-8
    )
    start = perf_counter()
    factor = solver.factor(matrix)
    factored = perf_counter()
    factor.solve(load)
    return {
        "unknowns": operators.size,
        "entries": matrix.nnz,
        "factor_s": factored - start,
        "solve_s": perf_counter() - factored,
        "factor_mb": factor.memory_bytes / 1e6,
        "before_mb": before,
        "peak_mb": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0,
    }


def apart(size: float, precision: str) -> dict[str, float]:
    """Measure in a fresh process."""
    names = ("OMP_NUM_THREADS", "RAYON_NUM_THREADS", "NGS_NUM_THREADS", "OPENBLAS_NUM_THREADS")
    done = subprocess.run(
        [sys.executable, "-m", "benchmarks.scaling", "--one", str(size), "--precision", precision],
        env={**os.environ, **dict.fromkeys(names, THREADS)},
        cwd=Path(__file__).resolve().parent.parent,
        capture_output=True,
        text=True,
        check=False,
        timeout=LIMIT,
    )
    if done.returncode:
        raise RuntimeError("".join(done.stderr.strip().splitlines()[-1:]) or "no memory was left")
    found: dict[str, float] = json.loads(done.stdout)
    return found


def exponent(measured: Sequence[Mapping[str, float]], name: str) -> float:
    """Slope of the logarithm of a figure over that of the unknowns."""
    unknowns = [m["unknowns"] for m in measured]
    return float(np.polyfit(np.log(unknowns), np.log([m[name] for m in measured]), 1)[0])


def rows(sizes: Sequence[float] = SIZES, precision: str = "double") -> Iterator[Mapping[str, Any]]:
    """Measure all sizes, the coarsest first, and the exponents."""
    measured: list[dict[str, float]] = []
    end = "all sizes were measured"
    for size in sorted(sizes, reverse=True):
        try:
            found = apart(size, precision)
        except (RuntimeError, subprocess.TimeoutExpired) as error:
            end = f"cells of {size:g} mm were not measured: {error}"
            break
        measured.append(found)
        yield {
            "id": f"acoustics/scaling-{precision}-{len(measured)}",
            "size": f"{found['unknowns']} unknowns, {found['entries']} entries",
            "ours_s": found["factor_s"] + found["solve_s"],
            "other": None,
            "other_s": None,
            "ratio": None,
            "peak_mb": found["peak_mb"],
            "notes": f"two threads, cells of {size:g} mm; factorisation with its analysis "
            f"{found['factor_s']:.1f} s, solution {found['solve_s']:.2f} s, factor "
            f"{found['factor_mb']:.0f} MB; {found['before_mb']:.0f} MB were taken before it",
        }
    if len(measured) < 2:
        raise RuntimeError(f"scaling: two sizes are the least for an exponent; {end}")
    slopes = ", ".join(f"{words} {exponent(measured, n):.2f}" for n, words in MEASURED.items())
    yield {
        "id": f"acoustics/scaling-{precision}-exponents",
        "size": f"{measured[0]['unknowns']} to {measured[-1]['unknowns']} unknowns",
        "ours_s": sum(found["factor_s"] + found["solve_s"] for found in measured),
        "other": None,
        "other_s": None,
        "ratio": None,
        "peak_mb": max(found["peak_mb"] for found in measured),
        "notes": f"exponents over the unknowns: {slopes}; {end}; larger ones with --sizes",
    }


def main() -> None:
    """Run what the command line selects."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.scaling", description=__doc__)
    parser.add_argument("--sizes", type=float, nargs="+", default=[*SIZES], help="mesh sizes [mm]")
    parser.add_argument("--precision", choices=("double", "mixed"), default="double")
    parser.add_argument("--out", type=Path, default=RECORD, help="where the rows are put")
    parser.add_argument("--one", type=float, metavar="SIZE", help="measure one size and leave")
    options = parser.parse_args()
    if options.one is not None:
        print(json.dumps(measure(options.one, options.precision)))
        return
    record(rows(options.sizes, options.precision), options.out)


if __name__ == "__main__":
    main()
