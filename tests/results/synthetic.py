# SPDX-License-Identifier: LGPL-2.1-or-later
"""A made-up but physically shaped result, to test the storing and the drawing of results.

Strip theory along a bent and twisted blade, and modal sums for the spectra. Nothing here comes
from a computation of the package.
"""

from dataclasses import dataclass, replace

import numpy as np

from quietblade.errors import Notice
from quietblade.geometry import NacaFourDigit
from quietblade.mesh import Mesh
from quietblade.results import mode_records as records
from quietblade.results import model as m
from quietblade.results.excitations import ExcitationTable, TransferTable
from quietblade.results.store import RunFolder
from quietblade.results.vtk import PointField, write_fields
from quietblade.typing import AnyArray, ComplexArray, FloatArray

SPEED, ROTATION, DENSITY = 5.0, 0.58, 1000.0
HUB, SPAN, ROOT_CHORD, TIP_CHORD = 0.2, 1.0, 0.25, 0.075


@dataclass(frozen=True)
class Shape:
    """How a blade gives way."""

    deflection: float
    tip_twist: float
    root_twist: float
    camber: float
    shear: float
    modes: dict[str, tuple[str, float, float, float]]
    """Name at rest: name under load, both frequencies [Hz], rise of the level [dB]."""


SHAPES = {
    "aluminium": Shape(
        0.13, np.radians(-0.45), np.radians(0.05), 0.0006, 0.0185,
        {
            "B4": ("B4", 84.0, 84.8, 1.0), "B5": ("B5", 136.4, 137.5, 1.6),
            "E2": ("E2", 149.1, 149.0, 0.5), "T2": ("T2", 162.7, 162.8, 4.6),
            "B6": ("B6", 192.3, 194.1, 2.1), "T3": ("T3", 238.0, 238.3, 1.0),
        },
    ),
    "composite": Shape(
        0.36, np.radians(1.1), np.radians(0.3), 0.0072, 0.087,
        {
            "B5": ("B5", 96.1, 103.2, 1.0), "B6": ("B6", 137.2, 148.1, 1.3),
            "E2": ("E2", 128.0, 127.0, 0.5), "T2": ("T2", 166.9, 155.6, 1.1),
            "B7": ("B7", 185.5, 199.1, 7.2), "T3": ("T3", 246.0, 232.0, 1.0),
        },
    ),
}  # fmt: skip


def make_result(
    blade: str = "aluminium", case_text: str = "[blade]\nspan = '1 m'  # größe\n"
) -> m.Result:
    shape = SHAPES[blade]
    grid = _grid(shape)
    return m.Result(
        title=f"The paper's {blade} blade",
        blade=blade,
        static=make_static(shape),
        configurations={
            "C0": make_configuration(shape, grid, loaded=False),
            "C1": make_configuration(shape, grid, loaded=True),
        },
        moduli=make_moduli(),
        mesh=m.MeshResult(
            nodes=17036,
            cells=m.CellCensus(
                region=("blade", "blade", "film", "water"),
                kind=("tetra10", "pyramid13", "hexahedron20", "tetra10"),
                count=np.array([4440, 368, 144, 7102]),
            ),
            quality=m.MeshQuality(
                region=("blade", "film", "water"),
                worst=np.array([0.027, 0.096, 0.011]),
                mean=np.array([0.28, 0.12, 0.72]),
                least_jacobian=np.array([0.52, 0.98, 0.73]),
            ),
            unknowns=m.Unknowns(
                part=("displacement", "film_pressure", "potential"),
                count=np.array([28410, 388, 12034]),
            ),
        ),
        run=make_run(case_text),
        campbell=make_campbell(),
    )


