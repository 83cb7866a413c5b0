# SPDX-License-Identifier: LGPL-2.1-or-later
"""A structure in vacuo as the same kind of system as one in water."""

from collections.abc import Mapping
from dataclasses import dataclass

import ngsolve as ngs
import numpy as np
from scipy.sparse import csr_matrix

from quietblade.typing import BoolArray, ComplexArray
from quietblade.vibroacoustics.fluid import Water
from quietblade.vibroacoustics.loss import Loss, loss_term, lossy_parts
from quietblade.vibroacoustics.operators import Blocks, Operators


@dataclass(frozen=True)
class NoSphere:
    """There is no water, hence no condition."""

    name: str = "vacuum"

    def matrices(self, fem: ngs.Mesh, water: Water, outer: str) -> Mapping[str, csr_matrix]:
        """Nothing."""
        return {}

    def loads(
        self, fem: ngs.Mesh, water: Water, outer: str, radius: float
    ) -> Mapping[str, csr_matrix]:
        """Nothing."""
        return {}

    def factors(self, omega: complex, sound_speed: float, radius: float) -> Mapping[str, complex]:
        """Nothing."""
        return {}

    def coefficients(self, degree: int, kr: float) -> ComplexArray:
        """Zero for every degree."""
        return np.zeros(degree + 1, dtype=complex)


def dry_operators(
    *,
    stiffness: csr_matrix,
    mass: csr_matrix,
    free: BoolArray,
    displacements: int,
    loss: Loss = None,
) -> Operators:
    """System of a structure in vacuo, K + sum_r (g_r - 1) D_r - omega^2 M.

    Parameters
    ----------
    stiffness, mass : (ndof, ndof) csr_matrix
        In the numbering of displacement and film pressure, fixed unknowns included.
    free : (ndof,) bool array
        Unknowns that are not held (`Tangent.free`).
    displacements : int
        Number of the unknowns of displacement, which come first.
    loss : csr_matrix, mapping of name to csr_matrix or Lossy, or None
        As in `build_operators`.

    Returns
    -------
    Operators
        With empty terms of the water.
    """
    kept = np.flatnonzero(free)
    rows = np.arange(len(kept))
    blocks = Blocks(rows[kept < displacements], rows[kept >= displacements], rows[:0])
    parts = lossy_parts(loss)
    terms = {
        "K": stiffness,
        "M": mass,
        **{loss_term(region): part.matrix for region, part in parts.items()},
    }
    empty = csr_matrix((len(kept), len(kept)))
    return Operators(
        terms={
            **{name: csr_matrix(term[kept][:, kept]) for name, term in terms.items()},
            **dict.fromkeys("CHG", empty),
        },
        blocks=blocks,
        free=kept,
        first_potential=len(free),
        sound_speed=1.0,
        density=0.0,
        radius=1.0,
        condition=NoSphere(),
        moduli={region: part.ratio for region, part in parts.items()},
        exterior=empty,
    )
