# SPDX-License-Identifier: LGPL-2.1-or-later
"""An elastic steel shell in water under the exact condition, pushed by harmonics and on a cap.

Outer radius 0.5 m, wall 50 mm, E = 210 GPa (1 + 0.02 i), nu = 0.3, 7850 kg/m3, vacuum inside;
water of 1000 kg/m3 and 1500 m/s up to R = 0.6 m.  One layer of cells of 65 mm in the wall: what is
compared is bending of a thick wall near its resonances (1043, 1292, 1549 Hz for degrees 2 to 4), so
that an error of 1e-4 of a frequency already moves a level by some hundredths of a decibel.  Above
1.3 kHz the cap wants two layers (1600 Hz: 0.15 dB with one, 0.07 dB with two), which is not run.
"""

from dataclasses import replace
from functools import cache, partial

import numpy as np
from scipy.special import eval_legendre

from quietblade.linalg import make_solver
from quietblade.typing import ComplexArray, FloatArray
from quietblade.vibroacoustics.dtn import Dtn
from quietblade.vibroacoustics.excitation import pressure_force
from quietblade.vibroacoustics.modes import wet_modes
from quietblade.vibroacoustics.power import level, power_budget, radiated_power
from verification.acoustics_closed_forms import ElasticSphere
from verification.acoustics_models import Elastic, SphereModel, harmonic_pressure, layered_mesh
from verification.acoustics_modes import real_mode
from verification.registry import check

SOURCE = "three-dimensional elasticity and spherical waves (Junger and Feit 1986), infinite water"
STEEL = Elastic(young=210e9, poisson=0.3, density=7850.0, loss=0.02)
INNER, OUTER, SPHERE = 0.45, 0.5, 0.6
YOUNG = STEEL.young * (1.0 + 1j * STEEL.loss)
SHELL = ElasticSphere(OUTER, INNER, YOUNG, STEEL.poisson, STEEL.density, 1000.0, 1500.0)
CAP = np.radians(20.0)
FREQUENCIES = (200.0, 400.0, 800.0, 1200.0)
DEGREES = (0, 1, 2, 3)


def cap_coefficients(half_angle: float, degree: int) -> FloatArray:
    """Legendre coefficients (degree + 1,) of unit pressure on a polar cap."""
    x = np.cos(half_angle)
    higher = [
        0.5 * (eval_legendre(n - 1, x) - eval_legendre(n + 1, x)) for n in range(1, degree + 1)
    ]
    return np.array([0.5 * (1.0 - x), *higher])


def cap_power(shell: ElasticSphere, half_angle: float, frequency: float, degree: int = 20) -> float:
    """Power that a uniform pressure of 1 Pa on a polar cap radiates [W], by a series."""
    omega = 2.0 * np.pi * frequency
    parts = [
        shell.solve(n, omega, float(p))[1].power(shell.water_density, omega)
        for n, p in enumerate(cap_coefficients(half_angle, degree))
    ]
    return float(sum(parts))


@cache
def model() -> SphereModel:
    """Shell with a polar cap in a close sphere of water."""
    mesh = layered_mesh(
        (INNER, OUTER, 0.55, SPHERE), (0.065, 0.065, 0.08, 0.09), OUTER, cap=float(CAP)
    )
    return SphereModel(mesh, OUTER, SPHERE, {"blade": STEEL}, condition=Dtn(8))


@cache
def responses(frequency: float) -> tuple[FloatArray, ComplexArray]:
    """Solve for 1 Pa on the cap and on each harmonic of degree 0 to 3: loads and responses."""
    operators = model().operators
    forces = [pressure_force(model().fem, 1.0, surface="excited")] + [
        pressure_force(model().fem, harmonic_pressure(n), surface="wet|excited") for n in DEGREES
    ]
    loads = np.array([operators.right_hand_side(force) for force in forces])
    factor = make_solver(precision="double").factor(operators.at(2.0 * np.pi * frequency))
    return loads, factor.solve(loads.T.astype(complex)).T


