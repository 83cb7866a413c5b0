# SPDX-License-Identifier: LGPL-2.1-or-later
"""Write the reference of the case file's keys for the documentation.

    python tools/case_reference.py

Every key with its meaning, unit and default comes from the models that read the file.
"""

from collections.abc import Iterator
from inspect import cleandoc
from pathlib import Path
from typing import Any

from pydantic_core import PydanticUndefined

from quietblade.case import Case
from quietblade.case.fields import Words
from quietblade.case.materials import LAWS

OUT = Path(__file__).resolve().parent.parent / "docs" / "_generated" / "case-reference.md"


def example(schema: dict[str, Any]) -> str:
    """How a value of a field is written: its SI unit, its words or its type."""
    if "unit" in schema:
        return str(schema["unit"]) or "1"
    if "enum" in schema or "const" in schema:
        return ", ".join(f"`{word}`" for word in schema.get("enum", [schema.get("const")]))
    if "anyOf" in schema:
        return next(example(inner) for inner in schema["anyOf"] if inner.get("type") != "null")
    items = schema.get("items") or next(iter(schema.get("prefixItems", [])), None)
    if isinstance(items, dict):
        return f"list, {example(items)}"
    return {"string": "text", "integer": "whole number", "number": "1"}.get(schema["type"], "")


def default(value: object) -> str:
    """Default of a field in SI units; a dash if the key must be given."""
    if value is PydanticUndefined:
        return "must be given"
    if value is None:
        return "-"
    plain = value.plain() if hasattr(value, "plain") else value
    if isinstance(plain, tuple):
        return ", ".join(map(str, plain))
    return f"{plain:g}" if isinstance(plain, float) else str(plain)


def lines(model: type[Words]) -> Iterator[str]:
    """Rows of the table of one model."""
    yield "| key | meaning | unit or choice | default |"
    yield "|---|---|---|---|"
    properties = model.model_json_schema()["properties"]
    for key, field in model.model_fields.items():
        cells = (
            f"`{key}`",
            field.description or "",
            example(properties[key]),
            default(field.default),
        )
        yield "| " + " | ".join(cell.replace("|", r"\|") for cell in cells) + " |"


def table_model(annotation: Any) -> type[Words] | None:
    """Model of a table of the case file, or None for a plain key."""
    for inner in getattr(annotation, "__args__", (annotation,)):
        if isinstance(inner, type) and issubclass(inner, Words):
            return inner
    return None


def pages() -> Iterator[str]:
    """Write a section for each table, then one for each material law."""
    for name, field in Case.model_fields.items():
        model = table_model(field.annotation)
        if model is not None:
            yield f"### `[{name}]`\n\n{field.description}.\n\n" + "\n".join(lines(model))
    for law, model in LAWS.items():
        title = f'### `[materials.NAME]` with `law = "{law}"`'
        meaning = cleandoc(model.__doc__ or "")
        yield f"{title}\n\n{meaning}\n\n" + "\n".join(lines(model))


def main() -> None:
    """Write the page."""
    OUT.parent.mkdir(parents=True, exist_ok=True)
    OUT.write_text("\n\n".join(pages()) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
