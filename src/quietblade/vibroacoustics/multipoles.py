# SPDX-License-Identifier: LGPL-2.1-or-later
"""Outgoing multipoles from the motion and the pressure of the closed wetted surface.

The Kirchhoff-Helmholtz (Green) integral of a field against a regular wave vanishes for everything
that comes in from outside the surface.  It therefore sees the outgoing waves only, and not those
that an approximate condition on the outer sphere sends back: a second, independent way to the
power (theory: S2-9).
"""

from dataclasses import dataclass, replace
from math import isqrt
from typing import Self

import ngsolve as ngs
import numpy as np
from scipy.sparse import csr_matrix

from quietblade.errors import Notice
from quietblade.mesh.nodal import NodalBasis
from quietblade.typing import AnyArray, ComplexArray, FloatArray, IntArray
from quietblade.vibroacoustics.fluid import Water, coupling_matrix
from quietblade.vibroacoustics.harmonics import outgoing, radial_factors, solid_harmonics
from quietblade.vibroacoustics.operators import Operators, product_space

CLOSED_SURFACE = "wet|excited|root"


@dataclass(frozen=True)
class Multipoles:
    """Amplitudes of the outgoing waves psi = sum a_lm h_l(k r) Y_lm, h_l of the second kind.

    Attributes
    ----------
    center : (3,) array
        Where the spherical waves come from [m].
    omega : (f,) array
        Angular frequencies [rad/s].
    amplitudes : (f, (degree + 1)^2) complex array
        a_lm, real orthonormal harmonics, l = 0..degree and m = -l..l inside [m2/s].
    water : Water
    reach : float
        Distance from the centre beyond which the sum is the field [m].
    """

    center: FloatArray
    omega: FloatArray
    amplitudes: ComplexArray
    water: Water
    reach: float

    @property
    def tail(self) -> FloatArray:
        """Share of the two last degrees in the power (f,): what the cut-off may have left out."""
        return np.asarray(self.power_by_degree[:, -2:].sum(axis=-1) / self.power)

    @property
    def degree(self) -> int:
        """Highest degree kept."""
        return isqrt(self.amplitudes.shape[-1]) - 1

    @property
    def power_by_degree(self) -> FloatArray:
        """Power of each degree, (f, degree + 1) [W]: rho c / 2 times the sum of |a_lm|^2."""
        water = self.water
        each = 0.5 * water.density * water.sound_speed * np.abs(self.amplitudes) ** 2
        starts = np.arange(self.degree + 1) ** 2
        return np.asarray(np.add.reduceat(each, starts, axis=-1))

    @property
    def power(self) -> FloatArray:
        """Radiated power (f,) [W]."""
        return np.asarray(self.power_by_degree.sum(axis=-1))

    @property
    def share(self) -> FloatArray:
        """Share of each degree in the power, (f, degree + 1): monopole, dipole, quadrupole, ..."""
        return np.asarray(self.power_by_degree / self.power[:, None])

    def only(self, chosen: AnyArray) -> Self:
        """Return the same waves at some of the frequencies, by their places or a mask."""
        return replace(self, omega=self.omega[chosen], amplitudes=self.amplitudes[chosen])

    def far_field(self, directions: FloatArray) -> ComplexArray:
        """Far pressure times distance, p r exp(i k r) for r to infinity [Pa m].

        Parameters
        ----------
        directions : (d, 3) array
            Unit vectors from the centre.

        Returns
        -------
        (f, d) complex array
            rho c times the sum of i^l a_lm Y_lm.
        """
        pressure = np.zeros((len(self.omega), len(directions)), dtype=np.complex128)
        for degree in range(self.degree + 1):
            harmonics, _ = solid_harmonics(directions, degree)
            part = self.amplitudes[:, degree**2 : (degree + 1) ** 2]
            pressure += 1j**degree * (part @ harmonics)
        return self.water.density * self.water.sound_speed * pressure

    def pressure(self, points: FloatArray) -> ComplexArray:
        """Sound pressure at points outside the ball that holds the body [Pa].

        Parameters
        ----------
        points : (p, 3) array
            [m]

        Returns
        -------
        (f, p) complex array
            -i omega rho times the sum of a_lm h_l(k r) Y_lm (theory: S2-46).

        Raises
        ------
        ValueError
            If a point lies within `reach` of the centre, where the sum need not be the field.
        """
        away = points - self.center
        distance = np.linalg.norm(away, axis=1)
        if distance.min() < self.reach * (1.0 - 1e-9):
            raise ValueError(
                f"multipoles: a point at {distance.min():.4g} m from the centre is inside the ball "
                f"of {self.reach:.4g} m that holds the body; use SurfaceSources.pressure there"
            )
        kr = self.omega[:, None] / self.water.sound_speed * distance
        potential = np.zeros(kr.shape, dtype=np.complex128)
        for degree in range(self.degree + 1):
            harmonics, _ = solid_harmonics(away / distance[:, None], degree)
            part = self.amplitudes[:, degree**2 : (degree + 1) ** 2]
            potential += outgoing(degree, kr) * (part @ harmonics)
        return np.asarray(-1j * self.omega[:, None] * self.water.density * potential)

    def notices(self, limit: float = 1e-2) -> list[Notice]:
        """Says where the sum over degrees has not converged."""
        worst = int(np.argmax(self.tail))
        if self.tail[worst] <= limit:
            return []
        return [
            Notice(
                f"multipoles at {self.omega[worst] / (2.0 * np.pi):.4g} Hz",
                f"the power of degrees {self.degree - 1} and {self.degree} is not negligible",
                float(self.tail[worst]),
                limit,
                "raise the highest degree",
            )
        ]


