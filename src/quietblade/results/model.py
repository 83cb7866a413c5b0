# SPDX-License-Identifier: LGPL-2.1-or-later
"""The result of a study: plain arrays in SI units, nothing of the solvers that made them.

Every attribute is registered, with unit and meaning, in `quietblade.results.quantities`.
Angles are in rad. A number that was not computed is NaN, a text that does not apply is empty.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar, TypeVar

import numpy as np

from quietblade.card import Card
from quietblade.errors import Notice
from quietblade.results.excitations import RANDOM, ExcitationTable, TransferTable
from quietblade.results.mode_records import (
    CampbellDiagram,
    DryModes,
    LossShares,
    ModeCount,
    Participation,
)
from quietblade.results.quantities import CONFIGURATIONS, LABELS
from quietblade.results.record import Record
from quietblade.typing import BoolArray, ComplexArray, FloatArray, IntArray

if TYPE_CHECKING:
    import xarray as xr

NAN = float("nan")
AnyRecord = TypeVar("AnyRecord", bound=Record)
REFERENCE_POWER = 1e-12
"""Reference of sound power levels [W]."""


def state(name: str) -> int:
    """Index of a state of loading: ``rigid``, ``chained`` or ``coupled``."""
    return LABELS["state"].index(name)


def path(name: str) -> int:
    """Index of a path of the sound power: ``sphere``, ``wet_surface`` or ``multipoles``."""
    return LABELS["path"].index(name)


# --- step 1 -----------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False, repr=False)
class CouplingHistory(Record):
    """The loop between flow and structure, pass by pass."""

    group: ClassVar[str] = "static/history"
    relative_change: FloatArray
    tip_displacement: FloatArray
    lift: FloatArray
    error: FloatArray
    rate: FloatArray
    eigenvalue: ComplexArray
    fraction: FloatArray
    factorizations: IntArray


@dataclass(frozen=True, eq=False, repr=False)
class NewtonTable(Record):
    """Newton's method in the structure, step by step over the whole loop."""

    group: ClassVar[str] = "static/newton"
    coupling_iteration: IntArray
    fraction: FloatArray
    iteration: IntArray
    residual: FloatArray
    increment: FloatArray
    force: FloatArray
    motion: FloatArray
    new_tangent: BoolArray


@dataclass(frozen=True, eq=False, repr=False)
class SectionCurves(Record):
    """Curves along the span; rows are the states rigid, chained, coupled."""

    group: ClassVar[str] = "static/sections"
    span_fraction: FloatArray
    radius: FloatArray
    chord: FloatArray
    blade_angle: FloatArray
    camber: FloatArray
    incidence: FloatArray
    lift_coefficient: FloatArray
    lift_per_length: FloatArray
    warp: FloatArray
    reynolds: FloatArray
    drag_coefficient: FloatArray
    suction: FloatArray
    cavitation_number: FloatArray
    shedding_frequency: FloatArray


@dataclass(frozen=True, eq=False, repr=False)
class PerformanceFigures(Record):
    """Figures of the whole rotor; rows are the states rigid, chained, coupled."""

    group: ClassVar[str] = "static/performance"
    inflow: str
    friction: str
    blades: int
    advance_speed: float
    diameter: FloatArray
    thrust: FloatArray
    torque: FloatArray
    advance_ratio: FloatArray
    thrust_coefficient: FloatArray
    torque_coefficient: FloatArray
    efficiency: FloatArray
    inviscid_efficiency: FloatArray
    inception_depth: float
    inception_speed: float


@dataclass(frozen=True, eq=False, repr=False)
class StressTable(Record):
    """Largest stress and strain by region."""

    group: ClassVar[str] = "static/stress"
    region: tuple[str, ...]
    von_mises: FloatArray
    von_mises_p99: FloatArray
    von_mises_place: FloatArray
    principal_stress: FloatArray
    logarithmic_strain: FloatArray


@dataclass(frozen=True, eq=False, repr=False)
class FailureTable(Record):
    """Failure indices of the materials whose strength is known."""

    group: ClassVar[str] = "static/failure"
    region: tuple[str, ...]
    name: tuple[str, ...]
    value: FloatArray
    p99: FloatArray
    place: FloatArray


