# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tangent of the structure about an equilibrium: the solid's share of step 2.

All matrices are real, symmetric, and numbered like the product space (displacement, then film
pressure), fixed unknowns included (theory: S2-1, S2-2, S1-58).
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import ngsolve as ngs
import numpy as np
import scipy.sparse.linalg as spl
from scipy.sparse import csr_matrix, diags

from quietblade.errors import Notice
from quietblade.propulsion.forms import StructuralForms
from quietblade.propulsion.structure import Structure, StructureState
from quietblade.typing import BoolArray, FloatArray

StiffnessForm = Literal["full", "paper"]
LossForm = Literal["isochoric", "paper"]

ELASTIC = ("elastic_material", "elastic_geometric")
FILM = ("film_isochoric_material", "film_geometric", "film_pressure", "film_constraint")
STIFFNESS: Mapping[str, tuple[str, ...]] = {
    "full": (*ELASTIC, *FILM, "load", "spin", "support"),
    "paper": (*ELASTIC, *FILM, "support"),
}
"""Names of the pieces that each stiffness form adds up."""

MUCH_DROPPED = 0.5
"""Skew part of the load stiffness, relative to the symmetric one, beyond which it is noticed."""


@dataclass(frozen=True, eq=False)
class Tangent:
    """Pieces of the structural tangent at an equilibrium (u1, p1).

    Attributes
    ----------
    pieces : mapping of str to csr array
        Stiffness by name [N/m, m2, m3/Pa]:

        ``elastic_material``: ``dE : C : dE`` of the regions without film pressure;
        ``elastic_geometric``: ``S1 : grad v^T grad u`` of these regions;
        ``film_isochoric_material``: ``dE : C_iso : dE`` of the film, the part that shears material;
        ``film_geometric``: that of the film's isochoric stress;
        ``film_pressure``: film pressure times the second variation of the volume;
        ``film_constraint``: blocks of the film pressure: change of volume, bulk modulus;
        ``load``: symmetric part of the follower pressure's stiffness at fixed p1;
        ``spin``: ``-omega^2 M_perp``, M_perp the mass of the motion normal to the axis;
        ``support``: elastic support of the root.
    region_material : mapping of str to csr array
        Share of each region in ``elastic_material``.
    loss_factors : mapping of str to float
        Loss factor of each region's material.
    mass : csr array
        Mass of the undeformed configuration.
    dropped_load : float
        Frobenius norm of the skew part of the load stiffness relative to that of ``load``, both on
        the free unknowns.
    film_regions : tuple of str
        Regions of mixed materials.
    free : (ndof,) bool array
        Unknowns of the solid that are not held.
    """

    pieces: Mapping[str, csr_matrix]
    region_material: Mapping[str, csr_matrix]
    loss_factors: Mapping[str, float]
    mass: csr_matrix
    dropped_load: float
    film_regions: tuple[str, ...]
    free: BoolArray

    def sum(self, names: Iterable[str]) -> csr_matrix:
        """Add pieces up by name.

        Raises
        ------
        ValueError
            If there is no piece of a name.
        """
        total = csr_matrix(self.mass.shape)
        for name in names:
            if name not in self.pieces:
                raise ValueError(
                    f"there is no piece {name!r} of the tangent; it has {', '.join(self.pieces)}"
                )
            total = total + self.pieces[name]
        return csr_matrix(total)

    @cached_property
    def elastic(self) -> csr_matrix:
        """Material and geometric stiffness of the regions without film pressure."""
        return self.sum(ELASTIC)

    @cached_property
    def film(self) -> csr_matrix:
        """Whole second variation of the mixed energy: its u, u-p and p blocks."""
        return self.sum(FILM)

    @property
    def film_isochoric_material(self) -> csr_matrix:
        """The piece of this name."""
        return self.pieces["film_isochoric_material"]

    @property
    def load(self) -> csr_matrix:
        """The piece of this name."""
        return self.pieces["load"]

    @property
    def spin(self) -> csr_matrix:
        """The piece of this name."""
        return self.pieces["spin"]

    @property
    def loss_factor(self) -> float:
        """Loss factor of the film's material; zero without a film."""
        return max((self.loss_factors[region] for region in self.film_regions), default=0.0)

    def stiffness(self, form: StiffnessForm = "full") -> csr_matrix:
        """Stiffness at the equilibrium, the sum of ``STIFFNESS[form]``.

        Parameters
        ----------
        form : {"full", "paper"}
            ``full``: all pieces.  ``paper``: without load stiffness and spin softening; the
            prestress then acts without the load that balances it.
        """
        if form not in STIFFNESS:
            raise ValueError(f"stiffness form {form!r} is neither 'full' nor 'paper'")
        return self.sum(STIFFNESS[form])

    def loss(self, form: LossForm = "isochoric") -> csr_matrix:
        """Matrix L of the complex stiffness ``K + i L``, as far as the film makes it.

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

    def losses(self, form: LossForm = "isochoric") -> dict[str, csr_matrix]:
        """Loss matrices by region, of those whose material has a loss factor (theory: S1-59).

        That of the film is `loss`; an elastic region has eta times its material stiffness, in both
        forms.
        """
        found = {region: self.loss(form) for region in self.film_regions if self.loss_factor > 0.0}
        for region, matrix in self.region_material.items():
            if self.loss_factors[region] > 0.0:
                found[region] = csr_matrix(self.loss_factors[region] * matrix)
        return found

    @property
    def notices(self) -> tuple[Notice, ...]:
        """What the user should know of these matrices."""
        if self.dropped_load <= MUCH_DROPPED:
            return ()
        return (
            Notice(
                "tangent",
                "the skew part of the load stiffness, which is dropped, is large beside the "
                "symmetric part (Frobenius norms)",
                self.dropped_load,
                MUCH_DROPPED,
                "It changes frequencies in second order only; where the load stiffness matters, "
                "compare with a wetted surface that is closed",
            ),
        )


def compute_tangent(
    structure: Structure, state: StructureState, *, shape: bool = True, prestress: bool = True
) -> Tangent:
    """Assemble the tangent of a structure at an equilibrium.

    The switches tell what the load changes by its shape and what by its stress: pieces that are
    switched off are zero, or those of C0.

    Parameters
    ----------
    structure : Structure
        Mesh, materials and supports.
    state : StructureState
        Equilibrium; its own loads count. `Structure.rest()` gives the tangent of C0.
    shape : bool
        Whether strains change as on the deformed shape; if not, the stress of the state acts on
        the undeformed one.
    prestress : bool
        Whether the stress of the state acts (geometric pieces, film pressure), with the loads in
        balance with it (load, spin).
    """
    forms = structure.forms
    nothing = np.zeros(forms.ndof)
    placed = state.displacement if shape else np.zeros(forms.n_displacement)
    pieces, region_material = _material(forms, placed)
    mass = forms.linearise(forms.inertia_terms(), nothing)
    mass.eliminate_zeros()  # it does not couple the components of the displacement
    empty = csr_matrix(mass.shape)
    stress = ("elastic_geometric", "film_geometric", "film_pressure", "load", "spin")
    pieces |= dict.fromkeys(stress, empty)
    dropped = 0.0
    if prestress:
        strained = pieces if shape else _material(forms, state.displacement)[0]
        pieces |= _geometric(forms, state, strained)
        pieces["film_pressure"] = _film_pressure(forms, state.film_pressure, placed)
        pieces["load"], dropped = _load_stiffness(forms, state, placed)
        pieces["spin"] = _spin_softening(forms, mass, state.loading.spin_squared)
    support = structure.elastic_support
    pieces["support"] = empty if support is None else support.stiffness
    return Tangent(
        pieces=pieces,
        region_material=region_material,
        loss_factors={region: m.loss_factor for region, m in forms.materials.items()},
        mass=mass,
        dropped_load=dropped,
        film_regions=tuple(forms.mixed),
        free=forms.free,
    )


Matrices = dict[str, csr_matrix]


def _material(forms: StructuralForms, displacement: FloatArray) -> tuple[Matrices, Matrices]:
    """Pieces without stress on a shape, and the elastic one by region."""
    nothing = np.zeros(forms.ndof)
    base = forms.displacement(displacement)
    regions = {
        region: forms.linearise(forms.material_terms(region, base), nothing)
        for region in forms.elastic
    }
    at = np.concatenate([displacement, np.zeros(forms.n_pressure)])
    pieces = {
        "elastic_material": sum(regions.values(), csr_matrix((forms.ndof, forms.ndof))),
        "film_isochoric_material": forms.linearise(forms.isochoric_terms(base), nothing),
        "film_constraint": _pressure_blocks(forms, forms.linearise(forms.mixed_terms(), at)),
    }
    return pieces, regions


def _geometric(forms: StructuralForms, state: StructureState, material: Matrices) -> Matrices:
    """``S1 : grad v^T grad u``: what the second variation of the energy has beyond the material.

    It depends on the shape by the stress only.
    """
    at = np.concatenate([state.displacement, np.zeros(forms.n_pressure)])
    elastic = forms.linearise(forms.elastic_terms(), at)
    isochoric = forms.linearise(forms.isochoric_energy_terms(), at)
    return {
        "elastic_geometric": csr_matrix(elastic - material["elastic_material"]),
        "film_geometric": csr_matrix(isochoric - material["film_isochoric_material"]),
    }


def _film_pressure(
    forms: StructuralForms, pressure: FloatArray, displacement: FloatArray
) -> csr_matrix:
    """Film pressure times the second variation of the volume, on a shape."""
    if forms.P is None:
        return csr_matrix((forms.ndof, forms.ndof))
    field = ngs.GridFunction(forms.P)
    field.vec.FV().NumPy()[:] = pressure
    at = np.concatenate([displacement, np.zeros(forms.n_pressure)])
    return forms.linearise(forms.film_pressure_terms(field), at)


def _pressure_blocks(forms: StructuralForms, mixed: csr_matrix) -> csr_matrix:
    """Rows and columns of the film pressure."""
    entries = mixed.tocoo()
    kept = (entries.row >= forms.n_displacement) | (entries.col >= forms.n_displacement)
    places = (entries.row[kept], entries.col[kept])
    return csr_matrix((entries.data[kept], places), shape=mixed.shape)


def _load_stiffness(
    forms: StructuralForms, state: StructureState, displacement: FloatArray
) -> tuple[csr_matrix, float]:
    """Symmetric part of the pressure's stiffness, and the relative norm of the skew part."""
    forms.set_loading(state.loading)
    at = np.concatenate([displacement, np.zeros(forms.n_pressure)])
    whole = forms.linearise(forms.pressure_terms(), at)
    symmetric, skew = 0.5 * (whole + whole.T), 0.5 * (whole - whole.T)
    norms = [float(spl.norm(part[forms.free][:, forms.free])) for part in (symmetric, skew)]
    return symmetric.tocsr(), norms[1] / norms[0] if norms[0] > 0.0 else 0.0


def _spin_softening(forms: StructuralForms, mass: csr_matrix, spin_squared: float) -> csr_matrix:
    """``-omega^2 M_perp``: the mass of the components across the axis."""
    across = np.zeros(forms.ndof)
    across[forms.n_displacement // 3 : forms.n_displacement] = 1.0
    return csr_matrix(diags(-spin_squared * across) @ mass)
