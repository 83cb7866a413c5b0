# SPDX-License-Identifier: LGPL-2.1-or-later
"""Flexible propeller blades in water: equilibrium under lift, wet modes and radiated sound."""

from importlib import import_module
from importlib.metadata import version
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from quietblade.case import BodyCase, Case, load_case
    from quietblade.results.model import Result
    from quietblade.results.store import load
    from quietblade.study.steps import (
        collect,
        frequencies,
        make_blade,
        make_mesh,
        preset,
        run,
        solve_modes,
        solve_response,
        solve_static,
        tabulate_static,
    )

__version__ = version("quietblade")

_STEPS = (
    "collect", "frequencies", "make_blade", "make_mesh", "preset", "run", "solve_modes",
    "solve_response", "solve_static", "tabulate_static",
)  # fmt: skip
_PLACES = {
    **dict.fromkeys(("BodyCase", "Case", "load_case"), "quietblade.case"),
    "Result": "quietblade.results.model",
    "load": "quietblade.results.store",
    **dict.fromkeys(_STEPS, "quietblade.study.steps"),
}

__all__ = [
    "BodyCase",
    "Case",
    "Result",
    "__version__",
    "collect",
    "frequencies",
    "load",
    "load_case",
    "make_blade",
    "make_mesh",
    "preset",
    "run",
    "solve_modes",
    "solve_response",
    "solve_static",
    "tabulate_static",
]


def __getattr__(name: str) -> Any:
    """Import what is asked for, and nothing before: commands must start at once."""
    if name not in _PLACES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_PLACES[name]), name)


def __dir__() -> list[str]:
    return sorted(__all__)