def make_campbell() -> records.CampbellDiagram:
    """Southwell's law for three modes, and its crossings with two orders of five blades."""
    rotation, rest, rise = np.linspace(0.0, 12.0, 7), np.array([12.0, 31.0, 48.0]), 1.8
    frequency = np.sqrt(rest[:, None] ** 2 + rise * rotation**2 / (4.0 * np.pi**2))
    frequency[2, :2] = np.nan  # a mode that comes into the band from above
    slope = np.array([1, 2, 3]) * 5.0 / (2.0 * np.pi)
    at = rest[:2, None] / np.sqrt(slope**2 - rise / (4.0 * np.pi**2))
    mode, order = np.nonzero(at <= rotation[-1])
    return records.CampbellDiagram(
        advance="scaled",
        blades=5,
        rotation=rotation,
        advance_speed=SPEED * rotation / 6.0,
        tip_displacement=np.outer(rotation**2, [0.0, 1e-3, 0.0]),
        order=np.array([1, 2, 3]),
        name=("B1", "B2", "T1"),
        frequency=frequency,
        crossing_mode=tuple(("B1", "B2")[k] for k in mode),
        crossing_order=order + 1,
        crossing_rotation=at[mode, order],
        crossing_frequency=slope[order] * at[mode, order],
    )


def make_static(shape: Shape) -> m.StaticResult:
    s = np.linspace(0.0, 1.0, 101)
    chord = ROOT_CHORD + (TIP_CHORD - ROOT_CHORD) * s
    radius = HUB + SPAN * s
    rigid_alpha = np.arctan(ROTATION * radius / SPEED)
    twist = shape.tip_twist * s**2 + 4.0 * shape.root_twist * s * (1.0 - s)
    camber = shape.camber * 4.0 * s * (1.0 - s)
    # twist and camber of rigid, chained (too much of it) and coupled blade
    share = np.array([0.0, 0.93, 1.0])[:, None]
    alpha = rigid_alpha + share * twist
    lift_coefficient = 2.0 * np.pi * 1.045 * alpha + 4.0 * np.pi * share * camber
    pressure = 0.5 * DENSITY * (SPEED**2 + (ROTATION * radius) ** 2)
    lift_per_length = lift_coefficient * pressure * chord
    lift = np.trapezoid(lift_per_length, SPAN * s, axis=1)
    passes = np.arange(1, 9)
    return m.StaticResult(
        history=m.CouplingHistory(
            relative_change=np.r_[np.nan, 0.09 * 0.28 ** np.arange(0, 7)],
            tip_displacement=np.outer(1.0 - 0.09 * (-0.28) ** passes, _tip(shape)),
            lift=lift[2] + (lift[0] - lift[2]) * (-0.28) ** (passes - 1),
            error=np.r_[np.nan, 0.035 * 0.28 ** np.arange(0, 7)],
            rate=np.r_[np.nan, np.full(7, 0.28)],
            eigenvalue=np.r_[np.nan, np.full(7, -0.28 + 0.0j)],
            fraction=np.ones(8),
            factorizations=np.ones(8, dtype=int),
        ),
        newton=m.NewtonTable(
            coupling_iteration=np.repeat(passes, 4),
            fraction=np.ones(32),
            iteration=np.tile(np.arange(4), 8),
            residual=np.tile([1.0, 3e-2, 4e-5, 1e-10], 8),
            increment=np.tile([0.9, 2e-2, 1e-5, np.nan], 8),
            force=np.tile([50.0, 1.5, 2e-3, 5e-9], 8),
            motion=np.tile([0.1, 2e-3, 1e-6, np.nan], 8),
            new_tangent=np.tile([True, True, False, False], 8),
        ),
        sections=m.SectionCurves(
            span_fraction=s,
            radius=np.tile(radius, (3, 1)),
            chord=np.tile(chord, (3, 1)),
            blade_angle=share * twist,
            camber=share * camber,
            incidence=alpha,
            lift_coefficient=lift_coefficient,
            lift_per_length=lift_per_length,
            warp=share * camber * 0.02,
            reynolds=np.tile(chord * SPEED / 1.1e-6, (3, 1)),
            drag_coefficient=np.full(alpha.shape, 0.008),
            suction=1.2 * lift_coefficient,
            cavitation_number=np.tile(1e5 / pressure, (3, 1)),
            shedding_frequency=np.tile(0.21 * SPEED / (0.02 * chord), (3, 1)),
        ),
        performance=make_performance(lift),
        stress=m.StressTable(
            region=("blade", "film"),
            von_mises=np.array([2.1e8, 2.4e5]),
            von_mises_p99=np.array([1.6e8, 2.2e5]),
            von_mises_place=np.array([[0.02, 0.007, 0.21], [0.02, 0.0, 0.27]]),
            principal_stress=np.array([2.4e8, 1.9e5]),
            logarithmic_strain=np.array([3.2e-3, 0.5 * shape.shear]),
        ),
        failure=m.FailureTable(
            region=("blade",),
            name=("yield",),
            value=np.array([0.8]),
            p99=np.array([0.6]),
            place=np.array([[0.02, 0.007, 0.21]]),
        ),
        reaction=m.ReactionResult(
            force=np.array([0.1, -1.0, 0.0]) * lift[2],
            moment=np.array([0.6, -0.05, -0.01]) * lift[2],
            force_imbalance=2e-9,
            moment_imbalance=3e-9,
            transferred_force_error=1e-13,
            transferred_moment_error=2e-3,
        ),
        loads=m.LoadTable(kind=(), force=np.zeros((0, 3)), moment=np.zeros((0, 3))),
        mid_section=make_mid_section(shape),
        tip_displacement=_tip(shape),
        force=np.stack([-0.1 * lift, lift, 0.0 * lift], axis=1),
        moment=np.stack([-0.6 * lift, 0.05 * lift, 0.01 * lift], axis=1),
        lift=lift,
        thrust=0.1 * lift,
        torque=0.1 * lift * SPEED / ROTATION,
        tolerance=1e-5,
        converged=True,
        coupling_method="fixed-point",
        coupling_kind="steady",
        load_fraction=1.0,
        divergence_ratio=float("nan"),
        max_film_shear_strain=shape.shear,
        film_shear_strain_p99=0.82 * shape.shear,
        max_film_shear_strain_place=np.array([0.02, 0.0, 0.27]),
        max_blade_shear_strain=0.11 * shape.shear,
    )


