# SPDX-License-Identifier: LGPL-2.1-or-later
"""Complex modes of the damped, radiating system A(Omega) x = 0 (theory: S2-7)."""

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from quietblade.errors import Notice, SolverError
from quietblade.linalg import SparseSolver, make_solver
from quietblade.typing import BoolArray, ComplexArray, FloatArray, IntArray, Progress, silent
from quietblade.vibroacoustics.matching import assurance
from quietblade.vibroacoustics.modes import WetModes, unknowns
from quietblade.vibroacoustics.operators import Operators

_SAME = 0.25  # assurance below which a mode is not the one that was looked for
_TWIN = 1e-6  # relative distance of two Omega that may be one mode
_OFFSET = 1.001  # of the factored omega from the expected mode: A there is not nearly singular
_DIFFERENCE = 1e-4  # relative step of derivatives by omega; exact for factors of second degree


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
        x^T A'(Omega) x = -2 Omega: the modal mass is one without damping, and
        A(omega)^-1 is near x x^T / (2 Omega (Omega - omega)) by a light mode.
    residual : (m,) array
        ``||A(sigma)^-1 A(Omega) x|| / ||x||`` in the displacement, sigma the real mode's omega:
        the size of the change that one more iteration would make.
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
        """2 Im Omega / Re Omega: relative half-power width; positive for decay.

        For a constant complex stiffness, Omega^2 = omega_0^2 (1 + i eta), it is eta up to eta^3/4.
        """
        return np.asarray(2.0 * self.omega.imag / self.omega.real)


@dataclass(frozen=True)
class _Mode:
    """Outcome of one iteration."""

    omega: complex
    vector: ComplexArray
    residual: float
    failure: str = ""


def complex_modes(
    operators: Operators,
    modes: WetModes,
    band: tuple[float, float],
    *,
    solver: SparseSolver | None = None,
    tolerance: float = 1e-8,
    iterations: int = 20,
    progress: Progress = silent,
) -> ComplexModes:
    """Complex modes that belong to the real modes in a band.

    Residual inverse iteration (A. Neumaier, SIAM J. Numer. Anal. 22 (1985) 914-923): one
    factorisation a mode, Omega from the functional x^T A(Omega) x = 0, which for a complex
    symmetric A is in error by the square of the vector's error.

    Parameters
    ----------
    operators : Operators
        A(omega) with everything in it: loss, compressibility, radiation.
    modes : WetModes
        Real modes to start from.
    band : (float, float)
        Lowest and highest real frequency [Hz] of the modes to refine.
    solver : SparseSolver, optional
        Symmetric; in double precision unless given, because A is factored close to a mode.
    tolerance : float
        Largest `ComplexModes.residual` of a converged mode; Omega is then good to its square.
    iterations : int
        Most iterations a mode.
    progress : Progress
        Called before each mode.
    """
    chosen = make_solver(precision="double") if solver is None else solver
    rows = np.flatnonzero((modes.frequency >= max(band[0], 0.0)) & (modes.frequency <= band[1]))
    rows = rows[modes.frequency[rows] > 0.0]
    starts = unknowns(modes, operators)[rows]
    found = []
    for done, row in enumerate(rows):
        frequency = float(modes.frequency[row])
        progress("complex modes", done / len(rows), f"from {frequency:.4g} Hz")
        omega = 2.0 * np.pi * frequency
        found.append(_refined(operators, omega, starts[done], chosen, tolerance, iterations))
    return _collected(operators, rows, starts, found, tolerance)


