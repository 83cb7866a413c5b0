# SPDX-License-Identifier: LGPL-2.1-or-later
"""Conforming second-order meshes of blade, film and water."""

from quietblade.mesh.build import MeshSpec, build_mesh
from quietblade.mesh.cad import Patch
from quietblade.mesh.model import BOUNDARIES, INTERFACE, REGIONS, CellBlock, Mesh, Quality
from quietblade.mesh.nodal import NodalBasis
from quietblade.mesh.resize import resize_sphere

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