@dataclass(frozen=True, eq=False, repr=False)
class ReactionResult(Record):
    """Force and moment of the root, and how well forces balance."""

    group: ClassVar[str] = "static/reaction"
    force: FloatArray
    moment: FloatArray
    force_imbalance: float
    moment_imbalance: float
    transferred_force_error: float
    transferred_moment_error: float


@dataclass(frozen=True, eq=False, repr=False)
class LoadTable(Record):
    """Loads besides those of flow and spin."""

    group: ClassVar[str] = "static/loads"
    kind: tuple[str, ...]
    force: FloatArray
    moment: FloatArray


@dataclass(frozen=True, eq=False, repr=False)
class MidSection(Record):
    """Contours of the section at mid-span; rows are the states rigid, chained, coupled."""

    group: ClassVar[str] = "static/mid_section"
    span_fraction: float
    normalised: FloatArray
    placed: FloatArray


@dataclass(frozen=True, eq=False, repr=False)
class StaticResult(Record):
    """Step 1: the blade in equilibrium with the flow."""

    group: ClassVar[str] = "static"
    history: CouplingHistory
    newton: NewtonTable
    sections: SectionCurves
    performance: PerformanceFigures
    stress: StressTable
    failure: FailureTable
    reaction: ReactionResult
    loads: LoadTable
    mid_section: MidSection
    tip_displacement: FloatArray
    force: FloatArray
    moment: FloatArray
    lift: FloatArray
    thrust: FloatArray
    torque: FloatArray
    tolerance: float
    converged: bool
    coupling_method: str
    coupling_kind: str
    load_fraction: float
    divergence_ratio: float
    max_film_shear_strain: float = NAN
    film_shear_strain_p99: float = NAN
    max_film_shear_strain_place: FloatArray = field(default_factory=lambda: np.full(3, NAN))
    max_blade_shear_strain: float = NAN

    @property
    def iterations(self) -> int:
        """Passes of the coupling."""
        return len(self.history.lift)


def without_state(result: StaticResult, name: str) -> StaticResult:
    """Return the result with NaN in every row of a state that could not be computed."""

    def blanked(record: AnyRecord) -> AnyRecord:
        changes: dict[str, Any] = {}
        for quantity in record.quantities():
            if quantity.dims[:1] == ("state",):
                values = np.array(getattr(record, quantity.name))
                values[state(name)] = NAN
                changes[quantity.name] = values
        for member in fields(record):
            inner = getattr(record, member.name)
            if isinstance(inner, Record):
                changes[member.name] = blanked(inner)
        return replace(record, **changes)

    return blanked(result)


# --- step 2 -----------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False, repr=False)
class ModeTable(Record):
    """Wet modes in ascending frequency."""

    group: ClassVar[str] = "C*/modes"
    name: tuple[str, ...]
    frequency: FloatArray
    loss_factor: FloatArray
    film_loss: FloatArray
    radiation_loss: FloatArray
    purity: FloatArray
    partner: tuple[str, ...]
    partner_mac: FloatArray
    participation: FloatArray


@dataclass(frozen=True, eq=False, repr=False)
class Spectrum(Record):
    """Response to all excitations. A frequency that could not be solved is NaN.

    ``power_by_degree`` has no rows if the multipoles were not computed.
    """

    group: ClassVar[str] = "C*/spectrum"
    frequency: FloatArray
    power: FloatArray
    power_by_degree: FloatArray
    injected: FloatArray
    dissipated: FloatArray
    solver_residual: FloatArray
    error_estimate: FloatArray
    mobility: ComplexArray

    def __post_init__(self) -> None:
        super().__post_init__()
        if np.any(np.diff(self.frequency) <= 0.0):
            raise ValueError("C*/spectrum/frequency: frequencies must ascend")

    @property
    def power_level(self) -> FloatArray:
        """Sound power level [dB re 1 pW] by path; NaN where the power is not positive."""
        audible = np.where(self.power > 0.0, self.power, NAN)
        return np.asarray(10.0 * np.log10(audible / REFERENCE_POWER), dtype=np.float64)

    @property
    def balance_residual(self) -> FloatArray:
        """|injected - radiated through the sphere - dissipated| / injected."""
        error = self.injected - self.power[path("sphere")] - self.dissipated
        return np.asarray(np.abs(error / self.injected), dtype=np.float64)


