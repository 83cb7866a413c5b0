# SPDX-License-Identifier: LGPL-2.1-or-later
"""From the words of a case to the materials of its solid regions and their directions.

Finite elements are imported where they are needed: a look at a case stays light.
"""
# ruff: noqa: PLC0415

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

import numpy as np

from quietblade.case import AnyCase, Case, Finding
from quietblade.case.laminate import LaminateModel, LaminateWords, PlyWords
from quietblade.case.materials import (
    IsotropicWords,
    MooneyRivlinWords,
    NeoHookeanWords,
    OrthotropicWords,
    SolidWords,
)
from quietblade.errors import MaterialError, Notice
from quietblade.geometry import Blade

if TYPE_CHECKING:
    from quietblade.materials import IsotropicSVK, Laminate, Material, OrthotropicSVK, Ply
    from quietblade.materials.axes import Axes
    from quietblade.mesh.nodal import NodalBasis
    from quietblade.propulsion.plies import Plies

BENDING_ERROR = 0.05
"""Error of a homogenised laminate's bending stiffness beyond which a notice is given."""


def build_materials(case: Case, blade: Blade, basis: "NodalBasis") -> "Mapping[str, Material]":
    """Make the materials of the regions ``blade`` and ``film`` of the mesh.

    Material axes follow the camber surface of the blade.

    Parameters
    ----------
    case : Case
    blade : Blade
        As from `translate.build_blade`.
    basis : NodalBasis
        Of the mesh; fields of directions and plies live on it.

    Raises
    ------
    InvalidCaseError
        A material is not admissible.
    """
    parts = {"blade": case.blade, "film": case.film}
    materials = {}
    for part, words in parts.items():
        if words is not None:
            try:
                materials[part] = _material(case, part, words.material, blade, basis)
            except MaterialError as error:
                raise case.invalid(Finding((part, "material"), str(error))) from error
    return materials


def surface_axes(blade: Blade, basis: "NodalBasis") -> "Axes":
    """Directions of the camber surface, in which film and plies lie: span, chordwise, normal."""
    from quietblade import materials

    return materials.surface_axes(blade, basis, _solid_regions(basis))


def build_laminate(case: Case, name: str, words: LaminateWords) -> "Laminate":
    """Make a laminate; all its repeats are plies of their own.

    Raises
    ------
    MaterialError
        The stack is not possible.
    """
    from quietblade import materials

    plies = tuple(_ply(case, ply, words.repeat) for ply in words.plies) * words.repeat
    own = None if words.loss_factor is None else constant_loss(words)
    return materials.Laminate(name, plies, words.drape, own)


def constant_loss(words: SolidWords) -> float:
    """Loss factor of a material in its constant part: a model comes on top (`study.losses`)."""
    return words.loss_factor if isinstance(words.loss_factor, float) else 0.0


def blade_plies(case: Case, blade: Blade, basis: "NodalBasis") -> "Mapping[str, Plies]":
    """Plies in which stress and failure are told, by region; empty unless there is a laminate."""
    from quietblade import materials
    from quietblade.propulsion.plies import Plies

    words = case.material("blade")
    if not isinstance(words, LaminateWords):
        return {}
    laminate = build_laminate(case, case.blade.material, words)
    if words.model == "homogenised":
        return {"blade": Plies(laminate)}
    depth = materials.surface_depth(blade, basis, "blade")
    return {"blade": Plies(laminate, materials.ply_number(laminate, depth))}


def blade_density(case: Case) -> float:
    """Mean density of the blade's material [kg/m3]."""
    words = case.material("blade")
    if isinstance(words, LaminateWords):
        return build_laminate(case, case.blade.material, words).density
    return words.density


def bending_modulus(case: Case) -> float:
    """Young's modulus [Pa] with which the blade bends along its span, Poisson's effect free."""
    words = case.material("blade")
    if isinstance(words, IsotropicWords):
        return words.E
    if isinstance(words, MooneyRivlinWords | NeoHookeanWords):
        return 3.0 * words.shear_modulus
    if isinstance(words, OrthotropicWords):
        # Jones, Mechanics of Composite Materials, 2nd ed., eq. (2.97)
        c, s = np.cos(words.ply_angle), np.sin(words.ply_angle)
        shear = 1.0 / words.G12 - 2.0 * words.ratio(1, 2) / words.E1
        return float(1.0 / (c**4 / words.E1 + s**4 / words.E2 + shear * (s * c) ** 2))
    from quietblade import materials
    from quietblade.materials.voigt import in_plane_rotation, turned_stiffness

    if isinstance(words, LaminateWords):
        laminate = build_laminate(case, case.blade.material, words)
        if words.model == "plies":
            return 12.0 * materials.beam_stiffness(laminate.abd(1.0).D, 1.0).bending
        stiffness = laminate.stiffness
    else:
        stiffness = turned_stiffness(np.array(words.stiffness), in_plane_rotation(words.ply_angle))
    return float(1.0 / np.linalg.inv(stiffness)[0, 0])


