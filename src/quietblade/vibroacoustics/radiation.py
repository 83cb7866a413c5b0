# SPDX-License-Identifier: LGPL-2.1-or-later
"""Conditions on the outer sphere that let waves leave the mesh."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

import ngsolve as ngs
import numpy as np
from scipy.sparse import csr_matrix

from quietblade.errors import MeshError
from quietblade.mesh.assembly import csr_of
from quietblade.mesh.boundaries import boundary
from quietblade.typing import ComplexArray, FloatArray
from quietblade.vibroacoustics.fluid import Water, potential_space


class RadiationCondition(Protocol):
    """A condition d psi/dn + b psi = 0 on the sphere, as affine terms of A(omega).

    A(omega) gets the sum of ``factors[name] * matrices[name]`` and, for what acts on a few
    spherical harmonics only, of ``factors[name] * Y Y^T`` with ``Y = loads[name]``; both are
    positive on the space Q of the potential.  Power leaves through the sphere where the imaginary
    part of that sum is negative.
    """

    @property
    def name(self) -> str:
        """Name that accompanies every level computed with the condition."""

    def matrices(self, fem: ngs.Mesh, water: Water, outer: str) -> Mapping[str, csr_matrix]:
        """Real symmetric matrices (Q.ndof, Q.ndof), by name."""

    def loads(
        self, fem: ngs.Mesh, water: Water, outer: str, radius: float
    ) -> Mapping[str, csr_matrix]:
        """Real loads Y (Q.ndof, m) of the terms of low rank, by name; empty if it is local."""

    def factors(self, omega: complex, sound_speed: float, radius: float) -> Mapping[str, complex]:
        """Factor of each matrix and of each Y Y^T at an angular frequency [rad/s]."""

    def coefficients(self, degree: int, kr: float) -> ComplexArray:
        """R b on the harmonics of the degrees 0..degree, (degree + 1,), to judge the condition."""


@dataclass(frozen=True)
class Bgt1:
    """First-order condition of Bayliss, Gunzburger and Turkel, b = i k + 1/R (theory: S2-4).

    Exact for a monopole at the centre only; below k R = 3 the power of higher multipoles comes
    out wrong (see ``multipoles`` for an estimate that is free of the reflected wave).

    References
    ----------
    A. Bayliss, M. Gunzburger, E. Turkel, SIAM J. Appl. Math. 42 (1982) 430-451.
    """

    name: str = "BGT-1"

    def matrices(self, fem: ngs.Mesh, water: Water, outer: str) -> Mapping[str, csr_matrix]:
        """Q = int rho / c psi dpsi over the sphere."""
        scale = water.density / water.sound_speed
        return {"Q": csr_matrix(scale * sphere_mass(fem, outer))}

    def loads(
        self, fem: ngs.Mesh, water: Water, outer: str, radius: float
    ) -> Mapping[str, csr_matrix]:
        """Nothing: it is local."""
        return {}

    def factors(self, omega: complex, sound_speed: float, radius: float) -> Mapping[str, complex]:
        """-(i omega + c/R) for Q."""
        return {"Q": -(1j * omega + sound_speed / radius)}

    def coefficients(self, degree: int, kr: float) -> ComplexArray:
        """1 + i k R for every degree."""
        return np.full(degree + 1, 1.0 + 1j * kr)


@dataclass(frozen=True)
class Bgt2:
    """Second-order condition of Bayliss, Gunzburger and Turkel (theory: S2-40).

    b psi = beta psi - 1/(2 beta) Laplace-Beltrami psi with beta = i k + 1/R.  Exact for degrees 0
    and 1.  It feeds power back below k R = sqrt 2 for degree 2, sqrt 5 for degree 3, 3 for 4.

    References
    ----------
    A. Bayliss, M. Gunzburger, E. Turkel, SIAM J. Appl. Math. 42 (1982) 430-451.
    """

    name: str = "BGT-2"

    def matrices(self, fem: ngs.Mesh, water: Water, outer: str) -> Mapping[str, csr_matrix]:
        """Q = int rho psi dpsi and T = int rho grad_S psi . grad_S dpsi over the sphere."""
        return {
            "Q": csr_matrix(water.density * sphere_mass(fem, outer)),
            "T": csr_matrix(water.density * sphere_stiffness(fem, outer)),
        }

    def loads(
        self, fem: ngs.Mesh, water: Water, outer: str, radius: float
    ) -> Mapping[str, csr_matrix]:
        """Nothing: it is local."""
        return {}

    def factors(self, omega: complex, sound_speed: float, radius: float) -> Mapping[str, complex]:
        """-beta for Q and -1/(2 beta) for T."""
        beta = 1j * omega / sound_speed + 1.0 / radius
        return {"Q": -beta, "T": -0.5 / beta}

    def coefficients(self, degree: int, kr: float) -> ComplexArray:
        """Beta + l (l + 1)/(2 beta) with beta = 1 + i k R."""
        beta, degrees = 1.0 + 1j * kr, np.arange(degree + 1)
        return np.asarray(beta + degrees * (degrees + 1) / (2.0 * beta))


def static_exterior(fem: ngs.Mesh, water: Water, radius: float, outer: str = "outer") -> csr_matrix:
    """Incompressible water outside the sphere, to be added to H for real wet modes.

    Outside the sphere a potential of degree l decays as r^-(l+1), so that d psi/dn = -d psi with
    d = (l + 1)/R.  The local operator 1/R - (R/2) Laplace-Beltrami has 1/R + l (l + 1)/(2 R): exact
    for degrees 0 and 1, the ones that reach the sphere from a body well inside (theory: S2-11).

    Returns
    -------
    (Q.ndof, Q.ndof) csr_matrix
        int rho (1/R psi dpsi + R/2 grad_S psi . grad_S dpsi) over the sphere.
    """
    mass, stiffness = sphere_mass(fem, outer), sphere_stiffness(fem, outer)
    return csr_matrix(water.density * (mass / radius + 0.5 * radius * stiffness))


def sphere_mass(fem: ngs.Mesh, outer: str = "outer") -> csr_matrix:
    """Integral of psi dpsi over the sphere, (Q.ndof, Q.ndof)."""
    potential = potential_space(fem)
    psi, test = potential.TnT()
    form = ngs.BilinearForm(potential, check_unused=False)
    form += psi.Trace() * test.Trace() * ngs.ds(definedon=boundary(fem, outer))
    return csr_of(form.Assemble())


def sphere_stiffness(fem: ngs.Mesh, outer: str = "outer") -> csr_matrix:
    """Integral of grad_S psi . grad_S dpsi over the sphere, grad_S tangential, (Q.ndof, Q.ndof)."""
    potential = potential_space(fem)
    psi, test = potential.TnT()
    form = ngs.BilinearForm(potential, check_unused=False)
    along = ngs.InnerProduct(ngs.grad(psi).Trace(), ngs.grad(test).Trace())
    form += along * ngs.ds(definedon=boundary(fem, outer))
    return csr_of(form.Assemble())


def check_sphere(
    fem: ngs.Mesh, radius: float, outer: str = "outer", *, tolerance: float = 0.01
) -> FloatArray:
    """Centre of the outer boundary, after a check that it is a whole sphere of that radius.

    Raises
    ------
    MeshError
        If the mean squared distance of the boundary from a sphere, or its area, is off by more
        than ``tolerance``.
    """
    surface = ngs.ds(definedon=boundary(fem, outer))
    position = ngs.CF((ngs.x, ngs.y, ngs.z))
    area = float(ngs.Integrate(ngs.CF(1.0) * surface, fem))
    center: FloatArray = np.array([ngs.Integrate(x * surface, fem) for x in position]) / area
    away = position - ngs.CF(tuple(center))
    deviation = ngs.sqrt(ngs.InnerProduct(away, away)) / radius - 1.0
    error = float(np.sqrt(ngs.Integrate(deviation**2 * surface, fem) / area))
    whole = area / (4.0 * np.pi * radius**2)
    if error > tolerance or abs(whole - 1.0) > 2.0 * tolerance:
        raise MeshError(
            f"boundary {outer!r} is not a sphere of radius {radius:g} m: its distance from one is "
            f"{error:.2%} of the radius and its area {whole:.3f} times the sphere's; "
            "give the radius the mesh was made with"
        )
    return center