def make_performance(lift: FloatArray) -> m.PerformanceFigures:
    turns, diameter = ROTATION / (2.0 * np.pi), 2.0 * (HUB + SPAN)
    thrust, torque = 0.09 * lift, 0.1 * lift * SPEED / ROTATION
    ones = np.ones(3)
    return m.PerformanceFigures(
        inflow="none",
        friction="ittc-1957",
        blades=1,
        advance_speed=SPEED,
        diameter=diameter * ones,
        thrust=thrust,
        torque=torque,
        advance_ratio=SPEED / (turns * diameter) * ones,
        thrust_coefficient=thrust / (DENSITY * turns**2 * diameter**4),
        torque_coefficient=torque / (DENSITY * turns**2 * diameter**5),
        efficiency=thrust * SPEED / (torque * ROTATION),
        inviscid_efficiency=ones,
        inception_depth=-2.0,
        inception_speed=11.0,
    )


def make_mid_section(shape: Shape) -> m.MidSection:
    contour = NacaFourDigit().contour(0.06, 0.0, 0.006, 121)
    x, y = contour.T
    normalised = np.stack([np.stack([x, y + 4 * k * shape.camber * x * (1 - x)], axis=1)
                           for k in (0.0, 0.93, 1.0)])  # fmt: skip
    chord = 0.5 * (ROOT_CHORD + TIP_CHORD)
    placed = []
    for k, section in zip((0.0, 0.93, 1.0), normalised, strict=True):
        angle = k * (0.25 * shape.tip_twist + shape.root_twist)
        t, n = np.array([np.cos(angle), -np.sin(angle)]), np.array([np.sin(angle), np.cos(angle)])
        plane = chord * ((section[:, :1] - 0.5) * t + section[:, 1:] * n)
        plane[:, 1] += k * shape.deflection * _bend(0.5)
        placed.append(np.c_[plane, np.full(len(plane), HUB + 0.5)])
    return m.MidSection(span_fraction=0.5, normalised=normalised, placed=np.stack(placed))


