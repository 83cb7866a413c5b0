# SPDX-License-Identifier: LGPL-2.1-or-later
"""Section of the paper's page on what the paper leaves open: what was fitted, and what it moves."""

import csv
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from quietblade.case.study_calibration import Calibration, TargetWords
from quietblade.results.claims import BLADES, judge_claims
from tools.paper_runs import PaperRuns
from tools.paper_sections import changed, markdown, verdict

WORDS = Path(__file__).resolve().parent.parent / "cases" / "paper-calibration.toml"
_TOLD = 3
"""Choices that are named for a claim."""
_READINGS = {
    "": "the shear strain as engineering $\\gamma$",
    "tensor": "the shear strain as tensor component",
}


def unstated(runs: PaperRuns, _: Path) -> Iterator[str]:
    """Tell how the open parameters were found, and which open choice moves which claim."""
    yield "## What the paper leaves open\n"
    yield "[How these were searched, and from which bounds](calibration.md); the files are"
    yield "those of `quietblade study --calibrate cases/paper-calibration.toml`, and of the same"
    yield "with `--reading tensor` and with `--sensitivities`.\n"
    yield from _aligned(runs)
    words = Calibration.load(WORDS)
    for reading, text in _READINGS.items():
        stem = f"calibration-{reading}" if reading else "calibration"
        file = runs.calibration / f"{stem}.json"
        yield f"### Fitted with {text}\n"
        if not file.is_file():
            option = f" --reading {reading}" if reading else ""
            command = f"quietblade study --calibrate{option} cases/paper-calibration.toml"
            yield f"Not computed yet: run `{command}`.\n"
            continue
        yield from _fitted(words, json.loads(file.read_text(encoding="utf-8")))
    yield "### Which open choice moves which claim\n"
    file = runs.calibration / "sensitivities.csv"
    if file.is_file():
        yield from _movers(runs, file)
    else:
        yield "Not computed yet: run `quietblade study --sensitivities"
        yield "cases/paper-calibration.toml`.\n"


def _aligned(runs: PaperRuns) -> Iterator[str]:
    """Tell what the alignment does to lift and blade angle, which fixed it beforehand."""
    yield "### Alignment, by lift and blade angle\n"
    aligned = PaperRuns(runs.root.parent / "paper-alignment", "")
    names = aligned.names()
    if not names:
        yield "Not computed yet: run `quietblade study cases/paper-alignment.toml`.\n"
        return
    yield "The chord fraction on a straight line, fixed before the search by the equilibrium of"
    yield "both blades on a coarse mesh ([what the paper leaves open](calibration.md)).\n"
    rows = []
    for name in names:
        result = aligned.result(name)
        judged = {claim.id.rpartition("/")[2]: claim for claim in judge_claims(result)}
        rows.append(
            [name.partition("-")[0], changed(result, "blade.alignment")]
            + [verdict(judged[end]) for end in ("lift-coefficient", "blade-angle")]
        )
    heads = ["Blade", "Chord fraction", "Lift against the rigid blade", "Blade angle"]
    yield markdown(heads, rows)


def _fitted(words: Calibration, found: dict[str, Any]) -> Iterator[str]:
    moved = [p for p in words.parameters if p.search]
    yield markdown(
        ["Parameter", "Bounds", "Start", "Found", "Why these bounds"],
        [
            [f"`{p.key}`", f"{p.low} to {p.high}", str(found["start"][p.key]),
             str(found["best"][p.key]), p.reason]
            for p in moved
        ],
    )  # fmt: skip
    rows = []
    for target, off in zip(words.targets, found["residuals"], strict=True):
        wanted = target.readings.get(found["reading"], target.value)
        factor = found["correction"].get(f"{target.case}/{target.figure}", 1.0)
        rows.append(
            [f"{target.case}, `{target.figure}`", f"{wanted:g}", f"{_met(target, wanted, off):.4g}",
             f"{off:+.2f}", f"{factor:.4f}"]
        )  # fmt: skip
    yield markdown(["Target", "Wanted", "Met", "Off, in scales", "Fine / coarse mesh"], rows)
    ended = "ended by itself" if found["settled"] else "ended for want of evaluations"
    yield f"{found['evaluations']} evaluations; the search {ended}. Sum of squares"
    yield f"{found['cost'][0]:.3g} at the start, {found['cost'][1]:.3g} at the best.\n"


def _met(target: TargetWords, wanted: float, off: float) -> float:
    return wanted + off * target.scale


def _movers(runs: PaperRuns, file: Path) -> Iterator[str]:
    """Largest changes of each claim's figure, one choice at a time."""
    with file.open(encoding="utf-8", newline="") as lines:
        every = [row for row in csv.DictReader(lines) if row["change"]]
    yield "One choice is changed at a time, about the start of the search, on a coarse mesh, which"
    yield "is too stiff: what counts are the changes. Named are the"
    yield f"{_TOLD} choices that move a claim's figure most, and by how much.\n"
    rows = []
    for blade in BLADES:
        for claim in judge_claims(runs.result(f"{blade}-{runs.main}"), blade):
            moves = [row for row in every if (row["case"], row["figure"]) == (blade, claim.id)]
            moves = [row for row in moves if float(row["change"]) != 0.0]
            if not moves:
                continue
            moves.sort(key=lambda row: -abs(float(row["change"])))
            told = "; ".join(
                f"{float(row['change']):+.3g} by `{row['key']}` = {row['value']}"
                for row in moves[:_TOLD]
            )
            rows.append([blade, claim.statement, f"{float(moves[0]['start']):.4g}", told])
    yield markdown(["Blade", "Claim", "At the start", "Moved by"], rows)
