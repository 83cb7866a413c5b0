# SPDX-License-Identifier: LGPL-2.1-or-later
"""Stresses, strains, failure indices and reactions of the output, against closed forms."""

from functools import cache

import numpy as np

from quietblade.materials import (
    ElasticMaterial,
    IsotropicSVK,
    OrthotropicSVK,
    ply_axes,
    section_directions,
)
from quietblade.materials.draping import homogenised
from quietblade.materials.laminate import Laminate, Ply
from quietblade.materials.strength import PlyStrength
from quietblade.propulsion.plies import ply_state
from quietblade.propulsion.stress import RegionStress, StressReport, compute_stress
from quietblade.propulsion.structure import Spin, Structure, StructureState
from quietblade.typing import FloatArray
from verification.registry import check
from verification.structure_blade import TaperedBlade, mesh_blade
from verification.structure_models import Beam, box_mesh, uniform_pressure
from verification.structure_solid_theory import ThickTube
from verification.structure_statics import solve_tube

# -- closed forms ---------------------------------------------------------------------------------


def bar_second_piola(cauchy: float, youngs_modulus: float, poisson_ratio: float) -> float:
    """Second Piola-Kirchhoff stress [Pa] of a Saint-Venant-Kirchhoff bar of given Cauchy stress.

    With ``l^2 = 1 + 2 S/E`` along and ``1 - 2 nu S/E`` across, ``cauchy = S l / (1 - 2 nu S/E)``.
    """
    stress = cauchy
    for _ in range(60):
        stretch = np.sqrt(1.0 + 2.0 * stress / youngs_modulus)
        stress = cauchy * (1.0 - 2.0 * poisson_ratio * stress / youngs_modulus) / stretch
    return float(stress)


def shear_logarithmic_strain(shear: float) -> float:
    """Greatest principal logarithmic strain of simple shear, ``asinh(gamma / 2)``."""
    return float(np.arcsinh(0.5 * shear))


def off_axis_tsai_hill(angle: float, x: float, y: float, s: float) -> float:
    """Strength [Pa] of a ply pulled at an angle [rad] to its fibres, by Tsai and Hill.

    R. M. Jones, Mechanics of Composite Materials, 2nd ed., section 2.9.
    """
    c2, s2 = np.cos(angle) ** 2, np.sin(angle) ** 2
    return float((c2**2 / x**2 + c2 * s2 * (1 / s**2 - 1 / x**2) + s2**2 / y**2) ** -0.5)


def off_axis_maximum_strain(angle: float, ply: OrthotropicSVK) -> float:
    """Strength [Pa] of a ply pulled at an angle [rad] to its fibres, by the largest strain.

    Limits are strengths over moduli (linear plies).
    """
    assert ply.strength is not None
    c2, s2 = np.cos(angle) ** 2, np.sin(angle) ** 2
    nu21 = ply.nu12 * ply.e2 / ply.e1
    along, across = c2 - ply.nu12 * s2, s2 - nu21 * c2
    # strains times modulus for a unit stress: e1 E1 = c^2 - nu12 s^2, e2 E2 = s^2 - nu21 c^2
    limits = [
        (ply.strength.xt if along >= 0 else ply.strength.xc) / abs(along),
        (ply.strength.yt if across >= 0 else ply.strength.yc) / abs(across),
        ply.strength.s12 / np.sqrt(c2 * s2),
    ]
    return float(min(limits))


def cross_ply_stress(ply: OrthotropicSVK, stress: float) -> tuple[float, float]:
    """Stress along the fibres and across them of the 0 degree half of a cross-ply laminate [Pa].

    Half of the plies lie along the mean stress and half across it; classical laminate theory.
    """
    nu21 = ply.nu12 * ply.e2 / ply.e1
    q = 1.0 - ply.nu12 * nu21
    q11, q22, q12 = ply.e1 / q, ply.e2 / q, ply.nu12 * ply.e2 / q
    mean = np.array([[0.5 * (q11 + q22), q12], [q12, 0.5 * (q11 + q22)]])
    e1, e2 = np.linalg.solve(mean, [stress, 0.0])
    return float(q11 * e1 + q12 * e2), float(q12 * e1 + q22 * e2)


# -- models ---------------------------------------------------------------------------------------


def cube(material: ElasticMaterial) -> Structure:
    """Make a unit cube of eight cells, held nowhere in particular."""
    planes = np.linspace(0.0, 1.0, 3)
    return Structure(box_mesh(planes, planes, planes), {"blade": material}, wetted="tip")


def deformed(structure: Structure, gradient: FloatArray) -> StructureState:
    """State with a homogeneous deformation gradient."""
    rest = structure.rest()
    displacement = structure.basis.to_dofs(structure.basis.points @ (gradient - np.eye(3)).T)
    return StructureState(displacement, rest.film_pressure, rest.loading)


