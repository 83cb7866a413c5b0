# SPDX-License-Identifier: LGPL-2.1-or-later
"""Models of flexible hydrofoils of a water-tunnel experiment, with what was measured on them.

Measured by G. A. Zarruk, P. A. Brandner, B. W. Pearce and A. W. Phillips, Experimental study of
the steady fluid-structure interaction of flexible hydrofoils, J. Fluids Struct. 51 (2014) 326-343.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import ngsolve as ngs
import numpy as np
from numpy.typing import ArrayLike

from quietblade.errors import ConvergenceError
from quietblade.flow.inflow import Inflow, StripInflow
from quietblade.flow.lifting_line import LiftingLineInflow
from quietblade.geometry import Blade, NacaFourDigit, constant, table
from quietblade.linalg import make_solver
from quietblade.materials import (
    IsotropicSVK,
    Material,
    OrthotropicSVK,
    ply_axes,
    section_directions,
)
from quietblade.mesh import INTERFACE, Mesh, MeshSpec, Patch, build_mesh
from quietblade.mesh.surface import SurfaceQuadrature
from quietblade.propulsion.coupling import StaticState, solve_static
from quietblade.propulsion.structure import Structure
from quietblade.propulsion.tangent import compute_tangent
from quietblade.propulsion.transfer import LoadTransfer
from quietblade.typing import FloatArray
from quietblade.vibroacoustics.fluid import Water
from quietblade.vibroacoustics.modes import dry_modes, wet_modes
from quietblade.vibroacoustics.operators import build_operators
from verification.structure_models import traction_load

SPAN, ROOT_CHORD, TIP_CHORD, THICKNESS = 0.3, 0.12, 0.06, 0.09
"""Planform [m], and thickness over chord."""

INCIDENCE, REYNOLDS = np.radians(6.0), 1.0e6
"""Incidence of the compared state, and its Reynolds number with the mean chord of 90 mm."""

WATER = Water(density=998.0, sound_speed=1480.0)
VISCOSITY = 1.0e-6

CELL = 0.010
"""Edge of the cells on the foil [m]."""


class FourthPowerEdge(NacaFourDigit):
    """NACA 4-digit sections whose blunt edge is made by the last coefficient, that of x^4."""

    def half_thickness(self, x: ArrayLike, thickness: ArrayLike, te: ArrayLike) -> FloatArray:
        """Half thickness / chord; what the edge is thicker than the original's goes with x^4."""
        x, t = np.asarray(x, dtype=np.float64), np.asarray(thickness, dtype=np.float64)
        more = 0.5 * np.asarray(te, dtype=np.float64) - 0.0105 * t
        return np.asarray(super().half_thickness(x, t, 0.021 * t) + more * x**4)


STREAMS = {"strip": StripInflow, "lifting line": LiftingLineInflow}
"""Models of the flow about a fixed foil, by name."""


@dataclass(frozen=True)
class Hydrofoil:
    """A foil of the experiment with what was measured; NaN where nothing is published.

    Attributes
    ----------
    name : str
    edge : float
        Thickness of the trailing edge over the chord: 0.19 % (type I) or 1.32 % (type II).
    material : IsotropicSVK or OrthotropicSVK
        Fibres along the span.
    inertia : float
        Second moment of area of the root section, as published [m4].
    stiffness : float
        Force at the quarter chord of the tip over the deflection there [N/m].
    dry, wet : float
        First frequency in air and in water [Hz].
    deflection, twist : float
        Of the tip at 6 degrees and Re = 1e6 [m, rad]; the twist of the metal foils was too small
        to be resolved.
    slope : float
        Deflection ``d E I / (F s^3)`` for the force F normal to the chord.
    """

    name: str
    edge: float
    material: IsotropicSVK | OrthotropicSVK
    inertia: float
    stiffness: float
    dry: float
    wet: float
    deflection: float
    twist: float
    slope: float

    @property
    def young(self) -> float:
        """Young's modulus along the span [Pa]."""
        law = self.material
        return law.e1 if isinstance(law, OrthotropicSVK) else law.youngs_modulus


TYPE_I, TYPE_II = 0.00189, 0.01323

