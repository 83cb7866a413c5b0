# SPDX-License-Identifier: LGPL-2.1-or-later
"""The exact condition on the sphere: Dirichlet-to-Neumann map of the spherical harmonics.

A wave of degree l that goes out satisfies d psi/dn + d_l psi = 0 with d_l = -k h_l'(kR)/h_l(kR),
h of the second kind (theory: S2-41).  The degrees up to N get their own d_l through one auxiliary
unknown each harmonic; all higher ones share the real coefficient of degree N + 1 at rest, which is
elastic and lets no power pass (theory: S2-42).
"""

from collections.abc import Mapping
from dataclasses import dataclass
from math import log

import ngsolve as ngs
import numpy as np
from ngsolve.comp import IntegrationRuleSpaceSurface
from scipy.sparse import csr_matrix

from quietblade.mesh.assembly import csr_of
from quietblade.mesh.boundaries import boundary
from quietblade.mesh.model import INTERFACE
from quietblade.typing import ComplexArray, FloatArray
from quietblade.vibroacoustics.fluid import Water, potential_space
from quietblade.vibroacoustics.harmonics import solid_harmonics
from quietblade.vibroacoustics.radiation import check_sphere, sphere_mass

MOST_DEGREES = 30
"""Highest degree that `dtn_degree` proposes: with 961 auxiliary unknowns, a larger sphere is
cheaper."""

_QUADRATURE = 10  # order of the rule on the triangles of the sphere


def dtn_coefficients(degree: int, kr: complex) -> ComplexArray:
    """R d_l of the degrees 0..degree at a wave number times radius, which may be zero or complex.

    With r_l = z h_(l-1)(z)/h_l(z), the recurrence of the Hankel functions gives
    r_(l+1) = z^2/(2l + 1 - r_l) from r_0 = -iz, and R d_l = l + 1 - r_l.  It is stable upwards,
    and for real z the imaginary part, which is as small as z^(2l+1), keeps its digits.

    Returns
    -------
    (degree + 1,) complex array
        l + 1 at rest; the imaginary part is 1/(kR |h_l(kR)|^2) for real kR, always positive.
    """
    z = complex(kr)
    squared = z.real**2 if z.imag == 0.0 else z * z
    ratio = -1j * z
    values = np.empty(degree + 1, dtype=np.complex128)
    for n in range(degree + 1):
        values[n] = n + 1 - ratio
        ratio = squared / (2 * n + 1 - ratio)
    return values


def dtn_degree(ka: float, size_ratio: float, accuracy: float = 1e-3) -> int:
    """Highest degree that the condition needs (theory: S2-43).

    Waves that travel: degrees above ``ka`` hardly radiate (W. J. Wiscombe, Appl. Opt. 19 (1980)
    1505-1509).  Near fields: degree l falls by q^(l + 1) from the body to the sphere and, where it
    is reflected, by q^l on its way back.  Degree N + 1 is not reflected at rest, degree N + 1 + j
    by j/(2N + 3 + j).

    Parameters
    ----------
    ka : float
        Wave number times the largest distance of the body from the sphere's centre.
    size_ratio : float
        q, this distance over the sphere's radius, below one.
    accuracy : float
        Largest share of the near field at the body that may be wrong.

    Raises
    ------
    ValueError
        If a number has no meaning, the body reaches the sphere, or more than `MOST_DEGREES`
        degrees would be needed.
    """
    if not (0.0 < accuracy < 1.0 and 0.0 <= ka < np.inf):
        raise ValueError(
            f"radiation condition: the accuracy, {accuracy:g}, must lie between 0 and 1, and "
            f"ka = {ka:g} must be a number that is not negative"
        )
    if not 0.0 < size_ratio < 1.0:
        raise ValueError(
            f"radiation condition: the body reaches {size_ratio:.3g} of the sphere's radius; "
            "it must lie inside"
        )
    travelling = ka + max(1.0, -log(accuracy) / log(10.0)) * max(ka, 1e-9) ** (1.0 / 3.0)
    for degree in range(max(1, int(np.ceil(travelling))), MOST_DEGREES + 1):
        beyond = np.arange(1, 400)
        reflected = beyond / (2 * degree + 3 + beyond)
        if np.sum(reflected * size_ratio ** (2.0 * (degree + 1 + beyond) + 1.0)) <= accuracy:
            return degree
    raise ValueError(
        f"radiation condition: with a body that reaches {size_ratio:.1%} of the sphere's radius "
        f"and ka = {ka:.3g}, {accuracy:g} needs more than {MOST_DEGREES} degrees; "
        "use a larger sphere or a lower accuracy"
    )


