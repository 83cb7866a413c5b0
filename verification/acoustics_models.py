# SPDX-License-Identifier: LGPL-2.1-or-later
"""Small finite-element models of spheres in water, for the checks and for the tests."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache, cached_property

import ngsolve as ngs
import numpy as np
import rslab
from netgen import occ
from scipy.sparse import csr_matrix
from scipy.special import eval_legendre, legendre

from quietblade.linalg import make_solver
from quietblade.mesh.assembly import csr_of
from quietblade.mesh.nodal import NodalBasis
from quietblade.typing import ComplexArray, FloatArray
from quietblade.vibroacoustics.fluid import Water
from quietblade.vibroacoustics.multipoles import SurfaceSources
from quietblade.vibroacoustics.operators import CLAMPED, Operators, build_operators, product_space
from quietblade.vibroacoustics.radiation import Bgt1, RadiationCondition

WATER = Water(density=1000.0, sound_speed=1500.0)


@dataclass(frozen=True)
class Elastic:
    """Isotropic linear elastic solid with a loss factor."""

    young: float
    poisson: float
    density: float
    loss: float = 0.0


def linear_elastic(fem: ngs.Mesh, solid: Elastic, region: str) -> tuple[csr_matrix, csr_matrix]:
    """Stiffness and mass of a region, in the full numbering of V."""
    displacement = ngs.VectorH1(fem, order=2)
    u, v = displacement.TnT()
    mu = solid.young / (2.0 * (1.0 + solid.poisson))
    lame = 2.0 * mu * solid.poisson / (1.0 - 2.0 * solid.poisson)
    inside = ngs.dx(definedon=fem.Materials(region))
    elastic = ngs.BilinearForm(displacement, check_unused=False)
    elastic += (
        2.0 * mu * ngs.InnerProduct(ngs.Sym(ngs.Grad(u)), ngs.Sym(ngs.Grad(v)))
        + lame * ngs.div(u) * ngs.div(v)
    ) * inside
    inertia = ngs.BilinearForm(displacement, check_unused=False)
    inertia += solid.density * ngs.InnerProduct(u, v) * inside
    return csr_of(elastic.Assemble()), csr_of(inertia.Assemble())


LAYERS = ((0.5, 0.57, 0.68, 0.82, 1.0), (0.2, 0.2, 0.25, 0.3, 0.35))


def sphere_mesh(hollow: tuple[float, ...] = ()) -> ngs.Mesh:
    """Ball or thick shell "blade" of radius 0.5 m in a sphere of 1 m of "water", curved.

    Near fields of degree l fall as r^-(l+1): concentric surfaces make the elements thin where
    that happens, and the errors smaller than those of an even mesh of three times the size.

    Parameters
    ----------
    hollow : tuple of float
        Radii of concentric surfaces inside the solid, the first one bounds a vacuum.
    """
    radii = (*hollow, *LAYERS[0])
    sizes = (*([LAYERS[1][0]] * len(hollow)), *LAYERS[1])
    return layered_mesh(radii, sizes, 0.5, hollow=bool(hollow))


def layered_mesh(
    radii: tuple[float, ...],
    sizes: tuple[float, ...],
    wetted: float,
    *,
    hollow: bool = True,
) -> ngs.Mesh:
    """Concentric spheres, solid "blade" inside the wetted radius and "water" outside, curved.

    Parameters
    ----------
    radii, sizes : tuples of float
        Ascending radii of the surfaces, and the edge lengths on them.
    wetted : float
        The radius, one of them, where the water begins: boundary "wet".
    hollow : bool
        Whether there is a vacuum in the innermost sphere (boundary "inside").
    """
    centre = occ.Pnt(0.0, 0.0, 0.0)
    names = {radii[-1]: "outer", wetted: "wet"} | ({radii[0]: "inside"} if hollow else {})
    balls = []
    for radius, size in zip(radii, sizes, strict=True):
        ball = occ.Sphere(centre, radius)
        ball.faces.name, ball.faces.maxh = names.get(radius, "layer"), size
        balls.append(ball)
    parts = [] if hollow else [balls[0].mat("blade")]
    for index in range(1, len(balls)):
        layer = balls[index] - balls[index - 1]
        parts.append(layer.mat("blade" if radii[index] <= wetted else "water"))
    shape = occ.OCCGeometry(occ.Glue(parts))
    return ngs.Mesh(shape.GenerateMesh(maxh=0.4, grading=0.9, optsteps3d=1)).Curve(2)


@dataclass(frozen=True)
class SphereModel:
    """A sphere in water with its operators, and what the checks ask of it."""

    fem: ngs.Mesh
    radius: float
    outer: float
    solid: Mapping[str, Elastic]
    water: Water = WATER
    condition: RadiationCondition = field(default_factory=Bgt1)

    @cached_property
    def basis(self) -> NodalBasis:
        """Nodes of the mesh."""
        return NodalBasis(self.fem)

    @cached_property
    def operators(self) -> Operators:
        """Operators on C0 with the condition."""
        parts = {name: linear_elastic(self.fem, e, name) for name, e in self.solid.items()}
        empty = csr_matrix(next(iter(parts.values()))[0].shape)
        return build_operators(
            self.fem,
            stiffness=sum((k for k, _ in parts.values()), start=empty),
            mass=sum((m for _, m in parts.values()), start=empty),
            loss={name: e.loss * parts[name][0] for name, e in self.solid.items()},
            water=self.water,
            radius=self.outer,
            condition=self.condition,
            clamped=CLAMPED if CLAMPED in self.fem.GetBoundaries() else None,
        )

    @cached_property
    def sources(self) -> SurfaceSources:
        """Sources on the wetted surface."""
        return SurfaceSources.of(self.fem, self.basis, self.operators)

    def radial_motion(self, degree: int) -> FloatArray:
        """Nodal displacement e_r P_l(cos theta) on the wetted surface, free unknowns (n_u,)."""
        wet = self.basis.nodes_of("wet", codimension=1)
        values = np.zeros_like(self.basis.points)
        direction = self.basis.points[wet] / self.radius
        values[wet] = direction * eval_legendre(degree, direction[:, 2])[:, None]
        operators = self.operators
        return np.asarray(self.basis.to_dofs(values)[operators.free[operators.blocks.u]])

    def forced_by_motion(self, degree: int, omega: float, velocity: float = 1.0) -> ComplexArray:
        """Response (n,) of the water to a radial velocity v P_l(cos theta) of the sphere."""
        return self.forced_by_motions((degree,), omega, velocity)[0]

    def forced_by_motions(
        self, degrees: tuple[int, ...], omega: float, velocity: float = 1.0
    ) -> ComplexArray:
        """Responses (d, n) of the water to motions of several degrees, with one factor."""
        operators = self.operators
        u, water = operators.blocks.u, operators.blocks.water
        response = np.zeros((len(degrees), operators.size), dtype=np.complex128)
        moved = np.array([self.radial_motion(degree) for degree in degrees])
        response[:, u] = moved * velocity / (1j * omega)
        matrix = operators.at(omega)
        inner = csr_matrix(matrix[water][:, water])
        right = -(matrix[water][:, u] @ response[:, u].T)
        response[:, water] = make_solver(precision="double").factor(inner).solve(right).T
        return response

    def forced_by_load(self, load: FloatArray, omega: float) -> ComplexArray:
        """Response (n,) of solid and water to a load on the free unknowns."""
        matrix = self.operators.at(omega)
        factor = rslab.ldlt(matrix)
        solution: ComplexArray = factor.solve(load.astype(np.complex128))
        return np.asarray(solution + factor.solve(load - matrix @ solution))

    def surface_mean(self, values: ComplexArray, degree: int) -> complex:
        """Least-squares factor of P_l(cos theta) in nodal values on the wetted surface."""
        wet = self.basis.nodes_of("wet", codimension=1)
        shape = eval_legendre(degree, self.basis.points[wet, 2] / self.radius)
        return complex(shape @ values[wet] / (shape @ shape))

    def potential(self, response: ComplexArray) -> ComplexArray:
        """Nodal potential (nodes,) of a response."""
        space = product_space(self.fem)
        full = np.zeros(space.ndof, dtype=np.complex128)
        free = self.operators.free
        full[free] = response[: len(free)]
        return np.asarray(self.basis.to_values(full[space.Range(2).start :]))

    def radial_displacement(self, response: ComplexArray) -> ComplexArray:
        """Nodal u . e_r (nodes,), meant for the wetted surface."""
        space = product_space(self.fem)
        full = np.zeros(space.ndof, dtype=np.complex128)
        free = self.operators.free
        full[free] = response[: len(free)]
        values = self.basis.to_values(full[: space.Range(1).start])
        return np.asarray(np.einsum("ni,ni->n", values, self.basis.points) / self.radius)


def harmonic_pressure(degree: int) -> ngs.CoefficientFunction:
    """P_l(cos theta) as a function of place."""
    mu = ngs.z / ngs.sqrt(ngs.x**2 + ngs.y**2 + ngs.z**2)
    powers = legendre(degree).coef[::-1]
    return sum((float(c) * mu**n for n, c in enumerate(powers)), start=ngs.CF(0.0))


@cache
def ball() -> SphereModel:
    """Solid ball, light and soft."""
    return SphereModel(sphere_mesh(), 0.5, 1.0, {"blade": SOFT})


@cache
def shell() -> SphereModel:
    """Thick shell with loss, inner radius 0.35 m."""
    return SphereModel(sphere_mesh(hollow=(0.35, 0.42)), 0.5, 1.0, {"blade": LOSSY})


SOFT = Elastic(young=3.0e9, poisson=0.35, density=1200.0)
LOSSY = Elastic(young=5.0e9, poisson=0.3, density=1500.0, loss=0.05)
