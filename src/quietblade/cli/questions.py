# SPDX-License-Identifier: LGPL-2.1-or-later
"""The questions of ``quietblade new`` at a terminal: from a preset to a case of one's own."""

import tomllib
from collections.abc import Iterable, Mapping
from copy import deepcopy
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import typer

from quietblade.case import Case, InvalidCaseError
from quietblade.case.library import LAW_OF
from quietblade.case.materials import BLADE_LAWS, FILM_LAWS
from quietblade.case.presets import BLADES, PRESETS, preset_text
from quietblade.case.problems import Problem
from quietblade.case.units import FREQUENCY, LENGTH, read_quantity
from quietblade.case.writing import case_text
from quietblade.cli.common import console, error_console
from quietblade.cli.files import case_path
from quietblade.errors import CaseError
from quietblade.study.preflight import preflight

Form = Literal["one", "range", "ends"]


@dataclass(frozen=True)
class Question:
    """A key of the case, and how to ask for it.

    Attributes
    ----------
    key : str
        Dotted key.
    text : str
        What is asked for.
    form : {"one", "range", "ends"}
        One answer; the two ends of a range; or the values of a function of the span at root and
        tip.
    number : bool
        The value is a plain number, or a percentage.
    scaled : bool
        A length whose default goes with the span.
    """

    key: str
    text: str
    form: Form = "one"
    number: bool = False
    scaled: bool = False

    @property
    def parts(self) -> tuple[str, ...]:
        """What is asked for, one prompt each."""
        ends = {"one": ("",), "range": (", from", ", to"), "ends": (" at the root", " at the tip")}
        return tuple(self.text + end for end in ends[self.form])

    def defaults(self, value: Any) -> list[Any]:
        """Return the defaults of the parts from what the case says."""
        if self.form == "one":
            return [value]
        if self.form == "range":
            return list(value)
        return [value["values"][0], value["values"][-1]] if isinstance(value, dict) else [value] * 2

    def value(self, parts: list[Any]) -> Any:
        """Return what the case is to say from the answers."""
        if self.form == "one":
            return parts[0]
        if self.form == "range":
            return parts
        return parts[0] if parts[0] == parts[1] else {"s": [0, 1], "values": parts}


BLADE = (
    Question("title", "Title"),
    Question("blade.span", "Span, from the root to the tip"),
    Question("blade.hub_radius", "Radius of the root from the rotor axis"),
    Question("blade.chord", "Chord", "ends"),
    Question("blade.section", "Family of the sections"),
    Question("blade.thickness", "Thickness over chord", "ends", number=True),
    Question("blade.blade_angle", "Angle of the chord from the rotor axis", "ends"),
    Question("blade.material", "Material of the blade"),
)
FILM = (
    Question("film.span", "Span fractions of the film (0 root, 1 tip)", "range", number=True),
    Question("film.chord", "Chord fractions of the film", "range", number=True),
    Question("film.thickness", "Thickness of the film", scaled=True),
    Question("film.material", "Material of the film"),
)
OPERATION = (
    Question("flow.speed", "Speed of the water along the rotor axis"),
    Question("flow.rotation", "Rate of rotation (0 rad/s: a fixed foil)"),
    Question("acoustics.band", "Band of frequencies", "range"),
    Question("mesh.size", "Size of the elements on the blade", scaled=True),
)
IF_WRONG = (
    Question("acoustics.sphere_radius", "Radius of the water sphere", scaled=True),
    Question("acoustics.gap", "Least distance of the blade from it", scaled=True),
)
"""Asked only if what goes with the span does not do."""

_NEW_FILM = {
    "span": [0.1, 0.9],
    "chord": [0.2, 0.7],
    "thickness": "0.5 mm",
    "material": "viscoelastic-paper",
}


def ask_case(name: str | None, preset: str | None, *, force: bool) -> tuple[Path, str]:
    """Ask for the main values of a case, and return its path and text.

    Parameters
    ----------
    name, preset : str or None
        Name of the case and the preset to start from; asked for if they are not given.
    force : bool
        A file of that name may be replaced.
    """
    console.print("Enter keeps what stands in brackets. Units are yours: 250 mm, 8 deg, 60 rpm.")
    path = case_path(name, force=force) if name else _ask_path(force)
    if preset is None:
        for known in BLADES:
            console.print(f"  {known}: {PRESETS[known]}", markup=False)
        preset = _ask_until("Start from", BLADES[0], _of_blade)
    _of_blade(preset)
    start = tomllib.loads(preset_text(preset))
    data = deepcopy(start)
    data["title"] = path.stem
    _ask(BLADE[:2], data)
    _scale(data, start)
    console.print(f"  materials: {', '.join(_materials(data, BLADE_LAWS))}", markup=False)
    _ask(BLADE[2:], data)
    if typer.confirm("A viscoelastic film in the blade?", default="film" in data):
        data.setdefault("film", deepcopy(_NEW_FILM))
        console.print(f"  materials: {', '.join(_materials(data, FILM_LAWS))}", markup=False)
        _ask(FILM, data)
    else:
        data.pop("film", None)
    _ask(OPERATION, data)
    _drop_unused_materials(data)
    _fit_step(data, start)
    about = f'Written by "quietblade new" from answers, starting from the preset {preset}.'
    return path, _possible(data, about)


