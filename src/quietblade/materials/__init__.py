# SPDX-License-Identifier: LGPL-2.1-or-later
"""Hyperelastic materials as strain energies, laminates, their directions and a library."""

from quietblade.materials.anisotropic import AnisotropicSVK
from quietblade.materials.axes import Axes, ply_axes, section_directions
from quietblade.materials.draping import homogenised, layered, ply_number
from quietblade.materials.isotropic import IsotropicSVK
from quietblade.materials.kinematics import green_lagrange
from quietblade.materials.laminate import (
    Laminate,
    Ply,
    beam_stiffness,
    effective_stiffness,
    plate_stiffness,
)
from quietblade.materials.library import LIBRARY, LibraryEntry, find_material
from quietblade.materials.mooney_rivlin import MooneyRivlin
from quietblade.materials.neo_hookean import NeoHookean
from quietblade.materials.orthotropic import OrthotropicSVK
from quietblade.materials.protocols import ElasticMaterial, Material, MixedMaterial
from quietblade.materials.strength import PlyStrength
from quietblade.materials.surface import Depth, surface_axes, surface_depth, surface_frame

__all__ = [
    "LIBRARY",
    "AnisotropicSVK",
    "Axes",
    "Depth",
    "ElasticMaterial",
    "IsotropicSVK",
    "Laminate",
    "LibraryEntry",
    "Material",
    "MixedMaterial",
    "MooneyRivlin",
    "NeoHookean",
    "OrthotropicSVK",
    "Ply",
    "PlyStrength",
    "beam_stiffness",
    "effective_stiffness",
    "find_material",
    "green_lagrange",
    "homogenised",
    "layered",
    "plate_stiffness",
    "ply_axes",
    "ply_number",
    "section_directions",
    "surface_axes",
    "surface_depth",
    "surface_frame",
]
