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
from quietblade.study.decomposition import decompose_shift
from quietblade.study.run import run_key
from quietblade.study.water_check import compare_water
from quietblade.typing import Progress

ROOT = Path(__file__).resolve().parent.parent
TABLES = {"shift": ("22 mm", decompose_shift), "water": ("11 mm", compare_water)}
"""Edge length of the cells on the blade, and what makes the table: differences of one mesh settle
on a middle one, but two meshes of the water differ by the error of each."""


def main() -> None:
    """Compute the tables of both blades."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=ROOT / "runs" / "paper" / "beyond")
    parser.add_argument("--size", help="edge length of the cells on the blade, for all tables")
    options = parser.parse_args()
    for blade in BLADES:
        case = Case.load(ROOT / "cases" / f"paper-{blade}.toml")
        for name, (size, make) in TABLES.items():
            file = options.out / blade / f"{name}.nc"
            compute(case.varied({"mesh.size": options.size or size}), make, file)


def compute(case: Case, make: Callable[[Case, Progress], AlternativeTable], file: Path) -> None:
    """Compute a table that is not there yet."""
    if not up_to_date(file, case):
        make(case, report).save(file)
        report(file.stem, 1.0, str(file))


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
