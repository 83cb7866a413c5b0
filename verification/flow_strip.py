# SPDX-License-Identifier: LGPL-2.1-or-later
"""Strip loads of the paper's rigid blade: NACA 0006, chord 250 to 75 mm, z = 0.2 to 1.2 m.

V = 5 m/s, omega = 0.58 rad/s, 1000 kg/m3, chord along the rotor axis, so that the incidence is
arctan(omega z / V).
"""

from collections.abc import Callable
from functools import cache

import numpy as np
from scipy.integrate import quad

from quietblade.flow import BladeFlow, StripInflow, span_integral, strip_loads
from quietblade.geometry import Blade, NacaFourDigit, constant, table
from verification.flow_xfoil import coefficient_table
from verification.registry import check

SPEED, ROTATION, DENSITY = 5.0, 0.58, 1000.0
ROOT, TIP = 0.2, 1.2
POLYNOMIAL_EDGE = 0.00126  # thickness of the edge of NACA 0006 by its polynomial, in chords


@cache
def flow(edge: float, nodes: int) -> BladeFlow:
    """Compute the loads on 101 sections."""
    blade = Blade(
        hub_radius=ROOT,
        span=TIP - ROOT,
        chord=table(np.array([0.0, 1.0]), np.array([0.25, 0.075])),
        blade_angle=constant(0.0),
        sweep=constant(0.0),
        rake=constant(0.0),
        thickness=constant(0.06),
        camber=constant(0.0),
        family=NacaFourDigit(),
        trailing_edge=edge,
    )
    points = blade.section(np.linspace(0.0, 1.0, 101), nodes)
    return strip_loads(points, StripInflow(SPEED, ROTATION, DENSITY))


def strip_integral(coefficient: Callable[[float], float], arm: float = 0.0) -> float:
    """Integral of rho W^2 c C(alpha) / 2 over the radius, times z - ROOT if ``arm`` is 1."""

    def integrand(z: float) -> float:
        chord = 0.25 - 0.175 * (z - ROOT) / (TIP - ROOT)
        load = 0.5 * DENSITY * (SPEED**2 + (ROTATION * z) ** 2) * chord
        return float(load * coefficient(np.arctan2(ROTATION * z, SPEED)) * (z - ROOT) ** arm)

    return float(quad(integrand, ROOT, TIP, epsabs=0.0, epsrel=1e-12)[0])


def thin(alpha: float) -> float:
    """Lift coefficient of a flat plate at small incidence."""
    return 2.0 * np.pi * alpha


def xfoil_lift(alpha: float) -> float:
    """Lift of NACA 0006 from XFOIL's at 4 and 8 deg: a sin(alpha) + b sin(3 alpha).

    That is the general form of the panel method for a symmetric section, because Cp is a quadratic
    form of cos(alpha) and sin(alpha).
    """
    known = coefficient_table("naca0006", "blunt")[1:, :2]
    factors = np.linalg.solve(np.sin(np.outer(known[:, 0], [1.0, 3.0])), known[:, 1])
    return float(np.sin(alpha * np.array([1.0, 3.0])) @ factors)


# 908.4 N, 485.6 N m. The cubic spline through 101 sections leaves 1e-9 of a smooth integrand.
@check(
    "flow/strip-lift",
    quantity="lift of the paper's rigid blade with C_L = 2 pi alpha [N]",
    reference=strip_integral(thin),
    source="integral of rho (V^2 + omega^2 z^2) c pi alpha dz",
    tolerance=1e-5,
)
def strip_lift() -> float:
    """Incidence, speed, chord and span of the sections with the thin-section lift."""
    blade = flow(POLYNOMIAL_EDGE, 161)
    load = blade.loads.dynamic_pressure * blade.sections.chord * 2.0 * np.pi * blade.loads.alpha
    return float(span_integral(blade.sections, load))


@check(
    "flow/strip-root-moment",
    quantity="moment of that lift about the root [N m]",
    reference=strip_integral(thin, 1.0),
    source="integral of rho (V^2 + omega^2 z^2) c pi alpha (z - 0.2) dz",
    tolerance=1e-5,
)
def strip_moment() -> float:
    """As the lift, with the arm along the span."""
    blade = flow(POLYNOMIAL_EDGE, 161)
    load = blade.loads.dynamic_pressure * blade.sections.chord * 2.0 * np.pi * blade.loads.alpha
    return float(span_integral(blade.sections, load * blade.sections.arc_length))


# XFOIL prints C_L to 5e-5, 1.1e-4 of the value at 4 deg: 0.1 N. The blade's sections have 161
# nodes and the tables 160, which alters C_L by less than that.
@check(
    "flow/strip-lift-panel",
    quantity="lift of the paper's rigid blade with the panel method [N]",
    reference=strip_integral(xfoil_lift),
    source="the same integral with the C_L that XFOIL 6.99 gives at 4 and 8 deg",
    tolerance=0.15,
)
def panel_lift() -> float:
    """Lift of the sections as they are."""
    return flow(POLYNOMIAL_EDGE, 161).total.lift


# A rigid inviscid strip blade has no loss; what is left is the numerical drag (2.6e-4 at the tip
# with 321 nodes), whose power is 0.4 % of the shaft's because this blade is so lightly loaded.
@check(
    "flow/strip-efficiency",
    quantity="thrust V / (torque omega), sharp edge, 321 nodes",
    reference=1.0,
    source="lift is perpendicular to the relative velocity V e_x - omega e_x x x",
    tolerance=5e-3,
)
def efficiency() -> float:
    """Compare useful power with shaft power."""
    total = flow(0.0, 321).total
    return total.thrust * SPEED / (total.torque * ROTATION)


# Algebra: only the rounding of the sums is left.
@check(
    "flow/strip-power-balance",
    quantity="(thrust V + power of the numerical drag) / (torque omega), blunt edge, 161 nodes",
    reference=1.0,
    source="F . W = drag |W| on every section",
    tolerance=1e-10,
)
def power_balance() -> float:
    """Compare the powers after the numerical drag, which here pushes, is given back."""
    blade = flow(POLYNOMIAL_EDGE, 161)
    loads = blade.loads
    drag = loads.dynamic_pressure * blade.sections.chord * loads.drag_error
    lost = float(span_integral(blade.sections, drag * loads.speed))
    return (blade.total.thrust * SPEED + lost) / (blade.total.torque * ROTATION)
