# SPDX-License-Identifier: LGPL-2.1-or-later
"""Made-up tables of alternatives: plausible, and from no computation."""

import numpy as np

from quietblade.results.alternatives import AlternativeTable

MODES = ("B4", "B5", "T2", "B6")
SHIFT = {  # of the frequencies against C0, by alternative and mode
    "C0": (0.0, 0.0, 0.0, 0.0),
    "shape": (0.01, 0.02, -0.05, 0.03),
    "stress": (0.02, 0.03, 0.01, 0.02),
    "both": (0.03, 0.06, -0.04, 0.05),
    "load": (0.03, 0.055, -0.045, 0.05),
    "C1": (0.03, 0.055, -0.045, 0.0499),
}


def make_decomposition() -> AlternativeTable:
    """As from `decompose_shift`; the first mode makes no peak."""
    shift = np.array(list(SHIFT.values()))
    return _table("From C0 to C1", tuple(SHIFT), shift)


def make_water(change: float = 2e-4) -> AlternativeTable:
    """As from `compare_water`, all frequencies changed alike."""
    return _table("Water mesh of C1", ("moved", "re-meshed"), np.array([[0.0] * 4, [change] * 4]))


def _table(title: str, names: tuple[str, ...], shift: np.ndarray) -> AlternativeTable:
    frequency = np.array([80.0, 135.0, 160.0, 190.0]) * (1.0 + shift)
    level = 20.0 + 100.0 * shift
    level[:, 0] = np.nan
    return AlternativeTable(
        title=title,
        name=names,
        description=tuple(f"{name} counts" for name in names),
        mode=MODES,
        frequency=frequency,
        loss_factor=np.full(shift.shape, 1e-3),
        assurance=1.0 - np.abs(shift),
        peak_frequency=np.where(np.isfinite(level), frequency, np.nan),
        peak_level=level,
        mean_level=5.0 + shift[:, 1],
        element_size=0.022,
        content_key="made up",
    )
