# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sweep by a reduced model: few factorisations, any number of frequencies, a known error.

The solutions of A(omega) x = b over a band lie almost in the space of the Krylov vectors around
one frequency (`krylov`), and the Galerkin projection on that space (`projection`) gives them.  The
space grows until the sound power at every frequency asked for has settled (theory: S2-61).
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import islice, pairwise, zip_longest

import numpy as np

from quietblade.errors import ConvergenceError
from quietblade.linalg import Factorization, SolverChain, SolverReport, make_solver
from quietblade.materials.viscoelastic import ModulusRatio
from quietblade.typing import AnyArray, ComplexArray, FloatArray, Progress, silent
from quietblade.vibroacoustics.krylov import krylov_vectors
from quietblade.vibroacoustics.operators import Blocks, Operators
from quietblade.vibroacoustics.power import PowerBudget, power_budget, radiated_power
from quietblade.vibroacoustics.projection import Projection
from quietblade.vibroacoustics.radiation import RadiationCondition

ASIDE = 1.0 + 0.02j
"""Factor from the middle of the band to the omega of the factor: there A is not nearly singular."""

_DECIBEL = 10.0 / np.log(10.0)
_JUDGED = 3  # successive models whose powers must agree
_LEAST = 4  # vectors before the first judgement
_LIGHT = 0.2  # loss factor up to which a mode can make a needle
_OFF = 0.95  # of the range in which modes with interpolated factors are looked for
_SETTLED = 1e-9  # relative change of such a mode's frequency at which it is good enough
_LOWEST = 1e-3  # of a band's upper end: below it no mode is looked for
_EDGE = 1e-12  # by which the upper end of a band is widened, to be inside
_AT_ONCE = 64  # frequencies whose matrices are in memory together
_STAGE = "reduced model"


@dataclass(frozen=True, eq=False)
class ReducedOperators:
    """The terms of A(omega) on the columns of a projection; what the powers are computed from."""

    terms: Mapping[str, AnyArray]
    moduli: Mapping[str, ModulusRatio]
    blocks: Blocks
    condition: RadiationCondition
    sound_speed: float
    density: float
    radius: float


