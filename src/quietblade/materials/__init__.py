# SPDX-License-Identifier: LGPL-2.1-or-later
"""Hyperelastic materials as strain energies, their directions and a small library."""

from quietblade.materials.axes import Axes, ply_axes, section_directions
from quietblade.materials.isotropic import IsotropicSVK
from quietblade.materials.kinematics import green_lagrange
from quietblade.materials.library import LIBRARY, LibraryEntry, find_material
from quietblade.materials.mooney_rivlin import MooneyRivlin
from quietblade.materials.orthotropic import OrthotropicSVK
from quietblade.materials.protocols import ElasticMaterial, Material, MixedMaterial

__all__ = [
    "LIBRARY",
    "Axes",
    "ElasticMaterial",
    "IsotropicSVK",
    "LibraryEntry",
    "Material",
    "MixedMaterial",
    "MooneyRivlin",
    "OrthotropicSVK",
    "find_material",
    "green_lagrange",
    "ply_axes",
    "section_directions",
]
