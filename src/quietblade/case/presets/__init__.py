# SPDX-License-Identifier: LGPL-2.1-or-later
"""Case files to start from."""

from collections.abc import Mapping
from importlib.resources import files
from types import MappingProxyType

from quietblade.case.problems import suggestion
from quietblade.errors import CaseError

PRESETS: Mapping[str, str] = MappingProxyType(
    {
        "paper-aluminium": "the aluminium blade of the two-step paper",
        "paper-composite": "the woven carbon blade of the two-step paper",
        "hydrofoil": "a fixed hydrofoil of a water-tunnel experiment",
        "twisted": "a twisted, swept and cambered blade of bronze with a film",
        "sphere": "a spherical shell of steel in water, with an exact solution",
    }
)
"""Name and one line about each."""

BLADES = tuple(name for name in PRESETS if name != "sphere")
"""Those of blades."""


def preset_text(name: str) -> str:
    """Return the text of a case file.

    Raises
    ------
    CaseError
        There is no preset of this name.
    """
    if name not in PRESETS:
        near = suggestion(name, PRESETS)
        known = "Known: " + ", ".join(PRESETS)
        raise CaseError(f'there is no preset "{name}". {near} {known}'.replace("  ", " "))
    return files(__name__).joinpath(f"{name}.toml").read_text(encoding="utf-8")
