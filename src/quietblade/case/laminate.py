# SPDX-License-Identifier: LGPL-2.1-or-later
"""Laminates as a case file says them."""

from typing import Annotated, Literal

from pydantic import Field, WithJsonSchema, model_validator

from quietblade.case import units
from quietblade.case.fields import (
    Angle,
    Count,
    Length,
    Quantity,
    Text,
    Words,
    between,
    entries_from,
    one_of,
    one_table_of,
    wrong,
)
from quietblade.case.loss import STRUCTURAL_LOSS, LossValue

LaminateModel = Literal["homogenised", "plies"]
Drape = Literal["symmetric", "through"]


class PlyWords(Words):
    """One ply of a laminate."""

    material: Text = Field(
        title="Material", description="Name of an isotropic or orthotropic material"
    )
    angle: Angle = Field(
        title="Angle",
        description="Angle from the span to axis 1 of the ply, positive towards the trailing edge",
    )
    thickness: Length | None = Field(None, title="Thickness", description="Thickness of the ply")
    fraction: Annotated[float, Quantity(units.FRACTION, above=0.0, most=1.0)] | None = Field(
        None, title="Fraction", description="Share of the stack's thickness"
    )

    @model_validator(mode="after")
    def _check_one(self) -> "PlyWords":
        if (self.thickness is None) == (self.fraction is None):
            raise wrong(
                "a ply needs either a thickness or a fraction",
                'Write thickness = "0.25 mm" or fraction = 0.125',
            )
        return self


class LaminateWords(Words):
    """Stack of plies, draped through the thickness of the blade."""

    law: Literal["laminate"] = Field(title="Law", description="Stack of plies")
    model: Annotated[LaminateModel, one_of(LaminateModel, "a model of a laminate")] = Field(
        title="Model",
        description="One effective solid for many repeats (homogenised), or each ply in its place",
    )
    drape: Annotated[Drape, one_of(Drape, "a way to drape a laminate")] = Field(
        "symmetric",
        title="Drape",
        description="From each face to the mid-surface (symmetric), or once from the lower to the "
        "upper face (through)",
    )
    plies: Annotated[
        tuple[PlyWords, ...],
        entries_from(1),
        WithJsonSchema({"type": "array", "items": one_table_of(PlyWords), "minItems": 1}),
    ] = Field(
        title="Plies",
        description="Tables { material, angle, thickness or fraction } in the order of the drape; "
        "with thicknesses the last ply fills what remains",
    )
    repeat: Annotated[Count, between(1, 1000)] = Field(
        1, title="Repeat", description="How often the list of plies is laid, one after the other"
    )
    loss_factor: LossValue | None = Field(
        None,
        title="Loss factor",
        description=f"{STRUCTURAL_LOSS}; without it that of the plies, if they all have the same",
    )
    source: Text = Field(
        "", title="Source", description="Where the constants come from, for people"
    )

    @model_validator(mode="after")
    def _check_measures(self) -> "LaminateWords":
        fractions = [ply.fraction for ply in self.plies if ply.fraction is not None]
        if fractions and len(fractions) < len(self.plies):
            raise wrong(
                "some plies have a thickness and some a fraction",
                "Give all plies the same",
                at=("plies",),
            )
        if fractions and abs(sum(fractions) - 1.0) > 1e-6:
            raise wrong(
                f"the fractions sum to {sum(fractions):.6g} and must sum to 1",
                "They are shares of one listed stack, whatever repeat says",
                at=("plies",),
            )
        return self
