# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where a damped mode loses its energy (theory: S2-55)."""

from collections.abc import Mapping

import numpy as np

from quietblade.typing import FloatArray
from quietblade.vibroacoustics.complex_modes import ComplexModes
from quietblade.vibroacoustics.operators import Operators
from quietblade.vibroacoustics.power import dissipated_by_region, radiated_power

RADIATION = "radiation"
"""Name of the share of the sound."""


def loss_shares(operators: Operators, modes: ComplexModes) -> Mapping[str, FloatArray]:
    """Split the loss factors of complex modes among the lossy regions and the sound.

    The parts are in proportion to the powers that the mode's motion loses in each region and
    radiates, at its frequency.

    Parameters
    ----------
    operators : Operators
        The system of the modes.
    modes : ComplexModes

    Returns
    -------
    mapping of name to (m,) array
        By region, and ``radiation``; they add up to ``modes.loss_factor``.
    """
    omega = modes.omega.real
    powers = {
        **dissipated_by_region(operators, omega, modes.vectors),
        RADIATION: radiated_power(operators, omega, modes.vectors),
    }
    total = sum(powers.values(), start=np.zeros(omega.shape))
    share = np.divide(modes.loss_factor, total, out=np.zeros(omega.shape), where=total > 0.0)
    return {name: power * share for name, power in powers.items()}