@dataclass(frozen=True)
class SurfaceSources:
    """Nodal weights of the velocity and of the potential on the closed wetted surface.

    Attributes
    ----------
    points : (m, 3) array
        Nodes of the surface in the configuration [m].
    center : (3,) array
        Centre of the spherical waves [m].
    flux : (m, n) csr_matrix
        int N_i (u . n) of the free unknowns, for the nodal shape functions N_i [m2].
    doublet : three (m, n) csr_matrix
        int N_i n_x psi, and for y and z [m2].
    water : Water
    """

    points: FloatArray
    center: FloatArray
    flux: csr_matrix
    doublet: tuple[csr_matrix, csr_matrix, csr_matrix]
    water: Water

    @classmethod
    def of(
        cls,
        fem: ngs.Mesh,
        basis: NodalBasis,
        operators: Operators,
        *,
        motion: ngs.GridFunction | None = None,
        surface: str = CLOSED_SURFACE,
        center: FloatArray | None = None,
        carried: csr_matrix | None = None,
    ) -> Self:
        """Integrate the sources over the closed surface.

        Parameters
        ----------
        operators : Operators
            Of the same configuration: gives the water and the numbering of the free unknowns.
        motion : ngsolve.GridFunction or None
            Displacement of the mesh from C0 to C1 [m].
        surface : str
            Name pattern of *all* faces between water and solid: also the clamped root, which does
            not move but reflects.
        center : (3,) array or None
            None takes the middle of the surface's bounding box; the power does not depend on it,
            the number of degrees does.
        carried : (V.ndof, n) csr_matrix or None
            Displacement unknowns of a root that moves, from all unknowns: `RootedSystem.carried`
            and `ShaftSystem.carried`.  Without it the root's face is at rest.
        """
        water = Water(operators.density, operators.sound_speed)
        nodes = basis.nodes_of(surface, codimension=1)
        points = basis.points[nodes]
        if motion is not None:
            points = points + basis.to_values(np.array(motion.vec))[nodes]
        middle = 0.5 * (points.min(axis=0) + points.max(axis=0)) if center is None else center
        # Full numbering: the gradient of a wave does not vanish on clamped nodes.
        coupling = csr_matrix(coupling_matrix(fem, water, surface, motion) / water.density)
        space = product_space(fem)
        to_free = _selection(operators.free, space.ndof, operators.size)
        to_nodes = basis.interpolation[:, nodes].T
        moving = to_free[: coupling.shape[0]]
        flux = to_nodes @ coupling.T @ (moving if carried is None else moving + carried)
        potential = to_free[space.Range(2).start :]
        rows = np.split(np.arange(coupling.shape[0]), 3)
        x, y, z = (csr_matrix(to_nodes @ coupling[row] @ potential) for row in rows)
        return cls(points, np.asarray(middle), csr_matrix(flux), (x, y, z), water)

    def on(self, columns: FloatArray) -> "SurfaceSources":
        """Return the sources as functions of coordinates on vectors (k, n)."""
        flux, *doublet = (csr_matrix(part @ columns.T) for part in (self.flux, *self.doublet))
        return replace(self, flux=flux, doublet=(doublet[0], doublet[1], doublet[2]))

    def multipoles(
        self,
        omega: FloatArray,
        response: ComplexArray,
        *,
        tolerance: float = 1e-4,
        max_degree: int = 20,
    ) -> Multipoles:
        """Outgoing waves of a response.

        With the regular waves g = j_l(k r) Y_lm about the centre,
        a_lm = -i k int (g i omega u . n - psi dg/dn), n out of the fluid (theory: S2-9).

        Parameters
        ----------
        omega : (f,) array
            Angular frequencies [rad/s].
        response : (f, n) array
            Free unknowns.
        tolerance : float
            The sum stops when two degrees in a row add less than this share of the power at every
            frequency.
        max_degree : int
            Highest degree in any case.
        """
        omega = np.atleast_1d(np.asarray(omega, dtype=np.float64))
        response = np.atleast_2d(response)
        wavenumber = omega / self.water.sound_speed
        away = self.points - self.center
        scale = float(np.linalg.norm(away, axis=1).max())
        away = away / scale
        distance = np.linalg.norm(away, axis=1)
        velocity = 1j * omega[:, None] * (self.flux @ response.T).T
        doublet = np.stack([(part @ response.T).T for part in self.doublet], axis=1) / scale
        radial = np.einsum("fin,ni->fn", doublet, away)
        found: list[ComplexArray] = []
        powers: list[FloatArray] = []
        for degree in range(max_degree + 1):
            harmonics, gradients = solid_harmonics(away, degree)
            value, slope = radial_factors(distance, wavenumber * scale, degree)
            integral = (value * velocity - slope * radial) @ harmonics.T
            for axis in range(3):
                integral -= (value * doublet[:, axis]) @ gradients[:, axis].T
            found.append(-1j * wavenumber[:, None] * integral)
            powers.append(np.sum(np.abs(found[-1]) ** 2, axis=1))
            if degree > 1 and np.all(powers[-1] + powers[-2] < tolerance * sum(powers)):
                break
        return Multipoles(self.center, omega, np.concatenate(found, axis=1), self.water, scale)

    def pressure(
        self, omega: FloatArray, response: ComplexArray, points: FloatArray
    ) -> ComplexArray:
        """Sound pressure at points of the water by the Kirchhoff-Helmholtz integral [Pa].

        psi = int (G i omega u . n - psi dG/dn) with G = exp(-i k r)/(4 pi r) (theory: S2-45).  It
        holds everywhere outside the body, and is accurate a few cells away from it.

        Parameters
        ----------
        omega : (f,) array
            Angular frequencies [rad/s].
        response : (f, n) array
            Unknowns.
        points : (p, 3) array
            [m]

        Returns
        -------
        (f, p) complex array
        """
        omega = np.atleast_1d(np.asarray(omega, dtype=np.float64))
        response = np.atleast_2d(response)
        velocity = 1j * omega[:, None] * (self.flux @ response.T).T
        doublet = np.stack([(part @ response.T).T for part in self.doublet], axis=2)
        potential = np.empty((len(omega), len(points)), dtype=np.complex128)
        for column, point in enumerate(points):
            away = self.points - point
            distance = np.linalg.norm(away, axis=1)
            phase = 1j * omega[:, None] / self.water.sound_speed
            green = np.exp(-phase * distance) / (4.0 * np.pi * distance)
            slope = -(phase + 1.0 / distance) * green / distance
            along = np.einsum("fnx,nx->fn", doublet, away)
            potential[:, column] = np.sum(green * velocity - slope * along, axis=1)
        return -1j * omega[:, None] * self.water.density * potential


def _selection(free: IntArray, full: int, size: int) -> csr_matrix:
    """Matrix (full, size) that puts the free unknowns, the first ones, into the full numbering."""
    ones: AnyArray = np.ones(len(free))
    return csr_matrix((ones, (free, np.arange(len(free)))), shape=(full, size))
