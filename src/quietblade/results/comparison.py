# SPDX-License-Identifier: LGPL-2.1-or-later
"""Differences between the headline figures of two runs."""

from collections.abc import Iterator
from dataclasses import dataclass

from quietblade.results.summary import ModeSummary, Summary
from quietblade.results.table import Table, number


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
    a, b = (
        # rigid motions have the frequency zero, up to rounding
        {m.name: m for m in getattr(s.modes, configuration) if m.kind != "rigid"}
        for s in (first, second)
    )
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


def _difference(
    name: str, unit: str, left: ModeSummary | None, right: ModeSummary | None, field: str
) -> Difference:
    first, second = (getattr(mode, field) if mode else None for mode in (left, right))
    return Difference(name, unit, first, second)
