# SPDX-License-Identifier: LGPL-2.1-or-later
"""Conforming second-order meshes of blade, film and water."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from quietblade.mesh.build import MeshSpec, build_mesh
    from quietblade.mesh.cad import Patch
    from quietblade.mesh.model import BOUNDARIES, INTERFACE, REGIONS, CellBlock, Mesh, Quality
    from quietblade.mesh.nodal import NodalBasis
    from quietblade.mesh.resize import resize_sphere

_PLACES = {
    "build": ("MeshSpec", "build_mesh"),
    "cad": ("Patch",),
    "model": ("BOUNDARIES", "INTERFACE", "REGIONS", "CellBlock", "Mesh", "Quality"),
    "nodal": ("NodalBasis",),
    "resize": ("resize_sphere",),
}

__all__ = [
    "BOUNDARIES",
    "INTERFACE",
    "REGIONS",
    "CellBlock",
    "Mesh",
    "MeshSpec",
    "NodalBasis",
    "Patch",
    "Quality",
    "build_mesh",
    "resize_sphere",
]


def __getattr__(name: str) -> Any:
    """Import what is asked for: a forecast takes sizes from here, but no mesher."""
    for module, names in _PLACES.items():
        if name in names:
            return getattr(import_module(f"{__name__}.{module}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
