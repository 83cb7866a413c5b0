# SPDX-License-Identifier: LGPL-2.1-or-later
"""Compute what the page of the paper has beyond the paper, beside the runs of a study.

Tables that are there for the same case and code are kept.
"""

import argparse
from collections.abc import Callable
from pathlib import Path

from quietblade.case import Case
from quietblade.results.alternatives import AlternativeTable
from quietblade.results.claims import BLADES
from quietblade.results.files import ResultError
from quietblade.study.alternatives import LoadedBlade, load_blade
from quietblade.study.decomposition import decompose_shift
from quietblade.study.run import run_key
from quietblade.study.water_check import compare_water

ROOT = Path(__file__).resolve().parent.parent
TABLES = {"shift": decompose_shift, "water": compare_water}


def main() -> None:
    """Compute the tables of both blades."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=ROOT / "runs" / "paper" / "beyond")
    parser.add_argument("--size", default="22 mm", help="edge length of the elements on the blade")
    options = parser.parse_args()
    for blade in BLADES:
        case = Case.load(ROOT / "cases" / f"paper-{blade}.toml").varied({"mesh.size": options.size})
        compute(case, options.out / blade, report)


def compute(case: Case, folder: Path, progress: Callable[[str, float | None, str], None]) -> None:
    """Compute the tables of one blade that are not there yet."""
    loaded: LoadedBlade | None = None
    for name, make in TABLES.items():
        file = folder / f"{name}.nc"
        if up_to_date(file, case):
            continue
        loaded = loaded or load_blade(case, progress)
        make(case, progress, loaded).save(file)
        progress(name, 1.0, str(file))


def up_to_date(file: Path, case: Case) -> bool:
    """Whether a table is there and belongs to this very case and code."""
    try:
        return AlternativeTable.load(file).content_key == run_key(case)
    except ResultError:
        return False


def report(stage: str, fraction: float | None, message: str) -> None:
    """Print the progress."""
    if message:
        print(f"{stage}: {message}", flush=True)


if __name__ == "__main__":
    main()
