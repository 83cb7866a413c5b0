# SPDX-License-Identifier: LGPL-2.1-or-later
"""What sets the blade in motion, and the transfer functions that a case asks for."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar, Literal, TypeAlias, TypeVar

from pydantic import (
    AfterValidator,
    BeforeValidator,
    Field,
    GetCoreSchemaHandler,
    GetJsonSchemaHandler,
    ValidationInfo,
    model_validator,
)
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema, core_schema

from quietblade.case import units
from quietblade.case.fields import (
    Angle,
    AngularDampingVector,
    AngularStiffnessVector,
    DampingVector,
    Extent,
    InertiaVector,
    MassVector,
    Number,
    Pressure,
    Quantity,
    SpanChord,
    StiffnessVector,
    Text,
    Words,
    entries,
    entries_from,
    is_si,
    one_of,
    wrong,
)
from quietblade.case.structure import Face

Side = Literal["upper", "lower"]
Axis = Literal["x", "y", "z"]
Motion = Literal["displacement", "velocity", "acceleration", "rotation"]
Signal = Literal["harmonic", "random"]
Correlation = Literal["none", "full"]
AnyWords = TypeVar("AnyWords", bound="ExcitationWords")
Function = Literal["mobility", "power-per-force", "blocked-force", "shaft"]

MOTIONS: Mapping[str, tuple[units.Kind, units.Kind]] = {
    "displacement": (units.LENGTH, units.LENGTH_DENSITY),
    "velocity": (units.SPEED, units.SPEED_DENSITY),
    "acceleration": (units.ACCELERATION, units.ACCELERATION_DENSITY),
    "rotation": (units.ANGLE, units.ANGLE_DENSITY),
}
"""Amplitude and density of each motion of the root."""


@dataclass(frozen=True)
class OfMotion:
    """Annotation of a value whose unit the key ``motion`` before it decides.

    Attributes
    ----------
    place : int
        0 for the amplitude, 1 for the density.
    """

    place: int

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        def validate(value: Any, info: ValidationInfo) -> float:
            motion = info.data.get("motion") if info.data else None
            if motion is None:
                return 0.0  # the motion is wrong, and that is the one thing to say
            quantity = Quantity(MOTIONS[motion][self.place], above=0.0)
            return quantity.read(value, si=is_si(info))

        return core_schema.with_info_plain_validator_function(validate)

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        kinds = [kinds[self.place] for kinds in MOTIONS.values()]
        unit = ", ".join(kind.unit for kind in kinds)
        return {"type": "string", "unit": unit, "examples": [kind.example for kind in kinds]}


def _pointing(vector: tuple[float, float, float]) -> tuple[float, float, float]:
    if not any(vector):
        raise wrong("points nowhere", "Write for example [0, -1, 0]")
    return vector


Direction = Annotated[tuple[Number, Number, Number], AfterValidator(_pointing), entries(3)]
"""Components along x, y and z; its length does not matter."""

_DENSITY = "One-sided power spectral density of a random load"
_TABLE = (
    "File beside the case file, columns frequency [Hz], amplitude [SI unit of the amplitude] and, "
    "if need be, phase [deg], or frequency and density, separated by commas, with a header; "
    "straight in between, over the whole band"
)


class ExcitationWords(Words):
    """What all excitations have: a name, and one of an amplitude, a density and a table."""

    amplitude_key: ClassVar[str] = ""
    example: ClassVar[units.Kind] = units.PRESSURE
    density_example: ClassVar[units.Kind] = units.PRESSURE_DENSITY

    kind: str = Field(title="Kind", description="What sets it in motion")
    name: Text = Field("", title="Name", description="Name in results; the kind if not given")
    phase: Angle = Field(0.0, title="Phase", description="Phase against the other loads")
    table: Text | None = Field(None, title="Table", description=_TABLE)

    @property
    def amplitude_value(self) -> float | None:
        """Constant amplitude in SI units, if that is what the case gives."""
        value: float | None = getattr(self, self.amplitude_key)
        return value

    @property
    def density_value(self) -> float | None:
        """Constant density in SI units, if that is what the case gives."""
        value: float | None = getattr(self, "density", None)
        return value

    @property
    def unit(self) -> str:
        """SI unit of the amplitude."""
        return self.example.unit

    @property
    def density_unit(self) -> str:
        """SI unit of the density."""
        return self.density_example.unit

    @model_validator(mode="after")
    def _check_one(self) -> "ExcitationWords":
        keys = (self.amplitude_key, "density", "table")
        given = [key for key in keys if getattr(self, key) is not None]
        if len(given) > 1:
            raise wrong(
                f"is given beside {given[0]}", f"Keep one of {', '.join(keys)}", at=(given[1],)
            )
        if self.table is not None and not self.table.strip():
            raise wrong("names no file", 'Write table = "spectrum.csv"', at=("table",))
        if not given and self.amplitude_key != "pressure":
            example = f'{self.amplitude_key} = "{self.example.example}"'
            raise wrong("has no amplitude", f'Add {example}, or table = "spectrum.csv"')
        if self.phase and self.table is not None:
            raise wrong("is given beside a table", "Add it to the table's phase", at=("phase",))
        return self


class PressureWords(ExcitationWords):
    """Pressure on a part of the surface."""

    amplitude_key: ClassVar[str] = "pressure"

    kind: Literal["pressure"] = Field("pressure", title="Kind", description="Pressure on a patch")
    pressure: Pressure | None = Field(
        None,
        title="Pressure",
        description="Peak amplitude; 1 Pa if neither this nor a density or table is given",
    )
    density: Annotated[float, Quantity(units.PRESSURE_DENSITY, above=0.0)] | None = Field(
        None, title="Density", description=_DENSITY
    )


class PatchWords(PressureWords):
    """Pressure on a patch of the blade's surface, pushing into the blade."""

    side: Annotated[Side, one_of(Side, "a side of the blade")] = Field(
        "upper", title="Side", description="Upper (suction) or lower face"
    )
    span: Extent = Field(title="Span", description="Range of span fractions")
    chord: Extent = Field(title="Chord", description="Range of chord fractions")