def pulled(material: IsotropicSVK, tension: float) -> RegionStress:
    """Pull a bar by a following tension [Pa] on its end, free to contract."""
    planes = np.linspace(0.0, 1.0, 3)
    structure = Structure(
        box_mesh(planes, planes, planes), {"blade": material}, clamped=None, wetted="tip",
        guided={"x": "left", "y": "lower", "z": "root"},
    )  # fmt: skip
    state = structure.solve(uniform_pressure(structure.basis, "tip", -tension), tolerance=1e-10)
    return compute_stress(structure, state).regions["blade"]


def pulled_ply(ply: OrthotropicSVK, angle: float, stress: float) -> RegionStress:
    """Put a block of a ply, turned from the pull by an angle, under a small uniaxial stress.

    The stretch that the law gives for the second Piola-Kirchhoff stress ``stress`` along z.
    """
    material = ply.oriented(ply_axes(angle, *section_directions()))
    structure = cube(material)
    A = np.asarray(material.axes)
    own = A.T @ np.diag([0.0, 0.0, stress]) @ A
    strain = np.diag(ply.compliance @ np.diag(own))
    for i, j, modulus in ((0, 1, ply.g12), (1, 2, ply.g23), (0, 2, ply.g13)):
        strain[i, j] = strain[j, i] = own[i, j] / (2.0 * modulus)
    squares, axes = np.linalg.eigh(np.eye(3) + 2.0 * A @ strain @ A.T)
    gradient = axes * np.sqrt(squares) @ axes.T
    return compute_stress(structure, deformed(structure, gradient)).regions["blade"]


def off_axis_strength(ply: OrthotropicSVK, angle: float, index: str) -> float:
    """Stress [Pa] at which an index of a pulled ply becomes one."""
    stress = 1e-3 * ply.e2
    return float(stress / pulled_ply(ply, angle, stress).failure_at_nodes[index].max())


@cache
def pressed_blade() -> StressReport:
    """Press and spin a tapered blade, until its tip moves by a tenth of the span."""
    mesh = mesh_blade(TaperedBlade(), 0.08)
    plastic = IsotropicSVK("plastic", 1200.0, 2.5e9, 0.35)
    structure = Structure(mesh.fem(), {"blade": plastic}, wetted="lower", spin=Spin(40.0))
    return compute_stress(structure, structure.solve(mesh.pressure(6e3), tolerance=1e-10))


# -- rows -----------------------------------------------------------------------------------------

_RUBBERY = IsotropicSVK("soft", 1000.0, 1e6, 0.3)
_LAW = "Saint-Venant-Kirchhoff bar, exact"


# A homogeneous state: exact on any mesh, but for the residual.
@check("structure/stress-bar-cauchy", quantity="Cauchy stress under a tension of 0.3 E [Pa]",
       reference=3e5, source="equilibrium on the deformed area", tolerance=1.0)  # fmt: skip
def _bar_cauchy() -> float:
    return float(pulled(_RUBBERY, 3e5).at_nodes.cauchy[:, 2, 2].mean())


@check("structure/stress-bar-second-piola",
       quantity="second Piola-Kirchhoff stress under a tension of 0.3 E [Pa]",
       reference=bar_second_piola(3e5, 1e6, 0.3), source=_LAW, tolerance=1.0)  # fmt: skip
def _bar_second_piola() -> float:
    return float(pulled(_RUBBERY, 3e5).at_nodes.second_piola[:, 2, 2].mean())


@check("structure/strain-log-shear",
       quantity="greatest principal logarithmic strain, simple shear 0.8",
       reference=shear_logarithmic_strain(0.8), source="asinh(gamma/2), exact",
       tolerance=1e-12)  # fmt: skip
def _shear() -> float:
    gradient = np.eye(3)
    gradient[2, 1] = 0.8
    structure = cube(_RUBBERY)
    fields = compute_stress(structure, deformed(structure, gradient)).regions["blade"].at_nodes
    return float(fields.principal_logarithmic[:, 0].max())


# Linear over the section and along the beam, as the cells can be; the deflection of 1e-4 lengths
# leaves 1e-4.
@check("structure/stress-beam", quantity="bending stress at the surface over M h / (2 I), mid-span",
       reference=1.0, source="beam theory, tip force", tolerance=1e-3)  # fmt: skip
def _beam() -> float:
    beam = Beam()
    structure = beam.structure()
    force = 3e-4 * beam.bending_stiffness / beam.length**2
    state = structure.solve(
        np.zeros(len(structure.basis.points)),
        dead_load=beam.tip_load(structure, np.array([0.0, force, 0.0])),
    )
    region = compute_stress(structure, state).regions["blade"]
    points = structure.basis.points[region.nodes]
    place = np.argmin(np.linalg.norm(points - [0.0, -0.05, 5.0], axis=1))
    expected = 0.5 * force * beam.length * 0.5 * beam.height * 12 / beam.height**4
    return float(region.at_nodes.cauchy[place, 2, 2] / expected)


_TUBE = ThickTube(inner=7.0, outer=18.625, c10=80.0, c01=20.0, pressure=150.0)
_SWOLLEN = (1.0 + _TUBE.displacement(7.0) / 7.0) ** 2


