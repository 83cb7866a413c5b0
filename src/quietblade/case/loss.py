# SPDX-License-Identifier: LGPL-2.1-or-later
"""How a case says the loss of a material: a number, or a table that names its model."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Annotated, Any, Literal, TypeAlias

from pydantic import (
    AfterValidator,
    Field,
    GetCoreSchemaHandler,
    GetJsonSchemaHandler,
    TypeAdapter,
    model_validator,
)
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema, core_schema

from quietblade.case.fields import (
    Duration,
    MolarEnergy,
    Number,
    Temperature,
    TemperatureStep,
    Text,
    Words,
    between,
    entries_from,
    is_si,
    one_table_of,
    wrong,
)
from quietblade.case.problems import Path, suggestion

STRUCTURAL_LOSS = (
    "Structural loss factor eta of the complex stiffness (1 + i eta), or a table that names a model"
)
"""Meaning of the key loss_factor of an elastic material."""

FILM_LOSS = (
    "Loss factor eta of the complex shear modulus G (1 + i eta), or a table that names a model"
)
"""Meaning of the key loss_factor of a film's material."""


def _read_by(read: Callable[..., Any]) -> CoreSchema:
    """Make the schema of a value that ``read(value, si=...)`` returns."""
    return core_schema.with_info_plain_validator_function(
        lambda value, info: read(value, si=is_si(info)),
        serialization=core_schema.plain_serializer_function_ser_schema(_plain),
    )


@dataclass(frozen=True)
class OneOf:
    """Annotation of a table of one of several models, which one of its keys names.

    Attributes
    ----------
    key, what : str
        The key, and what its word is, for messages.
    models : mapping of str to type of Words
    """

    key: str
    what: str
    models: Mapping[str, type[Words]]

    def model(self, value: Any) -> type[Words] | None:
        """Model that a table names, None if it names none that is known."""
        word = value.get(self.key) if isinstance(value, Mapping) else None
        return self.models.get(word) if isinstance(word, str) else None

    def read(self, value: Any, *, si: bool) -> Any:
        """Read a table."""
        if isinstance(value, tuple(self.models.values())):
            return value
        known = ", ".join(f'"{name}"' for name in self.models)
        if not isinstance(value, Mapping):
            raise wrong("a table is needed", f"Write {{ {self.key} = ..., ... }}; known: {known}")
        model = self.model(value)
        if model is None:
            word = value.get(self.key)
            near = suggestion(word, self.models) if isinstance(word, str) else ""
            at = (self.key,) if self.key in value else ()
            raise wrong(f"names no known {self.what}", f"{near} Known: {known}".strip(), at=at)
        return model.model_validate(value, context={"si": si})

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        return _read_by(self.read)

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        return one_table_of(*self.models.values())


def _plain(value: Any) -> Any:
    return value.model_dump(mode="json", exclude_none=True) if isinstance(value, Words) else value


class WlfWords(Words):
    """Shift of Williams, Landel and Ferry: log10 a_T = -c1 (T - T0) / (c2 + T - T0)."""

    law: Literal["wlf"] = Field(title="Law", description="Williams, Landel and Ferry")
    c1: Annotated[Number, between(0.0, 1e3, open_low=True)] = Field(
        title="c1", description="First constant, with the logarithm to base 10"
    )
    c2: TemperatureStep = Field(title="c2", description="Second constant")
    reference: Temperature = Field(
        title="Reference", description="Temperature T0 for which the model is given"
    )


class ArrheniusWords(Words):
    """Shift of Arrhenius: ln a_T = (Q / R) (1 / T - 1 / T0)."""

    law: Literal["arrhenius"] = Field(title="Law", description="Arrhenius")
    energy: MolarEnergy = Field(title="Energy", description="Activation energy Q")
    reference: Temperature = Field(
        title="Reference", description="Temperature T0 for which the model is given"
    )