class ForceWords(ExcitationWords):
    """Force at a point of the surface."""

    amplitude_key: ClassVar[str] = "force"
    example: ClassVar[units.Kind] = units.FORCE
    density_example: ClassVar[units.Kind] = units.FORCE_DENSITY

    kind: Literal["point-force"] = Field(title="Kind", description="Force at a point")
    force: Annotated[float, Quantity(units.FORCE, above=0.0)] | None = Field(
        None, title="Force", description="Peak amplitude"
    )
    density: Annotated[float, Quantity(units.FORCE_DENSITY, above=0.0)] | None = Field(
        None, title="Density", description=_DENSITY
    )


class PushWords(ForceWords):
    """Force at a point of the surface, in a fixed direction."""

    direction: Direction = Field(
        title="Direction", description="Along x, y and z; its length does not matter"
    )
    at: SpanChord = Field(title="At", description="Span fraction and chord fraction")
    face: Annotated[Face, one_of(Face, "a face of the blade")] = Field(
        "upper", title="Face", description="Face of the blade"
    )


class LinePushWords(ExcitationWords):
    """Force along a straight line of the planform, in a fixed direction."""

    amplitude_key: ClassVar[str] = "force"
    example: ClassVar[units.Kind] = units.LINE_FORCE
    density_example: ClassVar[units.Kind] = units.LINE_FORCE_DENSITY

    kind: Literal["line-force"] = Field(title="Kind", description="Force along a line")
    force: Annotated[float, Quantity(units.LINE_FORCE, above=0.0)] | None = Field(
        None, title="Force", description="Peak amplitude per length"
    )
    density: Annotated[float, Quantity(units.LINE_FORCE_DENSITY, above=0.0)] | None = Field(
        None, title="Density", description=_DENSITY
    )
    direction: Direction = Field(
        title="Direction", description="Along x, y and z; its length does not matter"
    )
    start: SpanChord = Field(title="Start", description="Span fraction and chord fraction")
    end: SpanChord = Field(title="End", description="Span fraction and chord fraction")
    face: Annotated[Face, one_of(Face, "a face of the blade")] = Field(
        "upper", title="Face", description="Face of the blade"
    )

    @model_validator(mode="after")
    def _check_line(self) -> "LinePushWords":
        if self.start == self.end:
            raise wrong("the line has no length", "Choose another end", at=("end",))
        return self


class RootMotionWords(ExcitationWords):
    """Motion that is forced on the root, as by a shaft or an engine; it moves as a rigid body."""

    amplitude_key: ClassVar[str] = "amplitude"
    example: ClassVar[units.Kind] = units.LENGTH

    kind: Literal["root-motion"] = Field(title="Kind", description="Motion of the root")
    motion: Annotated[Motion, one_of(Motion, "a motion of the root")] = Field(
        title="Motion", description="What amplitude or density is of; decides their unit"
    )
    axis: Annotated[Axis, one_of(Axis, "an axis")] = Field(
        title="Axis", description="Along it, or about it through the centre of the root face"
    )
    amplitude: Annotated[float, OfMotion(0)] | None = Field(
        None, title="Amplitude", description="Peak amplitude"
    )
    density: Annotated[float, OfMotion(1)] | None = Field(
        None, title="Density", description=_DENSITY
    )

    @property
    def unit(self) -> str:
        """SI unit of the amplitude."""
        return MOTIONS[self.motion][0].unit

    @property
    def density_unit(self) -> str:
        """SI unit of the density."""
        return MOTIONS[self.motion][1].unit