@dataclass(frozen=True, eq=False)
class ReducedModel:
    """A(omega) x = b on a small space.

    Attributes
    ----------
    operators : Operators
        The whole system.
    space : Projection
        Space whose first columns are used; not to be extended any more.
    load : (n,) or (k, n) array
        Right-hand side, or several of them.
    size : int
        Number of columns.
    """

    operators: Operators
    space: Projection
    load: AnyArray
    size: int

    @cached_property
    def reduced_load(self) -> AnyArray:
        """V^T b, (size,) or (k, size)."""
        return self.space.restricted(self.load.T)[: self.size].T

    @cached_property
    def reduced_operators(self) -> ReducedOperators:
        """Terms on the columns."""
        kept = slice(self.size)
        solid, water, held = (place[place < self.size] for place in self.space.places)
        whole = self.operators
        return ReducedOperators(
            terms={name: term[kept, kept] for name, term in self.space.terms.items()},
            moduli=whole.moduli,
            blocks=Blocks(solid, solid[:0], water, root=held),
            condition=whole.condition,
            sound_speed=whole.sound_speed,
            density=whole.density,
            radius=whole.radius,
        )

    def coordinates(self, omega: FloatArray) -> ComplexArray:
        """Solutions in the columns, (f, size) or (f, k, size), at angular frequencies [rad/s]."""
        load = self.reduced_load.reshape(-1, self.size).T.astype(complex)
        at = np.atleast_1d(omega)
        if len(at) == 0:
            return np.zeros((0, *self.load.shape[:-1], self.size), dtype=np.complex128)
        rows = [
            np.linalg.solve(self.space.at_each(part, self.size), load).swapaxes(1, 2)
            for part in np.array_split(at, max(1, -(-len(at) // _AT_ONCE)))
        ]
        return np.concatenate(rows).reshape(len(at), *self.load.shape[:-1], self.size)

    def columns(self) -> FloatArray:
        """Vectors (size, n) that the coordinates are factors of."""
        return np.asarray(self.space.lift(np.eye(self.space.size)[: self.size]))

    def solution(self, omega: FloatArray) -> ComplexArray:
        """Solutions (f, n) or (f, k, n) on all unknowns."""
        return np.asarray(self.space.lift(self.coordinates(omega)))

    def budget(self, omega: FloatArray) -> PowerBudget:
        """Injected, radiated and dissipated powers (f,) or (f, k) [W]."""
        y = self.coordinates(omega)
        return power_budget(self.reduced_operators, self._beside(omega), y, self.reduced_load)

    def radiated(self, omega: FloatArray) -> FloatArray:
        """Power through the sphere (f,) or (f, k) [W]."""
        return radiated_power(self.reduced_operators, self._beside(omega), self.coordinates(omega))

    def combined(self, amplitude: AnyArray) -> "ReducedModel":
        """Model of the load sum_k amplitude_k b_k, for amplitudes (k,)."""
        return replace(self, load=np.asarray(amplitude) @ self.load)

    def _beside(self, omega: FloatArray) -> FloatArray:
        """Angular frequencies in the shape (f,) or (f, k) of the powers."""
        at = np.atleast_1d(omega)
        beside = at.reshape(-1, *[1] * (self.load.ndim - 1))
        return np.broadcast_to(beside, (len(at), *self.load.shape[:-1]))

    def work(self, omega: FloatArray) -> ComplexArray:
        """b^T x, (f,) or (f, k) [J]: what each load works on, times its amplitude."""
        return np.asarray(np.sum(self.coordinates(omega) * self.reduced_load, axis=-1))

    def residual(self, omega: float) -> float:
        """Worst ||A x - b|| / ||b|| of the whole system at an angular frequency [rad/s]."""
        (x,) = self.solution(np.array([omega]))
        defect = (self.operators.at(omega) @ x.T).T - self.load
        sizes = (np.linalg.norm(part, axis=-1) for part in (defect, self.load))
        return float(np.max(np.divide(*sizes)))

    def light_modes(self, band: tuple[float, float]) -> tuple[FloatArray, FloatArray]:
        """Frequencies Re Omega / 2 pi [Hz] in a band and loss factors of the model's own modes.

        Those that decay too fast to make a peak are left out; ascending.  Complex moduli and the
        sphere's factors are those at each mode's own Omega, however wide the band is.

        Raises
        ------
        ValueError
            If the band has no positive frequency, or its ends are not in order.
        """
        if not 0.0 <= band[0] <= band[1] or not 0.0 < band[1] < np.inf:
            raise ValueError(f"reduced model: {band[0]:g} to {band[1]:g} Hz is not a band")
        low, high = (2.0 * np.pi * max(f, _LOWEST * band[1]) for f in band)
        parts = max(1, int(np.ceil(np.log2(high / low))))
        limits = np.geomspace(low, high, parts + 1)
        limits[-1] *= 1.0 + _EDGE
        found = np.concatenate([self._light(*part) for part in pairwise(limits.tolist())])
        order = np.argsort(found.real)
        return found.real[order] / (2.0 * np.pi), (2.0 * found.imag / found.real)[order]

    def _light(self, low: float, high: float) -> ComplexArray:
        """Omega of the light modes from low to high [rad/s], an octave at most."""
        values, coordinates = self.space.eigenpairs(0.5 * (low + high), self.size)
        # their factors are interpolated from the middle: a mode may be a little off
        near = (values.real > _OFF * low) & (values.real < high / _OFF)
        near &= np.abs(values.imag) < _LIGHT * values.real
        refined = [
            self.space.refined(complex(value), vector, _SETTLED)[0]
            for value, vector in zip(values[near], coordinates[near], strict=True)
        ]
        omega = np.array(refined, dtype=np.complex128)
        light = np.abs(2.0 * omega.imag) < _LIGHT * omega.real
        return omega[light & (omega.real >= low) & (omega.real < high)]


@dataclass(frozen=True, eq=False)
class Certificate:
    """How a reduced model was made, and how good it is.

    Attributes
    ----------
    frequency : (f,) array
        Frequencies at which it was judged [Hz]: those asked for, and the model's resonances.
    estimate : (f,) array
        Estimate of the error of the radiated power level at each [dB]: the largest change of the
        level over the last two enlargements of the space.
    tolerance : float
        What was wanted [dB].
    vectors : int
        Krylov vectors of each load, one solve each.
    size : int
        Columns of the reduced model.
    expansion : tuple of float
        Frequencies of the factorisations [Hz].
    history : (vectors,) array
        Largest estimate after each vector [dB]; infinite before the first judgement.
    """

    frequency: FloatArray
    estimate: FloatArray
    tolerance: float
    vectors: int
    size: int
    expansion: tuple[float, ...]
    history: FloatArray

    @property
    def factorizations(self) -> int:
        """Factorisations of the whole system."""
        return len(self.expansion)


@dataclass(frozen=True, eq=False)
class ReducedSweep:
    """A certified reduced model, and the factor that served for it.

    Attributes
    ----------
    model : ReducedModel
    smaller : tuple of ReducedModel
        The models before the last two enlargements.
    certificate : Certificate
    factor : Factorization or None
        The last one made, unless it was given up.
    report : SolverReport
        What the solvers did.
    """

    model: ReducedModel
    smaller: tuple[ReducedModel, ...]
    certificate: Certificate
    factor: Factorization | None
    report: SolverReport

    def without_factor(self) -> "ReducedSweep":
        """Return the same sweep without the memory of its factor."""
        return replace(self, factor=None)

    def estimate(self, frequency: FloatArray) -> FloatArray:
        """Estimate of the error of the radiated power level (f,) [dB] at any frequencies [Hz]."""
        return error_estimate(self.model, self.smaller, 2.0 * np.pi * np.atleast_1d(frequency))


def error_estimate(
    model: ReducedModel, smaller: Sequence[ReducedModel], omega: FloatArray
) -> FloatArray:
    """Largest change of the radiated power level from smaller models of the same space (f,) [dB].

    The change from a smaller model to the larger one is what the residual of the smaller one
    makes in the larger space: the hierarchical estimate of the smaller one's error.  The larger
    one's error is less by the rate of convergence.  Of several loads it is the worst.
    """
    return _largest_change(model.radiated(omega), [other.radiated(omega) for other in smaller])


def _largest_change(power: FloatArray, others: Sequence[FloatArray]) -> FloatArray:
    """Largest difference of powers (f,) or (f, k) from others, as a level (f,) [dB]."""
    changes = [np.abs(power - other) for other in others]
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = np.max(changes, axis=0) / np.abs(power)
    estimate = np.where(np.isfinite(ratio), _DECIBEL * ratio, np.inf)
    return np.asarray(estimate.reshape(len(estimate), -1).max(axis=1))


def reduce_system(
    operators: Operators,
    load: AnyArray,
    frequency: FloatArray,
    *,
    tolerance: float = 0.01,
    solver: SolverChain | None = None,
    most_vectors: int = 40,
    most_factorizations: int = 3,
    progress: Progress = silent,
) -> ReducedSweep:
    """Make a reduced model whose sound power is right at the frequencies of a band.

    Parameters
    ----------
    operators : Operators
        The system.
    load : (n,) or (k, n) array
        Right-hand side on the unknowns, the same at every frequency; with several, each gets its
        Krylov vectors and the power of each has to be right.
    frequency : (f,) array
        Where the power has to be right [Hz]; the needles between them are judged too.
    tolerance : float
        Largest estimate of the error of the radiated power level [dB].
    solver : SolverChain, optional
        Symmetric.
    most_vectors : int
        Most Krylov vectors from one factorisation and for one load.
    most_factorizations : int
        If the vectors of one do not suffice, the next is made where the estimate is worst.
    progress : Progress
        Called after each vector.

    Raises
    ------
    ValueError
        If the frequencies are not positive, or a load is zero.
    ConvergenceError
        The estimate stays above the tolerance; says where.
    """
    chain = make_solver() if solver is None else solver
    at = np.asarray(frequency, dtype=float)
    if at.ndim != 1 or at.size == 0 or not np.all(at > 0.0):
        raise ValueError("the frequencies of a sweep have to be a list of positive numbers [Hz]")
    sizes = np.linalg.norm(np.atleast_2d(load), axis=1)
    if not np.all((sizes > 0.0) & np.isfinite(sizes)):
        raise ValueError("a load of a sweep is zero or not finite: it makes no sound to be swept")
    space = Projection(operators)
    models: list[ReducedModel] = []
    powers: list[FloatArray] = []  # theirs, at the frequencies asked for
    points: list[float] = []
    history: list[float] = []
    worst, judged, estimate = float(0.5 * (at.min() + at.max())), at, np.full(at.shape, np.inf)
    while len(points) < most_factorizations:
        points.append(worst)
        omega = 2.0 * np.pi * worst * ASIDE
        progress(_STAGE, None, f"factorisation at {worst:.5g} Hz")
        factor = chain.factor(operators.at(omega))
        for vectors in islice(_together(operators, omega, factor, load), most_vectors):
            space.extend(vectors)
            models = [*models, ReducedModel(operators, space, load, space.size)][-_JUDGED:]
            powers = [*powers, models[-1].radiated(2.0 * np.pi * at)][-_JUDGED:]
            judged, estimate = at, np.full(at.shape, np.inf)
            if len(history) + 1 >= _LEAST:
                judged, estimate = _judge(models, powers, at, tolerance)
            history.append(float(estimate.max()))
            progress(_STAGE, None, f"{len(history)} vectors, error {history[-1]:.1e} dB")
            if history[-1] <= tolerance:
                return ReducedSweep(
                    models[-1],
                    tuple(models[:-1]),
                    Certificate(
                        judged, estimate, tolerance, len(history), space.size, tuple(points),
                        np.array(history),
                    ),
                    factor,
                    chain.report(),
                )  # fmt: skip
        worst = float(judged[int(np.argmax(estimate))])
    raise ConvergenceError(
        f"reduced model: the estimated error of the sound power is {estimate.max():.2g} dB at "
        f"{worst:.5g} Hz after {len(history)} vectors from {len(points)} factorisations, and "
        f"{tolerance:g} dB are wanted. Narrow the band, or sweep directly."
    )


def _together(
    operators: Operators, omega: complex, factor: Factorization, load: AnyArray
) -> Iterator[list[ComplexArray]]:
    """Krylov vectors of each load, side by side, until there are none."""
    each = [krylov_vectors(operators, omega, factor, row) for row in np.atleast_2d(load)]
    for row in zip_longest(*each):
        yield [vector for vector in row if vector is not None]


def _judge(
    models: Sequence[ReducedModel],
    powers: Sequence[FloatArray],
    frequency: FloatArray,
    tolerance: float,
) -> tuple[FloatArray, FloatArray]:
    """Frequencies and estimates; at the resonances too where the others are good enough."""
    estimate = _largest_change(powers[-1], powers[:-1])
    if estimate.max() > tolerance or len(frequency) == 1:
        return frequency, estimate
    *smaller, model = models
    needles, _ = model.light_modes((float(frequency.min()), float(frequency.max())))
    if needles.size == 0:  # every mode of the band may be heavily damped
        return frequency, estimate
    between = error_estimate(model, smaller, 2.0 * np.pi * needles)
    judged, first = np.unique(np.concatenate([frequency, needles]), return_index=True)
    return judged, np.concatenate([estimate, between])[first]
