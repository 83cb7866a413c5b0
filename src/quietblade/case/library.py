# SPDX-License-Identifier: LGPL-2.1-or-later
"""Materials that a case file may name without defining them."""

import tomllib
from collections.abc import Mapping
from importlib.resources import files
from types import MappingProxyType
from typing import Any

from pydantic import TypeAdapter

from quietblade.case.materials import MaterialWords, SolidWords

# the same file as the materials of Python code, read without loading the finite elements
_CONSTANTS: Mapping[str, Mapping[str, Any]] = tomllib.loads(
    files("quietblade").joinpath("materials/library.toml").read_text(encoding="utf-8")
)
_ABOUT = ("source", "note")

NAMES = tuple(_CONSTANTS)
"""Names of the library's materials."""

LAW_OF: Mapping[str, str] = MappingProxyType(
    {name: constants["law"] for name, constants in _CONSTANTS.items()}
)
"""Law of each material of the library."""

SOURCE_OF: Mapping[str, str] = MappingProxyType(
    {name: constants["source"] for name, constants in _CONSTANTS.items()}
)
"""Where the constants of each material come from."""

NOTE_OF: Mapping[str, str] = MappingProxyType(
    {name: constants["note"] for name, constants in _CONSTANTS.items()}
)
"""What a user should know before using each material, and how uncertain it is."""


def library_material(name: str) -> SolidWords:
    """Return a material of the library by its name: the constants, as if a case had them."""
    adapter: TypeAdapter[SolidWords] = TypeAdapter(MaterialWords)
    words = {key: value for key, value in _CONSTANTS[name].items() if key not in _ABOUT}
    return adapter.validate_python(words, context={"si": True})
