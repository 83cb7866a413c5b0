# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a calibration or its sensitivities found, as tables and files."""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from quietblade.case.problems import shown
from quietblade.case.study_calibration import Calibration
from quietblade.results.files import ResultError, write_text
from quietblade.results.model import Result
from quietblade.results.store import RunFolder
from quietblade.results.study_claims import closest_runs, closest_table
from quietblade.results.study_table import as_csv
from quietblade.results.table import Table, number
from quietblade.results.tables import as_text
from quietblade.study.calibration import Fitted
from quietblade.study.sensitivity import Sensitivities

_AT_BOUND = 0.01  # share of the bounds


def write_closest(root: Path) -> Table:
    """Write ``closest.csv``: the closest run to each claim, of all runs below the folder."""
    table = closest_table(closest_runs(_runs(root)))
    if table.rows:
        write_text(root / "closest.csv", as_csv(table.columns, table.rows))
    return table


def _runs(root: Path) -> Iterator[tuple[str, Result]]:
    for file in sorted(root.glob("*/*/*/result.nc")):
        try:
            yield str(file.parent.relative_to(root)), RunFolder(file.parent).load()
        except ResultError:  # of another version: it says nothing of this code
            continue


def _parameters(words: Calibration, found: Fitted) -> Table:
    rows = []
    for p in words.parameters:
        if not p.search:
            continue
        start, best = found.start.values[p.key], found.best.values[p.key]
        place = p.place(best)
        edge = "low" if place < _AT_BOUND else "high" if place > 1.0 - _AT_BOUND else ""
        bounds = f"{shown(p.low)} to {shown(p.high)}"
        at = f"at its {edge} bound" if edge else ""
        rows.append((p.key, bounds, shown(start), shown(best), at, p.reason))
    settled = "settled" if found.settled else "ended for want of evaluations"
    note = (
        f"{found.evaluations} evaluations, {found.computed} of them computed now; cost "
        f"{found.cost[0]:.4g} at the start, {found.cost[1]:.4g} at the best; {settled}"
    )
    heads = ("parameter", "bounds", "start", "best", "", "why these bounds")
    return Table("Parameters", heads, tuple(rows), note)


def _targets(words: Calibration, found: Fitted) -> Table:
    rows = []
    for target, off in zip(words.targets, found.residuals, strict=True):
        factor = found.correction.get(f"{target.case}/{target.figure}", 1.0)
        wanted = target.readings.get(found.reading, target.value)
        values = (e.figure(target.case, target.figure) * factor for e in (found.start, found.best))
        first, best = (number(value, ".5g") for value in values)
        rows.append(
            (target.case, target.figure, f"{wanted:g}", first, best, f"{off:+.2f}", f"{factor:.4f}")
        )
    heads = ("case", "figure", "target", "start", "best", "off, in scales", "fine / coarse")
    return Table("Targets", heads, tuple(rows))


def write_fitted(words: Calibration, found: Fitted, root: Path) -> tuple[Table, ...]:
    """Write ``calibration.json``, ``.txt`` (with the reading) and ``closest.csv``."""
    made = (_parameters(words, found), _targets(words, found), write_closest(root))
    tables = tuple(table for table in made if table.rows)
    stem = f"calibration-{found.reading}" if found.reading else "calibration"
    data: dict[str, Any] = {
        "reading": found.reading,
        "best": dict(found.best.values),
        "start": dict(found.start.values),
        "cost": found.cost,
        "path": found.path,
        "evaluations": found.evaluations,
        "settled": found.settled,
        "correction": dict(found.correction),
        "residuals": found.residuals.tolist(),
    }
    write_text(root / f"{stem}.txt", as_text(words.title or "Calibration", tables))
    write_text(root / f"{stem}.json", json.dumps(data, indent=1))
    return tables


def write_sensitivities(words: Calibration, found: Sensitivities, root: Path) -> tuple[Table, ...]:
    """Write ``sensitivities.csv`` and ``.txt``, and ``closest.csv``."""
    names = tuple(target.figure for target in words.targets)
    claims = any(name.startswith("paper/") for _, name in found.names())
    moved = (found.table() if claims else found.table(names), write_closest(root))
    tables = tuple(table for table in moved if table.rows)
    write_text(root / "sensitivities.csv", found.to_csv())
    write_text(root / "sensitivities.txt", as_text(words.title or "Sensitivities", tables))
    return tables
