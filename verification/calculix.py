# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs CalculiX CrunchiX (Debian: calculix-ccx) on a deck and reads its nodal results."""

import os
import re
import shutil
import subprocess
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter, sleep

import numpy as np

from quietblade.typing import FloatArray, IntArray

_BLOCK = re.compile(r"^ -4  (\w+)\s+(\d+)")
_MISSING = "the program ccx (CalculiX CrunchiX) is not installed"
_WIDTH = 12
_POLL = 0.01  # s


class CalculixError(RuntimeError):
    """CalculiX is not there, or did not give a solution."""


@dataclass(frozen=True)
class CalculixRun:
    """A finished run.

    Attributes
    ----------
    fields : mapping
        Last result of every quantity: DISP (n, 3), STRESS and TOSTRAIN (n, 6) in the order
        xx, yy, zz, xy, yz, zx, FORC (n, 3).
    nodes : (n,) int array
        Node numbers of the deck, from 1.
    seconds : float
        Wall time of the process.
    peak_mb : float
        Its greatest resident memory [MB].
    iterations : int
        Newton iterations.
    """

    fields: Mapping[str, FloatArray]
    nodes: IntArray
    seconds: float
    peak_mb: float
    iterations: int


def is_installed() -> bool:
    """Whether there is a program ``ccx``."""
    return shutil.which("ccx") is not None


def version() -> str:
    """Version of the installed program, such as ``2.20``.

    Raises
    ------
    CalculixError
        If ``ccx`` is not installed.
    """
    if not is_installed():
        raise CalculixError(_MISSING)
    said = subprocess.run(["ccx", "-v"], capture_output=True, text=True, check=False).stdout
    found = re.search(r"Version ([\d.]+)", said)
    return found.group(1) if found else "of unknown version"


def run_calculix(deck: Path, *, threads: int = 1, timeout: float = 600.0) -> CalculixRun:
    """Solve a deck in its folder.

    Raises
    ------
    CalculixError
        If ``ccx`` is not installed or gives no result.
    subprocess.TimeoutExpired
        If it takes longer than the timeout [s].
    """
    if not is_installed():
        raise CalculixError(_MISSING)
    count = str(threads)
    names = ("OMP_NUM_THREADS", "CCX_NPROC_STIFFNESS", "CCX_NPROC_RESULTS", "NUMBER_OF_CPUS")
    log = deck.with_suffix(".log")
    start = perf_counter()
    with log.open("w", encoding="utf-8") as output:
        process = subprocess.Popen(
            ["ccx", deck.stem],
            cwd=deck.parent,
            env={**os.environ, **dict.fromkeys(names, count)},
            stdout=output,
            stderr=subprocess.STDOUT,
        )
        usage = _wait(process, start + timeout)
    seconds = perf_counter() - start
    said = log.read_text(encoding="utf-8", errors="replace")
    if process.returncode != 0 or "Job finished" not in said:
        raise CalculixError(f"ccx gave no solution of {deck.name}: {said[-800:]}")
    nodes, fields = read_frd(deck.with_suffix(".frd"))
    iterations = len(re.findall(r"^ iteration \d+", said, re.M))
    return CalculixRun(fields, nodes, seconds, usage, iterations)


def _wait(process: "subprocess.Popen[bytes]", deadline: float) -> float:
    """Wait for the end of a process; return its greatest resident memory [MB]."""
    while True:
        pid, status, usage = os.wait4(process.pid, os.WNOHANG)
        if pid:
            process.returncode = os.waitstatus_to_exitcode(status)
            return usage.ru_maxrss / 1024.0
        if perf_counter() > deadline:
            process.kill()
            process.wait()
            raise subprocess.TimeoutExpired(process.args, deadline)
        sleep(_POLL)


def read_frd(path: Path) -> tuple[IntArray, dict[str, FloatArray]]:
    """Node numbers, and the last block of every nodal quantity, of a formatted ``.frd`` file.

    Numbers stand in columns of fixed width that may touch: node in 4 to 13, then 12 a value.
    """
    fields: dict[str, FloatArray] = {}
    numbers: IntArray = np.zeros(0, dtype=np.int64)
    name, rows, nodes = "", list[list[float]](), list[int]()
    for line in path.read_text(encoding="ascii", errors="replace").splitlines():
        found = _BLOCK.match(line)
        if found:
            name, rows, nodes = found.group(1), [], []
        elif name and line.startswith(" -1"):
            nodes.append(int(line[3:13]))
            rows.append(
                [float(line[i : i + _WIDTH]) for i in range(13, len(line.rstrip()), _WIDTH)]
            )
        elif name and line.startswith(" -3"):
            fields[name], numbers = np.array(rows), np.array(nodes)
            name = ""
    if not fields:
        raise CalculixError(f"{path.name} holds no results")
    return numbers, fields