# Only the modulus along the span is published; those across are usual for carbon-epoxy.
_CARBON = OrthotropicSVK(
    "carbon-0", 1600.0, e1=65e9, e2=10e9, e3=10e9, g12=4e9, g23=3.5e9, g13=4e9,
    nu12=0.28, nu23=0.4, nu13=0.28,
)  # fmt: skip
_STEEL = IsotropicSVK("steel-316L", 7900.0, 193e9, 0.3)
_ALUMINIUM = IsotropicSVK("aluminium-6061-T6", 2700.0, 71e9, 0.33)

FOILS = {
    foil.name: foil
    for foil in (
        Hydrofoil("I-SS", TYPE_I, _STEEL, 5956e-12, 61.7e3, 100.0, 62.0, 4.9e-3, np.nan, 0.204),
        Hydrofoil("II-SS", TYPE_II, _STEEL, 6148e-12, 60.2e3, 96.0, 61.0, 5.0e-3, np.nan, 0.227),
        Hydrofoil("II-AL", TYPE_II, _ALUMINIUM, 6350e-12, 22.1e3, 96.0, 41.0, 12.5e-3,
                  np.nan, 0.219),
        Hydrofoil("II-CFRP00", TYPE_II, _CARBON, 6148e-12, 20.0e3, 112.0, 41.0, 15.15e-3,
                  np.radians(0.6), np.nan),
    )
}  # fmt: skip
"""Foils by name."""


def foil_blade(edge: float, incidence: float = INCIDENCE) -> Blade:
    """Trapezoid without sweep about its mid-chord line, root at z = 0."""
    return Blade(
        hub_radius=0.0,
        span=SPAN,
        chord=table([0.0, 1.0], [ROOT_CHORD, TIP_CHORD]),
        blade_angle=constant(incidence),
        sweep=constant(0.0),
        rake=constant(0.0),
        thickness=constant(THICKNESS),
        camber=constant(0.0),
        family=FourthPowerEdge(),
        trailing_edge=edge,
    )


@cache
def foil_mesh(edge: float, cell: float = CELL) -> Mesh:
    """Foil in a sphere of water of one span; the wall at the root is left out."""
    centre = (0.0, 0.0, 0.5 * SPAN)
    patch = Patch(1, (0.85, 0.93), (0.35, 0.65))
    return build_mesh(foil_blade(edge), MeshSpec(cell, centre, SPAN, (patch,)))


def foil_structure(edge: float, material: Material, cell: float = CELL) -> Structure:
    """Solid of a foil, clamped at the root; fibres of an orthotropic solid lie along the span."""
    mesh = foil_mesh(edge, cell)
    if isinstance(material, OrthotropicSVK):
        material = material.oriented(ply_axes(0.0, *section_directions(INCIDENCE)))
    return Structure(mesh.fem, {"blade": material}, basis=mesh.basis)


def tip_stiffness(structure: Structure, chord_fraction: float = 0.25) -> float:
    """Force over deflection normal to the chord [N/m], at a chord fraction of the tip.

    The force is a traction on the tip face, linear along the chord; the deflection is its mean
    with the weight of the traction, at which the force does its work.
    """
    _, chordwise, normal = section_directions(INCIDENCE)
    tip = ngs.IfPos(ngs.z - (1.0 - 1e-9) * SPAN, 1.0, 0.0)
    x = sum(float(t) * place for t, place in zip(chordwise, (ngs.x, ngs.y, ngs.z), strict=True))
    on_tip = structure.forms.fem.Boundaries(INTERFACE)
    area, square = (
        ngs.Integrate(tip * x**power, structure.forms.fem, definedon=on_tip) for power in (0, 2)
    )
    first = ngs.Integrate(tip * x, structure.forms.fem, definedon=on_tip)
    arm = (chord_fraction - 0.5) * TIP_CHORD
    constant_part, slope = np.linalg.solve([[area, first], [first, square]], [1.0, arm])
    weight = tip * (float(constant_part) + float(slope) * x)
    traction = ngs.CF(tuple(float(n) * weight for n in normal))
    tangent = compute_tangent(structure, structure.rest())
    free = tangent.free
    force = traction_load(structure, traction, INTERFACE)[free]
    factor = make_solver(precision="double").factor(tangent.stiffness()[free][:, free])
    return float(1.0 / (force @ factor.solve(force)))