@cache
def radiated(frequency: float) -> FloatArray:
    """Powers (1 + 4,) through the sphere [W]."""
    _, response = responses(frequency)
    return radiated_power(
        model().operators, np.full(len(response), 2.0 * np.pi * frequency), response
    )


def cap_level(frequency: float) -> float:
    """Level of the power of the cap [dB re 1 pW]."""
    return float(level(radiated(frequency)[:1])[0])


def modal_level(degree: int, frequency: float) -> float:
    """Level of the power of a harmonic pressure [dB re 1 pW]."""
    return float(level(radiated(frequency)[1 + degree :][:1])[0])


for _frequency in FREQUENCIES:
    check(
        f"acoustics/steel-shell-cap-{_frequency:.0f}",
        quantity="sound power, 1 Pa on a polar cap of 20 deg of a steel shell in water, "
        f"{_frequency:.0f} Hz [dB re 1 pW]",
        reference=float(level(np.array(cap_power(SHELL, float(CAP), _frequency)))),
        source=f"{SOURCE}, series to degree 20",
        tolerance=0.05,
        quick=False,
    )(partial(cap_level, _frequency))

for _degree in DEGREES:
    for _frequency in (200.0, 800.0, 1200.0):
        _omega = 2.0 * np.pi * _frequency
        _power = SHELL.solve(_degree, _omega)[1].power(1000.0, _omega)
        if _degree > 2.0 * _omega / 1500.0 * SPHERE + 1.0:
            continue  # too weak beside the rounding of the mesh's symmetry
        check(
            f"acoustics/steel-shell-n{_degree}-{_frequency:.0f}",
            quantity=f"sound power, P{_degree} pressure of 1 Pa on a steel shell in water, "
            f"{_frequency:.0f} Hz [dB re 1 pW]",
            reference=float(level(np.array(_power))),
            source=SOURCE,
            # at 1200 Hz degree 3 is on the flank of its peak at 1292 Hz: 0.05 dB measured
            tolerance=0.05 if _degree < 3 else 0.1,
            quick=False,
        )(partial(modal_level, _degree, _frequency))


@check(
    "acoustics/steel-shell-balance",
    quantity="largest |injected - radiated - dissipated| / injected, steel shell, five loads",
    reference=0.0,
    source="conservation of energy",
    tolerance=1e-8,
    quick=False,
)
def balance() -> float:
    """Over all frequencies."""
    worst = 0.0
    for frequency in FREQUENCIES:
        loads, response = responses(frequency)
        omega = np.full(len(loads), 2.0 * np.pi * frequency)
        budget = power_budget(model().operators, omega, response, loads)
        worst = max(worst, float(budget.residual.max()))
    return worst


@cache
def wet_frequencies() -> FloatArray:
    """Elastic wet frequencies below 1500 Hz, incompressible water [Hz]: degrees 2 and 3."""
    frequency = wet_modes(model().operators, 1500.0).frequency
    return np.asarray(frequency[frequency > 10.0])


def wet_mode(degree: int) -> float:
    """Mean of the 2 l + 1 modes of a degree."""
    first = degree**2 - 4
    return float(wet_frequencies()[first : first + 2 * degree + 1].mean())


_STILL = replace(SHELL, young=STEEL.young, sound_speed=1.5e7)
for _degree, _low, _high in ((2, 900.0, 1250.0), (3, 1200.0, 1450.0)):
    _reference = real_mode(_STILL, _degree, _low, _high)
    check(
        f"acoustics/steel-shell-wet-n{_degree}",
        quantity=f"mean wet frequency of the steel shell's modes of degree {_degree}, "
        "incompressible water, exact static exterior [Hz]",
        reference=_reference,
        source=SOURCE,
        tolerance=1e-3 * _reference,
        quick=False,
    )(partial(wet_mode, _degree))
