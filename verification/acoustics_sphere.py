# SPDX-License-Identifier: LGPL-2.1-or-later
"""A sphere with a prescribed motion in water: radiation condition, power and added mass.

The reference of most checks has the same condition on the outer sphere as the computation, so that
only the error of discretisation is left.  It grows with the degree, because the triangles on the
sphere are 0.4 rad long; the tolerances are about twice what was measured.
"""

from functools import cache, partial

import numpy as np
import rslab

from quietblade.typing import FloatArray
from quietblade.vibroacoustics.power import radiated_power
from verification.acoustics_closed_forms import bgt1, moving_sphere, power_ratio
from verification.acoustics_models import WATER, ball
from verification.registry import check

JUNGER = "Junger and Feit 1986, spherical waves"
TRUNCATED = f"{JUNGER}, with the wave that first-order BGT reflects at R"
RADIUS, OUTER = 0.5, 1.0
RESISTANCE_TOLERANCE = {0: 3e-3, 1: 6e-3, 2: 1.5e-2}
REACTANCE_TOLERANCE = {0: 1e-3, 1: 1e-3, 2: 2e-3}


@cache
def sphere(degree: int, kr: float) -> tuple[complex, float, float]:
    """Surface pressure p/(rho c v), sphere power and multipole power over the plane wave's."""
    model = ball()
    omega = kr * WATER.sound_speed / OUTER
    response = model.forced_by_motion(degree, omega)
    potential = model.surface_mean(model.potential(response), degree)
    plane = 0.5 * WATER.density * WATER.sound_speed * 4.0 * np.pi * RADIUS**2 / (2 * degree + 1)
    through = float(radiated_power(model.operators, np.array(omega), response))
    multipoles = model.sources.multipoles(np.array([omega]), response[None, :])
    pressure = -1j * omega / WATER.sound_speed * potential
    return pressure, through / plane, float(multipoles.power[0]) / plane


def resistance(degree: int, kr: float) -> float:
    """Power through the outer sphere over that of a plane wave."""
    return sphere(degree, kr)[1]


def reactance(degree: int, kr: float) -> float:
    """Pressure on the sphere in phase with the acceleration."""
    return sphere(degree, kr)[0].imag


def source_resistance(degree: int, kr: float) -> float:
    """Multipole power over that of a plane wave."""
    return sphere(degree, kr)[2]


for _degree in (0, 1, 2):
    for _kr in (1.0, 2.0):
        _wave = moving_sphere(_degree, _kr / OUTER, RADIUS, OUTER, 1.0)
        _exact = -1j * _wave.k * _wave.potential(RADIUS)
        _plane = 0.5 * WATER.density * WATER.sound_speed * 4.0 * np.pi * RADIUS**2
        _omega = _kr / OUTER * WATER.sound_speed
        _sources = _wave.power_of_sources(WATER.density, _omega) * (2 * _degree + 1) / _plane
        _name = f"acoustics/sphere-bgt1-n{_degree}-kr{_kr:.0f}"
        _what = f"of a sphere of 0.5 m moving with P{_degree}, kR = {_kr:.0f}, over rho c"
        check(
            _name,
            quantity=f"radiation resistance {_what}",
            reference=_exact.real,
            source=TRUNCATED,
            tolerance=RESISTANCE_TOLERANCE[_degree] * _exact.real,
        )(partial(resistance, _degree, _kr))
        check(
            f"{_name}-reactance",
            quantity=f"radiation reactance {_what}",
            reference=_exact.imag,
            source=TRUNCATED,
            tolerance=REACTANCE_TOLERANCE[_degree] * _exact.imag,
        )(partial(reactance, _degree, _kr))
        check(
            f"acoustics/multipoles-n{_degree}-kr{_kr:.0f}",
            quantity=f"resistance by multipoles {_what}",
            reference=_sources,
            source=f"{TRUNCATED}; amplitude of the part that is singular inside",
            tolerance=RESISTANCE_TOLERANCE[_degree] * _sources,
        )(partial(source_resistance, _degree, _kr))


@check(
    "acoustics/pulsating-sphere-phase",
    quantity="phase of the pressure before the velocity, pulsating sphere, ka = 0.5 [deg]",
    reference=float(np.degrees(np.arctan(2.0))),
    source=f"{JUNGER}: p = rho c v ika/(1 + ika); first-order BGT is exact here",
    tolerance=0.05,  # 0.1 % of the resistance is 0.02 deg
)
def pulsating_phase() -> float:
    """Phase of the pressure on a pulsating sphere."""
    return float(np.degrees(np.angle(sphere(0, 1.0)[0])))


@check(
    "acoustics/bgt1-dipole-kr1",
    quantity="sphere power over multipole power of an oscillating sphere of 0.5 m, kR = 1",
    reference=power_ratio(1, 1.0, bgt1),
    source=f"{TRUNCATED}: (1 - |B/A|^2)/|1 - B/A|^2 = 2.613",
    tolerance=0.01,  # the errors of both powers nearly cancel
)
def dipole_overestimate() -> float:
    """How much too loud first-order BGT makes a dipole."""
    _, through, multipoles = sphere(1, 1.0)
    return through / multipoles


def added_mass(motion: FloatArray) -> float:
    """Compute the added mass with the static exterior of the sphere [kg]."""
    operators = ball().operators
    blocks = operators.blocks
    if operators.exterior is None:
        raise ValueError("the operators carry no static exterior")
    water = (operators.terms["H"] + operators.exterior)[blocks.psi][:, blocks.psi]
    flux = operators.terms["C"][blocks.psi][:, blocks.u] @ motion
    return float(flux @ rslab.ldlt(water).solve(flux))


@check(
    "acoustics/added-mass-pulsating",
    quantity="added mass of a pulsating sphere of 0.5 m [kg]",
    reference=4.0 * np.pi * WATER.density * RADIUS**3,
    source="Lamb 1932, Hydrodynamics: 4 pi rho a^3; the local static exterior is exact",
    tolerance=3.0,  # 0.13 % measured: the area of the curved triangles
)
def added_mass_pulsating() -> float:
    """Let the sphere pulsate."""
    return added_mass(ball().radial_motion(0))


@check(
    "acoustics/added-mass-oscillating",
    quantity="added mass of an oscillating sphere of 0.5 m [kg]",
    reference=2.0 * np.pi / 3.0 * WATER.density * RADIUS**3,
    source="Lamb 1932, Hydrodynamics: 2/3 pi rho a^3; the local static exterior is exact",
    tolerance=0.8,  # 0.14 % measured
)
def added_mass_oscillating() -> float:
    """Let the sphere move rigidly."""
    model = ball()
    values = np.zeros_like(model.basis.points)
    values[model.basis.nodes_of("wet", codimension=1), 2] = 1.0
    operators = model.operators
    return added_mass(model.basis.to_dofs(values)[operators.free[operators.blocks.u]])