def first_frequencies(
    structure: Structure, mesh: Mesh, water: Water, highest: float
) -> tuple[float, float]:
    """First frequency in vacuo and in incompressible water [Hz]; both are below ``highest``."""
    tangent = compute_tangent(structure, structure.rest())
    operators = build_operators(
        mesh.fem,
        stiffness=tangent.stiffness(),
        mass=tangent.mass,
        water=water,
        radius=mesh.radius,
    )
    dry, wet = (modes(operators, highest).frequency[0] for modes in (dry_modes, wet_modes))
    return float(dry), float(wet)


def stream(kind: str, reynolds: float = REYNOLDS) -> Inflow:
    """Inflow of a fixed foil: ``strip`` or ``lifting line``, the wall at the root its mirror."""
    speed = reynolds * VISCOSITY / (0.5 * (ROOT_CHORD + TIP_CHORD))
    return STREAMS[kind](speed, 0.0, WATER.density, VISCOSITY)


def bend(structure: Structure, edge: float, inflow: Inflow, *, sections: int = 31) -> StaticState:
    """Equilibrium of a foil with its flow."""
    blade, mesh = foil_blade(edge), foil_mesh(edge)
    stations = np.linspace(0.0, 1.0, sections)
    surface = SurfaceQuadrature(mesh.nodes, mesh.interface)
    transfer = LoadTransfer(surface, blade, stations, blade.section(stations, 121))
    return solve_static(structure, transfer, inflow, tolerance=1e-4)


@dataclass(frozen=True)
class Bent:
    """A foil in the stream.

    Attributes
    ----------
    deflection : float
        Of the tip's mid-chord, normal to the undeformed chord [m].
    twist : float
        Of the tip, nose up [rad].
    normal_coefficient : float
        Force normal to the chord over dynamic pressure and area.
    slope : float
        ``d E I / (F s^3)`` as published, with the computed d and F.
    """

    deflection: float
    twist: float
    normal_coefficient: float
    slope: float


@cache
def bent(name: str, kind: str) -> Bent:
    """Bend a foil of `FOILS` by a kind of `stream`."""
    foil, inflow = FOILS[name], stream(kind)
    state = bend(_structure(name), foil.edge, inflow)
    if not state.converged:
        raise ConvergenceError(f"hydrofoil {name} in the {kind}'s stream: {state.notices}")
    _, _, normal = section_directions(INCIDENCE)
    force = float(state.coupled.total.force @ normal)
    deflection = float(state.tip_displacement @ normal)
    turned = state.coupled.sections.blade_angle - state.rigid.sections.blade_angle
    slope = deflection * foil.young * foil.inertia / (force * SPAN**3)
    return Bent(deflection, float(turned[-1]), force / reference_force(), slope)


def reference_force() -> float:
    """Dynamic pressure times area [N]."""
    chord = 0.5 * (ROOT_CHORD + TIP_CHORD)
    return 0.5 * WATER.density * (REYNOLDS * VISCOSITY / chord) ** 2 * SPAN * chord


@cache
def _structure(name: str) -> Structure:
    foil = FOILS[name]
    return foil_structure(foil.edge, foil.material)


@cache
def stiffness(name: str) -> float:
    """`tip_stiffness` of a foil of `FOILS`."""
    return tip_stiffness(_structure(name))


@cache
def frequencies(name: str) -> tuple[float, float]:
    """`first_frequencies` of a foil of `FOILS`."""
    foil = FOILS[name]
    return first_frequencies(_structure(name), foil_mesh(foil.edge), WATER, 1.6 * foil.dry)


def taper_slope(load: Callable[[FloatArray], FloatArray]) -> float:
    """``d E I / (F s^3)`` of a clamped tapered beam by Euler and Bernoulli.

    Parameters
    ----------
    load : callable
        Force per length at span fractions, up to a factor.
    """
    x, weight = np.polynomial.legendre.leggauss(200)
    s, weight = 0.5 * (x + 1.0), 0.5 * weight
    force = weight * load(s)
    moment = np.maximum(s[None, :] - s[:, None], 0.0) @ force
    stiffness = (1.0 + (TIP_CHORD / ROOT_CHORD - 1.0) * s) ** 4
    return float(weight @ (moment * (1.0 - s) / stiffness) / np.sum(force))


def taper_stiffness(young: float, inertia: float) -> float:
    """Tip force over tip deflection of the clamped tapered beam [N/m]."""
    return 1.5 * young * inertia / SPAN**3
