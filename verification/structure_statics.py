# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rubber-like solids at finite strain: blocks of film and a thick ring, in closed form."""

from dataclasses import dataclass
from functools import cache

import ngsolve as ngs
import numpy as np
from netgen import occ

from quietblade.materials import MooneyRivlin, find_material
from quietblade.propulsion.structure import Structure, StructureState
from quietblade.typing import FloatArray
from verification.registry import check
from verification.structure_models import box_mesh, cauchy_stress, uniform_pressure
from verification.structure_solid_theory import ThickTube, shear_stress, uniaxial_stress

# -- the film's material, as a block of distorted hexahedra ---------------------------------------


def film_block() -> Structure:
    """Make a unit cube of film, all faces held, with distorted cells inside."""
    planes = np.linspace(0.0, 1.0, 3)

    def distort(points: FloatArray) -> FloatArray:
        inside = np.all((points > 0.25) & (points < 0.75), axis=1)
        return points + np.where(inside[:, None], [0.11, -0.07, 0.09], 0.0)

    mesh = box_mesh(planes, planes, planes, in_film=lambda c: c[:, 0] < 2.0, move=distort)
    held = "root|tip|left|right|lower|upper"
    return Structure(mesh, {"film": find_material("viscoelastic-paper")}, clamped=held, wetted=held)


def homogeneous(structure: Structure, gradient: FloatArray) -> StructureState:
    """Equilibrium with the boundary displaced as by a homogeneous deformation gradient.

    Inside the block the iteration begins somewhere else.
    """
    basis, rest = structure.basis, structure.rest()
    displacement = basis.to_dofs(basis.points @ (gradient - np.eye(3)).T)
    free = structure.forms.free[: len(displacement)]
    disturbance = 0.02 * np.random.default_rng(2).standard_normal(len(displacement))
    displacement = displacement + np.where(free, disturbance, 0.0)
    start = StructureState(displacement, rest.film_pressure, rest.loading)
    return structure.solve(np.zeros(len(basis.points)), start, tolerance=1e-10)


def nominal_stress(structure: Structure, state: StructureState) -> FloatArray:
    """Mean first Piola-Kirchhoff stress of a unit cube from its reactions, (3, 3) [Pa].

    ``P_iJ`` is the i-th component of the force on the face X_J = 1.
    """
    n = structure.forms.n_displacement
    reaction = structure.internal_force(state)[:n].reshape(3, -1)
    # virtual work of a displacement X_J along i
    basis = structure.basis
    fields = [basis.to_dofs(basis.points[:, J]) for J in range(3)]
    return np.array([[reaction[i] @ fields[J] for J in range(3)] for i in range(3)])


# Homogeneous states are exact in any mesh; the film is compressible (bulk modulus 2.2 GPa).
for _shear in (0.019, 0.09, 0.5):

    @check("structure/film-shear" + ("" if _shear == 0.09 else f"-{_shear:g}"),
           quantity=f"shear stress of the film at gamma = {_shear:g} [Pa]",
           reference=shear_stress(_shear, 0.238e6, 0.523e6),
           source="Mooney-Rivlin: tau = 2 (C10 + C01) gamma", tolerance=0.2)  # fmt: skip
    def _film_shear(shear: float = _shear) -> float:
        structure = film_block()
        gradient = np.eye(3)
        gradient[2, 1] = shear
        return float(nominal_stress(structure, homogeneous(structure, gradient))[2, 1])


for _stretch in (0.8, 0.9, 1.1, 1.5, 2.0):

    @check(f"structure/film-uniaxial-{_stretch:g}",
           quantity=f"nominal stress of the film at stretch {_stretch:g} [Pa]",
           reference=uniaxial_stress(_stretch, 0.238e6, 0.523e6),
           source="incompressible Mooney-Rivlin: P = 2 (l - l^-2) (C10 + C01 / l)",
           tolerance=10.0)  # fmt: skip
    def _film_uniaxial(stretch: float = _stretch) -> float:
        structure = film_block()
        across = stretch**-0.5
        stress = nominal_stress(
            structure, homogeneous(structure, np.diag([across, across, stretch]))
        )
        # the held faces carry the stress across that free ones would not; a mean stress added to
        # cancel it is reaction-free in an incompressible solid
        return float(stress[2, 2] - stress[0, 0] * across / stretch)


# -- thick tube under internal pressure -----------------------------------------------------------


