# SPDX-License-Identifier: LGPL-2.1-or-later
"""When a section stalls: two criteria on attached flow.

Thick sections stall from the trailing edge: the turbulent layer separates, farther and farther
ahead. Thin sections stall from the nose: the bubble in which the laminar layer turns turbulent
bursts when the suction at the nose is too much for its Reynolds number. The limits were adjusted
to the greatest lift of NACA 0006, 0009 and 0012 in XFOIL at Re = 3.8e5, 1.2e6 and 3e6, and meet
those nine incidences within 0.8 degrees.
"""

import numpy as np

from quietblade.typing import BoolArray, FloatArray

SEPARATION_LIMIT = 0.7
"""Chord fraction ahead of which a separated turbulent layer means stall."""

SUCTION_LIMIT = 6.6
"""Suction -Cp_min at which the nose stalls at `NOSE_REYNOLDS`."""

NOSE_REYNOLDS = 1500.0
"""Reynolds number of the stream and the nose radius at which `SUCTION_LIMIT` holds."""

SUCTION_EXPONENT = 0.58
"""Power of the nose's Reynolds number with which the suction limit grows."""


_NOSE_REGION = 0.02


def nose_radius(contour: FloatArray) -> float:
    """Radius of curvature at the nose of a section.

    The nodes of the first two per cent of the chord are fitted by y^2 = 2 r x + k x^1.5, the form
    of the NACA sections, so that noise on single nodes does no harm.

    Parameters
    ----------
    contour : array (N, 2)
        In units of the chord, with the nose at (0, 0) and the trailing edge at (1, 0).

    Returns
    -------
    float
        In chords.
    """
    x, y = np.asarray(contour, dtype=np.float64).T
    near = (x < _NOSE_REGION) & (x > 0.0)
    terms = np.stack([2.0 * x[near], x[near] ** 1.5], axis=1)
    coefficients, *_ = np.linalg.lstsq(terms, y[near] ** 2, rcond=None)
    return max(float(coefficients[0]), 0.0)


def suction_limit(radius: FloatArray | float, reynolds: FloatArray | float) -> FloatArray:
    """Largest suction -Cp_min that the nose bears (theory: S1-78).

    Parameters
    ----------
    radius : array or float
        Nose radius / chord.
    reynolds : array or float
        Of the stream and the chord.
    """
    nose = np.asarray(radius, dtype=np.float64) * reynolds
    return np.asarray(SUCTION_LIMIT * (nose / NOSE_REYNOLDS) ** SUCTION_EXPONENT, dtype=np.float64)


def is_stalled(
    suction: FloatArray,
    limit: FloatArray,
    separation_upper: FloatArray,
    separation_lower: FloatArray,
) -> BoolArray:
    """Whether either criterion is met.

    Parameters
    ----------
    suction, limit : array (...)
        -Cp_min, and the `suction_limit` of the section.
    separation_upper, separation_lower : array (...)
        Chord fractions of turbulent separation; nan where attached.
    """
    first = np.fmin(separation_upper, separation_lower)
    return np.asarray((suction > limit) | (np.nan_to_num(first, nan=1.0) < SEPARATION_LIMIT))
