# SPDX-License-Identifier: LGPL-2.1-or-later
"""Blade-element momentum theory: its own balance, the textbook's form, known limits, a propeller.

DTMB propeller 4119 (three blades, no skew, NACA 66 modified with the mean line a = 0.8): geometry
and open-water test as published with OpenProp's examples; compare Jessup (1989).
"""

from collections.abc import Callable
from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from quietblade.flow import (
    DeformedSections,
    MomentumInflow,
    OperatingCurves,
    PanelSections,
    operating_curves,
    performance,
    section_frames,
    viscous_loads,
)
from quietblade.flow.inflow import BladeFlow
from quietblade.flow.loads import integrate
from quietblade.flow.sections import AXIS
from quietblade.geometry import Blade, NacaFourDigit, NacaSixtySix, constant, table
from verification.registry import check

Array = NDArray[np.float64]

RADIUS_FRACTION = np.array([0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 1.0])
CHORD = np.array([0.32, 0.3625, 0.4048, 0.4392, 0.461, 0.4622, 0.4347, 0.3613, 0.2775, 0.002])
"""Over the diameter; the tip's is finite for the panel method, nominally 0."""
PITCH = np.array([1.105, 1.102, 1.098, 1.093, 1.088, 1.084, 1.081, 1.079, 1.077, 1.075])
THICKNESS = np.array(
    [0.2055, 0.1553, 0.118, 0.09016, 0.0696, 0.05418, 0.04206, 0.03321, 0.03228, 0.0316]
)
CAMBER = np.array(
    [0.01429, 0.02318, 0.02303, 0.02182, 0.02072, 0.02003, 0.01967, 0.01817, 0.01631, 0.01175]
)
EXPERIMENT = np.array(
    [
        [0.5, 0.280, 0.0460],
        [0.7, 0.205, 0.0360],
        [0.833, 0.150, 0.0280],
        [0.9, 0.125, 0.0240],
        [1.0, 0.075, 0.0180],
        [1.1, 0.030, 0.0110],
    ]
)
"""Columns J, K_T, K_Q of the open-water test."""

DIAMETER, TURNS, BLADES, DRAG = 0.3048, 10.0, 3, 0.008
OMEGA = 2.0 * np.pi * TURNS


def propeller_4119(sections: int = 31, nodes: int = 121) -> Array:
    """Nodes of the sections of a blade (sections, nodes, 3), cosine stations."""
    radius = 0.5 * DIAMETER
    s = (RADIUS_FRACTION - 0.2) / 0.8
    pitch_angle = np.arctan2(PITCH, np.pi * RADIUS_FRACTION)
    blade = Blade(
        hub_radius=0.2 * radius,
        span=0.8 * radius,
        chord=table(s, CHORD * DIAMETER, "pchip"),
        blade_angle=table(s, pitch_angle - 0.5 * np.pi, "pchip"),
        sweep=constant(0.0),
        rake=constant(0.0),
        thickness=table(s, THICKNESS, "pchip"),
        camber=table(s, CAMBER, "pchip"),
        family=NacaSixtySix(0.8),
        trailing_edge=0.004,
    )
    return blade.section(0.5 * (1.0 - np.cos(np.linspace(0.0, np.pi, sections))), nodes)


def inflow_4119(advance: float) -> MomentumInflow:
    """Momentum inflow at an advance ratio J."""
    return MomentumInflow(advance * TURNS * DIAMETER, OMEGA, blades=BLADES)


@cache
def solved_4119() -> tuple[DeformedSections, PanelSections]:
    """Sections with their panel solution."""
    sections = section_frames(propeller_4119())
    return sections, PanelSections(sections.contours)


def open_water(advance: float) -> tuple[float, float]:
    """K_T and K_Q of propeller 4119 with C_D = 0.008 on every section."""
    sections, panels = solved_4119()
    model = inflow_4119(advance)
    loads = model.loads(sections, panels)
    blade = BladeFlow(sections, loads, integrate(sections, loads))
    figures = performance(blade, model, viscous_loads(sections, loads, DRAG))
    return figures.thrust_coefficient, figures.torque_coefficient


