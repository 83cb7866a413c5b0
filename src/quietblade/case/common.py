# SPDX-License-Identifier: LGPL-2.1-or-later
"""What every case has, whatever it describes: one frozen object that knows where it came from."""

import copy
import hashlib
import json
from abc import abstractmethod
from collections.abc import Iterator, Mapping
from dataclasses import replace
from os import PathLike
from pathlib import Path as FilePath
from typing import Annotated, Any, ClassVar, Self

from pydantic import Field, PrivateAttr, ValidationError, model_validator

from quietblade.card import Shown
from quietblade.case.changes import with_changes
from quietblade.case.excitation import ExcitationWords, TransferWords
from quietblade.case.explain import explain, material_findings
from quietblade.case.far_field import BandsWords, FarFieldWords, LimitWords
from quietblade.case.fields import Count, Text, Words, between, wrong
from quietblade.case.laminate import LaminateWords
from quietblade.case.library import library_material
from quietblade.case.loss import LossWords, loss_files
from quietblade.case.materials import MaterialWords, SolidWords
from quietblade.case.problems import InvalidCaseError, Path
from quietblade.case.source import Finding, Source, parse_source, read_source
from quietblade.case.tables import AcousticsWords, MeshWords, SolverWords, WaterWords
from quietblade.case.versions import FORMAT, migrated

_KEY_DIGITS = 12


class AnyCase(Shown, Words):
    """What a case of a blade and one of another body have in common; values in SI units."""

    main: ClassVar[str]
    """Table that says what the case is of."""
    excitations: ClassVar[Mapping[str, type[ExcitationWords]]]
    """Model of each kind of excitation."""

    format: Annotated[Count, between(1, FORMAT)] = Field(
        FORMAT,
        title="Format",
        description="Format of the file, for later versions; the first if not given",
    )
    title: Text = Field("", title="Title", description="One line for people")
    materials: dict[str, MaterialWords] = Field(
        default_factory=dict, title="Materials", description="Materials by name"
    )
    water: WaterWords = Field(WaterWords(), title="Water", description="The water around")
    acoustics: AcousticsWords = Field(title="Acoustics", description="Vibration and sound")
    excitation: tuple[ExcitationWords, ...] = Field(
        title="Excitation", description="What sets it in motion: a table, or several"
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
    mesh: MeshWords = Field(title="Mesh", description="Size of the elements")
    solver: SolverWords = Field(SolverWords(), title="Solver", description="Linear solver")

    _source: Source = PrivateAttr(default_factory=Source)

    @model_validator(mode="after")
    def _check_excitation(self) -> Self:
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
        return self

    @classmethod
    def load(cls, path: str | PathLike[str]) -> Self:
        """Read a case file.

        Raises
        ------
        InvalidCaseError
            Lists every problem with file, line, key, value and remedy.
        """
        return cls.from_source(read_source(FilePath(path)))

    @classmethod
    def parse(cls, text: str, name: str = "case.toml") -> Self:
        """Read the text of a case file; ``name`` stands for it in messages.

        Raises
        ------
        InvalidCaseError
            Lists every problem with file, line, key, value and remedy.
        """
        return cls.from_source(parse_source(text, name))

    @classmethod
    def from_plain(cls, data: Mapping[str, Any], name: str = "case") -> Self:
        """Make a case from what `plain` gave: bare numbers are SI values.

        Raises
        ------
        InvalidCaseError
            Lists every problem with key, value and remedy.
        """
        return cls.from_source(Source(name, data, si=True))

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
        return self.from_source(replace(self._source, data=data, lines=lines, text=text))

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
        return {key: self.folder / name for key, name in self._named_files()}

    def _named_files(self) -> Iterator[tuple[str, str]]:
        for number, limit in enumerate(self.limits):
            if limit.table is not None:
                yield f"limits[{number}].table", limit.table
        for part in self.parts:
            for key, file in loss_files(self.loss(part)[1]):
                yield f"{part}.loss_factor.{key}", file
        for number, words in enumerate(self.excitation):
            if words.table is not None:
                yield f"excitation[{number}].table", words.table

    def plain(self) -> dict[str, Any]:
        """Return JSON-able data with SI values; `from_plain` reads it."""
        return self.model_dump(mode="json", exclude_none=True)

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
        del plain["format"], plain["title"], plain["materials"]
        plain["materials"] = {}
        for part in self.parts:
            del plain[part]["material"]
            plain["materials"][part] = self._physics_of(self.material(part))
        plain["files"] = {key: _digest(file) for key, file in self.files.items()}
        rounded: dict[str, Any] = _rounded(plain)
        return rounded

    @property
    @abstractmethod
    def parts(self) -> tuple[str, ...]:
        """Parts that have a material: solid regions of the mesh, and tables of the case."""

    @property
    @abstractmethod
    def middle(self) -> tuple[float, float, float]:
        """Centre of the water sphere if the case gives none, x, y, z [m]."""

    def material_name(self, part: str) -> str:
        """Name of the material of a part.

        Raises
        ------
        KeyError
            The case has no such part.
        """
        if part not in self.parts:
            raise KeyError(part)
        name: str = getattr(self, part).material
        return name

    def material(self, part: str) -> SolidWords:
        """Material of a part, such as ``"blade"``, from the case or the library.

        Raises
        ------
        KeyError
            The case has no such part.
        """
        return self.named_material(self.material_name(part))

    def loss(self, part: str) -> tuple[Path, float | LossWords]:
        """Loss factor of a part, behind its key; of a laminate without one that of its first ply.

        Raises
        ------
        KeyError
            The case has no such part.
        """
        name = self.material_name(part)
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
    def from_source(cls, source: Source) -> Self:
        """Make a case of what stands in a file.

        Raises
        ------
        InvalidCaseError
            Lists every problem with file, line, key, value and remedy.
        """
        source = migrated(source)
        strange = list(cls._strangers(source.data))
        if strange and cls.main not in source.data:
            raise InvalidCaseError(map(source.problem, strange))
        own = {key: v for key, v in source.data.items() if key not in {f.path[0] for f in strange}}
        findings = [*strange, *material_findings(source.data)]
        try:
            case = cls.model_validate(own, context={"si": source.si})
        except ValidationError as error:
            findings.extend(explain(error, source.data, cls))
        else:
            findings.extend(case._together() if not findings else ())
        if findings:
            raise InvalidCaseError(map(source.problem, findings))
        case._source = source
        return case

    @classmethod
    def _strangers(cls, data: Mapping[str, Any]) -> Iterator[Finding]:
        """Refuse tables that belong to a case of another kind."""
        del data
        return iter(())

    def _together(self) -> Iterator[Finding]:
        """Refuse what a material or a file makes wrong, though each table is right."""
        return iter(())


def _digest(file: FilePath) -> str:
    """Hash of a file's content; empty if it cannot be read, which is told where it is used."""
    try:
        return hashlib.sha256(file.read_bytes()).hexdigest()
    except (OSError, ValueError):  # ValueError: no name of a file at all
        return ""


def _rounded(value: Any) -> Any:
    if isinstance(value, float):
        return float(f"{value:.{_KEY_DIGITS}g}")
    if isinstance(value, dict):
        return {key: _rounded(inner) for key, inner in value.items()}
    return [_rounded(inner) for inner in value] if isinstance(value, list) else value
