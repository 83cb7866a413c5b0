# SPDX-License-Identifier: LGPL-2.1-or-later
"""Headline figures of the excitations and of the transfer functions, and their tables."""

import numpy as np

from quietblade.results.model import REFERENCE_POWER, ConfigurationResult, Result
from quietblade.results.summary import ExcitationSummary, TransferFigures, TransferSummary
from quietblade.typing import AnyArray, FloatArray

NAN = float("nan")
_NONE = TransferFigures(
    largest_mobility={},
    largest_power_per_force={},
    largest_root_force_n=NAN,
    largest_root_moment_nm=NAN,
    mean_shaft_db=NAN,
)


def excitation_summaries(result: Result) -> tuple[ExcitationSummary, ...]:
    """Figures of each load."""
    tables = {name: c.excitations for name, c in result.configurations.items()}
    if not tables:
        return ()
    first = next(iter(tables.values()))
    means = {name: table.mean_level.tolist() for name, table in tables.items()}
    return tuple(
        ExcitationSummary(
            name=name,
            kind=first.kind[k],
            unit=first.unit[k],
            amplitude=float(np.abs(first.amplitude[k]).max()),
            C0_mean_db=means["C0"][k] if "C0" in means else None,
            C1_mean_db=means["C1"][k] if "C1" in means else None,
        )
        for k, name in enumerate(first.name)
    )


def transfer_summary(result: Result) -> TransferSummary:
    """Figures of the transfer functions."""
    members = result.configurations
    asked = next((c.transfer.functions for c in members.values()), ())
    return TransferSummary(
        functions=asked, C0=_figures(members.get("C0")), C1=_figures(members.get("C1"))
    )


def _figures(configuration: ConfigurationResult | None) -> TransferFigures:
    if configuration is None or not configuration.transfer.functions:
        return _NONE
    transfer, names = configuration.transfer, configuration.excitations.name
    return TransferFigures(
        largest_mobility=dict(zip(names, map(_largest, transfer.mobility), strict=True)),
        largest_power_per_force=dict(
            zip(names, map(_largest, transfer.power_per_force), strict=True)
        ),
        largest_root_force_n=_largest(np.linalg.norm(transfer.root_force, axis=0)),
        largest_root_moment_nm=_largest(np.linalg.norm(transfer.root_moment, axis=0)),
        mean_shaft_db=_mean_level(configuration.spectrum.frequency, transfer.shaft_power),
    )


def _largest(values: AnyArray) -> float:
    size = np.abs(values)
    size = size[np.isfinite(size)]
    return float(size.max()) if size.size else NAN


def _mean_level(frequency: FloatArray, power: FloatArray) -> float:
    """Level of the mean power over the band, nan without any [dB]."""
    kept = np.isfinite(power)
    f, p = frequency[kept], power[kept]
    if len(f) == 0:
        return NAN
    mean = float(np.trapezoid(p, f) / (f[-1] - f[0])) if len(f) > 1 else float(p[0])
    return float(10.0 * np.log10(mean / REFERENCE_POWER)) if mean > 0.0 else NAN
