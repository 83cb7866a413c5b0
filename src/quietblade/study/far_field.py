# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sound away from the blade: waves, efficiency, pressure at points, patterns at frequencies."""

from dataclasses import dataclass

import numpy as np

from quietblade.case import Case
from quietblade.errors import Notice
from quietblade.study.vibration import Vibration
from quietblade.typing import AnyArray, ComplexArray, FloatArray
from quietblade.vibroacoustics.dtn import Dtn
from quietblade.vibroacoustics.farfield import degree_error, degree_notices, sphere_waves
from quietblade.vibroacoustics.multipoles import Multipoles, SurfaceSources
from quietblade.vibroacoustics.power import radiation_efficiency
from quietblade.vibroacoustics.radiation_check import estimated_error

PEAK, GIVEN = "peak", "given"
"""Why a frequency has a pattern."""


@dataclass(frozen=True, eq=False)
class Samples:
    """A response at some frequencies.

    Attributes
    ----------
    omega : (f,) float array
        [rad/s]
    response : (f, n) complex array
        Unknowns, or coordinates (f, k) on the columns.
    sources : SurfaceSources
        Sources on the wetted surface, of the unknowns or of the coordinates.
    columns : (k, n) array or None
        Columns of the reduced model.
    """

    omega: FloatArray
    response: ComplexArray
    sources: SurfaceSources
    columns: AnyArray | None = None


@dataclass(frozen=True, eq=False)
class Outside:
    """The field outside at some frequencies.

    Attributes
    ----------
    waves : Multipoles
        Outgoing waves: by the sphere's harmonics under the exact condition, else by the
        Kirchhoff-Helmholtz integral, which does not see what the sphere reflects.
    efficiency : (f,) float array
        Radiation efficiency (theory: S2-47).
    """

    waves: Multipoles
    efficiency: FloatArray


@dataclass(frozen=True, eq=False)
class FarField:
    """Sound away from the blade in one configuration.

    Attributes
    ----------
    origin : str
        Where the waves are taken from: ``sphere`` or ``multipoles``.
    spectrum : Outside
        At the frequencies of the sweep.
    condition_error : (f,) float array
        Estimated error of the power by the radiation condition [dB].
    points : (p, 3) float array
        [m]
    pressure : (p, f) complex array
        Sound pressure there [Pa].
    patterns : Outside
        At the peaks, then at the frequencies that the user gives.
    reason : tuple of str
        Of each pattern, ``peak`` or ``given``.
    notices : tuple of Notice
    """

    origin: str
    spectrum: Outside
    condition_error: FloatArray
    points: FloatArray
    pressure: ComplexArray
    patterns: Outside
    reason: tuple[str, ...]
    notices: tuple[Notice, ...]


def solve_far_field(
    case: Case, vibration: Vibration, spectrum: Samples, patterns: Samples, peaks: int
) -> FarField:
    """Find the sound outside.

    Parameters
    ----------
    spectrum : Samples
        Response over the band; rows that could not be solved are nan.
    patterns : Samples
        Response at the peaks, of which there are ``peaks``, and at the frequencies of the case.
    """
    points = np.array(case.far_field.points, dtype=float).reshape(-1, 3)
    given = len(patterns.omega) - peaks
    whole = _outside(vibration, spectrum)
    return FarField(
        origin="sphere" if _exact(vibration) else "multipoles",
        spectrum=whole,
        condition_error=_condition_error(vibration, spectrum, whole.waves),
        points=points,
        pressure=_pressure(vibration, spectrum, whole.waves, points),
        patterns=_outside(vibration, patterns),
        reason=(PEAK,) * peaks + (GIVEN,) * given,
        notices=(*_degree_notices(vibration, spectrum), *_near_points(case, vibration, points)),
    )


def _exact(vibration: Vibration) -> bool:
    return isinstance(vibration.operators.condition, Dtn)


def _outside(vibration: Vibration, samples: Samples) -> Outside:
    operators, omega = vibration.operators, samples.omega
    if _exact(vibration):
        waves = sphere_waves(operators, omega, samples.response, samples.columns)
    else:
        waves = samples.sources.multipoles(omega, samples.response)
    efficiency = radiation_efficiency(
        operators, vibration.normal_motion, omega, samples.response, waves.power, samples.columns
    )
    return Outside(waves, efficiency)


def _condition_error(vibration: Vibration, samples: Samples, waves: Multipoles) -> FloatArray:
    operators = vibration.operators
    if _exact(vibration):
        share = degree_error(operators, samples.omega, samples.response, samples.columns)
        return np.asarray(10.0 * np.log10(1.0 + share))
    return estimated_error(operators.condition, operators.radius, waves)


def _degree_notices(vibration: Vibration, samples: Samples) -> list[Notice]:
    if not _exact(vibration):
        return []
    solved = np.isfinite(samples.response).all(axis=1)
    if not solved.any():
        return []
    return degree_notices(
        vibration.operators, samples.omega[solved], samples.response[solved], samples.columns
    )


def _pressure(
    vibration: Vibration, samples: Samples, waves: Multipoles, points: FloatArray
) -> ComplexArray:
    """Pressure (p, f): outside the ball of the waves by them, nearer by the wetted surface."""
    pressure = np.empty((len(points), len(samples.omega)), dtype=np.complex128)
    far = np.linalg.norm(points - waves.center, axis=1) > waves.reach
    if far.any():
        pressure[far] = waves.pressure(points[far]).T
    if not far.all():
        near = samples.sources.pressure(samples.omega, samples.response, points[~far])
        pressure[~far] = near.T
    return pressure


def _near_points(case: Case, vibration: Vibration, points: FloatArray) -> list[Notice]:
    """Say which points the blade of this configuration comes too close to."""
    surface, least = vibration.sources.points, case.mesh.size
    found = []
    for number, point in enumerate(points):
        distance = float(np.linalg.norm(surface - point, axis=1).min())
        if distance < least:
            found.append(
                Notice(
                    f"far_field.points[{number}], {vibration.name}",
                    "lies within a cell of the blade, where the integral over its surface is not "
                    "accurate; distance from the nearest node [m]",
                    distance,
                    least,
                    "Move the point, or reduce mesh.size",
                )
            )
    return found
