# SPDX-License-Identifier: LGPL-2.1-or-later
"""Laminates and orthotropic solids against laminate theory and published beams."""

from functools import cache

import ngsolve as ngs
import numpy as np

from quietblade.materials import (
    AnisotropicSVK,
    Depth,
    ElasticMaterial,
    IsotropicSVK,
    Laminate,
    OrthotropicSVK,
    Ply,
    beam_stiffness,
    find_material,
    homogenised,
    layered,
    plate_stiffness,
    ply_axes,
    section_directions,
)
from quietblade.mesh.nodal import NodalBasis
from quietblade.typing import FloatArray
from verification.registry import check
from verification.structure_models import box_mesh, voigt_stiffness

_THEORY = "transformed compliance of a woven ply at 45 degrees (Jones, Mechanics of Composites)"
_CLT = "classical laminate theory (Jones, Mechanics of Composite Materials, ch. 4)"
_STRIP = "Akcabay and Young's composite strip, as in the tests of mdolab/DCFoil.jl"
_PURE = "pure bending of an anisotropic prism: curvature S11 M / I, twist S16 M / I"


def laminate_compliance() -> FloatArray:
    """Compliance (6, 6) [1/Pa] of the woven ply at 45 degrees, in the blade frame."""
    weave = find_material("woven-carbon-paper")
    assert isinstance(weave, OrthotropicSVK)
    turned = weave.oriented(ply_axes(np.pi / 4, *section_directions()))
    return np.linalg.inv(voigt_stiffness(turned))


# References are given to four or five digits.
@check("structure/laminate-modulus", quantity="modulus of the laminate along the span [GPa]",
       reference=17.426, source=_THEORY, tolerance=1e-3)  # fmt: skip
def _modulus() -> float:
    return float(1e-9 / laminate_compliance()[2, 2])


@check("structure/laminate-poisson", quantity="Poisson's ratio, span to chord", reference=0.7426,
       source=_THEORY, tolerance=1e-4)  # fmt: skip
def _poisson() -> float:
    S = laminate_compliance()
    return float(-S[0, 2] / S[2, 2])


# -- a strip with one ply angle, and its extremes over the angle ---------------------------------


def strip(
    angle: float,
    *,
    e1: float = 117.8e9,
    e2: float = 13.4e9,
    g12: float = 3.9e9,
    nu12: float = 0.25,
    width: float = 0.1,
    thickness: float = 0.012,
) -> tuple[float, float, float]:
    """EI, GJ and bend-twist coupling K [N m2] of a strip of one unidirectional ply.

    Parameters
    ----------
    angle : float
        Ply angle [rad].
    e1, e2, g12, nu12 : float
        Constants in the plane of the ply [Pa].
    width, thickness : float
        [m]
    """
    ply = OrthotropicSVK("ply", 1590.0, e1, e2, e2, g12, g12, g12, nu12, nu12, nu12)
    plate = plate_stiffness([Ply(ply, angle, fraction=1.0).stiffness], [thickness])
    beam = beam_stiffness(plate.D, width)
    return beam.bending, beam.torsion, beam.coupling


@cache
def _strips() -> FloatArray:
    return np.array([strip(angle) for angle in np.linspace(-np.pi / 2, np.pi / 2, 721)])


# Six digits are published; the extremes were taken over some table of angles.
@check("structure/laminate-strip-ei-90", quantity="EI of the strip, fibres across [N m2]",
       reference=192.96, source=_STRIP, tolerance=0.01)  # fmt: skip
def _strip_across() -> float:
    return strip(np.pi / 2)[0]


@check("structure/laminate-strip-gj-90", quantity="GJ of the strip, fibres across [N m2]",
       reference=224.64, source=_STRIP, tolerance=0.01)  # fmt: skip
def _strip_torsion() -> float:
    return strip(np.pi / 2)[1]


@check("structure/laminate-strip-gj-max", quantity="largest GJ over the ply angle [N m2]",
       reference=1055.22, source=_STRIP, tolerance=0.5)  # fmt: skip
def _strip_largest_torsion() -> float:
    return float(_strips()[:, 1].max())


@check("structure/laminate-strip-coupling", quantity="largest coupling over the ply angle [N m2]",
       reference=778.83, source=_STRIP, tolerance=0.5)  # fmt: skip
def _strip_coupling() -> float:
    return float(np.abs(_strips()[:, 2]).max())