ShiftWords: TypeAlias = WlfWords | ArrheniusWords
SHIFTS = OneOf("law", "law of a shift", {"wlf": WlfWords, "arrhenius": ArrheniusWords})


class PrestrainWords(Words):
    """Complex modulus of a film that is sheared by the steady load."""

    shear: Annotated[Number, between(0.0, 10.0, open_low=True)] = Field(
        title="Shear", description="Static shear strain; the modulus is interpolated between them"
    )
    factor: Annotated[Number, between(0.0, 1e3, open_low=True)] = Field(
        1.0, title="Factor", description="Of the complex modulus at this shear"
    )
    loss_factor: "LossValue | None" = Field(
        None,
        title="Loss factor",
        description="As that of an elastic material; without it the model of the film itself",
    )


def _ascending(entries: tuple[PrestrainWords, ...]) -> tuple[PrestrainWords, ...]:
    if any(a.shear >= b.shear for a, b in pairwise(entries)):
        raise wrong("the static shears do not ascend", "Sort the entries by shear, each once")
    return entries


class LossWords(Words):
    """What all models have in common."""

    model: str = Field(title="Model", description="Name of the model")
    prestrain: Annotated[
        tuple[PrestrainWords, ...], AfterValidator(_ascending), entries_from(0)
    ] = Field(
        (),
        title="Prestrain",
        description="Tables { shear, factor, loss_factor } for a film under static shear; the "
        "model itself holds without shear",
    )


class ConstantWords(LossWords):
    """The same loss factor at every frequency; not causal, the paper's."""

    model: Literal["constant"] = Field(title="Model", description="Constant")
    value: Annotated[Number, between(0.0, 10.0)] = Field(
        title="Value", description="Loss factor eta"
    )


class _ShiftedWords(LossWords):
    """Models that depend on frequency, and so on temperature."""

    temperature: Temperature | None = Field(
        None, title="Temperature", description="At which the blade works; needs a shift"
    )
    shift: Annotated[ShiftWords | None, SHIFTS] = Field(
        None,
        title="Shift",
        description="Table { law, ... } by which the temperature moves the model over frequency",
    )

    @model_validator(mode="after")
    def _check_both(self) -> "_ShiftedWords":
        if self.temperature is not None and self.shift is None:
            raise wrong(
                "has a temperature and no shift",
                'Add shift = { law = "wlf", c1, c2, reference } or { law = "arrhenius", energy, '
                "reference }, or leave the temperature out",
                at=("temperature",),
            )
        if self.shift is not None and self.temperature is None:
            raise wrong(
                "has a shift and no temperature",
                'Add temperature = "15 degC", at which the blade works',
                at=("shift",),
            )
        return self


class ZenerWords(_ShiftedWords):
    """Fractional Zener model, g = (1 + r (i w tau)^a) / (1 + (i w tau)^a)."""

    model: Literal["fractional-zener"] = Field(title="Model", description="Fractional Zener")
    stiffening: Annotated[Number, between(1.0, 1e6, open_low=True)] = Field(
        title="Stiffening", description="r, modulus at high frequencies over that at rest"
    )
    relaxation_time: Duration = Field(title="Relaxation time", description="tau")
    exponent: Annotated[Number, between(0.0, 1.0, open_low=True)] = Field(
        title="Exponent", description="a, order of the derivative; 1 is the standard linear solid"
    )


class MaxwellWords(_ShiftedWords):
    """Generalised Maxwell model, g = 1 + sum_k g_k i w tau_k / (1 + i w tau_k)."""

    model: Literal["maxwell"] = Field(title="Model", description="Generalised Maxwell")
    strengths: Annotated[tuple[Annotated[Number, between(0.0, 1e9)], ...], entries_from(1)] = Field(
        title="Strengths", description="g_k, moduli of the branches over that at rest"
    )
    relaxation_times: Annotated[tuple[Duration, ...], entries_from(1)] = Field(
        title="Relaxation times", description="tau_k, one for each strength"
    )

    @model_validator(mode="after")
    def _check_lengths(self) -> "MaxwellWords":
        if len(self.strengths) != len(self.relaxation_times):
            raise wrong(
                f"has {len(self.strengths)} strengths and {len(self.relaxation_times)} "
                "relaxation times",
                "Give as many of the one as of the other",
                at=("relaxation_times",),
            )
        return self


