# SPDX-License-Identifier: LGPL-2.1-or-later
r"""Lifting line on the deformed blade: bound vortex, straight wake, sections by the panel method.

The bound vortex follows the quarter chords of the deformed sections. From it a wake of straight
vortices runs along the local undisturbed relative velocity. At every control point the
circulation of the section in its *effective* stream is that of the bound vortex,
:math:`\Gamma_i = b_i \cdot (W_i + \sum_j A_{ij} \Gamma_j)` (theory: S1-82). The circulation of the
panel method is linear in the stream, thickness and camber included, so that this nonlinear looking
condition is one linear system.

Two choices of the control point. Prandtl's, on the vortex itself, is exact for the large aspect
ratio of a straight blade. Weissinger's, half a chord behind it, counts the bound vortex too, less
the plane vortex that the section contains already; it serves swept blades and small aspect ratios.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar, Literal, get_args

import numpy as np
from scipy.interpolate import CubicSpline

from quietblade.errors import GeometryError, Notice
from quietblade.flow.inflow import Stream, aspect_ratio, radii
from quietblade.flow.loads import SectionLoads, circulation_response
from quietblade.flow.panel import PanelSections
from quietblade.flow.sections import DeformedSections
from quietblade.flow.vortices import ray_velocity, segment_velocity
from quietblade.typing import FloatArray

Root = Literal["free", "mirrored"]
Control = Literal["prandtl", "weissinger"]

LOWEST_ASPECT_RATIO = {"prandtl": 4.0, "weissinger": 2.0}
LARGEST_SWEEP = np.radians(15.0)
LARGEST_WAKE_TURN = 0.5
"""Angle [rad] by which the wake turns about the axis while it travels one span."""

_PAD = 3
_RADIAL = 0.7
"""Least cosine between a radius of the root and its span."""


@dataclass(frozen=True, eq=False)
class VortexLine:
    """Bound vortex in N elements with its wake.

    Attributes
    ----------
    vertices : array (N + 1, 3)
        Ends of the elements, from root to tip [m].
    centres : array (N, 3)
        Points of the elements where circulation and section meet [m].
    offset : array (N, 3)
        From the centres to the control points [m]; 0 for Prandtl's line.
    wake : array (N + 1, 3)
        Unit vectors along the trailing vortices.
    mirror : tuple of array (3,) and array (3,), or None
        Point and unit normal of a plane that reflects the vortices.
    """

    vertices: FloatArray
    centres: FloatArray
    offset: FloatArray
    wake: FloatArray
    mirror: tuple[FloatArray, FloatArray] | None = None

    def influence(self) -> FloatArray:
        """Velocity at the control points of element i from unit circulation of j (N, N, 3) [1/m].

        Positive circulation makes lift towards ``tangent x chord direction`` (theory: S1-83).
        """
        control = self.centres + self.offset
        result = self._horseshoes(control)
        behind = np.any(self.offset != 0.0)
        diagonal = np.arange(len(control))
        if behind:  # the section already contains the endless straight vortex through its centre
            result[diagonal, diagonal] -= self._plane_vortices()
        if self.mirror is not None:
            point, normal = self.mirror
            reflection = np.eye(3) - 2.0 * np.outer(normal, normal)
            result += self._horseshoes(point + (control - point) @ reflection) @ reflection
        return result

    def _horseshoes(self, points: FloatArray) -> FloatArray:
        inner, outer = self.vertices[:-1], self.vertices[1:]
        bound = segment_velocity(points[:, None], outer, inner)
        trailing = ray_velocity(points[:, None], self.vertices, self.wake)
        result: FloatArray = bound + trailing[:, :-1] - trailing[:, 1:]
        return result

    def _plane_vortices(self) -> FloatArray:
        along = self.vertices[:-1] - self.vertices[1:]
        along = along / np.linalg.norm(along, axis=-1, keepdims=True)
        arm = self.offset - np.sum(self.offset * along, axis=-1, keepdims=True) * along
        square = np.sum(arm * arm, axis=-1, keepdims=True)
        result: FloatArray = np.cross(along, arm) / (2.0 * np.pi * square)
        return result


def line_parameter(elements: int, root: Root) -> tuple[FloatArray, FloatArray]:
    """Span fractions of vertices (N + 1,) and centres (N,), close together at free ends.

    They are equal steps of an angle in which the flow is even at both ends, see `to_angle`.
    """
    angle = np.arange(2 * elements + 1) / (2 * elements)
    fraction = np.sin(0.5 * np.pi * angle) if root == "mirrored" else _haversine(angle)
    return fraction[::2], fraction[1::2]


def to_angle(fraction: FloatArray, root: Root) -> FloatArray:
    """Angle of span fractions, from 0 at the root to 1 at the tip."""
    fraction = np.clip(fraction, 0.0, 1.0)
    angle = np.arcsin(fraction) if root == "mirrored" else np.arccos(1.0 - 2.0 * fraction) / 2.0
    result: FloatArray = 2.0 * angle / np.pi
    return result


def solve_circulation(
    influence: FloatArray, response: FloatArray, stream: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Solve the lifting-line equation (theory: S1-82).

    Parameters
    ----------
    influence : array (N, N, 3)
        Of `VortexLine.influence` [1/m].
    response : array (N, 3)
        Vectors b of the sections: the circulation in a stream W is ``b . W`` [m]. For a flat plate
        of chord c with the normal n this is ``pi c n``.
    stream : array (N,)
        Circulation ``b . W`` in the undisturbed water [m2/s].

    Returns
    -------
    circulation : array (N,)
        [m2/s]
    induced : array (N, 3)
        Velocity at the control points [m/s].
    """
    matrix = np.eye(len(stream)) - np.einsum("id,ijd->ij", response, influence)
    circulation = np.linalg.solve(matrix, stream)
    return circulation, np.einsum("ijd,j->id", influence, circulation)


