# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solids in closed form: the film's laws, a thick tube, bars of laminate."""

from dataclasses import dataclass

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq

from quietblade.typing import FloatArray

# -- incompressible Mooney-Rivlin solid -----------------------------------------------------------


def uniaxial_stress(stretch: float, c10: float, c01: float) -> float:
    """Nominal stress ``2 (l - l^-2) (c10 + c01/l)`` [Pa] of a bar under a stretch l."""
    return 2.0 * (stretch - stretch**-2) * (c10 + c01 / stretch)


def shear_stress(shear: float, c10: float, c01: float) -> float:
    """Shear stress ``2 (c10 + c01) gamma`` [Pa] of simple shear, exactly linear."""
    return 2.0 * (c10 + c01) * shear


@dataclass(frozen=True)
class ThickTube:
    """Long tube of incompressible Mooney-Rivlin solid under internal pressure, plane strain.

    With ``r^2 = R^2 + C`` and ``l = r/R`` the radial stress falls from zero outside by
    ``2 (c10 + c01) (l^2 - l^-2) dr/r`` (J. T. Oden, Finite Elements of Nonlinear Continua, 1972).

    Attributes
    ----------
    inner, outer : float
        Radii without load.
    c10, c01 : float
        Constants of the solid.
    pressure : float
        Pressure inside, in the unit of the constants.
    """

    inner: float
    outer: float
    c10: float
    c01: float
    pressure: float

    def displacement(self, radius: float) -> float:
        """Radial displacement of a point at an undeformed radius."""
        return float(np.sqrt(radius**2 + self._swelling()) - radius)

    def radial_stress(self, radius: float) -> float:
        """Radial Cauchy stress at a point of an undeformed radius."""
        return -self._carried(radius, self._swelling())

    def _swelling(self) -> float:
        """Constant C of ``r^2 = R^2 + C``.

        Raises
        ------
        ValueError
            If the tube bursts: its resistance is bounded.
        """
        most = 1e3 * self.outer**2
        if self._carried(self.inner, most) < self.pressure:
            raise ValueError(f"the tube cannot carry a pressure of {self.pressure:g}")
        return float(
            brentq(lambda c: self._carried(self.inner, c) - self.pressure, 0.0, most, xtol=1e-12)
        )

    def _carried(self, radius: float, swelling: float) -> float:
        """Rise of the radial stress from a radius to the outside."""

        def rise(R: float) -> float:
            square = 1.0 + swelling / R**2
            return (square - 1.0 / square) / (R * square)  # dr/r = dR/(R l^2)

        return 2.0 * (self.c10 + self.c01) * quad(rise, radius, self.outer, epsabs=0.0)[0]


# -- bars of rectangular section ------------------------------------------------------------------


@dataclass(frozen=True)
class BeamStiffness:
    """Moments by curvature and twist, ``M = EI w'' + K phi'``, ``T = K w'' + GJ phi'``.

    Attributes
    ----------
    bending, torsion, coupling : float
        EI, GJ and K [N m2].
    """

    bending: float
    torsion: float
    coupling: float

    def compliance(self) -> FloatArray:
        """Curvature and twist of a unit moment and a unit torque, (2, 2) [1/(N m2)]."""
        return np.linalg.inv([[self.bending, self.coupling], [self.coupling, self.torsion]])


def laminate_beam(
    width: float,
    thickness: float,
    angle: float,
    *,
    e1: float,
    e2: float,
    g12: float,
    nu12: float,
) -> BeamStiffness:
    """Thin bar of one ply, its fibres turned by an angle from the axis, as a plate strip.

    The strip is thin and free to curve across, and the end effect of torsion is left out:
    ``EI = b (D11 - D12^2/D22)``, ``K = 2 b (D16 - D12 D26/D22)``, ``GJ = 4 b (D66 - D26^2/D22)``
    with the plate's stiffness ``D = Q t^3/12`` (R. M. Jones, Mechanics of Composite Materials).

    Parameters
    ----------
    width, thickness : float
        b, t [m].
    angle : float
        From the axis to the fibres [rad].
    e1, e2, g12, nu12 : float
        Constants of the ply [Pa].
    """
    D = thickness**3 / 12.0 * np.linalg.inv(ply_compliance(angle, e1=e1, e2=e2, g12=g12, nu12=nu12))
    return BeamStiffness(
        width * (D[0, 0] - D[0, 1] ** 2 / D[1, 1]),
        4.0 * width * (D[2, 2] - D[1, 2] ** 2 / D[1, 1]),
        2.0 * width * (D[0, 2] - D[0, 1] * D[1, 2] / D[1, 1]),
    )


def ply_compliance(angle: float, *, e1: float, e2: float, g12: float, nu12: float) -> FloatArray:
    """Compliance (3, 3) [1/Pa] of a ply in plane stress (strains along, across, engineering shear).

    Axes are turned by ``-angle`` from the fibres: the fibres lie at ``angle`` from the first axis.
    """
    c, s = np.cos(angle), np.sin(angle)
    S = np.array([[1 / e1, -nu12 / e1, 0.0], [-nu12 / e1, 1 / e2, 0.0], [0.0, 0.0, 1 / g12]])
    turn = np.array(
        [[c * c, s * s, 2 * c * s], [s * s, c * c, -2 * c * s], [-c * s, c * s, c * c - s * s]]
    )
    return np.asarray(turn.T @ S @ turn)


def rectangle_torsion(
    width: float, thickness: float, along_width: float, along_thickness: float
) -> float:
    """Torsional stiffness GJ [N m2] of a rectangular bar, orthotropic along its edges.

    Parameters
    ----------
    width, thickness : float
        Edges of the section [m], any order.
    along_width, along_thickness : float
        Shear moduli between the bar's axis and each edge [Pa].

    Notes
    -----
    Series of S. G. Lekhnitskii, Theory of Elasticity of an Anisotropic Body, section 44.
    """
    n = np.arange(1.0, 60.0, 2.0)
    slenderness = width / thickness * np.sqrt(along_thickness / along_width)
    edge = np.sum(np.tanh(0.5 * np.pi * n * slenderness) / n**5) * 192.0 / np.pi**5 / slenderness
    return float(along_width * width * thickness**3 / 3.0 * (1.0 - edge))
