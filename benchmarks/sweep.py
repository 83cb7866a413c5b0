# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reduced sweep of the composite blade under load against direct solves, in one run.

    python -m benchmarks.sweep [--size "12 mm"]

A hundred and one frequencies from 100 to 200 Hz.  The direct sweep of all of them would take the
better part of an hour: the frequencies held out to judge the reduced model are solved, and their
mean time counts for the others.  Among them are the model's peaks in the band, where it is hardest;
the others lie between the frequencies that the reduced sweep was asked for.  Each measurement is a
process of its own with two threads that reads the matrices from a file, so that its peak memory is
that of the sweep with its matrices.
"""

import argparse
import json
import os
import pickle
import resource
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np

from benchmarks.run import RECORD, record
from quietblade.linalg import SolverChain, make_solver
from quietblade.materials.viscoelastic import FractionalZener
from quietblade.typing import FloatArray
from quietblade.vibroacoustics.loss import Lossy
from quietblade.vibroacoustics.operators import Operators
from quietblade.vibroacoustics.peaks import find_peaks
from quietblade.vibroacoustics.power import level, radiated_power
from quietblade.vibroacoustics.reduced import reduce_system
from quietblade.vibroacoustics.sweep import solve_point
from verification.acoustics_blade import WetBlade, loaded_blade

THREADS = "2"
SIZE = "12 mm"
"""Mesh size on the blade for more than 150 000 unknowns."""
CASE = {
    "acoustics.band": ["100 Hz", "200 Hz"],
    "acoustics.radiation": "bgt1",
    "acoustics.sphere_radius": "3 m",
}
"""What is changed in the preset."""

BAND = (100.0, 200.0)
FREQUENCIES = np.linspace(*BAND, 101)
ACCURACY = 1e-3
"""Wanted accuracy of the level [dB]."""
ROUNDING = 1e-7
"""What residuals of 1e-9 leave in levels of the direct sweep [dB]: no estimate is held to it."""
LIMIT = 1800.0
"""Seconds that one process may take."""

ZENER = FractionalZener(stiffening=20.0, tau=1e-4, alpha=0.5)
"""Film of the variant: its modulus doubles and its loss factor is about a quarter in the band."""

TOLERANCES = {"double": 1e-9, "mixed": 1e-6}
"""Of the solver's residual: a Krylov vector that is a little off still serves the space, whose
error is estimated with the whole A(omega)."""

SYSTEMS = {"bgt1": 20, "dtn": 4, "zener": 4}
"""Held-out frequencies of each system."""


IDS = {("bgt1", "double"): "acoustics/sweep-reduced-vs-direct"}
"""Names of rows that are not made of system and precision."""


def make_systems(folder: Path, size: str) -> None:
    """Write the matrices and loads of all systems into a folder."""
    blade = loaded_blade({**CASE, "mesh.size": size})
    film = Lossy(blade.tangent.film_isochoric_material, ZENER)
    systems = {
        "bgt1": blade.system(),
        "dtn": blade.system(blade.exact_condition()),
        "zener": blade.system(loss={"film": film}),
    }
    for name, operators in systems.items():
        write_system(folder / name, blade, operators)


def write_system(file: Path, blade: WetBlade, operators: Operators) -> None:
    """Write one system for another process."""
    file.write_bytes(pickle.dumps((operators, blade.load(operators)), protocol=5))


def read_system(file: Path) -> tuple[Operators, FloatArray]:
    """Read what `write_system` has written, in this very run."""
    with file.open("rb") as stream:
        operators, load = pickle.load(stream)
    return operators, load


def peak_mb() -> float:
    """Largest memory of this process so far [MB]."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0


def solver_of(precision: str) -> SolverChain:
    """Make the solver of both sweeps."""
    return make_solver(
        precision="mixed" if precision == "mixed" else "double", tolerance=TOLERANCES[precision]
    )


def measure_reduced(file: Path, precision: str, held_out: int | list[float]) -> dict[str, Any]:
    """Sweep by the reduced model; its levels and estimates at the frequencies held out.

    Their number may be given instead: they are then chosen with the model's peaks among them.
    """
    operators, load = read_system(file)
    start = perf_counter()
    solver = solver_of(precision)
    sweep = reduce_system(operators, load, FREQUENCIES, tolerance=ACCURACY, solver=solver)
    levels = level(sweep.model.radiated(2.0 * np.pi * FREQUENCIES))
    seconds = perf_counter() - start
    peaks = find_peaks(sweep, BAND).frequency
    with_peaks = perf_counter() - start
    frequency = (
        held_out_frequencies(peaks, held_out) if isinstance(held_out, int) else np.array(held_out)
    )
    return {
        "unknowns": operators.size,
        "seconds": seconds,
        "with_peaks": with_peaks,
        "peak_mb": peak_mb(),
        "factor_mb": sweep.report.largest_factor / 1e6,
        "factor_s": sweep.report.seconds,
        "solver": ", ".join(sweep.report.factorizations),
        "factorizations": sum(sweep.report.factorizations.values()),
        "vectors": sweep.certificate.vectors,
        "size": sweep.certificate.size,
        "span_db": float(np.ptp(levels)),
        "frequency": frequency.tolist(),
        "level": level(sweep.model.radiated(2.0 * np.pi * frequency)).tolist(),
        "estimate": sweep.estimate(frequency).tolist(),
    }