@dataclass(frozen=True)
class LiftingLineInflow(Stream):
    """Downwash of the blade's own wake: the finite-span correction of fins and slow rotors.

    Other blades are not felt, and the wake is straight: the blade must advance much farther than
    it turns.

    Attributes
    ----------
    root : {"mirrored", "free"}
        Whether the hub reflects the vortices like an endless wall normal to the span at the root,
        or the root is a second tip.
    control : {"prandtl", "weissinger"}
        Place of the control points; see the module. With Weissinger's the loads act perpendicular
        to the stream half a chord behind the bound vortex, which overestimates the induced drag
        (by 30 % at aspect ratio 6).
    elements : int
        Elements of the bound vortex.
    """

    name: ClassVar[str] = "lifting-line"
    validity: ClassVar[str] = (
        "one slender blade (aspect ratio above 4) whose wake leaves nearly straight: hydrofoils, "
        "fins, and blades that advance many spans a turn"
    )

    root: Root = "mirrored"
    control: Control = "prandtl"
    elements: int = 60

    def __post_init__(self) -> None:
        for word, known in ((self.root, get_args(Root)), (self.control, get_args(Control))):
            if word not in known:
                raise GeometryError(
                    f"lifting line: {word!r} is unknown. Remedy: use one of {known}"
                )
        if self.elements < 4:
            raise GeometryError(
                f"lifting line of {self.elements} elements. Remedy: use at least 4, better 60"
            )

    def induced_velocity(self, sections: DeformedSections, panels: PanelSections) -> FloatArray:
        """Velocity of the wake at the sections (M, 3) [m/s].

        Raises
        ------
        GeometryError
            The water is at rest relative to a part of the blade, so that no wake direction exists.
        """
        response = circulation_response(sections, panels)
        velocity = self.velocity(sections.reference)
        vertices, centres = line_parameter(self.elements, self.root)
        spline = CubicSpline(
            sections.arc_length / sections.arc_length[-1],
            np.concatenate([_quarter_chord(sections), velocity, response, _chord(sections)], 1),
        )
        _, stream, b, chord = np.split(spline(centres), 4, axis=1)
        ends, flow = spline(vertices)[:, :3], spline(vertices)[:, 3:6]
        offset = np.zeros_like(stream)
        if self.control == "weissinger":
            # along the stream: beside the wake sheet the control point would not feel its edges
            offset = 0.5 * np.linalg.norm(chord, axis=1, keepdims=True) * _directions(stream)
        else:
            ends = _unswept(ends, flow)
        line = VortexLine(
            vertices=ends,
            centres=_on_elements(ends, vertices, centres),
            offset=offset,
            wake=_directions(flow),
            mirror=(ends[0], _wall_normal(sections)) if self.root == "mirrored" else None,
        )
        induced = solve_circulation(line.influence(), b, np.sum(b * stream, axis=1))[1]
        return self._at_sections(sections, induced)

    def _at_sections(self, sections: DeformedSections, induced: FloatArray) -> FloatArray:
        """Carry velocities from the control points to the sections; even at both ends."""
        places = (np.arange(-_PAD, self.elements + _PAD) + 0.5) / self.elements
        spline = CubicSpline(places, np.pad(induced, ((_PAD, _PAD), (0, 0)), mode="symmetric"))
        fraction = sections.arc_length / sections.arc_length[-1]
        result: FloatArray = spline(to_angle(fraction, self.root))
        return result

    def _model_notices(self, sections: DeformedSections, loads: SectionLoads) -> Iterator[Notice]:
        where = f"inflow {self.name!r}"
        ratio = aspect_ratio(sections) * (2.0 if self.root == "mirrored" else 1.0)
        if ratio < LOWEST_ASPECT_RATIO[self.control]:
            yield Notice(
                where,
                "a lifting line overestimates the lift of so small an aspect ratio",
                ratio,
                LOWEST_ASPECT_RATIO[self.control],
                "Use control = 'weissinger', or a lifting-surface code",
            )
        sweep = _largest_sweep(sections, loads.velocity - loads.induced)
        if self.control == "prandtl" and sweep > LARGEST_SWEEP:
            yield Notice(
                where,
                "sweep angle [rad] of the quarter chords; Prandtl's line is for straight blades",
                sweep,
                float(LARGEST_SWEEP),
                "Use control = 'weissinger'",
            )
        turn = abs(self.rotation) * float(sections.arc_length[-1]) / max(abs(self.speed), 1e-12)
        if turn > LARGEST_WAKE_TURN:
            yield Notice(
                where,
                "angle [rad] by which the wake turns within one span, but is taken as straight",
                turn,
                LARGEST_WAKE_TURN,
                "Use the inflow 'momentum'",
            )
        if self.blades > 1:
            spacing = 2.0 * np.pi * float(np.mean(radii(sections))) / self.blades
            span = float(sections.arc_length[-1])
            if spacing < span:
                yield Notice(
                    where,
                    f"distance [m] between the {self.blades} blades below the span; neighbours "
                    "are not felt",
                    spacing,
                    span,
                    "Use the inflow 'momentum': without the neighbours' induction the thrust of a "
                    "propeller may come out nearly twice as large",
                )


