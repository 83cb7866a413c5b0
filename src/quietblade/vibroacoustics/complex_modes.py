# SPDX-License-Identifier: LGPL-2.1-or-later
"""Complex modes of the damped, radiating system A(Omega) x = 0 (theory: S2-7)."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment

from quietblade.errors import Notice, SolverError
from quietblade.linalg import Factorization, SparseSolver, make_solver
from quietblade.typing import BoolArray, ComplexArray, FloatArray, IntArray, Progress, silent
from quietblade.vibroacoustics.modes import WetModes, unknowns
from quietblade.vibroacoustics.operators import Operators
from quietblade.vibroacoustics.projection import Projection, mass_assurance, times

_GROUP = 1.2  # ratio of the highest to the lowest frequency that share a factorisation
_ASIDE = 1.0 + 0.01j  # of the factored omega from the modes: A there is not nearly singular
_SAME = 0.25  # assurance below which a mode is not the one that was looked for


@dataclass(frozen=True, eq=False)
class ComplexModes:
    """Complex modes in the order of the real modes that they started from.

    Motion follows exp(i Omega t): a mode with a positive imaginary part decays.

    Attributes
    ----------
    omega : (m,) complex array
        Omega [rad/s].
    vectors : (m, n) complex array
        Displacement, film pressure and potential psi on the free unknowns, scaled to
        x^T A'(Omega) x = -2 Omega: the modal mass is one without damping, and A(omega)^-1 near a
        light mode is x x^T / (2 Omega (Omega - omega)).
    residual : (m,) array
        ``||A(sigma)^-1 A(Omega) x|| / ||x||`` in the structure's mass, at a sigma close by: the
        size of the change that one more iteration would make.
    overlap : (m,) array
        Modal assurance (mass of the structure) between the mode and the one it started from.
    converged : (m,) bool array
        Whether the residual reached the tolerance and the mode is still the one it started from.
    start : (m,) int array
        Row of the real mode.
    notices : tuple of Notice
        Modes that did not converge, with the reason.
    """

    omega: ComplexArray
    vectors: ComplexArray
    residual: FloatArray
    overlap: FloatArray
    converged: BoolArray
    start: IntArray
    notices: tuple[Notice, ...]

    @property
    def frequency(self) -> FloatArray:
        """Re Omega / (2 pi) [Hz]: where a light mode's response is largest."""
        return np.asarray(self.omega.real / (2.0 * np.pi))

    @property
    def loss_factor(self) -> FloatArray:
        """2 Im Omega / Re Omega: half-power width, positive for decay (theory: S2-16).

        For a constant complex stiffness, Omega^2 = omega_0^2 (1 + i eta), it is eta up to eta^3/4.
        """
        return np.asarray(2.0 * self.omega.imag / self.omega.real)


