# SPDX-License-Identifier: LGPL-2.1-or-later
"""Loads of the structure and the straight path between two of them."""

from dataclasses import dataclass

from quietblade.typing import FloatArray


@dataclass(frozen=True)
class Spin:
    """Steady rotation about the x axis through the origin.

    Attributes
    ----------
    omega : float
        Rotation rate [rad/s].
    """

    omega: float = 0.0


@dataclass(frozen=True, eq=False)
class Loading:
    """All that loads the structure.

    Attributes
    ----------
    pressure : (n,) float array
        Pressure [Pa] at the mesh's nodes; it follows the surface.
    dead_load : (displacement unknowns,) float array
        Forces of fixed direction [N], work-conjugate to the displacement unknowns.
    spin_squared : float
        Square of the rotation rate [rad2/s2].
    """

    pressure: FloatArray
    dead_load: FloatArray
    spin_squared: float

    def towards(self, target: "Loading", fraction: float) -> "Loading":
        """Return the loading at a fraction of the straight path to a target."""
        if fraction == 1.0:
            return target
        a, b = 1.0 - fraction, fraction
        return Loading(
            a * self.pressure + b * target.pressure,
            a * self.dead_load + b * target.dead_load,
            a * self.spin_squared + b * target.spin_squared,
        )
