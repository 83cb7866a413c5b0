# SPDX-License-Identifier: LGPL-2.1-or-later
"""From a result to its headline figures."""

from collections.abc import Iterable

import numpy as np

from quietblade.card import Card, shortened
from quietblade.results.claims import judge_claims
from quietblade.results.excitation_headline import excitation_summaries, transfer_summary
from quietblade.results.far_headline import far_field_summary, limit_summaries
from quietblade.results.mode_records import CampbellDiagram
from quietblade.results.model import ConfigurationResult, Result, StaticResult, path, state
from quietblade.results.peaks import find_peaks
from quietblade.results.summary import (
    BalanceSummary,
    BranchSummary,
    CampbellSummary,
    CellSummary,
    ClaimSummary,
    CostSummary,
    CrossingSummary,
    FailureSummary,
    MeshSummary,
    ModesSummary,
    ModeSummary,
    ModulusSummary,
    PeakSharesSummary,
    PerformanceSummary,
    PowerPathsSummary,
    PowerSharesSummary,
    RunSummary,
    SoundPowerSummary,
    StateFigures,
    StaticSummary,
    StrengthSummary,
    Summary,
)
from quietblade.typing import FloatArray

NAN = float("nan")

_SAME_PEAK = 1e-3
"""Relative distance of frequencies that stand for one peak."""


def summarise(result: Result) -> Summary:
    """Headline figures of a result."""
    configurations, static = result.configurations, result.static
    spectra = [c.spectrum for c in configurations.values()]
    timings = result.run.timings
    seconds = dict(zip(timings.stage, timings.seconds.tolist(), strict=True))
    return Summary(
        title=result.title,
        blade=result.blade,
        static=None if static is None else _static(static),
        performance=None if static is None else _performance(static),
        strength=None if static is None else _strength(static),
        modes=ModesSummary(
            C0=_modes(configurations.get("C0")),
            C1=_modes(configurations.get("C1")),
            counted={name: c.mode_count.counted for name, c in configurations.items()},
            complete_below_hz=min(
                (c.mode_count.highest for c in configurations.values()), default=NAN
            ),
        ),
        campbell=_campbell(result.campbell),
        sound_power=_sound_power(result),
        far_field=far_field_summary(result),
        limits=tuple(limit_summaries(result)),
        power_paths=PowerPathsSummary(
            C0=_shares(configurations.get("C0")), C1=_shares(configurations.get("C1"))
        ),
        moduli=_moduli(result),
        excitations=excitation_summaries(result),
        transfer=transfer_summary(result),
        balance=BalanceSummary(
            max_relative_residual=_largest(s.balance_residual for s in spectra),
            max_solver_residual=_largest(s.solver_residual for s in spectra),
        ),
        mesh=_mesh(result),
        unknowns=int(result.mesh.unknowns.count.sum()),
        timings_s={**seconds, "total": sum(seconds.values())},
        cost=_cost(result),
        notices=tuple(str(notice) for notice in result.run.notices.notices()),
        claims=tuple(ClaimSummary(**vars(claim)) for claim in judge_claims(result)),
        run=_run(result),
    )


def result_card(result: Result) -> Card:
    """Headline figures in a few lines, for a prompt or a notebook."""
    rows = [] if result.static is None else _steady_rows(result.static)
    for name, found in result.configurations.items():
        unit = "dB re 1 pW/Hz" if found.random else "dB re 1 pW"
        named = zip(found.modes.name, found.modes.frequency, strict=True)
        modes = ", ".join(f"{mode} {frequency:.2f}" for mode, frequency in named)
        rows.append((f"{name}: wet modes", f"{modes} Hz"))
        peaks = found.peaks
        if len(peaks.frequency):
            loudest = int(np.argmax(peaks.power_level))
            level, at = peaks.power_level[loudest], peaks.frequency[loudest]
            rows.append((f"{name}: loudest peak", f"{level:.2f} {unit} at {at:.4g} Hz"))
        rows.append((f"{name}: mean over the band", f"{found.bands.mean_level:.2f} {unit}"))
    rows += [(f"notice: {n.where}", n.message) for n in result.run.notices.notices()]
    return Card(f"Result: {result.title or result.run.created}", shortened(rows))


def _steady_rows(static: StaticResult) -> list[tuple[str, str]]:
    rigid, coupled = (state(name) for name in ("rigid", "coupled"))
    along = ", ".join(f"{1e3 * u:.2f}" for u in static.tip_displacement)
    end = "converged" if static.converged else "NOT CONVERGED"
    return [
        ("tip displacement x, y, z", f"{along} mm ({end}, {static.coupling_kind})"),
        ("lift", f"{static.lift[coupled]:.5g} N; rigid blade {static.lift[rigid]:.5g} N"),
        ("largest shear strain of the film", f"{100.0 * static.max_film_shear_strain:.3f} %"),
    ]


