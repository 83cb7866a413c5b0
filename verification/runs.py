# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs that are killed or find the disk full, against the same run left alone."""

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from functools import cache
from itertools import count
from pathlib import Path
from tempfile import TemporaryDirectory
from time import sleep

import numpy as np

from quietblade.case.presets import preset_text
from quietblade.results.model import Result
from quietblade.results.record import Record
from quietblade.results.store import RunFolder
from quietblade.typing import FloatArray
from verification.registry import check

KILLS = 10
CHANGES = {
    'size = "23 mm"': 'size = "60 mm"',
    'band = ["100 Hz", "220 Hz"]': 'band = ["100 Hz", "160 Hz"]',
    'step = "1 Hz"': 'step = "20 Hz"',
    "sections = 101": "sections = 21\nsection_nodes = 81",
}

DIAGNOSTICS = ("balance_residual", "solver_residual", "error_estimate")
"""What is left over by rounding: there is nothing to compare in it."""

ONE_THREAD = {"OMP_NUM_THREADS": "1", "RAYON_NUM_THREADS": "1"}
"""Several threads add in another order each time, which needles without a film turn into 1e-9."""


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
"""What `quietblade run` computes, without the pictures that it draws afterwards."""


def start(case: Path, folder: Path) -> subprocess.Popen[str]:
    """Start a run, with its progress on a pipe."""
    return subprocess.Popen(
        (sys.executable, "-c", PROGRAM, str(case), str(folder)),
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        env=os.environ | ONE_THREAD,
    )


def run(case: Path, folder: Path) -> Result:
    """Run a case to its end."""
    with start(case, folder) as process:
        said = process.communicate()[0]
    if process.returncode != 0:
        raise RuntimeError(f"the run ended with {process.returncode}: {said}")
    return RunFolder(folder).load()


def killed(case: Path, folder: Path, lines: int, delay: float) -> bool:
    """Run a case and kill it some lines and a moment [s] after it began; whether that was."""
    with start(case, folder) as process:
        assert process.stdout is not None
        for number, _ in enumerate(process.stdout, start=1):
            if number >= lines:
                sleep(delay)
                process.kill()
                break
    return process.returncode == -signal.SIGKILL


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


@cache
def alone() -> tuple[Result, int]:
    """Return the result of the run left alone, and the size of its file [B]."""
    with TemporaryDirectory() as place:
        result = run(written(Path(place)), Path(place) / "run")
        return result, RunFolder(Path(place) / "run").result.stat().st_size


def written(place: Path) -> Path:
    """Write the case into a folder."""
    case = place / "case.toml"
    case.write_text(case_text(), encoding="utf-8")
    return case


@check(
    "runs/killed-and-resumed",
    quantity=f"largest relative difference after {KILLS} kills at random moments",
    reference=0.0,
    source="the same run left alone",
    tolerance=1e-10,
    quick=False,
)
def resumed() -> float:
    """Kill a run at random moments, each time going on from the one before."""
    random = np.random.default_rng(2026)
    wanted, _ = alone()
    with TemporaryDirectory() as place:
        case = written(Path(place))
        worst, kills, folders = 0.0, 0, count()
        folder = Path(place) / f"resumed{next(folders)}"
        while kills < KILLS:
            if killed(case, folder, int(random.integers(1, 13)), float(random.uniform(0.0, 0.4))):
                kills += 1
                continue
            # it came to its end: the kills go on with a run from the beginning
            worst = max(worst, difference(wanted, RunFolder(folder).load()))
            folder = Path(place) / f"resumed{next(folders)}"
        return max(worst, difference(wanted, run(case, folder)))


FULL = """
import resource, sys
resource.setrlimit(resource.RLIMIT_FSIZE, (int(sys.argv[1]),) * 2)
from quietblade.cli.main import execute
sys.exit(execute(sys.argv[2:]))
"""


@check(
    "runs/full-disk",
    quantity="largest relative difference after two runs for which there was no room",
    reference=0.0,
    source="the same run left alone",
    tolerance=1e-10,
    quick=False,
)
def full_disk() -> float:
    """Let a run find no room for some of its stages, then for none but its result."""
    wanted, needed = alone()
    with TemporaryDirectory() as place:
        case, folder = written(Path(place)), Path(place) / "cramped"
        for room in (needed // 8, needed - 1):  # bytes that a file may have
            command = (sys.executable, "-c", FULL, str(room), "run", str(case))
            done = subprocess.run(
                (*command, "--out", str(folder), "--brief"),
                capture_output=True,
                text=True,
                env=os.environ | ONE_THREAD,
                check=False,
            )
            said = " ".join(done.stderr.split())
            if done.returncode != 3 or str(folder) not in said or "Make room" not in said:
                raise RuntimeError(f"the run ended with {done.returncode}: {done.stderr}")
            if RunFolder(folder).result.exists():
                raise RuntimeError("the full disk holds a result")
        return difference(wanted, run(case, folder))
