# SPDX-License-Identifier: LGPL-2.1-or-later
"""Types of the fields of a case: quantities with units, fractions, counts and ranges."""

from dataclasses import dataclass
from typing import Annotated, Any, get_args

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    GetCoreSchemaHandler,
    GetJsonSchemaHandler,
    Strict,
    ValidationInfo,
)
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema, PydanticCustomError, core_schema

from quietblade.case import units
from quietblade.case.problems import Path, suggestion
from quietblade.case.units import WRITTEN_QUANTITY, Kind, UnitError, read_quantity

CASE_PROBLEM = "case_problem"
"""Type of the validation errors that carry their own message, remedy and place."""


class Words(BaseModel):
    """A table of the case file: frozen, and unknown keys are errors."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


TABLES = "tables"
"""Key of a JSON schema under which stand the names of the models that a table may be of."""


def one_table_of(*models: type[Words]) -> JsonSchemaValue:
    """Describe a table of one of several models, by their names: they may hold each other."""
    return {"type": "object", TABLES: [model.__name__ for model in models]}


def wrong(message: str, remedy: str = "", *, at: Path = ()) -> PydanticCustomError:
    """Make the validation error of a field, or of what stands ``at`` a place inside it."""
    context = {"message": message, "remedy": remedy, "at": at}
    return PydanticCustomError(CASE_PROBLEM, "{message}", context)


def is_si(info: ValidationInfo) -> bool:
    """Tell whether bare numbers are SI values: only for what a program wrote itself."""
    return bool(info.context and info.context.get("si"))


@dataclass(frozen=True)
class Quantity:
    """Annotation of a float that a case file writes with a unit.

    Attributes
    ----------
    kind : Kind
        Its dimension, unit and example.
    above, least, most : float or None
        Bounds in SI units: strictly above, at least, at most.
    hint : str
        Remedy for a value outside the bounds, if the example does not say it.
    """

    kind: Kind
    above: float | None = None
    least: float | None = None
    most: float | None = None
    hint: str = ""

    def read(self, value: Any, *, si: bool = False, at: Path = ()) -> float:
        """Read a value of the file as an SI number within the bounds."""
        try:
            number = read_quantity(value, self.kind, bare=si)
        except UnitError as problem:
            raise wrong(problem.message, problem.remedy, at=at) from problem
        fault = self.fault(number)
        if fault is not None:
            raise wrong(*fault, at=at)
        return number

    def fault(self, number: float) -> tuple[str, str] | None:
        """Return message and remedy for a number outside the bounds, else None."""
        example = f'Write {self.kind.name}, for example "{self.kind.example}"'
        limit = None
        if self.above is not None and number <= self.above:
            limit = f"greater than {self._in_words(self.above)}"
        elif self.least is not None and number < self.least:
            limit = f"at least {self._in_words(self.least)}"
        elif self.most is not None and number > self.most:
            limit = f"at most {self._in_words(self.most)}"
        if limit is not None:
            return f"must be {limit}", self.hint or example
        if number and not self.kind.smallest <= abs(number) <= self.kind.largest:
            size = "large" if abs(number) > self.kind.largest else "small"
            return f"is absurdly {size} for {self.kind.name}", f"Check the unit. {example}"
        return None

    def _in_words(self, bound: float) -> str:
        return f"{bound:g} {self.kind.unit}".rstrip() if bound else "zero"

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        def validate(value: Any, info: ValidationInfo) -> float:
            return self.read(value, si=is_si(info))

        return core_schema.with_info_plain_validator_function(validate)

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        return self.json_schema()

    def json_schema(self) -> JsonSchemaValue:
        """Describe the value as a case file writes it."""
        written = {"unit": self.kind.unit, "pattern": WRITTEN_QUANTITY}
        if self.kind.unit:
            return {"type": "string", "examples": [self.kind.example], **written}
        return {"type": ["number", "string"], "examples": [0.06, self.kind.example], **written}


Length = Annotated[float, Quantity(units.LENGTH, above=0.0)]
LengthOrZero = Annotated[float, Quantity(units.LENGTH, least=0.0)]
Coordinate = Annotated[float, Quantity(units.LENGTH)]
Angle = Annotated[float, Quantity(units.ANGLE)]
Speed = Annotated[float, Quantity(units.SPEED, above=0.0)]
AngularSpeed = Annotated[float, Quantity(units.ANGULAR_SPEED)]
Frequency = Annotated[float, Quantity(units.FREQUENCY, above=0.0)]
Pressure = Annotated[float, Quantity(units.PRESSURE, above=0.0)]
PressureOrZero = Annotated[float, Quantity(units.PRESSURE, least=0.0)]
SignedPressure = Annotated[float, Quantity(units.PRESSURE)]
Force = Annotated[float, Quantity(units.FORCE)]
ForcePerLength = Annotated[float, Quantity(units.LINE_FORCE)]
Stiffness = Annotated[float, Quantity(units.LINE_FORCE, above=0.0)]
AngularStiffness = Annotated[float, Quantity(units.MOMENT_PER_ANGLE, above=0.0)]
Acceleration = Annotated[float, Quantity(units.ACCELERATION)]
Modulus = Annotated[float, Quantity(units.MODULUS, above=0.0)]
ModulusOrZero = Annotated[float, Quantity(units.MODULUS, least=0.0)]
Density = Annotated[float, Quantity(units.DENSITY, above=0.0)]
Viscosity = Annotated[float, Quantity(units.VISCOSITY, above=0.0)]
Duration = Annotated[float, Quantity(units.TIME, above=0.0)]
Temperature = Annotated[float, Quantity(units.TEMPERATURE, above=0.0)]
TemperatureStep = Annotated[float, Quantity(units.TEMPERATURE_STEP, above=0.0)]
MolarEnergy = Annotated[float, Quantity(units.MOLAR_ENERGY, above=0.0)]
LevelDifference = Annotated[float, Quantity(units.LEVEL, above=0.0)]
Level = Annotated[float, Quantity(units.SOUND_LEVEL)]
Fraction = Annotated[
    float,
    Quantity(
        units.FRACTION,
        least=0.0,
        most=1.0,
        hint="The blade reaches from 0 (root, leading edge) to 1 (tip, trailing edge)",
    ),
]

Number = Annotated[float, Strict()]
Count = Annotated[int, Strict()]
Text = Annotated[str, Strict()]
Flag = Annotated[bool, Strict()]


def entries(count: int) -> BeforeValidator:
    """Make the validator of a list that must have a given number of entries."""

    def check(value: Any) -> Any:
        if not isinstance(value, list | tuple):
            raise wrong(f"a list of {count} entries is needed", f"Write {count} entries in [ ]")
        if len(value) != count:
            raise wrong(f"has {len(value)} entries and needs {count}", f"Write {count} entries")
        return value

    return BeforeValidator(check)


def entries_from(least: int) -> BeforeValidator:
    """Make the validator of a list that must have some entries."""

    def check(value: Any) -> Any:
        if not isinstance(value, list | tuple) or len(value) < least:
            raise wrong(f"a list of {least} or more entries is needed", "Write the entries in [ ]")
        return value

    return BeforeValidator(check)


def _increasing(of: str) -> AfterValidator:
    def check(pair: tuple[float, float]) -> tuple[float, float]:
        low, high = pair
        if low == high:
            raise wrong(f"the {of} is empty: it ends where it begins", f"Widen the {of}")
        if low > high:
            raise wrong(f"the {of} is reversed: it ends below its beginning", "Swap the two values")
        return pair

    return AfterValidator(check)


Extent = Annotated[tuple[Fraction, Fraction], _increasing("range"), entries(2)]
"""Range of span or chord fractions."""

Band = Annotated[tuple[Frequency, Frequency], _increasing("band"), entries(2)]
"""Range of frequencies."""

Point = Annotated[tuple[Coordinate, Coordinate, Coordinate], entries(3)]
"""Position in the blade's axes."""

