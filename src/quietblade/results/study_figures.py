# SPDX-License-Identifier: LGPL-2.1-or-later
"""The figures of one run that a study tabulates and a calibration fits: one vocabulary."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from quietblade.results.claims import judge_claims
from quietblade.results.excitations import RANDOM, of_signal
from quietblade.results.headline import summarise
from quietblade.results.model import Result
from quietblade.results.peaks import find_peaks
from quietblade.results.summary import ModeSummary, Summary

NAN = float("nan")


@dataclass(frozen=True)
class Figure:
    """One number of a run.

    Attributes
    ----------
    name : str
        What a study file calls it, such as ``lift`` or ``C0_B5_frequency``.
    value : float
        NaN if it was not computed.
    unit : str
        ``"1"`` is a ratio or a count; levels say ``dB re 1 pW``, of random loads ``1 pW/Hz``.
    meaning : str
        In a few words.
    """

    name: str
    value: float
    unit: str
    meaning: str


def headline_figures(result: Result) -> tuple[Figure, ...]:
    """Figures that a study tabulates, in the order in which people ask.

    Those of modes are named by configuration, mode and what they are: ``C1_T2_peak_level``.
    """
    summary = summarise(result)
    random = summary.sound_power.signal == RANDOM
    figures = (
        *_static(summary),
        *_modes(summary),
        *_stepped(result),
        *_sound(summary),
        *_cost(summary),
    )
    return tuple(replace(f, unit=of_signal(f.unit, random=random)) for f in figures)


def all_figures(result: Result) -> dict[str, float]:
    """Values by name: those of `headline_figures`, and the claims of the paper by their ids."""
    figures = {figure.name: figure.value for figure in headline_figures(result)}
    claims = judge_claims(result)
    figures |= {claim.id: NAN if claim.value is None else claim.value for claim in claims}
    return figures


def _number(value: float | None) -> float:
    return NAN if value is None else float(value)


def _static(summary: Summary) -> Iterator[Figure]:
    static = summary.static
    if static is None:
        return
    for axis, value in zip("xyz", static.tip_displacement_m, strict=True):
        name = f"tip_displacement_{axis}"
        yield Figure(name, _number(value), "m", f"displacement of the tip along {axis}")
    yield Figure("lift", _number(static.lift_n), "N", "lift of the coupled blade")
    yield Figure("lift_rigid", _number(static.lift_rigid_n), "N", "lift of the rigid blade")
    yield Figure("lift_chained", _number(static.lift_chained_n), "N", "lift after one pass")
    gain = 100.0 * (_number(static.lift_n) / _number(static.lift_rigid_n) - 1.0)
    yield Figure("lift_gain", gain, "%", "lift of the coupled against the rigid blade")
    yield Figure("thrust", _number(static.thrust_n), "N", "thrust of the coupled blade")
    yield Figure("torque", _number(static.torque_nm), "N m", "torque of the coupled blade")
    yield Figure(
        "film_shear_strain",
        _number(static.max_film_shear_strain),
        "1",
        "largest shear strain (engineering gamma) in the film",
    )
    yield Figure(
        "film_shear_strain_p99",
        _number(static.film_shear_strain_p99),
        "1",
        "shear strain that 99 % of the film stay below",
    )
    yield Figure("mid_camber", _number(static.mid_camber), "1", "camber of the mid section / chord")
    yield Figure(
        "tip_blade_angle", _number(static.tip_blade_angle_deg), "deg", "change of the tip's angle"
    )
    yield Figure("passes", static.iterations, "1", "passes of the coupling")


def _modes(summary: Summary) -> Iterator[Figure]:
    loaded = {mode.name: mode for mode in summary.modes.C1}
    for name, modes in (("C0", summary.modes.C0), ("C1", summary.modes.C1)):
        for mode in modes:
            if mode.kind != "rigid":  # their frequency is zero up to rounding
                yield from _mode(name, mode)
    for mode in summary.modes.C0:
        partner = loaded.get(mode.partner)
        if partner is None:
            continue
        shift = 100.0 * (_number(partner.frequency_hz) / _number(mode.frequency_hz) - 1.0)
        yield Figure(f"shift_{mode.name}", shift, "%", "frequency, C1 against C0")
        yield Figure(f"mac_{mode.name}", _number(mode.partner_mac), "1", "likeness, C1 to C0")
        rise = _number(partner.peak_level_db) - _number(mode.peak_level_db)
        yield Figure(f"rise_{mode.name}", rise, "dB", "level of the peak, C1 against C0")


def _mode(configuration: str, mode: ModeSummary) -> Iterator[Figure]:
    start, of = f"{configuration}_{mode.name}", f"{mode.name} on {configuration}"
    yield Figure(f"{start}_frequency", _number(mode.frequency_hz), "Hz", f"wet mode {of}")
    yield Figure(f"{start}_loss_factor", _number(mode.loss_factor), "1", f"loss factor of {of}")
    if mode.peak_frequency_hz is None:
        return
    yield Figure(f"{start}_peak_frequency", mode.peak_frequency_hz, "Hz", f"peak of {of}")
    yield Figure(
        f"{start}_peak_level", _number(mode.peak_level_db), "dB re 1 pW", f"true peak of {of}"
    )
    yield Figure(
        f"{start}_peak_width", _number(mode.peak_width_hz), "Hz", f"half-power width of {of}"
    )


def _stepped(result: Result) -> Iterator[Figure]:
    """Peaks as sweeps in even steps would show them."""
    for name, configuration in result.configurations.items():
        table, frequencies = configuration.stepped, configuration.peaks.frequency
        for mode, peak in find_peaks(configuration).items():
            row = int(np.argmin(np.abs(frequencies - peak.frequency)))
            for column, step in enumerate(table.step):
                start = f"{name}_{mode}_peak_level_{step:g}_Hz"
                meaning = f"peak of {mode} on {name} in steps of {step:g} Hz"
                for end, levels, how in (
                    ("", table.power_level, "from the band's lower end"),
                    ("_worst", table.worst_level, "most unluckily placed"),
                ):
                    value = float(levels[row, column])
                    yield Figure(start + end, value, "dB re 1 pW", f"{meaning}, {how}")


def _sound(summary: Summary) -> Iterator[Figure]:
    sound = summary.sound_power
    for name, value in (("C0", sound.C0_mean_db), ("C1", sound.C1_mean_db)):
        meaning = f"level of the mean power in the band on {name}"
        yield Figure(f"{name}_mean_level", _number(value), "dB re 1 pW", meaning)


def _cost(summary: Summary) -> Iterator[Figure]:
    yield Figure("nodes", summary.mesh.nodes, "1", "nodes of the mesh")
    yield Figure("unknowns", summary.unknowns, "1", "unknowns of step 2")
    yield Figure("seconds", summary.timings_s["total"], "s", "time of the run")