def laminate_notices(case: Case) -> Iterator[Notice]:
    """Say what the user should know about the model of the blade's laminate."""
    words = case.material("blade")
    if not isinstance(words, LaminateWords) or words.model != "homogenised":
        return
    error = build_laminate(case, case.blade.material, words).bending_error()
    if error > BENDING_ERROR:
        yield Notice(
            "blade.material",
            "the homogenised laminate knows nothing of the order of its plies: its bending "
            "stiffness is not that of the stack",
            error,
            BENDING_ERROR,
            'Use model = "plies"',
        )


def used_materials(case: AnyCase) -> frozenset[str]:
    """Names of all materials that the case uses, plies included."""
    names = {case.material_name(part) for part in case.parts}
    for part in case.parts:
        words = case.material(part)
        if isinstance(words, LaminateWords):
            names |= {ply.material for ply in words.plies}
    return frozenset(names)


def _material(case: Case, part: str, name: str, blade: Blade, basis: "NodalBasis") -> "Material":
    from quietblade import materials

    words = case.material(part)
    match words:
        case IsotropicWords():
            return isotropic(name, words)
        case MooneyRivlinWords():
            return materials.MooneyRivlin(
                name, words.density, words.c10, words.c01, words.bulk_modulus, constant_loss(words)
            )
        case NeoHookeanWords():
            return materials.NeoHookean(
                name, words.density, words.shear_modulus, words.bulk_modulus, constant_loss(words)
            )
        case LaminateWords():
            return _draped(build_laminate(case, name, words), words.model, part, blade, basis)
    axes = materials.surface_axes(blade, basis, part, words.ply_angle)
    if isinstance(words, OrthotropicWords):
        return _orthotropic(name, words).oriented(axes)
    return materials.AnisotropicSVK(
        name, words.density, np.array(words.stiffness), axes, constant_loss(words)
    )


def _draped(
    laminate: "Laminate", model: LaminateModel, part: str, blade: Blade, basis: "NodalBasis"
) -> "Material":
    from quietblade import materials

    axes = materials.surface_axes(blade, basis, part)
    if model == "homogenised":
        return materials.homogenised(laminate, axes)
    return materials.layered(laminate, axes, materials.surface_depth(blade, basis, part))


def isotropic(name: str, words: IsotropicWords) -> "IsotropicSVK":
    """Make the law of an isotropic material.

    Raises
    ------
    MaterialError
        Its constants are not admissible.
    """
    from quietblade import materials

    return materials.IsotropicSVK(
        name, words.density, words.E, words.nu, constant_loss(words), words.yield_strength
    )


def _orthotropic(name: str, words: OrthotropicWords) -> "OrthotropicSVK":
    from quietblade import materials

    strength = None if words.strengths is None else materials.PlyStrength(*words.strengths)
    return materials.OrthotropicSVK(
        name,
        words.density,
        e1=words.E1, e2=words.E2, e3=words.E3,
        g12=words.G12, g23=words.G23, g13=words.G13,
        nu12=words.ratio(1, 2), nu23=words.ratio(2, 3), nu13=words.ratio(1, 3),
        loss_factor=constant_loss(words),
        strength=strength,
    )  # fmt: skip


def _ply(case: Case, ply: PlyWords, repeat: int) -> "Ply":
    from quietblade import materials

    words = case.named_material(ply.material)
    share = None if ply.fraction is None else ply.fraction / repeat
    match words:
        case IsotropicWords():
            solid: IsotropicSVK | OrthotropicSVK = isotropic(ply.material, words)
        case OrthotropicWords():
            solid = _orthotropic(ply.material, words)
        case _:
            raise MaterialError(f"a ply cannot have the law {words.law} of {ply.material!r}")
    return materials.Ply(solid, ply.angle, ply.thickness, share)


def _solid_regions(basis: "NodalBasis") -> str:
    present = set(basis.fem.GetMaterials())
    return "|".join(part for part in ("blade", "film") if part in present)