def make_configuration(
    shape: Shape, frequency: FloatArray, *, loaded: bool
) -> m.ConfigurationResult:
    rows = _rows(shape, loaded)
    names, partners, natural, rise = zip(*rows, strict=True)
    f_n = np.array(natural)
    film = np.where([name.startswith("E") for name in names], 2e-4, 4e-3)
    radiation = 0.12 * film
    eta = film + radiation
    edgewise = np.array([name.startswith("E") for name in names])
    strength = np.where(edgewise, 2e-4, 1.0) * 10 ** (np.array(rise) / 10)
    omega, omega_n = 2 * np.pi * frequency, 2 * np.pi * f_n[:, None]
    modal_mobility = (
        1j * omega * strength[:, None] / (omega_n**2 * (1 + 1j * eta[:, None]) - omega**2)
    )
    force = 10.0
    modal_power = 0.5 * force**2 * modal_mobility.real
    radiated = ((radiation / eta)[:, None] * modal_power).sum(axis=0)
    injected = modal_power.sum(axis=0)
    power = np.stack([radiated, radiated * (1 + 1e-9), radiated * 0.3])
    peaks = _peaks(frequency, radiated)
    return m.ConfigurationResult(
        modes=m.ModeTable(
            name=names,
            frequency=f_n,
            loss_factor=eta,
            film_loss=film,
            radiation_loss=radiation,
            purity=np.full(len(names), 0.94),
            partner=partners,
            partner_mac=np.full(len(names), 0.97),
            participation=strength,
        ),
        mode_count=records.ModeCount(
            counted=len(names),
            highest=260.0,
            character=tuple("edgewise" if e else "bending" for e in edgewise),
            family_share=np.tile([0.94, 0.03, 0.02, 0.01], (len(names), 1)),
            residual=np.full(len(names), 1e-9),
        ),
        loss_shares=records.LossShares(("film", "radiation"), np.stack([film, radiation], axis=1)),
        participation=records.Participation(f_n, np.eye(len(names))),
        dry_modes=records.DryModes(
            names, 2.5 * f_n, film, np.full(len(names), 0.97), names, np.full(len(names), 0.95)
        ),
        spectrum=m.Spectrum(
            frequency=frequency,
            power=power,
            power_by_degree=power[2] * np.array([0.02, 0.9, 0.08])[:, None],
            injected=injected,
            dissipated=injected - radiated * (1 + 1e-8),
            solver_residual=np.full(len(frequency), 3e-12),
            error_estimate=np.full(len(frequency), 2e-4),
            mobility=modal_mobility.sum(axis=0),
        ),
        dissipation=_dissipation(frequency, injected - radiated, radiated),
        sweep=m.SweepRecord("reduced", 0.01, 2e-4, 16, 64, 1),
        stepped=_stepped(frequency, radiated),
        peaks=peaks,
        bands=m.BandTable(
            "decidecade",
            np.array([125.89, 158.49]),
            np.array([112.2, 141.25]),
            np.array([141.25, 177.83]),
            np.array([70.0, 72.0]),
            np.array([115.5, 117.5]),
            71.0,
            116.5,
        ),
        far_field=_far_field(frequency, power[2]),
        directivity=_directivity(peaks),
        limits=_limits(frequency, radiated),
        excitations=make_excitations(frequency, radiated, injected),
        transfer=make_transfer(frequency, modal_mobility.sum(axis=0), injected),
        radiation_condition="BGT-1",
        outer_radius=1.3,
        sound_speed=1500.0,
        water_density=DENSITY,
        excitation_pressure=1.0e4,
        excitation_area=1.0e-3,
    )


SHARES = np.array([0.02, 0.9, 0.08, 0.0])


def _far_field(frequency: FloatArray, power: FloatArray) -> m.FarFieldResult:
    level = 10.0 * np.log10(DENSITY * 1500.0 * power / (4.0 * np.pi * 1e-12))
    return m.FarFieldResult(
        origin="multipoles",
        frequency=frequency,
        kr=2.0 * np.pi * frequency / 1500.0 * 1.3,
        source_level=level,
        efficiency=1e-3 * (frequency / 100.0) ** 2,
        share=np.tile(SHARES[:, None], (1, len(frequency))),
        condition_error=np.full(len(frequency), 5.2),
        place=np.array([[0.0, 10.0, 0.7]]),
        pressure=np.sqrt(2.0) * 1e-6 * 10 ** ((level[None] - 20.0) / 20.0) * np.exp(-0.3j),
    )


