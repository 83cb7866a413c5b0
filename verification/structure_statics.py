# SPDX-License-Identifier: LGPL-2.1-or-later
"""Static equilibrium at finite strain against beams, blocks and rings in closed form."""

from functools import cache

import ngsolve as ngs
import numpy as np
from netgen import occ

from quietblade.materials import MooneyRivlin, find_material
from quietblade.propulsion.structure import Structure, StructureState
from quietblade.typing import FloatArray
from verification.registry import check
from verification.structure_models import (
    Beam,
    box_mesh,
    mean_displacement,
    uniform_pressure,
)

_ELASTICA = "inextensible elastica, two-point boundary value problem solved to 1e-6"
_BEAM = Beam()


@cache
def dead_tip_force(k: float) -> FloatArray:
    """Displacement of the tip over the length under a dead force, k = P L^2 / EI."""
    structure = _BEAM.structure()
    force = np.array([0.0, k * _BEAM.bending_stiffness / _BEAM.length**2, 0.0])
    pressure = np.zeros(len(structure.basis.points))
    state = structure.solve(pressure, dead_load=_BEAM.tip_load(structure, force))
    tip = mean_displacement(structure, structure.values(state), "tip")
    return tip / _BEAM.length


@cache
def follower_pressure(k: float) -> FloatArray:
    """Displacement of the tip over the length under a follower pressure, K = q L^3 / EI.

    Half of it pushes and half of it pulls on opposite faces: one face alone changes its length in
    bending, and with it the load, to first order in height over length.
    """
    structure = _BEAM.structure()
    q = k * _BEAM.bending_stiffness / _BEAM.length**3
    half = 0.5 * q / _BEAM.height
    pushed = Structure(
        structure.forms.fem,
        structure.forms.materials,
        wetted="lower|upper",
        basis=structure.basis,
    )
    pressure = uniform_pressure(structure.basis, "lower", half)
    pressure += uniform_pressure(structure.basis, "upper", -half)
    state = pushed.solve(pressure)
    return mean_displacement(pushed, pushed.values(state), "tip") / _BEAM.length


# Slenderness 100: shear and stretch change the elastica by a few 1e-4.
@check("structure/elastica-k4", quantity="w/L, dead tip force P L^2/EI = 4", reference=0.669964,
       source=_ELASTICA, tolerance=7e-4)  # fmt: skip
def _elastica_deflection() -> float:
    return float(dead_tip_force(4.0)[1])


@check("structure/elastica-k4-shortening", quantity="u/L, dead tip force P L^2/EI = 4",
       reference=0.328941, source=_ELASTICA, tolerance=7e-4)  # fmt: skip
def _elastica_shortening() -> float:
    return float(-dead_tip_force(4.0)[2])


@check("structure/elastica-k10", quantity="w/L, dead tip force P L^2/EI = 10", reference=0.810609,
       source=_ELASTICA, tolerance=8e-4)  # fmt: skip
def _elastica_far() -> float:
    return float(dead_tip_force(10.0)[1])


# Slenderness 100 and 40 cells: 3e-4 at the largest bend.
_FOLLOWER = {1: 0.124444, 2: 0.245592, 4: 0.466023, 10: 0.830148}

for _k, _w in _FOLLOWER.items():

    @check(f"structure/follower-pressure-K{_k}",
           quantity=f"w/L, follower pressure q L^3/EI = {_k}", reference=_w,
           source=_ELASTICA, tolerance=1e-3 * _w)  # fmt: skip
    def _follower(k: float = _k) -> float:
        return float(follower_pressure(k)[1])


@check("structure/follower-pressure-K4-shortening", quantity="u/L, follower pressure q L^3/EI = 4",
       reference=0.134987, source=_ELASTICA, tolerance=3e-4)  # fmt: skip
def _follower_shortening() -> float:
    return float(-follower_pressure(4.0)[2])


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


# Homogeneous states are exact in any mesh; the references have six digits.
@check("structure/film-shear", quantity="shear stress of the film at gamma = 0.09 [Pa]",
       reference=0.09 * 2 * (0.238e6 + 0.523e6), source="Mooney-Rivlin: tau = 2 (C10 + C01) gamma",
       tolerance=0.2)  # fmt: skip
def _film_shear() -> float:
    structure = film_block()
    gradient = np.eye(3)
    gradient[2, 1] = 0.09
    return float(nominal_stress(structure, homogeneous(structure, gradient))[2, 1])


_UNIAXIAL = {0.8: -1.35992e6, 0.9: -0.548097e6, 1.1: 0.390336e6, 1.5: 1.238519e6, 2.0: 1.748250e6}

for _stretch, _stress in _UNIAXIAL.items():

    @check(f"structure/film-uniaxial-{_stretch:g}",
           quantity=f"nominal stress of the film at stretch {_stretch:g} [Pa]", reference=_stress,
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


# -- thick ring under internal pressure -----------------------------------------------------------

_INNER, _OUTER, _THICKNESS = 7.0, 18.625, 1.5


@cache
def ring_displacement() -> float:
    """Displacement of the inner radius of a thick ring in plane strain, quarter model."""
    outer = occ.Cylinder(occ.Pnt(0, 0, 0), occ.Z, r=_OUTER, h=_THICKNESS)
    inner = occ.Cylinder(occ.Pnt(0, 0, -1), occ.Z, r=_INNER, h=_THICKNESS + 2)
    ring = (outer - inner) * occ.Box((0, 0, 0), (_OUTER, _OUTER, _THICKNESS))
    ring.mat("film")
    for face in ring.faces:
        centre = face.center
        if abs(centre.z) < 1e-6 or abs(centre.z - _THICKNESS) < 1e-6:
            face.name = "ends"
        elif abs(centre.x) < 1e-6:
            face.name = "x0"
        elif abs(centre.y) < 1e-6:
            face.name = "y0"
        else:
            face.name = "bore" if np.hypot(centre.x, centre.y) < _INNER else "outside"
    mesh = ngs.Mesh(occ.OCCGeometry(ring).GenerateMesh(maxh=2.5)).Curve(2)
    # bulk modulus large against the shear modulus of 200 psi: incompressible to 1e-5
    rubber = MooneyRivlin("rubber", 1.0, 80.0, 20.0, 1e7)
    structure = Structure(
        mesh, {"film": rubber}, clamped=None, wetted="bore",
        guided={"x": "x0", "y": "y0", "z": "ends"},
    )  # fmt: skip
    bore = structure.basis.nodes_of("bore", 1)
    state = structure.solve(uniform_pressure(structure.basis, "bore", 150.0))
    points = structure.basis.points[bore, :2]
    moved = points + structure.values(state)[bore, :2]
    return float((np.linalg.norm(moved, axis=1) - np.linalg.norm(points, axis=1)).mean())


# Second-order tetrahedra of a third of the inner radius: 3e-4.
@check("structure/thick-ring", quantity="u at the bore [in], 150 psi inside", reference=7.18187,
       source="incompressible Mooney-Rivlin ring in plane strain, exact (Oden 1972 problem)",
       tolerance=0.015)  # fmt: skip
def _thick_ring() -> float:
    return ring_displacement()
