# SPDX-License-Identifier: LGPL-2.1-or-later
"""Matrices of the water and of its contact with the blade, on C0 or on the moved mesh C1.

The numbering is that of the uncompressed spaces ``VectorH1(fem, order=2)`` (displacement) and
``H1(fem, order=2)`` (velocity potential); both cover the whole mesh, as ``NodalBasis`` does, and
only the unknowns that touch the water are used.  The fluid's normal points out of the fluid, into
the blade (theory: S2-5, S2-6).
"""

from dataclasses import dataclass

import ngsolve as ngs
import numpy as np
from scipy.sparse import csr_matrix

from quietblade.errors import MeshError
from quietblade.mesh.assembly import csr_of
from quietblade.mesh.boundaries import boundary
from quietblade.mesh.model import INTERFACE

FLUID = "water"


@dataclass(frozen=True)
class Water:
    """Fluid at rest.

    Attributes
    ----------
    density : float
        rho [kg/m3].
    sound_speed : float
        c [m/s].
    """

    density: float
    sound_speed: float

    def __post_init__(self) -> None:
        for name, value in (("density", self.density), ("sound speed", self.sound_speed)):
            if not 0.0 < value < np.inf:
                raise ValueError(f"water: its {name}, {value:g}, must be a positive number (SI)")


def potential_space(fem: ngs.Mesh) -> ngs.H1:
    """Space Q of the velocity potential, order 2, numbered as ``NodalBasis`` does.

    With ``definedon`` the space would leave out the edges of the solid from its numbering.
    """
    return ngs.H1(fem, order=2)


def fluid_normal(fem: ngs.Mesh, surface: ngs.Region) -> ngs.CoefficientFunction:
    """Give the unit normal out of the fluid, to be integrated over the wetted ``surface`` only.

    Which side the normal of a face between two regions points to depends on how the mesh was
    made, so it is measured: face by face against the outward normal of the water's elements.

    Raises
    ------
    MeshError
        If a face of ``surface`` does not touch the water.
    """
    facets = ngs.FacetFESpace(fem, order=0)
    space = facets**3
    test = space.TestFunction()
    normal = ngs.specialcf.normal(3)
    faces = ngs.LinearForm(ngs.InnerProduct(test.Trace(), normal) * ngs.ds(definedon=surface))
    # Over inner facets the normals of the two elements cancel; on the water's boundary one is left.
    around = ngs.LinearForm(
        ngs.InnerProduct(test, normal)
        * ngs.dx(definedon=fem.Materials(FLUID), element_boundary=True)
    )
    own, outward = (
        np.array(form.Assemble().vec).reshape(3, facets.ndof) for form in (faces, around)
    )
    area = np.linalg.norm(own, axis=0)
    cosine = np.einsum("ij,ij->j", own, outward)
    stray = np.count_nonzero(np.abs(cosine[area > 0]) < 0.5 * area[area > 0] ** 2)
    if stray:
        raise MeshError(
            f"{stray} faces of the wetted surface have water on no side or on both sides; "
            "check the names of the mesh's boundaries"
        )
    sign = ngs.GridFunction(facets)
    sign.vec.FV().NumPy()[:] = np.sign(cosine)
    return sign * normal


def coupling_matrix(
    fem: ngs.Mesh, water: Water, surface: str = INTERFACE, motion: ngs.GridFunction | None = None
) -> csr_matrix:
    """C = int rho psi (du . n) over the wetted surface (theory: S2-7).

    Parameters
    ----------
    surface : str
        Name pattern of the boundaries.
    motion : ngsolve.GridFunction or None
        Displacement of the whole mesh from C0 to C1 [m]; None integrates on C0.

    Returns
    -------
    (V.ndof, Q.ndof) csr_matrix
        Rows of displacement, columns of potential [kg/m3 m2].
    """
    region = boundary(fem, surface)
    potential = potential_space(fem)
    displacement = ngs.VectorH1(fem, order=2)
    psi, v = potential.TrialFunction(), displacement.TestFunction()
    normal = fluid_normal(fem, region)
    form = ngs.BilinearForm(trialspace=potential, testspace=displacement, check_unused=False)
    form += (
        water.density
        * psi.Trace()
        * ngs.InnerProduct(v.Trace(), normal)
        * ngs.ds(definedon=region, deformation=motion)
    )
    return csr_of(form.Assemble())


def kinetic_matrix(
    fem: ngs.Mesh, water: Water, motion: ngs.GridFunction | None = None
) -> csr_matrix:
    """H = int rho grad psi . grad dpsi over the water, (Q.ndof, Q.ndof) (theory: S2-7)."""
    potential = potential_space(fem)
    psi, test = potential.TnT()
    form = ngs.BilinearForm(potential, check_unused=False)
    form += (
        water.density
        * ngs.InnerProduct(ngs.grad(psi), ngs.grad(test))
        * ngs.dx(definedon=fem.Materials(FLUID), deformation=motion)
    )
    return csr_of(form.Assemble())


def compressibility_matrix(
    fem: ngs.Mesh, water: Water, motion: ngs.GridFunction | None = None
) -> csr_matrix:
    """G = int rho / c^2 psi dpsi over the water, (Q.ndof, Q.ndof) (theory: S2-7)."""
    potential = potential_space(fem)
    psi, test = potential.TnT()
    form = ngs.BilinearForm(potential, check_unused=False)
    form += (
        water.density
        / water.sound_speed**2
        * psi
        * test
        * ngs.dx(definedon=fem.Materials(FLUID), deformation=motion)
    )
    return csr_of(form.Assemble())


def normal_motion_matrix(
    fem: ngs.Mesh, surface: str = INTERFACE, motion: ngs.GridFunction | None = None
) -> csr_matrix:
    """Integral of (u . n) (du . n) over the wetted surface, (V.ndof, V.ndof) [m2].

    Parameters
    ----------
    surface : str
        Name pattern of the boundaries.
    motion : ngsolve.GridFunction or None
        Displacement of the whole mesh from C0 to C1 [m]; None integrates on C0.
    """
    region = boundary(fem, surface)
    displacement = ngs.VectorH1(fem, order=2)
    u, v = displacement.TnT()
    normal = fluid_normal(fem, region)
    form = ngs.BilinearForm(displacement, check_unused=False)
    form += (
        ngs.InnerProduct(u.Trace(), normal)
        * ngs.InnerProduct(v.Trace(), normal)
        * ngs.ds(definedon=region, deformation=motion)
    )
    return csr_of(form.Assemble())