def _directivity(peaks: m.PeakTable) -> m.DirectivityResult:
    """Dipoles along y, and one frequency that was asked for."""
    frequency = np.append(peaks.frequency, 140.0)
    source = np.append(peaks.power_level + 45.0, 100.0)
    polar, azimuth = np.linspace(0.0, np.pi, 19), 2.0 * np.pi * np.arange(36) / 36
    angle = 2.0 * np.pi * np.arange(72) / 72
    lobe = np.sin(polar)[:, None] * np.sin(azimuth)
    in_planes = np.stack([np.sin(angle), 0.0 * angle, np.cos(angle)])
    around = np.log10(3.0 * lobe**2 + 1e-9), np.log10(3.0 * in_planes**2 + 1e-9)
    count = len(frequency)
    return m.DirectivityResult(
        frequency=frequency,
        reason=("peak",) * len(peaks.frequency) + ("given",),
        source_level=source,
        efficiency=1e-3 * (frequency / 100.0) ** 2,
        share=np.tile(SHARES, (count, 1)),
        index=np.full(count, 10.0 * np.log10(3.0)),
        loudest=np.tile([0.0, 1.0, 0.0], (count, 1)),
        centre=np.array([0.0, 0.0, 0.7]),
        distance=np.inf,
        cut=("xy", "xz", "yz"),
        angle=angle,
        cut_level=source[:, None, None] + 10.0 * around[1],
        polar=polar,
        azimuth=azimuth,
        level=source[:, None, None] + 10.0 * around[0],
        product=np.sqrt(2.0) * 1e-6 * 10 ** (source[:, None, None] / 20.0) * (lobe + 0j),
    )


def _limits(frequency: FloatArray, power: FloatArray) -> m.LimitTable:
    """One for each frequency, one for decidecades."""
    level = 10.0 * np.log10(power / m.REFERENCE_POWER)
    centre = np.array([125.89, 158.49])
    narrow = np.where(frequency > 120.0, 75.0, np.nan)
    excess = level - narrow
    return m.LimitTable(
        name=("hull", "range"),
        quantity=("sound-power", "source-level"),
        bands=("narrow", "decidecade"),
        worst_excess=np.array([np.nanmax(excess), 2.5]),
        worst_frequency=np.array([frequency[np.nanargmax(excess)], 158.49]),
        row_of=np.repeat([0, 1], [len(frequency), 2]),
        frequency=np.concatenate([frequency, centre]),
        found=np.concatenate([level, [115.5, 117.5]]),
        allowed=np.concatenate([narrow, [116.0, 115.0]]),
    )


def _dissipation(frequency: FloatArray, lost: FloatArray, radiated: FloatArray) -> m.Dissipation:
    power = np.stack([0.1 * lost, 0.9 * lost, radiated])
    peaks = _peaks(frequency, radiated).frequency
    at_peaks = power[:, np.searchsorted(frequency, peaks)]
    return m.Dissipation(
        sink=("blade", "film", "water"),
        power=power,
        mean_share=power.mean(axis=1) / power.mean(axis=1).sum(),
        peak_frequency=peaks,
        peak_share=at_peaks / at_peaks.sum(axis=0),
    )


def make_moduli() -> m.ModulusTable:
    """A fitted film and a blade that is not isotropic, without a static modulus."""
    frequency = np.geomspace(5.0, 2000.0, 41)
    ratio = np.stack([_zener(frequency), 1.0 + 0.01j + 0.0 * frequency])
    points = np.geomspace(10.0, 1000.0, 15)
    scatter = 1.0 + 0.05 * np.sin(7.0 * np.arange(15))
    ends = np.array([100.0, 200.0])
    return m.ModulusTable(
        name=("film", "blade"),
        model=("table", "maxwell"),
        static=np.array([1.5e6, np.nan]),
        temperature=np.array([283.15, np.nan]),
        shift=np.array([3.2, 1.0]),
        fit_error=np.array([0.05, np.nan]),
        band=ends,
        band_ratio=np.stack([_zener(ends), np.full(2, 1.0 + 0.01j)]),
        frequency=frequency,
        ratio=ratio,
        measured_modulus=np.zeros(15, dtype=int),
        measured_frequency=points,
        measured_ratio=scatter * _zener(points),
    )