@dataclass(frozen=True, eq=False)
class SolvedTube:
    """A tube in equilibrium.

    Attributes
    ----------
    structure : Structure
        A quarter of a slice of it, of second-order tetrahedra.
    state : StructureState
    height : float
        Thickness of the slice.
    """

    structure: Structure
    state: StructureState
    height: float

    def displacement(self, radius: float) -> float:
        """Mean radial displacement on a quarter of a circle of an undeformed radius."""
        u = self.structure.forms.displacement(self.state.displacement)
        return self._mean(ngs.CF((u[0], u[1])), radius)

    def radial_stress(self, radius: float) -> float:
        """Mean radial Cauchy stress there; lines along the radius stay so."""
        stress = cauchy_stress(self.structure, self.state, "film")
        along = ngs.CF((ngs.x, ngs.y, 0.0)) / ngs.sqrt(ngs.x**2 + ngs.y**2)
        traction = stress * along
        return self._mean(ngs.CF((traction[0], traction[1])), radius)

    def _mean(self, vector: ngs.CoefficientFunction, radius: float) -> float:
        angle = np.linspace(0.02, 0.98, 49) * np.pi / 2
        c, s = np.cos(angle), np.sin(angle)
        points = self.structure.forms.fem(radius * c, radius * s, 0.5 * self.height)
        values = np.asarray(vector(points))
        return float(np.mean(values[:, 0] * c + values[:, 1] * s))


def solve_tube(tube: ThickTube, *, height: float, size: float) -> SolvedTube:
    """Solve a quarter of a slice of a tube, held in plane strain.

    Parameters
    ----------
    tube : ThickTube
        Radii, constants, pressure.
    height : float
        Thickness of the slice.
    size : float
        Edge of the cells.
    """
    outer = occ.Cylinder(occ.Pnt(0, 0, 0), occ.Z, r=tube.outer, h=height)
    inner = occ.Cylinder(occ.Pnt(0, 0, -height), occ.Z, r=tube.inner, h=3 * height)
    quarter = (outer - inner) * occ.Box((0, 0, 0), (tube.outer, tube.outer, height))
    quarter.mat("film")
    for face in quarter.faces:
        x, y, z = face.center.x, face.center.y, face.center.z
        if min(abs(z), abs(z - height)) < 1e-6 * height:
            face.name = "ends"
        elif min(abs(x), abs(y)) < 1e-6 * tube.inner:
            face.name = "x0" if abs(x) < abs(y) else "y0"
        else:
            face.name = "bore" if np.hypot(x, y) < tube.inner else "outside"
    mesh = ngs.Mesh(occ.OCCGeometry(quarter).GenerateMesh(maxh=size)).Curve(2)
    # bulk modulus large against the shear modulus: incompressible to 1e-5
    rubber = MooneyRivlin("rubber", 1.0, tube.c10, tube.c01, 1e5 * (tube.c10 + tube.c01))
    structure = Structure(
        mesh, {"film": rubber}, clamped=None, wetted="bore",
        guided={"x": "x0", "y": "y0", "z": "ends"},
    )  # fmt: skip
    state = structure.solve(uniform_pressure(structure.basis, "bore", tube.pressure))
    return SolvedTube(structure, state, height)


_ODEN = ThickTube(inner=7.0, outer=18.625, c10=80.0, c01=20.0, pressure=150.0)
_TUBE = "incompressible Mooney-Rivlin tube in plane strain, exact (J. T. Oden's problem, 1972)"


@cache
def _oden() -> SolvedTube:
    return solve_tube(_ODEN, height=1.5, size=2.5)


# Second-order tetrahedra of a third of the inner radius: 3e-4 of the displacement.  The stress is
# that inside the cells, without smoothing, and falls by a fifth of its value within one.
@check("structure/thick-ring", quantity="u at the bore [in], 150 psi inside",
       reference=_ODEN.displacement(7.0), source=_TUBE, tolerance=0.007)  # fmt: skip
def _thick_ring() -> float:
    return _oden().displacement(_ODEN.inner)


@check("structure/thick-ring-stress", quantity="radial stress at R = 8.16 in [psi]",
       reference=_ODEN.radial_stress(8.16), source=_TUBE, tolerance=2.0)  # fmt: skip
def _thick_ring_stress() -> float:
    return _oden().radial_stress(8.16)
