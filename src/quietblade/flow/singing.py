# SPDX-License-Identifier: LGPL-2.1-or-later
"""Singing: vortices shed from the trailing edge in step with a mode of the blade.

The frequency follows a Strouhal number of the wake's thickness, which is that of the edge and of
the displacement of the boundary layers that leave it (theory: S1-88; Gongwer, J. Appl. Mech. 19
(1952) 432-438; Blake, Mechanics of Flow-Induced Sound and Vibration). Whether the blade then sings
depends on the shape of the edge and on the damping, which are not asked here.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from quietblade.errors import GeometryError, Notice
from quietblade.flow.loads import SectionLoads
from quietblade.flow.sections import DeformedSections
from quietblade.typing import FloatArray

STROUHAL = 0.21
"""Of the thickness of the wake; measured values of blunt edges scatter from 0.18 to 0.25."""

LOCK_IN = 0.1
"""Relative distance of two frequencies within which vortices may lock to a mode."""


def displacement_thickness(chord: ArrayLike, reynolds: ArrayLike) -> FloatArray:
    """Displacement of a turbulent boundary layer at the end of one side of a plate [m].

    ``0.0463 c Re^(-1/5)``: an eighth of the thickness ``0.37 c Re^(-1/5)`` of the seventh-power
    law (Prandtl); 0 in water at rest.
    """
    re = np.asarray(reynolds, dtype=np.float64)
    moving = re > 0.0
    power = np.where(moving, re, 1.0) ** -0.2
    result: FloatArray = np.where(moving, 0.37 / 8.0 * np.asarray(chord) * power, 0.0)
    return result


def shedding_frequency(
    speed: ArrayLike, edge: ArrayLike, displacement: ArrayLike, strouhal: float = STROUHAL
) -> FloatArray:
    """Frequency of the vortices ``St W / (t_e + delta*)`` [Hz].

    Parameters
    ----------
    speed : array_like
        [m/s]
    edge : array_like
        Thickness of the trailing edge [m].
    displacement : array_like
        Displacement thickness of both boundary layers together [m].
    strouhal : float
    """
    w, e, d = (np.asarray(part, dtype=np.float64) for part in (speed, edge, displacement))
    result: FloatArray = strouhal * w / np.where(e + d > 0.0, e + d, np.nan)
    return result


def section_shedding(
    sections: DeformedSections,
    loads: SectionLoads,
    *,
    strouhal: float = STROUHAL,
    displacement: ArrayLike | None = None,
) -> FloatArray:
    """Shedding frequency of each section (M,) [Hz].

    Parameters
    ----------
    sections : DeformedSections
    loads : SectionLoads
    strouhal : float
    displacement : array_like (M,), optional
        Displacement thickness of both sides together at the trailing edge [m], from a boundary
        layer; default: twice that of a turbulent plate.
    """
    if displacement is None:
        displacement = 2.0 * displacement_thickness(sections.chord, loads.reynolds)
    base = sections.contours[:, 0] - sections.contours[:, -1]
    edge = sections.chord * np.linalg.norm(base, axis=1)
    return shedding_frequency(loads.speed, edge, displacement, strouhal)


def singing_notices(
    sections: DeformedSections,
    shedding: FloatArray,
    frequencies: ArrayLike,
    names: Sequence[str] | None = None,
    lock_in: float = LOCK_IN,
) -> list[Notice]:
    """Say which wet modes the trailing edge may excite.

    Parameters
    ----------
    sections : DeformedSections
    shedding : array (M,)
        Of `section_shedding` [Hz].
    frequencies : array_like (K,)
        Of the wet modes [Hz].
    names : sequence of str, optional
        Of the modes; default: their numbers from 1.
    lock_in : float
        Relative distance of the frequencies that still counts.

    Returns
    -------
    list of Notice
        One for each mode, with the section that comes closest: its frequency against the mode's.

    Raises
    ------
    GeometryError
        There are not as many names as frequencies.
    """
    modes = np.atleast_1d(np.asarray(frequencies, dtype=np.float64))
    names = [f"mode {k + 1}" for k in range(len(modes))] if names is None else list(names)
    if len(names) != len(modes):
        raise GeometryError(f"singing: {len(names)} names for {len(modes)} frequencies")
    found = []
    for name, mode in zip(names, modes.tolist(), strict=True):
        distance = np.abs(shedding / mode - 1.0)
        near = distance < lock_in
        if not near.any():
            continue
        k = int(np.nanargmin(distance))
        found.append(
            Notice(
                f"flow, section {k}, {sections.arc_length[k]:.3g} m along the span",
                f"singing: vortices of the trailing edge [Hz] meet {name} within "
                f"{100.0 * lock_in:.0f} % on {np.count_nonzero(near)} of {len(near)} sections",
                float(shedding[k]),
                mode,
                "Bevel or sharpen the trailing edge there, or alter its thickness",
            )
        )
    return found
