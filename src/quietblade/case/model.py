# SPDX-License-Identifier: LGPL-2.1-or-later
"""The study as the user says it: one frozen object, in SI units, that knows where it came from."""

import copy
import hashlib
import json
from collections.abc import Iterator, Mapping
from dataclasses import replace
from os import PathLike
from pathlib import Path as FilePath
from typing import Annotated, Any, Self

from pydantic import Field, PrivateAttr, ValidationError, model_validator

from quietblade.card import Card, Shown
from quietblade.case.campbell import CampbellWords
from quietblade.case.changes import with_changes
from quietblade.case.excitation import Excitations, RootMotionWords, TransferWords
from quietblade.case.explain import explain, material_findings
from quietblade.case.far_field import BandsWords, FarFieldWords, LimitWords
from quietblade.case.fields import Count, Text, Words, between, wrong
from quietblade.case.flow import FlowWords
from quietblade.case.laminate import LaminateWords
from quietblade.case.library import library_material
from quietblade.case.loss import LossWords, loss_files
from quietblade.case.materials import MaterialWords, SolidWords
from quietblade.case.problems import InvalidCaseError, Path, dotted
from quietblade.case.source import Finding, Source, parse_source, read_source
from quietblade.case.structure import LoadWords, PressureLoadWords, RootWords
from quietblade.case.tables import (
    FILE,
    AcousticsWords,
    BladeWords,
    FilmWords,
    MeshWords,
    SolverWords,
    StaticWords,
    WaterWords,
)
from quietblade.case.versions import FORMAT, migrated

_KEY_DIGITS = 12


