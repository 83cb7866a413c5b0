# SPDX-License-Identifier: LGPL-2.1-or-later
"""The headline figures as small tables, for the screen, for ``summary.txt`` and for the report."""

from collections.abc import Iterable, Iterator, Mapping

from quietblade.results.excitation_tables import excitation_table, transfer_table
from quietblade.results.far_tables import far_field_tables
from quietblade.results.summary import (
    ModeSummary,
    PerformanceSummary,
    StaticSummary,
    StrengthSummary,
    Summary,
)
from quietblade.results.table import Table, number


def summary_tables(summary: Summary) -> tuple[Table, ...]:
    """Headline tables in the order in which people ask."""
    tables = [
        *_steady(summary),
        _modes(summary),
        *far_field_tables(summary),
        _kinds(summary),
        _campbell(summary),
        _crossings(summary),
        _power_paths(summary),
        _moduli(summary),
        excitation_table(summary),
        transfer_table(summary),
        _claims(summary),
        _checks(summary),
        _time(summary),
        _run(summary),
    ]
    if summary.notices:
        rows = tuple((notice,) for notice in summary.notices)
        tables.append(Table("Warnings", (), rows))
    return tuple(table for table in tables if table.rows)


def as_text(title: str, tables: Iterable[Table]) -> str:
    """Plain text with aligned columns."""
    parts = [title, "=" * len(title)]
    for table in tables:
        parts += ["", table.title, "-" * len(table.title), *_lines(table)]
        if table.note:
            parts.append(f"({table.note})")
    return "\n".join(parts) + "\n"


def verdict(agrees: bool | None) -> str:
    """Say whether a claim agrees."""
    return {True: "agrees", False: "DIFFERS", None: "not judged"}[agrees]


def _steady(summary: Summary) -> Iterator[Table]:
    """Step 1, which only blades have."""
    if summary.static is not None:
        yield _static(summary.static)
    if summary.performance is not None:
        yield _performance(summary.performance)
    if summary.strength is not None:
        yield _strength(summary.strength)


def _static(static: StaticSummary) -> Table:
    along = ", ".join(number(_times(1e3, u), "z.1f") for u in static.tip_displacement_m)
    place = ", ".join(number(u, ".3f") for u in static.max_film_shear_strain_place_m)
    gain = _change(static.lift_n, static.lift_rigid_n)
    state = "converged" if static.converged else "NOT CONVERGED"
    change = number(static.relative_change, ".1e")
    return Table(
        "Steady load",
        (),
        (
            ("Tip displacement x, y, z", f"{along} mm"),
            ("Blade angle at the tip, change", f"{number(static.tip_blade_angle_deg, '+.3f')} deg"),
            ("Camber of the mid section", f"{number(_times(100, static.mid_camber), '+.3f')} %"),
            ("Lift", f"{number(static.lift_n, '.1f')} N ({gain} against the rigid blade)"),
            ("Lift, rigid and chained",
             f"{number(static.lift_rigid_n, '.1f')} and {number(static.lift_chained_n, '.1f')} N"),
            ("Thrust, torque of one blade",
             f"{number(static.thrust_n, '.2f')} N, {number(static.torque_nm, '.2f')} N m"),
            ("Largest film shear strain",
             f"{number(_times(100, static.max_film_shear_strain), '.2f')} %; 99 % of the film "
             f"below {number(_times(100, static.film_shear_strain_p99), '.2f')} %"),
            ("  at x, y, z", f"{place} m"),
            ("Coupling",
             f"{state}, {static.method}, {static.iterations} iterations, last change {change}, "
             f"estimated error {number(static.estimated_error, '.1e')}; {static.kind}"),
            ("  static divergence",
             "none in sight" if static.divergence_ratio is None
             else f"at {number(static.divergence_ratio, '.3g')} times the dynamic pressure"),
            ("  change by pass", ", ".join(number(c, ".1e") for c in static.changes)),
        ),
    )  # fmt: skip


