# SPDX-License-Identifier: LGPL-2.1-or-later
"""Regular spherical waves j_l(k r) Y_lm with real orthonormal harmonics, and their gradients.

Everything is written with solid harmonics S_lm(x) = r^l Y_lm, which are polynomials: nothing is
singular at the poles or at the centre.
"""

from math import prod

import numpy as np
from scipy.special import factorial, spherical_jn, spherical_yn

from quietblade.typing import ComplexArray, FloatArray

_NEAR = 2.0  # k r up to which the power series is used
_TERMS = 12  # of it: the next one is below rounding


def solid_harmonics(points: FloatArray, degree: int) -> tuple[FloatArray, FloatArray]:
    """Real orthonormal solid harmonics of one degree, and their gradients.

    Parameters
    ----------
    points : (n, 3) array
    degree : int

    Returns
    -------
    (2 degree + 1, n) array
        r^l Y_lm with m = -l..l; the sine harmonics have negative m.
    (2 degree + 1, 3, n) array
        Gradients.

    Notes
    -----
    S_lm = N_lm P_lm Re, Im (x + i y)^m, with P_lm = r^(l-m) d^m P_l/du^m at u = z/r, for which
    dP_lm/dz = (l + m) P_(l-1)m and dP_lm/dx = -x P_(l-1)(m+1).
    """
    x, y, _ = points.T
    polynomials = _reduced_legendre(points, degree)
    below = _reduced_legendre(points, degree - 1) if degree > 0 else np.zeros((0, len(points)))
    below = np.concatenate([below, np.zeros((2, len(points)))])
    values = np.empty((2 * degree + 1, len(points)))
    gradients = np.empty((2 * degree + 1, 3, len(points)))
    circular = (x + 1j * y) ** np.arange(degree + 1)[:, None]
    for m in range(degree + 1):
        norm = np.sqrt(
            (2 * degree + 1) / (4.0 * np.pi) * factorial(degree - m) / factorial(degree + m)
        ) * (np.sqrt(2.0) if m else 1.0)
        turned = m * circular[m - 1] if m else np.zeros(len(points), dtype=np.complex128)
        wave = np.stack(
            [
                polynomials[m] * turned - x * below[m + 1] * circular[m],
                1j * polynomials[m] * turned - y * below[m + 1] * circular[m],
                (degree + m) * below[m] * circular[m],
            ]
        )
        values[degree + m] = norm * polynomials[m] * circular[m].real
        gradients[degree + m] = norm * wave.real
        if m:
            values[degree - m] = norm * polynomials[m] * circular[m].imag
            gradients[degree - m] = norm * wave.imag
    return values, gradients


def outgoing(degree: int, z: FloatArray) -> ComplexArray:
    """Spherical Hankel function of the second kind, h_l(z): a wave that goes out."""
    return np.asarray(spherical_jn(degree, z) - 1j * spherical_yn(degree, z))


def radial_factors(
    radius: FloatArray, wavenumber: FloatArray, degree: int
) -> tuple[FloatArray, FloatArray]:
    """Factors F, D with j_l(k r) Y = F S and grad(j_l(k r) Y) = F grad S + D S x.

    Parameters
    ----------
    radius : (n,) array
        r.
    wavenumber : (f,) array
        k.

    Returns
    -------
    F, D : (f, n) arrays
        F = j_l(k r)/r^l and D = -k j_(l+1)(k r)/r^(l+1), finite at the centre.
    """
    k = np.asarray(wavenumber)[:, None]
    return _bessel_over_power(radius, k, degree), -k * _bessel_over_power(radius, k, degree + 1)


def _bessel_over_power(radius: FloatArray, k: FloatArray, degree: int) -> FloatArray:
    """j_l(k r)/r^l, by its power series (DLMF 10.53.1) on bodies smaller than a third of a wave."""
    z = k * radius
    squared, series = -0.5 * z**2, np.ones_like(z)
    for n in range(_TERMS, 0, -1):
        series = 1.0 + squared / (n * (2 * (degree + n) + 1)) * series
    value = np.asarray(k**degree / prod(range(1, 2 * degree + 2, 2)) * series)
    far = z > _NEAR
    if far.any():  # SciPy's function costs as much as ten series
        value[far] = spherical_jn(degree, z[far]) / np.broadcast_to(radius, z.shape)[far] ** degree
    return value


def _reduced_legendre(points: FloatArray, degree: int) -> FloatArray:
    """r^(l-m) d^m P_l(u)/du^m at u = z/r for m = 0..l, (degree + 1, n)."""
    z = points[:, 2]
    squared = np.einsum("ij,ij->i", points, points)
    rows = np.empty((degree + 1, len(points)))
    for m in range(degree + 1):
        before, now = np.zeros(len(points)), np.full(len(points), float(prod(range(1, 2 * m, 2))))
        for n in range(m + 1, degree + 1):
            before, now = (
                now,
                ((2 * n - 1) * z * now - (n + m - 1) * squared * before) / (n - m),
            )
        rows[m] = now
    return rows
