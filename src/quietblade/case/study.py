# SPDX-License-Identifier: LGPL-2.1-or-later
"""A study as the user says it: base cases, variants of them, and what to tabulate."""

import re
from collections.abc import Mapping
from itertools import product
from pathlib import Path as FilePath
from typing import Annotated, Any, Self, TypeVar

from pydantic import AfterValidator, Field, PrivateAttr, ValidationError

from quietblade.case import AnyCase, load_case
from quietblade.case.explain import explain
from quietblade.case.fields import Text, Words, entries_from, wrong
from quietblade.case.problems import InvalidCaseError, Path, Problem, shown, suggestion
from quietblade.case.source import Finding, Source, read_source

Changes = Mapping[str, Any]
"""Dotted keys of a case to values as a case file writes them."""

_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9._+-]*")
_DEEP = {"materials"}  # tables whose entries are tables
_MOST_RUNS = 1000

AnyWords = TypeVar("AnyWords", bound=Words)


def read_words(path: FilePath, model: type[AnyWords]) -> tuple[AnyWords, Source]:
    """Read a file of words that is not a case.

    Raises
    ------
    InvalidCaseError
        Lists every problem with file, line, key, value and remedy.
    """
    source = read_source(path)
    try:
        return model.model_validate(source.data, context={"si": False}), source
    except ValidationError as error:
        findings = explain(error, source.data, model)
        raise InvalidCaseError(map(source.problem, findings)) from error


def flat(changes: Mapping[str, Any]) -> dict[str, Any]:
    """Dotted keys of changes that were written as tables; quoted dotted keys stay as they are."""
    found: dict[str, Any] = {}
    for table, inner in changes.items():
        if "." in table or not isinstance(inner, Mapping):
            found[table] = inner
            continue
        for key, value in inner.items():
            if table in _DEEP and isinstance(value, Mapping):
                found.update({f"{table}.{key}.{last}": v for last, v in value.items()})
            else:
                found[f"{table}.{key}"] = value
    return found


def _named(tables: dict[str, Any]) -> dict[str, Any]:
    for name in tables:
        if not _NAME.fullmatch(name):
            raise wrong(
                "is the name of a folder too",
                "Use letters, digits and . _ + -, and begin with a letter or a digit",
                at=(name,),
            )
    return tables


def _some(tables: dict[str, Any]) -> dict[str, Any]:
    if not tables:
        raise wrong("is empty", 'Name a case file, for example blade = "blade.toml"')
    return tables


def _lists(tables: dict[str, Any]) -> dict[str, Any]:
    for key, values in flat(tables).items():
        if not isinstance(values, list) or not values:
            raise wrong(f"{key} needs a list of values", f'Write "{key}" = [value, value]')
    return tables


class ConvergenceWords(Words):
    """Variants that differ in the mesh only, for the grid convergence index."""

    variants: Annotated[tuple[Text, ...], entries_from(3)] = Field(
        title="Variants", description="Three or more variants, the finest first"
    )


class ClaimsWords(Words):
    """Table of the paper's claims, for cases that stand for its blades."""

    variants: Annotated[tuple[Text, ...], entries_from(1)] = Field(
        title="Variants", description="Variants that get a column"
    )


