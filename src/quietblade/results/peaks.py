# SPDX-License-Identifier: LGPL-2.1-or-later
"""Peaks of the sound power and the wet modes that make them."""

from dataclasses import dataclass

import numpy as np

from quietblade.results.model import ConfigurationResult, path

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
    """

    mode: str
    frequency: float
    level: float


def find_peaks(configuration: ConfigurationResult) -> dict[str, Peak]:
    """Peak of each wet mode inside the band; modes that make none are left out.

    The range of a mode ends half-way to its neighbours. A maximum at the end of the range is the
    flank of something else and no peak of this mode.
    """
    spectrum, modes = configuration.spectrum, configuration.modes
    solved = np.flatnonzero(np.isfinite(spectrum.power_level[path("sphere")]))
    frequency = spectrum.frequency[solved]
    level = spectrum.power_level[path("sphere")][solved]
    between = 0.5 * (modes.frequency[1:] + modes.frequency[:-1])
    lowest = np.maximum(np.r_[0.0, between], (1.0 - _REACH) * modes.frequency)
    highest = np.minimum(np.r_[between, np.inf], (1.0 + _REACH) * modes.frequency)
    peaks = {}
    for name, low, high in zip(modes.name, lowest, highest, strict=True):
        near = np.flatnonzero((frequency >= low) & (frequency <= high))
        if near.size == 0:
            continue
        top = near[np.argmax(level[near])]
        if 0 < top < len(level) - 1 and level[top] > max(level[top - 1], level[top + 1]):
            peaks[name] = Peak(name, float(frequency[top]), float(level[top]))
    return peaks


def partner_of(configuration: ConfigurationResult, mode: str) -> tuple[str, float] | None:
    """Name and MAC of the most similar mode of the other configuration, if there is one."""
    if mode not in configuration.modes.name:
        return None
    index = configuration.modes.name.index(mode)
    name = configuration.modes.partner[index]
    return (name, float(configuration.modes.partner_mac[index])) if name else None
