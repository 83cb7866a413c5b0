# SPDX-License-Identifier: LGPL-2.1-or-later
"""From the artefacts of a run to its registered result."""

import platform
from collections.abc import Iterable, Mapping
from dataclasses import replace
from datetime import UTC, datetime
from importlib.metadata import version

import numpy as np

from quietblade import __version__
from quietblade.case import AnyCase, Case
from quietblade.errors import Notice
from quietblade.flow import (
    cavitation_number,
    inception_depth,
    inception_ship_speed,
    performance,
)
from quietblade.flow.cavitation import suction
from quietblade.flow.inflow import BladeFlow
from quietblade.flow.sections import DeformedSections
from quietblade.linalg import SolverReport as LinearReport
from quietblade.linalg import default_threads
from quietblade.mesh import Mesh
from quietblade.propulsion.coupling import StaticState
from quietblade.propulsion.loads_assembly import AppliedLoads
from quietblade.propulsion.stress import StressReport
from quietblade.results import model
from quietblade.study import far_outcome
from quietblade.study.dissipation import dissipation
from quietblade.study.excitation_outcome import (
    excitation_table,
    first_area,
    first_pressure,
    outgoing_by_degree,
    transfer_table,
)
from quietblade.study.keeping import Lap
from quietblade.study.mode_tables import ModeTables
from quietblade.study.sound import Sound
from quietblade.study.stages import PACKAGES
from quietblade.study.statics import Statics
from quietblade.study.transfer import drive_point_mobility
from quietblade.study.translate import environment
from quietblade.study.translate import inflow as inflow_of
from quietblade.study.vibration import Vibration
from quietblade.study.viscous import ViscousFlow
from quietblade.typing import FloatArray
from quietblade.vibroacoustics.power import level


def static_result(case: Case, statics: Statics) -> model.StaticResult:
    """Tables and figures of step 1."""
    state = statics.state
    flows = tuple(viscous.flow for viscous in statics.viscous)
    total = [flow.total for flow in flows]
    result = model.StaticResult(
        history=_history(state),
        newton=_newton(state),
        sections=_section_curves(case, statics.viscous),
        performance=_performance(case, statics.viscous),
        stress=_stress(statics.stress),
        failure=_failure(statics.stress),
        reaction=_reaction(statics),
        loads=_loads(statics.loads),
        mid_section=_mid_section(flows),
        tip_displacement=state.tip_displacement,
        force=np.array([t.force for t in total]),
        moment=np.array([t.moment for t in total]),
        lift=np.array([t.lift for t in total]),
        thrust=np.array([t.thrust for t in total]),
        torque=np.array([t.torque for t in total]),
        tolerance=state.tolerance,
        converged=state.converged,
        coupling_method=state.method,
        coupling_kind=state.kind,
        load_fraction=state.fraction,
        divergence_ratio=state.divergence if np.isfinite(state.divergence) else np.nan,
        max_blade_shear_strain=statics.blade_shear,
    )
    if state.chained_flow is None:
        result = model.without_state(result, "chained")
    shear = statics.shear
    if shear is None:
        return result
    return replace(
        result,
        max_film_shear_strain=shear.maximum,
        film_shear_strain_p99=shear.percentile(99.0),
        max_film_shear_strain_place=shear.place,
    )


def _stress(report: StressReport) -> model.StressTable:
    regions = list(report.regions.values())
    peaks = [region.peaks for region in regions]
    return model.StressTable(
        region=tuple(region.region for region in regions),
        von_mises=np.array([p["von_mises"].value for p in peaks]),
        von_mises_p99=np.array([p["von_mises"].percentile for p in peaks]),
        von_mises_place=np.array([p["von_mises"].place for p in peaks]),
        principal_stress=np.array([p["principal_stress"].value for p in peaks]),
        logarithmic_strain=np.array([p["logarithmic_strain"].value for p in peaks]),
    )


