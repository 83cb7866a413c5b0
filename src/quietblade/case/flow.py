# SPDX-License-Identifier: LGPL-2.1-or-later
"""The table of the steady flow: operation, inflow model and wake."""

from itertools import pairwise
from typing import Annotated, Literal

from pydantic import AfterValidator, Field, model_validator

from quietblade.case.fields import (
    AngularSpeed,
    Count,
    Length,
    LengthOrZero,
    Number,
    Pressure,
    Speed,
    Words,
    between,
    entries_from,
    one_of,
    wrong,
)

Inflow = Literal["none", "lifting-line", "momentum"]
Root = Literal["mirrored", "free"]
Control = Literal["prandtl", "weissinger"]
Friction = Literal["ittc-1957", "prandtl-schlichting", "boundary-layer", "none"]


def _odd(count: int) -> int:
    if count % 2 == 0:
        raise wrong("is even", f"Choose an odd number such as {count + 1}: one node is the nose")
    return count


class WakeWords(Words):
    """Circumferential mean of the inflow along the radius, over the speed."""

    radius: Annotated[tuple[Length, ...], entries_from(2)] = Field(
        title="Radius", description="Radii, increasing"
    )
    axial: Annotated[tuple[Number, ...], entries_from(2)] = Field(
        title="Axial", description="Axial velocity over the speed at each radius, 1 - w"
    )
    tangential: Annotated[tuple[Number, ...], entries_from(2)] | None = Field(
        None,
        title="Tangential",
        description="Tangential velocity over the speed, positive in the sense of the rotation",
    )

    @model_validator(mode="after")
    def _check_table(self) -> "WakeWords":
        if any(a >= b for a, b in pairwise(self.radius)):
            raise wrong("the radii do not increase", "Sort the table by the radius", at=("radius",))
        for key in ("axial", "tangential"):
            values = getattr(self, key)
            if values is not None and len(values) != len(self.radius):
                raise wrong(
                    f"has {len(values)} values for {len(self.radius)} radii",
                    "Give as many values as radii",
                    at=(key,),
                )
        return self


class FlowWords(Words):
    """Steady operation, and the sections on which the flow is computed."""

    speed: Speed = Field(
        title="Speed", description="Speed of the water along the rotor axis, downstream"
    )
    rotation: AngularSpeed = Field(
        title="Rotation", description="Angular speed of the blade about the rotor axis"
    )
    inflow: Annotated[Inflow, one_of(Inflow, "an inflow model")] = Field(
        "none",
        title="Inflow",
        description="Induced velocities: none (blade elements), of a single blade or hydrofoil "
        "(lifting-line), or of a propeller (momentum)",
    )
    blades: Annotated[Count, between(1, 20)] = Field(
        1, title="Blades", description="Number of blades of the rotor"
    )
    root: Annotated[Root, one_of(Root, "a root of the lifting line")] = Field(
        "mirrored",
        title="Root",
        description="Root of the lifting line: at a wall or hub (mirrored), or free",
    )
    control: Annotated[Control, one_of(Control, "a control point")] = Field(
        "prandtl",
        title="Control",
        description="Control points of the lifting line: on the vortex (prandtl), or half a chord "
        "behind it, for swept or broad blades (weissinger)",
    )
    wake: WakeWords | None = Field(
        None, title="Wake", description="Mean inflow along the radius, such as a ship's wake"
    )
    friction: Annotated[Friction, one_of(Friction, "a friction line")] = Field(
        "ittc-1957",
        title="Friction",
        description="Viscous drag for thrust, torque and efficiency, by a friction line with form "
        "factor or an integral boundary layer; it does not load the blade",
    )
    depth: LengthOrZero = Field(
        0.0, title="Depth", description="Depth of the rotor axis, for the cavitation check"
    )
    atmospheric_pressure: Pressure = Field(
        101.325e3, title="Atmospheric pressure", description="For the cavitation check"
    )
    sections: Annotated[Count, between(5, 2001)] = Field(
        101, title="Sections", description="Number of sections along the span"
    )
    section_nodes: Annotated[Count, between(41, 1001), AfterValidator(_odd)] = Field(
        161, title="Section nodes", description="Nodes on the contour of a section, odd"
    )
