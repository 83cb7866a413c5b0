# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where the injected power goes: each lossy region, and the water."""

from collections.abc import Mapping

import numpy as np

from quietblade.results.model import Dissipation
from quietblade.study.losses import region_of
from quietblade.study.sound import Sound
from quietblade.study.vibration import Vibration
from quietblade.typing import FloatArray
from quietblade.vibroacoustics.bands import band_mean

WATER = "water"
"""Name of what is radiated."""


def dissipation(vibration: Vibration, sound: Sound) -> Dissipation:
    """Power by region and water, with its shares in the mean over the band and at each peak.

    The mean is over the frequencies that could be solved; peaks are those of the reduced model, or
    the highest frequencies of a direct sweep.
    """
    sinks = _by_region(sound.lost, sound.budget.radiated)
    power = np.array(list(sinks.values()))
    solved = np.isfinite(power).all(axis=0)
    frequency = sound.frequency[solved]
    ends = (float(frequency[0]), float(frequency[-1]))
    mean = np.array([band_mean(frequency, row[solved], ends) for row in power])
    peak, at_peak = _peaks(vibration, sound, power)
    return Dissipation(
        sink=tuple(sinks),
        power=power,
        mean_share=mean / mean.sum(),
        peak_frequency=peak,
        peak_share=at_peak / at_peak.sum(axis=0),
    )


def _peaks(vibration: Vibration, sound: Sound, power: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Frequencies of the peaks (p,), and the powers there (sinks, p)."""
    if vibration.sweep is None:
        return sound.peaks.frequency, power[:, np.isin(sound.frequency, sound.peaks.frequency)]
    model, omega = vibration.sweep.model, 2.0 * np.pi * sound.peaks.frequency
    combined = vibration.excited.combined(model, omega)
    sinks = _by_region(combined.lost, combined.radiated)
    return sound.peaks.frequency, np.array(list(sinks.values()))


def _by_region(lost: Mapping[str, FloatArray], radiated: FloatArray) -> dict[str, FloatArray]:
    """Add the parts of a region up, and put the water last."""
    sinks: dict[str, FloatArray] = {}
    for name, power in lost.items():
        region = region_of(name)
        sinks[region] = sinks.get(region, np.zeros(power.shape)) + power
    return {**sinks, WATER: radiated}
