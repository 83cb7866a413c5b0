# SPDX-License-Identifier: LGPL-2.1-or-later
"""The preset of a sphere in water, run as a user runs it, against the exact series.

Cells are a third longer than the preset's, so that a run takes seconds: what is left are errors of
a thousandth in frequency and of some hundredths of a decibel.
"""

from functools import cache, partial
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from scipy.special import eval_legendre

from quietblade.case import BodyCase
from quietblade.case.materials import IsotropicWords
from quietblade.case.presets import preset_text
from quietblade.results.model import ConfigurationResult, path
from quietblade.results.store import RunFolder
from quietblade.study.run import run_case
from quietblade.vibroacoustics.power import level
from verification.acoustics_closed_forms import ElasticSphere
from verification.acoustics_modes import complex_mode, real_mode
from verification.acoustics_steel_shell import cap_coefficients, cap_power
from verification.registry import check

SOURCE = "three-dimensional elasticity and spherical waves (Junger and Feit 1986), infinite water"
CAP = 20.0
FREQUENCIES = (900.0, 1000.0, 1100.0, 1200.0, 1300.0, 1400.0)
POINTS = {"behind": (0.0, 0.0, -3.0), "beside": (3.0, 0.0, 0.0)}
"""Places at which the pressure is told [m]; the cap is in front, about +z."""
RESONANCES = {2: (900.0, 1250.0), 3: (1150.0, 1450.0)}
"""Degree: range that holds its one resonance [Hz]."""
DECAY = 150.0
"""Bound of the imaginary parts of the complex frequencies [Hz]: sound takes up to 0.2 of loss."""


def sphere_case() -> BodyCase:
    """Return the preset with coarser cells, and with the frequencies that are compared."""
    changes = {
        "mesh.size": "90 mm",
        "acoustics.step": "25 Hz",
        "acoustics.points_per_mode": 0,
        "far_field.frequencies": [f"{f:g} Hz" for f in FREQUENCIES],
        "far_field.points": [[f"{x:g} m" for x in point] for point in POINTS.values()],
    }
    return BodyCase.parse(preset_text("sphere")).varied(changes)


def exact(case: BodyCase, sound_speed: float | None = None, loss: bool = True) -> ElasticSphere:
    """Sphere of a case in closed form."""
    body, steel = case.body, case.material("body")
    if not isinstance(steel, IsotropicWords) or not isinstance(steel.loss_factor, float):
        raise TypeError("the closed form is for an isotropic material with a constant loss")
    return ElasticSphere(
        outer=body.radius,
        inner=body.radius - body.thickness,
        young=steel.E * (1.0 + 1j * steel.loss_factor * loss),
        poisson=steel.nu,
        density=steel.density,
        water_density=case.water.density,
        sound_speed=sound_speed or case.water.sound_speed,
    )


@cache
def computed() -> ConfigurationResult:
    """Run the case in a folder."""
    with TemporaryDirectory() as folder:
        result = run_case(sphere_case(), RunFolder(Path(folder)))
    return result.configurations["C0"]


def power_level(frequency: float) -> float:
    """Sound power level at a frequency of the sweep [dB re 1 pW]."""
    spectrum = computed().spectrum
    (place,) = np.flatnonzero(spectrum.frequency == frequency)
    return float(spectrum.power_level[path("sphere"), place])


def pressure_level(point: str, frequency: float) -> float:
    """Level of the sound pressure at a point [dB re 1 uPa]."""
    far = computed().far_field
    (place,) = np.flatnonzero(far.frequency == frequency)
    return float(far.pressure_level[list(POINTS).index(point), place])


def exact_pressure_level(sphere: ElasticSphere, point: str, frequency: float) -> float:
    """Sum the series of the cap at a point [dB re 1 uPa]."""
    omega, place = 2.0 * np.pi * frequency, np.array(POINTS[point])
    r = float(np.linalg.norm(place))
    total = 0j
    for n, load in enumerate(cap_coefficients(np.radians(CAP), 20)):
        wave = sphere.solve(n, omega, float(load))[1]
        pressure = -1j * omega * sphere.water_density * wave.potential(r)
        total += pressure * eval_legendre(n, place[2] / r)
    return float(20.0 * np.log10(abs(total) / np.sqrt(2.0) / 1e-6))


def mean_over_degree(degree: int, values: str) -> float:
    """Mean of a column of the table of modes over the modes of a degree."""
    modes = computed().modes
    own = [name.startswith(f"n{degree}.") for name in modes.name]
    if sum(own) != 2 * degree + 1:
        raise ValueError(f"{sum(own)} modes of degree {degree}, expected {2 * degree + 1}")
    return float(np.mean(getattr(modes, values)[own]))


_SPHERE = exact(sphere_case())
_STILL = exact(sphere_case(), sound_speed=1.5e7, loss=False)

for _frequency in FREQUENCIES:
    check(
        f"acoustics/sphere-case-{_frequency:.0f}",
        quantity=f"sound power of the preset sphere in water, {_frequency:.0f} Hz [dB re 1 pW]",
        reference=float(level(np.array(cap_power(_SPHERE, np.radians(CAP), _frequency)))),
        source=f"{SOURCE}, series to degree 20",
        tolerance=0.1,
        quick=False,
    )(partial(power_level, _frequency))

for _point in POINTS:
    check(
        f"acoustics/sphere-case-{_point}",
        quantity=f"sound pressure at 3 m {_point} it, 1300 Hz [dB re 1 uPa]",
        reference=exact_pressure_level(_SPHERE, _point, 1300.0),
        source=f"{SOURCE}, series to degree 20",
        tolerance=0.1,
        quick=False,
    )(partial(pressure_level, _point, 1300.0))

for _degree, (_low, _high) in RESONANCES.items():
    _wet = real_mode(_STILL, _degree, _low, 1.2 * _high)
    check(
        f"acoustics/sphere-case-n{_degree}-frequency",
        quantity=f"mean wet frequency of its modes of degree {_degree}, incompressible water [Hz]",
        reference=_wet,
        source=SOURCE,
        tolerance=2e-3 * _wet,
        quick=False,
    )(partial(mean_over_degree, _degree, "frequency"))
    _mode = complex_mode(_SPHERE, _degree, _low, _high, DECAY)
    check(
        f"acoustics/sphere-case-n{_degree}-loss",
        quantity="their loss factor, by steel and sound, compressible water",
        reference=2.0 * _mode.imag / _mode.real,
        source=SOURCE,
        tolerance=0.01 * 2.0 * _mode.imag / _mode.real,
        quick=False,
    )(partial(mean_over_degree, _degree, "loss_factor"))
