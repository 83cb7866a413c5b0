# SPDX-License-Identifier: LGPL-2.1-or-later
"""How the blade is held, and what loads it besides the flow."""

from typing import Annotated, Literal, TypeAlias

from pydantic import Field, model_validator

from quietblade.case.fields import (
    AccelerationVector,
    AngularStiffnessVector,
    ForceVector,
    LengthOrZero,
    LineForceVector,
    SignedPressure,
    SpanChord,
    StiffnessVector,
    Text,
    Words,
    one_of,
    wrong,
)

Support = Literal["clamped", "elastic"]
Face = Literal["upper", "lower"]


class RootWords(Words):
    """Root of the blade: clamped, or a rigid flange on springs that stand for its mounting."""

    support: Annotated[Support, one_of(Support, "a support")] = Field(
        "clamped", title="Support", description="Clamped, or held by springs (elastic)"
    )
    translation: StiffnessVector | None = Field(
        None,
        title="Translation",
        description="Stiffness against displacement along x, y and z; rigid if not given",
    )
    rotation: AngularStiffnessVector | None = Field(
        None,
        title="Rotation",
        description="Stiffness against rotation about x, y and z through the centre of the root "
        "face; rigid if not given",
    )

    @model_validator(mode="after")
    def _check_springs(self) -> "RootWords":
        given = [key for key in ("translation", "rotation") if getattr(self, key) is not None]
        if given and self.support == "clamped":
            raise wrong("is given for a clamped root", 'Write support = "elastic"', at=(given[0],))
        if not given and self.support == "elastic":
            raise wrong(
                "an elastic root needs a stiffness",
                'Add rotation = ["1 MN*m/rad", "1 MN*m/rad", "1 MN*m/rad"], or translation',
            )
        return self


class PressureLoadWords(Words):
    """Steady pressure on the surface, besides the flow's; it follows the deformed surface."""

    kind: Literal["pressure"] = Field(title="Kind", description="Pressure on the surface")
    value: SignedPressure | None = Field(
        None, title="Value", description="Uniform pressure, positive towards the blade"
    )
    table: Text | None = Field(
        None,
        title="Table",
        description="File beside the case file: a row a place, columns span, chord, upper, lower "
        "(fractions and Pa) on a full grid from 0 to 1, separated by commas, with a header",
    )

    @model_validator(mode="after")
    def _check_one(self) -> "PressureLoadWords":
        if (self.value is None) == (self.table is None):
            raise wrong(
                "needs either a value or a table", 'Write value = "10 kPa" or table = "p.csv"'
            )
        return self


class PointForceWords(Words):
    """Steady force of fixed direction at a point of the surface."""

    kind: Literal["point-force"] = Field(title="Kind", description="Force at a point")
    at: SpanChord = Field(title="At", description="Span fraction and chord fraction")
    face: Annotated[Face, one_of(Face, "a face of the blade")] = Field(
        "upper", title="Face", description="Face of the blade"
    )
    force: ForceVector = Field(title="Force", description="Components along x, y and z")


class LineForceWords(Words):
    """Steady force of fixed direction along a straight line of the planform."""

    kind: Literal["line-force"] = Field(title="Kind", description="Force along a line")
    start: SpanChord = Field(title="Start", description="Span fraction and chord fraction")
    end: SpanChord = Field(title="End", description="Span fraction and chord fraction")
    face: Annotated[Face, one_of(Face, "a face of the blade")] = Field(
        "upper", title="Face", description="Face of the blade"
    )
    force: LineForceVector = Field(
        title="Force", description="Force per length, components along x, y and z"
    )

    @model_validator(mode="after")
    def _check_line(self) -> "LineForceWords":
        if self.start == self.end:
            raise wrong("the line has no length", "Choose another end", at=("end",))
        return self


class GravityWords(Words):
    """Weight of the blade, in the blade's axes; buoyancy is what hydrostatic pressure makes."""

    kind: Literal["gravity"] = Field(title="Kind", description="Weight")
    acceleration: AccelerationVector = Field(
        title="Acceleration", description="Components along x, y and z"
    )


class HydrostaticWords(Words):
    """Pressure of the water at rest, as its mean over a turn of the rotor: uniform."""

    kind: Literal["hydrostatic"] = Field(title="Kind", description="Hydrostatic pressure")
    depth: LengthOrZero = Field(title="Depth", description="Depth of the rotor axis")


SteadyLoadWords: TypeAlias = (
    PressureLoadWords | PointForceWords | LineForceWords | GravityWords | HydrostaticWords
)
LoadWords = Annotated[SteadyLoadWords, Field(discriminator="kind")]

LOADS: dict[str, type[SteadyLoadWords]] = {
    "pressure": PressureLoadWords,
    "point-force": PointForceWords,
    "line-force": LineForceWords,
    "gravity": GravityWords,
    "hydrostatic": HydrostaticWords,
}
"""Model of each kind of load."""
