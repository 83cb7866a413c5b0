# SPDX-License-Identifier: LGPL-2.1-or-later
"""Damping by the stream around the blade of a case (theory: S2-72)."""

import numpy as np
from scipy.interpolate import make_interp_spline

from quietblade.case import Case, Finding
from quietblade.errors import Notice
from quietblade.flow.inflow import BladeFlow
from quietblade.mesh import Mesh
from quietblade.mesh.surface import SurfaceQuadrature
from quietblade.study.frames import SectionFrames
from quietblade.typing import FloatArray
from quietblade.vibroacoustics.flow_damping import (
    Strips,
    add_stream,
    stream_notices,
    strip_motion,
)
from quietblade.vibroacoustics.operators import Operators

_FEWEST = 5


def strips_of(flow: BladeFlow, count: int) -> Strips:
    """Sections at even steps of the span, with the stream that each meets."""
    sections, loads = flow.sections, flow.loads
    columns = (
        sections.arc_length[:, None], sections.reference, sections.chord_direction,
        sections.normal, sections.chord[:, None], loads.speed[:, None],
    )  # fmt: skip
    known = np.linspace(0.0, 1.0, len(sections.chord))
    span = np.linspace(0.0, 1.0, count)
    length, middle, chordwise, normal, chord, speed = (
        np.asarray(make_interp_spline(known, column, k=1)(span)) for column in columns
    )
    return Strips(
        span=span,
        length=length[:, 0],
        middle=middle,
        chordwise=_unit(chordwise),
        normal=_unit(normal),
        chord=chord[:, 0],
        speed=speed[:, 0],
    )


def with_stream(
    case: Case,
    mesh: Mesh,
    operators: Operators,
    flow: BladeFlow,
    positions: FloatArray,
    frames: SectionFrames,
) -> tuple[Operators, tuple[Notice, ...]]:
    """Let the stream of a configuration damp it.

    The strips are as wide as the elements, so that each holds some rows of nodes.

    Parameters
    ----------
    flow : BladeFlow
        Sections of the configuration and the stream that they meet.
    positions : (nodes, 3) array
        Nodes of the mesh in the configuration [m].
    frames : SectionFrames

    Raises
    ------
    InvalidCaseError
        The mesh is too coarse for strips.
    """
    count = max(_FEWEST, 1 + round(float(flow.sections.arc_length[-1]) / case.mesh.size))
    strips = strips_of(flow, count)
    wetted = SurfaceQuadrature(positions, mesh.interface)
    span = np.zeros(len(positions))
    span[frames.nodes] = np.clip(frames.span, 0.0, 1.0)
    try:
        motion = strip_motion(strips, positions, span, wetted.nodal_areas())
    except ValueError as error:
        finding = Finding(("acoustics", "flow_damping"), str(error), "Use a smaller mesh.size")
        raise case.invalid(finding) from error
    damped = add_stream(operators, mesh.basis, strips, motion, case.water.density)
    return damped, stream_notices(strips, np.array(case.acoustics.band))


def _unit(vectors: FloatArray) -> FloatArray:
    return np.asarray(vectors / np.linalg.norm(vectors, axis=1, keepdims=True))