def complex_modes(
    operators: Operators,
    modes: WetModes,
    band: tuple[float, float],
    *,
    solver: SparseSolver | None = None,
    space: Projection | None = None,
    factor: Factorization | None = None,
    tolerance: float = 1e-8,
    iterations: int = 8,
    progress: Progress = silent,
) -> ComplexModes:
    """Complex modes that belong to the real modes in a band.

    Residual inverse iteration (A. Neumaier, SIAM J. Numer. Anal. 22 (1985) 914-923) of a group of
    modes at once, with the eigenproblem solved anew on the space of all vectors so far (H. Voss,
    BIT 44 (2004) 387-401).  The space holds all real modes from the beginning, so that close and
    coupled modes do not disturb each other, and one factorisation serves a group.  Factors may
    depend on omega in any smooth way, as those of frequency-dependent moduli and of the sphere do.

    Parameters
    ----------
    operators : Operators
        A(omega) with everything in it: loss, compressibility, radiation.
    modes : WetModes
        Real modes to start from; those outside the band help the ones inside.
    band : (float, float)
        Lowest and highest real frequency [Hz] of the modes to refine.
    solver : SparseSolver, optional
        Symmetric.
    space : Projection, optional
        Space to start from besides the real modes, such as that of a reduced model of the band.
    factor : Factorization, optional
        Of A at a frequency of the band: it serves all modes first, and only for those that it does
        not bring to the tolerance others are made.
    tolerance : float
        Largest `ComplexModes.residual` of a converged mode; Omega is then good to its square.
    iterations : int
        Most iterations with one factorisation.
    progress : Progress
        Called before each group.
    """
    chosen = make_solver() if solver is None else solver
    rows = np.flatnonzero((modes.frequency >= band[0]) & (modes.frequency <= band[1]))
    rows = rows[modes.frequency[rows] > 0.0]
    starts = unknowns(modes, operators)
    space = Projection(operators) if space is None else space.copy()
    space.extend(starts[modes.frequency > 0.0])
    found: list[_Mode] = []
    for group in _groups(modes.frequency[rows]):
        members = rows[group]
        low, high = modes.frequency[members[0]], modes.frequency[members[-1]]
        progress("complex modes", len(found) / len(rows), f"{low:.4g} to {high:.4g} Hz")
        omega = 2.0 * np.pi * modes.frequency[members]
        search = _Search(operators, space.copy(), omega, starts[members], tolerance)
        found += search.run(chosen, factor, iterations)
    return _collected(operators, rows, found, tolerance)


@dataclass(frozen=True, eq=False)
class _Mode:
    """Outcome of the iteration of one mode."""

    omega: complex
    vector: ComplexArray
    residual: float
    overlap: float
    failure: str = ""


def _groups(frequency: FloatArray) -> list[slice]:
    """Split ascending frequencies into runs that are close enough for one factorisation."""
    groups: list[slice] = []
    first = 0
    for index in range(1, len(frequency) + 1):
        if index == len(frequency) or frequency[index] > _GROUP * frequency[first]:
            groups.append(slice(first, index))
            first = index
    return groups


