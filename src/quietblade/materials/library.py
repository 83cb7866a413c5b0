# SPDX-License-Identifier: LGPL-2.1-or-later
"""Named materials, each with the source of its constants.

The constants stand in ``library.toml`` beside this file, which case files read too.
"""

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from importlib.resources import files
from types import MappingProxyType
from typing import Any, TypeAlias

from quietblade.errors import MaterialError
from quietblade.materials.isotropic import IsotropicSVK
from quietblade.materials.mooney_rivlin import MooneyRivlin
from quietblade.materials.neo_hookean import NeoHookean
from quietblade.materials.orthotropic import OrthotropicSVK
from quietblade.materials.strength import PlyStrength

LibraryMaterial: TypeAlias = IsotropicSVK | OrthotropicSVK | MooneyRivlin | NeoHookean

_STRENGTHS = ("Xt", "Xc", "Yt", "Yc", "S12")


@dataclass(frozen=True)
class LibraryEntry:
    """A material of the library.

    Attributes
    ----------
    material : IsotropicSVK, OrthotropicSVK, MooneyRivlin or NeoHookean
        The material; an orthotropic one still has to be given its axes (`oriented`).
    source : str
        Where the constants come from.
    note : str
        What a user should know before using them, and how uncertain they are.
    """

    material: LibraryMaterial
    source: str
    note: str = ""

    @property
    def name(self) -> str:
        """Name in the library and in case files."""
        return self.material.name


def _make(name: str, words: Mapping[str, Any]) -> LibraryMaterial:
    constants = {key: value for key, value in words.items() if key not in {"law", "source", "note"}}
    match words["law"]:
        case "isotropic":
            youngs, ratio = constants.pop("E"), constants.pop("nu")
            return IsotropicSVK(name, youngs_modulus=youngs, poisson_ratio=ratio, **constants)
        case "orthotropic":
            constants.pop("ply_angle", None)  # of the case's lay-up, not of the material
            strengths = {key.lower(): constants.pop(key, None) for key in _STRENGTHS}
            strength = PlyStrength(**strengths) if strengths["xt"] else None
            lower = {key.lower(): value for key, value in constants.items()}
            return OrthotropicSVK(name, strength=strength, **lower)
        case "mooney-rivlin":
            return MooneyRivlin(name, **constants)
        case "neo-hookean":
            return NeoHookean(name, **constants)
    raise MaterialError(f"material {name!r} of the library has an unknown law {words['law']!r}")


def _read() -> dict[str, LibraryEntry]:
    text = files("quietblade").joinpath("materials/library.toml").read_text(encoding="utf-8")
    return {
        name: LibraryEntry(_make(name, words), words["source"], words["note"])
        for name, words in tomllib.loads(text).items()
    }


LIBRARY: Mapping[str, LibraryEntry] = MappingProxyType(_read())
"""Materials by name."""


def find_material(name: str) -> LibraryMaterial:
    """Return the library's material of this name.

    Raises
    ------
    MaterialError
        If there is none; the message lists the names.
    """
    if name not in LIBRARY:
        near = get_close_matches(name, LIBRARY, n=1)
        hint = f" Did you mean {near[0]!r}?" if near else ""
        raise MaterialError(
            f"no material {name!r} in the library: it has {', '.join(LIBRARY)}.{hint}"
        )
    return LIBRARY[name].material