def _performance(figures: PerformanceSummary) -> Table:
    states = (figures.rigid, figures.chained, figures.coupled)
    rows = [
        (name, *(number(getattr(state, key), form) for state in states), definition)
        for name, key, form, definition in (
            ("Thrust T [N]", "thrust_n", ".2f", "all blades, with friction"),
            ("Torque Q [N m]", "torque_nm", ".2f", "all blades, with friction"),
            ("Advance ratio J", "advance_ratio", ".4g", "V_A / (n D)"),
            ("K_T", "thrust_coefficient", ".4g", "T / (rho n^2 D^4)"),
            ("K_Q", "torque_coefficient", ".4g", "Q / (rho n^2 D^5)"),
            ("Efficiency", "efficiency", ".4f", "T V_A / (Q omega)"),
            ("  without friction", "inviscid_efficiency", ".4f", ""),
        )
        if any(getattr(state, key) is not None for state in states)  # nothing turns: no efficiency
    ]
    note = (
        f"{figures.blades} blade{'s' if figures.blades > 1 else ''}, inflow {figures.inflow}, "
        f"friction {figures.friction}; cavitation begins at a depth of the axis of "
        f"{number(figures.inception_depth_m, '.2f')} m, or at "
        f"{number(figures.inception_speed_m_s, '.2f')} m/s of ship speed"
    )
    heads = ("Rotor", "rigid", "chained", "coupled", "Definition")
    return Table("Performance", heads, tuple(rows), note)


def _strength(strength: StrengthSummary) -> Table:
    rows = [
        (f"Von Mises stress, {region}",
         f"{number(_times(1e-6, value))} MPa; 99 % of the volume below "
         f"{number(_times(1e-6, strength.von_mises_p99_pa[region]))} MPa")
        for region, value in strength.von_mises_pa.items()
    ]  # fmt: skip
    rows += [
        (f"Largest strain, {region}", f"{number(_times(100, value), '.3f')} % (logarithmic)")
        for region, value in strength.logarithmic_strain.items()
    ]
    for index in strength.failure:
        place = ", ".join(number(u, ".3f") for u in index.place_m)
        rows.append(
            (f"Failure index {index.name.replace('_', ' ')}, {index.region}",
             f"{number(index.value, '.3f')} at {place} m; 99 % below {number(index.p99, '.3f')}")
        )  # fmt: skip
    if not strength.failure:
        rows.append(("Failure index", "not computed: no strengths are given for the materials"))
    force = ", ".join(number(f, "z.1f") for f in strength.root_force_n)
    moment = ", ".join(number(f, "z.1f") for f in strength.root_moment_nm)
    rows.append(("Root force, moment x, y, z", f"{force} N; {moment} N m"))
    return Table("Strength", (), tuple(rows))


def _modes(summary: Summary) -> Table:
    loaded = {mode.name: mode for mode in summary.modes.C1}
    rows = [_mode_row(rest, loaded.pop(rest.partner, None)) for rest in summary.modes.C0]
    rows += [_mode_row(None, mode) for mode in loaded.values()]
    sound = summary.sound_power
    levels = {"C0": sound.C0_mean_db, "C1": sound.C1_mean_db}
    means = [f"{name} {mean:.1f}" for name, mean in levels.items() if mean is not None]
    note = ""
    if sound.radiation_condition:
        note = (
            f"levels of the peaks in dB re {sound.level_reference} through the sphere; "
            f"{sound.radiation_condition}, "
            f"R = {number(sound.outer_radius_m)} m, "
            f"kR = {number(sound.kr_min, '.2f')} to {number(sound.kr_max, '.2f')}; level of the "
            f"mean power over the band {', '.join(means)}"
        )
    heads = ("Mode", "C0 [Hz]", "C1 [Hz]", "shift", "loss C0", "loss C1", "MAC",
             "C0 [dB]", "C1 [dB]")  # fmt: skip
    table = Table("Wet modes and peaks of the sound power", heads, tuple(rows), note)
    return table if len(means) > 1 else table.without_empty_columns()


def _mode_row(rest: ModeSummary | None, loaded: ModeSummary | None) -> tuple[str, ...]:
    names = [mode.name for mode in (rest, loaded) if mode]
    before, after = (m.frequency_hz if m else None for m in (rest, loaded))
    return (
        " / ".join(dict.fromkeys(names)),
        number(before, "z.2f"),
        number(after, "z.2f"),
        _change(after, before),
        *(number(m.loss_factor if m else None, ".2e") for m in (rest, loaded)),
        number(rest.partner_mac if rest and loaded else None, ".3f"),
        *(number(m.peak_level_db if m else None, ".1f") for m in (rest, loaded)),
    )


