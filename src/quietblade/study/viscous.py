# SPDX-License-Identifier: LGPL-2.1-or-later
"""Viscous drag of a case's sections, by a friction line or a boundary layer, and singing."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from quietblade.case import Case
from quietblade.errors import Notice
from quietblade.flow import (
    PanelSections,
    ViscousLoads,
    friction_notices,
    section_drag,
    section_shedding,
    singing_notices,
    viscous_loads,
)
from quietblade.flow.inflow import BladeFlow
from quietblade.flow.polar import SectionLayer, SideLayer, boundary_layer
from quietblade.typing import FloatArray

LAYER = "boundary-layer"
"""Word of the case for drag from an integral boundary layer."""


@dataclass(frozen=True, eq=False)
class ViscousFlow:
    """What friction adds to the flow about the blade in one state.

    Attributes
    ----------
    flow : BladeFlow
        The inviscid flow.
    layer : SectionLayer or None
        Boundary layers on the sections, if the case asks for them.
    loads : ViscousLoads
        Drag of the sections.
    shedding : (M,) float array
        Shedding frequency of the trailing edge along the span [Hz].
    """

    flow: BladeFlow
    layer: SectionLayer | None
    loads: ViscousLoads
    shedding: FloatArray


def viscous_flow(case: Case, flow: BladeFlow) -> ViscousFlow:
    """Compute drag and vortex shedding of the sections in their effective stream."""
    sections, loads = flow.sections, flow.loads
    if case.flow.friction == LAYER:
        gamma = PanelSections(sections.contours).solve(loads.alpha).gamma
        layer = boundary_layer(sections.contours, gamma, loads.reynolds)
        ends = [
            side.layer.momentum_thickness[:, -1] * side.layer.shape[:, -1]
            for side in (layer.upper, layer.lower)
        ]
        thickness = sections.chord * np.sum(ends, axis=0)
        drag = viscous_loads(sections, loads, layer.drag_coefficient)
        shedding = section_shedding(sections, loads, displacement=thickness)
        return ViscousFlow(flow, layer, drag, shedding)
    line = case.flow.friction
    coefficient = 0.0 if line == "none" else section_drag(sections, loads, line)
    drag = viscous_loads(sections, loads, coefficient)
    return ViscousFlow(flow, None, drag, section_shedding(sections, loads))


def viscous_notices(case: Case, viscous: ViscousFlow) -> Iterator[Notice]:
    """Say where the drag is doubtful: laminar sections, or turbulent separation."""
    flow, layer = viscous.flow, viscous.layer
    if layer is not None:
        for name, side in (("upper", layer.upper), ("lower", layer.lower)):
            yield from _separation(flow, name, side)
    elif case.flow.friction != "none":
        yield from friction_notices(flow.sections, flow.loads)


def _separation(flow: BladeFlow, name: str, side: SideLayer) -> Iterator[Notice]:
    separated = np.flatnonzero(np.isfinite(side.separation))
    if len(separated) == 0:
        return
    worst = separated[np.argmin(side.separation[separated])]
    radius = float(np.linalg.norm(flow.sections.reference[worst, 1:]))
    yield Notice(
        f"flow, section {worst} at radius {radius:.4g} m",
        f"the turbulent boundary layer separates on the {name} side of {len(separated)} of "
        f"{len(side.separation)} sections; chord fraction of the foremost",
        float(side.separation[worst]),
        1.0,
        "Lift and drag are not to be trusted there; lower the incidence",
    )


def singing(viscous: ViscousFlow, frequencies: FloatArray, names: Sequence[str]) -> list[Notice]:
    """Say which wet modes the trailing edge may excite."""
    return singing_notices(viscous.flow.sections, viscous.shedding, frequencies, list(names))
