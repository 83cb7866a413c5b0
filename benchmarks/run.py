# SPDX-License-Identifier: LGPL-2.1-or-later
"""Run the benchmarks, print a table and write ``build/benchmarks.json``.

    python -m benchmarks.run [--only NAME] [--out FILE]

Every module of this folder offers ``rows()``: an iterable of mappings with the keys of `KEYS`.
A comparison that cannot be made (another program is not installed) has ``other_s`` and ``ratio``
None and says why in ``notes``.
"""

import argparse
import json
import sys
from collections.abc import Iterable, Iterator, Mapping
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
RECORD = ROOT / "build" / "benchmarks.json"
KEYS = ("id", "size", "ours_s", "other", "other_s", "ratio", "peak_mb", "notes")


def modules(only: str) -> list[str]:
    """Names of the benchmark modules that begin with ``only``."""
    found = (module.name for module in iter_modules([str(Path(__file__).parent)]))
    return sorted(name for name in found if name != "run" and name.startswith(only))


def complete(row: Mapping[str, Any]) -> dict[str, Any]:
    """Check that a row has the keys of the record, no more and no less, and order them."""
    if set(row) != set(KEYS):
        raise ValueError(f"benchmark row {row.get('id')!r} has keys {sorted(row)}, not {KEYS}")
    return {key: row[key] for key in KEYS}


def rows(name: str) -> Iterator[dict[str, Any]]:
    """Rows of one benchmark module, as they are measured."""
    for row in import_module(f"benchmarks.{name}").rows():
        yield complete(row)


def number(value: float | None) -> str:
    """Four figures, or a dash where there is no number."""
    return "-" if value is None else f"{value:.4g}"


def line(row: Mapping[str, Any]) -> str:
    """One line of the printed table."""
    columns = (number(row[key]) for key in ("ours_s", "other_s", "ratio", "peak_mb"))
    return f"{row['id']:<42} " + " ".join(f"{text:>10}" for text in columns) + f"  {row['notes']}"


def record(measured: Iterable[Mapping[str, Any]], file: Path = RECORD, *, keep: bool = True) -> int:
    """Print rows as they are measured, write them to the file and return how many there were.

    Rows of other ids stay in the file if ``keep``.
    """
    old = json.loads(file.read_text(encoding="utf-8")) if keep and file.exists() else []
    entries, count = {row["id"]: row for row in old}, 0
    print(f"{'benchmark':<42} {'ours [s]':>10} {'other [s]':>10} {'ratio':>10} {'peak [MB]':>10}")
    for row in measured:
        entries[row["id"]] = complete(row)
        count += 1
        print(line(row), flush=True)
        # at once: a later row may take an hour, or not come
        file.parent.mkdir(parents=True, exist_ok=True)
        text = json.dumps([entries[key] for key in sorted(entries)], indent=1)
        file.write_text(text + "\n", encoding="utf-8")
    return count


def main() -> int:
    """Run what the command line selects."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.run", description=__doc__)
    parser.add_argument("--only", default="", metavar="NAME", help="modules that begin with NAME")
    parser.add_argument("--out", type=Path, default=RECORD, help=f"default {RECORD.name} in build")
    options = parser.parse_args()

    every = (row for name in modules(options.only) for row in rows(name))
    measured = record(every, options.out, keep=bool(options.only))
    print(f"{measured} benchmarks; written to {options.out}")
    return 0 if measured else 1


if __name__ == "__main__":
    sys.exit(main())
