# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sound away from the blade: waves, efficiency, pressure at points, patterns at frequencies."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from quietblade.case import AnyCase
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
    """A response at some frequencies, in parts that are independent of each other.

    Attributes
    ----------
    omega : (f,) float array
        [rad/s]
    responses : tuple of (f, n) complex arrays
        Unknowns, or coordinates (f, k) on the columns, of each part; the powers of parts add. One
        harmonic excitation is one part.
    sources : SurfaceSources
        Sources on the wetted surface, of the unknowns or of the coordinates.
    columns : (k, n) array or None
        Columns of the reduced model.
    """

    omega: FloatArray
    responses: tuple[ComplexArray, ...]
    sources: SurfaceSources
    columns: AnyArray | None = None


@dataclass(frozen=True, eq=False)
class Outside:
    """The field outside at some frequencies.

    Attributes
    ----------
    parts : tuple of Multipoles
        Outgoing waves of each part: by the sphere's harmonics under the exact condition, else by
        the Kirchhoff-Helmholtz integral, which does not see what the sphere reflects.
    efficiency : (f,) float array
        Radiation efficiency (theory: S2-47).
    """

    parts: tuple[Multipoles, ...]
    efficiency: FloatArray

    @property
    def waves(self) -> Multipoles:
        """Waves of the first part, for what all parts have in common."""
        return self.parts[0]

    @property
    def power(self) -> FloatArray:
        """Power of all parts (f,) [W]."""
        return np.asarray(sum(part.power for part in self.parts))

    @property
    def share(self) -> FloatArray:
        """Share of monopole, dipole, quadrupole and all higher degrees in the power, (f, 4)."""
        powers = np.zeros((len(self.waves.omega), 4))
        for part in self.parts:
            each = part.power_by_degree
            powers[:, : min(3, each.shape[1])] += each[:, :3]
            powers[:, 3] += each[:, 3:].sum(axis=1)
        return np.asarray(powers / self.power[:, None])


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
        Sound pressure there [Pa], of several parts the root of the sum of squares.
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
    case: AnyCase, vibration: Vibration, spectrum: Samples, patterns: Samples, peaks: int
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
        condition_error=_condition_error(vibration, spectrum, whole),
        points=points,
        pressure=_pressure(spectrum, whole, points),
        patterns=_outside(vibration, patterns),
        reason=(PEAK,) * peaks + (GIVEN,) * given,
        notices=(*_degree_notices(vibration, spectrum), *_near_points(case, vibration, points)),
    )


def together(parts: Sequence[ComplexArray]) -> ComplexArray:
    """Amplitude of independent parts: the root of the sum of squares; one part keeps its phase."""
    if len(parts) == 1:
        return parts[0]
    return np.sqrt(sum(np.abs(part) ** 2 for part in parts)) + 0j


def _exact(vibration: Vibration) -> bool:
    return isinstance(vibration.operators.condition, Dtn)


def _outside(vibration: Vibration, samples: Samples) -> Outside:
    operators, omega, columns = vibration.operators, samples.omega, samples.columns
    parts, plane = [], np.zeros(len(omega))
    root = vibration.excited.root
    carried = None if root is None else root.carried
    for response in samples.responses:
        if _exact(vibration):
            waves = sphere_waves(operators, omega, response, columns)
        else:
            waves = samples.sources.multipoles(omega, response)
        one = np.ones(len(omega))
        plane += 1.0 / radiation_efficiency(
            operators, vibration.normal_motion, omega, response, one, columns, carried
        )
        parts.append(waves)
    power = np.asarray(sum(part.power for part in parts))
    return Outside(tuple(parts), power / plane)


def _condition_error(vibration: Vibration, samples: Samples, outside: Outside) -> FloatArray:
    """Estimate of the part that is worst."""
    operators = vibration.operators
    if _exact(vibration):
        shares = [
            degree_error(operators, samples.omega, response, samples.columns)
            for response in samples.responses
        ]
        return np.asarray(10.0 * np.log10(1.0 + np.max(shares, axis=0)))
    errors = np.array(
        [estimated_error(operators.condition, operators.radius, w) for w in outside.parts]
    )
    worst = np.argmax(np.where(np.isnan(errors), np.inf, np.abs(errors)), axis=0)
    return np.asarray(errors[worst, np.arange(errors.shape[1])])


def _degree_notices(vibration: Vibration, samples: Samples) -> list[Notice]:
    if not _exact(vibration):
        return []
    found: list[Notice] = []
    for response in samples.responses:
        solved = np.isfinite(response).all(axis=1)
        if solved.any():
            found += degree_notices(
                vibration.operators, samples.omega[solved], response[solved], samples.columns
            )
    return list(dict.fromkeys(found))


def _pressure(samples: Samples, outside: Outside, points: FloatArray) -> ComplexArray:
    """Pressure (p, f): outside the ball of the waves by them, nearer by the wetted surface."""
    pressure = np.empty((len(points), len(samples.omega)), dtype=np.complex128)
    waves = outside.waves
    far = np.linalg.norm(points - waves.center, axis=1) > waves.reach
    if far.any():
        pressure[far] = together([part.pressure(points[far]) for part in outside.parts]).T
    if not far.all():
        near = [
            samples.sources.pressure(samples.omega, response, points[~far])
            for response in samples.responses
        ]
        pressure[~far] = together(near).T
    return pressure


def _near_points(case: AnyCase, vibration: Vibration, points: FloatArray) -> list[Notice]:
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