@dataclass(frozen=True, eq=False, repr=False)
class Dissipation(Record):
    """Where the injected power goes: each lossy region, and the water."""

    group: ClassVar[str] = "C*/dissipation"
    sink: tuple[str, ...]
    power: FloatArray
    mean_share: FloatArray
    peak_frequency: FloatArray
    peak_share: FloatArray


@dataclass(frozen=True, eq=False, repr=False)
class SweepRecord(Record):
    """How the spectrum was made."""

    group: ClassVar[str] = "C*/sweep"
    method: str
    accuracy: float
    largest_estimate: float
    vectors: int
    columns: int
    factorizations: int


@dataclass(frozen=True, eq=False, repr=False)
class PeakTable(Record):
    """Peaks of the radiated power."""

    group: ClassVar[str] = "C*/peaks"
    frequency: FloatArray
    power_level: FloatArray
    width: FloatArray
    estimate: FloatArray


@dataclass(frozen=True, eq=False, repr=False)
class SteppedTable(Record):
    """The peaks as sweeps in even steps would show them; empty of a direct sweep."""

    group: ClassVar[str] = "C*/stepped"
    step: FloatArray
    power_level: FloatArray
    worst_level: FloatArray

    @classmethod
    def none(cls) -> "SteppedTable":
        """Return the table of a sweep whose true peaks are not known."""
        return cls(np.zeros(0), np.zeros((0, 0)), np.zeros((0, 0)))


@dataclass(frozen=True, eq=False, repr=False)
class BandTable(Record):
    """Mean power by band and over all."""

    group: ClassVar[str] = "C*/bands"
    kind: str
    centre: FloatArray
    lower: FloatArray
    upper: FloatArray
    level: FloatArray
    source_level: FloatArray
    mean_level: float
    mean_source_level: float


@dataclass(frozen=True, eq=False, repr=False)
class FarFieldResult(Record):
    """What leaves over frequency, and the sound pressure at points."""

    group: ClassVar[str] = "C*/far_field"
    origin: str
    frequency: FloatArray
    kr: FloatArray
    source_level: FloatArray
    efficiency: FloatArray
    share: FloatArray
    condition_error: FloatArray
    place: FloatArray
    pressure: ComplexArray

    @property
    def pressure_level(self) -> FloatArray:
        """Level of the sound pressure [dB re 1 uPa], minus infinity for silence."""
        with np.errstate(divide="ignore"):
            return np.asarray(20.0 * np.log10(np.abs(self.pressure) / np.sqrt(2.0) / 1e-6))


@dataclass(frozen=True, eq=False, repr=False)
class DirectivityResult(Record):
    """Sound by direction at the peaks and at the frequencies asked for."""

    group: ClassVar[str] = "C*/directivity"
    frequency: FloatArray
    reason: tuple[str, ...]
    source_level: FloatArray
    efficiency: FloatArray
    share: FloatArray
    index: FloatArray
    loudest: FloatArray
    centre: FloatArray
    distance: float
    cut: tuple[str, ...]
    angle: FloatArray
    cut_level: FloatArray
    polar: FloatArray
    azimuth: FloatArray
    level: FloatArray
    product: ComplexArray


@dataclass(frozen=True, eq=False, repr=False)
class LimitTable(Record):
    """Levels against the limits of the case, each with its rows of frequencies."""

    group: ClassVar[str] = "C*/limits"
    name: tuple[str, ...]
    quantity: tuple[str, ...]
    bands: tuple[str, ...]
    worst_excess: FloatArray
    worst_frequency: FloatArray
    row_of: IntArray
    frequency: FloatArray
    found: FloatArray
    allowed: FloatArray

    @property
    def excess(self) -> FloatArray:
        """By how much the levels are above the limit [dB]; nan where there is none."""
        return np.asarray(self.found - self.allowed)


