# SPDX-License-Identifier: LGPL-2.1-or-later
"""Spaces, free unknowns and weak forms of the finite-strain structure.

Total Lagrangian: everything is integrated over the undeformed blade C0, with the deformation
gradient ``F = 1 + grad u``.
"""

from collections.abc import Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from functools import cached_property

import ngsolve as ngs
import numpy as np
from scipy.sparse import csr_matrix

from quietblade.errors import MaterialError, MeshError
from quietblade.linalg import default_threads
from quietblade.materials import AnisotropicSVK, Material, MixedMaterial, green_lagrange
from quietblade.mesh.assembly import csr_of
from quietblade.mesh.boundaries import boundary, held_boundary
from quietblade.mesh.nodal import NodalBasis
from quietblade.propulsion.loading import Loading
from quietblade.typing import BoolArray, FloatArray, IntArray

Terms = Sequence[ngs.CoefficientFunction]
"""Integrals of a weak form (NGSolve ``SumOfIntegrals``)."""

SOLID_REGIONS = ("blade", "film", "body")

# Pressure, cofactor and test function are each of second order on a straight face.
_FOLLOWER_BONUS = 2


class StructuralForms:
    """Spaces and integrals of a structure on an NGSolve mesh.

    Unknowns are numbered as in the product space V * P: displacement (three blocks, order 2,
    every vertex and edge of the mesh), then film pressure (order 1, every vertex).  P is absent
    if no material is mixed.

    Parameters
    ----------
    fem : ngsolve.Mesh
        Mesh with the regions and boundaries named in the other arguments.
    materials : mapping
        Law of each solid region.
    clamped : str or None
        Name pattern of the boundaries that are held, if any.
    wetted : str
        Name pattern of the boundaries that carry pressure.
    guided : mapping
        Boundary name patterns by axis ("x", "y", "z") where only that displacement is held.
    basis : NodalBasis or None
        Nodal basis of the mesh, if there is one already.

    Raises
    ------
    MaterialError
        If a solid region has no material.
    MeshError
        If a region or boundary is not in the mesh.
    """

    def __init__(
        self,
        fem: ngs.Mesh,
        materials: Mapping[str, Material],
        *,
        clamped: str | None,
        wetted: str,
        guided: Mapping[str, str] | None = None,
        basis: NodalBasis | None = None,
    ) -> None:
        _check_regions(fem, materials)
        self.fem, self.materials, self.wetted = fem, dict(materials), wetted
        self.basis = NodalBasis(fem) if basis is None else basis
        _check_mixed(materials)
        boundary(fem, wetted)
        self.mixed = {n: m for n, m in materials.items() if isinstance(m, MixedMaterial)}
        self.elastic = {n: m for n, m in materials.items() if not isinstance(m, MixedMaterial)}
        self.V = ngs.VectorH1(fem, order=2)
        self.P = ngs.H1(fem, order=1, definedon="|".join(self.mixed)) if self.mixed else None
        self.X = self.V * self.P if self.P else self.V
        self.n_displacement: int = self.V.ndof
        self.n_pressure: int = self.P.ndof if self.P else 0
        self.free = self._select_free(clamped, guided or {})
        self.load_pressure = ngs.GridFunction(ngs.H1(fem, order=2))
        self.spin_squared = ngs.Parameter(0.0)

    def set_loading(self, loading: Loading) -> None:
        """Make the load terms speak of these loads."""
        self.load_pressure.vec.FV().NumPy()[:] = self.basis.to_dofs(loading.pressure)
        self.spin_squared.Set(loading.spin_squared)

    @property
    def ndof(self) -> int:
        """Unknowns in full numbering."""
        return self.n_displacement + self.n_pressure

    @cached_property
    def solid(self) -> ngs.Region:
        """All solid regions."""
        return self.fem.Materials("|".join(self.materials))

    @cached_property
    def solid_nodes(self) -> IntArray:
        """Numbers of the nodes of the solid in the nodal basis."""
        return self.basis.nodes_of("|".join(self.materials))

    @cached_property
    def cell_size(self) -> float:
        """Cube root of the mean volume of the solid's cells [m]."""
        with parallel():
            volume = ngs.Integrate(1.0, self.fem, definedon=self.solid)
        count = sum(1 for _ in self.solid.Elements())
        return float(np.cbrt(volume / count))

    @cached_property
    def mixed_region(self) -> ngs.Region:
        """Regions of mixed materials."""
        return self.fem.Materials("|".join(self.mixed))

    def boundary(self, pattern: str) -> ngs.Region:
        """Boundaries of the mesh that match a name pattern; at least one does.

        Raises
        ------
        MeshError
            If none does.
        """
        return boundary(self.fem, pattern)

    def gradient(self, u: ngs.CoefficientFunction) -> ngs.CoefficientFunction:
        """Deformation gradient F of a displacement."""
        return ngs.Id(3) + ngs.Grad(u)

    def trial(self) -> tuple[ngs.CoefficientFunction, ngs.CoefficientFunction | None]:
        """Trial displacement and film pressure."""
        if self.P is None:
            return self.X.TrialFunction(), None
        u, p = self.X.TrialFunction()
        return u, p

    def test(self) -> ngs.CoefficientFunction:
        """Test displacement."""
        return self.X.TestFunction() if self.P is None else self.X.TestFunction()[0]

    # -- integrals --------------------------------------------------------------------------

    def elastic_terms(self) -> Terms:
        """Strain energy of the regions that the displacement alone describes."""
        u, _ = self.trial()
        F = self.gradient(u)
        return [_variation(m.energy(F), region, _extra(m)) for region, m in self.elastic.items()]

    def elastic_tangent_terms(self, base: ngs.GridFunction, correction: ngs.GridFunction) -> Terms:
        """Elastic tangent with independent stresses: bilinear, about the displacement `base`.

        Its initial-stress part has the stress that the *linearised* strain of the last correction
        gives, instead of the stress of the present displacement, which a large rotation spoils
        by a spurious stretch: ``E - 1/2 grad d^T grad d`` takes the place of E.  The solution is
        the same, Newton's method needs far fewer iterations in thin structures, and it still
        converges quadratically.  Magisano, Leonetti and Garcea, Comput. Methods Appl. Mech. Eng.
        313 (2017) 986-1005 (mixed integration points).

        Written out, ``dE : C : DE + S : grad v^T grad u``, it is assembled four times as fast as
        the second derivative of an energy, which is evaluated for each pair of components.
        """
        (u, _), v = self.trial(), self.test()
        F, D = self.gradient(base), ngs.Grad(correction)
        E = (green_lagrange(F) - 0.5 * D.trans * D).MakeVariable()
        change, varied = F.trans * ngs.Grad(u), F.trans * ngs.Grad(v)
        change = 0.5 * (change + change.trans)
        terms = []
        for region, material in self.elastic.items():
            S = material.energy_of_strain(E).Diff(E)
            S = 0.5 * (S + S.trans)
            rate = ngs.InnerProduct(S.Diff(E, change), varied)
            rate += ngs.InnerProduct(ngs.Grad(u) * S, ngs.Grad(v))
            terms.append(rate.Compile() * ngs.dx(region))
        return terms

    def mixed_terms(self) -> Terms:
        """Energy of the film, in displacement and pressure."""
        u, p = self.trial()
        F = self.gradient(u)
        return [_variation(m.energy(F, p), region) for region, m in self.mixed.items()]

    def material_terms(self, region: str, base: ngs.GridFunction) -> Terms:
        """Elastic energy of a region at the strain ``E0 + sym(F0^T grad u)``, affine in u.

        Its second variation at u = 0 is ``dE : C : dE``, without the initial-stress part.
        """
        u, _ = self.trial()
        F0 = self.gradient(base)
        change = F0.trans * ngs.Grad(u)
        E = green_lagrange(F0) + 0.5 * (change + change.trans)
        return [_variation(self.elastic[region].energy_of_strain(E), region)]

    def isochoric_energy_terms(self) -> Terms:
        """Isochoric energy of the film, in the displacement alone."""
        u, _ = self.trial()
        F = self.gradient(u)
        return [_variation(m.isochoric_energy(F), region) for region, m in self.mixed.items()]

    def film_pressure_terms(self, pressure: ngs.GridFunction) -> Terms:
        """Work ``int p J`` of a given film pressure on the change of volume."""
        u, _ = self.trial()
        J = ngs.Det(self.gradient(u))
        return [_variation(pressure * J, region) for region in self.mixed]

    def isochoric_terms(
        self, base: ngs.GridFunction, weight: ngs.CoefficientFunction | None = None
    ) -> Terms:
        """Isochoric energy of the film at the strain ``E0 + sym(F0^T grad u)``, affine in u.

        Its second variation at u = 0 is ``dE : C_iso : dE``, without the initial-stress part: the
        film's loss (theory: S2-3).  A weight, a function of place, multiplies the energy.
        """
        u, _ = self.trial()
        F0 = self.gradient(base)
        change = F0.trans * ngs.Grad(u)
        C = F0.trans * F0 + change + change.trans
        energies = {r: m.isochoric_energy_of_metric(C) for r, m in self.mixed.items()}
        if weight is not None:
            energies = {region: weight * energy for region, energy in energies.items()}
        return [_variation(energy, region) for region, energy in energies.items()]

    def pressure_terms(self) -> Terms:
        """Virtual work ``int p cof(F) N . v dS0`` of the follower pressure, on the left side.

        Its derivative is the load stiffness (theory: S1-17).
        """
        (u, _), v = self.trial(), self.test()
        # The surface gradient is enough: cof(F) N only knows the tangents.
        moved_normal = ngs.Cof(ngs.Id(3) + ngs.Grad(u).Trace()) * self.outward_normal
        return [
            self.load_pressure
            * ngs.InnerProduct(moved_normal, v.Trace())
            * ngs.ds(self.wetted, bonus_intorder=_FOLLOWER_BONUS)
        ]

    def spin_terms(self) -> Terms:
        """Energy ``-1/2 rho omega^2 |P_perp (X + u)|^2`` of the spin (theory: S1-18)."""
        u, _ = self.trial()
        distance_squared = (ngs.y + u[1]) ** 2 + (ngs.z + u[2]) ** 2
        return [
            _variation(-0.5 * m.density * self.spin_squared * distance_squared, region)
            for region, m in self.materials.items()
        ]

    def inertia_terms(self) -> Terms:
        """Mass ``int rho u . v dV0``."""
        (u, _), v = self.trial(), self.test()
        product = ngs.InnerProduct(u, v)
        return [m.density * product * ngs.dx(region) for region, m in self.materials.items()]

    # -- assembly ---------------------------------------------------------------------------

    def form(self, terms: Terms, *, bilinear: bool = False) -> ngs.BilinearForm:
        """Form of some terms on the product space.

        Bilinear ones (not just linear in the test function) can be differentiated when the form
        is made, which makes their assembly several times faster.
        """
        form = ngs.BilinearForm(self.X, check_unused=False)
        options = ngs.ngsglobals
        before, options.symbolic_integrator_uses_diff = (
            options.symbolic_integrator_uses_diff,
            bilinear,
        )
        try:
            for term in terms:
                form += term
        finally:
            options.symbolic_integrator_uses_diff = before
        return form

    def linearise(self, terms: Terms, at: FloatArray) -> csr_matrix:
        """Return the derivative of some terms at a vector, full numbering."""
        if not terms:
            return csr_matrix((self.ndof, self.ndof))
        form = self.form(terms)
        with parallel():
            form.AssembleLinearization(self.vector(at))
        return csr_of(form)

    def apply(self, form: ngs.BilinearForm, at: FloatArray) -> FloatArray:
        """Return a form (nonlinear or not) at a vector, (ndof,), full numbering."""
        vector = self.vector(at)
        result = vector.CreateVector()
        with parallel():
            form.Apply(vector, result)
        return np.array(result)

    def vector(self, values: FloatArray) -> ngs.BaseVector:
        """NGSolve vector of full-numbered values."""
        vector = ngs.GridFunction(self.X).vec
        vector.FV().NumPy()[:] = values
        return vector

    def displacement(self, dofs: FloatArray) -> ngs.GridFunction:
        """Displacement field of the unknowns of V."""
        field = ngs.GridFunction(self.V)
        field.vec.FV().NumPy()[:] = dofs
        return field

    # -- topology ---------------------------------------------------------------------------

    @cached_property
    def outward_normal(self) -> ngs.CoefficientFunction:
        """Unit normal of the wetted surface out of the solid, whatever the mesh's orientation.

        The faces of a mesh may be oriented either way, each for itself.  The normal of the solid
        cells decides: face integrals of it cancel inside the solid and stay on its boundary.
        """
        facets = ngs.FacetFESpace(self.fem, order=0)
        w, n = facets.TestFunction(), ngs.specialcf.normal(3)
        agreement = np.zeros(facets.ndof)
        for axis in range(3):
            face, cell = ngs.LinearForm(facets), ngs.LinearForm(facets)
            face += n[axis] * w * ngs.ds(self.wetted)
            cell += n[axis] * w * ngs.dx(definedon=self.solid, element_boundary=True)
            agreement += np.array(face.Assemble().vec) * np.array(cell.Assemble().vec)
        orientation = ngs.GridFunction(facets)
        orientation.vec.FV().NumPy()[:] = np.sign(agreement)
        return orientation * n

    def _select_free(self, clamped: str | None, guided: Mapping[str, str]) -> BoolArray:
        held = {} if clamped is None else dict.fromkeys("xyz", clamped)
        scalar = ngs.H1(self.fem, order=2)
        blocks = np.tile(_dofs(scalar, self.solid), (3, 1))
        for axis, pattern in [*held.items(), *guided.items()]:
            held_to = _dofs(scalar, held_boundary(self.fem, pattern))
            blocks["xyz".index(axis), held_to] = False
        if self.P is None:
            return blocks.ravel()
        return np.concatenate([blocks.ravel(), _dofs(self.P, self.mixed_region)])


