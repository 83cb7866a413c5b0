# SPDX-License-Identifier: LGPL-2.1-or-later
"""Loads on sections in given streams, and their sums over the blade."""

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from quietblade.flow.contours import contour_loads
from quietblade.flow.panel import PanelSections
from quietblade.flow.sections import AXIS, DeformedSections
from quietblade.typing import FloatArray

MID_CHORD = np.array([0.5, 0.0])


@dataclass(frozen=True, eq=False)
class SectionLoads:
    """Flow and loads on M sections with N nodes each.

    Attributes
    ----------
    velocity : array (M, 3)
        Velocity of the stream that the sections meet, relative to the blade [m/s].
    induced : array (M, 3)
        Part of it that the blade's own vortices make; 0 in strip theory [m/s].
    alpha : array (M,)
        Effective incidence: that of the stream on the projected chord [rad].
    speed : array (M,)
        Speed of the stream normal to the span, ``W_n`` [m/s].
    density : float
        Density of the water [kg/m3].
    dynamic_pressure : array (M,)
        ``rho W_n**2 / 2`` [Pa].
    reynolds : array (M,)
        ``W_n chord / nu``.
    cp, pressure : array (M, N)
        Pressure coefficient, and pressure above that of the undisturbed water [Pa], at the nodes.
    lift_coefficient, moment_coefficient : array (M,)
        Lift perpendicular to the stream, moment about the quarter chord (nose up positive).
    drag_error : array (M,)
        Drag coefficient of the pressure, which ought to be 0; see `PanelSolution.drag`.
    force : array (M, 3)
        Integral of the pressure, per unit length of the deformed span [N/m].
    moment : array (M, 3)
        Its moment about the mid-chord reference point, per unit length of the deformed span [N].
    lift_per_length : array (M,)
        Part of the force that is perpendicular to the stream, towards the upper side [N/m].
    """

    velocity: FloatArray
    induced: FloatArray
    alpha: FloatArray
    speed: FloatArray
    density: float
    dynamic_pressure: FloatArray
    reynolds: FloatArray
    cp: FloatArray
    pressure: FloatArray
    lift_coefficient: FloatArray
    moment_coefficient: FloatArray
    drag_error: FloatArray
    force: FloatArray
    moment: FloatArray
    lift_per_length: FloatArray


@dataclass(frozen=True, eq=False)
class TotalLoads:
    """Loads on the whole blade.

    Inviscid strips without induced velocities lose no power: ``thrust V = torque omega``, but for
    the numerical drag (`SectionLoads.drag_error`) and the moments about a span that leans along the
    axis. At small incidence the thrust is a small part of the lift, so that it feels this drag by
    a few per cent.

    Attributes
    ----------
    force : array (3,)
        [N]
    moment : array (3,)
        About the origin, which lies on the rotor axis [N m].
    lift : float
        Integral of the sections' lift over the deformed span [N].
    thrust : float
        ``-force[0]``: positive when it pushes the ship forward, against the axis [N].
    torque : float
        ``-moment[0]``: positive when the shaft must drive the blade [N m].
    """

    force: FloatArray
    moment: FloatArray
    lift: float
    thrust: float
    torque: float


def section_loads(
    sections: DeformedSections,
    velocity: FloatArray,
    *,
    density: float,
    kinematic_viscosity: float,
    induced: FloatArray | None = None,
    panels: PanelSections | None = None,
) -> SectionLoads:
    r"""Compute the loads on sections, each in a plane inviscid stream.

    Only the part ``W_n`` of the stream that is normal to the deformed span acts; the part along
    the span passes by unchanged. By Bernoulli's law
    :math:`p - p_\infty = \tfrac12 \rho W_n^2 C_p`.

    Parameters
    ----------
    sections : DeformedSections
    velocity : array (M, 3)
        Velocity of the stream relative to the blade at the reference points [m/s].
    density : float
        [kg/m3]
    kinematic_viscosity : float
        [m2/s]; the Reynolds number is information only.
    induced : array (M, 3), optional
        Part of the velocity that the blade induces [m/s], kept in the result; default 0.
    panels : PanelSections, optional
        Solution of ``sections.contours``, if there is one already.

    Returns
    -------
    SectionLoads

    Raises
    ------
    GeometryError
        A contour cannot be solved, see `quietblade.flow.guards.check_contours`.
    """
    panels = PanelSections(sections.contours) if panels is None else panels
    along = np.sum(velocity * sections.chord_direction, axis=-1)
    across = np.sum(velocity * sections.normal, axis=-1)
    alpha, speed = np.arctan2(across, along), np.hypot(along, across)
    dynamic_pressure = 0.5 * density * speed**2
    solved = panels.solve(alpha)
    plane_force, turn = contour_loads(sections.contours, solved.cp, MID_CHORD)

    scale = (dynamic_pressure * sections.chord)[:, None]
    axes = np.stack([sections.chord_direction, sections.normal], axis=1)
    force = scale * np.einsum("md,mdx->mx", plane_force, axes)
    moment = scale * (sections.chord * turn)[:, None] * sections.tangent
    return SectionLoads(
        velocity=velocity,
        induced=np.zeros_like(velocity) if induced is None else induced,
        alpha=alpha,
        speed=speed,
        density=density,
        dynamic_pressure=dynamic_pressure,
        reynolds=speed * sections.chord / kinematic_viscosity,
        cp=solved.cp,
        pressure=dynamic_pressure[:, None] * solved.cp,
        lift_coefficient=solved.lift,
        moment_coefficient=solved.moment,
        drag_error=solved.drag,
        force=force,
        moment=moment,
        lift_per_length=scale[:, 0] * solved.lift,
    )


def circulation_response(sections: DeformedSections, panels: PanelSections) -> FloatArray:
    r"""Vectors b (M, 3) that make the circulation of sections: ``gamma = b . W`` (theory: S1-81).

    The vortex strength of the panel method is linear in the components of the stream, and so is
    the circulation: :math:`b = c\,(\Gamma_0 t + \Gamma_{90} n)` with the circulations in unit
    streams along and across the chord. The lift per length is :math:`\rho\, b \cdot W\, |W_n|`, the
    zero-lift direction is perpendicular to b.

    Parameters
    ----------
    sections : DeformedSections
    panels : PanelSections
        Solution of ``sections.contours``.

    Returns
    -------
    array (M, 3)
        [m]
    """
    along, across = (panels.solve(angle).circulation[:, None] for angle in (0.0, 0.5 * np.pi))
    result: FloatArray = sections.chord[:, None] * (
        along * sections.chord_direction + across * sections.normal
    )
    return result


def integrate(sections: DeformedSections, loads: SectionLoads) -> TotalLoads:
    """Integrate the loads over the deformed span, first section to last (theory: S1-10).

    The integrand is the cubic spline through the sections. No load is added beyond the first and
    the last section.

    Parameters
    ----------
    sections : DeformedSections
    loads : SectionLoads

    Returns
    -------
    TotalLoads
    """
    force = span_integral(sections, loads.force)
    moment = span_integral(sections, np.cross(sections.reference, loads.force) + loads.moment)
    return TotalLoads(
        force=force,
        moment=moment,
        lift=float(span_integral(sections, loads.lift_per_length)),
        thrust=-float(force @ AXIS),
        torque=-float(moment @ AXIS),
    )


def span_integral(sections: DeformedSections, values: FloatArray) -> FloatArray:
    """Integrate values (M, ...) of the sections over the deformed arc length."""
    s = sections.arc_length
    result: FloatArray = np.asarray(CubicSpline(s, values).integrate(s[0], s[-1]))
    return result
