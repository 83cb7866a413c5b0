# SPDX-License-Identifier: LGPL-2.1-or-later
"""Spheres in water in closed form, with exp(+i omega t), with and without the reflected wave.

A field of degree l is psi = (A h2_l(k r) + B h1_l(k r)) P_l(cos theta): h2 goes out, h1 comes back
from an outer sphere with an approximate condition.  In an infinite fluid B = 0.

References
----------
M. C. Junger, D. Feit, Sound, Structures, and Their Interaction, 2nd ed., MIT Press 1986.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from scipy.special import spherical_jn, spherical_yn

Bgt = Callable[[int, float, float], complex]
Bessel = Callable[..., Any]
Triple = tuple[complex, complex, complex]


def h1(degree: int, z: float, derivative: bool = False) -> complex:
    """Spherical Hankel function of the first kind (incoming)."""
    return complex(spherical_jn(degree, z, derivative) + 1j * spherical_yn(degree, z, derivative))


def h2(degree: int, z: float, derivative: bool = False) -> complex:
    """Spherical Hankel function of the second kind (outgoing)."""
    return h1(degree, z, derivative).conjugate()


def bgt1(degree: int, k: float, radius: float) -> complex:
    """Coefficient b of d psi/dn + b psi = 0, first order, the same for all degrees."""
    del degree
    return 1j * k + 1.0 / radius


def bgt2(degree: int, k: float, radius: float) -> complex:
    """Coefficient of the second-order condition on a harmonic of that degree."""
    first = 1j * k + 1.0 / radius
    return first + degree * (degree + 1) / (2.0 * radius**2 * first)


def reflection(degree: int, k: float, radius: float, condition: Bgt | None) -> complex:
    """B/A that d psi/dr + b psi = 0 at r = radius asks for; zero without a condition."""
    if condition is None:
        return 0.0
    b = condition(degree, k, radius)
    z = k * radius
    leaving = k * h2(degree, z, True) + b * h2(degree, z)
    return -leaving / (k * h1(degree, z, True) + b * h1(degree, z))


def power_ratio(degree: int, kr: float, condition: Bgt) -> float:
    """Power through the sphere over the exact one, compact source (theory: S2-12).

    The strength is the coefficient of the singular part, A - B.
    """
    ratio = reflection(degree, kr, 1.0, condition)
    return (1.0 - abs(ratio) ** 2) / abs(1.0 - ratio) ** 2


@dataclass(frozen=True)
class Wave:
    """One degree of the field, A h2 + B h1.

    Attributes
    ----------
    degree : int
    k : float
        Wave number [1/m].
    outgoing, incoming : complex
        A and B [m2/s].
    """

    degree: int
    k: float
    outgoing: complex
    incoming: complex

    def potential(self, r: float) -> complex:
        """Factor of P_l in psi [m2/s]."""
        z = self.k * r
        return self.outgoing * h2(self.degree, z) + self.incoming * h1(self.degree, z)

    def velocity(self, r: float) -> complex:
        """Factor of P_l in d psi/dr [m/s]."""
        z = self.k * r
        slopes = h2(self.degree, z, True), h1(self.degree, z, True)
        return self.k * (self.outgoing * slopes[0] + self.incoming * slopes[1])

    def power(self, density: float, omega: float) -> float:
        """Net power through any sphere [W]."""
        net = abs(self.outgoing) ** 2 - abs(self.incoming) ** 2
        return 2.0 * np.pi * density * omega * net / (self.k * (2 * self.degree + 1))

    def power_through(self, radius: float, condition: Bgt, density: float, omega: float) -> float:
        """Power through the sphere that has a condition d psi/dr + b psi = 0 [W].

        W = 2 pi R^2 rho omega Im(b) |psi|^2/(2l + 1): that of `power`, which at low frequency is
        the difference of two numbers that are the same to rounding.
        """
        passing = condition(self.degree, self.k, radius).imag * abs(self.potential(radius)) ** 2
        return 2.0 * np.pi * radius**2 * density * omega * passing / (2 * self.degree + 1)

    def power_of_sources(self, density: float, omega: float) -> float:
        """Power of the part that is singular inside, with amplitude A - B [W].

        B h1 = B (2 j - h2): the incoming wave goes through the centre and out again; what the
        body itself sends is A - B.
        """
        strength = abs(self.outgoing - self.incoming) ** 2
        return 2.0 * np.pi * density * omega * strength / (self.k * (2 * self.degree + 1))


def moving_sphere(
    degree: int,
    k: float,
    radius: float,
    outer: float,
    velocity: complex,
    condition: Bgt | None = bgt1,
) -> Wave:
    """Field around a sphere with radial velocity v P_l(cos theta)."""
    ratio = reflection(degree, k, outer, condition)
    unit = Wave(degree, k, 1.0, ratio)
    amplitude = velocity / unit.velocity(radius)
    return Wave(degree, k, amplitude, amplitude * ratio)


@dataclass(frozen=True)
class ElasticSphere:
    """Solid sphere (``inner = 0``) or thick shell with a vacuum inside, in water.

    Attributes
    ----------
    outer, inner : float
        Radii [m].
    young : complex
        E (1 + i eta) [Pa].
    poisson : float
    density : float
        Of the solid [kg/m3].
    water_density, sound_speed : float
        Of the water.
    sphere : float
        Radius of the outer sphere of the water [m].
    condition : Bgt or None
        Condition there; None is the infinite water.
    """

    outer: float
    inner: float
    young: complex
    poisson: float
    density: float
    water_density: float
    sound_speed: float
    sphere: float = 1.0
    condition: Bgt | None = None

    def solve(
        self, degree: int, omega: float, outer_pressure: float = 1.0, inner_pressure: float = 0.0
    ) -> tuple[complex, Wave]:
        """Radial displacement of the outer surface [m] and field, factors of P_l(cos theta).

        Both pressures push into the solid, with amplitude times P_l(cos theta) [Pa].

        u = grad phi + curl curl (r chi): u_r = phi' + l (l + 1) chi/r and the factor of
        dP_l/dtheta is (phi + chi)/r + chi'.
        """
        columns = self._solid_columns(degree, omega)
        k = omega / self.sound_speed
        wave = Wave(degree, k, 1.0, reflection(degree, k, self.sphere, self.condition))
        n = len(columns)
        rows: list[list[complex]] = []
        right: list[complex] = []
        surfaces = [(self.outer, -outer_pressure)]
        if self.inner > 0.0:
            surfaces.append((self.inner, -inner_pressure))
        for r, normal_stress in surfaces:
            state = [column(r) for column in columns]
            # sigma_rr = -p - p_fluid with p_fluid = -i omega rho psi
            fluid = -1j * omega * self.water_density * wave.potential(r) if r == self.outer else 0.0
            rows.append([s[1] for s in state] + [fluid])
            right.append(normal_stress)
            if degree > 0:
                rows.append([s[2] for s in state] + [0.0])
                right.append(0.0)
        moving = [1j * omega * column(self.outer)[0] for column in columns]
        rows.append([*moving, -wave.velocity(self.outer)])
        right.append(0.0)
        matrix = np.array(rows)
        scale = np.abs(matrix).max(axis=0)
        solved = np.linalg.solve(matrix / scale, np.array(right)) / scale
        radial = sum(solved[j] * columns[j](self.outer)[0] for j in range(n))
        amplitude = complex(solved[-1])
        return complex(radial), Wave(degree, k, amplitude, amplitude * wave.incoming)

    def _solid_columns(self, degree: int, omega: float) -> list[Callable[[float], Triple]]:
        """(u_r, sigma_rr, sigma_rtheta) at r, one function a potential."""
        mu = self.young / (2.0 * (1.0 + self.poisson))
        lame = self.young * self.poisson / ((1.0 + self.poisson) * (1.0 - 2.0 * self.poisson))
        pressure_wave = omega * np.sqrt(self.density / (lame + 2.0 * mu) + 0j)
        shear_wave = omega * np.sqrt(self.density / mu + 0j)
        ll = degree * (degree + 1)

        def dilatation(kind: Bessel, r: float) -> Triple:
            f, f1, f2 = _radial(kind, degree, pressure_wave, r)
            stress = -lame * pressure_wave**2 * f + 2.0 * mu * f2
            return f1, stress, 2.0 * mu * (f1 / r - f / r**2)

        def shear(kind: Bessel, r: float) -> Triple:
            f, f1, f2 = _radial(kind, degree, shear_wave, r)
            stress = 2.0 * mu * ll * (f1 / r - f / r**2)
            return ll * f / r, stress, mu * (ll * f / r**2 + f2 - 2.0 * f / r**2)

        kinds = [spherical_jn] if self.inner == 0.0 else [spherical_jn, spherical_yn]
        potentials = [dilatation, shear] if degree > 0 else [dilatation]
        return [partial(potential, kind) for potential in potentials for kind in kinds]


def _radial(kind: Bessel, degree: int, q: complex, r: float) -> Triple:
    """Bessel function of q r with its first and second derivative in r."""
    f, slope = complex(kind(degree, q * r)), q * complex(kind(degree, q * r, True))
    return f, slope, -2.0 * slope / r - (q**2 - degree * (degree + 1) / r**2) * f
