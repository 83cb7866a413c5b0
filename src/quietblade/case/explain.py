# SPDX-License-Identifier: LGPL-2.1-or-later
"""From validation errors to findings that a user can act on."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any, get_args

from pydantic import BaseModel, ValidationError
from pydantic.fields import FieldInfo
from pydantic_core import ErrorDetails

from quietblade.case.excitation import EXCITATIONS
from quietblade.case.fields import CASE_PROBLEM, Quantity
from quietblade.case.laminate import PlyWords
from quietblade.case.library import LAW_OF
from quietblade.case.loss import loss_model
from quietblade.case.materials import BLADE_LAWS, BODY_LAWS, FILM_LAWS, LAWS, ply_findings
from quietblade.case.problems import Path, dotted, nearest, suggestion
from quietblade.case.source import Finding, as_written
from quietblade.case.spans import Spanwise
from quietblade.case.structure import LOADS

Model = type[BaseModel]

_TYPES = {
    "int_type": ("a whole number is needed", "Write a number such as 40, without quotes"),
    "float_type": ("a number is needed", "Write a number such as 0.5, without quotes"),
    "bool_type": ("is neither true nor false", "Write true or false, without quotes"),
    "string_type": ("text is needed", "Write it in quotes"),
    "finite_number": ("is not a finite number", "Write a finite number"),
    "tuple_type": ("a list is needed", "Write the entries in [ ], tables below a header in [[ ]]"),
    "dict_type": ("a table is needed", "Write its keys below a header in [ ]"),
    "model_type": ("a table is needed", "Write its keys below a header in [ ]"),
    "model_attributes_type": ("a table is needed", "Write its keys below a header in [ ]"),
}


@dataclass(frozen=True)
class _Choice:
    """Entries of one table that are of several models, told apart by one key."""

    key: str
    what: str
    models: Mapping[str, Model]
    usual: str = ""
    """Word of an entry that has none."""

    def model(self, entry: Any) -> Model | None:
        word = entry.get(self.key, self.usual) if isinstance(entry, Mapping) else None
        return self.models.get(word) if isinstance(word, str) else None


_CHOICES = {
    "materials": _Choice("law", "a material law", LAWS),
    "loads": _Choice("kind", "a kind of load", LOADS),
    "excitation": _Choice("kind", "a kind of excitation", EXCITATIONS, "pressure"),
}


def _choice(name: str, root: Model) -> _Choice | None:
    """Models of the entries of a table; each kind of case has excitations of its own."""
    choice = _CHOICES.get(name)
    own = getattr(root, "excitations", None) if name == "excitation" else None
    return replace(choice, models=own) if choice and own else choice


_PART_LAWS = (("blade", BLADE_LAWS), ("film", FILM_LAWS), ("body", BODY_LAWS))


def explain(error: ValidationError, data: Mapping[str, Any], root: Model) -> Iterator[Finding]:
    """Say what is wrong for each validation error of a case."""
    details = error.errors(include_url=False)
    missing = {_in_file(d["loc"]) for d in details if d["type"] == "missing"}
    misspelt: set[Path] = set()
    for detail in details:
        if detail["type"] == "extra_forbidden":
            *table, key = _in_file(detail["loc"])
            near = nearest(str(key), [str(path[-1]) for path in missing if [*path[:-1]] == table])
            misspelt.update({(*table, near)} if near else ())
    for detail in details:
        # a misspelt key is one problem, not also a missing one
        if detail["type"] != "missing" or _in_file(detail["loc"]) not in misspelt:
            yield _explain(detail, data, root)


def _explain(detail: ErrorDetails, data: Mapping[str, Any], root: Model) -> Finding:
    path, kind, context = _in_file(detail["loc"]), detail["type"], detail.get("ctx", {})
    if kind == CASE_PROBLEM:
        return Finding((*path, *context["at"]), context["message"], context["remedy"])
    if kind == "missing":
        return _missing(path, data, root)
    if kind == "extra_forbidden":
        return _unknown(path, data, root)
    if kind in ("union_tag_not_found", "union_tag_invalid"):
        choice = _choice(str(path[0]), root)
        assert choice is not None
        fault = "is missing" if kind == "union_tag_not_found" else f"is not {choice.what}"
        return Finding((*path, choice.key), fault, f"Known: {_listed(choice.models)}")
    message, remedy = _TYPES.get(kind, (detail["msg"][:1].lower() + detail["msg"][1:], ""))
    return Finding(path, message, remedy)


def _in_file(loc: tuple[int | str, ...]) -> Path:
    # pydantic inserts the word that tells the model behind the name or number of the entry
    return loc[:2] + loc[3:] if loc[:1] and loc[0] in _CHOICES and len(loc) > 2 else loc


def _missing(path: Path, data: Mapping[str, Any], root: Model) -> Finding:
    *table, key = path
    model = model_at(tuple(table), data, root)
    info = model.model_fields[str(key)] if model else None
    if info is None:
        return Finding(path, "is missing", f"Add {key}")
    inner = _whole_table(str(key), info, root)
    if inner is not None:
        wanted = [name for name, f in inner.model_fields.items() if f.is_required()]
        instead = ", or [body] for a sphere in water" if path == ("blade",) else ""
        remedy = f"Add [{key}] with {', '.join(wanted)}{instead}"
        return Finding(path, "this table is missing", remedy)
    return Finding(path, "is missing", f"{info.description}. Add {_example(str(key), info)}")


def _example(key: str, info: FieldInfo) -> str:
    for note in info.metadata:
        quantity = note.quantity if isinstance(note, Spanwise) else note
        if isinstance(quantity, Quantity):
            kind = quantity.kind
            return f'{key} = "{kind.example}"' if kind.unit else f"{key} = 0.06"
    return f"{key} = ..."


def _unknown(path: Path, data: Mapping[str, Any], root: Model) -> Finding:
    *table, key = path
    model = model_at(tuple(table), data, root)
    known = list(model.model_fields) if model else []
    near = suggestion(str(key), known)
    if near:
        return Finding(path, "unknown key", near)
    elsewhere = [
        dotted((name, str(key)))
        for name, info in root.model_fields.items()
        if (inner := _whole_table(name, info, root)) and key in inner.model_fields
    ]
    if elsewhere:
        return Finding(path, "unknown key here", f"Did you mean {' or '.join(elsewhere)}?")
    return Finding(path, "unknown key", f"Known here: {', '.join(known)}")


def model_at(path: Path, data: Mapping[str, Any], root: Model) -> Model | None:
    """Model of the table at a path; None where there is no table."""
    choice = _choice(str(path[0]), root) if path else None
    if choice is not None:
        if path[2:3] == ("plies",) and len(path) == 4:
            return PlyWords
        if path[2:3] == ("loss_factor",):
            return loss_model(path[3:], _at(path[:3], data))
        return choice.model(_at(path, data)) if len(path) == 2 else None
    model: Model | None = root
    for part in path:
        if isinstance(part, int):  # of a list of tables
            continue
        info = model.model_fields.get(str(part)) if model else None
        model = _table_model(info.annotation) if info else None
    return model


def _whole_table(name: str, info: FieldInfo, root: Model) -> Model | None:
    """Model of a table at the top, the usual one where there are several; None for other keys."""
    choice = _choice(name, root)
    return choice.models.get(choice.usual) if choice else _table_model(info.annotation)


def _at(path: Path, data: Any) -> Any:
    for part in as_written(path, data):
        try:
            data = data[part]
        except (LookupError, TypeError):
            return None
    return data


def _table_model(annotation: Any) -> Model | None:
    for candidate in (annotation, *get_args(annotation)):
        if isinstance(candidate, type) and issubclass(candidate, BaseModel):
            return candidate
    return None


def material_findings(data: Mapping[str, Any]) -> Iterator[Finding]:
    """Check the names of materials: they exist, and their laws suit their places."""
    own = data.get("materials")
    for name in own if isinstance(own, Mapping) else ():
        if name in LAW_OF:
            yield Finding(
                ("materials", name), "is the name of a library material", "Choose another name"
            )
    laws = dict(LAW_OF) | _laws(data)
    yield from ply_findings(data, laws)
    for part, allowed in _PART_LAWS:
        table = data.get(part)
        name = table.get("material") if isinstance(table, Mapping) else None
        if not isinstance(name, str):
            continue
        if name not in laws:
            near = suggestion(name, laws)
            known = f"Known: {_listed(laws)}; or define [materials.{dotted((name,))}]"
            yield Finding(
                (part, "material"), "there is no material of this name", f"{near} {known}".strip()
            )
        elif laws[name] in LAWS and laws[name] not in allowed:
            yield Finding(
                (part, "material"),
                f"has the law {laws[name]}, which the {part} cannot have",
                f"The {part} needs the law {' or '.join(allowed)}",
            )


def _laws(data: Mapping[str, Any]) -> dict[str, str]:
    """Law of each material that the case defines; empty where it says nothing usable."""
    own = data.get("materials")
    laws = {}
    for name, words in own.items() if isinstance(own, Mapping) else ():
        law = words.get("law") if isinstance(words, Mapping) else None
        laws[name] = law if isinstance(law, str) else ""
    return laws


def _listed(names: Mapping[str, Any]) -> str:
    return ", ".join(f'"{name}"' for name in names)
