# SPDX-License-Identifier: LGPL-2.1-or-later
"""A calibration as the user says it: unstated parameters, their bounds, and what is fitted."""

import re
from collections.abc import Mapping
from pathlib import Path as FilePath
from typing import Annotated, Any, Self

from pydantic import AfterValidator, Field, PrivateAttr, model_validator

from quietblade.case.fields import Count, Number, Text, Words, between, entries_from, wrong
from quietblade.case.model import Case
from quietblade.case.problems import InvalidCaseError, Problem
from quietblade.case.source import Finding, Source
from quietblade.case.study import flat, read_words

_QUANTITY = re.compile(r"\s*([+-]?[\d.]+(?:[eE][+-]?\d+)?)\s*(\S.*?)?\s*")
_ENTRY = re.compile(r"(.+)\[(\d+)\]")
_DIGITS = 5


def magnitude(value: Any, at: str) -> tuple[float, str]:
    """Split a value as it is written into number and unit (empty without one)."""
    if isinstance(value, int | float) and not isinstance(value, bool):
        return float(value), ""
    found = _QUANTITY.fullmatch(value) if isinstance(value, str) else None
    try:
        number = float(found[1]) if found else None
    except ValueError:  # such as 1.2.3
        number = None
    if found is None or number is None:
        raise wrong("is not a number with or without a unit", 'Write 0.5 or "1.5 mm"', at=(at,))
    return number, found[2] or ""


class ParameterWords(Words):
    """A number of the case that is not known."""

    key: Text = Field(
        title="Key", description="Dotted key of a case; `film.span[0]` is the first of a list"
    )
    low: Any = Field(title="Low", description="Least admissible value, as in a case file")
    high: Any = Field(title="High", description="Greatest admissible value, in the same unit")
    start: Any = Field(None, title="Start", description="Where to begin; the middle if not given")
    search: bool = Field(
        True, title="Search", description="Whether the search moves it; else sensitivities only"
    )
    reason: Text = Field("", title="Reason", description="Where the bounds come from")

    @model_validator(mode="after")
    def _check(self) -> "ParameterWords":
        (low, unit), (high, other) = magnitude(self.low, "low"), magnitude(self.high, "high")
        if other != unit:
            raise wrong(f"has another unit than low, {self.low!r}", "Use the same", at=("high",))
        if low >= high:
            raise wrong(f"is not above low, {self.low!r}", "Swap or widen the bounds", at=("high",))
        if self.start is not None:
            start, own = magnitude(self.start, "start")
            if own != unit or not low <= start <= high:
                message = f"does not lie between {self.low!r} and {self.high!r}"
                raise wrong(message, "Choose a start inside the bounds", at=("start",))
        return self

    def value(self, x: float) -> Any:
        """Value at a place ``x`` from 0 (low) to 1 (high), as a case file writes it."""
        (low, unit), (high, _) = magnitude(self.low, "low"), magnitude(self.high, "high")
        number = float(f"{low + x * (high - low):.{_DIGITS}g}")
        return f"{number:g} {unit}" if unit else number

    def place(self, value: Any) -> float:
        """Inverse of `value`."""
        (low, _), (high, _) = magnitude(self.low, "low"), magnitude(self.high, "high")
        return (magnitude(value, "start")[0] - low) / (high - low)

    @property
    def first(self) -> float:
        """Place of the start."""
        return 0.5 if self.start is None else self.place(self.start)


class ChoiceWords(Words):
    """A choice of the case that is not known and has no in-between."""

    key: Text = Field(title="Key", description="Dotted key of a case")
    values: Annotated[tuple[Any, ...], entries_from(1)] = Field(
        title="Values", description="What it could be instead, as in a case file"
    )
    reason: Text = Field("", title="Reason", description="Why it is a question")


class TargetWords(Words):
    """A figure that the search fits."""

    case: Text = Field(title="Case", description="Name of the case")
    figure: Text = Field(title="Figure", description="Name of the figure, or id of a claim")
    value: Number = Field(title="Value", description="What it should be, in the figure's unit")
    scale: Annotated[Number, between(0.0, 1e12, open_low=True)] = Field(
        title="Scale", description="Deviation that counts as one"
    )
    readings: dict[str, Number] = Field(
        default_factory=dict,
        title="Readings",
        description="The value under other readings of the source, by name",
    )


