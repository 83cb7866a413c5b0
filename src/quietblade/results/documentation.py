# SPDX-License-Identifier: LGPL-2.1-or-later
"""The page that documents what a run stores, made from the register and the summary's model.

To renew it after a change: ``python -c "from pathlib import Path; from quietblade.results import
documentation as d; Path('docs/result-schema.md').write_text(d.schema_page(), 'utf-8')"``.
"""

import json
from collections.abc import Iterator, Mapping
from itertools import groupby
from typing import Any

from quietblade.results.quantities import DIMENSIONS, LABELS, QUANTITIES, Quantity
from quietblade.results.summary import Summary


def json_schema() -> dict[str, Any]:
    """JSON Schema (draft 2020-12) of the output of ``quietblade show --json``."""
    schema = Summary.model_json_schema(mode="serialization")
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **schema}


def schema_page() -> str:
    """Text of ``docs/result-schema.md``."""
    return "\n".join([*_head(), *_summary(), *_dimensions(), *_groups(), *_schema()]) + "\n"


def _head() -> list[str]:
    return [
        "# What a run stores",
        "",
        "<!-- Made by quietblade.results.documentation; a test keeps it equal to the code. -->",
        "",
        "A run is a folder: `result.nc` (every number), `fields/*.vtu` (fields on the mesh, for",
        "ParaView), `figures/*.png`, `summary.txt` and `case.toml`, a copy of the case file.",
        "`result.nc` is written last: a folder that has it is whole.",
        "",
        "All values are in SI units; angles are in rad. A real number that was not computed is",
        "NaN in `result.nc` and null in JSON. Harmonic quantities are peak amplitudes with",
        "exp(+i omega t). The axes are those of the rotating blade: x along the rotor axis,",
        "positive downstream, z radial along the undeformed span, y = z cross x.",
        "",
    ]


def _summary() -> Iterator[str]:
    schema = json_schema()
    yield "## Headline figures: `quietblade show DIR --json`"
    yield ""
    yield "| field | type | meaning |"
    yield "|---|---|---|"
    for name, kind, meaning in _fields(schema, schema, ""):
        yield f"| `{name}` | {kind} | {_cell(meaning)} |"
    yield ""


def _fields(
    node: Mapping[str, Any], schema: Mapping[str, Any], prefix: str
) -> Iterator[tuple[str, str, str]]:
    for name, member in node["properties"].items():
        whole = f"{prefix}{name}"
        inner = _referred(member, schema)
        items = _referred(inner.get("items", {}), schema)
        if "properties" in inner:
            yield from _fields(inner, schema, f"{whole}.")
        elif "properties" in items:
            yield whole, "list of objects", member.get("description", "")
            yield from _fields(items, schema, f"{whole}[].")
        else:
            yield whole, _type(inner), member.get("description", "")


def _referred(member: Mapping[str, Any], schema: Mapping[str, Any]) -> Mapping[str, Any]:
    """Follow a reference, that of an object which may be null too."""
    for option in member.get("anyOf", ()):
        if "$ref" in option:
            member = option
    if "$ref" not in member:
        return member
    found: Mapping[str, Any] = schema["$defs"][member["$ref"].rsplit("/", 1)[-1]]
    return found


def _type(member: Mapping[str, Any]) -> str:
    if "anyOf" in member:
        return " or ".join(_type(option) for option in member["anyOf"])
    if "prefixItems" in member:
        return f"list of {len(member['prefixItems'])}: {_type(member['prefixItems'][0])}"
    if member["type"] == "array":
        return f"list of {_type(member['items'])}"
    if member["type"] == "object":
        return f"object of {_type(member['additionalProperties'])}"
    return str(member["type"])


def _dimensions() -> Iterator[str]:
    yield "## Dimensions of `result.nc`"
    yield ""
    yield "| dimension | entries | runs along |"
    yield "|---|---|---|"
    for name, meaning in DIMENSIONS.items():
        labels = ", ".join(f"`{label}`" for label in LABELS.get(name, ()))
        yield f"| `{name}` | {labels} | {_cell(meaning)} |"
    yield ""


def _groups() -> Iterator[str]:
    for group, members in groupby(QUANTITIES.values(), key=lambda q: q.group):
        if group == "fields":
            yield "## Point data of `fields/*.vtu`"
            yield ""
            yield "Complex fields are two arrays, `NAME LABEL re` and `NAME LABEL im`."
        else:
            yield f"## Group `/{group}`" if group else "## Root group"
            if group == "C*":
                yield ""
                yield "`C*` stands for `C0` and `C1`."
            if group == "alternatives":
                yield ""
                yield "Not in `result.nc` but in files of its own, of comparisons of models."
        yield ""
        yield "| name | symbol | unit | dimensions | kind | meaning |"
        yield "|---|---|---|---|---|---|"
        yield from map(_row, members)
        yield ""


def _row(q: Quantity) -> str:
    dims = ", ".join(
        (*q.dims, "complex") if q.kind == "complex" and q.group != "fields" else q.dims
    )
    meaning = f"{q.description}: {_code(q.equation)}" if q.equation else q.description
    symbol = _code(q.symbol) if q.symbol else ""
    return f"| `{q.name}` | {symbol} | {q.label} | {dims} | {q.kind} | {_cell(meaning)} |"


def _schema() -> list[str]:
    text = json.dumps(json_schema(), indent=1)
    return ["## JSON schema", "", "```json", text, "```"]


def _code(text: str) -> str:
    return f"`{text}`"


def _cell(text: str) -> str:
    return text.replace("|", "\\|")
