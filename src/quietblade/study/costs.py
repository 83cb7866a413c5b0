# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a run will cost: memory, and time by stage.

The constants are those of runs of the paper's blades (20 000 to 184 000 unknowns, two threads),
in units of one factorisation of `quietblade.linalg.trial` on the same machine.
"""

from dataclasses import dataclass

import numpy as np

from quietblade.case import AnyCase, Case
from quietblade.geometry import Blade
from quietblade.linalg import default_threads
from quietblade.study import translate
from quietblade.study.forecast import Size

TIME_FACTOR = 2.0
"""A stage takes between the estimate over this factor and the estimate times it."""

MEMORY_FACTOR = 1.5
"""The same of the memory."""

_TRIAL = 0.058  # processor time of the trial on the machine of the constants [s]
_THREADS = 2
_SCALING = 0.8  # power of the number of threads by which a run gets faster
_MOST_THREADS = 8  # more do not help systems of this size

_FACTOR = 3.0 / 54_700**1.43  # seconds of a factorisation over unknowns^1.43
_FACTOR_POWER = 1.43
_MESH = 8e-5  # the rest is seconds a node or an unknown
_LOFT = 20.0  # seconds that the geometry kernel takes for a blade that is not ruled
_STATICS = 4.5e-4
_MOTION = 5e-5
_ASSEMBLY = 1.6e-4
_MODE_FACTORS = 2.0
_SWEEP = 2e-5
_TABLES = 2e-5
_FILES = 5e-5
_MODES = 10  # whose peaks are refined
_FIRST, _PER_UNKNOWN, _SECOND = 0.3e9, 36e3, 0.25  # bytes; share of a second configuration
_RULED = 1e-6


@dataclass(frozen=True)
class Cost:
    """Estimated cost of a run.

    Attributes
    ----------
    memory : float
        Largest memory [B], within `MEMORY_FACTOR`.
    seconds : dict of str to float
        Time of each stage, on this machine with nothing beside, within `TIME_FACTOR` [s].
    threads : int
        For which that is.
    """

    memory: float
    seconds: dict[str, float]
    threads: int

    @property
    def total(self) -> float:
        """Time of all stages [s]."""
        return sum(self.seconds.values())


def estimate(case: AnyCase, blade: Blade | None, size: Size, trial: float) -> Cost:
    """Estimate memory and time.

    Parameters
    ----------
    case : AnyCase
    blade : Blade or None
        None for another body.
    size : Size
        Of the systems.
    trial : float
        Of `quietblade.linalg.trial.trial_seconds` on this machine [s].
    """
    threads = default_threads()
    slower = trial / _TRIAL * (_THREADS / min(threads, _MOST_THREADS)) ** _SCALING
    raw = _stages(case, blade, size)
    names = case.acoustics.configurations
    share = 1.0 + _SECOND * (len(names) - 1)
    return Cost(
        memory=_FIRST + share * _PER_UNKNOWN * size.vibration,
        seconds={name: slower * seconds for name, seconds in raw.items()},
        threads=threads,
    )


def _stages(case: AnyCase, blade: Blade | None, size: Size) -> dict[str, float]:
    """Time of each stage on the machine of the constants [s], in their order."""
    n, acoustics = size.vibration, case.acoustics
    factor = _FACTOR * n**_FACTOR_POWER
    statics, motion = _STATICS * size.statics, _MOTION * size.nodes
    modes = _ASSEMBLY * n + _MODE_FACTORS * factor
    sweep = _SWEEP * n
    if acoustics.sweep == "direct":
        modes -= factor  # no reduced model is made
        frequencies = len(translate.base_frequencies(case)) + _MODES * acoustics.points_per_mode
        sweep = frequencies * factor
    found = {"mesh": _MESH * size.nodes + (0.0 if blade is None or _ruled(blade) else _LOFT)}
    if blade is not None:
        found["flow and structure"] = statics
    if "C1" in acoustics.configurations:
        found["mesh motion"] = motion
    found |= {f"modes {name}": modes for name in acoustics.configurations}
    found |= {f"sweep {name}": sweep for name in acoustics.configurations}
    dry = 0.5 * modes * len(acoustics.configurations) if acoustics.dry_modes else 0.0
    found["mode tables"] = _TABLES * n + dry
    if isinstance(case, Case) and case.campbell is not None:
        each = statics + motion + _ASSEMBLY * n + factor
        found["Campbell diagram"] = len(case.campbell.speeds) * each
    return found | {"files": _FILES * size.nodes}


def _ruled(blade: Blade) -> bool:
    """Whether straight lines from root to tip make the blade."""
    root, middle, tip = blade.section(np.array([0.0, 0.5, 1.0]), 41)
    return bool(np.abs(0.5 * (root + tip) - middle).max() < _RULED * blade.span)
