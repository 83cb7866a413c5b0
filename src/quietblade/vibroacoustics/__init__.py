# SPDX-License-Identifier: LGPL-2.1-or-later
"""Step 2: small harmonic vibrations about the static state, in water, and the sound they make."""

from quietblade.vibroacoustics.bands import Bands, Limit
from quietblade.vibroacoustics.directivity import directivity, source_level
from quietblade.vibroacoustics.dtn import Dtn, fitted_dtn
from quietblade.vibroacoustics.excitation import pressure_force
from quietblade.vibroacoustics.farfield import sphere_waves
from quietblade.vibroacoustics.fluid import Water
from quietblade.vibroacoustics.multipoles import Multipoles, SurfaceSources
from quietblade.vibroacoustics.operators import Blocks, Operators, build_operators
from quietblade.vibroacoustics.power import PowerBudget, level, power_budget
from quietblade.vibroacoustics.radiation import Bgt1, Bgt2, RadiationCondition, static_exterior

__all__ = [
    "Bands",
    "Bgt1",
    "Bgt2",
    "Blocks",
    "Dtn",
    "Limit",
    "Multipoles",
    "Operators",
    "PowerBudget",
    "RadiationCondition",
    "SurfaceSources",
    "Water",
    "build_operators",
    "directivity",
    "fitted_dtn",
    "level",
    "power_budget",
    "pressure_force",
    "source_level",
    "sphere_waves",
    "static_exterior",
]
