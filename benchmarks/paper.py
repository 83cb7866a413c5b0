# SPDX-License-Identifier: LGPL-2.1-or-later
"""The paper's study at its size: times and memory that the runs of ``make paper`` have recorded.

    python -m benchmarks.paper [--study runs/paper] [--variant ours]

The other way is a direct sweep: one factorisation of the coupled matrix, of the time that the same
run measured, at each frequency of the band in steps of 0.5 Hz in both configurations.
"""

import argparse
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from benchmarks.run import ROOT, record
from quietblade.results.claims import BLADES
from quietblade.results.files import ResultError
from quietblade.results.model import Result
from quietblade.results.store import RunFolder

STUDY = ROOT / "runs" / "paper"
STEP = 0.5
OTHER = f"a factorisation at each frequency, in steps of {STEP:g} Hz"


def direct_seconds(result: Result) -> float:
    """Time of the factorisations that a direct sweep would need [s]."""
    first = next(iter(result.configurations.values())).spectrum.frequency
    frequencies = round(float(first[-1] - first[0]) / STEP) + 1
    return len(result.configurations) * frequencies * result.run.cost.factorization


def rows(study: Path = STUDY, variant: str = "ours") -> Iterator[dict[str, Any]]:
    """Both blades of a variant, and each of them."""
    found: dict[str, Result] = {}
    for blade in BLADES:
        try:
            found[blade] = RunFolder(study / f"{blade}-{variant}").load()
        except ResultError:
            why = f"no run of the {blade} blade yet: make paper"
            yield _row("paper/full-study", None, None, None, None, why)
            return
    sums = [float(r.run.timings.seconds.sum()) for r in found.values()]
    direct = [direct_seconds(r) for r in found.values()]
    peaks = [float(r.run.cost.memory.max()) / 1e6 for r in found.values()]
    sizes = [int(r.mesh.unknowns.count.sum()) for r in found.values()]
    said = [
        f"{r.mesh.nodes} nodes, {r.run.threads} threads, {seconds / r.run.cost.factorization:.1f}"
        f" factorisations of {r.run.cost.factorization:.1f} s"
        for r, seconds in zip(found.values(), sums, strict=True)
    ]
    yield _row(
        "paper/full-study", sum(sizes), sum(sums), sum(direct), max(peaks),
        "rigid, chained, coupled; C0 and C1; both blades one after the other",
    )  # fmt: skip
    for k, blade in enumerate(found):
        yield _row(f"paper/full-study-{blade}", sizes[k], sums[k], direct[k], peaks[k], said[k])


def _row(
    name: str,
    size: int | None,
    ours: float | None,
    other: float | None,
    peak: float | None,
    notes: str,
) -> dict[str, Any]:
    ratio = None if ours is None or other is None else other / ours
    return {
        "id": name,
        "size": size,
        "ours_s": ours,
        "other": OTHER,
        "other_s": other,
        "ratio": ratio,
        "peak_mb": peak,
        "notes": notes,
    }


def main() -> None:
    """Print and record the rows of a study."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--study", type=Path, default=STUDY)
    parser.add_argument("--variant", default="ours")
    options = parser.parse_args()
    record(rows(options.study, options.variant))


if __name__ == "__main__":
    main()
