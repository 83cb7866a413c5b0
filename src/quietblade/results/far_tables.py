# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tables of the far field: peaks, bands, limits."""

from collections.abc import Iterator

from quietblade.results.excitations import RANDOM, of_signal
from quietblade.results.summary import ConfigurationSound, PatternSummary, Summary
from quietblade.results.table import Table, number

Rows = tuple[tuple[str, ...], ...]

PEAK_HEADS = ("Peak", "", "f [Hz]", "width [Hz]", "L_W", "L_S", "efficiency")
WAVE_HEADS = (
    "Peak", "", "f [Hz]", "mono-", "di-", "quadrupole", "higher", "DI [dB]", "loudest x, y, z",
)  # fmt: skip
LIMIT_HEADS = ("", "Limit", "Of", "Bands", "", "Excess [dB]", "at [Hz]")


def far_field_tables(summary: Summary) -> tuple[Table, ...]:
    """Peaks, limits and bands; those without rows are left to the caller to drop."""
    return (
        Table(
            "Peaks of the radiated power",
            PEAK_HEADS,
            tuple((*head, *_peak_row(pattern)) for head, pattern in _patterns(summary)),
            _peak_note(summary),
        ),
        Table(
            "Multipoles and directivity at the peaks",
            WAVE_HEADS,
            tuple((*head, *_wave_row(pattern)) for head, pattern in _patterns(summary)),
            _wave_note(summary),
        ),
        Table("Limits", LIMIT_HEADS, _limit_rows(summary)),
        Table("Bands", _band_columns(summary), _band_rows(summary), _band_note(summary)),
    )


def _peak_note(summary: Summary) -> str:
    """Say what the columns of the peaks are, and under which condition they hold."""
    far, sound = summary.far_field, summary.sound_power
    waves = "on the sphere" if far.origin == "sphere" else "of the wetted surface"
    errors = [
        abs(member.largest_condition_error_db)
        for member in (far.C0, far.C1)
        if member.largest_condition_error_db is not None
    ]
    note = (
        "width at half the power; L_W in dB re 1 pW through the sphere, L_S source level in "
        f"dB re 1 uPa m, mean over all directions, of the waves {waves}; efficiency by S2-47; "
        f"{sound.radiation_condition}, kR = {number(sound.kr_min, '.2f')} to "
        f"{number(sound.kr_max, '.2f')}: L_W is wrong by up to "
        f"{number(max(errors, default=None), '.2g')} dB by the estimate for this condition"
    )
    return of_signal(note, random=sound.signal == RANDOM)


def _wave_note(summary: Summary) -> str:
    """Say what the columns of the waves are."""
    distance = summary.far_field.distance_m
    place = "far away" if distance is None else f"at {distance:g} m"
    return (
        "shares of the radiated power; DI: largest squared pressure over its mean over all "
        f"directions, {place}; direction of the largest pressure in the axes of the case"
    )


def _band_columns(summary: Summary) -> tuple[str, ...]:
    """Heads of the table of bands."""
    names = [name for name, _ in _members(summary)]
    return (
        "Band [Hz]",
        *(f"L_W {name}" for name in names),
        *(f"L_S {name}" for name in names),
    )


def _band_rows(summary: Summary) -> Rows:
    """Levels of the bands and over all frequencies."""
    members = [member for _, member in _members(summary)]
    centres = sorted({b.centre_hz for m in members for b in m.bands if b.centre_hz is not None})
    bands = [{band.centre_hz: band for band in member.bands} for member in members]
    rows = [
        (
            f"{centre:.4g}",
            *(number(b[centre].level_db if centre in b else None, ".1f") for b in bands),
            *(number(b[centre].source_level_db if centre in b else None, ".1f") for b in bands),
        )
        for centre in centres
    ]
    if members:
        rows.append(
            (
                "all frequencies",
                *(number(member.mean_level_db, ".1f") for member in members),
                *(number(member.mean_source_level_db, ".1f") for member in members),
            )
        )
    return tuple(rows)


def _band_note(summary: Summary) -> str:
    """Say what the levels of the bands are."""
    kind = {"decidecade": "decidecades (base ten)", "third-octave": "third octaves (base two)"}
    note = (
        f"{kind.get(summary.far_field.band_kind, '')} that the frequencies cover; levels of the "
        "mean power in the band; L_W in dB re 1 pW, L_S in dB re 1 uPa m"
    )
    return of_signal(note, random=summary.sound_power.signal == RANDOM)


def _limit_rows(summary: Summary) -> Rows:
    """Each limit in each configuration."""
    words = {True: "EXCEEDED", False: "kept", None: "not touched"}
    units = {"sound-power": "sound power", "source-level": "source level"}
    return tuple(
        (
            words[limit.exceeded],
            limit.name,
            units[limit.quantity],
            limit.bands,
            limit.configuration,
            number(limit.worst_excess_db, "+.1f"),
            number(limit.worst_frequency_hz, ".5g"),
        )
        for limit in summary.limits
    )


def _members(summary: Summary) -> Iterator[tuple[str, ConfigurationSound]]:
    far = summary.far_field
    for name, member in (("C0", far.C0), ("C1", far.C1)):
        if member.mean_level_db is not None or member.peaks or member.given:
            yield name, member


def _patterns(summary: Summary) -> Iterator[tuple[tuple[str, str, str], PatternSummary]]:
    """Peaks and the frequencies asked for, with name, configuration and frequency."""
    for name, member in _members(summary):
        for pattern in (*member.peaks, *member.given):
            head = (pattern.mode or "peak") if pattern in member.peaks else "given"
            yield (head, name, number(pattern.frequency_hz, ".3f")), pattern


def _peak_row(pattern: PatternSummary) -> tuple[str, ...]:
    return (
        number(pattern.width_hz, ".2g"),
        number(pattern.level_db, ".1f"),
        number(pattern.source_level_db, ".1f"),
        number(pattern.efficiency, ".2e"),
    )


def _wave_row(pattern: PatternSummary) -> tuple[str, ...]:
    shares = (pattern.monopole, pattern.dipole, pattern.quadrupole, pattern.higher)
    return (
        *("-" if share is None else f"{100.0 * share:.1f} %" for share in shares),
        number(pattern.index_db, ".1f"),
        ", ".join(number(x, "z.2f") for x in pattern.loudest),
    )