class _Search:
    """The iteration of one group of modes on a growing space."""

    def __init__(
        self,
        operators: Operators,
        space: Projection,
        start: FloatArray,
        vectors: ComplexArray,
        tolerance: float,
    ) -> None:
        self._operators, self._space, self._tolerance = operators, space, tolerance
        self._start, self._vectors = start, vectors
        self._omega = start.astype(complex)
        self._coordinates: list[ComplexArray] = [np.zeros(0, dtype=complex)] * len(start)
        self._overlap = np.zeros(len(start))
        self._change = np.full(len(start), np.inf)

    def run(
        self, solver: SparseSolver, factor: Factorization | None, iterations: int
    ) -> list[_Mode]:
        """Iterate with the factor there is, with one of the group, with one for each mode left."""
        failure = ""
        try:
            self._renew()
            if factor is not None:
                self._iterate(factor, iterations)
            if np.any(self._change > self._tolerance):
                own = self._factored(solver, complex(np.mean(self._omega.real)))
                self._iterate(own, iterations)
                del own
            for index in np.flatnonzero(self._change > self._tolerance):
                if self._change[index] > self._tolerance:
                    self._iterate(self._factored(solver, complex(self._omega[index])), iterations)
        except SolverError as error:
            failure = str(error)
        return [
            _Mode(
                complex(self._omega[index]),
                self._scaled(index),
                float(self._change[index]),
                float(self._overlap[index]),
                failure if self._change[index] > self._tolerance else "",
            )
            for index in range(len(self._omega))
        ]

    def _factored(self, solver: SparseSolver, omega: complex) -> Factorization:
        return solver.factor(self._operators.at(_ASIDE * omega))

    def _iterate(self, factor: Factorization, iterations: int) -> None:
        for _ in range(iterations):
            active = np.flatnonzero(self._change > self._tolerance)
            vectors = [self._space.lift(self._coordinates[index]) for index in active]
            defects = [
                self._applied(self._omega[index], x)
                for index, x in zip(active, vectors, strict=True)
            ]
            steps = factor.solve(np.stack(defects, axis=1)).T
            self._change[active] = [
                self._size(z) / self._size(x) for z, x in zip(steps, vectors, strict=True)
            ]
            wanted = self._change[active] > self._tolerance
            if not wanted.any():
                return
            self._space.extend(steps[wanted])
            self._renew()

    def _renew(self) -> None:
        """Eigenpairs on the space, for the modes that have not converged.

        All modes of the group take part in the choice, so that no two become one.
        """
        centre = float(np.sqrt(self._start[0] * self._start[-1]))
        values, coordinates = self._space.eigenpairs(centre)
        # the group spans little of this range; a space too poor for it has its eigenvalues anywhere
        near = (values.real > 0.5 * centre) & (values.real < 2.0 * centre)
        if np.count_nonzero(near) < len(self._start):
            near = values.real > 0.0
        values, coordinates = values[near], coordinates[near]
        solid = self._space.structural
        starts = np.array([self._space.coordinates(vector)[solid] for vector in self._vectors])
        alike = mass_assurance(starts, coordinates[:, solid])
        # Waves between blade and sphere may carry the same motion at another frequency.
        distance = np.abs(values / self._start[:, None] - 1.0)
        pairs = zip(*linear_sum_assignment(alike - distance, maximize=True), strict=True)
        for index, column in pairs:
            if self._change[index] > self._tolerance:
                omega, refined = self._space.refined(values[column], coordinates[column])
                self._omega[index], self._coordinates[index] = omega, refined
                self._overlap[index] = alike[index, column]

    def _applied(self, omega: complex, x: ComplexArray) -> ComplexArray:
        """A(omega) x."""
        total = np.zeros(x.shape, dtype=complex)
        for name, factor in self._operators.factors(omega).items():
            total += factor * times(self._operators.terms[name], x)
        return total

    def _size(self, x: ComplexArray) -> float:
        return float(np.sqrt(np.vdot(x, times(self._operators.terms["M"], x)).real))

    def _scaled(self, index: int) -> ComplexArray:
        """Vector with x^T A'(omega) x = -2 omega; the difference is exact for second degree."""
        omega, coordinates = self._omega[index], np.zeros(self._space.size, dtype=complex)
        coordinates[: len(self._coordinates[index])] = self._coordinates[index]
        h = 1e-4 * abs(omega)
        slope = (self._space.at(omega + h) - self._space.at(omega - h)) / (2.0 * h)
        mass = complex(coordinates @ slope @ coordinates) / (-2.0 * omega)
        return self._space.lift(coordinates / np.sqrt(mass))


def _collected(
    operators: Operators, rows: IntArray, found: Sequence[_Mode], tolerance: float
) -> ComplexModes:
    """Put the modes side by side and say which of them cannot be trusted."""
    reasons = [_doubt(mode, tolerance) for mode in found]
    notices = tuple(
        Notice(
            f"complex mode from the real mode {row}",
            f"{reason}, at {mode.omega.real / (2.0 * np.pi):.5g} Hz",
            mode.residual,
            tolerance,
            "Take the real mode, or a direct sweep around it.",
        )
        for row, mode, reason in zip(rows, found, reasons, strict=True)
        if reason
    )
    vectors = np.array([mode.vector for mode in found], dtype=complex)
    return ComplexModes(
        omega=np.array([mode.omega for mode in found], dtype=complex),
        vectors=vectors.reshape(len(found), operators.size),
        residual=np.array([mode.residual for mode in found]),
        overlap=np.array([mode.overlap for mode in found]),
        converged=np.array([not reason for reason in reasons], dtype=bool),
        start=rows,
        notices=notices,
    )


def _doubt(mode: _Mode, tolerance: float) -> str:
    """Why a mode cannot be trusted; empty if it can."""
    if mode.failure:
        return mode.failure
    if not mode.residual <= tolerance:
        return "the iteration did not converge"
    if mode.overlap < _SAME:
        return f"the mode has little in common with its start (assurance {mode.overlap:.2f})"
    return ""
