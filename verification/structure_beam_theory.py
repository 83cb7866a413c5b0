# SPDX-License-Identifier: LGPL-2.1-or-later
"""Slender beams in closed form: the elastica, and frequencies of stretched and rotating beams.

Everything is dimensionless: lengths over L, forces times L^2/EI, moments times L/EI, loads per
length times L^3/EI, frequencies times ``sqrt(m L^4/EI)``.
"""

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import Legendre
from scipy.integrate import solve_ivp
from scipy.linalg import eigh
from scipy.optimize import brentq

from quietblade.typing import FloatArray

_RITZ_FUNCTIONS = 16
_GAUSS_POINTS = 48


@dataclass(frozen=True)
class Tip:
    """Where the tip of a bent cantilever is.

    Attributes
    ----------
    u, w : float
        Shortening along the undeformed axis and deflection across it, over the length.
    angle : float
        Rotation of the tip [rad].
    """

    u: float
    w: float
    angle: float


def elastica(force: float = 0.0, line: float = 0.0) -> Tip:
    """Cantilever without stretch or shear under loads of fixed direction across its axis.

    Parameters
    ----------
    force : float
        Tip force, ``P L^2/EI``.
    line : float
        Uniform load, ``q L^3/EI``.

    Notes
    -----
    ``theta'' = -(force + line (1 - s)) cos theta``, integrated from the tip; its angle there is
    the root of ``theta(0) = 0`` (S. P. Timoshenko and J. M. Gere, Theory of Elastic Stability,
    2nd ed., section 2.7).
    """

    def root(angle: float) -> FloatArray:
        return _from_tip(angle, force, line, follow=False)

    if force == line == 0.0:
        return Tip(0.0, 0.0, 0.0)
    # a tip that hangs along the load feels no moment and makes the whole beam hang
    angle = float(brentq(lambda a: root(a)[0], 0.0, np.pi / 2, xtol=1e-12))
    _, x, y = root(angle)
    return Tip(float(1.0 + x), float(-y), angle)


def follower_elastica(force: float = 0.0, line: float = 0.0) -> Tip:
    """Cantilever as `elastica`, under loads that stay perpendicular to its axis.

    Seen from the tip everything is known there, so that one integration is enough.
    """
    angle, x, y = _from_tip(0.0, force, line, follow=True)
    c, s = np.cos(angle), np.sin(angle)
    return Tip(float(1.0 + c * x + s * y), float(s * x - c * y), float(-angle))


def rolled(moment: float) -> Tip:
    """Cantilever under an end moment ``M L/EI``: an arc of a circle."""
    if moment == 0.0:
        return Tip(0.0, 0.0, 0.0)
    arc = np.sin(moment) / moment
    return Tip(float(1.0 - arc), float((1.0 - np.cos(moment)) / moment), moment)


def _from_tip(angle: float, force: float, line: float, *, follow: bool) -> FloatArray:
    """Angle and place of the root, seen from a tip at the origin with a given angle, (3,)."""

    def inwards(_: float, state: FloatArray) -> list[float]:
        phi, _x, _y, moment, across, up = state
        c, s = np.cos(phi), np.sin(phi)
        push = (-line * s, line * c) if follow else (0.0, line)
        return [-moment, -c, -s, c * up - s * across, *push]

    start = [angle, 0.0, 0.0, 0.0, 0.0, force]
    path = solve_ivp(inwards, (0.0, 1.0), start, method="DOP853", rtol=1e-9, atol=1e-11)
    return np.asarray(path.y[:3, -1])


def rotating_cantilever(
    speed: float, *, hub_ratio: float = 0.0, count: int = 3
) -> tuple[FloatArray, FloatArray]:
    """Frequencies of a uniform cantilever that rotates about an axis across its root.

    Parameters
    ----------
    speed : float
        ``Omega sqrt(m L^4/EI)``.
    hub_ratio : float
        Radius of the root over the length.
    count : int
        Number of modes.

    Returns
    -------
    flap, edge : (count,) arrays
        Out of the plane of rotation and in it; ``edge^2 = flap^2 - speed^2``, NaN if negative.

    Notes
    -----
    Ritz' method with polynomials, converged to 1e-8 (A. D. Wright, C. E. Smith, R. W. Thresher
    and J. L. C. Wang, J. Appl. Mech. 49 (1982) 197-202, have the same numbers by Frobenius'
    method).
    """
    squares, _ = _ritz(speed**2, hub_ratio, 0.0)
    flap, edge = squares[:count], squares[:count] - speed**2
    return np.sqrt(flap), np.sqrt(np.where(edge >= 0.0, edge, np.nan))


def southwell(count: int = 3, *, hub_ratio: float = 0.0) -> FloatArray:
    """Coefficients K of ``flap^2 = flap(0)^2 + K speed^2`` at low speed, (count,)."""
    _, shapes = _ritz(0.0, 0.0, 0.0)
    slopes = _basis()[1] @ shapes
    x, weight = _gauss()
    return np.asarray((weight * _tension(x, hub_ratio)) @ slopes**2)[:count]


def axially_loaded_cantilever(force: float, count: int = 3) -> FloatArray:
    """Squares of the frequencies under a dead axial tip force ``N L^2/EI``, tension positive.

    The first is zero at Euler's load -pi^2/4 and negative beyond.
    """
    return _ritz(0.0, 0.0, force)[0][:count]


def simply_supported_beam(force: float, count: int = 3) -> FloatArray:
    """Squares ``(n pi)^4 (1 + N L^2/(n^2 pi^2 EI))`` of the frequencies of a beam on two hinges."""
    n = np.arange(1, count + 1) * np.pi
    return np.asarray(n**4 * (1.0 + force / n**2))


def _ritz(speed_squared: float, hub_ratio: float, force: float) -> tuple[FloatArray, FloatArray]:
    """Squared flap frequencies, and shapes in columns, of unit mass."""
    value, slope, curvature = _basis()
    x, weight = _gauss()
    tension = speed_squared * _tension(x, hub_ratio) + force
    stiffness = (curvature.T * weight) @ curvature + (slope.T * (weight * tension)) @ slope
    squares, shapes = eigh(stiffness, (value.T * weight) @ value)
    return squares, shapes


def _tension(x: FloatArray, hub_ratio: float) -> FloatArray:
    """Centrifugal force at x over ``m Omega^2 L^2``."""
    return hub_ratio * (1.0 - x) + 0.5 * (1.0 - x**2)


def _gauss() -> tuple[FloatArray, FloatArray]:
    x, weight = np.polynomial.legendre.leggauss(_GAUSS_POINTS)
    return 0.5 * (x + 1.0), 0.5 * weight


def _basis() -> tuple[FloatArray, FloatArray, FloatArray]:
    """Clamped polynomials ``x^2 P_n(2x - 1)`` with two derivatives at the Gauss points."""
    x, _ = _gauss()
    square = Legendre.basis(2, domain=[0, 1]) + 3 * Legendre.basis(1, domain=[0, 1]) + 2.0
    functions = [square / 6 * Legendre.basis(n, domain=[0, 1]) for n in range(_RITZ_FUNCTIONS)]
    values, slopes, curvatures = (
        np.stack([f.deriv(order)(x) for f in functions], axis=1) for order in (0, 1, 2)
    )
    return values, slopes, curvatures
