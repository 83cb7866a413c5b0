# SPDX-License-Identifier: LGPL-2.1-or-later
"""Names of the modes of a sphere by the harmonics of its surface's motion.

The motion of the surface is split into a_lm Y_lm across it, b_lm grad Y_lm along it and
c_lm e_r x grad Y_lm around it, which are orthogonal on the sphere.  Modes of degree l that move it
in and out are ``n<l>``, those that only twist it ``t<l>``; the 2 l + 1 modes of a degree are
told apart by a second number, in ascending frequency: ``n2.1`` to ``n2.5``.
"""

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from quietblade.mesh.surface import SurfaceQuadrature
from quietblade.typing import BoolArray, FloatArray
from quietblade.vibroacoustics.harmonics import solid_harmonics
from quietblade.vibroacoustics.naming import FAMILIES, MIXED

HIGHEST = 16
"""Highest degree that is looked for."""


@dataclass(frozen=True, eq=False)
class DegreeNaming:
    """Names of a set of modes.

    Attributes
    ----------
    name : tuple of str, length m
        No two alike.
    character : tuple of str, length m
        ``rigid``, ``degree 2``, ``torsion 2``, or ``mixed``.
    purity : (m,) array
        Share of the surface's mean square motion in the degree of the name; one of a rigid motion.
    shares : (m, 4) array
        Of the families of a blade's modes: nan.
    """

    name: tuple[str, ...]
    character: tuple[str, ...]
    purity: FloatArray
    shares: FloatArray


def name_by_degree(
    surface: SurfaceQuadrature, shapes: FloatArray, rigid: BoolArray
) -> DegreeNaming:
    """Name modes of a sphere about the origin.

    Parameters
    ----------
    surface : SurfaceQuadrature
        The sphere.
    shapes : (m, nodes, 3) float array
        Displacement of its nodes; real.
    rigid : (m,) bool array
        Which modes are rigid motions.
    """
    split = degree_shares(surface, shapes)
    chosen = np.argmax(split, axis=1)
    families, characters, purity = [], [], np.ones(len(shapes))
    for mode, place in enumerate(chosen.tolist()):
        torsion, degree = divmod(place, HIGHEST + 1)
        if rigid[mode]:
            families.append("rigid")
            characters.append("rigid")
            continue
        purity[mode] = split[mode, place]
        families.append(f"{'t' if torsion else 'n'}{degree}")
        word = f"{'torsion' if torsion else 'degree'} {degree}"
        characters.append(word if purity[mode] >= MIXED else "mixed")
    nothing = np.full((len(shapes), len(FAMILIES)), np.nan)
    return DegreeNaming(tuple(_numbered(families)), tuple(characters), purity, nothing)


def degree_shares(surface: SurfaceQuadrature, shapes: FloatArray) -> FloatArray:
    """Shares of the degrees in the surface's mean square motion.

    Returns
    -------
    (m, 2 (`HIGHEST` + 1)) array
        Motion in, out and along, degrees 0 to `HIGHEST`; then motion around.
    """
    places = surface.positions(surface.points).reshape(-1, 3)
    radius = np.linalg.norm(places, axis=1)
    outward = places / radius[:, None]
    areas = np.linalg.norm(surface.area_vectors(surface.points).reshape(-1, 3), axis=1)
    weight = areas / radius**2
    moved = np.array([surface.positions(shape).reshape(-1, 3) for shape in shapes])
    moved = moved.reshape(len(shapes), len(places), 3)
    total = np.einsum("q,mqi,mqi->m", weight, moved, moved)
    weighted = moved * weight[:, None]
    across = np.einsum("mqi,qi->mq", weighted, outward)
    shares = np.zeros((2, HIGHEST + 1, len(shapes)))
    for degree in range(HIGHEST + 1):
        values, gradients = solid_harmonics(outward, degree)
        shares[0, degree] = _squares(across @ values.T)
        if degree:
            along = gradients.transpose(0, 2, 1) - degree * values[..., None] * outward
            around = np.cross(outward, along)
            for row, field in enumerate((along, around)):
                parts = np.einsum("mqi,kqi->mk", weighted, field)
                shares[row, degree] += _squares(parts) / (degree * (degree + 1))
    return np.asarray((shares / total).reshape(2 * (HIGHEST + 1), len(shapes)).T)


def _squares(rows: FloatArray) -> FloatArray:
    return np.asarray(np.sum(rows**2, axis=1))


def _numbered(families: Iterable[str]) -> Iterable[str]:
    count: Counter[str] = Counter()
    for family in families:
        count[family] += 1
        yield f"{family}.{count[family]}"
