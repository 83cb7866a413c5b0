# SPDX-License-Identifier: LGPL-2.1-or-later
"""The paper's two blades, from case file to sound power, at the size of the demonstration.

Runs that ``make demo`` has left in ``runs/`` are used; otherwise they are computed there.
"""

from functools import cache
from pathlib import Path

import numpy as np

from quietblade.case import Case
from quietblade.results.model import Result
from quietblade.results.store import RunFolder
from quietblade.study.run import finished, run_case
from verification.registry import check

ROOT = Path(__file__).parents[1]
PAPER = "two-step paper, section 3.2: peaks of the sound power at rest, and their modes"
REACH = 0.13
"""The paper leaves film, sphere and excitation open: its frequencies are targets, not references;
the nearest neighbour of the same family is farther away than this."""

MODES = {
    "aluminium": {"B5": 135.0, "T2": 160.0, "B6": 190.0},
    "composite": {"B6": 135.0, "T2": 160.0, "B7": 190.0},
}


@cache
def result(blade: str) -> Result:
    """Load or compute the result of one of the paper's blades."""
    case = Case.load(ROOT / "cases" / f"paper-{blade}.toml")
    folder = RunFolder(ROOT / "runs" / f"paper-{blade}")
    return finished(case, folder) or run_case(case, folder)


def mode_frequency(blade: str, mode: str) -> float:
    """Frequency of a mode at rest [Hz]; nan if there is none of this name."""
    modes = result(blade).configurations["C0"].modes
    return float(modes.frequency[modes.name.index(mode)]) if mode in modes.name else np.nan


def worst_balance(blade: str) -> float:
    """Largest relative error of the energy balance over both configurations."""
    configurations = result(blade).configurations.values()
    return max(float(np.max(c.spectrum.balance_residual)) for c in configurations)


def _register(blade: str) -> None:
    for mode, frequency in MODES[blade].items():
        check(
            f"paper/{blade}-{mode}",
            quantity=f"wet frequency of {mode} at rest [Hz]",
            reference=frequency,
            source=PAPER,
            tolerance=REACH * frequency,
            quick=False,
        )(lambda mode=mode: mode_frequency(blade, mode))
    check(
        f"paper/{blade}-energy-balance",
        quantity="largest |injected - radiated - dissipated| / injected over the sweep",
        reference=0.0,
        source="conservation of energy",
        tolerance=1e-6,  # what residuals near rounding leave of powers that nearly cancel
        quick=False,
    )(lambda: worst_balance(blade))


for _blade in MODES:
    _register(_blade)
