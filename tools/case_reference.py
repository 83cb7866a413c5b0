# SPDX-License-Identifier: LGPL-2.1-or-later
"""Write the reference of the case file's keys and of the material library for the documentation.

    python tools/case_reference.py

Every key with its meaning, unit and default comes from the models that read the file; every
material with its constants, source and note from the library.
"""

from collections.abc import Iterator
from inspect import cleandoc
from math import pi
from pathlib import Path
from types import UnionType
from typing import Any, get_args, get_origin

from pydantic.fields import FieldInfo
from pydantic_core import PydanticUndefined

from quietblade.case import AnyCase, Case
from quietblade.case.body import BODY_EXCITATIONS, BodyWords
from quietblade.case.excitation import EXCITATIONS
from quietblade.case.fields import Words
from quietblade.case.laminate import PlyWords
from quietblade.case.library import NAMES, NOTE_OF, SOURCE_OF, library_material
from quietblade.case.loss import LOSS_MODELS, SHIFTS, PrestrainWords
from quietblade.case.materials import LAWS
from quietblade.case.structure import LOADS

OUT = Path(__file__).resolve().parent.parent / "docs" / "_generated"

HEAD = ("| key | meaning | SI unit or choice | default |", "|---|---|---|---|")
TYPES = {
    "string": "text",
    "integer": "whole number",
    "number": "1",
    "object": "table",
    "boolean": "true, false",
}

# How people write a value of a unit: from this magnitude on, one is so much, and called so.
PRINTED = {
    "Pa": ((1e9, 1e9, " GPa"), (0.0, 1e6, " MPa")),
    "kg/m^3": ((0.0, 1.0, " kg/m³"),),
    "rad": ((0.0, pi / 180.0, "°"),),
}


def example(schema: dict[str, Any], definitions: dict[str, Any]) -> str:
    """How a value of a field is written: its SI unit, its words or its type."""
    if "$ref" in schema:
        return example(definitions[schema["$ref"].rsplit("/", 1)[1]], definitions)
    if "unit" in schema:
        return str(schema["unit"]) or "1"
    if "enum" in schema or "const" in schema:
        return ", ".join(f"`{word}`" for word in schema.get("enum", [schema.get("const")]))
    if "anyOf" in schema:
        kinds = [example(s, definitions) for s in schema["anyOf"] if s.get("type") != "null"]
        return ", or ".join(dict.fromkeys(kinds))
    items = schema.get("items") or next(iter(schema.get("prefixItems", [])), None)
    if isinstance(items, dict):
        return f"list, {example(items, definitions)}"
    return TYPES.get(schema.get("type", ""), "")


def default(value: object) -> str:
    """Default of a field in SI units; a dash if there is none and the key may be left out."""
    if value is PydanticUndefined:
        return "must be given"
    if value is None or value in ("", ()):
        return "-"
    plain = value.plain() if hasattr(value, "plain") else value
    if isinstance(plain, tuple):
        return ", ".join(map(str, plain)) or "-"
    if isinstance(plain, bool):
        return str(plain).lower()
    return f"{plain:g}" if isinstance(plain, float) else str(plain)


def lines(model: type[Words]) -> Iterator[str]:
    """Rows of the table of one model; tables inside it have a section of their own."""
    yield from HEAD
    schema = model.model_json_schema()
    for key, field in model.model_fields.items():
        if table_model(field.annotation) is not None:
            continue
        cells = (
            f"`{key}`",
            field.description or "",
            example(schema["properties"][key], schema.get("$defs", {})),
            default(field.default),
        )
        yield "| " + " | ".join(cell.replace("|", r"\|") for cell in cells) + " |"


def table_model(annotation: Any) -> type[Words] | None:
    """Model of a table of the case file that may be left out or not, or None for any other key."""
    inners = get_args(annotation) if get_origin(annotation) is UnionType else (annotation,)
    for inner in inners:
        if isinstance(inner, type) and issubclass(inner, Words):
            return inner
    return None


def entry_model(annotation: Any) -> type[Words] | None:
    """Model of the entries of a list of tables, or None for any other key."""
    return table_model(get_args(annotation)[0]) if get_origin(annotation) is tuple else None


