# SPDX-License-Identifier: LGPL-2.1-or-later
"""How a case says the loss of a material: a number, or a table that names its model."""

from collections.abc import Mapping
from typing import Annotated, Any

from pydantic import BeforeValidator

from quietblade.case.fields import Number, between, wrong
from quietblade.case.problems import suggestion

LOSS_MODELS: Mapping[str, str] = {"constant": "value"}
"""Models of a film's loss that ``loss_factor`` may name in a table, and the key of their number."""


def _loss(value: Any) -> Any:
    """Accept ``{ model = "constant", value = 0.2 }`` for a number."""
    if not isinstance(value, Mapping):
        return value
    model = value.get("model")
    if not isinstance(model, str) or model not in LOSS_MODELS:
        known = ", ".join(f'"{name}"' for name in LOSS_MODELS)
        near = suggestion(model, LOSS_MODELS) if isinstance(model, str) else ""
        raise wrong("has no known model of the loss", f"{near} Known: {known}".strip())
    key = LOSS_MODELS[model]
    if set(value) != {"model", key}:
        raise wrong(
            f"needs the keys model and {key}", f'Write {{ model = "{model}", {key} = 0.2 }}'
        )
    return value[key]


LossFactor = Annotated[Number, between(0.0, 10.0)]
FilmLossFactor = Annotated[Number, between(0.0, 10.0), BeforeValidator(_loss)]

STRUCTURAL_LOSS = "Structural loss factor eta of the complex stiffness (1 + i eta)"
"""Meaning of the key loss_factor of an elastic material."""