def _static(static: StaticResult) -> StaticSummary:
    sections = static.sections
    rigid, chained, coupled = (state(name) for name in ("rigid", "chained", "coupled"))
    middle = np.argmin(np.abs(sections.span_fraction - static.mid_section.span_fraction))
    twist = sections.blade_angle[coupled, -1] - sections.blade_angle[rigid, -1]
    return StaticSummary(
        tip_displacement_m=tuple(static.tip_displacement.tolist()),
        max_film_shear_strain=static.max_film_shear_strain,
        film_shear_strain_p99=static.film_shear_strain_p99,
        max_film_shear_strain_place_m=tuple(static.max_film_shear_strain_place.tolist()),
        max_blade_shear_strain=static.max_blade_shear_strain,
        lift_n=float(static.lift[coupled]),
        lift_rigid_n=float(static.lift[rigid]),
        lift_chained_n=float(static.lift[chained]),
        thrust_n=float(static.thrust[coupled]),
        torque_nm=float(static.torque[coupled]),
        mid_camber=float(sections.camber[coupled, middle]),
        tip_blade_angle_deg=float(np.degrees(twist)),
        iterations=static.iterations,
        relative_change=float(static.history.relative_change[-1]),
        estimated_error=float(static.history.error[-1]),
        method=static.coupling_method,
        kind=static.coupling_kind,
        divergence_ratio=static.divergence_ratio,
        changes=tuple(static.history.relative_change.tolist()),
        converged=static.converged,
    )


def _strength(static: StaticResult) -> StrengthSummary:
    stress, failure, reaction = static.stress, static.failure, static.reaction

    def by_region(values: FloatArray) -> dict[str, float]:
        return dict(zip(stress.region, values.tolist(), strict=True))

    return StrengthSummary(
        von_mises_pa=by_region(stress.von_mises),
        von_mises_p99_pa=by_region(stress.von_mises_p99),
        logarithmic_strain=by_region(stress.logarithmic_strain),
        failure=tuple(
            FailureSummary(
                region=region,
                name=name,
                value=float(failure.value[i]),
                p99=float(failure.p99[i]),
                place_m=tuple(failure.place[i].tolist()),
            )
            for i, (region, name) in enumerate(zip(failure.region, failure.name, strict=True))
        ),
        root_force_n=tuple(reaction.force.tolist()),
        root_moment_nm=tuple(reaction.moment.tolist()),
        force_imbalance=reaction.force_imbalance,
    )


def _performance(static: StaticResult) -> PerformanceSummary:
    figures = static.performance

    def of(name: str) -> StateFigures:
        row = state(name)
        return StateFigures(
            advance_ratio=float(figures.advance_ratio[row]),
            thrust_n=float(figures.thrust[row]),
            torque_nm=float(figures.torque[row]),
            thrust_coefficient=float(figures.thrust_coefficient[row]),
            torque_coefficient=float(figures.torque_coefficient[row]),
            efficiency=float(figures.efficiency[row]),
            inviscid_efficiency=float(figures.inviscid_efficiency[row]),
        )

    return PerformanceSummary(
        inflow=figures.inflow,
        friction=figures.friction,
        blades=figures.blades,
        rigid=of("rigid"),
        chained=of("chained"),
        coupled=of("coupled"),
        inception_depth_m=figures.inception_depth,
        inception_speed_m_s=figures.inception_speed,
    )


def _modes(configuration: ConfigurationResult | None) -> tuple[ModeSummary, ...]:
    if configuration is None:
        return ()
    modes, peaks = configuration.modes, find_peaks(configuration)
    losses, dry = configuration.loss_shares, configuration.dry_modes
    return tuple(
        ModeSummary(
            name=name,
            frequency_hz=float(modes.frequency[i]),
            loss_factor=float(modes.loss_factor[i]),
            purity=float(modes.purity[i]),
            partner=modes.partner[i],
            partner_mac=float(modes.partner_mac[i]),
            kind=configuration.mode_count.character[i],
            loss_by_part=dict(zip(losses.name, losses.share[i].tolist(), strict=True)),
            dry_frequency_hz=(
                float(dry.frequency[dry.partner.index(name)]) if name in dry.partner else None
            ),
            peak_share=_share(configuration, i, peaks[name].frequency) if name in peaks else None,
            peak_frequency_hz=peaks[name].frequency if name in peaks else None,
            peak_level_db=peaks[name].level if name in peaks else None,
            peak_width_hz=peaks[name].width if name in peaks else None,
        )
        for i, name in enumerate(modes.name)
    )


def _share(configuration: ConfigurationResult, mode: int, frequency: float) -> float | None:
    """Share of a mode in the response nearest to a frequency, if it was split there."""
    at = configuration.participation
    near = np.flatnonzero(np.abs(at.frequency / frequency - 1.0) < _SAME_PEAK)
    return float(at.share[near[0], mode]) if near.size else None