@dataclass(frozen=True, eq=False, repr=False)
class ConfigurationResult(Record):
    """Step 2 about one configuration, C0 or C1."""

    group: ClassVar[str] = "C*"
    modes: ModeTable
    mode_count: ModeCount
    loss_shares: LossShares
    participation: Participation
    dry_modes: DryModes
    spectrum: Spectrum
    dissipation: Dissipation
    sweep: SweepRecord
    peaks: PeakTable
    stepped: SteppedTable
    bands: BandTable
    far_field: FarFieldResult
    directivity: DirectivityResult
    limits: LimitTable
    excitations: ExcitationTable
    transfer: TransferTable
    radiation_condition: str
    outer_radius: float
    sound_speed: float
    water_density: float
    excitation_pressure: float
    excitation_area: float

    @property
    def random(self) -> bool:
        """Whether powers are spectral densities, per hertz."""
        return self.excitations.signal == RANDOM

    @property
    def kr(self) -> FloatArray:
        """Wave number times outer radius, at the frequencies of the spectrum."""
        k = 2.0 * np.pi * self.spectrum.frequency / self.sound_speed
        return np.asarray(k * self.outer_radius, dtype=np.float64)


@dataclass(frozen=True, eq=False, repr=False)
class ModulusTable(Record):
    """Complex moduli of the regions whose loss is more than a number."""

    group: ClassVar[str] = "moduli"
    name: tuple[str, ...]
    model: tuple[str, ...]
    static: FloatArray
    temperature: FloatArray
    shift: FloatArray
    fit_error: FloatArray
    band: FloatArray
    band_ratio: ComplexArray
    frequency: FloatArray
    ratio: ComplexArray
    measured_modulus: IntArray
    measured_frequency: FloatArray
    measured_ratio: ComplexArray


# --- mesh and run -----------------------------------------------------------------------------


@dataclass(frozen=True, eq=False, repr=False)
class CellCensus(Record):
    """Number of cells by region and kind."""

    group: ClassVar[str] = "mesh/cells"
    region: tuple[str, ...]
    kind: tuple[str, ...]
    count: IntArray


@dataclass(frozen=True, eq=False, repr=False)
class MeshQuality(Record):
    """Shape figures of the cells by region."""

    group: ClassVar[str] = "mesh/quality"
    region: tuple[str, ...]
    worst: FloatArray
    mean: FloatArray
    least_jacobian: FloatArray


@dataclass(frozen=True, eq=False, repr=False)
class Unknowns(Record):
    """Free unknowns of step 2 by part."""

    group: ClassVar[str] = "mesh/unknowns"
    part: tuple[str, ...]
    count: IntArray


@dataclass(frozen=True, eq=False, repr=False)
class MeshResult(Record):
    """The mesh in figures."""

    group: ClassVar[str] = "mesh"
    nodes: int
    cells: CellCensus
    quality: MeshQuality
    unknowns: Unknowns


@dataclass(frozen=True, eq=False, repr=False)
class Packages(Record):
    """Versions of the packages that the result depends on."""

    group: ClassVar[str] = "run/packages"
    name: tuple[str, ...]
    version: tuple[str, ...]


@dataclass(frozen=True, eq=False, repr=False)
class Timings(Record):
    """Wall-clock time by stage."""

    group: ClassVar[str] = "run/timings"
    stage: tuple[str, ...]
    seconds: FloatArray


@dataclass(frozen=True, eq=False, repr=False)
class Cost(Record):
    """What the stages of `Timings` cost besides time."""

    group: ClassVar[str] = "run/cost"
    stage: tuple[str, ...]
    kept: BoolArray
    memory: FloatArray
    factorization: float = NAN


@dataclass(frozen=True, eq=False, repr=False)
class SolverReport(Record):
    """Linear solvers by use."""

    group: ClassVar[str] = "run/solvers"
    use: tuple[str, ...]
    solver: tuple[str, ...]
    factorizations: IntArray
    worst_residual: FloatArray
    peak_memory: FloatArray


@dataclass(frozen=True, eq=False, repr=False)
class Fallbacks(Record):
    """Changes of the linear solver during the run."""

    group: ClassVar[str] = "run/fallbacks"
    event: tuple[str, ...]