@dataclass(frozen=True)
class Dtn:
    """Exact condition up to a degree, elastic above it (theory: S2-42).

    Attributes
    ----------
    degree : int
        N: every outgoing wave of the degrees 0..N leaves.
    size_ratio : float
        Largest distance of the body from the centre over R; one is on the safe side.
    accuracy : float
        Share of the field that may be wrong; what `farfield.degree_notices` checks.
    name : str
        Name that accompanies every level.

    References
    ----------
    J. B. Keller, D. Givoli, J. Comput. Phys. 82 (1989) 172-192.
    """

    degree: int
    size_ratio: float = 1.0
    accuracy: float = 1e-3
    name: str = "DtN"

    def __post_init__(self) -> None:
        if self.degree < 0 or self.degree != int(self.degree):
            raise ValueError(
                f"radiation condition: the degree, {self.degree}, must be 0, 1, 2, ..."
            )

    def matrices(self, fem: ngs.Mesh, water: Water, outer: str) -> Mapping[str, csr_matrix]:
        """Q = int rho psi dpsi over the sphere."""
        return {"Q": csr_matrix(water.density * sphere_mass(fem, outer))}

    def loads(
        self, fem: ngs.Mesh, water: Water, outer: str, radius: float
    ) -> Mapping[str, csr_matrix]:
        """Y_l = sqrt(rho)/R int Y_lm dpsi over the sphere, one column a harmonic."""
        columns = harmonic_loads(fem, self.degree, radius, outer)
        scale = np.sqrt(water.density)
        return {
            f"Y{n}": csr_matrix(scale * columns[:, n**2 : (n + 1) ** 2])
            for n in range(self.degree + 1)
        }

    def factors(self, omega: complex, sound_speed: float, radius: float) -> Mapping[str, complex]:
        """-b for Q and -(d_l - b) for Y_l, with b = (N + 2)/R."""
        local = self.degree + 2.0
        exact = dtn_coefficients(self.degree, omega * radius / sound_speed)
        own = {f"Y{n}": complex(local - d) / radius for n, d in enumerate(exact)}
        return {"Q": -local / radius, **own}

    def coefficients(self, degree: int, kr: float) -> ComplexArray:
        """R d_l up to N, N + 2 above."""
        exact = dtn_coefficients(self.degree, kr)
        above = np.full(max(degree - self.degree, 0), self.degree + 2.0 + 0.0j)
        return np.concatenate([exact, above])[: degree + 1]


def fitted_dtn(
    fem: ngs.Mesh,
    highest: float,
    *,
    sound_speed: float,
    radius: float,
    accuracy: float = 1e-3,
    motion: ngs.GridFunction | None = None,
    wetted: str = f"{INTERFACE}|root",
    outer: str = "outer",
) -> Dtn:
    """Condition with the degree that a body, its sphere and a frequency need (`dtn_degree`).

    Parameters
    ----------
    fem : ngsolve.Mesh
    highest : float
        Highest frequency [Hz].
    sound_speed, radius : float
        c [m/s] and R [m].
    accuracy : float
        As in `dtn_degree`.
    motion : ngsolve.GridFunction or None
        Displacement from C0 to C1 [m].
    wetted, outer : str
        Name patterns of the body's surface and of the sphere.

    Raises
    ------
    ValueError
        If the body is too close to the sphere for the accuracy.
    """
    center = check_sphere(fem, radius, outer)
    points = surface_points(fem, wetted, 4, motion)[0]
    size = float(np.linalg.norm(points - center, axis=1).max())
    wavenumber = 2.0 * np.pi * highest / sound_speed
    ratio = size / radius
    return Dtn(dtn_degree(wavenumber * size, ratio, accuracy), ratio, accuracy)


def harmonic_loads(fem: ngs.Mesh, degree: int, radius: float, outer: str = "outer") -> FloatArray:
    """1/R int Y_lm dpsi over the sphere for all harmonics up to a degree.

    The harmonics are taken exactly, in the direction of each quadrature point from the centre.

    Returns
    -------
    (Q.ndof, (degree + 1)^2) array
        Real orthonormal harmonics, l = 0..degree and m = -l..l inside.
    """
    center = check_sphere(fem, radius, outer)
    points, weights = surface_points(fem, outer, _QUADRATURE)
    away = points - center
    away /= np.linalg.norm(away, axis=1)[:, None]
    values = [weights @ solid_harmonics(away, n)[0].T for n in range(degree + 1)]
    return np.concatenate(values, axis=1) / radius


def surface_points(
    fem: ngs.Mesh, surface: str, order: int, motion: ngs.GridFunction | None = None
) -> tuple[FloatArray, csr_matrix]:
    """Quadrature points (q, 3) on a surface, and the integrals of the potential's test functions.

    Returns
    -------
    points : (q, 3) array
        Moved by ``motion`` if there is one [m].
    weights : (Q.ndof, q) csr_matrix
        Applied to values at the points it gives int f dpsi over the surface at rest.
    """
    region = boundary(fem, surface)
    samples = IntegrationRuleSpaceSurface(fem, order=order, definedon=region)
    potential = potential_space(fem)
    form = ngs.BilinearForm(trialspace=samples, testspace=potential, check_unused=False)
    rules = samples.GetIntegrationRules()
    form += (
        samples.TrialFunction()
        * potential.TestFunction().Trace()
        * ngs.ds(definedon=region, intrules=rules)
    )
    weights = csr_of(form.Assemble())
    position = [ngs.x, ngs.y, ngs.z]
    if motion is not None:
        position = [x + motion[axis] for axis, x in enumerate(position)]
    at = ngs.GridFunction(samples)
    points = np.empty((samples.ndof, 3))
    for axis, coordinate in enumerate(position):
        at.Interpolate(coordinate, definedon=region)
        points[:, axis] = np.array(at.vec)
    return points, weights
