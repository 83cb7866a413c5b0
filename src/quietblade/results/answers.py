# SPDX-License-Identifier: LGPL-2.1-or-later
"""The headline answers in words, in the order in which people ask."""

from collections.abc import Iterable, Iterator, Mapping
from itertools import groupby

import numpy as np

from quietblade.results.summary import ConfigurationSound, ModeSummary, PatternSummary, Summary
from quietblade.results.table import Table, number

QUESTIONS = (
    "How much does it bend?",
    "What happens to the lift?",
    "Where are the resonances?",
    "How loud is it?",
    "Where does the power go?",
    "How far to trust it?",
)
"""In the order in which people ask."""

_MISSING = "not computed"


def answers(summary: Summary) -> Table:
    """Answer each question in one or two sentences."""
    texts = (_bend, _lift, _resonances, _loud, _power, _trust)
    of_blades = () if summary.static is not None else (_bend, _lift)
    rows = tuple(
        (question, " ".join(text(summary)) or _MISSING)
        for question, text in zip(QUESTIONS, texts, strict=True)
        if text not in of_blades
    )
    return Table("In short", (), rows)


def _bend(summary: Summary) -> Iterator[str]:
    static = summary.static
    if static is None:
        return
    if not static.converged:
        yield "The equilibrium did NOT converge; these are figures of its last state."
    along = [1e3 * (np.nan if u is None else u) for u in static.tip_displacement_m]
    parts = ", ".join(f"{u:z.1f}" for u in along)
    yield f"The tip moves by {np.linalg.norm(along):.1f} mm (x, y, z: {parts} mm)"
    yield f"and turns by {number(static.tip_blade_angle_deg, '+.2f')} deg."
    if static.max_film_shear_strain is not None:
        yield f"Largest shear strain of the film: {100 * static.max_film_shear_strain:.2f} %."
    stress = None if summary.strength is None else summary.strength.von_mises_pa.get("blade")
    if stress is not None:
        yield f"Largest von Mises stress in the blade: {1e-6 * stress:.4g} MPa."


def _lift(summary: Summary) -> Iterator[str]:
    static, rotor = summary.static, summary.performance
    if static is None or rotor is None or static.lift_n is None:
        return
    yield f"Lift {static.lift_n:.1f} N"
    if static.lift_rigid_n:
        change = 100.0 * (static.lift_n / static.lift_rigid_n - 1.0)
        yield f"against {static.lift_rigid_n:.1f} N of the rigid blade: {change:+.1f} %."
    else:
        yield "(that of the rigid blade: not computed)."
    before, after = rotor.rigid.efficiency, rotor.coupled.efficiency
    if before is not None and after is not None:
        yield f"Efficiency of the rotor {after:.3f} against {before:.3f}."


def _resonances(summary: Summary) -> Iterator[str]:
    for name, modes in (("C0", summary.modes.C0), ("C1", summary.modes.C1)):
        if modes:
            yield f"{_STATE[name]} ({name}), in the water: {_frequencies(modes)} Hz."


def _frequencies(modes: Iterable[ModeSummary]) -> str:
    """Frequencies by name; of modes that differ in their second number only, the mean."""
    elastic = (mode for mode in modes if mode.kind != "rigid")
    told = []
    for stem, group in groupby(elastic, key=lambda mode: mode.name.partition(".")[0]):
        known = [mode.frequency_hz for mode in group]
        mean = np.mean([np.nan if f is None else f for f in known])
        count = f" ({len(known)} modes)" if len(known) > 1 else ""
        told.append(f"{stem} {number(float(mean), '.1f')}{count}")
    return ", ".join(told)


def _loud(summary: Summary) -> Iterator[str]:
    sound = summary.sound_power
    members = (("C0", summary.far_field.C0), ("C1", summary.far_field.C1))
    for name, member in members:
        if member.mean_level_db is not None:
            yield f"{_STATE[name]} ({name}): {_level(member)}."
    if any(member.mean_level_db is not None for _, member in members):
        yield f"Sound power levels in dB re {sound.level_reference}."
    exceeded = [limit for limit in summary.limits if limit.exceeded]
    if exceeded:
        names = ", ".join(dict.fromkeys(limit.name for limit in exceeded))
        yield f"Above the limit: {names}."
    elif summary.limits:
        yield "No limit of the case is exceeded."


def _level(member: ConfigurationSound) -> str:
    mean = f"mean over the band {number(member.mean_level_db, '.1f')} dB"
    peaks = [peak for peak in member.peaks if peak.level_db is not None]
    if not peaks:
        return mean
    top = max(peaks, key=_height)
    whose = f" ({top.mode})" if top.mode else ""
    return (
        f"loudest peak {number(top.level_db, '.1f')} dB at {number(top.frequency_hz, '.2f')} Hz"
        f"{whose}, {mean}"
    )


def _height(peak: PatternSummary) -> float:
    return -np.inf if peak.level_db is None else peak.level_db


def _power(summary: Summary) -> Iterator[str]:
    paths = summary.power_paths
    for name, shares in (("C0", paths.C0), ("C1", paths.C1)):
        if shares.mean:
            yield f"{_STATE[name]} ({name}), in the mean over the band: {_shares(shares.mean)}."


def _shares(shares: Mapping[str, float | None]) -> str:
    return ", ".join(
        f"{number(None if share is None else 100.0 * share, '.3g')} % "
        + ("radiated into the water" if sink == "water" else f"in the {sink}")
        for sink, share in shares.items()
    )


def _trust(summary: Summary) -> Iterator[str]:
    static, balance, sound = summary.static, summary.balance, summary.sound_power
    if static is not None:
        verdict = "converged" if static.converged else "did NOT converge"
        yield (
            f"Flow and structure {verdict}, with an estimated error of "
            f"{number(static.estimated_error, '.0e')}."
        )
    if balance.max_relative_residual is not None:
        yield f"The power balances to {balance.max_relative_residual:.0e};"
        yield (
            "sphere and multipoles differ by up to "
            f"{number(sound.max_multipole_difference_db, '.1g')} dB."
        )
    count = len(summary.notices)
    yield f"{count} warning{'' if count == 1 else 's'}{', see below' if count else ''}."


_STATE = {"C0": "At rest", "C1": "Under load"}