@dataclass(frozen=True, eq=False, repr=False)
class NoticeTable(Record):
    """Warnings of the run."""

    group: ClassVar[str] = "run/notices"
    where: tuple[str, ...]
    message: tuple[str, ...]
    value: FloatArray
    limit: FloatArray
    remedy: tuple[str, ...]

    @classmethod
    def of(cls, notices: tuple[Notice, ...]) -> "NoticeTable":
        """Make the table from `Notice` objects."""
        return cls(
            where=tuple(n.where for n in notices),
            message=tuple(n.message for n in notices),
            value=np.array([NAN if n.value is None else n.value for n in notices], dtype=float),
            limit=np.array([NAN if n.limit is None else n.limit for n in notices], dtype=float),
            remedy=tuple(n.remedy for n in notices),
        )

    def notices(self) -> tuple[Notice, ...]:
        """Return the `Notice` objects again."""
        rows = zip(self.where, self.message, self.value, self.limit, self.remedy, strict=True)
        return tuple(
            Notice(where, message, _known(value), _known(limit), remedy)
            for where, message, value, limit, remedy in rows
        )


@dataclass(frozen=True, eq=False, repr=False)
class RunRecord(Record):
    """Provenance: what made the result, on what, in which time, with which warnings."""

    group: ClassVar[str] = "run"
    created: str
    platform: str
    threads: int
    code_version: str
    content_key: str
    case_text: str
    packages: Packages
    timings: Timings
    cost: Cost
    solvers: SolverReport
    fallbacks: Fallbacks
    notices: NoticeTable


@dataclass(frozen=True, eq=False, repr=False)
class Result(Record):
    """A whole study of one blade, or of another body.

    Attributes
    ----------
    title : str
        Title of the case.
    blade : str
        ``aluminium`` or ``composite`` if the case stands for one of the paper's blades, or empty.
    static : StaticResult or None
        None of a body that is no blade: it has no step 1.
    configurations : mapping
        `ConfigurationResult` by name, C0 and C1 or those that were computed, with the
        frequencies of the spectra in common.
    moduli : ModulusTable
    mesh : MeshResult
    run : RunRecord
    campbell : CampbellDiagram
    """

    group: ClassVar[str] = ""
    title: str
    blade: str
    static: StaticResult | None
    configurations: Mapping[str, ConfigurationResult]
    moduli: ModulusTable
    mesh: MeshResult
    run: RunRecord
    campbell: CampbellDiagram = field(default_factory=CampbellDiagram.none)

    @property
    def steady(self) -> StaticResult:
        """Step 1 of a blade.

        Raises
        ------
        ValueError
            The result is of another body.
        """
        if self.static is None:
            raise ValueError("a body that is no blade has no steady load: its `static` is None")
        return self.static

    @property
    def converged(self) -> bool:
        """Whether step 1 converged, where there is one."""
        return self.static is None or self.static.converged

    def card(self) -> Card:
        """Headline figures."""
        from quietblade.results.headline import result_card  # noqa: PLC0415  # made of results

        return result_card(self)

    def to_xarray(self) -> "xr.DataTree":
        """Return everything that ``result.nc`` holds, as labelled arrays with units."""
        from quietblade.results.dataset import to_tree  # noqa: PLC0415  # made of results

        return to_tree(self)

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.static is None and "C1" in self.configurations:
            raise ValueError("C1 is the state under a steady load, and there is no such load")
        unknown = set(self.configurations) - set(CONFIGURATIONS)
        if unknown:
            raise ValueError(f"configurations {sorted(unknown)}; there are {CONFIGURATIONS}")
        ordered = {
            name: self.configurations[name]
            for name in CONFIGURATIONS
            if name in self.configurations
        }
        object.__setattr__(self, "configurations", MappingProxyType(ordered))
        grids = [c.spectrum.frequency for c in ordered.values()]
        if any(not np.array_equal(grid, grids[0]) for grid in grids):
            raise ValueError("the spectra of C0 and C1 must share their frequencies")


def _known(value: float) -> float | None:
    return None if np.isnan(value) else float(value)
