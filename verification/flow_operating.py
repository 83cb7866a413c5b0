# SPDX-License-Identifier: LGPL-2.1-or-later
"""Friction, cavitation and vortex shedding against closed forms and XFOIL."""

import numpy as np
from numpy.typing import NDArray

from quietblade.flow import (
    Environment,
    PanelSections,
    StripInflow,
    cavitation_bucket,
    inception_speed,
    inception_submergence,
    section_frames,
    section_shedding,
    span_integral,
    viscous_loads,
)
from quietblade.geometry import NacaFourDigit
from verification.flow_strip import POLYNOMIAL_EDGE
from verification.flow_xfoil import coefficient_table, pressure_table
from verification.registry import check

Array = NDArray[np.float64]

RHO, NU = 1000.0, 1.0e-6


def straight_fin(chord: float, span: float, thickness: float, edge: float = 0.0) -> Array:
    """Nodes (11, 161, 3) of a rectangular fin of NACA 00 sections along z from z = 1 m."""
    contour = chord * (NacaFourDigit().contour(thickness, 0.0, edge, 161) - [0.5, 0.0])
    points = np.zeros((11, 161, 3))
    points[..., :2] = contour
    points[..., 2] = 1.0 + span * np.linspace(0.0, 1.0, 11)[:, None]
    return points


def plate_drag(speed: float, chord: float, span: float, thickness: float) -> float:
    """Drag of a fin at zero incidence by the ITTC line and Hoerner's form factor [N]."""
    friction = 0.075 / (np.log10(speed * chord / NU) - 2.0) ** 2
    form = 1.0 + 2.0 * thickness + 60.0 * thickness**4
    return float(0.5 * RHO * speed**2 * 2.0 * chord * span * friction * form)


def atmospheric_margin(suction: float, speed: float, environment: Environment) -> float:
    """Depth [m] at which ``p_atm + rho g h - p_v`` is the suction ``-Cp rho W^2 / 2``."""
    missing = 0.5 * RHO * speed**2 * suction
    surface = environment.atmospheric_pressure - environment.vapour_pressure
    return (missing - surface) / (RHO * environment.gravity)


# The largest thickness of the 161 nodes is 3e-6 below the nominal one; the rest is rounding.
@check(
    "flow/friction-plate",
    quantity="viscous drag of a fin 0.25 m x 1 m, t/c = 6 %, at 5 m/s [N]",
    reference=plate_drag(5.0, 0.25, 1.0, 0.06),
    source="2 C_F (1 + 2 t/c + 60 (t/c)^4), C_F = 0.075 / (log10 Re - 2)^2 (ITTC 1957)",
    tolerance=0.005,
)
def friction_plate() -> float:
    """Uniform stream along the chord."""
    sections = section_frames(straight_fin(0.25, 1.0, 0.06, POLYNOMIAL_EDGE))
    loads = StripInflow(5.0, 0.0, RHO, NU).loads(sections)
    return float(span_integral(sections, viscous_loads(sections, loads).force)[0])


# XFOIL prints Cp to 5e-6, which at 5.05 m/s is a depth of 7e-6 m.
@check(
    "flow/inception-depth",
    quantity="submergence of inception of NACA 0006 at 8 deg and 5.05 m/s [m]",
    reference=atmospheric_margin(
        -float(pressure_table("naca0006", "blunt")[:, -1].min()), 5.05, Environment()
    ),
    source="sigma = -Cp_min with Cp_min of XFOIL 6.99, inviscid, the same nodes",
    tolerance=1e-5,
)
def inception_at_8_degrees() -> float:
    """Tip of the paper's blade in strip theory."""
    nodes = pressure_table("naca0006", "blunt")[:, :2]
    solved = PanelSections(nodes[None]).solve(coefficient_table("naca0006", "blunt")[-1, 0])
    return float(inception_submergence(-solved.cp.min(), 5.05, Environment(), RHO))


# The printed Cp limits sigma to 5e-6, and the suction of this nose rises by 2.2 a degree.
@check(
    "flow/cavitation-bucket",
    quantity="upper edge of the bucket of NACA 0006 at sigma = -Cp_min(8 deg) [deg]",
    reference=8.0,
    source="-Cp_min of XFOIL 6.99 at 8 deg, inviscid, the same nodes",
    tolerance=1e-5,
)
def bucket() -> float:
    """Ask for the incidence that has this suction."""
    table = pressure_table("naca0006", "blunt")
    _, highest = cavitation_bucket(table[None, :, :2], -table[:, -1].min())
    return float(np.degrees(highest[0]))


# Algebra.
@check(
    "flow/inception-speed",
    quantity="speed [m/s] at which a suction of 1.5 cavitates 5 m below the surface",
    reference=float(np.sqrt(2.0 * (101325.0 + 9806.65 * 5.0 - 2339.0) / (1000.0 * 1.5))),
    source="W = sqrt(2 (p_atm + rho g h - p_v) / (-Cp_min rho))",
    tolerance=1e-9,
)
def speed_of_inception() -> float:
    """At fixed incidence."""
    return float(inception_speed(1.5, 5.0, Environment()))


def shedding(speed: float, chord: float, edge: float, strouhal: float = 0.21) -> float:
    """Frequency [Hz] from the edge's thickness / chord and two turbulent plate layers."""
    layer = 0.37 / 8.0 * chord * (speed * chord / NU) ** -0.2
    return strouhal * speed / (edge * chord + 2.0 * layer)


# The wedge's edge is exact; rounding of the contour is left.
@check(
    "flow/shedding-frequency",
    quantity="shedding frequency of an edge of 0.6 % of 0.25 m at 5 m/s [Hz]",
    reference=shedding(5.0, 0.25, 0.006),
    source="St W / (t_e + delta*), St = 0.21, delta* of two seventh-power layers",
    tolerance=1e-6,
)
def shed() -> float:
    """From the contour of the section and its stream."""
    sections = section_frames(straight_fin(0.25, 1.0, 0.06, 0.006))
    loads = StripInflow(5.0, 0.0, RHO, NU).loads(sections)
    return float(section_shedding(sections, loads)[5])