class _Forms:
    """A(omega) x and its derivative, from the products of each term with one vector."""

    def __init__(self, operators: Operators, x: ComplexArray) -> None:
        self._operators = operators
        self._x = x
        names = operators.factors(1.0)
        self._products = {name: operators.terms[name] @ x for name in names}
        self._values = {name: complex(x @ product) for name, product in self._products.items()}

    def at(self, omega: complex) -> ComplexArray:
        """A(omega) x."""
        return self._sum(self._operators.factors(omega))

    def slope(self, omega: complex) -> ComplexArray:
        """A'(omega) x."""
        return self._sum(self._derivatives(omega))

    def root(self, omega: complex) -> complex:
        """Zero of x^T A(omega) x near omega, by Newton's method."""
        for _ in range(30):
            value = self._scalar(self._operators.factors(omega))
            step = value / self._scalar(self._derivatives(omega))
            omega -= step
            if abs(step) <= 1e-14 * abs(omega):
                break
        return omega

    def _derivatives(self, omega: complex) -> dict[str, complex]:
        h = _DIFFERENCE * abs(omega)
        above, below = self._operators.factors(omega + h), self._operators.factors(omega - h)
        return {name: (above[name] - below[name]) / (2.0 * h) for name in above}

    def _sum(self, factors: Mapping[str, complex]) -> ComplexArray:
        total = np.zeros(self._x.shape, dtype=complex)
        for name, factor in factors.items():
            total += factor * self._products[name]
        return total

    def _scalar(self, factors: Mapping[str, complex]) -> complex:
        return sum(factor * self._values[name] for name, factor in factors.items())


def _refined(
    operators: Operators,
    omega: complex,
    x: ComplexArray,
    solver: SparseSolver,
    tolerance: float,
    iterations: int,
) -> _Mode:
    """One complex mode by residual inverse iteration."""
    u = operators.blocks.u
    forms = _Forms(operators, x)
    omega = forms.root(omega)
    sigma = _OFFSET * omega
    try:
        factor = solver.factor(operators.at(sigma))
        for _ in range(iterations):
            change = factor.solve(forms.at(omega))
            slope = forms.slope(omega)
            # The part along x only rescales it; near the pole it is large and full of rounding.
            change -= x * ((slope @ change) / (slope @ x))
            x = x - change
            residual = float(np.linalg.norm(change[u]) / np.linalg.norm(x[u]))
            forms = _Forms(operators, x)
            omega = forms.root(omega)
            if residual <= tolerance:
                break
    except SolverError as error:
        return _Mode(omega, x, np.inf, str(error))
    mass = complex(x @ forms.slope(omega)) / (-2.0 * omega)
    return _Mode(omega, x / np.sqrt(mass), residual)


def _collected(
    operators: Operators,
    rows: IntArray,
    starts: ComplexArray,
    found: Sequence[_Mode],
    tolerance: float,
) -> ComplexModes:
    """Put the modes side by side and say which of them cannot be trusted."""
    vectors = np.array([mode.vector for mode in found], dtype=complex)
    vectors = vectors.reshape(len(found), operators.size)
    mass = operators.terms["M"]
    overlap = np.array(
        [
            assurance(start[None], end[None], mass)[0, 0]
            for start, end in zip(starts, vectors, strict=True)
        ]
    )
    reasons = [
        _doubt(mode, tolerance, float(same)) for mode, same in zip(found, overlap, strict=True)
    ]
    alike = assurance(vectors, vectors, mass)
    for one, two in itertools.combinations(range(len(found)), 2):
        near = abs(found[one].omega - found[two].omega) <= _TWIN * abs(found[one].omega)
        if near and alike[one, two] > 0.99 and not reasons[one] and not reasons[two]:
            worse = one if overlap[one] < overlap[two] else two
            reasons[worse] = "the iteration ended at the mode of another start"
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
    return ComplexModes(
        omega=np.array([mode.omega for mode in found], dtype=complex),
        vectors=vectors,
        residual=np.array([mode.residual for mode in found]),
        overlap=overlap,
        converged=np.array([not reason for reason in reasons], dtype=bool),
        start=rows,
        notices=notices,
    )


def _doubt(mode: _Mode, tolerance: float, overlap: float) -> str:
    """Why a mode cannot be trusted; empty if it can."""
    if mode.failure:
        return mode.failure
    if mode.residual > tolerance:
        return "the iteration did not converge"
    if overlap < _SAME:
        return f"the mode has little in common with its start (assurance {overlap:.2f})"
    return ""
