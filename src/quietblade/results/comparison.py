# SPDX-License-Identifier: LGPL-2.1-or-later
"""Differences between the headline figures of two runs."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations

from quietblade.errors import Notice
from quietblade.results.summary import ModeSummary, Summary
from quietblade.results.table import Table, number

_EXCHANGED = 0.25  # of the change by name, below which modes are rather taken as exchanged


@dataclass(frozen=True)
class Difference:
    """One figure of two runs.

    Attributes
    ----------
    name, unit : str
        What is compared; unit "1" is a ratio, and "dB re 1 pW" a level.
    first, second : float or None
        The values; None where a run does not have it.
    """

    name: str
    unit: str
    first: float | None
    second: float | None

    @property
    def change(self) -> float | None:
        """Second minus first."""
        if self.first is None or self.second is None:
            return None
        return self.second - self.first

    @property
    def relative(self) -> float | None:
        """Change over the first value; levels have none."""
        if self.change is None or not self.first or self.unit.startswith("dB"):
            return None
        return self.change / abs(self.first)


def compare_summaries(first: Summary, second: Summary) -> tuple[Difference, ...]:
    """Differences of displacement, lift, shear strain, and of frequencies and peaks by mode name.

    Parameters
    ----------
    first, second : Summary
        Headline figures of the two runs.

    Returns
    -------
    tuple of Difference
        Modes that only one run has are there with None for the other.
    """
    return (*_static(first, second), *_modes("C0", first, second), *_modes("C1", first, second))


def exchanged_names(first: Summary, second: Summary) -> tuple[Notice, ...]:
    """Notice pairs of modes of which each is all but where the other was.

    Modes that mix bending and torsion may be named the other way round after a small change, and
    a comparison by name then shows large differences that are none.
    """
    return tuple(n for c in ("C0", "C1") for n in _exchanged(c, first, second))


def comparison_table(differences: tuple[Difference, ...], names: tuple[str, str]) -> Table:
    """Table of differences; ``names`` head the two columns of values."""
    rows = tuple(
        (
            d.name,
            number(d.first, ".5g"),
            number(d.second, ".5g"),
            number(d.change, "+.3g"),
            number(None if d.relative is None else 100.0 * d.relative, "+.2f"),
            "" if d.unit == "1" else d.unit,
        )
        for d in differences
    )
    return Table("Differences", ("", *names, "change", "%", "unit"), rows)


def _static(first: Summary, second: Summary) -> Iterator[Difference]:
    a, b = first.static, second.static
    if a is None or b is None:
        return
    for axis, u, v in zip("xyz", a.tip_displacement_m, b.tip_displacement_m, strict=True):
        yield Difference(f"tip displacement {axis}", "m", u, v)
    yield Difference("blade angle at the tip", "deg", a.tip_blade_angle_deg, b.tip_blade_angle_deg)
    yield Difference("camber of the mid section", "1", a.mid_camber, b.mid_camber)
    yield Difference("lift", "N", a.lift_n, b.lift_n)
    yield Difference("lift, rigid", "N", a.lift_rigid_n, b.lift_rigid_n)
    yield Difference("thrust", "N", a.thrust_n, b.thrust_n)
    yield Difference("torque", "N m", a.torque_nm, b.torque_nm)
    yield Difference(
        "largest film shear strain", "1", a.max_film_shear_strain, b.max_film_shear_strain
    )


def _modes(configuration: str, first: Summary, second: Summary) -> Iterator[Difference]:
    a, b = _by_name(configuration, first), _by_name(configuration, second)
    references = [s.sound_power.level_reference for s in (first, second)]
    unit = f"dB re {references[0]}"
    alike = len(set(references)) == 1  # powers and their densities cannot be compared
    for name in dict.fromkeys((*a, *b)):
        left, right = a.get(name), b.get(name)
        yield _difference(f"{configuration} {name} frequency", "Hz", left, right, "frequency_hz")
        yield _difference(f"{configuration} {name} loss factor", "1", left, right, "loss_factor")
        peak = _difference(f"{configuration} {name} peak level", unit, left, right, "peak_level_db")
        if alike and (peak.first is not None or peak.second is not None):
            yield peak


def _by_name(configuration: str, summary: Summary) -> dict[str, ModeSummary]:
    # rigid motions have the frequency zero, up to rounding
    return {m.name: m for m in getattr(summary.modes, configuration) if m.kind != "rigid"}


def _exchanged(configuration: str, first: Summary, second: Summary) -> Iterator[Notice]:
    a, b = (
        {n: m.frequency_hz for n, m in _by_name(configuration, summary).items() if m.frequency_hz}
        for summary in (first, second)
    )
    for one, other in combinations([name for name in a if name in b], 2):
        by_name = abs(a[one] - b[one]) + abs(a[other] - b[other])
        crossed = abs(a[one] - b[other]) + abs(a[other] - b[one])
        if crossed < _EXCHANGED * by_name:
            yield Notice(
                f"modes {configuration}",
                f"{one} and {other} seem to have exchanged their names: {a[one]:.5g} and "
                f"{a[other]:.5g} Hz here, {b[one]:.5g} and {b[other]:.5g} Hz there",
                remedy="Compare these two crosswise, after a look at their shapes",
            )


def _difference(
    name: str, unit: str, left: ModeSummary | None, right: ModeSummary | None, field: str
) -> Difference:
    first, second = (getattr(mode, field) if mode else None for mode in (left, right))
    return Difference(name, unit, first, second)