def _kinds(summary: Summary) -> Table:
    """Kind of each mode, and where its energy goes."""
    members = [("C0", mode) for mode in summary.modes.C0]
    members += [("C1", mode) for mode in summary.modes.C1]
    parts = list(dict.fromkeys(part for _, mode in members for part in mode.loss_by_part))
    dry = any(mode.dry_frequency_hz is not None for _, mode in members)
    heads = ["", "Mode", "kind", "purity", "wet [Hz]", *(["dry [Hz]"] if dry else []),
             "loss factor", *(f"by {part}" for part in parts), "share of peak"]  # fmt: skip
    rows = [
        (
            where,
            mode.name,
            mode.kind,
            number(mode.purity, ".2f"),
            number(mode.frequency_hz, "z.2f"),
            *([number(mode.dry_frequency_hz, ".2f")] if dry else []),
            number(mode.loss_factor, ".2e"),
            *(number(mode.loss_by_part.get(part), ".1e") for part in parts),
            number(mode.peak_share, ".3f"),
        )
        for where, mode in members
    ]
    note = (
        "purity: share of the kinetic energy in the family of the name, mixed below 0.6; share of "
        "peak: that of the mode in the response at its own peak"
    )
    return Table("Kind and loss of the wet modes", tuple(heads), tuple(rows), note)


def _campbell(summary: Summary) -> Table:
    diagram = summary.campbell
    heads = ("Mode [Hz]", *(f"{number(w)} rad/s" for w in diagram.rotation_rad_s))
    speeds = ("advance [m/s]", *(number(v) for v in diagram.advance_speed_m_s))
    rows = [
        (branch.name, *(number(f, ".2f") for f in branch.frequency_hz))
        for branch in diagram.branches
    ]
    note = f"wet modes under load over the speed of the shaft; speed of advance {diagram.advance}"
    return Table("Campbell diagram", heads, (speeds, *rows) if rows else (), note)


def _crossings(summary: Summary) -> Table:
    diagram = summary.campbell
    rows = tuple(
        (
            crossing.mode,
            f"{crossing.order} x {diagram.blades}",
            f"{number(crossing.rotation_rad_s)} rad/s",
            f"{number(crossing.frequency_hz, '.2f')} Hz",
        )
        for crossing in diagram.crossings
    )
    if diagram.branches and not rows:
        rows = (("none", "", "", ""),)
    heads = ("Mode", "order x blades", "shaft", "frequency")
    return Table("Crossings of modes and blade rate", heads, rows)


def _power_paths(summary: Summary) -> Table:
    paths = {"C0": summary.power_paths.C0, "C1": summary.power_paths.C1}
    sinks = tuple(dict.fromkeys(sink for shares in paths.values() for sink in shares.mean))
    rows = []
    for name, shares in paths.items():
        if shares.mean:
            rows.append((f"{name}, mean over the band", *_percents(shares.mean, sinks)))
        rows += [
            (f"{name}, peak at {number(peak.frequency_hz, '.2f')} Hz",
             *_percents(peak.share, sinks))
            for peak in shares.peaks
        ]  # fmt: skip
    note = "shares of the injected power, in per cent; water: radiated through the sphere"
    return Table("Where the power goes", ("", *sinks), tuple(rows), note)


def _percents(shares: Mapping[str, float | None], sinks: Iterable[str]) -> Iterator[str]:
    return (number(_times(100.0, shares.get(sink)), ".3g") for sink in sinks)


def _moduli(summary: Summary) -> Table:
    rows = tuple(
        (
            modulus.name,
            modulus.model,
            "-" if modulus.temperature_k is None else f"{modulus.temperature_k - 273.15:.1f} degC",
            " to ".join(number(value, ".3g") for value in modulus.storage_ratio),
            " to ".join(number(value, ".3g") for value in modulus.loss_factor),
            number(_times(100.0, modulus.fit_error), ".2g"),
        )
        for modulus in summary.moduli
    )
    heads = ("Modulus", "Model", "Temperature", "Storage / static", "Loss factor", "Fit error [%]")
    note = "from the low to the high end of the band; static: that of the steady load"
    return Table("Complex moduli", heads, rows, note)


