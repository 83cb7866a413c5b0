# SPDX-License-Identifier: LGPL-2.1-or-later
"""The stream that each section meets."""

from dataclasses import dataclass
from typing import ClassVar, Protocol

import numpy as np

from quietblade.flow.loads import SectionLoads, TotalLoads, integrate, section_loads
from quietblade.flow.sections import AXIS, DeformedSections, section_frames
from quietblade.typing import FloatArray


class Inflow(Protocol):
    """A model of the stream: deformed sections in, loads out."""

    @property
    def name(self) -> str:
        """Name in a case file."""
        ...

    def loads(self, sections: DeformedSections) -> SectionLoads:
        """Compute the loads on the sections."""
        ...


@dataclass(frozen=True)
class StripInflow:
    """Every section meets the undisturbed water: no velocity is induced by the other sections.

    The blade turns with ``+rotation`` about the x axis and moves with ``speed`` against it, so that
    the water's velocity relative to the blade at x is ``W = speed e_x - rotation e_x × x``. Strip
    theory overestimates the lift of a blade of finite span, most of all at the tip.

    Attributes
    ----------
    speed : float
        Speed of advance V along the axis [m/s].
    rotation : float
        Angular velocity [rad/s].
    density : float
        Density of the water [kg/m3].
    kinematic_viscosity : float
        Of the water [m2/s], for the Reynolds number.
    """

    name: ClassVar[str] = "none"

    speed: float
    rotation: float
    density: float = 1000.0
    kinematic_viscosity: float = 1.0e-6

    def velocity(self, points: FloatArray) -> FloatArray:
        """Velocity of the water relative to the blade at points (..., 3) [m/s]."""
        result: FloatArray = self.speed * AXIS - self.rotation * np.cross(AXIS, points)
        return result

    def loads(self, sections: DeformedSections) -> SectionLoads:
        """Compute the loads on the sections in the stream at their reference points.

        Parameters
        ----------
        sections : DeformedSections

        Returns
        -------
        SectionLoads

        Raises
        ------
        GeometryError
            A contour cannot be solved.
        """
        return section_loads(
            sections,
            self.velocity(sections.reference),
            density=self.density,
            kinematic_viscosity=self.kinematic_viscosity,
        )


@dataclass(frozen=True, eq=False)
class BladeFlow:
    """Sections of a blade, the loads on them and their sum."""

    sections: DeformedSections
    loads: SectionLoads
    total: TotalLoads


def strip_loads(points: FloatArray, inflow: Inflow) -> BladeFlow:
    """Compute the loads on a blade from the deformed nodes of its sections.

    Parameters
    ----------
    points : array (M, N, 3)
        As for `quietblade.flow.sections.section_frames`.
    inflow : Inflow

    Returns
    -------
    BladeFlow

    Raises
    ------
    GeometryError
        The sections cannot be projected or solved.
    """
    sections = section_frames(points)
    loads = inflow.loads(sections)
    return BladeFlow(sections, loads, integrate(sections, loads))
