# SPDX-License-Identifier: LGPL-2.1-or-later
"""The film's complex modulus as a function of its static strain (theory: S2-53)."""

from collections.abc import Sequence
from itertools import pairwise

import ngsolve as ngs
import numpy as np
from scipy.sparse import csr_matrix

from quietblade.propulsion.structure import Structure, StructureState


def equivalent_shear(structure: Structure, state: StructureState) -> ngs.CoefficientFunction:
    """Give the static shear of the film, gamma = sqrt(J^-2/3 tr(F^T F) - 3), a function of place.

    Of a simple shear it is the amount of shear, and a change of volume does not count.
    """
    forms = structure.forms
    F = forms.gradient(forms.displacement(state.displacement))
    excess = ngs.Det(F) ** (-2 / 3) * ngs.InnerProduct(F, F) - 3.0
    return ngs.sqrt(ngs.IfPos(excess, excess, 0.0))


def prestrain_parts(
    structure: Structure, state: StructureState, strains: Sequence[float]
) -> list[csr_matrix]:
    """Split the film's isochoric material stiffness by its static shear.

    Part j has the weight of a hat function of the shear that is one at ``strains[j]`` and zero at
    its neighbours; beyond the ends the weights are constant.  The parts add up to the piece
    ``film_isochoric_material`` of the tangent, and with a complex modulus for each part the modulus
    is interpolated linearly between them.

    Parameters
    ----------
    structure : Structure
        With a film.
    state : StructureState
        Equilibrium.
    strains : sequence of float
        Shear strains of a table, ascending; one at least.

    Returns
    -------
    list of (ndof, ndof) csr_matrix
        Numbered as the tangent.

    Raises
    ------
    ValueError
        If the strains do not ascend, or there is no film.
    """
    if not structure.forms.mixed:
        raise ValueError("the structure has no film whose loss could depend on its strain")
    if len(strains) == 0 or not all(a < b for a, b in pairwise(strains)):
        raise ValueError(f"the strains of a table must ascend, got {list(strains)}")
    forms, gamma = structure.forms, equivalent_shear(structure, state)
    base, nothing = forms.displacement(state.displacement), np.zeros(forms.ndof)
    return [
        forms.linearise(forms.isochoric_terms(base, weight=hat), nothing)
        for hat in _hats(gamma, strains)
    ]


def _hats(gamma: ngs.CoefficientFunction, at: Sequence[float]) -> list[ngs.CoefficientFunction]:
    """Hat functions of gamma, which add up to one."""
    above = [ngs.CF(1.0)]  # rises from 0 to 1 up to each strain
    for low, high in pairwise(at):
        rise = (gamma - low) / (high - low)
        above.append(ngs.IfPos(rise, ngs.IfPos(1.0 - rise, rise, 1.0), 0.0))
    above.append(ngs.CF(0.0))
    return [own - following for own, following in pairwise(above)]
