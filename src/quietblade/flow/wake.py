# SPDX-License-Identifier: LGPL-2.1-or-later
"""Uneven water in front of the rotor, averaged over the turn."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import PchipInterpolator

from quietblade.errors import GeometryError
from quietblade.typing import FloatArray


@dataclass(frozen=True)
class RadialWake:
    """Circumferential mean of the water's velocity in the rotor's plane, without the rotor.

    Between the radii monotone cubics, beyond them the end values (theory: S1-80).

    Attributes
    ----------
    radius : tuple of float
        Increasing radii [m].
    axial : tuple of float
        Axial velocity over the speed of advance V, ``1 - w(r)``.
    tangential : tuple of float
        Tangential velocity over V, positive in the sense of a positive rotation.

    Raises
    ------
    GeometryError
        The table is not one.
    """

    radius: tuple[float, ...]
    axial: tuple[float, ...]
    tangential: tuple[float, ...]

    def __post_init__(self) -> None:
        counts = {len(self.radius), len(self.axial), len(self.tangential)}
        if len(counts) > 1 or len(self.radius) < 2:
            raise GeometryError(
                f"wake table: {len(self.radius)} radii, {len(self.axial)} axial and "
                f"{len(self.tangential)} tangential values. Remedy: give at least two of each, "
                "as many as radii"
            )
        values = np.array([self.radius, self.axial, self.tangential])
        if not (np.all(np.isfinite(values)) and np.all(np.diff(values[0]) > 0.0)):
            raise GeometryError(
                f"wake table: radii {list(self.radius)} must increase and all values be finite. "
                "Remedy: sort the table by the radius"
            )

    def at(self, radius: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Axial and tangential velocity over V at radii of any shape [m]."""
        inside = np.clip(radius, self.radius[0], self.radius[-1])
        axial, tangential = (
            np.asarray(PchipInterpolator(self.radius, values)(inside), dtype=np.float64)
            for values in (self.axial, self.tangential)
        )
        return axial, tangential

    def mean(self, inner: float, outer: float) -> float:
        """Mean axial velocity over V of the ring between two radii [m], by volume."""
        x, weight = np.polynomial.legendre.leggauss(64)
        r = 0.5 * (inner + outer) + 0.5 * (outer - inner) * x
        return float(weight @ (self.at(r)[0] * r) / (weight @ r))


def radial_wake(
    radius: ArrayLike, axial: ArrayLike, tangential: ArrayLike | None = None
) -> RadialWake:
    """Make a wake from arrays of radii [m] and of velocities over the speed of advance.

    Without tangential velocities these are 0.

    Raises
    ------
    GeometryError
        The table is not one.
    """
    tangential = np.zeros(np.shape(axial)) if tangential is None else tangential
    columns = (np.asarray(part, dtype=np.float64).ravel() for part in (radius, axial, tangential))
    return RadialWake(*(tuple(column.tolist()) for column in columns))


def wake_of_angles(
    radius: ArrayLike, relative_speed: ArrayLike, angle: ArrayLike, *, speed: float, rotation: float
) -> RadialWake:
    """Make a wake from the inflow angle and the speed relative to the blade along the radius.

    Parameters
    ----------
    radius : array_like
        Increasing radii [m].
    relative_speed : array_like
        Speed of the water relative to the turning blade there [m/s].
    angle : array_like
        Angle of that velocity from the plane of rotation [rad], 0 to pi/2 for a ship that goes
        ahead.
    speed : float
        Speed of advance to which the table refers [m/s], not 0.
    rotation : float
        Angular velocity at which it was measured or computed [rad/s].

    Returns
    -------
    RadialWake

    Raises
    ------
    GeometryError
        The speed is 0 or the table is not one.
    """
    if speed == 0.0:
        raise GeometryError(
            "wake table: the speed of advance is 0, so that no ratio to it exists. "
            "Remedy: give the speed at which the table was made"
        )
    r, w, phi = (np.asarray(part, dtype=np.float64) for part in (radius, relative_speed, angle))
    sense = -1.0 if rotation < 0.0 else 1.0
    return radial_wake(r, w * np.sin(phi) / speed, (rotation * r - sense * w * np.cos(phi)) / speed)