def _campbell(diagram: CampbellDiagram) -> CampbellSummary:
    crossings = zip(
        diagram.crossing_mode, diagram.crossing_order.tolist(),
        diagram.crossing_rotation.tolist(), diagram.crossing_frequency.tolist(), strict=True,
    )  # fmt: skip
    return CampbellSummary(
        advance=diagram.advance,
        blades=diagram.blades,
        rotation_rad_s=tuple(diagram.rotation.tolist()),
        advance_speed_m_s=tuple(diagram.advance_speed.tolist()),
        branches=tuple(
            BranchSummary(name=name, frequency_hz=tuple(row.tolist()))
            for name, row in zip(diagram.name, diagram.frequency, strict=True)
        ),
        crossings=tuple(
            CrossingSummary(mode=mode, order=order, rotation_rad_s=speed, frequency_hz=frequency)
            for mode, order, speed, frequency in crossings
        ),
    )


def _shares(configuration: ConfigurationResult | None) -> PowerSharesSummary:
    if configuration is None:
        return PowerSharesSummary(mean={}, peaks=())
    paths = configuration.dissipation

    def named(shares: FloatArray) -> dict[str, float]:
        return dict(zip(paths.sink, shares.tolist(), strict=True))

    return PowerSharesSummary(
        mean=named(paths.mean_share),
        peaks=tuple(
            PeakSharesSummary(frequency_hz=float(frequency), share=named(shares))
            for frequency, shares in zip(paths.peak_frequency, paths.peak_share.T, strict=True)
        ),
    )


def _moduli(result: Result) -> tuple[ModulusSummary, ...]:
    table = result.moduli
    return tuple(
        ModulusSummary(
            name=name,
            model=table.model[i],
            temperature_k=float(table.temperature[i]),
            storage_ratio=tuple(table.band_ratio[i].real.tolist()),
            loss_factor=tuple((table.band_ratio[i].imag / table.band_ratio[i].real).tolist()),
            fit_error=float(table.fit_error[i]),
        )
        for i, name in enumerate(table.name)
    )


def _sound_power(result: Result) -> SoundPowerSummary:
    members = list(result.configurations.values())
    levels = {
        name: tuple(c.spectrum.power_level[path("sphere")].tolist())
        for name, c in result.configurations.items()
    }
    means = {name: c.bands.mean_level for name, c in result.configurations.items()}
    return SoundPowerSummary(
        frequency_hz=tuple(members[0].spectrum.frequency.tolist()) if members else (),
        C0_db=levels.get("C0", ()),
        C1_db=levels.get("C1", ()),
        signal=members[0].excitations.signal if members else "",
        level_reference=members[0].excitations.level_reference if members else "",
        radiation_condition=members[0].radiation_condition if members else "",
        outer_radius_m=members[0].outer_radius if members else None,
        kr_min=float(members[0].kr[0]) if members else None,
        sweep=members[0].sweep.method if members else "",
        largest_estimate_db=_largest(
            np.array([member.sweep.largest_estimate]) for member in members
        ),
        C0_mean_db=means.get("C0"),
        C1_mean_db=means.get("C1"),
        kr_max=float(members[0].kr[-1]) if members else None,
        max_surface_difference_db=_difference(members, "wet_surface"),
        max_multipole_difference_db=_difference(members, "multipoles"),
    )


def _difference(members: list[ConfigurationResult], other: str) -> float:
    levels = [c.spectrum.power_level for c in members]
    return _largest(np.abs(level[path("sphere")] - level[path(other)]) for level in levels)


def _mesh(result: Result) -> MeshSummary:
    mesh = result.mesh
    cells = zip(mesh.cells.region, mesh.cells.kind, mesh.cells.count.tolist(), strict=True)
    return MeshSummary(
        nodes=mesh.nodes,
        cells=tuple(CellSummary(region=r, kind=k, count=n) for r, k, n in cells),
        worst_quality=dict(zip(mesh.quality.region, mesh.quality.worst.tolist(), strict=True)),
        unknowns_by_part=dict(zip(mesh.unknowns.part, mesh.unknowns.count.tolist(), strict=True)),
    )


def _cost(result: Result) -> CostSummary:
    cost = result.run.cost
    return CostSummary(
        factorization_s=cost.factorization,
        memory_b=dict(zip(cost.stage, cost.memory.tolist(), strict=True)),
        kept=tuple(np.array(cost.stage)[cost.kept].tolist()),
    )


def _run(result: Result) -> RunSummary:
    run = result.run
    return RunSummary(
        created=run.created,
        platform=run.platform,
        threads=run.threads,
        code_version=run.code_version,
        content_key=run.content_key,
        packages=dict(zip(run.packages.name, run.packages.version, strict=True)),
        solvers=tuple(dict.fromkeys(run.solvers.solver)),
        fallbacks=run.fallbacks.event,
    )


def _largest(arrays: Iterable[FloatArray]) -> float:
    """Largest finite value of all arrays, NaN if there is none."""
    values = np.concatenate([np.empty(0), *arrays])
    values = values[np.isfinite(values)]
    return float(values.max()) if values.size else NAN
