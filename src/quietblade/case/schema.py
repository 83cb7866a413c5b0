# SPDX-License-Identifier: LGPL-2.1-or-later
"""JSON schema of the case file, by which an editor completes keys and marks slips."""

from typing import Any

from pydantic.json_schema import GenerateJsonSchema, models_json_schema

from quietblade.case.body import BodyCase
from quietblade.case.fields import TABLES, Words
from quietblade.case.laminate import PlyWords
from quietblade.case.loss import LOSS_MODELS, SHIFTS, PrestrainWords
from quietblade.case.model import Case

SCHEMA_FILE = "quietblade.schema.json"
"""Usual name of the file."""

DIRECTIVE = f"#:schema ./{SCHEMA_FILE}\n"
"""Line of a TOML file by which editors find the schema beside it."""

_BY_NAME: tuple[type[Words], ...] = (
    PlyWords, PrestrainWords, *LOSS_MODELS.models.values(), *SHIFTS.models.values()
)  # fmt: skip
"""Models that others name in `one_table_of`."""


class _Generator(GenerateJsonSchema):
    def encode_default(self, dft: Any) -> Any:
        return super().encode_default(dft.plain() if hasattr(dft, "plain") else dft)


def case_schema() -> dict[str, Any]:
    """Make the schema of a case file, draft 2020-12.

    It knows keys, types, words and the form of quantities; whether a unit is a known one, and
    what values mean together, only `Case` knows.
    """
    models = [(model, "validation") for model in (Case, BodyCase, *_BY_NAME)]
    _, schema = models_json_schema(models, schema_generator=_Generator)  # type: ignore[arg-type]  # the mode is a literal
    definitions = {name: _as_toml(inner) for name, inner in schema["$defs"].items()}
    for definition in definitions.values():
        del definition["title"]  # the name of a class
    case, body = definitions.pop("Case"), definitions.pop("BodyCase")
    kinds = [part["properties"].pop("excitation") for part in (case, body)]
    needed = [set(part.pop("required")) for part in (case, body)]
    shared = needed[0] & needed[1]
    one = {"anyOf": [kind["items"] for kind in kinds]}
    case["properties"] |= {
        "body": body["properties"]["body"],
        "excitation": {
            "title": kinds[0]["title"],
            "description": "What sets it in motion: a table, or several",
            # one table may stand for a list of one
            "anyOf": [one, {"type": "array", "items": one}],
        },
    }
    return {
        "$schema": GenerateJsonSchema.schema_dialect,
        "title": "Case file of quietblade",
        **case,
        "description": "A study of one blade, or of another body",
        "required": sorted(shared),
        "oneOf": [{"required": sorted(own - shared)} for own in needed],
        "$defs": definitions,
    }


def _as_toml(node: Any) -> Any:
    """Say what TOML and its editors understand: no null, defaults as written, units in words."""
    if isinstance(node, list):
        return [_as_toml(inner) for inner in node]
    if not isinstance(node, dict):
        return node
    node = {key: _as_toml(inner) for key, inner in node.items() if key != "discriminator"}
    if "anyOf" in node:
        kept = [kind for kind in node["anyOf"] if kind != {"type": "null"}]
        node = {**node, "anyOf": kept} if len(kept) > 1 else {**node, **kept[0]}
        if len(kept) == 1:
            del node["anyOf"]
    if TABLES in node:
        names = node.pop(TABLES)
        node["oneOf"] = [{"$ref": f"#/$defs/{name}"} for name in names]
    unit = node.get("unit")
    if unit and isinstance(node.get("description"), str):
        node["description"] += f" [{unit}]"
    if "default" in node:
        value = node.pop("default")
        if isinstance(value, float) and unit:
            node["default"] = f"{value:g} {unit}"
        elif value not in (None, "", []) and not isinstance(value, dict):
            node["default"] = value
    return node
