# SPDX-License-Identifier: LGPL-2.1-or-later
"""Real and complex modes of a thick elastic shell in water against three-dimensional elasticity.

The tolerances are about twice the measured error of a mesh with two layers of elements in the
shell; degree 3 and torsion are not compared, for they need a finer one.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
from numpy.polynomial import Chebyshev
from scipy.optimize import brentq

from quietblade.typing import FloatArray
from quietblade.vibroacoustics.complex_modes import ComplexModes, complex_modes
from quietblade.vibroacoustics.modes import WetModes, dry_modes, wet_modes
from verification.acoustics_closed_forms import ElasticSphere, bgt1
from verification.acoustics_models import LOSSY, shell
from verification.acoustics_shell import closed_form
from verification.registry import check

SOURCE = "three-dimensional elasticity and spherical waves (Junger and Feit 1986)"
HIGHEST = 700.0
# 3 translations, 3 rotations, 5 modes of degree 2, breathing, 7 modes of degree 3
BELOW_HIGHEST = 19


@cache
def wet() -> WetModes:
    """Real wet modes of the shell."""
    return wet_modes(shell().operators, HIGHEST)


@cache
def damped() -> ComplexModes:
    """Complex modes of degree 2, under first-order BGT."""
    return complex_modes(shell().operators, wet(), (400.0, 450.0))


def stiffness(sphere: ElasticSphere, degree: int, frequency: float) -> complex:
    """Pressure over radial displacement [Pa/m]: zero at a mode."""
    return 1.0 / sphere.solve(degree, 2.0 * np.pi * frequency)[0]


def real_mode(sphere: ElasticSphere, degree: int, low: float, high: float) -> float:
    """Frequency [Hz] of the mode of a sphere without loss in a range."""
    return float(brentq(lambda f: stiffness(sphere, degree, f).real, low, high, xtol=1e-9))


def complex_mode(
    sphere: ElasticSphere, degree: int, low: float, high: float, decay: float = 50.0
) -> complex:
    """Complex frequency [Hz], from the analytic continuation of the stiffness off the real line.

    Its real part is looked for between ``low`` and ``high``, its imaginary part below ``decay``.
    """
    along = np.vectorize(lambda f: stiffness(sphere, degree, f), otypes=[complex])
    roots = Chebyshev.interpolate(along, 16, domain=[low, high]).roots()
    (found,) = roots[(roots.real > low) & (roots.real < high) & (np.abs(roots.imag) < decay)]
    return complex(found)


# Incompressible water is water in which sound is ten thousand times faster.
_STILL = replace(closed_form(None), young=LOSSY.young, sound_speed=1.5e7)
_DRY = replace(_STILL, water_density=1e-6)
_BREATHING = real_mode(_STILL, 0, 500.0, 700.0)
_OVAL = real_mode(_STILL, 2, 350.0, 500.0)
_OVAL_DRY = real_mode(_DRY, 2, 450.0, 650.0)
_DAMPED = complex_mode(closed_form(bgt1), 2, 360.0, 480.0)


@check(
    "acoustics/wet-mode-breathing",
    quantity="wet frequency of the thick shell's breathing mode, incompressible water [Hz]",
    reference=_BREATHING,
    source=SOURCE,
    tolerance=2e-3 * _BREATHING,
)
def breathing() -> float:
    """Mode 12: the one after the five of degree 2."""
    return float(wet().frequency[11])


@check(
    "acoustics/wet-mode-degree-2",
    quantity="mean wet frequency of the thick shell's five modes of degree 2 [Hz]",
    reference=_OVAL,
    source=SOURCE,
    tolerance=0.01 * _OVAL,
)
def oval() -> float:
    """Modes 7 to 11."""
    return float(wet().frequency[6:11].mean())


@check(
    "acoustics/wet-over-dry-degree-2",
    quantity="wet over dry frequency of the thick shell's modes of degree 2",
    reference=_OVAL / _OVAL_DRY,
    source=SOURCE,
    # the static exterior is exact for degrees 0 and 1 only
    tolerance=5e-3 * _OVAL / _OVAL_DRY,
)
def added_mass() -> float:
    """Ratio of the means; the mesh's error of the stiffness is in both."""
    dry = dry_modes(shell().operators, HIGHEST)
    return oval() / float(dry.frequency[6:11].mean())


@check(
    "acoustics/wet-mode-count",
    quantity=f"wet modes of the thick shell below {HIGHEST:.0f} Hz, by Sylvester's law of inertia",
    reference=BELOW_HIGHEST,
    source=SOURCE,
    tolerance=0.0,
)
def count() -> float:
    """Rigid motions included."""
    return float(wet().count)


@check(
    "acoustics/wet-mode-loss",
    quantity="largest |eta_m / eta - 1| of the shell's real wet modes; all its material has loss",
    reference=0.0,
    source="uniform complex modulus",
    tolerance=1e-8,
)
def loss() -> float:
    """Elastic modes only."""
    return float(np.nanmax(np.abs(wet().loss_factor / LOSSY.loss - 1.0)))


def _mean(values: Callable[[ComplexModes], FloatArray]) -> float:
    modes = damped()
    if len(modes.omega) != 5 or not modes.converged.all():
        raise ValueError(f"five modes should have converged: {modes.notices}")
    return float(values(modes).mean())


@check(
    "acoustics/complex-mode-frequency",
    quantity="frequency of the shell's modes of degree 2 with loss and radiation [Hz]",
    reference=_DAMPED.real,
    source=f"{SOURCE}, with the wave that first-order BGT reflects",
    tolerance=6e-3 * _DAMPED.real,
)
def damped_frequency() -> float:
    """Mean of the five."""
    return _mean(lambda modes: modes.frequency)


@check(
    "acoustics/complex-mode-loss",
    quantity="loss factor 2 Im / Re of these modes; 0.05 of it is the material's",
    reference=2.0 * _DAMPED.imag / _DAMPED.real,
    source=f"{SOURCE}, with the wave that first-order BGT reflects",
    tolerance=4e-3 * 2.0 * _DAMPED.imag / _DAMPED.real,
)
def damped_loss() -> float:
    """Mean of the five."""
    return _mean(lambda modes: modes.loss_factor)
