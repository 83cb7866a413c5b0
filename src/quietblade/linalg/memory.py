# SPDX-License-Identifier: LGPL-2.1-or-later
"""The memory that a factorisation would need against what there is, before any of it is taken."""

from pathlib import Path

from quietblade.errors import SolverError

_MEMINFO = Path("/proc/meminfo")


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
    free = available_memory()
    if free is not None and needed > free:
        raise SolverError(
            f"linear solver: the factor of {unknowns} unknowns needs {needed / 1e9:.2g} GB, and "
            f"{free / 1e9:.2g} GB of memory are free; use larger cells (mesh.size), a smaller "
            'sphere (acoustics.sphere_radius), or solver.precision = "mixed"'
        )
