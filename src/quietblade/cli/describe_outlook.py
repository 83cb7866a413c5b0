# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a run will be like, in words for people and as data for programs."""

from dataclasses import asdict
from typing import Any

from quietblade.study.costs import MEMORY_FACTOR, TIME_FACTOR
from quietblade.study.forecast import UNCERTAINTY
from quietblade.study.outlook import Outlook

Rows = list[tuple[str, str]]


def outlook_tables(ahead: Outlook) -> list[tuple[str, Rows]]:
    """Size, cost and assumptions."""
    size, cost = ahead.size, ahead.cost
    free = "" if ahead.memory_free is None else f"; {ahead.memory_free / 1e9:.3g} GB are free"
    within = f"within {100 * UNCERTAINTY:.0f} %"
    threads = f"{cost.threads} thread" + ("s" if cost.threads > 1 else "")
    forecast = [
        ("nodes", f"about {_rounded(size.nodes)}, {within}"),
        (
            "unknowns",
            (f"about {_rounded(size.statics)} in step 1, " if size.statics else "about ")
            + f"{_rounded(size.vibration)} in step 2",
        ),
        ("memory", f"about {cost.memory / 1e9:.2g} GB, within a factor {MEMORY_FACTOR:g}{free}"),
        (
            "time",
            f"about {spell(cost.total)} on {threads} of this machine, if it does nothing else; "
            f"within a factor {TIME_FACTOR:g}",
        ),
        *((f"  {name}", spell(seconds)) for name, seconds in cost.seconds.items()),
    ]
    judged = [(a.name, a.said if a.holds else f"DOUBTFUL: {a.said}") for a in ahead.assumptions]
    return [("What a run takes", forecast), ("What the method assumes", judged)]


def outlook_data(ahead: Outlook) -> dict[str, Any]:
    """Return the same as plain data in SI units."""
    return {
        "forecast": {
            "nodes": ahead.size.nodes,
            "unknowns_step_1": ahead.size.statics,
            "unknowns_step_2": ahead.size.vibration,
            "size_uncertainty": UNCERTAINTY,
            "memory_b": ahead.cost.memory,
            "memory_factor": MEMORY_FACTOR,
            "memory_free_b": ahead.memory_free,
            "threads": ahead.cost.threads,
            "time_s": ahead.cost.seconds,
            "total_time_s": ahead.cost.total,
            "time_factor": TIME_FACTOR,
        },
        "assumptions": [
            {key: value for key, value in asdict(a).items() if key != "doubt"}
            for a in ahead.assumptions
        ],
    }


def spell(seconds: float) -> str:
    """Spell a time that is known roughly."""
    if seconds < 1.0:
        return "under 1 s"
    for unit, length in (("h", 3600.0), ("min", 60.0)):
        if seconds >= 2.0 * length:
            return f"{seconds / length:.2g} {unit}"
    return f"{seconds:.2g} s" if seconds < 10.0 else f"{seconds:.0f} s"


def _rounded(count: int) -> str:
    """Three digits, with spaces between thousands."""
    digits = max(0, len(str(count)) - 3)
    return f"{round(count, -digits):,}".replace(",", " ")