# -- beams of finite elements --------------------------------------------------------------------


def bent_prism(
    law: ElasticMaterial, *, width: float, height: float, length: float, cells: int
) -> tuple[float, float]:
    """Curvature and twist rate [rad/m] of a prism of second-order bricks, for a unit moment.

    The prism lies along z with its height along y.  Both ends carry the tractions ``M y / I``;
    the rigid motions are held by a soft foundation that the balanced load does not feel.

    Parameters
    ----------
    law : ElasticMaterial
        Oriented.
    width, height, length : float
        [m]
    cells : int
        Cells along the length; two across the width, one across the height.

    Returns
    -------
    curvature, twist : float
        ``-v''`` and the rate of rotation about z, positive from x to y, per N m.
    """
    x, y = 0.5 * width * np.array([-1.0, 0.0, 1.0]), 0.5 * height * np.array([-1.0, 1.0])
    mesh = box_mesh(x, y, length * np.linspace(-0.5, 0.5, cells + 1))
    space = ngs.VectorH1(mesh, order=2)
    u, v = space.TnT()
    form = ngs.BilinearForm(space)
    strain = 0.5 * (ngs.Grad(u) + ngs.Grad(u).trans)
    form += ngs.Variation(law.energy_of_strain(strain).Compile() * ngs.dx)
    softness = 1e-9 * law_modulus(law) / length**2
    form += ngs.Variation(softness * ngs.InnerProduct(u, u) * ngs.dx)
    load = ngs.LinearForm(space)
    traction = ngs.y / (width * height**3 / 12.0)
    load += traction * v[2] * ngs.ds("tip") - traction * v[2] * ngs.ds("root")
    solution = ngs.GridFunction(space)
    form.AssembleLinearization(solution.vec)
    inverse = form.mat.Inverse(space.FreeDofs(), inverse="sparsecholesky")
    solution.vec.data = inverse * load.Assemble().vec
    # mean of a field of linear strains and rotations: the quadratic displacement gives both
    at, h = 0.25 * length, 0.24 * width
    middle, ahead, behind = (solution(mesh(0.0, 0.0, z)) for z in (0.0, at, -at))
    curvature = -(ahead[1] + behind[1] - 2.0 * middle[1]) / at**2
    turns = [
        (solution(mesh(h, 0.0, z))[1] - solution(mesh(-h, 0.0, z))[1]) / (2.0 * h)
        for z in (at, -at)
    ]
    return float(curvature), float((turns[0] - turns[1]) / (2.0 * at))


def law_modulus(law: ElasticMaterial) -> float:
    """Largest entry of a law's stiffness [Pa]."""
    return float(np.abs(voigt_stiffness(law)).max())


_SIZES = {"width": 0.1, "height": 0.012, "length": 0.6, "cells": 6}
_AXES = ply_axes(0.0, *section_directions())


@cache
def _off_axis(angle: float) -> tuple[float, float]:
    ud = find_material("carbon-epoxy-t300")
    assert isinstance(ud, OrthotropicSVK)
    law = ud.oriented(ply_axes(angle, *section_directions()))
    inertia = _SIZES["width"] * _SIZES["height"] ** 3 / 12.0
    S = np.linalg.inv(Ply(ud, angle, fraction=1.0).stiffness)
    curvature, twist = bent_prism(law, **_SIZES)  # type: ignore[arg-type]
    # the shear strain S16 M y / I of span and chord is -2 y times the twist
    return curvature * inertia / S[0, 0], twist * inertia / (-0.5 * S[0, 5])


# The solution is a polynomial of degree 2, which the elements contain: rounding, and the
# foundation.
@check("structure/orthotropic-bending", quantity="curvature of a prism, fibres at 30 deg, ratio",
       reference=1.0, source=_PURE, tolerance=1e-5)  # fmt: skip
def _off_axis_bending() -> float:
    return _off_axis(np.radians(30.0))[0]


@check("structure/orthotropic-bend-twist",
       quantity="twist of a bent prism, fibres at 30 deg, ratio",
       reference=1.0, source=_PURE, tolerance=1e-5)  # fmt: skip
def _off_axis_twist() -> float:
    return _off_axis(np.radians(30.0))[1]


