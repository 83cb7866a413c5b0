# SPDX-License-Identifier: LGPL-2.1-or-later
"""Viscous drag of a case's sections, by a friction line or a boundary layer, and singing."""

from collections.abc import Iterator, Sequence

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


def section_layer(case: Case, flow: BladeFlow) -> SectionLayer | None:
    """Boundary layers on the sections in their effective stream, if the case asks for them."""
    if case.flow.friction != LAYER:
        return None
    sections, loads = flow.sections, flow.loads
    gamma = PanelSections(sections.contours).solve(loads.alpha).gamma
    return boundary_layer(sections.contours, gamma, loads.reynolds)


def viscous(case: Case, flow: BladeFlow, layer: SectionLayer | None) -> ViscousLoads:
    """Drag of the sections as the case asks for it."""
    sections, loads = flow.sections, flow.loads
    if layer is not None:
        return viscous_loads(sections, loads, layer.drag_coefficient)
    if case.flow.friction == "none":
        return viscous_loads(sections, loads, 0.0)
    return viscous_loads(sections, loads, section_drag(sections, loads, case.flow.friction))


def shedding(flow: BladeFlow, layer: SectionLayer | None) -> FloatArray:
    """Shedding frequency of the trailing edge along the span (M,) [Hz]."""
    displacement = None
    if layer is not None:
        ends = [
            side.layer.momentum_thickness[:, -1] * side.layer.shape[:, -1]
            for side in (layer.upper, layer.lower)
        ]
        displacement = flow.sections.chord * np.sum(ends, axis=0)
    return section_shedding(flow.sections, flow.loads, displacement=displacement)


def viscous_notices(case: Case, flow: BladeFlow, layer: SectionLayer | None) -> Iterator[Notice]:
    """Say where the drag is doubtful: laminar sections, or turbulent separation."""
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


def singing(
    case: Case, flow: BladeFlow, frequencies: FloatArray, names: Sequence[str]
) -> list[Notice]:
    """Say which wet modes the trailing edge may excite."""
    layer = section_layer(case, flow)
    return singing_notices(flow.sections, shedding(flow, layer), frequencies, list(names))