def curves_4119(advances: Array) -> OperatingCurves:
    """Open-water curves with the friction line instead of a constant drag."""
    speeds = np.asarray(advances) * TURNS * DIAMETER
    points = propeller_4119()
    return operating_curves(points, lambda v, w: MomentumInflow(v, w, blades=BLADES), speeds, OMEGA)


def textbook_angle(
    lift: Callable[[float], float],
    *,
    speed: float,
    rotation: float,
    radius: float,
    chord: float,
    pitch_angle: float,
    blades: int,
    tip: float,
    hub: float,
) -> float:
    """Inflow angle of one section by Ning's residual (2014) for propellers, drag left out.

    ``sin phi (1 - kappa) - V / (omega r) cos phi (1 + kappa') = 0`` with
    ``kappa = sigma c_n / (4 F sin^2 phi)``, ``kappa' = sigma c_t / (4 F sin phi cos phi)``.
    ``lift`` is the section's C_L of the incidence; 0 < phi < pi / 2.
    """
    solidity = blades * chord / (2.0 * np.pi * radius)

    def residual(phi: float) -> float:
        sine, cosine = np.sin(phi), np.cos(phi)
        coefficient = lift(pitch_angle - phi)
        ends = [(tip - radius) / radius, (radius - hub) / hub]
        losses = [2.0 / np.pi * np.arccos(np.exp(-0.5 * blades * e / sine)) for e in ends]
        factor = 4.0 * losses[0] * losses[1]
        kappa = solidity * coefficient * cosine / (factor * sine**2)
        swirl = solidity * coefficient * sine / (factor * sine * cosine)
        return float(sine * (1.0 - kappa) - speed / (rotation * radius) * cosine * (1.0 + swirl))

    undisturbed = np.arctan2(speed, rotation * radius)
    return float(brentq(residual, undisturbed, 0.5 * np.pi - 1e-9, xtol=1e-14))


# Bisection to the last bit: the rounding of speeds of 10 m/s is left.
@check(
    "flow/momentum-residual",
    quantity="largest residual of propeller 4119 at J = 0.833, inner sections [m/s]",
    reference=0.0,
    source="the equation that is solved",
    tolerance=1e-9,
)
def residual() -> float:
    """Direction of the stream at the blades."""
    rings, _, _ = inflow_4119(0.833).rings(*solved_4119())
    phi, _ = rings.solve()
    return float(np.abs(rings.residual(phi))[1:-1].max())


# Both solve the same equation to rounding.
@check(
    "flow/momentum-textbook",
    quantity="largest difference of the inflow angle [rad], propeller 4119 at J = 0.5 to 1.1",
    reference=0.0,
    source="Ning (2014), one section at a time by Brent's method, planar sections",
    tolerance=1e-9,
)
def textbook() -> float:
    """Vectors on deformed sections against the formulas with angles."""
    sections, panels = solved_4119()
    radius, along = sections.reference[:, 2], panels.solve(0.0).circulation
    across = panels.solve(0.5 * np.pi).circulation
    worst = 0.0
    for advance in EXPERIMENT[:, 0]:
        model = inflow_4119(float(advance))
        phi, _ = model.rings(*solved_4119())[0].solve()
        for k in range(3, len(radius) - 3, 4):
            exact = textbook_angle(
                lambda alpha, k=k: float(
                    2.0 * (along[k] * np.cos(alpha) + across[k] * np.sin(alpha))
                ),
                speed=model.speed,
                rotation=OMEGA,
                radius=float(radius[k]),
                chord=float(sections.chord[k]),
                pitch_angle=float(0.5 * np.pi + sections.blade_angle[k]),
                blades=BLADES,
                tip=float(radius[-1]),
                hub=float(radius[0]),
            )
            worst = max(worst, abs(float(phi[k]) - exact))
    return worst


