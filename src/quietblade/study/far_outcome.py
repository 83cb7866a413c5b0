# SPDX-License-Identifier: LGPL-2.1-or-later
"""From the sound of a configuration to its bands, far field, directivity and limits."""

import numpy as np

from quietblade.case import AnyCase
from quietblade.results import model
from quietblade.study.far_field import FarField, Outside, together
from quietblade.study.limits import bands_of, limits
from quietblade.study.sound import Sound
from quietblade.typing import ComplexArray, FloatArray
from quietblade.vibroacoustics.bands import Bands, Limit, band_mean
from quietblade.vibroacoustics.directivity import (
    directivity,
    plane_directions,
    pressure_level,
    source_level,
)
from quietblade.vibroacoustics.power import level

_ANGLES = 180  # of a polar diagram: every 2 degrees
_POLAR, _AZIMUTH = 37, 72  # of the grid around: every 5 degrees

_NORMALS = {"xy": (0.0, 0.0, 1.0), "xz": (0.0, -1.0, 0.0), "yz": (1.0, 0.0, 0.0)}
_STARTS = {"xy": (1.0, 0.0, 0.0), "xz": (1.0, 0.0, 0.0), "yz": (0.0, 1.0, 0.0)}


def band_table(case: AnyCase, sound: Sound) -> model.BandTable:
    """Mean power in the bands that the frequencies cover, and over all frequencies."""
    frequency, through, leaving = _solved(sound)
    bands = _whole(case.bands.kind, frequency)
    ends = (frequency[0], frequency[-1])
    water = sound.far.spectrum.waves.water
    return model.BandTable(
        kind=case.bands.kind,
        centre=bands.centre,
        lower=bands.lower,
        upper=bands.upper,
        level=level(bands.mean(frequency, through)),
        source_level=source_level(bands.mean(frequency, leaving), water),
        mean_level=float(level(np.array(band_mean(frequency, through, ends)))),
        mean_source_level=float(source_level(np.array(band_mean(frequency, leaving, ends)), water)),
    )


def far_field_result(radius: float, far: FarField) -> model.FarFieldResult:
    """Curves over frequency; ``radius`` is that of the outer sphere [m]."""
    waves = far.spectrum.waves
    return model.FarFieldResult(
        origin=far.origin,
        frequency=waves.omega / (2.0 * np.pi),
        kr=waves.omega * radius / waves.water.sound_speed,
        source_level=source_level(far.spectrum.power, waves.water),
        efficiency=far.spectrum.efficiency,
        share=far.spectrum.share.T,
        condition_error=far.condition_error,
        place=far.points,
        pressure=far.pressure,
    )


def directivity_result(case: AnyCase, far: FarField) -> model.DirectivityResult:
    """Polar diagrams and sphere of directions at the peaks and the frequencies of the case."""
    waves, words = far.patterns.waves, case.far_field
    distance = np.inf if words.distance is None else words.distance
    angle = 2.0 * np.pi * np.arange(_ANGLES) / _ANGLES
    cuts = [plane_directions(_NORMALS[name], _ANGLES, _STARTS[name])[1] for name in words.planes]
    polar = np.linspace(0.0, np.pi, _POLAR)
    azimuth = 2.0 * np.pi * np.arange(_AZIMUTH) / _AZIMUTH
    around = _sphere(polar, azimuth)
    count, shape = len(waves.omega), (len(waves.omega), _POLAR, _AZIMUTH)
    product, mean = _directed(far.patterns, around, distance)
    in_planes = pressure_level(_directed(far.patterns, np.concatenate(cuts), distance)[0])
    top = np.argmax(np.abs(product), axis=1)
    loudest = np.abs(product[np.arange(count), top]) ** 2
    return model.DirectivityResult(
        frequency=waves.omega / (2.0 * np.pi),
        reason=far.reason,
        source_level=source_level(far.patterns.power, waves.water),
        efficiency=far.patterns.efficiency,
        share=far.patterns.share,
        index=10.0 * np.log10(loudest / mean),
        loudest=around[top],
        centre=waves.center,
        distance=distance,
        cut=words.planes,
        angle=angle,
        cut_level=in_planes.reshape(count, len(cuts), _ANGLES),
        polar=polar,
        azimuth=azimuth,
        level=pressure_level(product).reshape(shape),
        product=product.reshape(shape),
    )


