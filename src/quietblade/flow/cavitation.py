# SPDX-License-Identifier: LGPL-2.1-or-later
r"""Where cavitation is expected to begin: :math:`\sigma \le -C_{p,min}` (theory: S1-87).

The suction of an inviscid section is an upper bound near the nose, where the peak may be narrower
than the boundary layer; then inception is later than predicted.
"""

import numpy as np
from numpy.typing import ArrayLike

from quietblade.flow.environment import Environment
from quietblade.flow.inflow import radii
from quietblade.flow.loads import SectionLoads
from quietblade.flow.panel import PanelSections
from quietblade.flow.sections import DeformedSections
from quietblade.typing import BoolArray, FloatArray

_LARGEST_INCIDENCE = np.radians(25.0)
_INCIDENCES = 1001
_BARE = 0.02  # share of the greatest lift coefficient below which an end counts as without lift


def cavitation_number(
    sections: DeformedSections,
    loads: SectionLoads,
    environment: Environment,
    position: ArrayLike = 0.0,
) -> FloatArray:
    r"""Cavitation number of each section.

    .. math:: \sigma = \frac{p_{atm} + \rho g (h - r\cos\beta) - p_v}{\tfrac12 \rho W_n^2}

    with the depth h of the axis, the distance r of the section from it and the angle
    :math:`\beta` of the blade from the top of its turn.

    Parameters
    ----------
    sections : DeformedSections
    loads : SectionLoads
    environment : Environment
    position : array_like (...)
        Angles from the top of the turn [rad]; default: at the top, where it is least.

    Returns
    -------
    array (..., M)
        Infinite where the water is at rest.
    """
    beta = np.asarray(position, dtype=np.float64)[..., None]
    submergence = environment.depth - radii(sections) * np.cos(beta)
    available = environment.available_pressure(submergence, loads.density)
    moving = loads.dynamic_pressure > 0.0
    divisor = np.where(moving, loads.dynamic_pressure, 1.0)
    result: FloatArray = np.where(moving, available / divisor, np.inf)
    return result


def suction(loads: SectionLoads) -> FloatArray:
    """Greatest suction ``-Cp_min`` of each section (M,)."""
    result: FloatArray = -loads.cp.min(axis=1)
    return result


def is_judged(loads: SectionLoads) -> BoolArray:
    """Sections (M,) whose suction says where cavitation begins: all but a free end without lift.

    Where an inflow model lets the lift vanish, at a tip or hub, the whole incidence of the last
    section is undone at once: it stands at zero lift, with a suction at its nose that no tip has.
    """
    lift = np.abs(loads.lift_coefficient)
    result: BoolArray = np.ones(len(lift), dtype=np.bool_)
    if np.any(loads.induced):
        result[[0, -1]] = lift[[0, -1]] >= _BARE * lift.max()
    return result


def inception_submergence(
    suction: ArrayLike, speed: ArrayLike, environment: Environment, density: float = 1000.0
) -> FloatArray:
    """Depth below the surface above which a section cavitates [m].

    Parameters
    ----------
    suction : array_like
        ``-Cp_min`` of the section.
    speed : array_like
        Speed of its stream [m/s]; broadcast against the suction.
    environment : Environment
        Its depth is not used.
    density : float
        [kg/m3]

    Returns
    -------
    array
        Negative where the pressure of the atmosphere alone prevents cavitation.
    """
    peak = 0.5 * density * np.square(speed) * np.asarray(suction, dtype=np.float64)
    surface = environment.available_pressure(0.0, density)
    result: FloatArray = (peak - surface) / (density * environment.gravity)
    return result


def inception_depth(
    sections: DeformedSections, loads: SectionLoads, environment: Environment
) -> FloatArray:
    """Depth of the rotor axis above which each section cavitates at the top of its turn (M,) [m].

    The blade is free of cavitation below the largest of them; minus infinity where a section is
    not judged.
    """
    local = inception_submergence(suction(loads), loads.speed, environment, loads.density)
    result: FloatArray = np.where(is_judged(loads), local + radii(sections), -np.inf)
    return result