def _zener(frequency: FloatArray) -> AnyArray:
    z = (2j * np.pi * frequency * 1e-3) ** 0.6
    return (1.0 + 8.0 * z) / (1.0 + z)


def make_excitations(
    frequency: FloatArray, radiated: FloatArray, injected: FloatArray
) -> ExcitationTable:
    share = np.array([[0.7], [0.3]])
    ones = np.ones_like(frequency)
    return ExcitationTable(
        signal="harmonic",
        correlation="",
        name=("patch", "engine"),
        kind=("pressure", "root-motion"),
        unit=("Pa", "m/s"),
        size=np.array([1e-3, np.nan]),
        amplitude=np.stack([1e4 * ones, 1e-3j * ones]),
        radiated=share * radiated,
        injected=share * injected,
        mean_level=10.0 * np.log10(share[:, 0] * radiated.mean() / m.REFERENCE_POWER),
    )


def make_transfer(
    frequency: FloatArray, mobility: ComplexArray, injected: FloatArray
) -> TransferTable:
    ramp = frequency / frequency[0]
    force = np.array([0.3, 9.0, 1.0])[:, None] * ramp * np.sqrt(injected / injected.mean())
    blocked = np.stack([force, 0.2 * force]) * np.exp(0.1j)
    return TransferTable(
        functions=("mobility", "power-per-force", "blocked-force", "shaft"),
        about=np.array([0.0, 0.0, HUB]),
        mobility=np.stack([mobility, 0.3j * np.abs(mobility) + mobility]),
        power_per_force=np.stack([injected, 0.1 * injected]) / 50.0,
        blocked_force=blocked,
        blocked_moment=0.5 * blocked,
        root_force=force,
        root_moment=0.5 * force,
        shaft_power=0.01 * injected * ramp,
    )


def _peaks(frequency: FloatArray, power: FloatArray) -> m.PeakTable:
    top = np.flatnonzero((power[1:-1] > power[:-2]) & (power[1:-1] > power[2:])) + 1
    return m.PeakTable(
        frequency[top],
        10.0 * np.log10(power[top] / m.REFERENCE_POWER),
        4e-3 * frequency[top],
        np.full(len(top), 1e-5),
    )


def _stepped(frequency: FloatArray, power: FloatArray) -> m.SteppedTable:
    true = _peaks(frequency, power).power_level
    loss = np.array([2.0, 6.0, 12.0])
    return m.SteppedTable(
        np.array([0.5, 1.0, 2.0]), true[:, None] - 0.3 * loss, true[:, None] - loss
    )


def make_run(case_text: str) -> m.RunRecord:
    notice = Notice("flow, s = 1.00", "incidence beyond stall", 0.138, 0.13, "lower the rotation")
    return m.RunRecord(
        created="2026-01-31T12:00:00+00:00",
        platform="Linux x86_64, Python 3.11",
        threads=1,
        code_version="0.1.0",
        content_key="0123abcd",
        case_text=case_text,
        packages=m.Packages(name=("ngsolve", "numpy"), version=("6.2.2608", "2.4.6")),
        timings=m.Timings(
            stage=("mesh", "equilibrium", "sweep"), seconds=np.array([4.0, 20.5, 60])
        ),
        cost=m.Cost(
            stage=("mesh", "equilibrium", "sweep"),
            kept=np.array([True, False, False]),
            memory=np.array([4e8, 1.5e9, np.nan]),
            factorization=4.0,
        ),
        solvers=m.SolverReport(
            use=("sweep",),
            solver=("rslab, mixed precision",),
            factorizations=np.array([250]),
            worst_residual=np.array([3e-12]),
            peak_memory=np.array([1.2e9]),
        ),
        fallbacks=m.Fallbacks(event=()),
        notices=m.NoticeTable.of((notice, Notice("mesh", "no limit here"))),
    )


def with_static(result: m.Result, **changes: object) -> m.Result:
    return replace(result, static=replace(result.static, **changes))


