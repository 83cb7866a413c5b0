# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where the change from C0 to C1 comes from: shape, stress, loads (theory: S2-1).

The steady load changes the vibration in two ways, by the shape that it gives to blade and water,
and by its stress.  The stress comes with the loads that balance it: the stiffness of the pressure,
which turns with the surface, and that of the centrifugal force.
"""

from collections.abc import Iterator

from quietblade.case import Case
from quietblade.propulsion.tangent import STIFFNESS
from quietblade.results.alternatives import AlternativeTable
from quietblade.study.alternatives import Alternative, LoadedBlade, load_blade, tabulate, vibrate
from quietblade.study.vibration import Share
from quietblade.typing import Progress, silent

REST, SHAPE, STRESS, BOTH, LOAD, ALL = "C0", "shape", "stress", "both", "load", "C1"
"""Names of the alternatives."""

_PAPER = STIFFNESS["paper"]

SHARES: dict[str, tuple[str, Share]] = {
    SHAPE: ("deformed shape alone", Share(prestress=False)),
    STRESS: (
        "stress alone, with its loads, on the shape at rest",
        Share(shape=False, pieces=STIFFNESS["full"]),
    ),
    BOTH: ("shape and stress, without the stiffness of the loads", Share(pieces=_PAPER)),
    LOAD: ("with the stiffness of the pressure", Share(pieces=(*_PAPER, "load"))),
    ALL: ("with spin softening too: C1", Share(pieces=STIFFNESS["full"])),
}
"""What of the steady load counts in each, and in words."""


def decompose_shift(
    case: Case, progress: Progress = silent, loaded: LoadedBlade | None = None
) -> AlternativeTable:
    """Take the change of modes and peaks from C0 to C1 apart.

    Parameters
    ----------
    case : Case
        The blade; the stiffness that it asks for does not matter.
    progress : callable
    loaded : LoadedBlade, optional
        Its equilibrium, if it is known.

    Returns
    -------
    AlternativeTable
        Rows `REST`, which is the reference, and those of `SHARES`.

    Raises
    ------
    CaseError
        The case cannot be.
    QuietbladeError
        A stage failed.
    """
    known = load_blade(case, progress) if loaded is None else loaded
    return tabulate("From C0 to C1", known, _alternatives(known, progress), progress)


def _alternatives(loaded: LoadedBlade, progress: Progress) -> Iterator[Alternative]:
    yield Alternative(REST, "at rest: C0", vibrate(loaded, at_rest=True, progress=progress))
    for name, (description, share) in SHARES.items():
        yield Alternative(name, description, vibrate(loaded, share, progress=progress))
