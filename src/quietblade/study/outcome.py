# SPDX-License-Identifier: LGPL-2.1-or-later
"""From the artefacts of a run to its registered result."""

import platform
from collections.abc import Mapping
from dataclasses import replace
from datetime import UTC, datetime
from importlib.metadata import version

import numpy as np
from scipy.sparse import csr_matrix, diags_array

from quietblade import __version__
from quietblade.case import Case
from quietblade.errors import Notice
from quietblade.flow.inflow import BladeFlow
from quietblade.flow.sections import DeformedSections
from quietblade.linalg import SolverReport as LinearReport
from quietblade.linalg import default_threads
from quietblade.mesh import Mesh
from quietblade.propulsion.coupling import StaticState
from quietblade.results import model
from quietblade.study.statics import Statics
from quietblade.study.vibration import Sound, Vibration
from quietblade.typing import FloatArray
from quietblade.vibroacoustics.matching import match

PACKAGES = ("ngsolve", "gmsh", "rslab", "numpy", "scipy", "xarray", "h5netcdf")
"""Packages that the numbers depend on."""


def static_result(statics: Statics) -> model.StaticResult:
    """Tables and figures of step 1."""
    state = statics.state
    flows = (state.rigid, state.chained, state.coupled)
    total = [flow.total for flow in flows]
    result = model.StaticResult(
        history=_history(state),
        newton=_newton(state),
        sections=_section_curves(flows),
        mid_section=_mid_section(flows),
        tip_displacement=state.tip_displacement,
        force=np.array([t.force for t in total]),
        moment=np.array([t.moment for t in total]),
        lift=np.array([t.lift for t in total]),
        thrust=np.array([t.thrust for t in total]),
        torque=np.array([t.torque for t in total]),
        tolerance=state.tolerance,
        converged=state.converged,
        max_blade_shear_strain=statics.blade_shear,
    )
    shear = statics.shear
    if shear is None:
        return result
    return replace(
        result,
        max_film_shear_strain=shear.maximum,
        film_shear_strain_p99=shear.percentile(99.0),
        max_film_shear_strain_place=shear.place,
    )


def _history(state: StaticState) -> model.CouplingHistory:
    change = np.array([step.change for step in state.history])
    return model.CouplingHistory(
        relative_change=np.where(np.isfinite(change), change, np.nan),
        tip_displacement=np.array([step.tip for step in state.history]),
        lift=np.array([step.lift for step in state.history]),
    )


def _newton(state: StaticState) -> model.NewtonTable:
    rows = [(step.iteration, line) for step in state.history for line in step.newton]
    return model.NewtonTable(
        coupling_iteration=np.array([k for k, _ in rows]),
        fraction=np.array([line.fraction for _, line in rows]),
        iteration=np.array([line.iteration for _, line in rows]),
        residual=np.array([line.residual for _, line in rows]),
        increment=np.array([line.increment for _, line in rows]),
        new_tangent=np.array([line.new_tangent for _, line in rows]),
    )


def _section_curves(flows: tuple[BladeFlow, ...]) -> model.SectionCurves:
    sections = [flow.sections for flow in flows]
    loads = [flow.loads for flow in flows]
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
    case: Case, vibration: Vibration, sound: Sound, other: Vibration | None
) -> model.ConfigurationResult:
    """Modes and spectrum of one configuration; ``other`` is the configuration to compare with."""
    operators = vibration.operators
    return model.ConfigurationResult(
        modes=_mode_table(vibration, other),
        spectrum=_spectrum(case, vibration, sound),
        radiation_condition=operators.condition.name,
        outer_radius=operators.radius,
        sound_speed=operators.sound_speed,
        water_density=operators.density,
        excitation_pressure=case.excitation.pressure,
        excitation_area=vibration.area,
    )


def _mode_table(vibration: Vibration, other: Vibration | None) -> model.ModeTable:
    """Real modes; those in the band with the loss of the damped mode that belongs to them."""
    modes, damped = vibration.modes, vibration.damped
    loss, radiation = modes.loss_factor.copy(), np.full(len(modes.frequency), np.nan)
    good = damped.converged
    loss[damped.start[good]] = damped.loss_factor[good]
    radiation[damped.start[good]] = damped.loss_factor[good] - modes.loss_factor[damped.start[good]]
    work = np.abs(modes.vectors @ vibration.load)
    partner, likeness = ("",) * len(loss), np.full(len(loss), np.nan)
    if other is not None:
        # each in the axes of its own sections: the bent blade carries its shapes with it
        own, theirs = (v.shapes.reshape(len(v.shapes), -1) for v in (vibration, other))
        found = match(own, theirs, csr_matrix(diags_array(np.repeat(vibration.masses, 3))))
        names = other.naming.name
        partner = tuple(names[k] if k >= 0 else "" for k in found.partner)
        likeness = found.assurance
    return model.ModeTable(
        name=vibration.naming.name,
        frequency=modes.frequency,
        loss_factor=loss,
        film_loss=modes.loss_factor,
        radiation_loss=radiation,
        purity=vibration.naming.purity,
        partner=partner,
        partner_mac=likeness,
        participation=(work / work.max()) ** 2,
    )


def _spectrum(case: Case, vibration: Vibration, sound: Sound) -> model.Spectrum:
    response, budget, waves = sound.response, sound.budget, sound.multipoles
    assert response.solution is not None
    force = case.excitation.pressure * vibration.area
    work = response.solution @ vibration.load
    return model.Spectrum(
        frequency=response.frequency,
        power=np.array([budget.radiated, budget.surface, waves.power]),
        power_by_degree=waves.power_by_degree.T,
        injected=budget.injected,
        dissipated=budget.dissipated,
        solver_residual=response.residual,
        mobility=1j * response.omega * work / force**2,
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
    seconds: Mapping[str, float],
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
        timings=model.Timings(tuple(seconds), np.array(list(seconds.values()))),
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


def _solver_table(reports: Mapping[str, LinearReport]) -> model.SolverReport:
    return model.SolverReport(
        use=tuple(reports),
        solver=tuple(", ".join(r.factorizations) for r in reports.values()),
        factorizations=np.array([sum(r.factorizations.values()) for r in reports.values()]),
        worst_residual=np.array([r.worst_residual for r in reports.values()]),
        peak_memory=np.array([float(r.largest_factor) for r in reports.values()]),
    )
