# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tangent of the structure about an equilibrium: the solid's share of step 2.

All matrices are real, symmetric, and numbered like the product space (displacement, then film
pressure), fixed unknowns included (theory: S2-1).
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np
import scipy.sparse.linalg as spl
from scipy.sparse import csr_matrix, diags

from quietblade.propulsion.forms import StructuralForms
from quietblade.propulsion.structure import Structure, StructureState
from quietblade.typing import BoolArray

StiffnessForm = Literal["full", "paper"]
LossForm = Literal["isochoric", "paper"]


@dataclass(frozen=True, eq=False)
class Tangent:
    """Pieces of the structural tangent at an equilibrium (u1, p1).

    Attributes
    ----------
    elastic : csr array
        Material and geometric stiffness of the regions without film pressure.
    film : csr array
        Whole second variation of the mixed energy: its u, u-p and p blocks.
    film_isochoric_material : csr array
        ``dE : C_iso : dE`` of the film at fixed E0, the part that shears material; film pressure,
        bulk stiffness and initial stress have no share in it.
    load : csr array
        Symmetric part of the follower pressure's stiffness at fixed p1.
    spin : csr array
        ``-omega^2 M_perp``, M_perp the mass of the motion normal to the axis (spin softening).
    mass : csr array
        Mass of the undeformed configuration.
    dropped_load : float
        Frobenius norm of the skew part of the load stiffness relative to that of `load`, both on
        the free unknowns.
    loss_factor : float
        Loss factor of the film's material.
    free : (ndof,) bool array
        Unknowns of the solid that are not held.
    """

    elastic: csr_matrix
    film: csr_matrix
    film_isochoric_material: csr_matrix
    load: csr_matrix
    spin: csr_matrix
    mass: csr_matrix
    dropped_load: float
    loss_factor: float
    free: BoolArray

    def stiffness(self, form: StiffnessForm = "full") -> csr_matrix:
        """Stiffness at the equilibrium.

        Parameters
        ----------
        form : {"full", "paper"}
            ``full``: elastic, film, load stiffness and spin softening.  ``paper``: elastic and film
            only; the prestress then acts without the load that balances it.
        """
        if form == "full":
            return csr_matrix(self.elastic + self.film + self.load + self.spin)
        if form == "paper":
            return csr_matrix(self.elastic + self.film)
        raise ValueError(f"stiffness form {form!r} is neither 'full' nor 'paper'")

    def loss(self, form: LossForm = "isochoric") -> csr_matrix:
        """Matrix L of the complex stiffness ``K + i L``.

        Parameters
        ----------
        form : {"isochoric", "paper"}
            ``isochoric``: eta times the isochoric material stiffness of the film.  ``paper``: eta
            times the film's whole u-p block; condensing p makes this ``(1 + i eta) K_v``.
        """
        if form == "isochoric":
            return csr_matrix(self.loss_factor * self.film_isochoric_material)
        if form == "paper":
            return csr_matrix(self.loss_factor * self.film)
        raise ValueError(f"loss form {form!r} is neither 'isochoric' nor 'paper'")


def compute_tangent(structure: Structure, state: StructureState) -> Tangent:
    """Assemble the tangent of a structure at an equilibrium.

    Parameters
    ----------
    structure : Structure
        Mesh, materials and supports.
    state : StructureState
        Equilibrium; its own loads count. `Structure.rest()` gives the tangent of C0.
    """
    forms, at = structure.forms, state.unknowns
    nothing = np.zeros(forms.ndof)
    base = forms.displacement(state.displacement)
    mass = forms.linearise(forms.inertia_terms(), nothing)
    mass.eliminate_zeros()  # it does not couple the components of the displacement
    load, dropped = _load_stiffness(forms, state)
    return Tangent(
        elastic=forms.linearise(forms.elastic_terms(), at),
        film=forms.linearise(forms.mixed_terms(), at),
        film_isochoric_material=forms.linearise(forms.isochoric_terms(base), nothing),
        load=load,
        spin=_spin_softening(forms, mass, state.loading.spin_squared),
        mass=mass,
        dropped_load=dropped,
        loss_factor=max((m.loss_factor for m in forms.mixed.values()), default=0.0),
        free=forms.free,
    )


def _load_stiffness(forms: StructuralForms, state: StructureState) -> tuple[csr_matrix, float]:
    """Symmetric part of the pressure's stiffness, and the relative norm of the skew part."""
    forms.set_loading(state.loading)
    whole = forms.linearise(forms.pressure_terms(), state.unknowns)
    symmetric, skew = 0.5 * (whole + whole.T), 0.5 * (whole - whole.T)
    norms = [float(spl.norm(part[forms.free][:, forms.free])) for part in (symmetric, skew)]
    return symmetric.tocsr(), norms[1] / norms[0] if norms[0] > 0.0 else 0.0


def _spin_softening(forms: StructuralForms, mass: csr_matrix, spin_squared: float) -> csr_matrix:
    """``-omega^2 M_perp``: the mass of the components across the axis."""
    across = np.zeros(forms.ndof)
    across[forms.n_displacement // 3 : forms.n_displacement] = 1.0
    return csr_matrix(diags(-spin_squared * across) @ mass)
