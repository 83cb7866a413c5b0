# SPDX-License-Identifier: LGPL-2.1-or-later
"""Spectra in bands, and limits to compare them with.

References
----------
IEC 61260-1:2014, Electroacoustics - Octave-band and fractional-octave-band filters: base ten.
ISO 18405:2017, Underwater acoustics - Terminology: a decidecade is a tenth of a decade, a third
octave the third root of two; they differ by 0.08 %.
"""

from dataclasses import dataclass
from typing import Self

import numpy as np

from quietblade.typing import FloatArray

BASE_TEN, BASE_TWO = 10.0**0.3, 2.0
"""Frequency ratio of an octave: three tenths of a decade, or exactly two."""

_REFERENCE = 1000.0


@dataclass(frozen=True)
class Bands:
    """Adjacent frequency bands.

    Attributes
    ----------
    centre, lower, upper : (b,) arrays
        Exact mid-band frequencies and edges [Hz].
    """

    centre: FloatArray
    lower: FloatArray
    upper: FloatArray

    @classmethod
    def between(cls, low: float, high: float, fraction: int = 3, octave: float = BASE_TEN) -> Self:
        """Bands whose centres lie in a range, ends included.

        Parameters
        ----------
        low, high : float
            [Hz]
        fraction : int
            1 for octaves, 3 for third octaves, which are decidecades in base ten, 6, 12, ...
        octave : float
            `BASE_TEN` or `BASE_TWO`.

        Raises
        ------
        ValueError
            If the range is empty or not positive, or the fraction less than one.
        """
        if not 0.0 < low <= high or fraction < 1:
            raise ValueError(
                f"bands: {low:g} to {high:g} Hz in 1/{fraction} octaves is not a range of bands; "
                "give positive frequencies in order and a fraction of one or more"
            )
        # An even fraction has the reference frequency on an edge.
        shift = 0.0 if fraction % 2 else 0.5
        ends = fraction * np.log(np.array([low, high]) / _REFERENCE) / np.log(octave)
        first, last = np.ceil(ends[0] - shift - 1e-9), np.floor(ends[1] - shift + 1e-9)
        centre = _REFERENCE * octave ** ((np.arange(first, last + 1.0) + shift) / fraction)
        half = octave ** (0.5 / fraction)
        return cls(centre, centre / half, centre * half)

    @property
    def width(self) -> FloatArray:
        """Upper minus lower edge [Hz]."""
        return np.asarray(self.upper - self.lower)

    def mean(self, frequency: FloatArray, power: FloatArray) -> FloatArray:
        """Mean over each band of a power spectrum that is a smooth function of frequency.

        Times `width` it is the power in the band of an excitation of unit density per Hz.

        Returns
        -------
        (b,) array
            nan for a band that the frequencies do not cover.
        """
        return np.array(
            [
                band_mean(frequency, power, (low, high))
                for low, high in zip(self.lower, self.upper, strict=True)
            ]
        )

    def total(self, frequency: FloatArray, power: FloatArray) -> FloatArray:
        """Power in each band of tones: the sum of those in [lower, upper)."""
        inside = (frequency >= self.lower[:, None]) & (frequency < self.upper[:, None])
        return np.asarray(np.where(inside, power, 0.0).sum(axis=1))


def band_mean(frequency: FloatArray, power: FloatArray, band: tuple[float, float]) -> float:
    """Mean of a power spectrum over a band.

    Between the given frequencies the level is taken as straight, so that the flanks of a needle
    are not overrated as by the trapezoidal rule; where a power is not positive, the power is.

    Parameters
    ----------
    frequency, power : (f,) arrays
        In any order; one value a frequency.
    band : (float, float)
        Edges [Hz].

    Returns
    -------
    float
        nan if the frequencies do not reach from edge to edge.

    Raises
    ------
    ValueError
        If the upper edge is not above the lower one.
    """
    if not band[0] < band[1]:
        raise ValueError(f"bands: {band[0]:g} to {band[1]:g} Hz is not a band")
    order = np.argsort(frequency)
    f, p = np.asarray(frequency, dtype=float)[order], np.asarray(power, dtype=float)[order]
    low, high = band
    if len(f) < 2 or low < f[0] - 1e-9 * low or high > f[-1] + 1e-9 * high:
        return float("nan")
    edges = np.clip([low, high], f[0], f[-1])
    inside = (f > edges[0]) & (f < edges[1])
    grid = np.concatenate([edges[:1], f[inside], edges[1:]])
    silent = bool(np.any(p <= 0.0))
    values = np.interp(grid, f, p) if silent else np.exp(np.interp(grid, f, np.log(p)))
    return float(np.sum(_segment_means(values) * np.diff(grid)) / (high - low))


def _segment_means(values: FloatArray) -> FloatArray:
    """Mean between neighbours: logarithmic where both are positive, else arithmetic."""
    left, right = values[:-1], values[1:]
    plain = 0.5 * (left + right)
    usable = (left > 0.0) & (right > 0.0) & (np.abs(left - right) > 1e-6 * np.abs(plain))
    a, b = np.where(usable, left, 1.0), np.where(usable, right, np.e)
    return np.where(usable, (b - a) / np.log(b / a), plain)


@dataclass(frozen=True)
class Limit:
    """A limit of a level over frequency, to be laid over a spectrum.

    Attributes
    ----------
    name : str
    frequency : (n,) array
        Ascending [Hz].
    level : (n,) array
        [dB], on whatever reference the compared levels have; straight over lg f in between.

    Raises
    ------
    ValueError
        If the table is not two columns of equal length with positive ascending frequencies.
    """

    name: str
    frequency: FloatArray
    level: FloatArray

    def __post_init__(self) -> None:
        f, level = np.asarray(self.frequency), np.asarray(self.level)
        ascending = f.ndim == 1 and len(f) > 0 and f[0] > 0.0 and bool(np.all(np.diff(f) > 0.0))
        if not ascending or level.shape != f.shape or not np.all(np.isfinite(level)):
            raise ValueError(
                f"limit {self.name!r}: needs positive ascending frequencies and one finite level "
                "for each"
            )

    def at(self, frequency: FloatArray) -> FloatArray:
        """Limit at frequencies [dB], nan outside the table."""
        return np.interp(
            np.log(frequency), np.log(self.frequency), self.level, left=np.nan, right=np.nan
        )

    def excess(self, frequency: FloatArray, level: FloatArray) -> FloatArray:
        """By how much levels are above the limit [dB]; negative below it, nan outside the table."""
        return np.asarray(level - self.at(frequency))
