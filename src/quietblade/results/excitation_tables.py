# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tables of the loads and of the transfer functions."""

from quietblade.results.summary import Summary, TransferFigures
from quietblade.results.table import Table, number


def excitation_table(summary: Summary) -> Table:
    """List the loads with the mean sound power of each."""
    sound = summary.sound_power
    rows = tuple(
        (
            load.name,
            load.kind,
            f"{number(load.amplitude)} {load.unit}",
            number(load.C0_mean_db, ".1f"),
            number(load.C1_mean_db, ".1f"),
        )
        for load in summary.excitations
    )
    note = (
        f"{sound.signal}; the largest amplitude in the band; levels of the mean power over the "
        f"band of each load alone, dB re {sound.level_reference}"
    )
    heads = ("Load", "kind", "amplitude", "C0 [dB]", "C1 [dB]")
    return Table("Excitation", heads, rows, note).without_empty_columns()


def transfer_table(summary: Summary) -> Table:
    """List the largest values of the transfer functions over the band."""
    transfer, reference = summary.transfer, summary.sound_power.level_reference
    figures = (transfer.C0, transfer.C1)
    names = [load.name for load in summary.excitations]
    rows: list[tuple[str, ...]] = []
    if "mobility" in transfer.functions:
        rows += [
            (f"Mobility, {name} [m/(s N)]", *(_of(f, "largest_mobility", name) for f in figures))
            for name in names
        ]
    if "power-per-force" in transfer.functions:
        rows += [
            (f"Sound per force, {name} [W/N^2]",
             *(_of(f, "largest_power_per_force", name) for f in figures))
            for name in names
        ]  # fmt: skip
    if "blocked-force" in transfer.functions or "shaft" in transfer.functions:
        root = "/sqrt(Hz)" if summary.sound_power.signal == "random" else ""
        rows += [
            (f"Force on the root [N{root}]", *(_of(f, "largest_root_force_n") for f in figures)),
            (f"Moment on the root [N m{root}]",
             *(_of(f, "largest_root_moment_nm") for f in figures)),
        ]  # fmt: skip
    if "shaft" in transfer.functions:
        means = (number(f.mean_shaft_db, ".1f") for f in figures)
        rows.append((f"Mean power into the shaft [dB re {reference}]", *means))
    heads = ("Largest in the band", "C0", "C1")
    return Table("Transfer functions", heads, tuple(rows)).without_empty_columns()


def _of(figures: TransferFigures, key: str, name: str = "") -> str:
    value = getattr(figures, key)
    return number(value.get(name) if name else value, ".3e")