def write_synthetic_fields(folder: RunFolder, mesh: Mesh, result: m.Result) -> None:
    """Fields of the right shape on a real mesh."""
    shape = SHAPES[result.blade]
    solid = {name: mesh.cells[name] for name in ("blade", "film")}
    surface = {**solid, "excited": (_Triangles(mesh.faces["excited"]),)}
    s = (mesh.nodes[:, 2] - HUB) / SPAN
    moved = _beam(mesh.nodes, s, shape.deflection * _bend(s), shape.tip_twist * s**2)
    strain = np.full(len(mesh.nodes), np.nan)
    film = np.unique(np.concatenate([block.connectivity.ravel() for block in solid["film"]]))
    chord = ROOT_CHORD + (TIP_CHORD - ROOT_CHORD) * s[film]
    across = mesh.nodes[film, 0] / (0.35 * chord)
    strain[film] = shape.shear * np.exp(-2.2 * s[film]) * (0.25 + 0.75 * np.abs(across) ** 2)
    pressure = -2000.0 * s * np.sign(mesh.nodes[:, 1])
    write_fields(
        folder.static_fields,
        mesh.nodes,
        surface,
        [
            PointField("displacement", moved),
            PointField("film_shear_strain", strain),
            PointField("von_mises_stress", 2e8 * (1.0 - s) + 1e6, "blade"),
            PointField("pressure", pressure),
        ],
    )
    for name, configuration in result.configurations.items():
        points = mesh.nodes + moved if name == "C1" else mesh.nodes
        shapes = [
            PointField("mode_shape", _mode(mode, mesh.nodes, s) * (1 + 0.02j), mode)
            for mode in configuration.modes.name
        ]
        write_fields(folder.mode_fields(name), points, solid, shapes)


@dataclass(frozen=True)
class _Triangles:
    connectivity: AnyArray
    kind: str = "triangle6"


def _rows(shape: Shape, loaded: bool) -> list[tuple[str, str, float, float]]:
    rows = [
        (after, before, f1, rise) if loaded else (before, after, f0, 0.0)
        for before, (after, f0, f1, rise) in shape.modes.items()
    ]
    return sorted(rows, key=lambda row: row[2])


def _grid(shape: Shape) -> FloatArray:
    needles = [f for _, f0, f1, _ in shape.modes.values() for f in (f0, f1)]
    # finer towards the resonance, as a sweep that has been refined
    offsets = np.r_[0.0, np.geomspace(2e-5, 2e-2, 14)]
    fine = np.concatenate([f * (1 + np.r_[-offsets[:0:-1], offsets]) for f in needles])
    grid = np.unique(np.r_[np.arange(100.0, 200.5, 1.0), fine])
    return grid[(grid >= 100.0) & (grid <= 200.0)]


def _tip(shape: Shape) -> FloatArray:
    return np.array([0.004 * shape.deflection, shape.deflection, -0.6 * shape.deflection**2])


def _bend(s: float | FloatArray) -> FloatArray:
    s = np.asarray(s)
    return s**2 * (6.0 - 4.0 * s + s**2) / 3.0


def _beam(
    nodes: FloatArray, s: FloatArray, deflection: FloatArray, twist: FloatArray
) -> FloatArray:
    slope = np.gradient(deflection[np.argsort(s)], np.sort(s) + 1e-9 * np.arange(len(s)))
    inverse = np.argsort(np.argsort(s))
    slope = np.clip(slope[inverse], -1.0, 1.0)
    x, y = nodes[:, 0], nodes[:, 1]
    return np.stack([twist * y, deflection - twist * x, -slope * y], axis=1)


def _mode(name: str, nodes: FloatArray, s: FloatArray) -> FloatArray:
    number = int(name[1:])
    zero = np.zeros_like(s)
    if name[0] == "T":
        wave = np.sin((number - 0.5) * np.pi * s)
        return np.stack([wave * nodes[:, 1], -wave * nodes[:, 0], zero], axis=1) / 0.08
    k = (number - 0.5) * np.pi
    sigma = (np.cosh(k) + np.cos(k)) / (np.sinh(k) + np.sin(k))
    wave = 0.5 * (np.cosh(k * s) - np.cos(k * s) - sigma * (np.sinh(k * s) - np.sin(k * s)))
    return np.stack([wave, zero, zero] if name[0] == "E" else [zero, wave, zero], axis=1)
