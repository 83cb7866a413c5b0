# SPDX-License-Identifier: LGPL-2.1-or-later
r"""A clamped bar in torsion whose lift acts ahead of its axis: the simplest aeroelastic blade.

With the twist :math:`\theta(y)`, the torsional stiffness GJ, the chord c, the distance e of the
lift ahead of the elastic axis and the lift slope :math:`a_0`,

.. math::
    GJ\, \theta'' + q\, e\, c\, C_L(\alpha_0 + \theta) = 0, \qquad \theta(0) = 0, \quad
    \theta'(l) = 0 .

For the linear lift :math:`C_L = a_0 \alpha` the twist is
:math:`\theta = \alpha_0 (\cos\lambda(l - y) / \cos\lambda l - 1)` with
:math:`\lambda^2 = q e c a_0 / GJ`, without bound at the divergence pressure
:math:`q_D = (\pi / 2)^2 GJ / (e c a_0 l^2)` (Bisplinghoff, Ashley and Halfman, *Aeroelasticity*,
1955, chapter 8). A lift behind the axis (e < 0) washes out: there is a solution at any q.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from quietblade.typing import FloatArray


def divergence_pressure(
    stiffness: float, arm: float, chord: float, slope: float, length: float
) -> float:
    """Dynamic pressure at which a uniform clamped bar diverges in torsion.

    Parameters
    ----------
    stiffness : float
        GJ [N m2].
    arm : float
        Lift ahead of the elastic axis, e [m]; negative: behind it.
    chord, length : float
        [m]
    slope : float
        Lift slope a0 [1/rad].

    Returns
    -------
    float
        [Pa]; negative if the bar washes out.
    """
    return float((0.5 * np.pi) ** 2 * stiffness / (arm * chord * slope * length**2))


@dataclass(frozen=True)
class TorsionBar:
    """The bar in stations, as a fixed point of its twist.

    Attributes
    ----------
    stiffness, arm, chord, slope, length : float
        As for `divergence_pressure`.
    incidence : float
        At rest [rad].
    pressure : float
        Dynamic pressure q [Pa].
    softening : float
        Incidence scale s of the lift curve ``C_L = a0 s tanh(alpha / s)`` [rad]; infinite: linear.
    stations : int
        Equal parts of the length, by finite differences of second order.
    """

    stiffness: float = 1.0e3
    arm: float = 0.05
    chord: float = 0.2
    slope: float = 2.0 * np.pi
    length: float = 1.0
    incidence: float = 0.1
    pressure: float = 1.0e4
    softening: float = np.inf
    stations: int = 40

    @property
    def share(self) -> float:
        """Dynamic pressure over the divergence pressure; negative if the bar washes out."""
        return self.pressure / divergence_pressure(
            self.stiffness, self.arm, self.chord, self.slope, self.length
        )

    @cached_property
    def places(self) -> FloatArray:
        """Stations y, without the clamped one, (stations,) [m]."""
        return np.arange(1, self.stations + 1) * self.length / self.stations

    def lift(self, alpha: FloatArray) -> FloatArray:
        """Lift coefficient at incidences [rad]."""
        if np.isinf(self.softening):
            return self.slope * alpha
        return np.asarray(self.slope * self.softening * np.tanh(alpha / self.softening))

    def image(self, twist: FloatArray) -> FloatArray:
        """Twist under the moment of a twisted bar: one pass of flow and structure, (stations,)."""
        moment = self.pressure * self.arm * self.chord * self.lift(self.incidence + twist)
        step = self.length / self.stations
        load = np.asarray(moment) * step
        load[-1] *= 0.5
        torque = np.cumsum(load[::-1])[::-1]  # at the middles of the parts
        return np.asarray(np.cumsum(torque * step / self.stiffness))

    def exact_twist(self) -> FloatArray:
        """Twist of the bar with linear lift, by the closed form, (stations,) [rad]."""
        square = self.share * (0.5 * np.pi) ** 2  # (lambda l)^2
        root = np.sqrt(complex(square))
        y = self.places / self.length
        return np.asarray(self.incidence * ((np.cos(root * (1.0 - y)) / np.cos(root)).real - 1.0))

    @property
    def eigenvalue(self) -> float:
        """Largest eigenvalue of `image` with linear lift, of the bar in stations.

        ``mu = q e c a0 h^2 / (GJ (2 - 2 cos(pi / (2 n))))``, near ``q / q_D``.
        """
        step = self.length / self.stations
        load = self.pressure * self.arm * self.chord * self.slope * step**2 / self.stiffness
        return float(load / (2.0 - 2.0 * np.cos(0.5 * np.pi / self.stations)))


def bar_at(share: float, **changes: float) -> TorsionBar:
    """Return the default bar at a share of its divergence pressure; below 0 it washes out."""
    bar = TorsionBar(**changes)  # type: ignore[arg-type]
    arm = np.sign(share) * bar.arm
    q = share * divergence_pressure(bar.stiffness, arm, bar.chord, bar.slope, bar.length)
    return TorsionBar(**{**changes, "arm": arm, "pressure": q})  # type: ignore[arg-type]
