# SPDX-License-Identifier: LGPL-2.1-or-later
"""Krylov vectors of A(omega) x = b around one frequency, for any smooth dependence on omega.

Around omega_0 every factor f_j of A(omega) = sum f_j(omega) A_j is a power series in
mu = omega / omega_0 - 1, and the derivatives of the solution obey

    A_0 x_k = b_k - sum_{i >= 1} A_i x_{k-i},     A_i = sum_j c_ij A_j  (theory: S2-60)

Computed like this they soon become parallel.  The same space comes stably from Arnoldi's method on
the companion form of the series, whose vectors are kept as coefficients of one orthonormal basis
(two-level orthogonal Arnoldi: D. Lu, Y. Su, Z. Bai, SIAM J. Matrix Anal. Appl. 37 (2016) 195-214;
for a series of higher degree: D. Kressner, J. E. Roman, Numer. Linear Algebra Appl. 21 (2014)
569-588).
"""

from collections.abc import Callable, Iterator, Mapping

import numpy as np

from quietblade.linalg import Factorization
from quietblade.typing import AnyArray, ComplexArray
from quietblade.vibroacoustics.operators import Operators
from quietblade.vibroacoustics.projection import times

DEGREE = 6
"""Degree at which the power series of the factors are cut: of the vectors, not of the answer."""

_RADIUS = 0.2  # of the circle in mu on which the factors are sampled for their series
_SAMPLES = 32
_LOST = 1e-12  # of a vector's length: what is left of it below is rounding


def taylor_coefficients(
    factors: Callable[[complex], Mapping[str, complex]], omega: complex, degree: int
) -> Mapping[str, ComplexArray]:
    """Coefficients (degree + 1,) of each factor in powers of mu = omega' / omega - 1.

    By Cauchy's integral over a circle, which the trapezoidal rule integrates to rounding.

    Parameters
    ----------
    factors : callable
        Factors by name at a complex angular frequency, analytic around omega.
    omega : complex
        Where the series starts [rad/s].
    degree : int
        Last power.
    """
    turn = np.exp(2j * np.pi * np.arange(_SAMPLES) / _SAMPLES)
    sampled = [factors(complex(omega * (1.0 + _RADIUS * t))) for t in turn]
    powers = _RADIUS ** np.arange(degree + 1)
    return {
        name: np.fft.fft([complex(s[name]) for s in sampled])[: degree + 1] / _SAMPLES / powers
        for name in sampled[0]
    }


def krylov_vectors(
    operators: Operators, omega: complex, factor: Factorization, load: AnyArray
) -> Iterator[ComplexArray]:
    """Yield orthonormal vectors (n,) that span the solution and its derivatives at omega.

    Parameters
    ----------
    operators : Operators
        The system.
    omega : complex
        Angular frequency [rad/s] of the factor.
    factor : Factorization
        Of A(omega).
    load : (n,) array
        Right-hand side, the same at every frequency.

    Yields
    ------
    (n,) complex array
        One solve each.  Ends early if the space is complete.
    """
    series = taylor_coefficients(operators.factors, omega, DEGREE)
    start = factor.solve(load.astype(complex))
    basis = np.zeros((0, operators.size), dtype=complex)  # rows
    # each companion vector is DEGREE blocks, kept as coefficients of the basis
    states: list[ComplexArray] = []
    new, older = start, np.zeros((DEGREE - 1, 0), dtype=complex)
    while True:
        own = np.zeros(len(basis), dtype=complex)
        length = float(np.linalg.norm(new))
        for _ in range(2):
            part = (basis @ new.conj()).conj()  # no conjugate copy of the basis
            own += part
            new = new - part @ basis
        left = float(np.linalg.norm(new))
        if left <= _LOST * length:
            return
        basis = np.concatenate([basis, new[None] / left])
        yield basis[-1]
        state = np.zeros((DEGREE, len(basis)), dtype=complex)
        state[0, :-1], state[0, -1] = own, left
        state[1:, : older.shape[1]] = older
        state = _orthonormal(state, states)
        states.append(state)
        # A_0^-1 of minus the sum over the blocks; the blocks move down by one
        blocks = state @ basis
        defect = np.zeros(operators.size, dtype=complex)
        for name, c in series.items():
            if np.any(np.abs(c[1:]) > 0.0):
                defect -= times(operators.terms[name], c[1:] @ blocks)
        new, older = factor.solve(defect), state[:-1]


def _orthonormal(state: ComplexArray, states: list[ComplexArray]) -> ComplexArray:
    """Companion vector made orthonormal to those before it, in coefficients of the basis."""
    for _ in range(2):
        for other in states:
            width = other.shape[1]
            state[:, :width] -= np.vdot(other, state[:, :width]) * other
    return np.asarray(state / np.linalg.norm(state))
