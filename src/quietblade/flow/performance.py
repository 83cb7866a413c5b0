# SPDX-License-Identifier: LGPL-2.1-or-later
"""Figures of the rotor: thrust, torque, their coefficients, efficiency; sections; curves.

Definitions (theory: S1-89): `DEFINITIONS`.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import ArrayLike

from quietblade.errors import Notice
from quietblade.flow.cavitation import cavitation_number, inception_depth, suction
from quietblade.flow.environment import Environment
from quietblade.flow.friction import ViscousLoads, section_drag, viscous_loads
from quietblade.flow.inflow import BladeFlow, Inflow, Stream, radii
from quietblade.flow.loads import SectionLoads, integrate, span_integral
from quietblade.flow.panel import PanelSections
from quietblade.flow.sections import AXIS, DeformedSections, section_frames
from quietblade.typing import FloatArray

DEFINITIONS: dict[str, tuple[str, str, str]] = {
    "blades": ("Z", "1", "number of blades"),
    "advance_speed": (
        "V_A",
        "m/s",
        "speed of advance: mean axial inflow of the ring from root to tip, by volume; in a uniform "
        "stream the ship's speed",
    ),
    "rotation": ("omega", "rad/s", "angular velocity; n = |omega| / (2 pi) turns a second"),
    "diameter": ("D", "m", "twice the largest distance of a section from the axis"),
    "thrust": ("T", "N", "force of all blades against the axis, forward"),
    "torque": ("Q", "N m", "moment of the shaft on all blades about the axis"),
    "blade_thrust": ("T / Z", "N", "thrust of one blade"),
    "blade_torque": ("Q / Z", "N m", "torque of one blade"),
    "advance_ratio": ("J", "1", "V_A / (n D)"),
    "thrust_coefficient": ("K_T", "1", "T / (rho n^2 D^4)"),
    "torque_coefficient": ("K_Q", "1", "Q sign(omega) / (rho n^2 D^5)"),
    "efficiency": ("eta", "1", "T V_A / (Q omega) = J K_T / (2 pi K_Q)"),
}
"""Symbol, unit and definition of every figure of `Performance`."""


@dataclass(frozen=True)
class Performance:
    """Figures of the rotor at one point of operation; `DEFINITIONS` says what they are.

    Coefficients of a rotor that does not turn and the efficiency of one without power are nan.
    """

    blades: int
    advance_speed: float
    rotation: float
    diameter: float
    thrust: float
    torque: float
    blade_thrust: float
    blade_torque: float
    advance_ratio: float
    thrust_coefficient: float
    torque_coefficient: float
    efficiency: float

    def table(self) -> Iterator[tuple[str, float, str, str]]:
        """Symbol, value, unit and definition of each figure."""
        for figure in fields(self):
            symbol, unit, definition = DEFINITIONS[figure.name]
            yield symbol, float(getattr(self, figure.name)), unit, definition

    def __str__(self) -> str:
        return "\n".join(
            f"{symbol:>6} = {value:.6g} {unit if unit != '1' else ''}".rstrip() + f"  ({text})"
            for symbol, value, unit, text in self.table()
        )


def performance(
    flow: BladeFlow, inflow: Stream, viscous: ViscousLoads | None = None
) -> Performance:
    """Figures of a rotor whose blades all carry the loads of one.

    Parameters
    ----------
    flow : BladeFlow
        Of one blade.
    inflow : Stream
        The model that gave it: speed, rotation, number of blades, wake.
    viscous : ViscousLoads, optional
        Drag to be added to the pressure; default: none.

    Returns
    -------
    Performance
    """
    sections = flow.sections
    force, moment = flow.total.force, flow.total.moment
    if viscous is not None:
        force = force + span_integral(sections, viscous.force)
        moment = moment + span_integral(sections, np.cross(sections.reference, viscous.force))
    thrust, torque = -float(force @ AXIS), -float(moment @ AXIS)
    radius = radii(sections)
    diameter = 2.0 * float(radius.max())
    advance = inflow.speed
    if inflow.wake is not None:
        advance *= inflow.wake.mean(float(radius.min()), float(radius.max()))
    turns = abs(inflow.rotation) / (2.0 * np.pi)
    z, density = inflow.blades, flow.loads.density
    power = torque * inflow.rotation
    sense = float(np.sign(inflow.rotation))
    return Performance(
        blades=z,
        advance_speed=advance,
        rotation=inflow.rotation,
        diameter=diameter,
        thrust=z * thrust,
        torque=z * torque,
        blade_thrust=thrust,
        blade_torque=torque,
        advance_ratio=_ratio(advance, turns * diameter),
        thrust_coefficient=_ratio(z * thrust, density * turns**2 * diameter**4),
        torque_coefficient=_ratio(z * torque * sense, density * turns**2 * diameter**5),
        efficiency=_ratio(thrust * advance, power),
    )


def ideal_efficiency(figures: Performance, density: float) -> float:
    """Efficiency that no rotor of this thrust, diameter and speed exceeds, friction apart.

    ``2 / (1 + sqrt(1 + C_T))`` with ``C_T = T / (rho V_A^2 pi D^2 / 8)``, of Rankine's and
    Froude's actuator disk (momentum theory, no swirl); nan without thrust or speed.

    Parameters
    ----------
    figures : Performance
    density : float
        Of the water [kg/m^3].
    """
    if figures.thrust <= 0.0 or figures.advance_speed <= 0.0:
        return float("nan")
    pressure = density * figures.advance_speed**2 * np.pi * figures.diameter**2 / 8.0
    return float(2.0 / (1.0 + np.sqrt(1.0 + figures.thrust / pressure)))


def ideal_notices(figures: Performance, inflow: Inflow, density: float) -> Iterator[Notice]:
    """Notice a rotor that is better than the actuator disk, by a model that induces velocities.

    Parameters
    ----------
    figures : Performance
        Without friction.
    inflow : Inflow
        Blade elements in the undisturbed stream induce nothing and are not judged.
    density : float
        Of the water [kg/m^3].
    """
    ideal = ideal_efficiency(figures, density)
    if inflow.name != "none" and figures.efficiency > ideal:
        yield Notice(
            "flow.inflow",
            "the efficiency without friction is above that of the actuator disk, which no rotor "
            "exceeds: thrust and torque of this model are too favourable here",
            figures.efficiency,
            ideal,
            'Compare with another model: inflow = "momentum" for a rotor with several blades',
        )


@dataclass(frozen=True, eq=False)
class SectionTable:
    """What a designer asks of each section; arrays (M,).

    Attributes
    ----------
    radius : array
        Distance of the mid-chord from the rotor axis [m].
    chord : array
        [m]
    thickness, camber : array
        Largest, over the chord.
    blade_angle : array
        Angle of the chord from the rotor axis [rad].
    reynolds : array
        Of the effective stream and the chord.
    incidence : array
        Effective incidence [rad].
    lift_coefficient, drag_coefficient : array
        Referred to the effective stream and the chord; the drag is viscous.
    suction : array
        ``-Cp_min``.
    cavitation_number : array
        At the top of the turn; inception is predicted where the suction reaches it.
    """

    radius: FloatArray
    chord: FloatArray
    thickness: FloatArray
    camber: FloatArray
    blade_angle: FloatArray
    reynolds: FloatArray
    incidence: FloatArray
    lift_coefficient: FloatArray
    drag_coefficient: FloatArray
    suction: FloatArray
    cavitation_number: FloatArray


def section_table(
    sections: DeformedSections,
    loads: SectionLoads,
    environment: Environment | None = None,
    drag_coefficient: ArrayLike | None = None,
) -> SectionTable:
    """Tabulate the sections.

    Parameters
    ----------
    sections : DeformedSections
    loads : SectionLoads
    environment : Environment, optional
        Default: `Environment()`.
    drag_coefficient : array_like (M,) or float, optional
        Default: `quietblade.flow.friction.section_drag`.

    Returns
    -------
    SectionTable
    """
    return SectionTable(
        radius=radii(sections),
        chord=sections.chord,
        thickness=sections.thickness(),
        camber=sections.camber,
        blade_angle=sections.blade_angle,
        reynolds=loads.reynolds,
        incidence=loads.alpha,
        lift_coefficient=loads.lift_coefficient,
        drag_coefficient=viscous_loads(sections, loads, drag_coefficient).drag_coefficient,
        suction=suction(loads),
        cavitation_number=cavitation_number(sections, loads, environment or Environment()),
    )


@dataclass(frozen=True, eq=False)
class OperatingCurves:
    """A rigid rotor at many points of operation; arrays of the shape of the points.

    Attributes
    ----------
    speed, rotation : array
        Ship's speed [m/s] and shaft speed [rad/s].
    advance_ratio, thrust, torque, thrust_coefficient, torque_coefficient, efficiency : array
        As in `DEFINITIONS`, for all blades.
    incidence : array
        Largest effective incidence of a section, by magnitude [rad].
    inception_depth : array
        Depth of the axis above which the blade cavitates at the top of its turn [m].
    """

    speed: FloatArray
    rotation: FloatArray
    advance_ratio: FloatArray
    thrust: FloatArray
    torque: FloatArray
    thrust_coefficient: FloatArray
    torque_coefficient: FloatArray
    efficiency: FloatArray
    incidence: FloatArray
    inception_depth: FloatArray


def operating_curves(
    points: FloatArray,
    inflow: Callable[[float, float], Stream],
    speeds: ArrayLike,
    rotations: ArrayLike,
    *,
    friction: str | None = "ittc-1957",
    environment: Environment | None = None,
) -> OperatingCurves:
    """Compute a rigid rotor at many speeds; the panel method is solved once.

    Parameters
    ----------
    points : array (M, N, 3)
        Nodes of the sections of one blade, as for `quietblade.flow.sections.section_frames`.
    inflow : callable
        Makes the model of a speed [m/s] and a rotation [rad/s], for example
        ``lambda v, w: MomentumInflow(v, w, blades=4)``.
    speeds, rotations : array_like
        Broadcast against each other: columns and rows make a grid.
    friction : str or None
        Friction line of the drag, see `quietblade.flow.friction.LINES`; None: no drag.
    environment : Environment, optional
        Default: `Environment()`.

    Returns
    -------
    OperatingCurves

    Raises
    ------
    GeometryError
        The sections cannot be solved, or the model does not hold for them.
    """
    environment = environment or Environment()
    sections = section_frames(points)
    panels = PanelSections(sections.contours)
    speed, rotation = np.broadcast_arrays(
        np.asarray(speeds, dtype=np.float64), np.asarray(rotations, dtype=np.float64)
    )
    rows = []
    for v, omega in zip(speed.ravel().tolist(), rotation.ravel().tolist(), strict=True):
        model = inflow(v, omega)
        loads = model.loads(sections, panels)
        flow = BladeFlow(sections, loads, integrate(sections, loads))
        drag = None
        if friction is not None:
            drag = viscous_loads(sections, loads, section_drag(sections, loads, friction))
        p = performance(flow, model, drag)
        rows.append(
            (
                p.advance_ratio,
                p.thrust,
                p.torque,
                p.thrust_coefficient,
                p.torque_coefficient,
                p.efficiency,
                float(np.abs(loads.alpha).max()),
                float(inception_depth(sections, loads, environment).max()),
            )
        )
    columns = np.array(rows, dtype=np.float64).T.reshape(-1, *speed.shape)
    return OperatingCurves(speed.copy(), rotation.copy(), *columns)


def _ratio(numerator: float, denominator: float) -> float:
    return numerator / denominator if denominator != 0.0 else float("nan")
