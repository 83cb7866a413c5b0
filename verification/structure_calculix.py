# SPDX-License-Identifier: LGPL-2.1-or-later
"""The static solution against CalculiX on the same second-order tetrahedra.

The deck is the one that `quietblade.propulsion.deck.write_deck` exports. Both programs use the same
shape functions; they differ in the quadrature (ours integrates the energy exactly, CalculiX takes
four points a tetrahedron) and in what they call converged. Without the program ``ccx`` there are no
rows, and a line on stderr says so.
"""

import sys
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import ngsolve as ngs
import numpy as np

from quietblade.materials import (
    IsotropicSVK,
    Material,
    OrthotropicSVK,
    ply_axes,
    section_directions,
)
from quietblade.propulsion.deck import write_deck
from quietblade.propulsion.stress import compute_stress
from quietblade.propulsion.structure import Spin, Structure, StructureState
from verification.calculix import is_installed, run_calculix, version
from verification.registry import check
from verification.structure_blade import TaperedBlade, mesh_blade

_VOIGT = ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0))
_TOLERANCE = 1e-6


@dataclass(frozen=True)
class Difference:
    """Two solutions of one problem.

    Attributes
    ----------
    deflection : float
        Largest displacement over the span, ours.
    displacement : float
        Largest difference of a nodal displacement over the largest displacement.
    stress : float
        Largest difference of a component of the nodal Cauchy stress over the largest von Mises
        stress, both at nodes away from the root.
    reaction : float
        Difference of the internal force through the root nodes over its size.
    """

    deflection: float
    displacement: float
    stress: float
    reaction: float


def compare(
    structure: Structure, state: StructureState, folder: Path, *, away: float = 0.15
) -> Difference:
    """Solve the problem of a state again by CalculiX.

    Parameters
    ----------
    structure : Structure
        With one region.
    state : StructureState
        Our equilibrium.
    folder : Path
        Where deck and results are written.
    away : float
        Share of the span next to the root where stresses are left out: at the clamped edge the
        continuum is singular.

    Raises
    ------
    CalculixError
        If ccx is not installed or finds no solution.
    """
    deck = folder / "blade.inp"
    write_deck(deck, structure, state, tolerance=_TOLERANCE)
    theirs = run_calculix(deck)
    own_nodes = theirs.nodes <= len(structure.basis.points)  # the deck may have nodes of its own
    nodes = theirs.nodes[own_nodes] - 1
    ours = structure.values(state)[nodes]
    size = float(np.linalg.norm(ours, axis=1).max())
    moved = np.abs(ours - theirs.fields["DISP"][own_nodes]).max()

    (region,) = compute_stress(structure, state).regions.values()
    height = structure.basis.points[region.nodes, 2]
    far = height > height.min() + away * np.ptp(height)
    i, j = np.array(_VOIGT).T
    stress = region.at_nodes.cauchy[:, i, j]
    place = np.searchsorted(nodes, region.nodes)
    difference = np.abs(stress - theirs.fields["STRESS"][own_nodes][place])[far].max()
    held = np.isin(nodes, structure.basis.nodes_of("root", 1))
    force = theirs.fields["FORC"][own_nodes][held].sum(axis=0)
    # CalculiX prints the internal forces, which at the root carry the pressure on its own edge too
    internal = structure.internal_force(state)[: structure.forms.n_displacement]
    own_force = (structure.basis.interpolation.T @ internal.reshape(3, -1).T)[nodes[held]].sum(
        axis=0
    )
    return Difference(
        deflection=size / float(np.ptp(height)),
        displacement=float(moved) / size,
        stress=float(difference / region.at_nodes.von_mises[far].max()),
        reaction=float(np.linalg.norm(force - own_force) / np.linalg.norm(own_force)),
    )


def compare_blade(
    material: Material,
    pressure: float,
    *,
    size: float,
    omega: float = 0.0,
    blade: TaperedBlade = TaperedBlade(),  # noqa: B008  # frozen
) -> Difference:
    """Press the lower face of a tapered blade in both programs.

    Parameters
    ----------
    material : Material
        Law of the blade.
    pressure : float
        Following pressure on the lower face [Pa].
    size : float
        Edge of the tetrahedra [m].
    omega : float
        Rotation rate about x [rad/s].
    blade : TaperedBlade
        Shape.
    """
    mesh = mesh_blade(blade, size)
    spin = Spin(omega)
    structure = Structure(mesh.fem(), {"blade": material}, wetted="lower", spin=spin)
    state = structure.solve(mesh.pressure(pressure), tolerance=_TOLERANCE)
    with TemporaryDirectory() as folder:
        return compare(structure, state, Path(folder))


def twisting_fibres() -> OrthotropicSVK:
    """Fibre plastic whose axes turn along the span."""
    plastic = OrthotropicSVK(
        "fibre", 1500.0, e1=12e9, e2=2.5e9, e3=1.5e9, g12=1e9, g23=0.6e9, g13=0.8e9,
        nu12=0.3, nu23=0.35, nu13=0.25,
    )  # fmt: skip
    return plastic.oriented(ply_axes(0.4, *section_directions(0.5 * ngs.z)))


@cache
def _solved(name: str) -> Difference:
    plastic = IsotropicSVK("plastic", 1200.0, 2.5e9, 0.35)
    if name == "isotropic":
        return compare_blade(plastic, 15e3, size=0.035)
    if name == "spinning":
        return compare_blade(plastic, 5e3, size=0.05, omega=60.0)
    return compare_blade(twisting_fibres(), 26e3, size=0.035)


# Measured: 1e-5 of displacement and force, 4e-4 of stress where fibres twist. The tolerances are
# those that an analyst would ask for.
def _enter(name: str, what: str, source: str) -> None:
    @check(f"structure/calculix-{name}-displacement", reference=0.0, source=source,
           quantity=f"largest difference over the largest displacement, {what}",
           tolerance=1e-3, quick=False)  # fmt: skip
    def displacement() -> float:
        return _solved(name).displacement

    @check(f"structure/calculix-{name}-stress", reference=0.0, source=source,
           quantity=f"largest difference of stress over the largest, away from the root, {what}",
           tolerance=0.02, quick=False)  # fmt: skip
    def stress() -> float:
        return _solved(name).stress

    @check(f"structure/calculix-{name}-reaction", reference=0.0, source=source,
           quantity=f"difference of the root force over the force, {what}",
           tolerance=1e-3, quick=False)  # fmt: skip
    def reaction() -> float:
        return _solved(name).reaction


if is_installed():
    _SAME = f"CalculiX CrunchiX {version()}, the same mesh"
    _enter("isotropic", "isotropic blade bent by a quarter of its span", _SAME)
    _enter(
        "orthotropic",
        "twisting fibres, blade bent by a fifth of its span",
        f"{_SAME}, axes constant in each cell there",
    )
    _enter("spinning", "isotropic blade under pressure and spin", _SAME)
else:
    print("structure/calculix-*: left out, the program ccx is not installed", file=sys.stderr)
