# SPDX-License-Identifier: LGPL-2.1-or-later
"""The study of a blade as the user says it, in SI units."""

from collections.abc import Iterator, Mapping
from typing import Any, ClassVar, Self

from pydantic import Field, model_validator

from quietblade.card import Card
from quietblade.case.campbell import CampbellWords
from quietblade.case.common import AnyCase
from quietblade.case.excitation import (
    EXCITATIONS,
    Excitations,
    ExcitationWords,
    RootMotionWords,
)
from quietblade.case.fields import wrong
from quietblade.case.flow import FlowWords
from quietblade.case.loss import LossWords
from quietblade.case.problems import dotted
from quietblade.case.source import Finding
from quietblade.case.structure import LoadWords, PressureLoadWords, RootWords
from quietblade.case.tables import FILE, BladeWords, FilmWords, StaticWords


class Case(AnyCase):
    """A study of one blade. Made by `load`, `parse` or `from_plain`; all values in SI units."""

    main: ClassVar[str] = "blade"
    excitations: ClassVar[Mapping[str, type[ExcitationWords]]] = EXCITATIONS

    blade: BladeWords = Field(title="Blade", description="Shape and material of the blade")
    film: FilmWords | None = Field(None, title="Film", description="Embedded viscoelastic film")
    root: RootWords = Field(RootWords(), title="Root", description="How the blade is held")
    loads: tuple[LoadWords, ...] = Field(
        (), title="Loads", description="Steady loads besides those of the flow"
    )
    flow: FlowWords = Field(title="Flow", description="Steady operation")
    static: StaticWords = Field(
        StaticWords(), title="Static", description="Equilibrium of blade and flow"
    )
    excitation: Excitations = Field(
        title="Excitation", description="What sets the blade in motion: a table, or several"
    )
    campbell: CampbellWords | None = Field(
        None, title="Campbell diagram", description="Wet modes over the speed of the shaft"
    )

    @model_validator(mode="after")
    def _check_blade(self) -> Self:
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

    @property
    def parts(self) -> tuple[str, ...]:
        """Parts that have a material."""
        return ("blade",) if self.film is None else ("blade", "film")

    @property
    def middle(self) -> tuple[float, float, float]:
        """Middle of the span on the reference line, x, y, z [m]."""
        return 0.0, 0.0, self.blade.hub_radius + 0.5 * self.blade.span

    def _named_files(self) -> Iterator[tuple[str, str]]:
        if self.blade.section.startswith(FILE):
            yield "blade.section", self.blade.section.removeprefix(FILE).strip()
        for number, load in enumerate(self.loads):
            if isinstance(load, PressureLoadWords) and load.table is not None:
                yield f"loads[{number}].table", load.table
        yield from super()._named_files()

    @classmethod
    def _strangers(cls, data: Mapping[str, Any]) -> Iterator[Finding]:
        if "body" not in data:
            return
        if "blade" in data:
            fault = "stands beside [blade], and a file describes one of them"
            yield Finding(("body",), fault, "Remove one of [blade] and [body]")
        else:
            fault = "describes another body than a blade, which this cannot be done with"
            yield Finding(("body",), fault, "Give a case file with [blade]")

    def _together(self) -> Iterator[Finding]:
        """Refuse a model of the loss where the whole tangent has one factor."""
        if self.film is None or self.acoustics.loss != "paper":
            return
        path, loss = self.loss("film")
        if isinstance(loss, LossWords):
            yield Finding(
                ("acoustics", "loss"),
                f"gives the film's whole tangent one loss factor, and {dotted(path)} has a model",
                'Use loss = "isochoric", or a number for the loss factor',
            )