def _haversine(angle: FloatArray) -> FloatArray:
    result: FloatArray = 0.5 * (1.0 - np.cos(np.pi * angle))
    return result


def _chord(sections: DeformedSections) -> FloatArray:
    result: FloatArray = sections.chord[:, None] * sections.chord_direction
    return result


def _quarter_chord(sections: DeformedSections) -> FloatArray:
    result: FloatArray = sections.reference - 0.25 * _chord(sections)
    return result


def _unswept(points: FloatArray, flow: FloatArray) -> FloatArray:
    """Points moved along the mean stream until none is ahead of another.

    Prandtl's theory knows no sweep, and the velocity that a swept or kinked vortex induces on
    itself grows without bound when its elements become short. Bending across the stream stays.
    """
    mean = _directions(np.mean(flow, axis=0))
    ahead = (points - np.mean(points, axis=0)) @ mean
    result: FloatArray = points - ahead[:, None] * mean
    return result


def _on_elements(ends: FloatArray, vertices: FloatArray, centres: FloatArray) -> FloatArray:
    """Centres on the straight elements: beside a curved line's chord they would feel it."""
    share = ((centres - vertices[:-1]) / np.diff(vertices))[:, None]
    result: FloatArray = (1.0 - share) * ends[:-1] + share * ends[1:]
    return result


def _directions(flow: FloatArray) -> FloatArray:
    speed = np.linalg.norm(flow, axis=-1, keepdims=True)
    if not np.all(speed > 0.0):
        raise GeometryError(
            "lifting line: the water is at rest relative to the blade, so that its wake has no "
            "direction. Remedy: give a speed or a rotation, or use the inflow 'none'"
        )
    result: FloatArray = flow / speed
    return result


def _wall_normal(sections: DeformedSections) -> FloatArray:
    """Return the unit vector along the root's radius, or along the span of a root on the axis.

    Such a root has no radius; the height of its camber or its sweep must not be taken for one.
    """
    across = np.array([0.0, 1.0, 1.0])
    radial, span = sections.reference[0] * across, sections.tangent[0] * across
    length = float(np.linalg.norm(radial))
    beside = abs(float(radial @ span)) <= _RADIAL * length * float(np.linalg.norm(span))
    result: FloatArray = span / np.linalg.norm(span) if beside else radial / length
    return result


def _largest_sweep(sections: DeformedSections, stream: FloatArray) -> float:
    line = np.diff(_quarter_chord(sections), axis=0)
    flow = 0.5 * (stream[1:] + stream[:-1])
    speed = np.linalg.norm(flow, axis=-1)
    cosine = np.sum(line * flow, axis=-1) / np.maximum(np.linalg.norm(line, axis=-1) * speed, 1e-30)
    return float(np.max(np.arcsin(np.clip(np.abs(cosine), 0.0, 1.0))))