class SearchWords(Words):
    """How the search goes about it."""

    evaluations: Annotated[Count, between(1, 10_000)] = Field(
        40, title="Evaluations", description="Most evaluations, those kept on disk included"
    )
    samples: Annotated[Count, between(0, 10_000)] = Field(
        0, title="Samples", description="Evaluations spread over the bounds before the search"
    )
    seed: Annotated[Count, between(0, 2**31)] = Field(
        1, title="Seed", description="Of the spread evaluations"
    )
    step: Annotated[Number, between(1e-4, 0.5)] = Field(
        0.15,
        title="Step",
        description="Step of the derivatives as a share of the bounds: beyond the meshes' noise",
    )


def _distinct(words: tuple[ParameterWords, ...]) -> tuple[ParameterWords, ...]:
    keys = [parameter.key for parameter in words]
    for number, key in enumerate(keys):
        if key in keys[:number]:
            raise wrong(f"{key} is there twice", "Name each key once", at=(number, "key"))
    return words


class Calibration(Words):
    """What is not known of some cases, and what is to be fitted. Made by `load`."""

    title: Text = Field("", title="Title", description="One line for people")
    cases: dict[str, Text] = Field(
        title="Cases",
        description="Case files by name, beside this file; the search computes those with a target",
    )
    common: dict[str, Any] = Field(
        default_factory=dict,
        title="Common",
        description="Changes of every evaluation: a coarse mesh, a narrow band",
    )
    fine: dict[str, Any] = Field(
        default_factory=dict,
        title="Fine",
        description="Changes that make an evaluation accurate; figures of the search are "
        "corrected by the ratio of both at the start",
    )
    sensitivities: dict[str, Any] = Field(
        default_factory=dict,
        title="Sensitivities",
        description="Changes of the runs for sensitivities, over those of every evaluation",
    )
    parameters: Annotated[
        tuple[ParameterWords, ...], AfterValidator(_distinct), entries_from(1)
    ] = Field(title="Parameters", description="Numbers that are not known")
    choices: tuple[ChoiceWords, ...] = Field(
        (), title="Choices", description="Choices that are not known, for the sensitivities"
    )
    targets: Annotated[tuple[TargetWords, ...], entries_from(1)] = Field(
        title="Targets", description="Figures that the search fits"
    )
    search: SearchWords = Field(SearchWords(), title="Search", description="Effort")

    _source: Source = PrivateAttr(default_factory=Source)

    @classmethod
    def load(cls, path: FilePath) -> Self:
        """Read a calibration file.

        Raises
        ------
        InvalidCaseError
            Lists every problem with file, line, key, value and remedy.
        """
        words, source = read_words(path, cls)
        words._source = source
        findings = [
            Finding(("targets", n, "case"), "is not a case", f"Known: {', '.join(words.cases)}")
            for n, target in enumerate(words.targets)
            if target.case not in words.cases
        ]
        if not any(parameter.search for parameter in words.parameters):
            findings.append(Finding(("parameters",), "the search has nothing to move"))
        if findings:
            raise InvalidCaseError(map(source.problem, findings))
        return words

    @property
    def fitted(self) -> tuple[str, ...]:
        """Cases that have a target."""
        return tuple(dict.fromkeys(target.case for target in self.targets))

    @property
    def readings(self) -> tuple[str, ...]:
        """Names of the other readings of the targets."""
        return tuple(dict.fromkeys(name for t in self.targets for name in t.readings))

    def base(self, name: str) -> Case:
        """Read a case and make the changes of every evaluation.

        Raises
        ------
        InvalidCaseError
            The case or the changes have problems.
        """
        case = Case.load(FilePath(self._source.file).parent / self.cases[name])
        return case.varied(flat(self.common))


def changed(case: Case, values: Mapping[str, Any]) -> Case:
    """Change values of a case, also single entries of lists of plain numbers (``film.span[0]``).

    Raises
    ------
    InvalidCaseError
        The changed case has problems, or a key does not name an entry of a list.
    """
    whole: dict[str, Any] = {}
    for key, value in values.items():
        found = _ENTRY.fullmatch(key)
        if found is None:
            whole[key] = value
            continue
        name, number = found[1], int(found[2])
        entries = whole.get(name) or _entries(case, name)
        if entries is None or number >= len(entries):
            fault = Problem(case.file, None, key, "", "is not an entry of a list", "Name the key")
            raise InvalidCaseError([fault])
        whole[name] = [*entries[:number], value, *entries[number + 1 :]]
    return case.varied(whole)


def _entries(case: Case, key: str) -> list[Any] | None:
    value: Any = case.plain()
    for name in key.split("."):
        value = value.get(name) if isinstance(value, dict) else None
    return value if isinstance(value, list) else None
