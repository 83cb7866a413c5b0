# SPDX-License-Identifier: LGPL-2.1-or-later
r"""Blade-element momentum theory: each ring of the disc feels the blades that pass it.

Glauert's balance of momentum with Prandtl's losses at tip and hub, solved for one unknown per
section, the inflow angle phi (Ning 2014, doi:10.1002/we.1636), and written for sections that may be
bent and twisted. With the undisturbed axial and tangential speeds V and U of the ring, the speed
:math:`W` and the direction :math:`(\sin\varphi, \cos\varphi)` of the stream at the blades,

.. math::
    V = W \sin\varphi\,(1 - \kappa), \qquad
    U = W \cos\varphi\,(1 + \kappa'), \qquad
    \kappa = \frac{K \cos\varphi}{F \sin\varphi\,|\sin\varphi|},\quad
    \kappa' = \frac{K \sin\varphi}{F \cos\varphi\,|\sin\varphi|}

where :math:`K(\varphi) = Z c C_L / (8 \pi r)` (theory: S1-84). The lift of the panel method is that
of its circulation, a sine of the incidence; so the root always lies between the undisturbed stream
and the section's zero-lift direction, and bisection finds it.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from quietblade.errors import GeometryError, Notice
from quietblade.flow.inflow import Stream, radii
from quietblade.flow.loads import SectionLoads, circulation_response
from quietblade.flow.panel import PanelSections
from quietblade.flow.sections import AXIS, DeformedSections
from quietblade.typing import FloatArray

LARGEST_ADVANCE = 0.5
"""V over the tip's speed above which Prandtl's wake of flat sheets is too coarse a picture."""

LARGEST_CHORD = 0.2
"""Chord over tip radius above which the flow's curvature matters to the lift of camber."""

_LEAST_FACTOR = 1e-6  # at the very tip no momentum is left; this stands for 0
_NO_ANGLE = 1e-9
_STEPS = 56
_HEAVY = 2.0 / 3.0  # kappa of a braking ring beyond which Buhl's fit replaces the momentum balance


@dataclass(frozen=True, eq=False)
class Rings:
    """Rings of the disc that M sections sweep, and the sections' lift in any stream.

    Speeds and angles are counted so that the undisturbed ones are not negative, whatever the
    signs of speed and rotation.

    Attributes
    ----------
    axial, tangential : array (M,)
        Undisturbed speeds V and U [m/s].
    lift_axial, lift_tangential : array (M,)
        ``K(phi) = lift_axial sin(phi) + lift_tangential cos(phi)``.
    tip, hub : array (M,)
        Exponents of Prandtl's factors times ``|sin phi|``; infinite without the loss.
    """

    axial: FloatArray
    tangential: FloatArray
    lift_axial: FloatArray
    lift_tangential: FloatArray
    tip: FloatArray
    hub: FloatArray

    def loading(self, phi: FloatArray) -> FloatArray:
        """K at inflow angles."""
        result: FloatArray = self.lift_axial * np.sin(phi) + self.lift_tangential * np.cos(phi)
        return result

    def loss(self, phi: FloatArray) -> FloatArray:
        """Prandtl's factor F of tip and hub."""
        sine = np.maximum(np.abs(np.sin(phi)), _NO_ANGLE)
        product = prandtl_factor(self.tip / sine) * prandtl_factor(self.hub / sine)
        result: FloatArray = np.maximum(product, _LEAST_FACTOR)
        return result

    def balance(self, phi: FloatArray) -> tuple[FloatArray, FloatArray]:
        """V / W and U / W that momentum allows at inflow angles."""
        sine, cosine = np.sin(phi), np.cos(phi)
        per_flow = self.loading(phi) / (self.loss(phi) * np.maximum(np.abs(sine), _NO_ANGLE))
        kappa = per_flow * cosine / np.where(sine < 0.0, -1.0, 1.0)
        kappa /= np.maximum(np.abs(sine), _NO_ANGLE)
        axial = sine * (1.0 - kappa)
        heavy = (kappa < -_HEAVY) & (sine > 0.0)
        axial[heavy] = sine[heavy] / buhl(-kappa[heavy], self.loss(phi)[heavy])
        return axial, cosine + per_flow * sine

    def residual(self, phi: FloatArray) -> FloatArray:
        """Zero where momentum and blade agree on the direction of the stream [m/s]."""
        axial, tangential = self.balance(phi)
        result: FloatArray = self.tangential * axial - self.axial * tangential
        return result

    def solve(self) -> tuple[FloatArray, FloatArray]:
        """Inflow angle [rad] and speed [m/s] of the stream at the blades."""
        low, high = self._bracket()
        sign = np.sign(self.residual(high))
        sign[sign == 0.0] = -np.sign(self.residual(low))[sign == 0.0]
        for _ in range(_STEPS):
            middle = 0.5 * (low + high)
            above = self.residual(middle) * sign > 0.0
            low, high = np.where(above, low, middle), np.where(above, middle, high)
        phi = 0.5 * (low + high)
        speed = np.hypot(self.axial, self.tangential) / np.hypot(*self.balance(phi))
        return phi, speed

    def undisturbed(self) -> FloatArray:
        """Inflow angle without induction [rad]."""
        result: FloatArray = np.arctan2(self.axial, self.tangential)
        return result

    def _bracket(self) -> tuple[FloatArray, FloatArray]:
        """Angles between which the root lies, on one side of phi = 0 and of pi."""
        start = self.undisturbed()
        # K is A sin(zero - phi) with A > 0: the residual changes its sign between start and zero
        zero = np.arctan2(self.lift_tangential, -self.lift_axial)
        zero = start + np.mod(zero - start + np.pi, 2.0 * np.pi) - np.pi
        low, high = np.minimum(start, zero), np.maximum(start, zero)
        ahead = (np.maximum(low, _NO_ANGLE), np.minimum(high, np.pi - _NO_ANGLE))
        behind = (low, np.full_like(low, -_NO_ANGLE))
        # braking so hard that the stream at the disc reverses
        ends = [np.sign(self.residual(end)) for end in ahead]
        reversed_ = (low < 0.0) & ((ends[0] * ends[1] > 0.0) | (start <= _NO_ANGLE))
        return (
            np.where(reversed_, behind[0], ahead[0]),
            np.where(reversed_, behind[1], ahead[1]),
        )


