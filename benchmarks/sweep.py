# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reduced sweep of the composite blade under load against direct solves, in one run.

The direct sweep of all frequencies would take the better part of an hour: as many of them as are
held out to judge the reduced model are solved, and their mean time counts for the others.
"""

import resource
from collections.abc import Iterator, Mapping
from time import perf_counter

import numpy as np

from quietblade.case import Case
from quietblade.case.presets import preset_text
from quietblade.errors import QuietbladeError
from quietblade.linalg import Precision, make_solver
from quietblade.study import stages
from quietblade.vibroacoustics.power import level, radiated_power
from quietblade.vibroacoustics.reduced import reduce_system
from quietblade.vibroacoustics.sweep import solve_point

SIZE = "14 mm"
"""Mesh size on the blade: at least 150 000 unknowns."""

FREQUENCIES = np.linspace(100.0, 200.0, 101)
HELD_OUT = np.linspace(100.0, 200.0, 20)
TOLERANCE = 1e-3
"""Wanted accuracy of the level [dB]."""
