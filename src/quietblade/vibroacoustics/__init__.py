# SPDX-License-Identifier: LGPL-2.1-or-later
"""Step 2: small harmonic vibrations about the static state, in water, and the sound they make."""

from quietblade.vibroacoustics.excitation import pressure_force
from quietblade.vibroacoustics.fluid import Water
from quietblade.vibroacoustics.multipoles import Multipoles, SurfaceSources
from quietblade.vibroacoustics.operators import Blocks, Operators, build_operators
from quietblade.vibroacoustics.power import PowerBudget, level, power_budget
from quietblade.vibroacoustics.radiation import Bgt1, RadiationCondition, static_exterior

__all__ = [
    "Bgt1",
    "Blocks",
    "Multipoles",
    "Operators",
    "PowerBudget",
    "RadiationCondition",
    "SurfaceSources",
    "Water",
    "build_operators",
    "level",
    "power_budget",
    "pressure_force",
    "static_exterior",
]
