# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a sweep in even steps shows of a needle: its level depends on where the grid happens to lie.

The level at a frequency is that of the reduced model, as exact as the true peak (theory: S2-62).
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from quietblade.typing import FloatArray

STEPS = (0.5, 1.0, 2.0)
"""Steps of a sweep [Hz]."""

_ALIGNMENTS = 48  # places of the grid against the peak that are tried


@dataclass(frozen=True, eq=False)
class SteppedPeaks:
    """Power of each peak as grids would show it.

    Attributes
    ----------
    step : (g,) array
        Steps of the grids [Hz].
    aligned : (k, g) array
        Largest power beside the peak on the grid that begins at the lower end of the band [W].
    worst : (k, g) array
        The same on the grid whose frequencies lie most unluckily [W]. The luckiest shows the peak.
    """

    step: FloatArray
    aligned: FloatArray
    worst: FloatArray


def stepped_peaks(
    power: Callable[[FloatArray], FloatArray],
    peaks: FloatArray,
    band: tuple[float, float],
    steps: Sequence[float] = STEPS,
) -> SteppedPeaks:
    """Evaluate peaks on grids of even steps.

    Parameters
    ----------
    power : callable
        Radiated power (f,) [W] at frequencies (f,) [Hz].
    peaks : (k,) array
        Frequencies of the peaks [Hz], inside the band.
    band : (float, float)
        Lowest and highest frequency [Hz].
    steps : sequence of float
        [Hz]
    """
    aligned, worst = (np.zeros((len(peaks), len(steps))) for _ in range(2))
    for column, step in enumerate(steps):
        # distance of the next grid frequency above the peak; the symmetric place is among them
        offsets = step * np.linspace(0.0, 1.0, _ALIGNMENTS + 1)
        for row, top in enumerate(peaks):
            natural = band[0] + step * np.ceil((top - band[0]) / step) - top
            above = np.append(offsets, natural)
            pairs = top + np.stack([above, above - step])
            seen = power(np.clip(pairs, *band).ravel()).reshape(2, -1).max(axis=0)
            aligned[row, column] = seen[-1]
            worst[row, column] = seen.min()
    return SteppedPeaks(np.array(steps, dtype=float), aligned, worst)