class Study(Words):
    """Base cases and their variants. Made by `load`."""

    title: Text = Field("", title="Title", description="One line for people")
    cases: Annotated[dict[str, Text], AfterValidator(_named), AfterValidator(_some)] = Field(
        title="Cases", description="Case files by name, beside the study file"
    )
    common: dict[str, Any] = Field(
        default_factory=dict, title="Common", description="Changes that every run gets"
    )
    variants: Annotated[dict[str, dict[str, Any]], AfterValidator(_named)] = Field(
        default_factory=dict,
        title="Variants",
        description="Changes by name of the variant, keys as in a case file",
    )
    vary: Annotated[dict[str, Any], AfterValidator(_lists)] = Field(
        default_factory=dict,
        title="Vary",
        description="Lists of values by key; every combination of them is a variant more",
    )
    figures: tuple[Text, ...] = Field(
        (), title="Figures", description="Figures of the printed table; some chosen ones if empty"
    )
    convergence: ConvergenceWords | None = Field(
        None, title="Convergence", description="Numerical uncertainty from several meshes"
    )
    claims: ClaimsWords | None = Field(
        None, title="Claims", description="Table of the paper's claims"
    )

    _source: Source = PrivateAttr(default_factory=Source)

    @classmethod
    def load(cls, path: FilePath) -> Self:
        """Read a study file.

        Raises
        ------
        InvalidCaseError
            Lists every problem with file, line, key, value and remedy.
        """
        study, source = read_words(path, cls)
        study._source = source
        findings = list(study._findings())
        if findings:
            raise InvalidCaseError(map(source.problem, findings))
        return study

    @property
    def file(self) -> str:
        """Name of the study file."""
        return self._source.file

    @property
    def text(self) -> str:
        """The study file as it was read."""
        return self._source.text

    def all_variants(self) -> dict[str, dict[str, Any]]:
        """Return the changes of every variant by name, those of the grid of `vary` too."""
        found = {name: flat(changes) for name, changes in self.variants.items()}
        grid = flat(self.vary)
        if grid:
            for values in product(*grid.values()):
                changes = dict(zip(grid, values, strict=True))
                found[_grid_name(changes)] = changes
        return found or {"base": {}}

    def base(self, name: str) -> AnyCase:
        """Read a base case, before any change.

        Raises
        ------
        InvalidCaseError
            The case file has problems.
        """
        return load_case(FilePath(self.file).parent / self.cases[name])

    def changed(self, case: AnyCase, variant: str) -> AnyCase:
        """Make a variant of a base case.

        Raises
        ------
        InvalidCaseError
            The changes have problems; they are told of the study file.
        """
        own = self.all_variants()[variant]
        try:
            return case.varied({**flat(self.common), **own})
        except InvalidCaseError as error:
            raise InvalidCaseError(self._problem(p, variant) for p in error.problems) from error

    def _problem(self, problem: Problem, variant: str) -> Problem:
        """Point a problem of a changed case at the line of the study file that changed it."""
        places: list[tuple[Path, str]] = [
            *(((*start, key), key) for start, key in self._keys(variant))
        ]
        for path, key in places:
            if problem.key == key or problem.key.startswith((f"{key}.", f"{key}[")):
                line = self._source.line(path) or self._source.line((*path[:-1], *key.split(".")))
                text = f"variant {variant}: {problem.message}"
                return Problem(self.file, line, key, problem.value, text, problem.remedy)
        return problem

    def _keys(self, variant: str) -> list[tuple[Path, str]]:
        start: Path = ("variants", variant) if variant in self.variants else ("vary",)
        own = [(start, key) for key in self.all_variants()[variant]]
        return [*own, *((("common",), key) for key in flat(self.common))]

    def _findings(self) -> list[Finding]:
        known = self.all_variants()
        findings = []
        for table, words in (("convergence", self.convergence), ("claims", self.claims)):
            for number, name in enumerate(words.variants if words is not None else ()):
                if name not in known:
                    near = suggestion(name, known)
                    remedy = f"{near} Known: {', '.join(known)}".strip()
                    path: Path = (table, "variants", number)
                    findings.append(Finding(path, "is not a variant", remedy))
        runs = len(known) * len(self.cases)
        if runs > _MOST_RUNS:
            findings.append(
                Finding(("vary",), f"makes {runs} runs", f"Vary less: at most {_MOST_RUNS} runs")
            )
        return findings


def _grid_name(changes: Mapping[str, Any]) -> str:
    """Name a combination: last word of each key and its value, fit for a folder."""
    parts = [f"{key.split('.')[-1]}-{_slug(value)}" for key, value in changes.items()]
    return "+".join(parts)


def _slug(value: Any) -> str:
    return re.sub(r"[^A-Za-z0-9.]+", "-", shown(value)).strip("-")
