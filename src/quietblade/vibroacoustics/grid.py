# SPDX-License-Identifier: LGPL-2.1-or-later
"""Frequencies of a sweep that resolve needles."""

import numpy as np

from quietblade.typing import FloatArray

_CORE = 0.75  # largest step of t: the first point beside a peak is 2.2 dB below it
_NEAREST = 1e-2  # of the half-width: points of the grid that are closer are one point


def refined_grid(
    band: tuple[float, float],
    step: float,
    modes: tuple[FloatArray, FloatArray] | None = None,
    points_per_mode: int = 15,
) -> FloatArray:
    """Even grid with more points around each mode, one of them at its peak.

    The points of a mode lie at f + f eta/2 sinh(t) with evenly spaced t: even within the
    half-power width f eta, three of them at least, and from there in geometric steps, along which
    the level of a needle falls by equal parts, until they meet the even grid or are used up.

    Parameters
    ----------
    band : (float, float)
        First and last frequency [Hz].
    step : float
        Largest distance of the even grid [Hz].
    modes : (f, eta), optional
        Frequencies Re Omega / 2 pi [Hz] and loss factors 2 Im Omega / Re Omega of complex modes;
        those outside the band count where their points fall inside.
    points_per_mode : int
        Points on both sides of a peak together, the peak included.

    Returns
    -------
    (n,) array
        Ascending frequencies without repetition.

    Raises
    ------
    ValueError
        If the band is empty, or the step or the number of points is not positive.
    """
    low, high = band
    if not 0.0 < low <= high or step <= 0.0 or points_per_mode < 1:
        raise ValueError(
            f"frequencies: no grid in the band {low:g} to {high:g} Hz with step {step:g} Hz and "
            f"{points_per_mode} points a mode"
        )
    count = int(np.ceil((high - low) / step * (1.0 - 1e-12)))
    even = np.linspace(low, high, count + 1) if count else np.array([low])
    if modes is None or len(modes[0]) == 0:
        return even
    frequency, loss = (np.atleast_1d(np.asarray(part, dtype=float)) for part in modes)
    half_width = 0.5 * frequency * np.abs(loss)
    # A mode without loss has no width; a millionth still shows where it is.
    half_width = np.maximum(half_width, 0.5e-6 * frequency)
    half = points_per_mode // 2
    reach = np.arcsinh(np.maximum(step / half_width, 1.0)) / max(half, 1)
    steps = np.minimum(reach, _CORE)[:, None] * np.arange(-half, half + 1)
    around = frequency[:, None] + half_width[:, None] * np.sinh(steps)
    around[:, half] = frequency
    inside = (around >= low) & (around <= high)
    kept = around[inside]
    gap = np.broadcast_to(_NEAREST * half_width[:, None], around.shape)[inside]
    peaks = frequency[(frequency >= low) & (frequency <= high)]
    return _merged(even, kept, gap, peaks)


def _merged(even: FloatArray, around: FloatArray, gap: FloatArray, peaks: FloatArray) -> FloatArray:
    """Unite the points; a peak stays exactly where it is, others give way to a close neighbour."""
    points = np.concatenate([peaks, even, around])
    rank = np.concatenate([np.zeros(len(peaks)), np.ones(len(even)), np.full(len(around), 2.0)])
    distance = np.concatenate([np.zeros(len(peaks) + len(even)), gap])
    order = np.lexsort((rank, points))
    chosen: list[int] = []
    for index in order:
        last = chosen[-1] if chosen else None
        if last is None or points[index] - points[last] > max(distance[index], distance[last]):
            chosen.append(int(index))
        elif rank[index] < rank[last]:
            chosen[-1] = int(index)
    return np.unique(points[chosen])