def parallel() -> AbstractContextManager[object]:
    """Let NGSolve use several threads, if there are several.

    On one thread its task manager would only wait for itself, at a high price on a busy machine.
    """
    return ngs.TaskManager() if default_threads() > 1 else nullcontext()


def _variation(
    energy: ngs.CoefficientFunction, region: str, extra: int = 0
) -> ngs.CoefficientFunction:
    return ngs.Variation(energy.Compile() * ngs.dx(region, bonus_intorder=extra))


def _extra(material: Material) -> int:
    """Degrees of quadrature beyond those of a homogeneous solid: plies vary inside cells."""
    return material.extra_order if isinstance(material, AnisotropicSVK) else 0


def _dofs(space: ngs.FESpace, region: ngs.Region) -> BoolArray:
    return np.array(space.GetDofs(region), dtype=bool)


def _check_regions(fem: ngs.Mesh, materials: Mapping[str, Material]) -> None:
    present = set(fem.GetMaterials())
    for region in materials:
        if region not in present:
            raise MeshError(
                f"material {materials[region].name!r} is for region {region!r}, which the mesh "
                f"does not have (it has {sorted(present)})."
            )
    bare = sorted(present.intersection(SOLID_REGIONS) - set(materials))
    if bare:
        raise MaterialError(f"the solid region {bare[0]!r} of the mesh has no material.")


def _check_mixed(materials: Mapping[str, Material]) -> None:
    mixed = [region for region, m in materials.items() if isinstance(m, MixedMaterial)]
    if len(mixed) > 1:
        raise MaterialError(
            f"regions {' and '.join(mixed)} both have a mixed material; only one may (the film)."
        )
