# SPDX-License-Identifier: LGPL-2.1-or-later
"""Inviscid flow past the sections of a deformed blade."""

from quietblade.flow.guards import check_contours
from quietblade.flow.inflow import BladeFlow, Inflow, StripInflow, strip_loads
from quietblade.flow.limits import Environment, cavitation_number, notices
from quietblade.flow.loads import (
    SectionLoads,
    TotalLoads,
    integrate,
    section_loads,
    span_integral,
)
from quietblade.flow.panel import PanelSections, PanelSolution
from quietblade.flow.sections import DeformedSections, section_frames

__all__ = [
    "BladeFlow",
    "DeformedSections",
    "Environment",
    "Inflow",
    "PanelSections",
    "PanelSolution",
    "SectionLoads",
    "StripInflow",
    "TotalLoads",
    "cavitation_number",
    "check_contours",
    "integrate",
    "notices",
    "section_frames",
    "section_loads",
    "span_integral",
    "strip_loads",
]