def _directed(
    outside: Outside, directions: FloatArray, distance: float
) -> tuple[ComplexArray, FloatArray]:
    """Pressure times distance (f, d) [Pa m] of all parts, and its mean square (f,)."""
    found = [directivity(part, directions, distance) for part in outside.parts]
    mean = np.zeros(len(outside.waves.omega))
    for each in found:
        top = np.argmax(np.abs(each.product), axis=1)[:, None]
        squared = np.abs(np.take_along_axis(each.product, top, 1)) ** 2
        mean += (squared / 10.0 ** (np.take_along_axis(each.index, top, 1) / 10.0))[:, 0]
    return together([each.product for each in found]), mean


def limit_table(case: AnyCase, sound: Sound) -> model.LimitTable:
    """Hold the levels against each limit, the peaks of the reduced model included."""
    held = limits(case)
    rows = [
        _limit_rows(words.quantity, words.bands, limit, sound)
        for words, limit in zip(case.limits, held, strict=True)
    ]
    worst = [_worst(*columns) for columns in rows]
    frequency, found, allowed = (
        np.concatenate([np.zeros(0), *(columns[k] for columns in rows)]) for k in range(3)
    )
    return model.LimitTable(
        name=tuple(words.name for words in case.limits),
        quantity=tuple(words.quantity for words in case.limits),
        bands=tuple(words.bands for words in case.limits),
        worst_excess=np.array([excess for excess, _ in worst]),
        worst_frequency=np.array([at for _, at in worst]),
        row_of=np.repeat(np.arange(len(rows)), [len(columns[0]) for columns in rows]),
        frequency=frequency,
        found=found,
        allowed=allowed,
    )


def _limit_rows(
    quantity: str, kind: str, limit: Limit, sound: Sound
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Frequencies [Hz], levels there and levels of the limit [dB]."""
    frequency, through, leaving = _solved(sound)
    of_waves = quantity == "source-level"
    power = leaving if of_waves else through
    if kind == "narrow":
        # a needle of the reduced model may stand between two frequencies of the sweep
        at_peaks = sound.far.patterns.power[: len(sound.peaks.frequency)]
        top = at_peaks if of_waves else sound.peaks.power
        power = np.concatenate([power, top])
        frequency = np.concatenate([frequency, sound.peaks.frequency])
        frequency, first = np.unique(frequency, return_index=True)
        power = power[first]
    else:
        bands = _whole(kind, frequency)
        frequency, power = bands.centre, bands.mean(frequency, power)
    water = sound.far.spectrum.waves.water
    found = source_level(power, water) if of_waves else level(power)
    return frequency, found, limit.at(frequency)


def _worst(frequency: FloatArray, found: FloatArray, allowed: FloatArray) -> tuple[float, float]:
    """Largest excess [dB] and its frequency [Hz], nan if there is none."""
    excess = found - allowed
    if not np.isfinite(excess).any():
        return np.nan, np.nan
    top = int(np.nanargmax(excess))
    return float(excess[top]), float(frequency[top])


def _solved(sound: Sound) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Frequencies that have a solution, power through the sphere and of the outgoing waves."""
    through, leaving = sound.budget.radiated, sound.far.spectrum.power
    solved = np.isfinite(through)
    return sound.frequency[solved], through[solved], leaving[solved]


def _whole(kind: str, frequency: FloatArray) -> Bands:
    """Bands of a kind that the frequencies cover from edge to edge."""
    low, high = frequency[0], frequency[-1]
    bands = bands_of(kind, low, high)
    covered = (bands.lower >= low * (1.0 - 1e-9)) & (bands.upper <= high * (1.0 + 1e-9))
    return Bands(bands.centre[covered], bands.lower[covered], bands.upper[covered])


def _sphere(polar: FloatArray, azimuth: FloatArray) -> FloatArray:
    """Make unit vectors (polar x azimuth, 3)."""
    theta, phi = (part.ravel() for part in np.meshgrid(polar, azimuth, indexing="ij"))
    ring = np.sin(theta)
    return np.stack([ring * np.cos(phi), ring * np.sin(phi), np.cos(theta)], axis=1)