def _failure(report: StressReport) -> model.FailureTable:
    rows = [
        (region.region, name, region.peaks[name])
        for region in report.regions.values()
        for name in region.failure_at_points
    ]
    return model.FailureTable(
        region=tuple(region for region, _, _ in rows),
        name=tuple(name for _, name, _ in rows),
        value=np.array([peak.value for _, _, peak in rows], dtype=float),
        p99=np.array([peak.percentile for _, _, peak in rows], dtype=float),
        place=np.array([peak.place for _, _, peak in rows], dtype=float).reshape(-1, 3),
    )


def _reaction(statics: Statics) -> model.ReactionResult:
    reaction, total = statics.stress.reaction, statics.state.coupled.total
    surface = statics.state.surface
    return model.ReactionResult(
        force=reaction.force,
        moment=reaction.moment,
        force_imbalance=reaction.force_imbalance,
        moment_imbalance=reaction.moment_imbalance,
        transferred_force_error=_relative(surface.force_error, total.force),
        transferred_moment_error=_relative(surface.moment_error, total.moment),
    )


def _relative(error: FloatArray, whole: FloatArray) -> float:
    size = float(np.linalg.norm(whole))
    return float(np.linalg.norm(error)) / size if size > 0.0 else float("nan")


def _loads(loads: AppliedLoads | None) -> model.LoadTable:
    parts = () if loads is None else loads.parts
    return model.LoadTable(
        kind=tuple(type(part.load).__name__ for part in parts),
        force=np.array([part.force for part in parts], dtype=float).reshape(-1, 3),
        moment=np.array([part.moment for part in parts], dtype=float).reshape(-1, 3),
    )


def _history(state: StaticState) -> model.CouplingHistory:
    steps = state.history
    return model.CouplingHistory(
        relative_change=_finite([step.change for step in steps]),
        tip_displacement=np.array([step.tip for step in steps]),
        lift=np.array([step.lift for step in steps]),
        error=_finite([step.error for step in steps]),
        rate=_finite([step.rate for step in steps]),
        eigenvalue=np.array([step.eigenvalue for step in steps], dtype=complex),
        fraction=np.array([step.fraction for step in steps]),
        factorizations=np.array([step.factorizations for step in steps]),
    )


def _finite(values: list[float]) -> FloatArray:
    array = np.array(values, dtype=float)
    return np.where(np.isfinite(array), array, np.nan)


def _newton(state: StaticState) -> model.NewtonTable:
    rows = [(step.iteration, line) for step in state.history for line in step.newton]
    return model.NewtonTable(
        coupling_iteration=np.array([k for k, _ in rows]),
        fraction=np.array([line.fraction for _, line in rows]),
        iteration=np.array([line.iteration for _, line in rows]),
        residual=np.array([line.residual for _, line in rows]),
        increment=np.array([line.increment for _, line in rows]),
        force=np.array([line.force for _, line in rows]),
        motion=np.array([line.motion for _, line in rows]),
        new_tangent=np.array([line.new_tangent for _, line in rows]),
    )


def _section_curves(case: Case, states: tuple[ViscousFlow, ...]) -> model.SectionCurves:
    sections = [viscous.flow.sections for viscous in states]
    loads = [viscous.flow.loads for viscous in states]
    water = environment(case)
    radius = [np.linalg.norm(s.reference[:, 1:], axis=1) for s in sections]
    root, tip = sections[0].reference[0, 2], sections[0].reference[-1, 2]
    return model.SectionCurves(
        span_fraction=(sections[0].reference[:, 2] - root) / (tip - root),
        radius=np.array(radius),
        chord=np.array([s.chord for s in sections]),
        blade_angle=np.array([s.blade_angle for s in sections]),
        camber=np.array([s.camber for s in sections]),
        incidence=np.array([load.alpha for load in loads]),
        lift_coefficient=np.array([load.lift_coefficient for load in loads]),
        lift_per_length=np.array([load.lift_per_length for load in loads]),
        warp=np.array([s.warp for s in sections]),
        reynolds=np.array([load.reynolds for load in loads]),
        drag_coefficient=np.array([viscous.loads.drag_coefficient for viscous in states]),
        suction=np.array([suction(load) for load in loads]),
        cavitation_number=np.array(
            [cavitation_number(s, load, water) for s, load in zip(sections, loads, strict=True)]
        ),
        shedding_frequency=np.array([viscous.shedding for viscous in states]),
    )