def _claims(summary: Summary) -> Table:
    rows = tuple(
        (verdict(claim.agrees), claim.statement, claim.paper, claim.computed, claim.criterion)
        for claim in summary.claims
    )
    judged = [claim for claim in summary.claims if claim.agrees is not None]
    met = sum(bool(claim.agrees) for claim in judged)
    note = f"{met} of {len(judged)} claims agree by quietblade's own criteria"
    heads = ("", "Claim", "Paper", "Computed", "Agrees if")
    return Table("The paper's claims", heads, rows, note)


def _checks(summary: Summary) -> Table:
    sound, balance = summary.sound_power, summary.balance
    return Table(
        "How far to trust it",
        (),
        (
            ("Energy balance, worst", number(balance.max_relative_residual, ".1e")),
            ("Modes, Sturm's count", _count(summary)),
            _sweep_check(summary),
            ("Sphere against wetted surface",
             f"{number(sound.max_surface_difference_db, '.2g')} dB"),
            ("Sphere against multipoles",
             f"{number(sound.max_multipole_difference_db, '.2g')} dB"),
            ("Worst cell quality",
             ", ".join(f"{r} {number(q, '.3f')}" for r, q in summary.mesh.worst_quality.items())),
        ),
    )  # fmt: skip


def _count(summary: Summary) -> str:
    counted = ", ".join(f"{name} {count}" for name, count in summary.modes.counted.items())
    below = number(summary.modes.complete_below_hz)
    return f"{counted} below {below} Hz; all found, none missing" if counted else "-"


def _sweep_check(summary: Summary) -> tuple[str, str]:
    if summary.sound_power.sweep == "reduced":
        error = number(summary.sound_power.largest_estimate_db, ".1e")
        return "Reduced sweep, largest estimated error", f"{error} dB"
    return "Linear solves, worst residual", number(summary.balance.max_solver_residual, ".1e")


def _time(summary: Summary) -> Table:
    """Stages beside one factorisation of the coupled matrix, the unit of all direct methods."""
    cost = summary.cost
    rows = [
        (
            name,
            number(seconds, ".1f"),
            number(seconds / cost.factorization_s if cost.factorization_s else None, ".1f"),
            number(_times(1e-9, cost.memory_b.get(name)), ".2f"),
            "kept from an earlier run" if name in cost.kept else "",
        )
        for name, seconds in summary.timings_s.items()
    ]
    note = (
        f"one factorisation of the coupled matrix takes {number(cost.factorization_s, '.2f')} s, "
        "its analysis included; memory is the process's largest until the end of the stage"
    )
    heads = ("Stage", "Time [s]", "in factorisations", "memory [GB]", "")
    return Table("Time", heads, tuple(rows), note)


def _run(summary: Summary) -> Table:
    cells = ", ".join(f"{c.region} {c.count} {c.kind}" for c in summary.mesh.cells)
    rows = [
        ("Mesh", f"{summary.mesh.nodes} nodes; {cells}"),
        ("Unknowns", str(summary.unknowns)),
        ("Solvers", "; ".join(summary.run.solvers)),
        *(("Change of solver", text) for text in _condensed(summary.run.fallbacks)),
        ("Version", f"quietblade {summary.run.code_version} on {summary.run.platform}"),
    ]
    return Table("Run", (), tuple(rows))


def _condensed(events: Iterable[str]) -> list[str]:
    """Events that differ only in what follows the last colon, counted."""
    reasons: dict[str, list[str]] = {}
    for event in events:
        head, _, reason = event.rpartition(": ")
        reasons.setdefault(head, []).append(reason)
    return [
        f"{head}: {found[0]}" + (f" (first of {len(found)} times)" if len(found) > 1 else "")
        for head, found in reasons.items()
    ]


def _times(factor: float, value: float | None) -> float | None:
    return None if value is None else factor * value


def _change(value: float | None, base: float | None) -> str:
    if value is None or not base:
        return "-"
    return f"{100.0 * (value / base - 1.0):+.2f} %"


def _lines(table: Table) -> list[str]:
    rows = [table.columns, *table.rows] if table.columns else list(table.rows)
    columns = list(zip(*rows, strict=True))
    widths = [max(map(len, column)) for column in columns]
    lines = ["  ".join(map(str.ljust, row, widths)).rstrip() for row in rows]
    if table.columns:
        lines.insert(1, "  ".join("-" * width for width in widths))
    return lines
