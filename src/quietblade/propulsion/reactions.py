# SPDX-License-Identifier: LGPL-2.1-or-later
"""Forces and moments of the support, and their balance with the loads (theory: S1-68)."""

from dataclasses import dataclass

import numpy as np

from quietblade.propulsion.structure import Structure, StructureState
from quietblade.typing import FloatArray


@dataclass(frozen=True, eq=False)
class Reaction:
    """What the support does to the structure, and what the loads do.

    Attributes
    ----------
    force, moment : (3,) float arrays
        Of held displacements and elastic supports on the structure [N], [N m], as it is deformed.
    applied_force, applied_moment : (3,) float arrays
        Of pressure, spin and dead loads on it.
    about : (3,) float array
        Point of the moments [m].
    force_imbalance, moment_imbalance : float
        ``|reaction + applied| / |applied|``; NaN without loads.  Both sums are taken from the
        weak form, so that what remains is the residual of the iteration.
    """

    force: FloatArray
    moment: FloatArray
    applied_force: FloatArray
    applied_moment: FloatArray
    about: FloatArray
    force_imbalance: float
    moment_imbalance: float


def compute_reaction(
    structure: Structure, state: StructureState, about: FloatArray | None = None
) -> Reaction:
    """Sum the forces of held displacements and elastic supports.

    Parameters
    ----------
    structure : Structure
        Mesh, materials and supports.
    state : StructureState
        An equilibrium.
    about : (3,) array or None
        Point of the moments in space [m]; default the origin, on the rotor axis.
    """
    point = np.zeros(3) if about is None else np.asarray(about, dtype=float)
    forms, basis = structure.forms, structure.basis
    n = forms.n_displacement
    external = structure.external_force(state)[:n]
    springs = structure.support_force(state)[:n]
    residual = structure.internal_force(state)[:n] - external - springs
    support = springs + np.where(forms.free[:n], 0.0, residual)
    # virtual displacements: of a translation and, as theta x position, of a rotation
    ones = basis.to_dofs(np.ones(len(basis.points)))
    positions = (basis.to_dofs(basis.points - point) + state.displacement).reshape(3, -1)
    force, moment = _resultant(support.reshape(3, -1), ones, positions)
    applied_force, applied_moment = _resultant(external.reshape(3, -1), ones, positions)
    return Reaction(
        force,
        moment,
        applied_force,
        applied_moment,
        point,
        _imbalance(force, applied_force),
        _imbalance(moment, applied_moment),
    )


def _resultant(
    forces: FloatArray, ones: FloatArray, positions: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Force and moment of forces (3, unknowns): their work at unit translations and rotations."""
    return forces @ ones, np.asarray(np.cross(positions.T, forces.T).sum(axis=0))


def _imbalance(reaction: FloatArray, applied: FloatArray) -> float:
    size = float(np.linalg.norm(applied))
    return float(np.linalg.norm(reaction + applied)) / size if size > 0.0 else float("nan")
