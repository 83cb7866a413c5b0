# SPDX-License-Identifier: LGPL-2.1-or-later
"""The section solver against XFOIL processes.

    python -m benchmarks.flow

Both solve 101 NACA 0006 sections of 160 nodes at their own incidence, inviscid, and give Cp on all
nodes: ours in one call, XFOIL in one process a section, which is how codes that couple with it
use it. Ours runs in a process of its own with one thread.
"""

import json
import os
import resource
import subprocess
import sys
import tempfile
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np

from quietblade.flow import PanelSections
from tools.make_xfoil_tables import Xfoil, XfoilError, naca

SECTIONS = 101
NODES = 160
REPEATS = 5
ALPHAS = np.linspace(1.0, 8.0, SECTIONS)  # degrees
ONE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"}


def measure_ours() -> dict[str, float]:
    """Time of one solution (best of five), of one more incidence, and peak memory."""
    contours = np.repeat(naca("0006", "blunt", NODES)[None], SECTIONS, axis=0)
    solve, again = [], []
    for _ in range(REPEATS):
        start = perf_counter()
        sections = PanelSections(contours)
        solution = sections.solve(np.radians(ALPHAS))
        solve.append(perf_counter() - start)
        start = perf_counter()
        sections.solve(np.radians(ALPHAS) + 0.01)
        again.append(perf_counter() - start)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
    return {
        "solve": min(solve),
        "again": min(again),
        "peak": peak,
        "lift": float(solution.lift.sum()),
    }


def measure_xfoil(folder: Path) -> tuple[float, float]:
    """Time of 101 processes, and the sum of their lift coefficients."""
    xfoil = Xfoil(folder)
    nodes = naca("0006", "blunt", NODES)
    start = perf_counter()
    lift = sum(float(xfoil.inviscid(nodes, [alpha]).lift[0]) for alpha in ALPHAS)
    return perf_counter() - start, lift


def rows() -> list[dict[str, Any]]:
    """Measure both in one run."""
    done = subprocess.run(
        [sys.executable, "-m", "benchmarks.flow", "--ours"],
        env={**os.environ, **ONE_THREAD},
        cwd=Path(__file__).resolve().parent.parent,
        capture_output=True,
        text=True,
        check=True,
    )
    ours = json.loads(done.stdout)
    notes = f"one thread, best of {REPEATS}; one more incidence {1e3 * ours['again']:.1f} ms"
    try:
        with tempfile.TemporaryDirectory() as folder:
            other, lift = measure_xfoil(Path(folder))
    except XfoilError as error:
        other, notes = None, f"{notes}; no comparison: {error}"
    else:
        difference = abs(lift - ours["lift"]) / SECTIONS
        notes = f"{notes}; mean C_L differs by {difference:.1e}"
    return [
        {
            "id": "flow/sections-vs-xfoil",
            "size": f"{SECTIONS} sections x {NODES} nodes",
            "ours_s": ours["solve"],
            "other": "XFOIL 6.99, one process a section",
            "other_s": other,
            "ratio": None if other is None else other / ours["solve"],
            "peak_mb": ours["peak"],
            "notes": notes,
        }
    ]


if __name__ == "__main__":
    print(json.dumps(measure_ours() if "--ours" in sys.argv else rows(), indent=1))
