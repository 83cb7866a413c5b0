# SPDX-License-Identifier: LGPL-2.1-or-later
"""How fast cells may grow; apart from the mesher, for those who only count cells."""

GROWTH = 0.6
"""Growth of the water's cells with the distance from the blade: 0.4 changes the frequencies of the
first eight wet modes by less than 0.2 %."""
