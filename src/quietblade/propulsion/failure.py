# SPDX-License-Identifier: LGPL-2.1-or-later
"""Failure indices: how near a stress or strain is to the strength of the material.

Every index grows in proportion to the load, as long as the stress does: failure is at 1, and the
load may grow by the factor 1 / index.
"""

from collections.abc import Mapping
from functools import singledispatch
from typing import Protocol

import numpy as np

from quietblade.materials import IsotropicSVK, OrthotropicSVK
from quietblade.materials.strength import PlyStrength
from quietblade.typing import FloatArray


class HasFields(Protocol):
    """What the indices need to know of a state (`quietblade.propulsion.stress.Fields`)."""

    @property
    def von_mises(self) -> FloatArray:
        """Von Mises stress [Pa]."""

    @property
    def material_strain(self) -> FloatArray | None:
        """Green-Lagrange strain in the material axes."""

    @property
    def material_stress(self) -> FloatArray | None:
        """Second Piola-Kirchhoff stress in the material axes [Pa]."""


def tsai_hill(stress: FloatArray, strength: PlyStrength) -> FloatArray:
    """Tsai-Hill index of stresses in the plane of a ply.

    Parameters
    ----------
    stress : (..., 3, 3) float array
        In the ply's axes [Pa]; the components 11, 22 and 12 count.
    strength : PlyStrength
        Tension or compression is chosen by the sign of each stress.

    Returns
    -------
    (...,) float array
        Square root of ``(s11/X)^2 - s11 s22/X^2 + (s22/Y)^2 + (s12/S)^2`` (theory: S1-66).
    """
    s11, s22, s12 = stress[..., 0, 0], stress[..., 1, 1], stress[..., 0, 1]
    X = np.where(s11 >= 0.0, strength.xt, strength.xc)
    Y = np.where(s22 >= 0.0, strength.yt, strength.yc)
    square = (s11**2 - s11 * s22) / X**2 + (s22 / Y) ** 2 + (s12 / strength.s12) ** 2
    # the form is positive unless X < Y / 2 (fibres weaker than the matrix)
    return np.asarray(np.sqrt(np.maximum(square, 0.0)))


def maximum_strain(strain: FloatArray, limits: PlyStrength) -> FloatArray:
    """Largest ratio of a strain in the plane of a ply to its limit.

    Parameters
    ----------
    strain : (..., 3, 3) float array
        In the ply's axes; 11, 22 and the engineering shear ``2 E12`` count.
    limits : PlyStrength
        Strains at failure in the places of the strengths (see `strain_limits`).

    Returns
    -------
    (...,) float array
        (theory: S1-65)
    """
    e11, e22, shear = strain[..., 0, 0], strain[..., 1, 1], 2.0 * np.abs(strain[..., 0, 1])
    ratios = (e11 / limits.xt, -e11 / limits.xc, e22 / limits.yt, -e22 / limits.yc)
    return np.asarray(np.max([*ratios, shear / limits.s12], axis=0))


def strain_limits(ply: OrthotropicSVK) -> PlyStrength:
    """Strains at failure of a ply under one stress alone: strength over modulus.

    Raises
    ------
    ValueError
        If the ply has no strengths.
    """
    if ply.strength is None:
        raise ValueError(f"material {ply.name!r} has no strengths")
    s = ply.strength
    return PlyStrength(s.xt / ply.e1, s.xc / ply.e1, s.yt / ply.e2, s.yc / ply.e2, s.s12 / ply.g12)


def margin_to_yield(von_mises: FloatArray, yield_strength: float) -> FloatArray:
    """Share by which a load may grow until a metal yields: ``yield / von Mises - 1``."""
    with np.errstate(divide="ignore"):
        return np.asarray(yield_strength / von_mises - 1.0)


def failure_indices(material: object, fields: HasFields) -> Mapping[str, FloatArray]:
    """All indices that the strengths of a material allow, by name, (n,) each.

    ``yield``: von Mises stress over yield strength.  ``tsai_hill`` and ``maximum_strain``: of an
    orthotropic solid in its own axes.  Empty if the material has no strengths.
    """
    return _indices(material, fields)


@singledispatch
def _indices(material: object, fields: HasFields) -> dict[str, FloatArray]:
    return {}


@_indices.register
def _(material: IsotropicSVK, fields: HasFields) -> dict[str, FloatArray]:
    if material.yield_strength is None:
        return {}
    return {"yield": fields.von_mises / material.yield_strength}


@_indices.register
def _(material: OrthotropicSVK, fields: HasFields) -> dict[str, FloatArray]:
    stress, strain = fields.material_stress, fields.material_strain
    if material.strength is None or stress is None or strain is None:
        return {}
    return {
        "tsai_hill": tsai_hill(stress, material.strength),
        "maximum_strain": maximum_strain(strain, strain_limits(material)),
    }