AnyExcitationWords: TypeAlias = PatchWords | PushWords | LinePushWords | RootMotionWords

EXCITATIONS: dict[str, type[AnyExcitationWords]] = {
    "pressure": PatchWords,
    "point-force": PushWords,
    "line-force": LinePushWords,
    "root-motion": RootMotionWords,
}
"""Model of each kind of excitation."""


def listed(value: Any) -> Any:
    """Take one table for a list of one, and a table without a kind for a pressure."""
    rows = [value] if isinstance(value, Mapping) else value
    if not isinstance(rows, list | tuple):
        raise wrong("a table is needed", "Write its keys below [excitation] or [[excitation]]")
    if not rows:
        raise wrong("is empty", "Nothing is moved: add a table [[excitation]]")
    return [{"kind": "pressure", **row} if isinstance(row, Mapping) else row for row in rows]


def distinct_names(rows: tuple[AnyWords, ...]) -> tuple[AnyWords, ...]:
    """Refuse two excitations of one name."""
    names = [row.name for row in rows]
    for number, name in enumerate(names):
        if name and name in names[:number]:
            raise wrong("names two excitations", "Choose another", at=(number, "name"))
    return rows


def _apart(rows: tuple[AnyExcitationWords, ...]) -> tuple[AnyExcitationWords, ...]:
    for number, row in enumerate(rows):
        for other, before in enumerate(rows[:number]):
            if isinstance(row, PatchWords) and isinstance(before, PatchWords):
                _check_apart(number, row, other, before)
    return rows


def _check_apart(number: int, row: PatchWords, other: int, before: PatchWords) -> None:
    shared = (
        max(a[0], b[0]) <= min(a[1], b[1])
        for a, b in ((row.span, before.span), (row.chord, before.chord))
    )
    if row.side == before.side and all(shared):
        raise wrong(
            f"the patch touches that of excitation[{other}]",
            "Leave a gap of some hundredths between them, in span or chord",
            at=(number, "span"),
        )


Excitations = Annotated[
    tuple[Annotated[AnyExcitationWords, Field(discriminator="kind")], ...],
    AfterValidator(_apart),
    AfterValidator(distinct_names),
    BeforeValidator(listed),
]
"""One table, or a list of tables."""


class ShaftWords(Words):
    """End of an elastic shaft at the centre of the root face; what is left out is zero."""

    translation: StiffnessVector | None = Field(
        None, title="Translation", description="Stiffness along x, y and z"
    )
    rotation: AngularStiffnessVector | None = Field(
        None, title="Rotation", description="Stiffness about x, y and z"
    )
    translation_damping: DampingVector | None = Field(
        None, title="Translation damping", description="Dashpots along x, y and z"
    )
    rotation_damping: AngularDampingVector | None = Field(
        None, title="Rotation damping", description="Dashpots about x, y and z"
    )
    mass: MassVector | None = Field(
        None, title="Mass", description="Masses that move along x, y and z"
    )
    inertia: InertiaVector | None = Field(
        None, title="Inertia", description="Moments of inertia about x, y and z"
    )

    @model_validator(mode="after")
    def _check_takes_power(self) -> "ShaftWords":
        if not any((*(self.translation_damping or ()), *(self.rotation_damping or ()))):
            raise wrong(
                "a shaft without dashpots takes no power",
                'Add translation_damping = ["5 kN*s/m", "5 kN*s/m", "5 kN*s/m"]: a long rod of '
                "area A takes A sqrt(E rho) along its axis",
            )
        return self


def _once(names: tuple[Function, ...]) -> tuple[Function, ...]:
    if len(set(names)) < len(names):
        raise wrong("names a function twice", "Name each once")
    return names


class TransferWords(Words):
    """Transfer functions beside the spectrum."""

    functions: Annotated[
        tuple[Annotated[Function, one_of(Function, "a transfer function")], ...],
        AfterValidator(_once),
        entries_from(1),
    ] = Field(
        title="Functions",
        description="Drive-point mobility of each load, radiated power per mean square force, "
        "blocked force and moment at the root, power into a shaft in place of the clamp",
    )
    shaft: ShaftWords | None = Field(
        None, title="Shaft", description="Shaft that takes the place of the clamp, for `shaft`"
    )

    @model_validator(mode="after")
    def _check_shaft(self) -> "TransferWords":
        if "shaft" in self.functions and self.shaft is None:
            raise wrong(
                "asks for a shaft that is not described",
                "Add [transfer.shaft] with translation_damping or rotation_damping",
                at=("functions",),
            )
        if self.shaft is not None and "shaft" not in self.functions:
            raise wrong("is not asked for", 'Add "shaft" to functions', at=("shaft",))
        return self

    @property
    def of_root(self) -> bool:
        """Whether the force on the root is wanted."""
        return "blocked-force" in self.functions or "shaft" in self.functions
