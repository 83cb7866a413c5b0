# SPDX-License-Identifier: LGPL-2.1-or-later
"""Stress and strain of the plies of a laminate, and their failure indices.

All plies at a place have the same strains in their plane and the same stresses out of it; that is
how the effective solid is made, and between plies that are glued together it is exact.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import ngsolve as ngs
import numpy as np

from quietblade.materials import IsotropicSVK
from quietblade.materials.laminate import Laminate, Ply
from quietblade.materials.voigt import PAIRS, in_plane_rotation
from quietblade.propulsion.failure import (
    HasFields,
    maximum_strain,
    strain_limits,
    tsai_hill,
)
from quietblade.propulsion.tensors import in_axes, von_mises_stress
from quietblade.typing import FloatArray, IntArray

_PLANE, _OUT = [0, 1, 5], [2, 3, 4]


@dataclass(frozen=True, eq=False)
class Plies:
    """The laminate of a region.

    Attributes
    ----------
    laminate : Laminate
        The stack; the axes of the region's material are its axes.
    number : CoefficientFunction or None
        Position in the list (from 0) of the ply at a place, as from ``ply_number``, where every
        ply has its place; None for one effective solid, in which every ply is everywhere.
    """

    laminate: Laminate
    number: ngs.CoefficientFunction | None = None


def ply_state(ply: Ply, strain: FloatArray, stress: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Strain and stress of a ply in its own axes (theory: S1-67).

    Parameters
    ----------
    ply : Ply
        Its law and angle.
    strain, stress : (n, 3, 3) float arrays
        Of the laminate, in its axes; the strains in the plane (11, 22, 12) and the stresses out of
        it (33, 23, 13) [Pa] count.

    Returns
    -------
    strain, stress : (n, 3, 3) float arrays
        In the axes of the ply, [-] and [Pa].
    """
    C = ply.stiffness
    shear = np.array([1.0, 1.0, 1.0, 2.0, 2.0, 2.0])
    i, j = np.array(PAIRS).T
    e = strain[:, i, j] * shear
    s = stress[:, i, j]
    e_out = s[:, _OUT] - e[:, _PLANE] @ C[np.ix_(_PLANE, _OUT)]
    e[:, _OUT] = np.linalg.solve(C[np.ix_(_OUT, _OUT)], e_out.T).T
    own = np.broadcast_to(in_plane_rotation(ply.angle), strain.shape)
    return in_axes(_tensor(e / shear), own), in_axes(_tensor(e @ C), own)


def ply_failure(
    laminate: Laminate, fields: HasFields, number: IntArray | None = None
) -> Mapping[str, FloatArray]:
    """Failure indices of all plies that have strengths.

    Parameters
    ----------
    laminate : Laminate
    fields : Fields
        In the axes of the laminate.
    number : (n,) int array or None
        Ply at each place; None: all plies are everywhere.

    Returns
    -------
    mapping
        ``tsai_hill``, ``maximum_strain``, ``yield``: the worst ply at each place; and of each ply
        alone as ``"tsai_hill, ply 1"`` and so on, counted as in the list, zero where it is not.

    Raises
    ------
    ValueError
        If the region's material has no axes.
    """
    strain, stress = fields.material_strain, fields.material_stress
    if strain is None or stress is None:
        raise ValueError(f"laminate {laminate.name!r}: the material of its region has no axes")
    single: dict[str, FloatArray] = {}
    worst: dict[str, FloatArray] = {}
    for count, ply in enumerate(laminate.plies):
        here = 1.0 if number is None else (number == count).astype(float)
        for name, index in _indices(ply, *ply_state(ply, strain, stress)).items():
            single[f"{name}, ply {count + 1}"] = here * index
            worst[name] = np.maximum(worst.get(name, 0.0), here * index)
    return worst | single


def _indices(ply: Ply, strain: FloatArray, stress: FloatArray) -> dict[str, FloatArray]:
    material = ply.material
    if isinstance(material, IsotropicSVK):
        if material.yield_strength is None:
            return {}
        return {"yield": von_mises_stress(stress) / material.yield_strength}
    if material.strength is None:
        return {}
    return {
        "tsai_hill": tsai_hill(stress, material.strength),
        "maximum_strain": maximum_strain(strain, strain_limits(material)),
    }


def _tensor(components: FloatArray) -> FloatArray:
    """Symmetric tensors (n, 3, 3) of six tensor components each."""
    tensor = np.empty((len(components), 3, 3))
    for column, (i, j) in enumerate(PAIRS):
        tensor[:, i, j] = tensor[:, j, i] = components[:, column]
    return tensor
