# SPDX-License-Identifier: LGPL-2.1-or-later
"""Flow past the sections of a deformed blade: pressure, induction, checks and figures."""

from quietblade.flow.cavitation import (
    cavitation_bucket,
    cavitation_number,
    inception_depth,
    inception_ship_speed,
    inception_speed,
    inception_submergence,
)
from quietblade.flow.environment import Environment
from quietblade.flow.friction import (
    ViscousLoads,
    form_factor,
    friction_coefficient,
    friction_notices,
    section_drag,
    viscous_loads,
)
from quietblade.flow.guards import check_contours
from quietblade.flow.inflow import BladeFlow, Inflow, StripInflow, strip_loads
from quietblade.flow.lifting_line import LiftingLineInflow, VortexLine, solve_circulation
from quietblade.flow.limits import notices
from quietblade.flow.loads import (
    SectionLoads,
    TotalLoads,
    circulation_response,
    integrate,
    section_loads,
    span_integral,
)
from quietblade.flow.momentum import MomentumInflow
from quietblade.flow.panel import PanelSections, PanelSolution
from quietblade.flow.performance import (
    OperatingCurves,
    Performance,
    SectionTable,
    operating_curves,
    performance,
    section_table,
)
from quietblade.flow.sections import DeformedSections, section_frames
from quietblade.flow.singing import section_shedding, shedding_frequency, singing_notices
from quietblade.flow.stall import stall_incidence
from quietblade.flow.wake import RadialWake, radial_wake, wake_of_angles

INFLOWS = {model.name: model for model in (StripInflow, LiftingLineInflow, MomentumInflow)}
"""Models of the inflow by the name that a case file uses."""

__all__ = [
    "INFLOWS",
    "BladeFlow",
    "DeformedSections",
    "Environment",
    "Inflow",
    "LiftingLineInflow",
    "MomentumInflow",
    "OperatingCurves",
    "PanelSections",
    "PanelSolution",
    "Performance",
    "RadialWake",
    "SectionLoads",
    "SectionTable",
    "StripInflow",
    "TotalLoads",
    "ViscousLoads",
    "VortexLine",
    "cavitation_bucket",
    "cavitation_number",
    "check_contours",
    "circulation_response",
    "form_factor",
    "friction_coefficient",
    "friction_notices",
    "inception_depth",
    "inception_ship_speed",
    "inception_speed",
    "inception_submergence",
    "integrate",
    "notices",
    "operating_curves",
    "performance",
    "radial_wake",
    "section_drag",
    "section_frames",
    "section_loads",
    "section_shedding",
    "section_table",
    "shedding_frequency",
    "singing_notices",
    "solve_circulation",
    "span_integral",
    "stall_incidence",
    "strip_loads",
    "viscous_loads",
    "wake_of_angles",
]
