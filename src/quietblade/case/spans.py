# SPDX-License-Identifier: LGPL-2.1-or-later
"""Functions of the span as a case file writes them: a constant, a table or a formula."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Annotated, Any, Literal, TypeAlias, get_args

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler, ValidationInfo
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema, core_schema

from quietblade.case import units
from quietblade.case.fields import Quantity, is_si, wrong
from quietblade.case.formula import formula_fault, formula_remedy
from quietblade.case.problems import suggestion
from quietblade.case.units import UnitError, convert_factor

Interpolation = Literal["linear", "pchip"]


@dataclass(frozen=True)
class ConstantSpan:
    """The same SI value along the whole span."""

    value: float

    def plain(self) -> Any:
        """Return JSON-able data with SI values."""
        return self.value


@dataclass(frozen=True)
class TableSpan:
    """SI values at span fractions from 0 (root) to 1 (tip)."""

    s: tuple[float, ...]
    values: tuple[float, ...]
    interpolation: Interpolation

    def plain(self) -> Any:
        """Return JSON-able data with SI values."""
        return {
            "s": list(self.s),
            "values": list(self.values),
            "interpolation": self.interpolation,
        }


@dataclass(frozen=True)
class FormulaSpan:
    """An expression of the span fraction ``s`` whose result is in ``unit``.

    ``scale`` is the SI value of that unit.
    """

    formula: str
    unit: str
    scale: float

    def plain(self) -> Any:
        """Return JSON-able data; the unit stays in words."""
        return {"formula": self.formula} | ({"unit": self.unit} if self.unit else {})


SpanValue: TypeAlias = ConstantSpan | TableSpan | FormulaSpan


@dataclass(frozen=True)
class Spanwise:
    """Annotation of a field that is a function of the span, of one kind of quantity."""

    quantity: Quantity

    def read(self, value: Any, *, si: bool = False) -> SpanValue:
        """Read what a case file says: a value, or a table with ``values`` or ``formula``."""
        if not isinstance(value, Mapping):
            return ConstantSpan(self.quantity.read(value, si=si))
        if "formula" in value:
            return self._formula(value)
        if "values" in value or "s" in value:
            return self._table(value, si)
        raise wrong("says neither values nor a formula", f"Write {self._example}")

    @property
    def _example(self) -> str:
        example = self.quantity.kind.example
        value = f'"{example}"' if self.quantity.kind.unit else "0.06"
        return f"{value} or {{ s = [0, 1], values = [{value}, {value}] }}"

    def _table(self, value: Mapping[str, Any], si: bool) -> TableSpan:
        _known_keys(value, ("s", "values", "interpolation"))
        lists: dict[str, list[Any]] = {}
        for key in ("s", "values"):
            entry = value.get(key)
            if not isinstance(entry, list | tuple):
                fault = "must be a list" if key in value else f"has no {key}"
                raise wrong(fault, f"Write {self._example}", at=(key,) if key in value else ())
            lists[key] = list(entry)
        s = [_span_fraction(x, i) for i, x in enumerate(lists["s"])]
        values = [
            self.quantity.read(x, si=si, at=("values", i)) for i, x in enumerate(lists["values"])
        ]
        if len(s) != len(values) or len(s) < 2:
            raise wrong(
                f"has {len(s)} span fractions and {len(values)} values",
                "Give at least two of each, and as many values as span fractions",
            )
        if s[0] != 0.0 or s[-1] != 1.0 or any(a >= b for a, b in pairwise(s)):
            raise wrong(
                "the span fractions do not increase from 0 to 1",
                "Begin with 0 (root), end with 1 (tip), and let each be greater than the last",
                at=("s",),
            )
        kind = value.get("interpolation", "linear")
        if kind not in get_args(Interpolation):
            near = suggestion(kind, get_args(Interpolation)) if isinstance(kind, str) else ""
            remedy = f'{near} Known: "linear", "pchip" (monotone cubic)'.strip()
            raise wrong("is not an interpolation", remedy, at=("interpolation",))
        return TableSpan(tuple(s), tuple(values), kind)

    def _formula(self, value: Mapping[str, Any]) -> FormulaSpan:
        _known_keys(value, ("formula", "unit"))
        kind = self.quantity.kind
        formula, unit = value["formula"], value.get("unit", "")
        if not isinstance(formula, str) or not formula.strip():
            raise wrong("is not a formula", 'Write it in quotes: "0.25 - 0.175*s"', at=("formula",))
        fault = formula_fault(formula.strip())
        if fault:
            raise wrong(fault, formula_remedy(), at=("formula",))
        if not isinstance(unit, str):
            raise wrong("is not a unit", f'Write unit = "{kind.unit}"', at=("unit",))
        if kind.unit and not unit.strip():
            raise wrong("the formula has no unit", f'Add unit = "{kind.usual[0]}"')
        try:
            scale = convert_factor(unit, kind) if unit.strip() else 1.0
        except UnitError as problem:
            raise wrong(problem.message, f'Write unit = "{kind.unit}"', at=("unit",)) from problem
        return FormulaSpan(formula.strip(), unit.strip(), scale)

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        def validate(value: Any, info: ValidationInfo) -> SpanValue:
            return self.read(value, si=is_si(info))

        return core_schema.with_info_plain_validator_function(
            validate,
            serialization=core_schema.plain_serializer_function_ser_schema(lambda v: v.plain()),
        )

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        value = self.quantity.json_schema()
        table = {
            "s": {"type": "array", "items": {"type": "number"}},
            "values": {"type": "array", "items": value},
            "interpolation": {"enum": list(get_args(Interpolation)), "default": "linear"},
        }
        formula = {"formula": {"type": "string"}, "unit": {"type": "string"}}
        return {
            "unit": value["unit"],
            "anyOf": [
                value,
                _closed(table, "s", "values"),
                _closed(formula, "formula"),
            ],
        }


def _closed(properties: JsonSchemaValue, *required: str) -> JsonSchemaValue:
    return {
        "type": "object",
        "properties": properties,
        "required": list(required),
        "additionalProperties": False,
    }


def _known_keys(value: Mapping[str, Any], known: tuple[str, ...]) -> None:
    for key in value:
        if key not in known:
            near = suggestion(key, known)
            raise wrong("unknown key", f"{near} Known: {', '.join(known)}".strip(), at=(key,))


def _span_fraction(value: Any, position: int) -> float:
    fraction = Quantity(units.FRACTION, least=0.0, most=1.0)
    return fraction.read(value, at=("s", position))


SpanLength = Annotated[SpanValue, Spanwise(Quantity(units.LENGTH, above=0.0))]
SpanOffset = Annotated[SpanValue, Spanwise(Quantity(units.LENGTH))]
SpanAngle = Annotated[SpanValue, Spanwise(Quantity(units.ANGLE))]
SpanThickness = Annotated[SpanValue, Spanwise(Quantity(units.FRACTION, above=0.0, most=0.5))]
SpanCamber = Annotated[SpanValue, Spanwise(Quantity(units.FRACTION, least=-0.25, most=0.25))]


def spanwise_quantity(note: Iterable[Any]) -> Quantity:
    """Return the quantity that a field's annotations say is a function of the span."""
    return next(n.quantity for n in note if isinstance(n, Spanwise))