def _performance(case: Case, states: tuple[ViscousFlow, ...]) -> model.PerformanceFigures:
    """Figures of the rotor in each state."""
    inflow, water = inflow_of(case), environment(case)
    figures = [performance(viscous.flow, inflow, viscous.loads) for viscous in states]
    coupled = states[-1].flow.sections, states[-1].flow.loads
    return model.PerformanceFigures(
        inflow=inflow.name,
        friction=case.flow.friction,
        blades=inflow.blades,
        advance_speed=figures[0].advance_speed,
        diameter=np.array([f.diameter for f in figures]),
        thrust=np.array([f.thrust for f in figures]),
        torque=np.array([f.torque for f in figures]),
        advance_ratio=np.array([f.advance_ratio for f in figures]),
        thrust_coefficient=np.array([f.thrust_coefficient for f in figures]),
        torque_coefficient=np.array([f.torque_coefficient for f in figures]),
        efficiency=np.array([f.efficiency for f in figures]),
        inviscid_efficiency=np.array(
            [performance(viscous.flow, inflow).efficiency for viscous in states]
        ),
        inception_depth=float(inception_depth(*coupled, water).max()),
        inception_speed=float(inception_ship_speed(*coupled, water, case.flow.speed).min()),
    )


def _mid_section(flows: tuple[BladeFlow, ...]) -> model.MidSection:
    sections = [flow.sections for flow in flows]
    middle = len(sections[0].reference) // 2
    return model.MidSection(
        span_fraction=middle / (len(sections[0].reference) - 1),
        normalised=np.array([s.contours[middle] for s in sections]),
        placed=np.array([_placed(s, middle) for s in sections]),
    )


def _placed(sections: DeformedSections, k: int) -> FloatArray:
    """Contour of section ``k`` in the blade frame, (nodes, 3) [m]."""
    x, y = (sections.contours[k] - [0.5, 0.0]).T
    arm = x[:, None] * sections.chord_direction[k] + y[:, None] * sections.normal[k]
    return np.asarray(sections.reference[k] + sections.chord[k] * arm)


def configuration_result(
    case: AnyCase, vibration: Vibration, sound: Sound, tables: ModeTables
) -> model.ConfigurationResult:
    """Modes and spectrum of one configuration."""
    operators = vibration.operators
    return model.ConfigurationResult(
        modes=tables.modes,
        mode_count=tables.count,
        loss_shares=tables.losses,
        participation=tables.participation,
        dry_modes=tables.dry,
        spectrum=_spectrum(vibration, sound),
        dissipation=dissipation(vibration, sound),
        sweep=_sweep(case, sound),
        peaks=peak_table(sound),
        stepped=_stepped(sound),
        bands=far_outcome.band_table(case, sound),
        far_field=far_outcome.far_field_result(operators.radius, sound.far),
        directivity=far_outcome.directivity_result(case, sound.far),
        limits=far_outcome.limit_table(case, sound),
        excitations=excitation_table(vibration.excited, sound),
        transfer=transfer_table(sound.transfer),
        radiation_condition=operators.condition.name,
        outer_radius=operators.radius,
        sound_speed=operators.sound_speed,
        water_density=operators.density,
        excitation_pressure=first_pressure(case),
        excitation_area=first_area(vibration.excited),
    )


def _spectrum(vibration: Vibration, sound: Sound) -> model.Spectrum:
    budget, omega = sound.budget, 2.0 * np.pi * sound.frequency
    outgoing = outgoing_by_degree(sound.waves)
    return model.Spectrum(
        frequency=sound.frequency,
        power=np.array([budget.radiated, budget.surface, outgoing.sum(axis=0)]),
        power_by_degree=outgoing,
        injected=budget.injected,
        dissipated=budget.dissipated,
        solver_residual=sound.residual,
        error_estimate=sound.estimate,
        mobility=drive_point_mobility(vibration.excited, omega, sound.loads.work)[:, 0],
    )