def held_out_frequencies(peaks: FloatArray, count: int) -> FloatArray:
    """Even frequencies off the grid, the nearest ones moved to the peaks; half of them at most."""
    step = (BAND[1] - BAND[0]) / count
    frequency = BAND[0] + step * (np.arange(count) + 0.5)
    for peak in peaks[: count // 2]:
        frequency[np.argmin(np.abs(frequency - peak))] = peak
    return np.sort(frequency)


def measure_direct(file: Path, precision: str, frequency: list[float]) -> dict[str, Any]:
    """Solve one frequency after the other; the first one also analyses the pattern."""
    operators, load = read_system(file)
    solver = solver_of(precision)
    seconds, levels = [], []
    for f in frequency:
        start = perf_counter()
        point = solve_point(operators, f, load, solver)
        if point.solution is None:
            raise RuntimeError(point.failure)
        omega = np.array([2.0 * np.pi * f])
        power = radiated_power(operators, omega, point.solution[None])
        seconds.append(perf_counter() - start)
        levels.append(float(level(power)[0]))
    mean = float(np.mean(seconds[1:]))
    return {
        "first": seconds[0],
        "mean": mean,
        "all": seconds[0] + (len(FREQUENCIES) - 1) * mean,
        "level": levels,
        "peak_mb": peak_mb(),
    }


def apart(task: str, file: Path, **words: Any) -> dict[str, Any]:
    """Run one of the measurements in a fresh process."""
    names = ("OMP_NUM_THREADS", "RAYON_NUM_THREADS", "NGS_NUM_THREADS", "OPENBLAS_NUM_THREADS")
    done = subprocess.run(
        [sys.executable, "-m", "benchmarks.sweep", "--task", task, str(file), json.dumps(words)],
        env={**os.environ, **dict.fromkeys(names, THREADS)},
        cwd=Path(__file__).resolve().parent.parent,
        capture_output=True,
        text=True,
        check=False,
        timeout=LIMIT,
    )
    if done.returncode:
        raise RuntimeError(f"{task} {file.name}: {done.stderr.strip().splitlines()[-1:]}")
    answer: dict[str, Any] = json.loads(done.stdout)
    return answer


def row(name: str, precision: str, ours: Mapping[str, Any], other: Mapping[str, Any]) -> Any:
    """Put one reduced sweep beside the direct one."""
    error = np.abs(np.subtract(ours["level"], other["level"]))
    real = error > ROUNDING
    effectivity = np.array(ours["estimate"])[real] / error[real]
    said = (
        f"effectivity median {np.median(effectivity):.0f}, least {effectivity.min():.1f} where the "
        f"difference is above {ROUNDING:g} dB ({real.sum()} of {len(error)})"
        if real.any()
        else f"nowhere above {ROUNDING:g} dB"
    )
    return {
        "id": IDS.get((name, precision), f"acoustics/sweep-{name}-{precision}"),
        "size": f"{ours['unknowns']} unknowns, {len(FREQUENCIES)} frequencies",
        "ours_s": ours["seconds"],
        "other": f"direct sweep in double, {len(error)} frequencies solved and extrapolated",
        "other_s": other["all"],
        "ratio": other["all"] / ours["seconds"],
        "peak_mb": ours["peak_mb"],
        "notes": (
            f"two threads; {ours['factorizations']} factorisation(s) by {ours['solver']}, "
            f"{ours['factor_s']:.1f} s and {ours['factor_mb']:.0f} MB, {ours['vectors']} vectors, "
            f"{ours['size']} columns; levels range over {ours['span_db']:.0f} dB; at "
            f"{len(error)} held-out frequencies, the peaks among them, the largest difference is "
            f"{error.max():.1e} dB, the largest estimate {max(ours['estimate']):.1e} dB, "
            f"{said}; "
            f"peaks found {ours['with_peaks'] - ours['seconds']:.1f} s later; direct: "
            f"{other['mean']:.1f} s each, {other['peak_mb']:.0f} MB"
        ),
    }


def rows(size: str = SIZE) -> Iterator[Mapping[str, Any]]:
    """Measure all systems, the reduced sweep with factors in double and in mixed precision."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        apart("systems", folder, size=size)
        for system, count in SYSTEMS.items():
            file = folder / system
            double = apart("reduced", file, precision="double", held_out=count)
            frequency = double["frequency"]
            direct = apart("direct", file, precision="double", frequency=frequency)
            yield row(system, "double", double, direct)
            mixed = apart("reduced", file, precision="mixed", held_out=frequency)
            yield row(system, "mixed", mixed, direct)


def main() -> None:
    """Run everything, or one measurement for another process."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.sweep", description=__doc__)
    parser.add_argument("--size", default=SIZE, help="mesh size on the blade")
    parser.add_argument("--out", type=Path, default=RECORD, help="where the rows are put")
    parser.add_argument("--task", nargs=3, metavar=("TASK", "FILE", "WORDS"), help="internal")
    options = parser.parse_args()
    if options.task is None:
        record(rows(options.size), options.out)
        return
    task, file, words = options.task[0], Path(options.task[1]), json.loads(options.task[2])
    if task == "systems":
        make_systems(file, **words)
        print("{}")
    elif task == "reduced":
        print(json.dumps(measure_reduced(file, **words)))
    else:
        print(json.dumps(measure_direct(file, **words)))


if __name__ == "__main__":
    main()
