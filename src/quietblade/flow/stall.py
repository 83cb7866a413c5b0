# SPDX-License-Identifier: LGPL-2.1-or-later
"""Incidence at which symmetric sections reach their greatest lift, from a table."""

import numpy as np
from numpy.typing import ArrayLike

from quietblade.typing import FloatArray

STALL_THICKNESS = np.array([0.06, 0.09, 0.12])
STALL_REYNOLDS = np.array([3.8e5, 1.2e6, 3.0e6])
STALL_INCIDENCE = np.radians([[5.75, 7.75, 10.75], [10.5, 13.25, 16.25], [13.5, 15.5, 18.5]])
"""Incidence of greatest lift of NACA 0006, 0009 and 0012 (rows) at `STALL_REYNOLDS` in XFOIL 6.99
with free transition (N = 9). Thin sections stall from the nose; higher Reynolds numbers delay
it."""


def stall_incidence(thickness: ArrayLike, reynolds: ArrayLike) -> FloatArray:
    """Incidence of greatest lift [rad], linear in the thickness and in the logarithm of Re.

    Beyond the table its ends hold. The incidence is that of the chord, because the ideal incidence
    of sections that bending or a parabolic mean line has cambered is near 0.

    Parameters
    ----------
    thickness, reynolds : array_like
        Largest thickness / chord; Reynolds number of the chord. They broadcast.
    """
    t, re = np.broadcast_arrays(np.asarray(thickness, dtype=np.float64), reynolds)
    low, high = STALL_REYNOLDS[[0, -1]]
    place = np.interp(np.log(np.clip(re, low, high)), np.log(STALL_REYNOLDS), np.arange(3.0))
    columns = np.stack([np.interp(t, STALL_THICKNESS, column) for column in STALL_INCIDENCE.T])
    before = np.minimum(place.astype(np.int64), len(STALL_REYNOLDS) - 2)
    lower = np.take_along_axis(columns, before[None], axis=0)[0]
    upper = np.take_along_axis(columns, before[None] + 1, axis=0)[0]
    return np.asarray(lower + (place - before) * (upper - lower), dtype=np.float64)
