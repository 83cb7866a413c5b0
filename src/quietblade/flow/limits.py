# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where attached, cavity-free, well resolved flow ends: notices on section loads.

They inform and change nothing: the loads remain those of attached inviscid flow.
"""

import numpy as np

from quietblade.errors import Notice
from quietblade.flow.cavitation import cavitation_number, is_judged, suction
from quietblade.flow.environment import Environment
from quietblade.flow.loads import SectionLoads
from quietblade.flow.sections import DeformedSections
from quietblade.flow.stall import stall_incidence
from quietblade.typing import BoolArray, FloatArray

__all__ = ["Environment", "cavitation_number", "notices", "stall_limit"]

MAX_DRAG_ERROR = 5e-3
"""Numerical drag coefficient above which the nose is badly resolved for this incidence."""


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
    found = [
        _notice(
            sections,
            "incidence [rad] beyond the stall of such sections",
            np.abs(loads.alpha),
            stall_limit(sections, loads, environment),
            "The lift is overestimated there; compare with a finite-span inflow or lower the load",
        ),
        _notice(
            sections,
            "cavitation inception: suction -Cp_min above the cavitation number",
            np.where(is_judged(loads), suction(loads), -np.inf),
            cavitation_number(sections, loads, environment),
            "Go deeper or slower. A suction peak narrower than the boundary layer exaggerates",
        ),
        _notice(
            sections,
            "numerical drag coefficient of the pressure",
            np.abs(loads.drag_error),
            np.full(len(sections.chord), MAX_DRAG_ERROR),
            "Use more nodes on each section",
        ),
    ]
    return [notice for notice in found if notice is not None]


def stall_limit(
    sections: DeformedSections, loads: SectionLoads, environment: Environment
) -> FloatArray:
    """Incidence beyond which each section stalls (M,) [rad], stated or from the table of thin ones.

    `quietblade.flow.polar` looks at each section itself, with its boundary layer.
    """
    if environment.stall_incidence is not None:
        return np.full(len(sections.chord), environment.stall_incidence)
    return stall_incidence(sections.thickness(), loads.reynolds)


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