def _of_blade(preset: str) -> str:
    text = preset_text(preset)
    if preset not in BLADES:
        raise CaseError(f'the questions are about blades, and "{preset}" is none: leave out --ask')
    return text


def _possible(data: dict[str, Any], about: str) -> str:
    """Ask again until the case as a whole is possible, and write it."""
    while True:
        text = case_text(data, about)
        try:
            preflight(Case.parse(text, "answers"))
        except InvalidCaseError as error:
            again = [
                question
                for question in (*BLADE, *FILM, *OPERATION, *IF_WRONG)
                if any(_concerns(problem, question) for problem in error.problems)
            ]
            if not again:
                raise
            _show(error.problems)
            _ask(again, data)
        else:
            return text


def _ask(questions: Iterable[Question], data: dict[str, Any]) -> None:
    """Ask, and ask again what the words of the case refuse; keep the answers in the data."""
    for question in questions:
        table, key = _place(data, question.key)
        while True:
            before = table.get(key)
            defaults = question.defaults(before)
            answers = [
                _answer(question, text, default)
                for text, default in zip(question.parts, defaults, strict=True)
            ]
            if answers != defaults:
                table[key] = question.value(answers)
            problems = [p for p in _problems(data) if _concerns(p, question)]
            if not problems:
                break
            _show(problems)
            table[key] = before


def _answer(question: Question, text: str, default: Any) -> Any:
    said = str(typer.prompt(text, default=str(default))).strip().strip("\"'")
    if said == str(default):
        return default
    if question.number:
        try:
            return float(said)
        except ValueError:
            return said
    return said


def _ask_until(text: str, default: str | None, read: Any) -> str:
    while True:
        said = str(typer.prompt(text, default=default)).strip()
        try:
            read(said)
        except CaseError as error:
            error_console.print(f"  {error}", markup=False, soft_wrap=True)
        else:
            return said


def _ask_path(force: bool) -> Path:
    said = _ask_until("Name of the case", "my-blade", lambda name: case_path(name, force=force))
    return case_path(said, force=force)


def _place(data: dict[str, Any], key: str) -> tuple[dict[str, Any], str]:
    *tables, last = key.split(".")
    for table in tables:
        data = data[table]
    return data, last


def _problems(data: Mapping[str, Any]) -> tuple[Problem, ...]:
    try:
        Case.parse(case_text(data), "answers")
    except InvalidCaseError as error:
        return error.problems
    return ()


def _concerns(problem: Problem, question: Question) -> bool:
    rest = problem.key.removeprefix(question.key)
    return problem.key.startswith(question.key) and rest[:1] in ("", ".", "[")


def _show(problems: Iterable[Problem]) -> None:
    for problem in problems:
        said = f"{problem.value}: {problem.message}" if problem.value else problem.message
        error_console.print(f"  {said}. {problem.remedy}", markup=False, soft_wrap=True)


def _materials(data: Mapping[str, Any], laws: tuple[str, ...]) -> list[str]:
    own = {name: words["law"] for name, words in data.get("materials", {}).items()}
    return [name for name, law in {**own, **LAW_OF}.items() if law in laws]


def _drop_unused_materials(data: dict[str, Any]) -> None:
    used = {data[part]["material"] for part in ("blade", "film") if part in data}
    kept = {name: words for name, words in data.get("materials", {}).items() if name in used}
    data.pop("materials", None)
    if kept:
        data["materials"] = kept


def _scale(data: dict[str, Any], start: Mapping[str, Any]) -> None:
    """Let the lengths that go with the blade's size go with its span."""
    span, before = (read_quantity(words["blade"]["span"], LENGTH) for words in (data, start))
    if span == before:
        return
    ratio = span / before
    scaled = [q.key for q in (*FILM, *OPERATION, *IF_WRONG) if q.scaled]
    for key in scaled:
        if key.split(".")[0] in data:
            table, last = _place(data, key)
            table[last] = f"{1e3 * ratio * read_quantity(table[last], LENGTH):.3g} mm"


def _fit_step(data: dict[str, Any], start: Mapping[str, Any]) -> None:
    """Keep the number of base frequencies where the band is another."""
    new, old = (words["acoustics"]["band"] for words in (data, start))
    if new == old:
        return
    (low, high), (old_low, old_high) = (
        [read_quantity(end, FREQUENCY) for end in band] for band in (new, old)
    )
    step = read_quantity(start["acoustics"]["step"], FREQUENCY)
    data["acoustics"]["step"] = f"{step * (high - low) / (old_high - old_low):.3g} Hz"