def tables(name: str, annotation: Any, meaning: str) -> Iterator[str]:
    """Sections of a table and of the tables inside it."""
    model = table_model(annotation)
    if model is None:
        return
    yield f"### `[{name}]`\n\n{meaning}.\n\n" + "\n".join(lines(model))
    for key, field in model.model_fields.items():
        yield from tables(f"{name}.{key}", field.annotation, field.description or "")


def kind(title: str, model: type[Words]) -> str:
    """Section of one of several models that a table may have, told apart by a word."""
    return f"### {title}\n\n{cleandoc(model.__doc__ or '')}\n\n" + "\n".join(lines(model))


def ordered(case: type[AnyCase]) -> dict[str, FieldInfo]:
    """Fields of a case: first what it has alone, then what all cases have."""
    fields = case.model_fields
    own = [name for name in fields if name not in AnyCase.model_fields]
    return {name: fields[name] for name in (*own, *AnyCase.model_fields)}


def keys() -> Iterator[str]:
    """Sections of all tables, those of a body that is no blade last."""
    plain = [key for key, field in Case.model_fields.items() if field.annotation in (str, int)]
    at_top = Case.model_json_schema()["properties"]
    yield "### At the top\n\n" + "\n".join(
        [
            *HEAD,
            *(
                f"| `{key}` | {said.description} | {TYPES[kind]} | {default(said.default)} |"
                for key in plain
                for said, kind in [(Case.model_fields[key], at_top[key]["type"])]
            ),
        ]
    )
    for name, field in ordered(Case).items():
        if name == "materials":
            for law, model in LAWS.items():
                yield kind(f'`[materials.NAME]` with `law = "{law}"`', model)
            yield kind("A ply, in the list `plies` of a laminate", PlyWords)
            for word, model in LOSS_MODELS.models.items():
                yield kind(f'A table `loss_factor` with `model = "{word}"`', model)
            for word, model in SHIFTS.models.items():
                yield kind(f'A table `shift` of it with `law = "{word}"`', model)
            yield kind("An entry of the list `prestrain` of it", PrestrainWords)
        elif name == "loads":
            for word, model in LOADS.items():
                yield kind(f'`[[loads]]` with `kind = "{word}"`', model)
        elif name == "excitation":
            for word, model in EXCITATIONS.items():
                yield kind(f'`[excitation]` or `[[excitation]]` with `kind = "{word}"`', model)
        elif (model := entry_model(field.annotation)) is not None:
            yield kind(f"`[[{name}]]`", model)
        else:
            yield from tables(name, field.annotation, field.description or "")

    yield from tables("body", BodyWords, "A body in place of a blade")
    for word, model in BODY_EXCITATIONS.items():
        yield kind(f'`[excitation]` of a body with `kind = "{word}"`', model)


def printed(key: str, value: object, unit: str | None) -> str:
    """One constant of a material with its unit."""
    if not isinstance(value, float):
        return ""
    ways = PRINTED.get(unit or "", ((0.0, 1.0, ""),))
    size, name = next((size, name) for least, size, name in ways if abs(value) >= least)
    return f"{key} = {value / size:.4g}{name}"


def material(name: str) -> str:
    """Entry of the library: constants, source and note."""
    words = library_material(name)
    properties = type(words).model_json_schema()["properties"]
    constants = []
    for key, field in type(words).model_fields.items():
        value = getattr(words, key)
        if value is None or (value == field.default and key != "law"):
            continue
        schema = properties[key]
        units = [s.get("unit") for s in (schema, *schema.get("anyOf", ()))]
        constants.append(printed(key, value, next((u for u in units if u), None)))
    listed = ", ".join(filter(None, constants))
    return "\n".join(
        [
            f"`{name}`",
            f": {words.law}: {listed}.",
            "",
            f"  {NOTE_OF[name]}",
            "",
            f"  Source: {SOURCE_OF[name]}.",
        ]
    )


def main() -> None:
    """Write both pages."""
    OUT.mkdir(parents=True, exist_ok=True)
    (OUT / "case-reference.md").write_text("\n\n".join(keys()) + "\n", encoding="utf-8")
    entries = "\n\n".join(material(name) for name in NAMES)
    (OUT / "library.md").write_text(entries + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
