# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sound of a case about one configuration: response over the band, and where its power goes."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from quietblade.card import Card, Shown, shortened
from quietblade.case import AnyCase
from quietblade.errors import Notice
from quietblade.linalg import SolverReport
from quietblade.study.far_field import FarField, Samples, solve_far_field
from quietblade.study.transfer import LoadPowers, Transfer, solve_transfer
from quietblade.study.vibration import Vibration, symmetric_solver
from quietblade.typing import ComplexArray, FloatArray, IntArray, Progress
from quietblade.vibroacoustics.combined import Combined
from quietblade.vibroacoustics.multipoles import Multipoles
from quietblade.vibroacoustics.operators import Operators
from quietblade.vibroacoustics.peaks import Peaks, find_peaks, peaks_on_grid
from quietblade.vibroacoustics.power import PowerBudget, level
from quietblade.vibroacoustics.radiation_check import radiation_notices
from quietblade.vibroacoustics.reduced import Certificate
from quietblade.vibroacoustics.stepped import SteppedPeaks, stepped_peaks
from quietblade.vibroacoustics.sweep import solve_response


@dataclass(frozen=True, eq=False, repr=False)
class Sound(Shown):
    """Response over frequency and where its power goes.

    Attributes
    ----------
    name : str
        ``C0`` or ``C1``.
    frequency : (f,) float array
        [Hz]
    budget : PowerBudget
        Injected, radiated and dissipated power [W].
    lost : mapping of str to (f,) float array
        Dissipated power by lossy part [W].
    loads : LoadPowers
        What each load does.
    transfer : Transfer or None
        Transfer functions, if the case asks for them.
    waves : tuple of Multipoles
        Outgoing waves by the Kirchhoff-Helmholtz integral, of each independent part of the
        excitation; their powers add.
    residual : (f,) float array
        ``||A x - b|| / ||b||`` of the whole system, nan in a reduced sweep.
    estimate : (f,) float array
        Estimated error of the power level by the reduced model [dB], nan in a direct sweep.
    snapshots : (k,) float array
        Frequencies near the damped modes [Hz], with ``solutions`` (k, n) there; none if the loads
        are independent, which have no common response.
    solutions : (k, n) complex array
    report : SolverReport
        What the solvers did in the sweep.
    failures : mapping of float to str
        Frequencies that could not be solved [Hz], and why.
    peaks : Peaks
        Maxima of the reduced model, or the loudest of three neighbours of a direct sweep.
    far : FarField
        What leaves, and where to.
    certificate : Certificate or None
        Of a reduced sweep.
    stepped : SteppedPeaks or None
        The peaks of a reduced sweep as sweeps in even steps would show them.
    notices : tuple of Notice
    """

    name: str
    frequency: FloatArray
    budget: PowerBudget
    lost: Mapping[str, FloatArray]
    loads: LoadPowers
    transfer: Transfer | None
    waves: tuple[Multipoles, ...]
    residual: FloatArray
    estimate: FloatArray
    snapshots: FloatArray
    solutions: ComplexArray
    report: SolverReport
    peaks: Peaks
    far: FarField
    failures: Mapping[float, str] = field(default_factory=dict)
    certificate: Certificate | None = None
    stepped: SteppedPeaks | None = None
    notices: tuple[Notice, ...] = ()

    def card(self) -> Card:
        """Peaks of the radiated power."""
        peaks = self.peaks
        rows = [
            tuple(f"{x:.5g}" for x in row)
            for row in zip(peaks.frequency, level(peaks.power), peaks.width, strict=True)
        ]
        low, high = self.frequency[[0, -1]]
        return Card(
            f"Sound of {self.name}: {len(self.frequency)} frequencies, {low:g} to {high:g} Hz",
            shortened(rows),
            ("peak [Hz]", "level [dB re 1 pW; random loads: 1 pW/Hz]", "half-power width [Hz]"),
        )


def solve_sound(
    case: AnyCase, vibration: Vibration, frequency: FloatArray, progress: Progress
) -> Sound:
    """Find response and powers at the frequencies [Hz], by the sweep that the case asks for."""
    if vibration.sweep is None:
        return _direct(case, vibration, frequency, progress)
    return _reduced(case, vibration, frequency, progress)


def _direct(
    case: AnyCase, vibration: Vibration, frequency: FloatArray, progress: Progress
) -> Sound:
    """One factorisation a frequency."""
    operators = vibration.operators
    solver = symmetric_solver(case)
    excited, count = vibration.excited, len(vibration.excited.drives)
    response = solve_response(operators, frequency, excited.every, solver=solver, progress=progress)
    every = response.solution
    assert every is not None  # nothing observed: the solutions are kept
    combined = Combined(
        operators, response.omega, every[:, :count], excited.vectors, excited.parts(frequency)
    )
    sources, budget = vibration.sources, combined.budget
    waves = tuple(sources.multipoles(response.omega, x) for x in combined.responses)
    solved = tuple(part.only(np.isfinite(budget.radiated)) for part in waves)
    peaks = peaks_on_grid(frequency, budget.radiated)
    asked = _patterns(case, peaks)
    there = np.searchsorted(frequency, asked)
    far = solve_far_field(
        case,
        vibration,
        Samples(response.omega, tuple(combined.responses), sources),
        Samples(response.omega[there], tuple(combined.responses[:, there]), sources),
        len(peaks.frequency),
    )
    snapshots = _snapshots(_nearest(frequency, vibration.damped.frequency), combined)
    failed = [
        Notice(f"sweep {vibration.name}", f"no solution at {f:.6g} Hz: {why}")
        for f, why in response.failures.items()
    ]
    return Sound(
        name=vibration.name,
        frequency=frequency,
        budget=budget,
        lost=combined.lost,
        loads=LoadPowers.of(combined),
        transfer=solve_transfer(case, excited, combined, every[..., operators.blocks.held]),
        waves=waves,
        residual=response.residual,
        estimate=np.full(frequency.shape, np.nan),
        snapshots=frequency[snapshots],
        solutions=combined.responses[0][snapshots],
        report=response.report,
        peaks=peaks,
        far=far,
        failures=response.failures,
        notices=(
            *_wave_notices(operators, solved),
            *far.notices,
            *_coarse_step(vibration, frequency),
            *failed,
        ),
    )