def stacked_beam(
    laminate: Laminate, *, model: str = "plies", cells_across: int = 1, height: float = 0.012
) -> float:
    """Bending stiffness per width [N m] of a stacked plate from solid elements, over that of CLT.

    The plate is bent to a cylinder, which stores ``1/2 D11 k^2`` for each unit of area where the
    plane stress of laminate theory may form: the displacement across the thickness is free.

    Parameters
    ----------
    laminate : Laminate
    model : {"plies", "homogenised"}
    cells_across : int
        Second-order bricks across the thickness.
    height : float
        Thickness [m].
    """
    y = height * np.linspace(-0.5, 0.5, cells_across + 1)
    side = np.array([-1.0, 0.0, 1.0]) * 2.0 * height
    mesh = box_mesh(side, y, side)
    basis = NodalBasis(mesh)
    at = basis.points[basis.nodes_of(".*"), 1]
    depth = Depth.of_nodes(basis, ".*", at + 0.5 * height, 0.5 * height - at)
    law: AnisotropicSVK = (
        layered(laminate, _AXES, depth) if model == "plies" else homogenised(laminate, _AXES)
    )
    space = ngs.VectorH1(mesh, order=2)
    form = ngs.BilinearForm(space)
    du = ngs.Grad(space.TrialFunction())
    energy = law.energy_of_strain(0.5 * (du + du.trans))
    form += ngs.Variation(energy.Compile() * ngs.dx(bonus_intorder=law.extra_order))
    bent = ngs.GridFunction(space)
    form.AssembleLinearization(bent.vec)
    bent.Set(ngs.CF((0.0, -0.5 * ngs.z**2, ngs.y * ngs.z)))
    n = space.ndof // 3
    free = ngs.BitArray(space.ndof)
    free.Clear()
    for dof in range(n, 2 * n):
        free.Set(dof)
    for dof in np.flatnonzero(np.array(ngs.H1(mesh, order=2).GetDofs(mesh.Boundaries("lower")))):
        free.Clear(n + int(dof))  # against rigid motion of the middle; the thickness stays free
    force = bent.vec.CreateVector()
    force.data = form.mat * bent.vec
    bent.vec.data -= form.mat.Inverse(free, inverse="sparsecholesky") * force
    force.data = form.mat * bent.vec
    stored = float(ngs.InnerProduct(force, bent.vec)) / (4.0 * height) ** 2
    return stored / float(laminate.abd(height).D[0, 0])


def _stack(*angles: float) -> Laminate:
    ud = find_material("carbon-epoxy-t300")
    assert isinstance(ud, OrthotropicSVK)
    plies = tuple(Ply(ud, np.radians(a), fraction=1.0 / len(angles)) for a in angles)
    return Laminate("stack", plies)


def sandwich(share: float, core: IsotropicSVK) -> Laminate:
    """Faces of carbon along the span, each of a share of the half thickness, on a core."""
    ud = find_material("carbon-epoxy-t300")
    assert isinstance(ud, OrthotropicSVK)
    return Laminate("sandwich", (Ply(ud, 0.0, fraction=share), Ply(core, 0.0, fraction=1 - share)))


# Laminate theory takes plane stress; second-order bricks bring it out exactly where the strain
# across the thickness is linear.
@check("structure/laminate-bending-cross-ply", quantity="D11 of [0/90]s, one brick across, ratio",
       reference=1.0, source=_CLT, tolerance=1e-3)  # fmt: skip
def _cross_ply() -> float:
    return stacked_beam(_stack(0.0, 90.0))


@check("structure/laminate-bending-quasi-isotropic",
       quantity="D11 of [0/45/-45/90]s, two bricks across, ratio",
       reference=1.0, source=_CLT, tolerance=1e-3)  # fmt: skip
def _quasi_isotropic() -> float:
    return stacked_beam(_stack(0.0, 45.0, -45.0, 90.0), cells_across=2)


@check("structure/laminate-bending-sandwich", quantity="D11 of a sandwich, one brick, ratio",
       reference=1.0, source=_CLT, tolerance=1e-3)  # fmt: skip
def _sandwich() -> float:
    return stacked_beam(sandwich(0.1, IsotropicSVK("foam", 250.0, 200e6, 0.3)))


@check("structure/laminate-homogenised-error",
       quantity="D11 of the homogenised [0/90]s over that of the stack",
       reference=0.6100, source=_CLT, tolerance=1e-3)  # fmt: skip
def _homogenised() -> float:
    return stacked_beam(_stack(0.0, 90.0), model="homogenised")
