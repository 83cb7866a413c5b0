# SPDX-License-Identifier: LGPL-2.1-or-later
"""Run the reference checks, print a table and write ``build/verification.json``.

    python -m verification.run [--quick] [--only PREFIX] [--out FILE]

The exit code is 1 if a check failed without an explanation, raised an error, or if none was
selected. Checks that were
not selected keep the line of their last run in the file, so that a part can be run again alone.
"""

import argparse
import json
import math
import sys
import traceback
from collections.abc import Iterable
from dataclasses import asdict
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules
from time import perf_counter
from typing import Any

from verification.registry import CHECKS, Check, Row

ROOT = Path(__file__).resolve().parent.parent
RECORD = ROOT / "build" / "verification.json"
MACHINERY = {"registry", "report", "run"}


def load_checks() -> dict[str, Check]:
    """Import every module of this folder, and with it its checks, ordered by id."""
    for module in iter_modules([str(Path(__file__).parent)]):
        if module.name not in MACHINERY:
            import_module(f"verification.{module.name}")
    return dict(sorted(CHECKS.items()))


def select(checks: dict[str, Check], *, quick: bool, only: str) -> list[Check]:
    """Choose the checks whose id begins with ``only``; of these the quick ones if ``quick``."""
    return [
        check
        for name, check in checks.items()
        if name.startswith(only) and (check.quick or not quick)
    ]


def run(check: Check) -> Row:
    """Compute one check; an error is printed and counts as a failure without a value."""
    start = perf_counter()
    try:
        return check.run()
    except Exception:  # the other checks must still be run and recorded
        traceback.print_exc()
        return Row(
            check.id,
            check.quantity,
            check.reference,
            check.source,
            math.nan,
            check.tolerance,
            passed=False,
            seconds=perf_counter() - start,
        )


def line(row: Row) -> str:
    """One line of the printed table."""
    verdict = "passed" if row.passed else "differs" if row.explanation else "FAILED"
    return (
        f"{verdict:<7} {row.id:<52} {row.value:>14.7g} {row.reference:>14.7g} "
        f"{row.tolerance:>9.2g} {row.seconds:>8.2f} s"
    )


def record(row: Row) -> dict[str, Any]:
    """Row as JSON says it: a value that is not a number becomes null."""
    entry = asdict(row)
    if not math.isfinite(row.value):
        entry["value"] = None
    return entry


def merge(path: Path, rows: Iterable[Row], known: Iterable[str]) -> list[dict[str, Any]]:
    """Entries of the record: new rows, and old ones of checks that still exist."""
    old = json.loads(path.read_text(encoding="utf-8")) if path.exists() else []
    entries = {entry["id"]: entry for entry in old}
    entries.update({row.id: record(row) for row in rows})
    exist = set(known)
    return [entries[name] for name in sorted(entries) if name in exist]


def main() -> int:
    """Run what the command line selects."""
    parser = argparse.ArgumentParser(prog="python -m verification.run", description=__doc__)
    parser.add_argument("--quick", action="store_true", help="only the checks marked quick")
    parser.add_argument("--only", default="", metavar="PREFIX", help="ids that begin with PREFIX")
    parser.add_argument("--out", type=Path, default=RECORD, help=f"default {RECORD.name} in build")
    options = parser.parse_args()

    checks = load_checks()
    chosen = select(checks, quick=options.quick, only=options.only)
    print(f"        {'check':<52} {'value':>14} {'reference':>14} {'tolerance':>9} {'time':>10}")
    rows = []
    for check in chosen:
        rows.append(run(check))
        print(line(rows[-1]), flush=True)

    options.out.parent.mkdir(parents=True, exist_ok=True)
    entries = merge(options.out, rows, checks)
    options.out.write_text(json.dumps(entries, indent=1) + "\n", encoding="utf-8")
    failed = [row.id for row in rows if not row.passed and not row.explanation]
    known = sum(bool(row.explanation) for row in rows)
    print(
        f"{len(rows)} checks, {len(failed)} failed, {known} known to differ; "
        f"written to {options.out}"
    )
    if not rows:
        print(f"no check matches --only {options.only!r}; known: {', '.join(checks) or 'none'}")
    return 1 if failed or not rows else 0


if __name__ == "__main__":
    sys.exit(main())
