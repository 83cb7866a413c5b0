# SPDX-License-Identifier: LGPL-2.1-or-later
"""Material laws in the words of CalculiX and Abaqus."""

from collections.abc import Iterator
from functools import singledispatch

import ngsolve as ngs
import numpy as np

from quietblade.errors import MaterialError
from quietblade.materials import IsotropicSVK, Material, MooneyRivlin, OrthotropicSVK
from quietblade.materials.anisotropic import AnisotropicSVK
from quietblade.materials.neo_hookean import NeoHookean


@singledispatch
def law_lines(material: object) -> Iterator[str]:
    """Cards of the stress-strain law, without ``*MATERIAL`` and ``*DENSITY``.

    Under ``*STEP, NLGEOM`` CalculiX's ``*ELASTIC`` is linear between Green-Lagrange strain and
    second Piola-Kirchhoff stress: Saint-Venant-Kirchhoff.  Abaqus takes logarithmic strain and
    Cauchy stress instead; the difference is of the order of the strain.

    Raises
    ------
    MaterialError
        If the law has no counterpart there.
    """
    raise MaterialError(
        f"deck: {type(material).__name__} has no counterpart in CalculiX; Saint-Venant-Kirchhoff, "
        "neo-Hookean and Mooney-Rivlin materials can be exported"
    )


@law_lines.register
def _(material: IsotropicSVK) -> Iterator[str]:
    yield "*ELASTIC"
    yield f"{material.youngs_modulus:.12g}, {material.poisson_ratio:.12g}"


@law_lines.register
def _(material: OrthotropicSVK) -> Iterator[str]:
    m = material
    yield "*ELASTIC, TYPE=ENGINEERING CONSTANTS"
    first = (m.e1, m.e2, m.e3, m.nu12, m.nu13, m.nu23, m.g12, m.g13)
    yield ", ".join(f"{constant:.10g}" for constant in first)
    yield f"{m.g23:.12g}"


@law_lines.register
def _(material: AnisotropicSVK) -> Iterator[str]:
    if isinstance(material.stiffness, ngs.CoefficientFunction):
        raise MaterialError(
            f"deck: the stiffness of material {material.name!r} changes from place to place, as "
            "that of plies in their places does; export the homogenised laminate"
        )
    # upper triangle by columns, for the components 11, 22, 33, 12, 13, 23
    order = [0, 1, 2, 5, 4, 3]
    C = np.asarray(material.stiffness)[np.ix_(order, order)]
    entries = [f"{C[row, column]:.10g}" for column in range(6) for row in range(column + 1)]
    yield "*ELASTIC, TYPE=ANISO"
    for i in range(0, len(entries), 8):
        yield ", ".join(entries[i : i + 8])


@law_lines.register
def _(material: NeoHookean) -> Iterator[str]:
    yield "*HYPERELASTIC, NEO HOOKE"
    yield f"{0.5 * material.shear_modulus:.12g}, {2.0 / material.bulk_modulus:.12g}"


@law_lines.register
def _(material: MooneyRivlin) -> Iterator[str]:
    # (J - 1)^2 / D1 of these programs is K/2 (J - 1)^2
    yield "*HYPERELASTIC, MOONEY-RIVLIN"
    yield f"{material.c10:.12g}, {material.c01:.12g}, {2.0 / material.bulk_modulus:.12g}"


def material_lines(name: str, material: Material) -> Iterator[str]:
    """``*MATERIAL`` block of a law under a name of the deck.

    Raises
    ------
    MaterialError
        If the law has no counterpart, or a constant changes from place to place.
    """
    if isinstance(material.density, ngs.CoefficientFunction):
        raise MaterialError(
            f"deck: the density of material {material.name!r} changes from place to place; "
            "export the homogenised laminate"
        )
    yield f"*MATERIAL, NAME={name}"
    yield from law_lines(material)
    yield "*DENSITY"
    yield f"{material.density:.12g}"
