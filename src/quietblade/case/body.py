# SPDX-License-Identifier: LGPL-2.1-or-later
"""The study of a body that is no blade: so far a spherical shell, at rest and free in the water."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, ClassVar, Literal, Self, TypeAlias

import numpy as np
from pydantic import AfterValidator, BeforeValidator, Field, model_validator

from quietblade.card import Card
from quietblade.case import units
from quietblade.case.common import AnyCase
from quietblade.case.excitation import (
    Direction,
    ExcitationWords,
    ForceWords,
    PressureWords,
    distinct_names,
    listed,
)
from quietblade.case.fields import Length, Quantity, Text, Words, entries_from, one_of, wrong
from quietblade.case.source import Finding
from quietblade.case.tables import AcousticsWords, Configuration

BodyKind = Literal["spherical-shell"]

BLADE_TABLES = ("blade", "film", "root", "loads", "flow", "static", "campbell")
"""Tables that only a case of a blade has."""

_WHOLE = np.radians(179.0)


class BodyWords(Words):
    """A spherical shell about the origin, with nothing inside, free in the water."""

    kind: Annotated[BodyKind, one_of(BodyKind, "a kind of body")] = Field(
        title="Kind", description="Shape of the body"
    )
    radius: Length = Field(title="Radius", description="Outer radius")
    thickness: Length = Field(title="Thickness", description="Thickness of the wall")
    material: Text = Field(title="Material", description="Name of its material, isotropic")

    @model_validator(mode="after")
    def _check_wall(self) -> Self:
        if self.thickness >= self.radius:
            raise wrong(
                f"is not less than the radius of {1e3 * self.radius:g} mm",
                "Leave a hollow inside: a thinner wall",
                at=("thickness",),
            )
        return self


class CapWords(PressureWords):
    """Pressure on a cap of the sphere, pushing into it."""

    axis: Direction = Field(
        (0.0, 0.0, 1.0),
        title="Axis",
        description="From the centre of the body to that of the cap; its length does not matter",
    )
    half_angle: Annotated[float, Quantity(units.ANGLE, above=0.0, most=_WHOLE)] = Field(
        title="Half angle", description="Angle between the axis and the rim of the cap"
    )


class PointWords(ForceWords):
    """Force at a point of the sphere, in a fixed direction."""

    at: Direction = Field(
        title="At",
        description="From the centre of the body to the point; its length does not matter",
    )
    direction: Direction | None = Field(
        None,
        title="Direction",
        description="Along x, y and z; its length does not matter; towards the centre if not given",
    )


BodyExcitationWords: TypeAlias = CapWords | PointWords

BODY_EXCITATIONS: dict[str, type[BodyExcitationWords]] = {
    "pressure": CapWords,
    "point-force": PointWords,
}
"""Model of each kind of excitation of a body."""


def _apart(rows: tuple[BodyExcitationWords, ...]) -> tuple[BodyExcitationWords, ...]:
    caps = [(number, row) for number, row in enumerate(rows) if isinstance(row, CapWords)]
    for place, (number, row) in enumerate(caps):
        for other, before in caps[:place]:
            between = angle_between(row.axis, before.axis)
            if between <= row.half_angle + before.half_angle:
                raise wrong(
                    f"the cap touches that of excitation[{other}]",
                    "Leave a gap of some degrees between them",
                    at=(number, "half_angle"),
                )
    return rows


def angle_between(one: tuple[float, ...], other: tuple[float, ...]) -> float:
    """Angle between two directions [rad]."""
    a, b = (np.array(v) / np.linalg.norm(v) for v in (one, other))
    return float(2.0 * np.arctan2(np.linalg.norm(a - b), np.linalg.norm(a + b)))


def _at_rest(names: tuple[Configuration, ...]) -> tuple[Configuration, ...]:
    if names != ("C0",):
        raise wrong("has C1, and a body bears no steady load", 'Write ["C0"], or leave it out')
    return names


class BodyAcousticsWords(AcousticsWords):
    """Band and water sphere of the vibro-acoustic step of a body at rest."""

    configurations: Annotated[
        tuple[Annotated[Configuration, one_of(Configuration, "a configuration")], ...],
        AfterValidator(_at_rest),
        entries_from(1),
    ] = Field(("C0",), title="Configurations", description="At rest (C0)")

    @model_validator(mode="after")
    def _check_stream(self) -> Self:
        if self.flow_damping:
            raise wrong(
                "is of a blade in a stream, and the water around a body rests",
                "Leave it out",
                at=("flow_damping",),
            )
        return self


class BodyCase(AnyCase):
    """A study of a body that is no blade. Made by `load`, `parse` or `from_plain`; SI units."""

    main: ClassVar[str] = "body"
    excitations: ClassVar[Mapping[str, type[ExcitationWords]]] = BODY_EXCITATIONS

    body: BodyWords = Field(title="Body", description="Shape and material, in place of a blade's")
    acoustics: BodyAcousticsWords = Field(title="Acoustics", description="Vibration and sound")
    excitation: Annotated[
        tuple[Annotated[BodyExcitationWords, Field(discriminator="kind")], ...],
        AfterValidator(_apart),
        AfterValidator(distinct_names),
        BeforeValidator(listed),
    ] = Field(title="Excitation", description="What sets the body in motion: a table, or several")

    @model_validator(mode="after")
    def _check_transfer(self) -> Self:
        if self.transfer is not None and self.transfer.of_root:
            raise wrong(
                "asks for forces on a clamp, and a body is free",
                'Keep "mobility" and "power-per-force"',
                at=("transfer", "functions"),
            )
        return self

    @property
    def parts(self) -> tuple[str, ...]:
        """Parts that have a material."""
        return ("body",)

    @property
    def middle(self) -> tuple[float, float, float]:
        """Centre of the body, x, y, z [m]."""
        return 0.0, 0.0, 0.0

    def card(self) -> Card:
        """Body, band and loads in a few lines."""
        body, (low, high) = self.body, self.acoustics.band
        rows = (
            ("body", f"{body.kind}, radius {1e3 * body.radius:g} mm"),
            ("wall", f"{1e3 * body.thickness:g} mm of {body.material}"),
            ("excitation", ", ".join(words.kind for words in self.excitation)),
            ("band", f"{low:g} to {high:g} Hz in steps of {self.acoustics.step:g} Hz"),
            ("mesh size", f"{1e3 * self.mesh.size:g} mm"),
        )
        return Card(f"Case: {self.title or self.file}", rows)

    @classmethod
    def _strangers(cls, data: Mapping[str, Any]) -> Iterator[Finding]:
        if "body" not in data:
            if "blade" in data:
                fault = "describes a blade, which this cannot be done with"
                yield Finding(("blade",), fault, "Give a case file with [body]")
            return
        for table in BLADE_TABLES:
            if table in data and table != "blade":
                yield Finding((table,), "is of a blade, and this case has [body]", "Remove it")
        if "blade" in data:
            fault = "stands beside [body], and a file describes one of them"
            yield Finding(("blade",), fault, "Remove one of [blade] and [body]")
