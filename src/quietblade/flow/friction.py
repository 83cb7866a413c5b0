# SPDX-License-Identifier: LGPL-2.1-or-later
r"""Viscous drag of sections from a friction line and a form factor (theory: S1-86).

.. math:: C_D = 2\, C_F(Re)\, \bigl(1 + 2\,t/c + 60\,(t/c)^4\bigr)

The force is along the water's relative velocity. It enters thrust, torque and efficiency, not the
pressure that bends the blade: across its thin sections it does next to nothing.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from quietblade.errors import GeometryError, Notice
from quietblade.flow.loads import SectionLoads
from quietblade.flow.sections import DeformedSections
from quietblade.typing import FloatArray

LAMINAR_REYNOLDS = 5e5
"""Reynolds number below which much of a smooth section is laminar."""

_LOWEST_REYNOLDS = 1e4


def laminar_plate(reynolds: ArrayLike) -> FloatArray:
    """Friction of one side of a laminar plate, ``1.328 / sqrt(Re)`` (Blasius 1908)."""
    result: FloatArray = 1.328 / np.sqrt(np.asarray(reynolds, dtype=np.float64))
    return result


def ittc_1957(reynolds: ArrayLike) -> FloatArray:
    """Ship-model correlation line ``0.075 / (log10 Re - 2)^2`` (8th ITTC, 1957)."""
    result: FloatArray = 0.075 / (np.log10(np.asarray(reynolds, dtype=np.float64)) - 2.0) ** 2
    return result


def prandtl_schlichting(reynolds: ArrayLike) -> FloatArray:
    """Friction of one side of a smooth turbulent plate, ``0.455 / (log10 Re)^2.58``."""
    result: FloatArray = 0.455 / np.log10(np.asarray(reynolds, dtype=np.float64)) ** 2.58
    return result


LINES: dict[str, Callable[[ArrayLike], FloatArray]] = {
    "ittc-1957": ittc_1957,
    "prandtl-schlichting": prandtl_schlichting,
    "laminar": laminar_plate,
}
"""Friction lines by name."""


def friction_coefficient(reynolds: ArrayLike, line: str = "ittc-1957") -> FloatArray:
    """Friction coefficient of one side of a plate.

    Below a Reynolds number of 1e4, where no turbulent line holds, it is that of the laminar plate;
    0 in water at rest.

    Parameters
    ----------
    reynolds : array_like
    line : str
        A name of `LINES`.

    Raises
    ------
    GeometryError
        The line is unknown.
    """
    if line not in LINES:
        raise GeometryError(f"friction line {line!r} is unknown. Remedy: use one of {list(LINES)}")
    re = np.asarray(reynolds, dtype=np.float64)
    fast = np.maximum(re, _LOWEST_REYNOLDS)
    slow = laminar_plate(np.maximum(re, 1e-300))
    result: FloatArray = np.where(re > _LOWEST_REYNOLDS, LINES[line](fast), slow)
    return np.where(re > 0.0, result, 0.0)


def form_factor(thickness: ArrayLike) -> FloatArray:
    """Drag of a section over that of a plate: ``1 + 2 t/c + 60 (t/c)^4`` (Hoerner 1965)."""
    t = np.asarray(thickness, dtype=np.float64)
    result: FloatArray = 1.0 + 2.0 * t + 60.0 * t**4
    return result


def section_drag(
    sections: DeformedSections, loads: SectionLoads, line: str = "ittc-1957"
) -> FloatArray:
    """Drag coefficient of each section from a friction line (M,).

    Raises
    ------
    GeometryError
        The line is unknown.
    """
    plate = 2.0 * friction_coefficient(loads.reynolds, line)
    result: FloatArray = plate * form_factor(sections.thickness())
    return result


@dataclass(frozen=True, eq=False)
class ViscousLoads:
    """Drag that the pressure of inviscid flow does not have.

    Attributes
    ----------
    drag_coefficient : array (M,)
    force : array (M, 3)
        Per unit length of the deformed span, along the relative velocity [N/m].
    """

    drag_coefficient: FloatArray
    force: FloatArray


def viscous_loads(
    sections: DeformedSections, loads: SectionLoads, drag_coefficient: ArrayLike | None = None
) -> ViscousLoads:
    """Drag of the sections along the water's velocity relative to the blade.

    Parameters
    ----------
    sections : DeformedSections
    loads : SectionLoads
    drag_coefficient : array_like (M,) or float, optional
        From measurements or a boundary layer; default: `section_drag`.

    Returns
    -------
    ViscousLoads
    """
    given = section_drag(sections, loads) if drag_coefficient is None else drag_coefficient
    drag = np.broadcast_to(np.asarray(given, dtype=np.float64), sections.chord.shape)
    speed = np.linalg.norm(loads.velocity, axis=1)
    per_velocity = 0.5 * loads.density * speed * sections.chord * drag
    return ViscousLoads(drag.copy(), per_velocity[:, None] * loads.velocity)


def friction_notices(sections: DeformedSections, loads: SectionLoads) -> list[Notice]:
    """Say where a turbulent friction line is doubtful because much of the section is laminar."""
    low = (loads.reynolds > 0.0) & (loads.reynolds < LAMINAR_REYNOLDS)
    if not low.any():
        return []
    k = int(np.argmin(np.where(low, loads.reynolds, np.inf)))
    return [
        Notice(
            f"flow, section {k}, {sections.arc_length[k]:.3g} m along the span",
            "Reynolds number so low that a turbulent friction line overestimates the drag, on "
            f"{np.count_nonzero(low)} of {len(low)} sections",
            float(loads.reynolds[k]),
            LAMINAR_REYNOLDS,
            "Give drag coefficients from a boundary layer with transition",
        )
    ]
