# SPDX-License-Identifier: LGPL-2.1-or-later
"""A run that is killed again and again, against the same run left alone."""

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from itertools import count
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from quietblade.case.presets import preset_text
from quietblade.results.model import Result
from quietblade.results.record import Record
from quietblade.results.store import RunFolder
from quietblade.typing import FloatArray
from verification.registry import check

KILLS = 3
CHANGES = {
    'size = "22 mm"': 'size = "60 mm"',
    'band = ["100 Hz", "220 Hz"]': 'band = ["100 Hz", "160 Hz"]',
    'step = "1 Hz"': 'step = "20 Hz"',
    "sections = 101": "sections = 21\nsection_nodes = 81",
}

DIAGNOSTICS = ("balance_residual", "solver_residual", "error_estimate")
"""What is left over by rounding: there is nothing to compare in it."""

ONE_THREAD = {"OMP_NUM_THREADS": "1", "RAYON_NUM_THREADS": "1"}
"""Several threads add in another order each time, which needles without a film turn into 1e-9."""

PROGRAM = """
import sys
from pathlib import Path
from quietblade.case import Case
from quietblade.results.store import RunFolder
from quietblade.study.run import run_case

def say(stage, fraction, message):
    print(stage, message, flush=True)

run_case(Case.load(sys.argv[1]), RunFolder(Path(sys.argv[2])), say)
"""


def case_text() -> str:
    """Write the paper's aluminium blade without its film, as coarse as it can be."""
    text = preset_text("paper-aluminium")
    head, _, rest = text.partition("[film]")
    text = head + rest[rest.index("\n[") + 1 :]
    for old, new in CHANGES.items():
        if old not in text:
            raise ValueError(f"the preset has no longer {old!r}")
        text = text.replace(old, new)
    return text


def run(case: Path, folder: Path, lines: int | None = None) -> bool:
    """Run a case, killed after so many lines of progress; whether it came to its end."""
    command = (sys.executable, "-c", PROGRAM, str(case), str(folder))
    environment = os.environ | ONE_THREAD
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment) as process:
        assert process.stdout is not None
        for number, _ in enumerate(process.stdout):
            if lines is not None and number >= lines:
                process.send_signal(signal.SIGKILL)
                return False
    if process.returncode != 0:
        raise RuntimeError(f"the run ended with {process.returncode}")
    return True


def figures(record: Record) -> Iterator[FloatArray]:
    """Every number of a record."""
    for name, array in record.arrays().items():
        if name not in DIAGNOSTICS and array.dtype.kind in "fc":
            yield np.abs(array).ravel()


def difference(one: Result, other: Result) -> float:
    """Largest difference of modes, spectra and static sections, each to its array's largest."""
    pairs = [(one.static.sections, other.static.sections)]
    for name, configuration in one.configurations.items():
        same = other.configurations[name]
        pairs += [(configuration.modes, same.modes), (configuration.spectrum, same.spectrum)]
    worst = 0.0
    for left, right in pairs:
        for a, b in zip(figures(left), figures(right), strict=True):
            if not np.array_equal(np.isnan(a), np.isnan(b)):
                return float("inf")
            largest = np.nanmax(a, initial=0.0)
            if largest > 0.0:
                worst = max(worst, float(np.nanmax(np.abs(a - b), initial=0.0) / largest))
    return worst


@check(
    "acoustics/killed-and-resumed-run",
    quantity=f"largest relative difference after {KILLS} kills at random moments",
    reference=0.0,
    source="the same run left alone",
    tolerance=1e-10,
    quick=False,
)
def killed() -> float:
    """Kill a run at random lines of its progress, and let it end."""
    with TemporaryDirectory() as place:
        case, alone, resumed = (Path(place) / name for name in ("case.toml", "alone", "resumed"))
        case.write_text(case_text(), encoding="utf-8")
        run(case, alone)
        random = np.random.default_rng(2026)
        for kills in count(1):
            if run(case, resumed, int(random.integers(4, 14)) if kills <= KILLS else None):
                break
        if kills <= KILLS:
            raise RuntimeError(f"the run ended before kill {kills}")
        return difference(RunFolder(alone).load(), RunFolder(resumed).load())
