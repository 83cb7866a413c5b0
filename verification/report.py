# SPDX-License-Identifier: LGPL-2.1-or-later
"""Write the tables of the documentation's verification and benchmark pages.

    python -m verification.report

Reads ``build/verification.json`` and ``build/benchmarks.json``, writes ``docs/_generated/*.md``.
A page whose record does not exist says which command makes it.
"""

import json
from collections.abc import Callable, Iterable, Mapping
from itertools import groupby
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
OUT = ROOT / "docs" / "_generated"
Row = Mapping[str, Any]


def part(row: Row) -> str:
    """Part of the product that a row belongs to: the beginning of its id."""
    return str(row["id"]).split("/")[0]


def number(value: float | None, digits: int) -> str:
    """Value with some significant digits, or a dash."""
    return "-" if value is None else f"{value:.{digits}g}"


def table(head: Iterable[str], lines: Iterable[Iterable[str]]) -> str:
    """Markdown table."""
    names = list(head)
    rows = [names, ["---"] * len(names), *(list(line) for line in lines)]
    return "\n".join("| " + " | ".join(cell.replace("|", r"\|") for cell in r) + " |" for r in rows)


def verification_page(rows: list[Row]) -> str:
    """Summary, then one table for each part."""
    missed = [row for row in rows if not row["passed"]]
    failed = [str(row["id"]) for row in missed if not row.get("explanation")]
    verdict = f"**Failed: {', '.join(failed)}.**" if failed else "None failed."
    if len(missed) > len(failed):
        verdict += f" {len(missed) - len(failed)} are known to differ; the tables say why."
    pages = [f"{len(rows)} checks. {verdict}"]
    head = ("check", "quantity", "value", "reference", "tolerance", "source", "passed", "time [s]")
    for name, group in groupby(sorted(rows, key=lambda row: str(row["id"])), key=part):
        lines = [
            (
                f"`{row['id']}`",
                row["quantity"],
                number(row["value"], 7),
                number(row["reference"], 7),
                number(row["tolerance"], 2),
                row["source"],
                "yes" if row["passed"] else f"**no** {row.get('explanation', '')}".rstrip(),
                f"{row['seconds']:.2f}",
            )
            for row in group
        ]
        pages.append(f"## {name.capitalize()}\n\n{table(head, lines)}")
    return "\n\n".join(pages) + "\n"


def benchmark_page(rows: list[Row]) -> str:
    """Print one table for each part."""
    head = (
        "benchmark",
        "size",
        "quietblade [s]",
        "other",
        "other [s]",
        "ratio",
        "peak [MB]",
        "notes",
    )
    pages = []
    for name, group in groupby(sorted(rows, key=lambda row: str(row["id"])), key=part):
        lines = [
            (
                f"`{row['id']}`",
                str(row["size"]),
                number(row["ours_s"], 3),
                str(row["other"] or "-"),
                number(row["other_s"], 3),
                number(row["ratio"], 3),
                number(row["peak_mb"], 4),
                str(row["notes"] or ""),
            )
            for row in group
        ]
        pages.append(f"## {name.capitalize()}\n\n{table(head, lines)}")
    return "\n\n".join(pages) + "\n"


PAGES: dict[str, tuple[str, Callable[[list[Row]], str]]] = {
    "verification": ("make verify", verification_page),
    "benchmarks": ("make bench", benchmark_page),
}


def page(name: str, build: Path) -> str:
    """Text of a page, from its record in the build folder if there is one."""
    command, make = PAGES[name]
    record = build / f"{name}.json"
    if not record.exists():
        return f"There is no record in this build: run `{command}`, then `make docs`.\n"
    return make(json.loads(record.read_text(encoding="utf-8")))


def main() -> None:
    """Write both pages."""
    OUT.mkdir(parents=True, exist_ok=True)
    for name in PAGES:
        (OUT / f"{name}.md").write_text(page(name, ROOT / "build"), encoding="utf-8")


if __name__ == "__main__":
    main()
