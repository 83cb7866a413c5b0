# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is asked about the sound far away: directivity, points, bands and limits."""

from itertools import pairwise
from typing import Annotated, Literal

from pydantic import AfterValidator, Field, model_validator

from quietblade.case.fields import (
    Frequency,
    Length,
    Level,
    Point,
    Text,
    Words,
    entries_from,
    one_of,
    wrong,
)

BandKind = Literal["decidecade", "third-octave"]
Plane = Literal["xy", "xz", "yz"]
LimitQuantity = Literal["sound-power", "source-level"]
LimitBands = Literal["narrow", "decidecade", "third-octave"]


def _once(planes: tuple[Plane, ...]) -> tuple[Plane, ...]:
    if len(set(planes)) < len(planes):
        raise wrong("names a plane twice", 'Write ["xy", "xz", "yz"]')
    return planes


class BandsWords(Words):
    """Frequency bands in which the levels are told beside the narrow band."""

    kind: Annotated[BandKind, one_of(BandKind, "a kind of bands")] = Field(
        "decidecade",
        title="Kind",
        description="Tenths of a decade (IEC 61260-1, base ten), or third octaves in base two",
    )


class FarFieldWords(Words):
    """Directivity and sound pressure away from the blade, in the blade's axes."""

    frequencies: tuple[Frequency, ...] = Field(
        (),
        title="Frequencies",
        description="Frequencies of the band at which the directivity is told besides the peaks",
    )
    distance: Length | None = Field(
        None,
        title="Distance",
        description="Distance of the directivity from the centre of the sphere; far away if not "
        "given",
    )
    planes: Annotated[
        tuple[Annotated[Plane, one_of(Plane, "a plane")], ...],
        AfterValidator(_once),
        entries_from(1),
    ] = Field(
        ("xy", "xz", "yz"),
        title="Planes",
        description="Planes of the polar diagrams through the centre of the sphere; the angle goes "
        "from the first axis to the second",
    )
    points: tuple[Point, ...] = Field(
        (),
        title="Points",
        description="Places x, y, z in the water at which the sound pressure is told",
    )


class LimitWords(Words):
    """A limit that is laid over the levels: a file, or frequencies with their levels."""

    name: Text = Field(title="Name", description="Name in pictures and tables")
    quantity: Annotated[LimitQuantity, one_of(LimitQuantity, "a quantity with limits")] = Field(
        "sound-power",
        title="Quantity",
        description="Sound power (dB re 1 pW) or source level (dB re 1 uPa m)",
    )
    bands: Annotated[LimitBands, one_of(LimitBands, "a kind of bands")] = Field(
        "narrow",
        title="Bands",
        description="Whether it is for each frequency (narrow) or for the level of a band",
    )
    frequencies: tuple[Frequency, ...] = Field(
        (), title="Frequencies", description="Ascending; in between the limit is straight over lg f"
    )
    levels: tuple[Level, ...] = Field((), title="Levels", description="Level at each frequency")
    table: Text | None = Field(
        None,
        title="Table",
        description="File beside the case file instead: columns frequency, level (Hz and dB), "
        "separated by commas, with a header",
    )

    @model_validator(mode="after")
    def _check_table(self) -> "LimitWords":
        inline = bool(self.frequencies or self.levels)
        if inline == (self.table is not None):
            raise wrong(
                "needs either frequencies with levels or a table",
                'Write frequencies = ["100 Hz", "1 kHz"] and levels = ["120 dB", "110 dB"], or '
                'table = "limit.csv"',
            )
        if len(self.frequencies) != len(self.levels):
            raise wrong(
                f"has {len(self.levels)} levels for {len(self.frequencies)} frequencies",
                "Write one level for each frequency",
                at=("levels",),
            )
        if any(a >= b for a, b in pairwise(self.frequencies)):
            raise wrong(
                "does not ascend", "Write the frequencies in ascending order", at=("frequencies",)
            )
        return self
