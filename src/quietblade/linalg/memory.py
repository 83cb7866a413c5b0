# SPDX-License-Identifier: LGPL-2.1-or-later
"""The memory that a factorisation would need against what there is, before any of it is taken."""

import ctypes
import gc
from functools import cache
from pathlib import Path

from quietblade.errors import SolverError

_MEMINFO = Path("/proc/meminfo")
_LARGE = 100_000_000
"""Size of a factor [B] from which it pays to tidy up before it is made, a tenth of a second."""


def available_memory() -> int | None:
    """Memory that can be taken without swapping [B]; None where the system does not tell."""
    try:
        lines = _MEMINFO.read_text(encoding="ascii").splitlines()
    except OSError:
        return None
    for line in lines:
        name, _, amount = line.partition(":")
        if name == "MemAvailable":
            return 1024 * int(amount.split()[0])
    return None


def release_memory() -> None:
    """Give back to the system what is not used any more.

    The C library of Linux keeps the memory of small arrays that are gone: at 180 000 unknowns more
    than a gigabyte, just when a factor needs it.
    """
    gc.collect()
    trim = _trim()
    if trim is not None:
        trim(0)


@cache
def _trim() -> "ctypes._FuncPointer | None":
    """``malloc_trim`` of the GNU C library; None elsewhere."""
    try:
        return ctypes.CDLL(None).malloc_trim
    except (OSError, AttributeError, TypeError):  # TypeError: Windows has no library of that name
        return None


def require_memory(needed: int, unknowns: int) -> None:
    """Refuse a factorisation that does not fit.

    Parameters
    ----------
    needed : int
        Largest memory that it will take [B].
    unknowns : int
        Size of the system, for the message.

    Raises
    ------
    SolverError
        With both figures; a system that is swapped to disk, or killed, says less.
    """
    if needed > _LARGE:
        release_memory()
    free = available_memory()
    if free is not None and needed > free:
        raise SolverError(
            f"linear solver: the factor of {unknowns} unknowns needs {needed / 1e9:.2g} GB, and "
            f"{free / 1e9:.2g} GB of memory are free; use larger cells (mesh.size), a smaller "
            'sphere (acoustics.sphere_radius), or solver.precision = "mixed"'
        )