class Case(Shown, Words):
    """A study of one blade. Made by `load`, `parse` or `from_plain`; all values in SI units."""

    format: Annotated[Count, between(1, FORMAT)] = Field(
        FORMAT,
        title="Format",
        description="Format of the file, for later versions; the first if not given",
    )
    title: Text = Field("", title="Title", description="One line for people")
    blade: BladeWords = Field(title="Blade", description="Shape and material of the blade")
    film: FilmWords | None = Field(None, title="Film", description="Embedded viscoelastic film")
    materials: dict[str, MaterialWords] = Field(
        default_factory=dict, title="Materials", description="Materials by name"
    )
    root: RootWords = Field(RootWords(), title="Root", description="How the blade is held")
    loads: tuple[LoadWords, ...] = Field(
        (), title="Loads", description="Steady loads besides those of the flow"
    )
    water: WaterWords = Field(WaterWords(), title="Water", description="The water around")
    flow: FlowWords = Field(title="Flow", description="Steady operation")
    static: StaticWords = Field(
        StaticWords(), title="Static", description="Equilibrium of blade and flow"
    )
    acoustics: AcousticsWords = Field(title="Acoustics", description="Vibration and sound")
    excitation: Excitations = Field(
        title="Excitation", description="What sets the blade in motion: a table, or several"
    )
    transfer: TransferWords | None = Field(
        None, title="Transfer", description="Transfer functions beside the spectrum"
    )
    far_field: FarFieldWords = Field(
        FarFieldWords(), title="Far field", description="Directivity and pressure at points"
    )
    bands: BandsWords = Field(BandsWords(), title="Bands", description="Bands of the levels")
    limits: tuple[LimitWords, ...] = Field(
        (), title="Limits", description="Limits that the levels are held against"
    )
    campbell: CampbellWords | None = Field(
        None, title="Campbell diagram", description="Wet modes over the speed of the shaft"
    )
    mesh: MeshWords = Field(title="Mesh", description="Size of the elements")
    solver: SolverWords = Field(SolverWords(), title="Solver", description="Linear solver")

    _source: Source = PrivateAttr(default_factory=Source)

    @model_validator(mode="after")
    def _check_excitation(self) -> "Case":
        random = self.acoustics.signal == "random"
        for number, words in enumerate(self.excitation):
            at = ("excitation", number)
            if not random and words.density_value is not None:
                raise wrong(
                    "is the density of a random load, and the signal is harmonic",
                    f'Write {words.amplitude_key}, or signal = "random" in [acoustics]',
                    at=(*at, "density"),
                )
            if random and words.table is None and words.density_value is None:
                given = words.amplitude_value is not None
                raise wrong(
                    "is an amplitude, and the signal is random" if given else "has no density",
                    'Write density, or signal = "harmonic" in [acoustics]',
                    at=(*at, words.amplitude_key) if given else at,
                )
            if random and words.phase:
                raise wrong("means nothing for a random load", "Leave it out", at=(*at, "phase"))
        self._check_root()
        forces = [words for words in self.excitation if not isinstance(words, RootMotionWords)]
        if self.transfer is not None and self.transfer.shaft is not None and not forces:
            raise wrong(
                "takes power from forces on the blade, and there are none",
                "Add one to [[excitation]]",
                at=("transfer", "shaft"),
            )
        return self

    def _check_root(self) -> None:
        """On springs the root is free to move: nothing can be forced on it or read at a clamp."""
        if self.root.support == "clamped":
            return
        remedy = 'Write support = "clamped" in [root], and the springs as [transfer.shaft]'
        for number, words in enumerate(self.excitation):
            if isinstance(words, RootMotionWords):
                raise wrong(
                    "moves a root that stands on springs", remedy, at=("excitation", number, "kind")
                )
        if self.transfer is not None and self.transfer.of_root:
            raise wrong(
                "asks for forces on a clamp, and the root stands on springs",
                remedy,
                at=("transfer", "functions"),
            )

    @classmethod
    def load(cls, path: str | PathLike[str]) -> Self:
        """Read a case file.

        Raises
        ------
        InvalidCaseError
            Lists every problem with file, line, key, value and remedy.
        """
        return cls._build(read_source(FilePath(path)))

    @classmethod
    def parse(cls, text: str, name: str = "case.toml") -> Self:
        """Read the text of a case file; ``name`` stands for it in messages.

        Raises
        ------
        InvalidCaseError
            Lists every problem with file, line, key, value and remedy.
        """
        return cls._build(parse_source(text, name))

    @classmethod
    def from_plain(cls, data: Mapping[str, Any], name: str = "case") -> Self:
        """Make a case from what `plain` gave: bare numbers are SI values.

        Raises
        ------
        InvalidCaseError
            Lists every problem with key, value and remedy.
        """
        return cls._build(Source(name, data, si=True))

    def varied(self, changes: Mapping[str, Any]) -> Self:
        """Return the same case with other values, written as in a case file.

        Parameters
        ----------
        changes : mapping
            Dotted keys to values, for example ``{"mesh.size": "40 mm"}``.

        Raises
        ------
        InvalidCaseError
            The changed case has problems.
        """
        data: dict[str, Any] = copy.deepcopy(dict(self._source.data))
        lines = dict(self._source.lines)
        for key, value in changes.items():
            *tables, last = key.split(".")
            table = data
            for name in tables:
                inner = table.setdefault(name, {})
                if not isinstance(inner, dict):
                    fault = Finding(tuple(tables), "is not a table", f"It has no key {last}")
                    raise InvalidCaseError([self._source.problem(fault)])
                table = inner
            table[last] = value
            changed = (*tables, last)
            lines = {path: n for path, n in lines.items() if path[: len(changed)] != changed}
        text = with_changes(self._source.text, changes)
        return self._build(replace(self._source, data=data, lines=lines, text=text))

    @property
    def text(self) -> str:
        """The case file as it was read, or the case as JSON if it came from a program."""
        return self._source.text or json.dumps(self.plain(), indent=2)

    @property
    def file(self) -> str:
        """Name of the file that the case was read from."""
        return self._source.file

    @property
    def folder(self) -> FilePath:
        """Folder in which the files that the case names are looked for."""
        return FilePath(self._source.file).parent

    @property
    def files(self) -> Mapping[str, FilePath]:
        """Files that the case names, by key."""
        named = {}
        if self.blade.section.startswith(FILE):
            named["blade.section"] = self.blade.section.removeprefix(FILE).strip()
        for number, load in enumerate(self.loads):
            if isinstance(load, PressureLoadWords) and load.table is not None:
                named[f"loads[{number}].table"] = load.table
        for number, limit in enumerate(self.limits):
            if limit.table is not None:
                named[f"limits[{number}].table"] = limit.table
        for part in self.parts:
            for key, file in loss_files(self.loss(part)[1]):
                named[f"{part}.loss_factor.{key}"] = file
        for number, words in enumerate(self.excitation):
            if words.table is not None:
                named[f"excitation[{number}].table"] = words.table
        return {key: self.folder / name for key, name in named.items()}

    def plain(self) -> dict[str, Any]:
        """Return JSON-able data with SI values; `from_plain` reads it."""
        return self.model_dump(mode="json", exclude_none=True)

    def card(self) -> Card:
        """Blade, operation, band and loads in a few lines."""
        blade, film, flow = self.blade, self.film, self.flow
        low, high = self.acoustics.band
        layer = "none" if film is None else f"{1e3 * film.thickness:g} mm of {film.material}"
        rows = (
            ("blade", f"span {1e3 * blade.span:g} mm from radius {1e3 * blade.hub_radius:g} mm"),
            ("section", blade.section),
            ("material", blade.material),
            ("film", layer),
            ("flow", f"{flow.speed:g} m/s, shaft {flow.rotation:g} rad/s, inflow {flow.inflow}"),
            ("excitation", ", ".join(words.kind for words in self.excitation)),
            ("band", f"{low:g} to {high:g} Hz in steps of {self.acoustics.step:g} Hz"),
            ("configurations", ", ".join(self.acoustics.configurations)),
            ("mesh size", f"{1e3 * self.mesh.size:g} mm"),
        )
        return Card(f"Case: {self.title or self.file}", rows)

    def content_key(self) -> str:
        """Hash of everything that the result depends on; the same for the same physics."""
        text = json.dumps(self.physics(), sort_keys=True, separators=(",", ":"))
        return hashlib.sha256(text.encode()).hexdigest()

    def physics(self) -> dict[str, Any]:
        """Return everything that the result depends on, as JSON-able data with SI values.

        Titles, comments, the names of materials and materials that are not used do not matter,
        nor does the unit in which a value is written. Of the files that the case names, under
        "files", the content counts, not the name.
        """
        plain = self.plain()
        del plain["format"], plain["title"], plain["materials"], plain["blade"]["material"]
        plain["materials"] = {"blade": self._physics_of(self.material("blade"))}
        if self.film is not None:
            del plain["film"]["material"]
            plain["materials"]["film"] = self._physics_of(self.material("film"))
        plain["files"] = {
            key: hashlib.sha256(file.read_bytes()).hexdigest() if file.is_file() else ""
            for key, file in self.files.items()
        }
        rounded: dict[str, Any] = _rounded(plain)
        return rounded

    def material(self, part: str) -> SolidWords:
        """Material of a part, ``"blade"`` or ``"film"``, from the case or the library.

        Raises
        ------
        KeyError
            The case has no such part.
        """
        return self.named_material(self._material_name(part))

    @property
    def parts(self) -> tuple[str, ...]:
        """Parts that have a material."""
        return ("blade",) if self.film is None else ("blade", "film")

    def loss(self, part: str) -> tuple[Path, float | LossWords]:
        """Loss factor of a part, behind its key; of a laminate without one that of its first ply.

        Raises
        ------
        KeyError
            The case has no such part.
        """
        name = self._material_name(part)
        words = self.named_material(name)
        if isinstance(words, LaminateWords) and words.loss_factor is None:
            name = words.plies[0].material
            words = self.named_material(name)
        return ("materials", name, "loss_factor"), words.loss_factor or 0.0

    def named_material(self, name: str) -> SolidWords:
        """Material of a name, from the case or the library.

        Raises
        ------
        KeyError
            There is none.
        """
        own = self.materials.get(name)
        return own if own is not None else library_material(name)

    def _material_name(self, part: str) -> str:
        words = {"blade": self.blade, "film": self.film}[part]
        if words is None:
            raise KeyError(part)
        return words.material

    def _physics_of(self, words: SolidWords) -> dict[str, Any]:
        """Return what a material says, with the materials of its plies and without its source."""
        plain = words.model_dump(mode="json", exclude={"source"})
        if isinstance(words, LaminateWords):
            for ply in plain["plies"]:
                ply["material"] = self._physics_of(self.named_material(ply["material"]))
        return plain

    def invalid(self, *findings: Finding) -> InvalidCaseError:
        """Make the error that points at these findings in the file of this case."""
        return InvalidCaseError(map(self._source.problem, findings))

    @classmethod
    def _build(cls, source: Source) -> Self:
        source = migrated(source)
        findings = list(material_findings(source.data))
        try:
            case = cls.model_validate(source.data, context={"si": source.si})
        except ValidationError as error:
            findings.extend(explain(error, source.data, cls))
        else:
            findings.extend(_loss_findings(case) if not findings else ())
        if findings:
            raise InvalidCaseError(map(source.problem, findings))
        case._source = source
        return case


def _loss_findings(case: Case) -> Iterator[Finding]:
    """Refuse a model of the loss where the whole tangent has one factor."""
    if case.film is None or case.acoustics.loss != "paper":
        return
    path, loss = case.loss("film")
    if isinstance(loss, LossWords):
        yield Finding(
            ("acoustics", "loss"),
            f"gives the film's whole tangent one loss factor, and {dotted(path)} has a model",
            'Use loss = "isochoric", or a number for the loss factor',
        )


def _rounded(value: Any) -> Any:
    if isinstance(value, float):
        return float(f"{value:.{_KEY_DIGITS}g}")
    if isinstance(value, dict):
        return {key: _rounded(inner) for key, inner in value.items()}
    return [_rounded(inner) for inner in value] if isinstance(value, list) else value