def _sweep(case: AnyCase, sound: Sound) -> model.SweepRecord:
    certificate = sound.certificate
    if certificate is None:
        solved = sum(sound.report.factorizations.values())
        nan = float("nan")
        return model.SweepRecord("direct", nan, nan, 0, 0, solved)
    return model.SweepRecord(
        "reduced",
        case.acoustics.accuracy,
        float(certificate.estimate.max()),
        certificate.vectors,
        certificate.size,
        certificate.factorizations,
    )


def peak_table(sound: Sound) -> model.PeakTable:
    """Put the peaks of the sound power in a table."""
    peaks = sound.peaks
    return model.PeakTable(peaks.frequency, level(peaks.power), peaks.width, peaks.estimate)


def _stepped(sound: Sound) -> model.SteppedTable:
    if sound.stepped is None:
        return model.SteppedTable.none()
    return model.SteppedTable(
        sound.stepped.step, level(sound.stepped.aligned), level(sound.stepped.worst)
    )


def mesh_result(mesh: Mesh, vibration: Vibration) -> model.MeshResult:
    """Put the mesh in figures."""
    census = [
        (region, kind, count)
        for region, kinds in mesh.census().items()
        for kind, count in kinds.items()
    ]
    blocks = vibration.operators.blocks
    parts = {
        "displacement": blocks.u, "film pressure": blocks.p, "velocity potential": blocks.psi,
    }  # fmt: skip
    quality = mesh.quality.values()
    return model.MeshResult(
        nodes=len(mesh.nodes),
        cells=model.CellCensus(
            tuple(c[0] for c in census),
            tuple(c[1] for c in census),
            np.array([c[2] for c in census]),
        ),
        quality=model.MeshQuality(
            tuple(mesh.quality),
            np.array([q.worst for q in quality]),
            np.array([q.mean for q in quality]),
            np.array([q.least_jacobian for q in quality]),
        ),
        unknowns=model.Unknowns(
            tuple(parts), np.array([len(part) for part in parts.values()], dtype=np.int64)
        ),
    )


def run_record(
    case_text: str,
    content_key: str,
    laps: Mapping[str, Lap],
    sweeps: Iterable[LinearReport],
    reports: Mapping[str, LinearReport],
    notices: tuple[Notice, ...],
) -> model.RunRecord:
    """Provenance of a run."""
    versions = {name: version(name) for name in PACKAGES}
    return model.RunRecord(
        created=datetime.now(UTC).isoformat(timespec="seconds"),
        platform=f"{platform.platform()}, Python {platform.python_version()}",
        threads=default_threads(),
        code_version=__version__,
        content_key=content_key,
        case_text=case_text,
        packages=model.Packages(tuple(versions), tuple(versions.values())),
        timings=model.Timings(tuple(laps), np.array([lap.seconds for lap in laps.values()])),
        cost=model.Cost(
            tuple(laps),
            np.array([lap.kept for lap in laps.values()]),
            np.array([lap.memory for lap in laps.values()]),
            _factorization(sweeps),
        ),
        solvers=_solver_table(reports),
        fallbacks=model.Fallbacks(
            tuple(
                f"{use}: {f.left} -> {f.entered}: {f.reason}"
                for use, r in reports.items()
                for f in r.fallbacks
            )
        ),
        notices=model.NoticeTable.of(notices),
    )


def _factorization(sweeps: Iterable[LinearReport]) -> float:
    """Mean time of one factorisation [s], the analysis included."""
    reports = list(sweeps)
    count = sum(sum(report.factorizations.values()) for report in reports)
    return sum(report.seconds for report in reports) / count if count else float("nan")


def _solver_table(reports: Mapping[str, LinearReport]) -> model.SolverReport:
    return model.SolverReport(
        use=tuple(reports),
        solver=tuple(", ".join(r.factorizations) for r in reports.values()),
        factorizations=np.array([sum(r.factorizations.values()) for r in reports.values()]),
        worst_residual=np.array([r.worst_residual for r in reports.values()]),
        peak_memory=np.array([float(r.largest_factor) for r in reports.values()]),
    )