SpanChord = Annotated[tuple[Fraction, Fraction], entries(2)]
"""Place on the blade: span fraction and chord fraction."""

ForceVector = Annotated[tuple[Force, Force, Force], entries(3)]
LineForceVector = Annotated[tuple[ForcePerLength, ForcePerLength, ForcePerLength], entries(3)]
AccelerationVector = Annotated[tuple[Acceleration, Acceleration, Acceleration], entries(3)]
StiffnessVector = Annotated[tuple[Stiffness, Stiffness, Stiffness], entries(3)]
AngularStiffnessVector = Annotated[
    tuple[AngularStiffness, AngularStiffness, AngularStiffness], entries(3)
]
Damping = Annotated[float, Quantity(units.DAMPING, least=0.0)]
AngularDamping = Annotated[float, Quantity(units.ANGULAR_DAMPING, least=0.0)]
Mass = Annotated[float, Quantity(units.MASS, least=0.0)]
Inertia = Annotated[float, Quantity(units.INERTIA, least=0.0)]
DampingVector = Annotated[tuple[Damping, Damping, Damping], entries(3)]
AngularDampingVector = Annotated[tuple[AngularDamping, AngularDamping, AngularDamping], entries(3)]
MassVector = Annotated[tuple[Mass, Mass, Mass], entries(3)]
InertiaVector = Annotated[tuple[Inertia, Inertia, Inertia], entries(3)]
"""Components along the blade's axes x, y, z."""


def one_of(literal: Any, what: str) -> BeforeValidator:
    """Make the validator of a word of a `Literal`, with a suggestion for a misspelt one."""
    words: tuple[str, ...] = get_args(literal)

    def check(value: Any) -> Any:
        if value not in words:
            known = ", ".join(f'"{word}"' for word in words)
            near = suggestion(value, words) if isinstance(value, str) else ""
            raise wrong(f"is not {what}", f"{near} Known: {known}".strip())
        return value

    return BeforeValidator(check)


@dataclass(frozen=True)
class Between:
    """Annotation of a plain number within bounds; the lower one may be excluded."""

    least: float
    most: float
    open_low: bool

    def check(self, value: float) -> float:
        """Return a number within the bounds, refuse any other."""
        low, high = self.least, self.most
        if not (low < value if self.open_low else low <= value) or value > high:
            start = "above" if self.open_low else "from"
            raise wrong(
                f"must be {start} {low:g} to {high:g}",
                f"Choose a number {start} {low:g} to {high:g}",
            )
        return value

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        return core_schema.no_info_after_validator_function(self.check, handler(source))

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        low = "exclusiveMinimum" if self.open_low else "minimum"
        return {**handler(schema), low: self.least, "maximum": self.most}


def between(least: float, most: float, *, open_low: bool = False) -> Between:
    """Make the annotation of a plain number within bounds."""
    return Between(least, most, open_low)