# Nodal stresses at a surface, where the gradient is steepest: the second-order tetrahedra of a
# third of the inner radius miss 2 %.
@check("structure/stress-tube-bore",
       quantity="mean hoop less radial stress at the nodes of the bore [psi]",
       reference=200.0 * (_SWOLLEN - 1.0 / _SWOLLEN),
       source="incompressible Mooney-Rivlin tube in plane strain, exact",
       tolerance=14.0)  # fmt: skip
def _tube() -> float:
    solved = solve_tube(_TUBE, height=1.5, size=2.5)
    region = compute_stress(solved.structure, solved.state).regions["film"]
    bore = np.isin(region.nodes, solved.structure.basis.nodes_of("bore", 1))
    stress = region.at_nodes.cauchy[bore]
    x, y, _ = solved.structure.basis.points[region.nodes[bore]].T
    r = np.stack([x, y, 0 * x], axis=1) / np.hypot(x, y)[:, None]
    t = np.stack([-y, x, 0 * x], axis=1) / np.hypot(x, y)[:, None]
    hoop = np.einsum("ni,nij,nj->n", t, stress, t) - np.einsum("ni,nij,nj->n", r, stress, r)
    return float(hoop.mean())


_BALANCE = "equilibrium of the whole blade"


@check("structure/reaction-force", quantity="|root force + loads| / |loads|", reference=0.0,
       source=_BALANCE, tolerance=1e-8)  # fmt: skip
def _force() -> float:
    return pressed_blade().reaction.force_imbalance


@check("structure/reaction-moment", quantity="|root moment + loads| / |loads|", reference=0.0,
       source=_BALANCE, tolerance=1e-8)  # fmt: skip
def _moment() -> float:
    return pressed_blade().reaction.moment_imbalance


# E-glass and epoxy as in Jones' example; the form of the laws matters here, not the numbers.
GLASS = OrthotropicSVK(
    "glass", 2000.0, e1=54e9, e2=18e9, e3=18e9, g12=9e9, g23=6e9, g13=9e9, nu12=0.25, nu23=0.4,
    nu13=0.25, strength=PlyStrength(1035e6, 1035e6, 28e6, 138e6, 41e6),
)  # fmt: skip
"""A ply of E-glass and epoxy, of the size of the figures in Jones' table 2-3."""

for _degrees in (15, 45, 75):

    @check(f"structure/tsai-hill-{_degrees}deg",
           quantity=f"strength of a ply pulled at {_degrees} deg, Tsai-Hill [Pa]",
           reference=off_axis_tsai_hill(np.radians(_degrees), 1035e6, 28e6, 41e6),
           source="closed form, Jones, section 2.9", tolerance=1e3)  # fmt: skip
    def _tsai_hill(degrees: float = _degrees) -> float:
        return off_axis_strength(GLASS, np.radians(degrees), "tsai_hill")

    @check(f"structure/maximum-strain-{_degrees}deg",
           quantity=f"strength of a ply pulled at {_degrees} deg, maximum strain [Pa]",
           reference=off_axis_maximum_strain(np.radians(_degrees), GLASS),
           source="closed form, Jones, section 2.9", tolerance=1e3)  # fmt: skip
    def _maximum_strain(degrees: float = _degrees) -> float:
        return off_axis_strength(GLASS, np.radians(degrees), "maximum_strain")


def recovered_ply_stress(stress: float) -> tuple[float, float]:
    """Stress along and across the fibres of the 0 degree plies of a block of cross-ply [Pa].

    The block is one effective solid of very many thin plies of `GLASS`, under a stress along z.
    """
    laminate = Laminate("cross", tuple(Ply(GLASS, a, fraction=0.5) for a in (0.0, 0.5 * np.pi)))
    strain = np.linalg.solve(laminate.stiffness, [stress, 0.0, 0.0, 0.0, 0.0, 0.0])
    stretches = np.sqrt(1.0 + 2.0 * strain[[1, 2, 0]])  # chord x, thickness y, span z
    structure = cube(homogenised(laminate, ply_axes(0.0, *section_directions())))
    state = deformed(structure, np.diag(stretches))
    fields = compute_stress(structure, state).regions["blade"].at_points
    assert fields.material_strain is not None
    assert fields.material_stress is not None
    own = ply_state(laminate.plies[0], fields.material_strain, fields.material_stress)[1]
    return float(own[:, 0, 0].mean()), float(own[:, 1, 1].mean())


for _number, _name in enumerate(("along", "across")):

    @check(f"structure/ply-stress-{_name}",
           quantity=f"stress {_name} the fibres of 0 deg plies, 20 MPa on a cross-ply solid [Pa]",
           reference=cross_ply_stress(GLASS, 20e6)[_number],
           source="classical laminate theory, exact", tolerance=1.0)  # fmt: skip
    def _ply_stress(number: int = _number) -> float:
        return recovered_ply_stress(20e6)[number]
