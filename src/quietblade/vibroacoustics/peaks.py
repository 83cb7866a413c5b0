# SPDX-License-Identifier: LGPL-2.1-or-later
"""Peaks of the sound power: maxima of a reduced model, never read off a grid (theory: S2-62)."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from quietblade.typing import FloatArray
from quietblade.vibroacoustics.reduced import ReducedSweep

_REACH = 4.0  # half-power widths on either side in which the maximum is sought
_NARROWEST = 1e-7  # relative width of the search for a mode that hardly decays
_FINE = 1e-12  # relative tolerance of a peak's frequency
_SAME = 0.01  # tops closer than this share of a mode's width are one: no dip lies between them


@dataclass(frozen=True, eq=False)
class Peaks:
    """Maxima of the radiated power, in ascending frequency.

    Attributes
    ----------
    frequency : (k,) array
        Where the power is largest [Hz].
    power : (k,) array
        The largest power [W].
    width : (k,) array
        Distance of the frequencies on both sides where the power is half of that [Hz]; nan where
        it does not fall so far before a neighbour or the end of the band.
    estimate : (k,) array
        Estimate of the error of the level [dB].
    """

    frequency: FloatArray
    power: FloatArray
    width: FloatArray
    estimate: FloatArray


def find_peaks(
    sweep: ReducedSweep,
    band: tuple[float, float],
    radiated: Callable[[FloatArray], FloatArray] | None = None,
) -> Peaks:
    """Find the maxima of the radiated power that the model's damped modes make in a band [Hz].

    Parameters
    ----------
    sweep : ReducedSweep
        Certified model.
    band : (float, float)
        Lowest and highest frequency [Hz].
    radiated : callable, optional
        Radiated power (f,) at angular frequencies (f,) [rad/s]; that of the model if left out,
        which then has one load.
    """
    model = sweep.model
    powers = model.radiated if radiated is None else radiated

    def power(frequency: float) -> float:
        return float(powers(np.array([2.0 * np.pi * frequency]))[0])

    found: list[float] = []
    # the sharpest first: it finds its top best, and a broad mode may climb to the same one
    for loss, resonance in sorted(zip(*model.light_modes(band)[::-1], strict=True)):
        reach = _REACH * max(loss, _NARROWEST) * resonance
        low, high = max(band[0], resonance - reach), min(band[1], resonance + reach)
        # as an offset from the resonance, so that a needle is not lost in the digits of f
        best = minimize_scalar(
            lambda offset, near=resonance: -power(near + offset),
            bounds=(low - resonance, high - resonance), method="bounded",
            options={"xatol": _FINE * resonance},
        )  # fmt: skip
        top, margin = resonance + float(best.x), 1e-3 * (high - low)
        inside = low + margin < top < high - margin
        apart = _SAME * max(loss, _NARROWEST) * resonance
        if inside and all(abs(top - other) > apart for other in found):
            found.append(top)
    frequency = np.sort(found)
    return Peaks(
        frequency,
        np.array([power(f) for f in frequency]),
        np.array([_width(power, float(f), band) for f in frequency]),
        sweep.estimate(frequency) if len(frequency) else np.zeros(0),
    )


def peaks_on_grid(frequency: FloatArray, power: FloatArray) -> Peaks:
    """Frequencies that are louder than both neighbours; their widths and errors are not known.

    Parameters
    ----------
    frequency : (f,) array
        Ascending [Hz].
    power : (f,) array
        Radiated power [W], nan where it is not known.
    """
    known = np.isfinite(power)
    frequency, power = frequency[known], power[known]
    top = np.flatnonzero((power[1:-1] > power[:-2]) & (power[1:-1] > power[2:])) + 1
    unknown = np.full(len(top), np.nan)
    return Peaks(frequency[top], power[top], unknown, unknown.copy())


def _width(power: Callable[[float], float], top: float, band: tuple[float, float]) -> float:
    """Distance between the frequencies of half the power; nan if there are none."""
    half = 0.5 * power(top)
    sides = []
    for end in band:
        reach = abs(end - top)
        near, distance = top, _NARROWEST * top
        while True:
            far = top + np.sign(end - top) * min(distance, reach)
            value = power(far)
            if value <= half:
                break
            if distance >= reach:
                return float("nan")
            near, distance = far, 1.5 * distance
        sides.append(brentq(lambda f: power(f) - half, near, far, xtol=_FINE * top))
    return float(abs(sides[1] - sides[0]))