def froude_efficiency(thrust_coefficient: float) -> float:
    """Efficiency of the ideal actuator disk, ``2 / (1 + sqrt(1 + C_T))``."""
    return float(2.0 / (1.0 + np.sqrt(1.0 + thrust_coefficient)))


# Swirl, which the disk does not have, and uneven loading; both below 0.2 % here.
@check(
    "flow/momentum-disk",
    quantity="efficiency over Froude's, 60 narrow blades, no losses, V / (omega R) = 0.02",
    reference=1.0,
    source="2 / (1 + sqrt(1 + C_T)), C_T = thrust / (rho V^2 / 2 pi (R^2 - r_h^2))",
    tolerance=2e-3,
)
def disk() -> float:
    """Fast blades of little pitch whose rings are loaded almost evenly."""
    r = np.linspace(0.5, 1.0, 41)
    blade = Blade(
        hub_radius=0.5,
        span=0.5,
        chord=table(r * 2.0 - 1.0, 2e-3 / r**2),
        blade_angle=table(r * 2.0 - 1.0, np.arctan2(0.024, r) + np.radians(1.0) - 0.5 * np.pi),
        sweep=constant(0.0),
        rake=constant(0.0),
        thickness=constant(0.06),
        camber=constant(0.0),
        family=NacaFourDigit(),
        trailing_edge=0.0,
    )
    sections = section_frames(blade.section(np.linspace(0.0, 1.0, 41), 161))
    model = MomentumInflow(1.0, 50.0, blades=60, tip_loss=False, hub_loss=False)
    loads = model.loads(sections)
    lift = loads.lift_per_length[:, None] * np.cross(sections.tangent, loads.velocity)
    lift /= loads.speed[:, None]  # without the numerical drag
    force, moment = (
        np.trapezoid(part, r, axis=0) for part in (lift, np.cross(sections.reference, lift))
    )
    thrust, torque = -60.0 * force @ AXIS, -60.0 * moment @ AXIS
    area = np.pi * 0.75
    return thrust * 1.0 / (torque * 50.0) / froude_efficiency(thrust / (0.5 * 1000.0 * area))


# Too high, as expected: the chord is up to 0.92 of the radius, and the curved flow of so wide a
# blade takes about half of its camber's lift, which no theory of independent sections knows
# (docs/theory-inflow.md). The tolerance is half of the measured value: the stated excess fits in,
# an error of sign, of a blade or of the induction does not.
_TEST = "open-water test as published with OpenProp's examples; compare Jessup (1989)"


@check(
    "flow/momentum-4119-thrust",
    quantity="K_T of DTMB 4119 at J = 0.833, C_D = 0.008",
    reference=0.150,
    source=_TEST,
    tolerance=0.075,
)
def thrust_4119() -> float:
    """Design point."""
    return open_water(0.833)[0]


@check(
    "flow/momentum-4119-torque",
    quantity="10 K_Q of DTMB 4119 at J = 0.833, C_D = 0.008",
    reference=0.280,
    source=_TEST,
    tolerance=0.14,
)
def torque_4119() -> float:
    """Design point."""
    return 10.0 * open_water(0.833)[1]


# Thrust and torque are too high together, so that their ratio is good: within the scatter of 3 %
# of tests and of codes in workshops (smp'11: 4.4 % on K_T at moderate loading).
@check(
    "flow/momentum-4119-efficiency",
    quantity="efficiency of DTMB 4119 at J = 0.833, C_D = 0.008",
    reference=0.833 * 0.150 / (2.0 * np.pi * 0.0280),
    source=_TEST,
    tolerance=0.03,
)
def efficiency_4119() -> float:
    """Design point."""
    kt, kq = open_water(0.833)
    return 0.833 * kt / (2.0 * np.pi * kq)