class ModulusTableWords(_ShiftedWords):
    """Measured complex moduli in a file, fitted by a generalised Maxwell model.

    The file, beside the case file, has columns under a header that says their units, such as
    ``frequency [Hz], storage modulus [MPa], loss modulus [MPa]`` or, in place of the last,
    ``loss factor``. With a column ``static shear`` it is a table over the film's static shear.
    """

    model: Literal["table"] = Field(title="Model", description="Fit of measured moduli")
    file: Text = Field(title="File", description="Table of frequency and moduli (CSV)")

    @model_validator(mode="after")
    def _check_file(self) -> "ModulusTableWords":
        if not self.file.strip():
            raise wrong("names no file", 'Write file = "rubber.csv"', at=("file",))
        return self


LOSS_MODELS = OneOf(
    "model",
    "model of the loss",
    {
        "constant": ConstantWords,
        "fractional-zener": ZenerWords,
        "maxwell": MaxwellWords,
        "table": ModulusTableWords,
    },
)
"""Models that the table ``loss_factor`` may name."""

_NUMBER: TypeAdapter[float] = TypeAdapter(Annotated[Number, between(0.0, 10.0)])


@dataclass(frozen=True)
class _Loss:
    """Annotation of a loss factor: a number, or a table with a model of `LOSS_MODELS`.

    Attributes
    ----------
    film : bool
        Whether the model may depend on the static shear.
    """

    film: bool

    def read(self, value: Any, *, si: bool) -> Any:
        """Read a number or a table; a constant without prestrain is a number."""
        if not isinstance(value, Mapping | Words):
            return _NUMBER.validate_python(value)
        words = LOSS_MODELS.read(value, si=si)
        if words.prestrain and not self.film:
            raise wrong(
                "depends on static shear, which only the loss of a film does",
                "Remove prestrain",
                at=("prestrain",),
            )
        return words.value if isinstance(words, ConstantWords) and not words.prestrain else words

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        return _read_by(self.read)

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        return {"anyOf": [{"type": "number"}, one_table_of(*LOSS_MODELS.models.values())]}


LossValue: TypeAlias = Annotated[float | LossWords, _Loss(film=False)]
FilmLossValue: TypeAlias = Annotated[float | LossWords, _Loss(film=True)]

PrestrainWords.model_rebuild()


def loss_model(path: Path, value: Any) -> type[Words] | None:
    """Model of the table at a place in a loss factor, for messages about its keys.

    Parameters
    ----------
    path : tuple
        Keys and positions below ``loss_factor``.
    value : object
        What stands at that key.
    """
    model, chosen = LOSS_MODELS.model(value), LOSS_MODELS
    for part in path:
        value = _entry(value, part)
        if isinstance(part, int):
            model = PrestrainWords
        elif part != "prestrain":
            chosen = SHIFTS if part == "shift" else LOSS_MODELS
            model = chosen.model(value)
    return model


def _entry(value: Any, part: str | int) -> Any:
    if isinstance(value, Mapping):
        return value.get(part)
    inside = isinstance(value, list | tuple) and isinstance(part, int) and part < len(value)
    return value[part] if inside else None


def loss_files(loss: float | LossWords | None) -> Iterator[tuple[str, str]]:
    """Files that a loss factor names, by key below it."""
    if isinstance(loss, ModulusTableWords):
        yield "file", loss.file
    if isinstance(loss, LossWords):
        for number, entry in enumerate(loss.prestrain):
            for key, file in loss_files(entry.loss_factor):
                yield f"prestrain[{number}].loss_factor.{key}", file
