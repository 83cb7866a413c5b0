# SPDX-License-Identifier: LGPL-2.1-or-later
"""Levels under water and how they depend on the direction (theory: S2-49)."""

from dataclasses import dataclass

import numpy as np

from quietblade.typing import AnyArray, ComplexArray, FloatArray
from quietblade.vibroacoustics.fluid import Water
from quietblade.vibroacoustics.harmonics import outgoing
from quietblade.vibroacoustics.multipoles import Multipoles

REFERENCE_PRESSURE = 1e-6


@dataclass(frozen=True)
class Directivity:
    """Sound in some directions.

    Attributes
    ----------
    directions : (d, 3) array
        Unit vectors from the centre of the waves.
    distance : float
        [m], infinite for the far field.
    product : (f, d) complex array
        p r exp(i k r) [Pa m].
    level : (f, d) array
        Pressure level times distance, 20 lg(p_rms r) [dB re 1 uPa m]; far away the source level in
        that direction.
    index : (f, d) array
        Squared pressure over its mean over all directions [dB].
    """

    directions: FloatArray
    distance: float
    product: ComplexArray
    level: FloatArray
    index: FloatArray


def directivity(waves: Multipoles, directions: FloatArray, distance: float = np.inf) -> Directivity:
    """Sound at one distance in any directions.

    Parameters
    ----------
    waves : Multipoles
    directions : (d, 3) array
        Need not be of unit length.
    distance : float
        From the centre of the waves [m].

    Raises
    ------
    ValueError
        If a direction has no length, or the distance does not lie outside the body.
    """
    length = np.linalg.norm(directions, axis=1)
    if not np.all(length > 0.0):
        raise ValueError("directivity: a direction without length; give vectors that are not zero")
    if not distance >= waves.reach * (1.0 - 1e-9):
        raise ValueError(
            f"directivity: {distance:.4g} m from the centre is inside the ball of "
            f"{waves.reach:.4g} m that holds the body; take a larger distance"
        )
    unit = directions / length[:, None]
    water, starts = waves.water, np.arange(waves.degree + 1) ** 2
    strength = np.add.reduceat(np.abs(waves.amplitudes) ** 2, starts, axis=1)
    if np.isinf(distance):
        product = waves.far_field(unit)
        mean = (water.density * water.sound_speed) ** 2 * strength.sum(axis=1)
    else:
        kr = waves.omega / water.sound_speed * distance
        at = waves.pressure(waves.center + distance * unit)
        product = at * distance * np.exp(1j * kr)[:, None]
        radial = np.stack([outgoing(degree, kr) for degree in range(waves.degree + 1)], axis=1)
        scale = (waves.omega * water.density * distance) ** 2
        mean = scale * np.sum(np.abs(radial) ** 2 * strength, axis=1)
    mean = mean / (4.0 * np.pi)
    with np.errstate(divide="ignore"):  # a null of the pattern is minus infinity
        index = 10.0 * np.log10(np.abs(product) ** 2 / mean[:, None])
    return Directivity(unit, distance, product, pressure_level(product), index)


def pressure_level(pressure: AnyArray) -> FloatArray:
    """Level of peak amplitudes [dB re 1 uPa]: 20 lg(|p|/sqrt 2), minus infinity for silence."""
    with np.errstate(divide="ignore"):
        rms = np.abs(pressure) / np.sqrt(2.0)
        return np.asarray(20.0 * np.log10(rms / REFERENCE_PRESSURE))


def source_level(power: FloatArray, water: Water) -> FloatArray:
    """Source level of a power, averaged over all directions [dB re 1 uPa m].

    10 lg(rho c P / (4 pi)): the level of sound power re 1 pW plus 50.8 dB in fresh water.  A power
    that is not positive has none (nan).
    """
    positive = np.asarray(power) > 0.0
    squared = np.where(positive, power, 1.0) * water.density * water.sound_speed / (4.0 * np.pi)
    return np.where(positive, 10.0 * np.log10(squared / REFERENCE_PRESSURE**2), np.nan)


def plane_directions(
    normal: tuple[float, float, float], count: int, start: tuple[float, float, float] | None = None
) -> tuple[FloatArray, FloatArray]:
    """Directions around a circle, for a polar diagram.

    Parameters
    ----------
    normal : (3,) tuple of float
        Normal of the plane; angles turn about it.
    count : int
        Number of directions.
    start : (3,) tuple of float or None
        Direction of angle zero, made perpendicular to the normal; None takes the axis that is
        nearest to the plane.

    Returns
    -------
    angles : (count,) array
        [rad]
    directions : (count, 3) array

    Raises
    ------
    ValueError
        If the normal has no length, or start and normal are parallel.
    """
    if not np.linalg.norm(normal) > 0.0:
        raise ValueError("directivity: the plane's normal must not be zero")
    axis = np.asarray(normal, dtype=float) / np.linalg.norm(normal)
    first = np.eye(3)[np.argmin(np.abs(axis))] if start is None else np.asarray(start, dtype=float)
    first = first - (first @ axis) * axis
    length = float(np.linalg.norm(first))
    if length < 1e-9:
        raise ValueError("directivity: the start direction is parallel to the plane's normal")
    first /= length
    angles = 2.0 * np.pi * np.arange(count) / count
    turned = np.outer(np.cos(angles), first) + np.outer(np.sin(angles), np.cross(axis, first))
    return angles, turned
