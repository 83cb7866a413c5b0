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
from quietblade.typing import FloatArray
from quietblade.vibroacoustics.fluid import Water, boundary, potential_space


class RadiationCondition(Protocol):
    """A condition d psi/dn + b psi = 0 on the sphere, as affine terms of A(omega).

    The matrices are real, symmetric and positive on the space Q of the potential; A(omega) gets
    the sum of ``factors[name] * matrices[name]``.  Power leaves through the sphere where the
    imaginary part of that sum is negative.
    """

    @property
    def name(self) -> str:
        """Name that accompanies every level computed with the condition."""

    def matrices(self, fem: ngs.Mesh, water: Water, outer: str) -> Mapping[str, csr_matrix]:
        """Real symmetric matrices (Q.ndof, Q.ndof), by name."""

    def factors(self, omega: complex, sound_speed: float, radius: float) -> Mapping[str, complex]:
        """Factor of each matrix at an angular frequency [rad/s]."""


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

    def factors(self, omega: complex, sound_speed: float, radius: float) -> Mapping[str, complex]:
        """-(i omega + c/R) for Q."""
        return {"Q": -(1j * omega + sound_speed / radius)}


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