@dataclass(frozen=True)
class MomentumInflow(Stream):
    """Induction of a propeller or turbine of several slender blades, ring by ring.

    Attributes
    ----------
    tip_loss, hub_loss : bool
        Whether Prandtl's factors for the finite number of blades are applied. The radii of tip and
        hub are those of the last and the first deformed section.
    """

    name: ClassVar[str] = "momentum"
    validity: ClassVar[str] = (
        "propellers of several slender blades (chord below a fifth of the tip radius) that advance "
        "less than half as fast as their tips turn"
    )

    tip_loss: bool = True
    hub_loss: bool = True

    def induced_velocity(self, sections: DeformedSections, panels: PanelSections) -> FloatArray:
        """Velocity of the disc at the sections (M, 3) [m/s].

        Raises
        ------
        GeometryError
            A section lies on the rotor axis, or the deformed span runs around the axis.
        """
        rings, axial, tangential = self.rings(sections, panels)
        phi, speed = rings.solve()
        result: FloatArray = (
            (speed * np.sin(phi) - rings.axial)[:, None] * axial
            + (speed * np.cos(phi) - rings.tangential)[:, None] * tangential
        )  # fmt: skip
        return result

    def rings(
        self, sections: DeformedSections, panels: PanelSections
    ) -> tuple[Rings, FloatArray, FloatArray]:
        """Rings of the sections, and the directions (M, 3) of their axial and tangential speed."""
        radius = radii(sections)
        _check(radius, self.blades)
        outward = sections.reference * [0.0, 1.0, 1.0] / radius[:, None]
        around = np.cross(AXIS, outward)
        velocity = self.velocity(sections.reference)
        forward = np.where(velocity @ AXIS < 0.0, -1.0, 1.0)[:, None] * AXIS
        against = np.where(np.sum(velocity * around, axis=1) > 0.0, 1.0, -1.0)[:, None] * around
        # force on the water per stream squared, along -lift: circulation times (span x stream)
        span = np.sum(sections.tangent * np.cross(forward, against), axis=1)
        slope = np.abs(np.sum(sections.tangent * outward, axis=1))
        _check_slope(slope)
        scale = (self.blades * span / (4.0 * np.pi * radius * slope))[:, None]
        response = scale * circulation_response(sections, panels)
        spacing = 0.5 * self.blades
        tip = spacing * np.maximum(radius[-1] - radius, 0.0) / radius
        hub = spacing * np.maximum(radius - radius[0], 0.0) / radius[0]
        rings = Rings(
            axial=np.sum(velocity * forward, axis=1),
            tangential=np.sum(velocity * against, axis=1),
            lift_axial=np.sum(response * forward, axis=1),
            lift_tangential=np.sum(response * against, axis=1),
            tip=tip if self.tip_loss else np.full_like(tip, np.inf),
            hub=hub if self.hub_loss else np.full_like(hub, np.inf),
        )
        return rings, forward, against

    def _model_notices(self, sections: DeformedSections, loads: SectionLoads) -> Iterator[Notice]:
        where, radius = f"inflow {self.name!r}", radii(sections)
        if self.blades < 2:
            yield Notice(
                where,
                "number of blades; rings around one blade say little of the flow at it",
                float(self.blades),
                2.0,
                "Use the inflow 'lifting-line' for a single blade or fin",
            )
        advance = abs(self.speed) / max(abs(self.rotation) * float(radius[-1]), 1e-12)
        if advance > LARGEST_ADVANCE:
            yield Notice(
                where,
                "speed of advance over the tip's speed; the wake is no stack of flat sheets",
                advance,
                LARGEST_ADVANCE,
                "Use the inflow 'lifting-line': the finite span matters, the disc does not",
            )
        width = sections.chord / radius[-1]
        if np.any(width > LARGEST_CHORD):
            k = int(np.argmax(width))
            yield Notice(
                f"{where}, section {k}",
                "chord over tip radius; the curved flow takes up to half of the camber's lift of "
                "wide blades, which no strip model knows",
                float(width[k]),
                LARGEST_CHORD,
                "Expect thrust and torque tens of per cent too high; use a lifting-surface code",
            )
        axial = loads.induced @ AXIS / np.where(self.speed == 0.0, np.inf, self.speed)
        if np.any(axial < -0.4):
            k = int(np.argmin(axial))
            yield Notice(
                f"{where}, section {k}",
                "the disc brakes the water by this part of its speed; an empirical fit (Buhl) or "
                "a reversed stream stands for the momentum balance",
                float(-axial[k]),
                0.4,
                "Do not trust windmilling and crash-stop loads",
            )


