# SPDX-License-Identifier: LGPL-2.1-or-later
"""Peaks of the sound power and the wet modes that make them."""

from dataclasses import dataclass

import numpy as np

from quietblade.results.model import ConfigurationResult, PeakTable
from quietblade.typing import FloatArray

_REACH = 0.02
"""A peak is looked for within 2 % of the wet mode: losses and radiation move it far less."""


@dataclass(frozen=True)
class Peak:
    """A local maximum of the sound power through the sphere.

    Attributes
    ----------
    mode : str
        Wet mode that it belongs to.
    frequency : float
        Frequency of the maximum [Hz].
    level : float
        Sound power level [dB re 1 pW].
    width : float
        Half-power width [Hz], nan if it is not known.
    """

    mode: str
    frequency: float
    level: float
    width: float


def find_peaks(configuration: ConfigurationResult) -> dict[str, Peak]:
    """Peak of each wet mode inside the band; modes that make none are left out.

    The range of a mode ends half-way to its neighbours; the highest peak in it is the mode's.
    """
    modes = configuration.modes
    return assign_peaks(modes.name, modes.frequency, configuration.peaks)


def assign_peaks(
    names: tuple[str, ...], frequency: FloatArray, peaks: PeakTable
) -> dict[str, Peak]:
    """Peak of each mode, given by name and frequency [Hz], as `find_peaks` does."""
    between = 0.5 * (frequency[1:] + frequency[:-1])
    lowest = np.maximum(np.r_[0.0, between], (1.0 - _REACH) * frequency)
    highest = np.minimum(np.r_[between, np.inf], (1.0 + _REACH) * frequency)
    found = {}
    for name, low, high in zip(names, lowest, highest, strict=True):
        near = np.flatnonzero((peaks.frequency >= low) & (peaks.frequency <= high))
        if near.size:
            top = near[np.argmax(peaks.power_level[near])]
            found[name] = Peak(
                name,
                float(peaks.frequency[top]),
                float(peaks.power_level[top]),
                float(peaks.width[top]),
            )
    return found


def partner_of(configuration: ConfigurationResult, mode: str) -> tuple[str, float] | None:
    """Name and MAC of the most similar mode of the other configuration, if there is one."""
    if mode not in configuration.modes.name:
        return None
    index = configuration.modes.name.index(mode)
    name = configuration.modes.partner[index]
    return (name, float(configuration.modes.partner_mac[index])) if name else None