def inception_speed(
    suction: ArrayLike, submergence: ArrayLike, environment: Environment, density: float = 1000.0
) -> FloatArray:
    """Speed of a section's stream at which it begins to cavitate at fixed incidence [m/s].

    Parameters
    ----------
    suction : array_like
        ``-Cp_min``.
    submergence : array_like
        Depth of the section below the surface [m]; broadcast against the suction.
    environment : Environment
        Its depth is not used.
    density : float
        [kg/m3]

    Returns
    -------
    array
        Infinite without suction, 0 where the water boils at rest.
    """
    peak = np.asarray(suction, dtype=np.float64)
    available = np.maximum(environment.available_pressure(submergence, density), 0.0)
    sucked = peak > 0.0
    square = 2.0 * available / (density * np.where(sucked, peak, 1.0))
    result: FloatArray = np.where(sucked, np.sqrt(square), np.inf)
    return result


def inception_ship_speed(
    sections: DeformedSections, loads: SectionLoads, environment: Environment, speed: float
) -> FloatArray:
    """Ship speed at which each section begins to cavitate at the top of its turn (M,) [m/s].

    The rotation grows with the speed: at a constant advance ratio the incidences stay.

    Parameters
    ----------
    sections : DeformedSections
    loads : SectionLoads
        At the speed ``speed``.
    environment : Environment
    speed : float
        [m/s]

    Returns
    -------
    array (M,)
        Infinite where a section is not judged.
    """
    submergence = environment.depth - radii(sections)
    local = inception_speed(suction(loads), submergence, environment, loads.density)
    moving = (loads.speed > 0.0) & is_judged(loads)
    result: FloatArray = np.where(
        moving, abs(speed) * local / np.where(moving, loads.speed, 1.0), np.inf
    )
    return result


def cavitation_bucket(contours: FloatArray, sigma: ArrayLike) -> tuple[FloatArray, FloatArray]:
    r"""Range of incidence in which sections do not cavitate.

    The surface speed at a node is :math:`G\,|\cos(\alpha - \delta)|`, so each node cavitates within
    :math:`\arccos(\sqrt{1 + \sigma} / G)` of its :math:`\delta`: the limits are exact for the panel
    method. The range is the one around the incidence of least suction.

    Parameters
    ----------
    contours : array (M, N, 2)
        In units of the chord, see `PanelSections`.
    sigma : array_like (...)
        Cavitation numbers.

    Returns
    -------
    lowest, highest : array (..., M)
        Incidences from the chord [rad]; nan where every incidence within 25 degrees cavitates.

    Raises
    ------
    GeometryError
        A contour cannot be solved.
    """
    unit = PanelSections(contours).unit
    strength = np.hypot(unit[..., 0], unit[..., 1])
    place = np.arctan2(unit[..., 1], unit[..., 0])
    best = _least_suction(unit)
    above = best[:, None] + np.mod(place - best[:, None], np.pi)
    limit = np.sqrt(np.maximum(1.0 + np.asarray(sigma, dtype=np.float64), 0.0))[..., None, None]
    ratio = np.minimum(limit / np.maximum(strength, 1e-300), 1.0)
    width = np.where(limit < strength, np.arccos(ratio), 0.0)
    highest = np.min(np.where(width > 0.0, above - width, np.inf), axis=-1)
    lowest = np.max(np.where(width > 0.0, above - np.pi + width, -np.inf), axis=-1)
    dry = (lowest < best) & (best < highest)
    end = _LARGEST_INCIDENCE
    return (
        np.where(dry, np.clip(lowest, -end, end), np.nan),
        np.where(dry, np.clip(highest, -end, end), np.nan),
    )


def _least_suction(unit: FloatArray) -> FloatArray:
    """Incidence of the least suction of each section (M,) [rad], to a twentieth of a degree."""
    alpha = np.linspace(-_LARGEST_INCIDENCE, _LARGEST_INCIDENCE, _INCIDENCES)
    streams = np.stack([np.cos(alpha), np.sin(alpha)])
    fastest = np.array([np.abs(section @ streams).max(axis=0) for section in unit])
    result: FloatArray = alpha[np.argmin(fastest, axis=1)]
    return result
