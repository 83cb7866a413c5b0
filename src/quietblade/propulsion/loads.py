# SPDX-License-Identifier: LGPL-2.1-or-later
"""Loads that a user gives: what they are, not yet what they do to a mesh.

`quietblade.propulsion.loads_assembly` turns them into nodal pressures, which follow the deformed
surface, and dead forces, which keep place and direction (theory: S1-50 to S1-55).
"""

from dataclasses import dataclass
from math import isfinite
from typing import Literal, TypeAlias

import numpy as np

from quietblade.errors import QuietbladeError
from quietblade.typing import FloatArray

Vector: TypeAlias = tuple[float, float, float]

STANDARD_GRAVITY = 9.80665
"""[m/s2]"""


class LoadError(QuietbladeError):
    """A load is not possible, or does not fit the blade."""


@dataclass(frozen=True)
class UniformPressure:
    """The same pressure on the whole wetted surface; it follows the surface.

    Attributes
    ----------
    pressure : float
        Above the pressure at rest [Pa]; positive pushes into the blade.
    """

    pressure: float

    def __post_init__(self) -> None:
        _finite("uniform pressure", self.pressure)


@dataclass(frozen=True, eq=False)
class PressureAtPoints:
    """Pressure known at points of the surface, as from a flow computation or from taps.

    A node of the surface takes the value of the nearest point.

    Attributes
    ----------
    points : (n, 3) float array
        Places on the undeformed blade [m].
    pressure : (n,) float array
        Above the pressure at rest [Pa].
    reach : float
        Largest distance [m] of a node from its point.
    """

    points: FloatArray
    pressure: FloatArray
    reach: float

    def __post_init__(self) -> None:
        _finite("pressure at points", self.points, self.pressure, self.reach)
        if self.points.shape != (len(self.pressure), 3) or len(self.pressure) == 0:
            raise LoadError(
                f"pressure at points: places of shape {self.points.shape} do not fit "
                f"{self.pressure.shape} pressures; give (n, 3) and (n,)"
            )


@dataclass(frozen=True, eq=False)
class PressureTable:
    """Pressure over span fraction and chord fraction, on the upper and the lower side.

    Linear between the rows and columns.  A node belongs to the side whose face is nearer.

    Attributes
    ----------
    s, xi : (m,), (n,) float arrays
        Span fractions (0 root, 1 tip) and chord fractions (0 leading edge), increasing; both have
        to reach from 0 to 1, since nothing is extrapolated.
    upper, lower : (m, n) float arrays
        Above the pressure at rest [Pa].
    """

    s: FloatArray
    xi: FloatArray
    upper: FloatArray
    lower: FloatArray

    def __post_init__(self) -> None:
        _finite("pressure table", self.s, self.xi, self.upper, self.lower)
        for name, grid in (("s", self.s), ("xi", self.xi)):
            if len(grid) < 2 or (np.diff(grid) <= 0.0).any():
                raise LoadError(f"pressure table: {name} has to increase, got {grid.tolist()}")
            if grid[0] > 0.0 or grid[-1] < 1.0:
                raise LoadError(
                    f"pressure table: {name} reaches from {grid[0]:g} to {grid[-1]:g}; add values "
                    "at 0 and 1, since nothing is extrapolated"
                )
        shape = (len(self.s), len(self.xi))
        if self.upper.shape != shape or self.lower.shape != shape:
            raise LoadError(
                f"pressure table: values of shape {self.upper.shape} (upper) and "
                f"{self.lower.shape} (lower) do not fit the grid {shape}"
            )


@dataclass(frozen=True)
class HydrostaticPressure:
    """Pressure of the water's weight, ``p_surface + rho g depth``, on the wetted surface.

    It follows the turning of the surface; the depth is that of the undeformed place.

    Attributes
    ----------
    water_density : float
        [kg/m3]
    depth : float
        Depth of the frame's origin, on the rotor axis, below the free surface [m].
    gravity : tuple of 3 floats
        Acceleration in the blade's frame [m/s2]; it points down.  In the blade's frame it turns
        with ``-omega_p`` about x, so a component across the axis is that of one instant.
    position : {"mean", "frozen"}
        ``mean``: over one turn, where the part of gravity across the rotor axis averages out: with
        a horizontal axis a uniform pressure.  ``frozen``: the blade in the given direction.
    surface_pressure : float
        Pressure at the free surface [Pa], as far as it is not part of the pressure at rest.
    """

    water_density: float
    depth: float
    gravity: Vector = (0.0, 0.0, -STANDARD_GRAVITY)
    position: Literal["mean", "frozen"] = "mean"
    surface_pressure: float = 0.0

    def __post_init__(self) -> None:
        _finite(
            "hydrostatic pressure", self.water_density, self.depth, self.gravity,
            self.surface_pressure,
        )  # fmt: skip
        if self.position not in ("mean", "frozen"):
            raise LoadError(
                f"hydrostatic pressure: position {self.position!r} is neither 'mean' nor 'frozen'"
            )
        if self.water_density <= 0.0:
            raise LoadError(
                f"hydrostatic pressure: water density {self.water_density:g} kg/m3 is not positive"
            )


@dataclass(frozen=True)
class Gravity:
    """Weight of the solid; its buoyancy is not implied, it comes from `HydrostaticPressure`.

    Attributes
    ----------
    acceleration : tuple of 3 floats
        In the blade's frame [m/s2].
    """

    acceleration: Vector = (0.0, 0.0, -STANDARD_GRAVITY)

    def __post_init__(self) -> None:
        _finite("gravity", self.acceleration)


@dataclass(frozen=True)
class PointForce:
    """A dead force on a point of the blade.

    Attributes
    ----------
    place : tuple of 3 floats
        On or in the undeformed blade [m]; a place off the blade moves to the nearest point of its
        surface.
    force : tuple of 3 floats
        [N]
    tolerance : float
        Largest distance from the blade [m].
    """

    place: Vector
    force: Vector
    tolerance: float = 1e-3

    def __post_init__(self) -> None:
        _finite("point force", self.place, self.force, self.tolerance)


@dataclass(frozen=True, eq=False)
class LineForce:
    """A dead force per length along a chain of straight lines on the blade.

    Attributes
    ----------
    path : (n, 3) float array
        Corners of the chain on or in the undeformed blade [m].
    force : (3,) or (n, 3) float array
        Force per length of the chain [N/m], the same everywhere, or linear between the corners.
    tolerance : float
        Largest distance from the blade [m].
    """

    path: FloatArray
    force: FloatArray
    tolerance: float = 1e-3

    def __post_init__(self) -> None:
        _finite("line force", self.path, self.force, self.tolerance)
        n = len(self.path)
        if n < 2 or self.path.shape != (n, 3) or self.force.shape not in ((3,), (n, 3)):
            raise LoadError(
                f"line force: a path of shape {self.path.shape} and a force of shape "
                f"{self.force.shape}; give at least two corners (n, 3), and (3,) or (n, 3)"
            )
        if (np.linalg.norm(np.diff(self.path, axis=0), axis=1) == 0.0).any():
            raise LoadError("line force: two corners in a row are the same point")


PressureLoad = UniformPressure | PressureAtPoints | PressureTable | HydrostaticPressure
DeadLoad = Gravity | PointForce | LineForce
Load = PressureLoad | DeadLoad
"""Any load that a user gives."""


def _finite(load: str, *values: float | Vector | FloatArray) -> None:
    for value in values:
        array = np.asarray(value, dtype=float)
        if not np.isfinite(array).all():
            bad = next(v for v in array.ravel().tolist() if not isfinite(v))
            raise LoadError(f"{load}: {bad} is not a finite number")
