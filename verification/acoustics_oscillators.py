# SPDX-License-Identifier: LGPL-2.1-or-later
"""Closed forms of one degree of freedom and of bars and beams, with free parameters."""

import numpy as np

from quietblade.materials.viscoelastic import GeneralizedMaxwell, ModulusRatio
from quietblade.typing import ComplexArray, FloatArray


def oscillator_mode(natural: float, ratio: ModulusRatio) -> complex:
    """Omega [rad/s] of omega_0^2 g(Omega) = Omega^2 with a positive real part.

    Parameters
    ----------
    natural : float
        omega_0 with the static modulus [rad/s].
    ratio : ModulusRatio
        g.
    """
    omega = complex(natural * np.sqrt(complex(ratio(natural))))
    for _ in range(100):
        h = 1e-6 * abs(omega)
        value = omega**2 - natural**2 * ratio(omega)
        slope = 2.0 * omega - natural**2 * (ratio(omega + h) - ratio(omega - h)) / (2.0 * h)
        step = value / slope
        omega -= step
        if abs(step) < 1e-14 * abs(omega):
            return omega
    raise ValueError(f"no damped frequency near {natural:g} rad/s")


def maxwell_mode(natural: float, model: GeneralizedMaxwell) -> complex:
    """Find it for a generalised Maxwell model: a root of a polynomial, without iteration.

    With lambda = i Omega: lambda^2 + omega_0^2 (1 + sum g_k lambda tau_k/(1 + lambda tau_k)) = 0.
    """
    whole = np.polynomial.Polynomial([natural**2, 0.0, 1.0])
    factors = [np.polynomial.Polynomial([1.0, tau]) for tau in model.times]
    for factor in factors:
        whole = whole * factor
    for k, (g, tau) in enumerate(zip(model.strengths, model.times, strict=True)):
        part = np.polynomial.Polynomial([0.0, natural**2 * g * tau])
        for other, factor in enumerate(factors):
            part = part * factor if other != k else part
        whole = whole + part
    omega = whole.roots() / 1j
    return complex(omega[np.argmax(omega.real)])


def random_mean_square(force: float, damping: float, stiffness: float) -> float:
    """Mean square displacement [m2] of m u'' + c u' + k u = f with white f, all frequencies.

    Parameters
    ----------
    force : float
        One-sided power spectral density of f [N2/Hz].
    damping, stiffness : float
        c [N s/m], k [N/m]; the mass does not matter.

    References
    ----------
    S. H. Crandall, W. D. Mark, Random vibration in mechanical systems, Academic Press 1963.
    """
    return force / (4.0 * damping * stiffness)


def bar_carried(
    omega: FloatArray, place: float, length: float, young: complex, density: float
) -> ComplexArray:
    """Axial displacement of a bar whose one end moves by one and whose other end is free.

    u = cos(k (L - x)) / cos(k L), k = omega sqrt(rho / E).
    """
    k = np.asarray(omega) * np.sqrt(density / complex(young))
    return np.asarray(np.cos(k * (length - place)) / np.cos(k * length))


def bar_stiffness(
    omega: FloatArray, length: float, area: float, young: complex, density: float
) -> ComplexArray:
    """Force [N/m] at the moved end of that bar, -E A k tan(k L)."""
    k = np.asarray(omega) * np.sqrt(density / complex(young))
    return np.asarray(-young * area * k * np.tan(k * length))


def cantilever_mobility(
    omega: FloatArray, length: float, bending: complex, mass: float
) -> ComplexArray:
    """Drive-point mobility [m/(N s)] at the tip of an Euler-Bernoulli cantilever.

    Y = i omega L^3/(E I) (cosh b sin b - sinh b cos b)/(b^3 (1 + cosh b cos b)),
    b^4 = m omega^2 L^4/(E I).

    Parameters
    ----------
    omega : (f,) array
        [rad/s]
    length : float
        [m]
    bending : complex
        E I (1 + i eta) [N m2].
    mass : float
        m, mass per length [kg/m].
    """
    w = np.asarray(omega)
    b = (mass * w**2 * length**4 / complex(bending)) ** 0.25
    top = np.cosh(b) * np.sin(b) - np.sinh(b) * np.cos(b)
    receptance = length**3 / bending * top / (b**3 * (1.0 + np.cosh(b) * np.cos(b)))
    return np.asarray(1j * w * receptance)
