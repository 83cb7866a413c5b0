# SPDX-License-Identifier: LGPL-2.1-or-later
"""Flexible propeller blades in water: equilibrium under lift, wet modes and radiated sound."""

from importlib.metadata import version

__version__ = version("quietblade")
