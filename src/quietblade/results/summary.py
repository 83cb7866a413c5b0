# SPDX-License-Identifier: LGPL-2.1-or-later
"""The headline figures of a run as data: what ``quietblade show --json`` prints.

Units are in the names of the fields. A figure that was not computed is null.
"""

from typing import Annotated, Any

import numpy as np
from pydantic import BaseModel, BeforeValidator, ConfigDict, Field

from quietblade.results.quantities import QUANTITIES


def _finite(value: Any) -> Any:
    """JSON has no NaN."""
    return None if isinstance(value, float) and not np.isfinite(value) else value


Number = Annotated[float | None, BeforeValidator(_finite)]
Vector = tuple[Number, Number, Number]


def _of(key: str, note: str = "") -> Any:
    """Field that is described by a registered quantity."""
    quantity = QUANTITIES[key]
    label = quantity.label
    density = quantity.per_hertz().label.removeprefix("dB re ")
    if key.startswith("C*/") and not label.endswith(density):
        label += f", or {density} if random"
    unit = f" [{label}]" if label not in {"", "1"} else ""
    more = f"; {note}" if note else ""
    return Field(description=f"{quantity.description}{unit}{more}")


class _Part(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid")


class StaticSummary(_Part):
    """Step 1."""

    tip_displacement_m: Vector = _of("static/tip_displacement", "axes x, y, z of the blade frame")
    max_film_shear_strain: Number = _of("static/max_film_shear_strain")
    film_shear_strain_p99: Number = _of("static/film_shear_strain_p99")
    max_film_shear_strain_place_m: Vector = _of("static/max_film_shear_strain_place")
    max_blade_shear_strain: Number = _of("static/max_blade_shear_strain")
    lift_n: Number = _of("static/lift", "coupled")
    lift_rigid_n: Number = _of("static/lift", "rigid")
    lift_chained_n: Number = _of("static/lift", "chained")
    thrust_n: Number = _of("static/thrust", "coupled")
    torque_nm: Number = _of("static/torque", "coupled")
    mid_camber: Number = _of("static/sections/camber", "coupled, mid section")
    tip_blade_angle_deg: Number = Field(description="change of the blade angle at the tip [deg]")
    iterations: int = Field(description="passes of the coupling")
    relative_change: Number = _of("static/history/relative_change", "the last one")
    estimated_error: Number = _of("static/history/error", "the last one")
    method: str = _of("static/coupling_method")
    kind: str = _of("static/coupling_kind")
    divergence_ratio: Number = _of("static/divergence_ratio")
    changes: tuple[Number, ...] = _of("static/history/relative_change", "of each pass")
    converged: bool = _of("static/converged")


class StateFigures(_Part):
    """Figures of the rotor in one state of its blades, friction included."""

    advance_ratio: Number = _of("static/performance/advance_ratio")
    thrust_n: Number = _of("static/performance/thrust")
    torque_nm: Number = _of("static/performance/torque")
    thrust_coefficient: Number = _of("static/performance/thrust_coefficient")
    torque_coefficient: Number = _of("static/performance/torque_coefficient")
    efficiency: Number = _of("static/performance/efficiency")
    inviscid_efficiency: Number = _of("static/performance/inviscid_efficiency")


class FailureSummary(_Part):
    """The largest of one failure index in one region."""

    region: str = _of("static/failure/region")
    name: str = _of("static/failure/name")
    value: Number = _of("static/failure/value")
    p99: Number = _of("static/failure/p99")
    place_m: Vector = _of("static/failure/place")


class StrengthSummary(_Part):
    """Stress, failure and reactions in equilibrium."""

    von_mises_pa: dict[str, Number] = _of("static/stress/von_mises", "by region")
    von_mises_p99_pa: dict[str, Number] = _of("static/stress/von_mises_p99", "by region")
    logarithmic_strain: dict[str, Number] = _of("static/stress/logarithmic_strain", "by region")
    failure: tuple[FailureSummary, ...] = Field(
        description="failure indices; empty where no strength is known"
    )
    root_force_n: Vector = _of("static/reaction/force")
    root_moment_nm: Vector = _of("static/reaction/moment")
    force_imbalance: Number = _of("static/reaction/force_imbalance")


class PerformanceSummary(_Part):
    """The rotor: undeformed, under the undeformed blade's load, and in equilibrium."""

    inflow: str = _of("static/performance/inflow")
    friction: str = _of("static/performance/friction")
    blades: int = _of("static/performance/blades")
    rigid: StateFigures
    chained: StateFigures
    coupled: StateFigures
    inception_depth_m: Number = _of("static/performance/inception_depth")
    inception_speed_m_s: Number = _of("static/performance/inception_speed")


class ModeSummary(_Part):
    """One wet mode."""

    name: str = _of("C*/modes/name")
    frequency_hz: Number = _of("C*/modes/frequency")
    loss_factor: Number = _of("C*/modes/loss_factor")
    purity: Number = _of("C*/modes/purity")
    partner: str = _of("C*/modes/partner")
    partner_mac: Number = _of("C*/modes/partner_mac")
    kind: str = _of("C*/mode_count/character")
    loss_by_part: dict[str, Number] = _of("C*/loss_shares/share", "by region, stream, radiation")
    dry_frequency_hz: Number = _of("C*/dry_modes/frequency", "of the dry mode that belongs to it")
    peak_share: Number = _of("C*/participation/share", "at the mode's own peak")
    peak_frequency_hz: Number = Field(description="frequency of the mode's peak in the power [Hz]")
    peak_level_db: Number = Field(
        description="sound power level of that peak [dB re 1 pW, or 1 pW/Hz]"
    )
    peak_width_hz: Number = Field(description="half-power width of that peak [Hz]")


class ModesSummary(_Part):
    """Wet modes of both configurations, in ascending frequency."""

    C0: tuple[ModeSummary, ...] = Field(description="at rest")
    C1: tuple[ModeSummary, ...] = Field(description="deformed by the steady load")
    counted: dict[str, int] = _of("C*/mode_count/counted", "by configuration")
    complete_below_hz: Number = _of("C*/mode_count/highest")


class CrossingSummary(_Part):
    """A multiple of the blade rate meets a mode."""

    mode: str = _of("campbell/crossing_mode")
    order: int = _of("campbell/crossing_order")
    rotation_rad_s: Number = _of("campbell/crossing_rotation")
    frequency_hz: Number = _of("campbell/crossing_frequency")


class BranchSummary(_Part):
    """A mode over the speed of the shaft."""

    name: str = _of("campbell/name")
    frequency_hz: tuple[Number, ...] = _of("campbell/frequency", "at each speed")


class CampbellSummary(_Part):
    """The Campbell diagram; empty unless the case asks for it."""

    advance: str = _of("campbell/advance")
    blades: int = _of("campbell/blades")
    rotation_rad_s: tuple[Number, ...] = _of("campbell/rotation")
    advance_speed_m_s: tuple[Number, ...] = _of("campbell/advance_speed")
    branches: tuple[BranchSummary, ...] = Field(description="modes over the speed of the shaft")
    crossings: tuple[CrossingSummary, ...] = Field(description="in ascending speed")


class SoundPowerSummary(_Part):
    """Sound power through the outer sphere."""

    frequency_hz: tuple[float, ...] = _of("C*/spectrum/frequency")
    C0_db: tuple[Number, ...] = _of("C*/spectrum/power_level", "at rest; empty if not computed")
    C1_db: tuple[Number, ...] = _of("C*/spectrum/power_level", "deformed; empty if not computed")
    signal: str = _of("C*/excitations/signal")
    level_reference: str = Field(description="reference of the levels: 1 pW, or 1 pW/Hz if random")
    radiation_condition: str = _of("C*/radiation_condition")
    outer_radius_m: Number = _of("C*/outer_radius")
    kr_min: Number = Field(description="least wave number times outer radius in the band")
    sweep: str = _of("C*/sweep/method")
    largest_estimate_db: Number = _of("C*/sweep/largest_estimate", "of both configurations")
    C0_mean_db: Number = _of("C*/bands/mean_level", "at rest")
    C1_mean_db: Number = _of("C*/bands/mean_level", "deformed")
    kr_max: Number = Field(description="greatest wave number times outer radius in the band")
    max_surface_difference_db: Number = Field(
        description="largest difference of the levels from sphere and wetted surface [dB]"
    )
    max_multipole_difference_db: Number = Field(
        description="largest difference of the levels from sphere and multipoles, which do not "
        "depend on the radiation condition's reflections [dB]"
    )


class PatternSummary(_Part):
    """Sound at one frequency: a peak, or a frequency that was asked for."""

    mode: str = Field(description="wet mode that makes the peak, or empty")
    frequency_hz: Number = _of("C*/directivity/frequency")
    level_db: Number = Field(description="sound power level [dB re 1 pW, or 1 pW/Hz if random]")
    source_level_db: Number = _of("C*/directivity/source_level")
    width_hz: Number = _of("C*/peaks/width", "of a peak")
    estimate_db: Number = _of("C*/peaks/estimate", "of a peak")
    efficiency: Number = _of("C*/directivity/efficiency")
    monopole: Number = Field(description="share of the monopole in the power")
    dipole: Number = Field(description="share of the dipole")
    quadrupole: Number = Field(description="share of the quadrupole")
    higher: Number = Field(description="share of all higher degrees")
    index_db: Number = _of("C*/directivity/index")
    loudest: Vector = _of("C*/directivity/loudest")


class BandSummary(_Part):
    """Levels of one band."""

    centre_hz: Number = _of("C*/bands/centre")
    level_db: Number = _of("C*/bands/level")
    source_level_db: Number = _of("C*/bands/source_level")


class ConfigurationSound(_Part):
    """Sound of one configuration; empty if it was not computed."""

    mean_level_db: Number = _of("C*/bands/mean_level")
    mean_source_level_db: Number = _of("C*/bands/mean_source_level")
    largest_condition_error_db: Number = _of("C*/far_field/condition_error", "the largest")
    peaks: tuple[PatternSummary, ...] = Field(description="peaks of the radiated power")
    given: tuple[PatternSummary, ...] = Field(description="frequencies that the case names")
    bands: tuple[BandSummary, ...] = Field(description="bands that the frequencies cover")


class FarFieldSummary(_Part):
    """What leaves, by peaks and bands."""

    origin: str = _of("C*/far_field/origin")
    band_kind: str = _of("C*/bands/kind")
    distance_m: Number = _of("C*/directivity/distance", "null if infinite")
    source_level_reference: str = Field(
        description="reference of the source levels: 1 uPa m, or 1 uPa m/sqrt(Hz) if random"
    )
    C0: ConfigurationSound
    C1: ConfigurationSound


class LimitSummary(_Part):
    """One limit in one configuration."""

    name: str = _of("C*/limits/name")
    quantity: str = _of("C*/limits/quantity")
    bands: str = _of("C*/limits/bands")
    configuration: str = Field(description="C0 or C1")
    worst_excess_db: Number = _of("C*/limits/worst_excess")
    worst_frequency_hz: Number = _of("C*/limits/worst_frequency")
    exceeded: bool | None = Field(description="null if the limit does not touch the band")


class PeakSharesSummary(_Part):
    """Where the power goes at one peak of the sound power."""

    frequency_hz: Number = _of("C*/dissipation/peak_frequency")
    share: dict[str, Number] = _of("C*/dissipation/peak_share", "by region, and of the water")


class PowerSharesSummary(_Part):
    """Where the power goes in one configuration."""

    mean: dict[str, Number] = _of("C*/dissipation/mean_share", "by region, and of the water")
    peaks: tuple[PeakSharesSummary, ...] = Field(description="the same at each peak")


class PowerPathsSummary(_Part):
    """Where the power of the excitation goes."""

    C0: PowerSharesSummary
    C1: PowerSharesSummary


class ModulusSummary(_Part):
    """A complex modulus that is more than a constant loss factor."""

    name: str = _of("moduli/name")
    model: str = _of("moduli/model")
    temperature_k: Number = _of("moduli/temperature")
    storage_ratio: tuple[Number, Number] = Field(
        description="storage modulus over the static one, at the ends of the band"
    )
    loss_factor: tuple[Number, Number] = Field(description="loss factor there")
    fit_error: Number = _of("moduli/fit_error")


class ExcitationSummary(_Part):
    """One load."""

    name: str = _of("C*/excitations/name")
    kind: str = _of("C*/excitations/kind")
    unit: str = _of("C*/excitations/unit")
    amplitude: Number = _of("C*/excitations/amplitude", "the largest in the band")
    C0_mean_db: Number = _of("C*/excitations/mean_level", "at rest")
    C1_mean_db: Number = _of("C*/excitations/mean_level", "deformed")


class TransferFigures(_Part):
    """Transfer functions of one configuration; null or empty where they were not asked for."""

    largest_mobility: dict[str, Number] = _of("C*/transfer/mobility", "largest by load")
    largest_power_per_force: dict[str, Number] = _of(
        "C*/transfer/power_per_force", "largest by load"
    )
    largest_root_force_n: Number = _of("C*/transfer/root_force", "largest over the band")
    largest_root_moment_nm: Number = _of("C*/transfer/root_moment", "largest over the band")
    mean_shaft_db: Number = Field(
        description="level of the mean power into the shaft over the band [dB re 1 pW, or 1 pW/Hz]"
    )


class TransferSummary(_Part):
    """Transfer functions of both configurations."""

    functions: tuple[str, ...] = _of("C*/transfer/functions")
    C0: TransferFigures = Field(description="at rest")
    C1: TransferFigures = Field(description="deformed by the steady load")


class BalanceSummary(_Part):
    """How well the energy balances, over both configurations."""

    max_relative_residual: Number = _of("C*/spectrum/balance_residual", "the largest")
    max_solver_residual: Number = _of("C*/spectrum/solver_residual", "the largest")


class CellSummary(_Part):
    """Cells of one kind in one region."""

    region: str = _of("mesh/cells/region")
    kind: str = _of("mesh/cells/kind")
    count: int = _of("mesh/cells/count")


class MeshSummary(_Part):
    """The mesh."""

    nodes: int = _of("mesh/nodes")
    cells: tuple[CellSummary, ...] = Field(description="census of the cells")
    worst_quality: dict[str, Number] = _of("mesh/quality/worst", "by region")
    unknowns_by_part: dict[str, int] = _of("mesh/unknowns/count")


class ClaimSummary(_Part):
    """A claim of the paper beside the computed value."""

    id: str = Field(description="stable name")
    statement: str = Field(description="what it is about")
    paper: str = Field(description="what the paper says")
    computed: str = Field(description="what was computed")
    criterion: str = Field(description="when the two agree")
    value: Number = Field(description="figure that the judgement rests on")
    agrees: bool | None = Field(description="null if it was not computed")
    low: Number = Field(description="values above agree; null without a least value")
    high: Number = Field(description="values below agree; null without a greatest value")


class RunSummary(_Part):
    """Where the result comes from."""

    created: str = _of("run/created")
    platform: str = _of("run/platform")
    threads: int = _of("run/threads")
    code_version: str = _of("run/code_version")
    content_key: str = _of("run/content_key")
    packages: dict[str, str] = Field(description="version by package")
    solvers: tuple[str, ...] = Field(description="linear solvers that were used")
    fallbacks: tuple[str, ...] = _of("run/fallbacks/event")


class CostSummary(_Part):
    """What the stages cost."""

    factorization_s: Number = _of("run/cost/factorization")
    memory_b: dict[str, Number] = _of("run/cost/memory", "by stage")
    kept: tuple[str, ...] = Field(description="stages that an earlier run has computed")


class Summary(_Part):
    """The headline figures of a run."""

    title: str = _of("title")
    blade: str = _of("blade")
    static: StaticSummary | None = Field(description="null of a body that is no blade")
    performance: PerformanceSummary | None = Field(description="null of a body that is no blade")
    strength: StrengthSummary | None = Field(description="null of a body that is no blade")
    modes: ModesSummary
    campbell: CampbellSummary
    sound_power: SoundPowerSummary
    far_field: FarFieldSummary
    limits: tuple[LimitSummary, ...] = Field(description="limits of the case by configuration")
    power_paths: PowerPathsSummary
    moduli: tuple[ModulusSummary, ...] = Field(
        description="complex moduli that are more than a constant loss factor"
    )
    excitations: tuple[ExcitationSummary, ...] = Field(description="loads, as in the case")
    transfer: TransferSummary
    balance: BalanceSummary
    mesh: MeshSummary
    unknowns: int = Field(description="free unknowns of step 2")
    timings_s: dict[str, float] = _of("run/timings/seconds", "and their sum as `total`")
    cost: CostSummary
    notices: tuple[str, ...] = Field(description="warnings")
    claims: tuple[ClaimSummary, ...] = Field(
        description="claims of the paper; empty unless the case stands for one of its blades"
    )
    run: RunSummary
