# SPDX-License-Identifier: LGPL-2.1-or-later
"""The water around the rotor, as far as cavitation and stall are concerned."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from quietblade.typing import FloatArray


@dataclass(frozen=True)
class Environment:
    """What decides stall and cavitation besides the loads.

    Attributes
    ----------
    depth : float
        Depth of the rotor axis below the surface [m].
    atmospheric_pressure, vapour_pressure : float
        [Pa]; the vapour pressure is that of water at 20 degrees Celsius.
    gravity : float
        [m/s2]
    stall_incidence : float or None
        Limit of the incidence for all sections [rad]; None: by each section's
        thickness and Reynolds number, see `quietblade.flow.stall`.
    """

    depth: float = 5.0
    atmospheric_pressure: float = 101325.0
    vapour_pressure: float = 2339.0
    gravity: float = 9.80665
    stall_incidence: float | None = None

    def available_pressure(self, submergence: ArrayLike, density: float) -> FloatArray:
        """Pressure above that of the vapour at depths below the surface [m], in Pa."""
        head = density * self.gravity * np.asarray(submergence, dtype=np.float64)
        result: FloatArray = self.atmospheric_pressure + head - self.vapour_pressure
        return result
