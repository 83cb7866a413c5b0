# SPDX-License-Identifier: LGPL-2.1-or-later
"""The table of the Campbell diagram: speeds of the shaft and multiples of the blade rate."""

from itertools import pairwise
from typing import Annotated, Literal

from pydantic import AfterValidator, Field

from quietblade.case.fields import (
    AngularSpeed,
    Count,
    Words,
    between,
    entries_from,
    one_of,
    wrong,
)

Advance = Literal["scaled", "fixed"]


def _ascending(speeds: tuple[float, ...]) -> tuple[float, ...]:
    if speeds[0] < 0.0 or any(a >= b for a, b in pairwise(speeds)):
        raise wrong(
            "the speeds do not increase from zero or above",
            'Write for example ["0.4 rad/s", "0.6 rad/s", "0.8 rad/s"]; the sense is that of '
            "flow.rotation",
        )
    return speeds


def _distinct(orders: tuple[int, ...]) -> tuple[int, ...]:
    if len(set(orders)) < len(orders):
        raise wrong("names an order twice", "Write each order once")
    return tuple(sorted(orders))


class CampbellWords(Words):
    """Wet modes over the speed of the shaft, each in the equilibrium of that speed."""

    speeds: Annotated[tuple[AngularSpeed, ...], AfterValidator(_ascending), entries_from(2)] = (
        Field(
            title="Speeds",
            description="Speeds of the shaft, increasing; each costs an equilibrium and its modes",
        )
    )
    orders: Annotated[
        tuple[Annotated[Count, between(1, 1000)], ...], AfterValidator(_distinct), entries_from(1)
    ] = Field((1, 2, 3), title="Orders", description="Multiples of the blade rate to draw")
    advance: Annotated[Advance, one_of(Advance, "a speed of advance")] = Field(
        "scaled",
        title="Advance",
        description="Speed of the water at each speed of the shaft: in proportion to it from "
        "`flow.speed` at `flow.rotation`, so that the advance ratio stays (scaled), or always "
        "`flow.speed` (fixed)",
    )
