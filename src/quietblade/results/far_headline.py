# SPDX-License-Identifier: LGPL-2.1-or-later
"""Headline figures of the far field: peaks, bands, limits."""

from collections.abc import Iterator

import numpy as np

from quietblade.results.excitations import of_signal
from quietblade.results.model import ConfigurationResult, Result, path
from quietblade.results.peaks import find_peaks
from quietblade.results.summary import (
    BandSummary,
    ConfigurationSound,
    FarFieldSummary,
    LimitSummary,
    PatternSummary,
)
from quietblade.typing import FloatArray


def far_field_summary(result: Result) -> FarFieldSummary:
    """Peaks, frequencies asked for and bands of each configuration."""
    members = result.configurations
    first = next(iter(members.values()), None)
    return FarFieldSummary(
        origin=first.far_field.origin if first else "",
        band_kind=first.bands.kind if first else "",
        distance_m=first.directivity.distance if first else None,
        source_level_reference=of_signal("1 uPa m", random=first.random) if first else "",
        C0=_sound(members.get("C0")),
        C1=_sound(members.get("C1")),
    )


def limit_summaries(result: Result) -> Iterator[LimitSummary]:
    """Each limit in each configuration."""
    for name, configuration in result.configurations.items():
        table = configuration.limits
        for i, limit in enumerate(table.name):
            excess = float(table.worst_excess[i])
            yield LimitSummary(
                name=limit,
                quantity=table.quantity[i],
                bands=table.bands[i],
                configuration=name,
                worst_excess_db=excess,
                worst_frequency_hz=float(table.worst_frequency[i]),
                exceeded=excess > 0.0 if np.isfinite(excess) else None,
            )


def _sound(configuration: ConfigurationResult | None) -> ConfigurationSound:
    if configuration is None:
        return ConfigurationSound(
            mean_level_db=None, mean_source_level_db=None, largest_condition_error_db=None,
            peaks=(), given=(), bands=(),
        )  # fmt: skip
    bands, error = configuration.bands, configuration.far_field.condition_error
    reasons = configuration.directivity.reason
    columns = zip(bands.centre, bands.level, bands.source_level, strict=True)
    return ConfigurationSound(
        mean_level_db=bands.mean_level,
        mean_source_level_db=bands.mean_source_level,
        largest_condition_error_db=_largest(error),
        peaks=tuple(_pattern(configuration, i) for i, r in enumerate(reasons) if r == "peak"),
        given=tuple(_pattern(configuration, i) for i, r in enumerate(reasons) if r == "given"),
        bands=tuple(
            BandSummary(centre_hz=float(f), level_db=float(power), source_level_db=float(source))
            for f, power, source in columns
        ),
    )


def _pattern(configuration: ConfigurationResult, i: int) -> PatternSummary:
    """One pattern; level, width and estimate are those of its peak."""
    pattern, peaks, spectrum = (
        configuration.directivity, configuration.peaks, configuration.spectrum,
    )  # fmt: skip
    is_peak = pattern.reason[i] == "peak"  # the peaks come first, in their order
    frequency = float(peaks.frequency[i] if is_peak else pattern.frequency[i])
    modes = {p.frequency: p.mode for p in find_peaks(configuration).values()}
    nearest = int(np.argmin(np.abs(spectrum.frequency - frequency)))
    level = peaks.power_level[i] if is_peak else spectrum.power_level[path("sphere"), nearest]
    monopole, dipole, quadrupole, higher = pattern.share[i].tolist()
    return PatternSummary(
        mode=modes.get(frequency, "") if is_peak else "",
        frequency_hz=frequency,
        level_db=float(level),
        source_level_db=float(pattern.source_level[i]),
        width_hz=float(peaks.width[i]) if is_peak else None,
        estimate_db=float(peaks.estimate[i]) if is_peak else None,
        efficiency=float(pattern.efficiency[i]),
        monopole=monopole,
        dipole=dipole,
        quadrupole=quadrupole,
        higher=higher,
        index_db=float(pattern.index[i]),
        loudest=tuple(pattern.loudest[i].tolist()),
    )


def _largest(error: FloatArray) -> float | None:
    """Find the error of largest size, with its sign; None if there is none."""
    known = error[np.isfinite(error)]
    return float(known[np.argmax(np.abs(known))]) if known.size else None