def _reduced(
    case: AnyCase, vibration: Vibration, frequency: FloatArray, progress: Progress
) -> Sound:
    """Evaluate the certified reduced model of the configuration at all frequencies."""
    sweep = vibration.sweep
    assert sweep is not None
    operators, model, omega = vibration.operators, sweep.model, 2.0 * np.pi * frequency
    progress("sweep", 0.1, f"{len(frequency)} frequencies on {model.size} columns")
    excited, columns = vibration.excited, model.columns()
    sources = vibration.sources.on(columns)
    combined = excited.combined(model, omega)
    waves = tuple(sources.multipoles(omega, y) for y in combined.responses)
    progress("sweep", 0.6, "peaks")
    peaks = find_peaks(sweep, case.acoustics.band, lambda at: excited.combined(model, at).radiated)
    progress("sweep", 0.8, "far field")
    asked = 2.0 * np.pi * _patterns(case, peaks)
    at_asked = excited.combined(model, asked).responses if len(asked) else combined.responses[:, :0]
    far = solve_far_field(
        case,
        vibration,
        Samples(omega, tuple(combined.responses), sources, columns),
        Samples(asked, tuple(at_asked), sources, columns),
        len(peaks.frequency),
    )
    stepped = stepped_peaks(
        lambda f: excited.combined(model, 2.0 * np.pi * f).radiated,
        peaks.frequency,
        case.acoustics.band,
    )
    _, _, held = model.space.places
    snapshots = _snapshots(_nearest(frequency, vibration.damped.frequency), combined)
    return Sound(
        name=vibration.name,
        frequency=frequency,
        budget=combined.budget,
        lost=combined.lost,
        loads=LoadPowers.of(combined),
        transfer=solve_transfer(case, excited, combined, model.coordinates(omega)[..., held]),
        waves=waves,
        residual=np.full(frequency.shape, np.nan),
        estimate=sweep.estimate(frequency),
        snapshots=frequency[snapshots],
        solutions=combined.responses[0][snapshots] @ columns,
        report=sweep.report,
        peaks=peaks,
        far=far,
        certificate=sweep.certificate,
        stepped=stepped,
        notices=(
            *_wave_notices(operators, waves),
            *far.notices,
        ),
    )


def _patterns(case: AnyCase, peaks: Peaks) -> FloatArray:
    """Frequencies whose directivity is told [Hz]: the peaks, then those of the case."""
    return np.concatenate([peaks.frequency, np.array(case.far_field.frequencies)])


def _nearest(frequency: FloatArray, wanted: FloatArray) -> IntArray:
    """Places of the frequencies nearest to those wanted inside the band, each once."""
    inside = wanted[(wanted >= frequency[0]) & (wanted <= frequency[-1])]
    return np.unique([int(np.argmin(np.abs(frequency - f))) for f in inside]).astype(np.int64)


def _snapshots(nearest: IntArray, combined: Combined) -> IntArray:
    """Places of the responses to be kept; loads that are independent have none in common."""
    return nearest if len(combined.parts) == 1 else nearest[:0]


def _wave_notices(operators: Operators, waves: tuple[Multipoles, ...]) -> list[Notice]:
    """Notices on the outgoing waves of all parts, each once."""
    found = [
        notice
        for part in waves
        for notice in (
            *part.notices(),
            *radiation_notices(operators.condition, operators.radius, part),
        )
    ]
    return list(dict.fromkeys(found))


def _coarse_step(vibration: Vibration, frequency: FloatArray) -> list[Notice]:
    """Say which needles a direct sweep misses between its frequencies."""
    damped = vibration.damped
    width = damped.frequency * np.abs(damped.loss_factor)
    found = []
    for f, w in zip(damped.frequency, width, strict=True):
        if frequency[0] <= f <= frequency[-1]:
            distance = float(np.min(np.abs(frequency - f)))
            if distance > 0.25 * w:
                found.append(
                    Notice(
                        f"sweep {vibration.name}",
                        f"the peak at {f:.5g} Hz, {w:.2g} Hz wide, lies between the frequencies; "
                        "distance of the nearest [Hz]",
                        distance,
                        0.25 * float(w),
                        'Use sweep = "reduced", or points_per_mode = 1 or more',
                    )
                )
    return found
