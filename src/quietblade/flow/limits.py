# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where attached, cavity-free, well resolved flow ends: notices on section loads.

They inform and change nothing: the loads remain those of attached inviscid flow.
"""

from dataclasses import dataclass

import numpy as np

from quietblade.errors import Notice
from quietblade.flow.loads import SectionLoads
from quietblade.flow.sections import DeformedSections
from quietblade.typing import BoolArray, FloatArray

STALL_THICKNESS = np.array([0.06, 0.09, 0.12])
STALL_INCIDENCE = np.radians([5.75, 10.5, 13.5])
"""Incidence of greatest lift of NACA 0006, 0009 and 0012 at Re = 3.8e5 in XFOIL 6.99 with free
transition (N = 9). Thin sections stall from the nose; higher Reynolds numbers delay it (0006: 7.75
deg at 1e6). The incidence is that of the chord, because the ideal incidence of sections that
bending or a parabolic mean line has cambered is near 0."""

MAX_DRAG_ERROR = 5e-3
"""Numerical drag coefficient above which the nose is badly resolved for this incidence."""


@dataclass(frozen=True)
class Environment:
    """What decides stall and cavitation besides the loads.

    Attributes
    ----------
    depth : float
        Depth of the rotor axis below the surface [m].
    atmospheric_pressure, vapour_pressure : float
        [Pa]; the vapour pressure is that of water at 20 degrees Celsius.
    gravity : float
        [m/s2]
    stall_incidence : float or None
        Limit of the incidence for all sections [rad]; None: `STALL_INCIDENCE`, interpolated to
        each section's thickness.
    """

    depth: float = 5.0
    atmospheric_pressure: float = 101325.0
    vapour_pressure: float = 2339.0
    gravity: float = 9.80665
    stall_incidence: float | None = None


def cavitation_number(
    sections: DeformedSections, loads: SectionLoads, environment: Environment
) -> FloatArray:
    r"""Cavitation number of each section (M,), with the blade at the top of its turn.

    .. math:: \sigma = \frac{p_{atm} + \rho g (h - r) - p_v}{\tfrac12 \rho W_n^2}

    with the depth h of the axis and the distance r of the section from it. Inception is predicted
    where :math:`\sigma \le -C_{p,min}`. Infinite where the water is at rest.
    """
    radius = np.hypot(sections.reference[:, 1], sections.reference[:, 2])
    water = loads.density * environment.gravity * (environment.depth - radius)
    available = environment.atmospheric_pressure + water - environment.vapour_pressure
    moving = loads.dynamic_pressure > 0.0
    divisor = np.where(moving, loads.dynamic_pressure, 1.0)
    result: FloatArray = np.where(moving, available / divisor, np.inf)
    return result


def notices(
    sections: DeformedSections, loads: SectionLoads, environment: Environment | None = None
) -> list[Notice]:
    """Say where the loads are doubtful: stall, cavitation, discretisation.

    Parameters
    ----------
    sections : DeformedSections
    loads : SectionLoads
    environment : Environment, optional
        Default: `Environment()`.

    Returns
    -------
    list of Notice
        At most one of each kind, for the section that is worst.
    """
    environment = environment or Environment()
    suction = -loads.cp.min(axis=1)
    sigma = cavitation_number(sections, loads, environment)
    found = [
        _notice(
            sections,
            "incidence [rad] beyond the stall of such sections",
            np.abs(loads.alpha),
            _stall_limit(sections, environment),
            "The lift is overestimated there; compare with a finite-span inflow or lower the load",
        ),
        _notice(
            sections,
            "cavitation inception: suction -Cp_min above the cavitation number",
            suction,
            sigma,
            "Go deeper or slower. A suction peak narrower than the boundary layer exaggerates",
        ),
        _notice(
            sections,
            "numerical drag coefficient of the pressure",
            np.abs(loads.drag_error),
            np.full(len(suction), MAX_DRAG_ERROR),
            "Use more nodes on each section",
        ),
    ]
    return [notice for notice in found if notice is not None]


def _stall_limit(sections: DeformedSections, environment: Environment) -> FloatArray:
    if environment.stall_incidence is not None:
        return np.full(len(sections.chord), environment.stall_incidence)
    result: FloatArray = np.interp(sections.thickness(), STALL_THICKNESS, STALL_INCIDENCE)
    return result


def _notice(
    sections: DeformedSections, message: str, value: FloatArray, limit: FloatArray, remedy: str
) -> Notice | None:
    beyond: BoolArray = value > limit
    if not beyond.any():
        return None
    k = int(np.argmax(value - limit))
    count = f"{np.count_nonzero(beyond)} of {len(beyond)} sections"
    where = f"flow, section {k}, {sections.arc_length[k]:.3g} m along the span"
    return Notice(where, f"{message}, on {count}", float(value[k]), float(limit[k]), remedy)