def prandtl_factor(exponent: FloatArray) -> FloatArray:
    r"""Prandtl's loss factor :math:`\frac2\pi \arccos e^{-f}` (theory: S1-85), f >= 0."""
    result: FloatArray = 2.0 / np.pi * np.arccos(np.exp(-exponent))
    return result


def buhl(kappa: FloatArray, factor: FloatArray) -> FloatArray:
    """Speed through a heavily braking ring over the undisturbed speed.

    Buhl's parabola between momentum theory and a plate (NREL/TP-500-36834, 2005), solved for the
    induction as by Ning (2014).

    Parameters
    ----------
    kappa : array
        Loading ``sigma C_n / (4 F sin^2 phi)`` of a turbine, above 2/3.
    factor : array
        Loss factor F.
    """
    x = 2.0 * factor * kappa
    first = x - (10.0 / 9.0 - factor)
    second = np.maximum(x - factor * (4.0 / 3.0 - factor), 0.0)
    third = x - (25.0 / 9.0 - 2.0 * factor)
    regular = np.abs(third) > 1e-9
    induction = np.where(
        regular,
        (first - np.sqrt(second)) / np.where(regular, third, 1.0),
        1.0 - 0.5 / np.sqrt(np.maximum(second, 1e-30)),
    )
    result: FloatArray = 1.0 - induction
    return result


def _check(radius: FloatArray, blades: int) -> None:
    if blades < 1:
        raise GeometryError(f"momentum: {blades} blades. Remedy: give at least 1")
    if not np.all(radius > 1e-6 * radius.max()):
        raise GeometryError(
            f"momentum: section {int(np.argmin(radius))} lies on the rotor axis, where no ring "
            "exists. Remedy: begin the blade at the hub's radius"
        )


def _check_slope(slope: FloatArray) -> None:
    if not np.all(slope > 0.1):
        k = int(np.argmin(slope))
        raise GeometryError(
            f"momentum: at section {k} the deformed span is {np.degrees(np.arccos(slope[k])):.0f} "
            "degrees off the radius, so that rings are crossed almost along. Remedy: lower the "
            "load, or use the inflow 'none'"
        )
