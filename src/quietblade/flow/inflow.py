# SPDX-License-Identifier: LGPL-2.1-or-later
"""The stream that each section meets: the protocol of its models, and strip theory."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar, Protocol

import numpy as np

from quietblade.errors import Notice
from quietblade.flow.loads import SectionLoads, TotalLoads, integrate, section_loads
from quietblade.flow.panel import PanelSections
from quietblade.flow.sections import AXIS, DeformedSections, section_frames
from quietblade.flow.wake import RadialWake
from quietblade.typing import FloatArray

LOWEST_STRIP_ASPECT_RATIO = 20.0
"""Aspect ratio below which the finite span takes more than a tenth of a strip blade's lift."""


class Inflow(Protocol):
    """A model of the stream: deformed sections in, loads out."""

    @property
    def name(self) -> str:
        """Name in a case file."""
        ...

    @property
    def validity(self) -> str:
        """For which blades the model is meant, in a sentence."""
        ...

    def loads(
        self, sections: DeformedSections, panels: PanelSections | None = None
    ) -> SectionLoads:
        """Compute the loads on the sections; ``panels`` is their solution if there is one."""
        ...

    def notices(self, sections: DeformedSections, loads: SectionLoads) -> list[Notice]:
        """Say what of the blade and its flow is outside of the model."""
        ...


@dataclass(frozen=True)
class Stream:
    """Undisturbed water as the turning blade meets it; base of the models of induced velocity.

    The blade turns with ``+rotation`` about the x axis and moves with ``speed`` against it, so that
    the water's velocity relative to the blade at x is ``W = speed e_x - rotation e_x × x`` in a
    uniform stream (theory: S1-80).

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
    wake : RadialWake or None
        Uneven inflow, such as a ship's wake; None: uniform.
    blades : int
        Number of blades of the rotor.
    """

    speed: float
    rotation: float
    density: float = 1000.0
    kinematic_viscosity: float = 1.0e-6
    wake: RadialWake | None = None
    blades: int = 1

    def velocity(self, points: FloatArray) -> FloatArray:
        """Velocity of the undisturbed water relative to the blade at points (..., 3) [m/s]."""
        around = np.cross(AXIS, points)
        if self.wake is None:
            result: FloatArray = self.speed * AXIS - self.rotation * around
            return result
        radius = np.linalg.norm(around, axis=-1, keepdims=True)
        axial, tangential = self.wake.at(radius)
        swirl = np.divide(tangential, radius, out=np.zeros_like(radius), where=radius > 0.0)
        result = self.speed * axial * AXIS + (self.speed * swirl - self.rotation) * around
        return result

    def induced_velocity(self, sections: DeformedSections, panels: PanelSections) -> FloatArray:
        """Velocity that the blade's own vortices induce at the sections (M, 3) [m/s]."""
        return np.zeros_like(sections.reference)

    def loads(
        self, sections: DeformedSections, panels: PanelSections | None = None
    ) -> SectionLoads:
        """Compute the loads on the sections in the stream at their reference points (theory: S1-6).

        Parameters
        ----------
        sections : DeformedSections
        panels : PanelSections, optional
            Solution of the sections' contours, if there is one already.

        Returns
        -------
        SectionLoads

        Raises
        ------
        GeometryError
            A contour cannot be solved.
        """
        panels = PanelSections(sections.contours) if panels is None else panels
        induced = self.induced_velocity(sections, panels)
        return section_loads(
            sections,
            self.velocity(sections.reference) + induced,
            density=self.density,
            kinematic_viscosity=self.kinematic_viscosity,
            induced=induced,
            panels=panels,
        )

    def notices(self, sections: DeformedSections, loads: SectionLoads) -> list[Notice]:
        """Say what of the blade and its flow is outside of the model."""
        return [*self._wake_notices(sections), *self._model_notices(sections, loads)]

    def _model_notices(self, sections: DeformedSections, loads: SectionLoads) -> Iterator[Notice]:
        yield from ()

    def _wake_notices(self, sections: DeformedSections) -> Iterator[Notice]:
        if self.wake is None:
            return
        radius = radii(sections)
        table = self.wake.radius
        allowed = 0.02 * (table[-1] - table[0])
        for value, limit in ((radius.min(), table[0]), (radius.max(), table[-1])):
            if abs(value - limit) > allowed and not table[0] <= value <= table[-1]:
                yield Notice(
                    "inflow, wake table",
                    "the blade reaches beyond the radii of the table, whose end values are held",
                    float(value),
                    float(limit),
                    "Extend the table",
                )


@dataclass(frozen=True)
class StripInflow(Stream):
    """Every section meets the undisturbed water: no velocity is induced by the other sections.

    Strip theory overestimates the lift of a blade of finite span, most of all at the tip.
    """

    name: ClassVar[str] = "none"
    validity: ClassVar[str] = (
        "blades so long and slender (aspect ratio above 20) that sections do not feel each other"
    )

    def _model_notices(self, sections: DeformedSections, loads: SectionLoads) -> Iterator[Notice]:
        ratio = aspect_ratio(sections)
        if ratio < LOWEST_STRIP_ASPECT_RATIO:
            yield Notice(
                f"inflow {self.name!r}",
                f"strip theory overestimates the lift of a blade of this aspect ratio by the "
                f"factor {1.0 + 2.0 / ratio:.2f} (elliptic loading)",
                ratio,
                LOWEST_STRIP_ASPECT_RATIO,
                "Use the inflow 'lifting-line' for a fin, 'momentum' for a propeller",
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


def radii(sections: DeformedSections) -> FloatArray:
    """Distances of the reference points from the rotor axis (M,) [m]."""
    result: FloatArray = np.hypot(sections.reference[:, 1], sections.reference[:, 2])
    return result


def aspect_ratio(sections: DeformedSections) -> float:
    """Span over mean chord of one blade, along the deformed span."""
    s = sections.arc_length
    return float(s[-1] ** 2 / np.trapezoid(sections.chord, s))
