# SPDX-License-Identifier: LGPL-2.1-or-later
"""Loads, elastic supports and the limits of equilibrium against closed forms."""

from functools import cache

import numpy as np
from scipy.optimize import brentq

from quietblade.materials import IsotropicSVK
from quietblade.propulsion.loads import Gravity, HydrostaticPressure, LineForce, Load, PointForce
from quietblade.propulsion.loads_assembly import apply_loads
from quietblade.propulsion.structure import Structure
from quietblade.propulsion.supports import RootSpring, Support
from quietblade.propulsion.tangent import compute_tangent
from quietblade.typing import FloatArray
from verification.registry import check
from verification.structure_models import SURFACE, Beam, box_mesh, dry_modes

SLENDER = Beam(length=1.0, height=0.02, cells=12, youngs_modulus=70e9, density=2700.0)
_BENDING = "Euler-Bernoulli cantilever"

# -- closed forms ---------------------------------------------------------------------------------


def spring_beam_tip(kappa: float) -> float:
    """Tip deflection ``w EI / (P L^3)`` of a cantilever with a root spring ``kappa = k L / EI``."""
    return 1.0 / 3.0 + 1.0 / kappa


def spring_beam_frequency(kappa: float) -> float:
    """Square root ``lambda`` of the first frequency times ``sqrt(m L^4 / EI)`` with a root spring.

    Least root of ``kappa (1 + cos cosh) + lambda (cos sinh - sin cosh) = 0``; it is that of a rigid
    rod, ``(3 kappa)^(1/4)``, for a soft spring and 1.8751 for a clamp.
    """

    def equation(x: float) -> float:
        c, s, ch, sh = np.cos(x), np.sin(x), np.cosh(x), np.sinh(x)
        return float(kappa * (1.0 + c * ch) + x * (c * sh - s * ch))

    return float(brentq(equation, 1e-6, 1.8752))


# -- computations with free parameters ------------------------------------------------------------


def supported_beam(beam: Beam, support: Support | None) -> Structure:
    """Beam on an elastic support at its root, or clamped without one."""
    material = IsotropicSVK("beam", beam.density, beam.youngs_modulus, 0.0)
    return Structure(
        beam.mesh(), {"blade": material}, wetted=SURFACE,
        clamped="root" if support is None else None, support=support,
    )  # fmt: skip


def tip_deflection(beam: Beam, loads: list[Load], support: Support | None = None) -> float:
    """Displacement of the tip along y under given loads [m]."""
    structure = supported_beam(beam, support)
    applied = apply_loads(structure, loads)
    state = structure.solve(applied.pressure, dead_load=applied.dead_load)
    tip = structure.basis.nodes_of("tip", 1)
    return float(structure.values(state)[tip, 1].mean())


def spring_of(beam: Beam, kappa: float) -> RootSpring:
    """Root spring against rotation about x with the stiffness ``kappa EI / L``."""
    stiffness = kappa * beam.bending_stiffness / beam.length
    return RootSpring(rotation=(stiffness, np.inf, np.inf))


def first_frequency(beam: Beam, support: Support | None) -> float:
    """Lowest angular frequency [rad/s]."""
    structure = supported_beam(beam, support)
    return float(dry_modes(compute_tangent(structure, structure.rest()), 2).omega[0])


@cache
def column_pivots(force: float, beam: Beam = SLENDER) -> int:
    """Negative pivots of a clamped column under an axial force ``N L^2 / EI``."""
    structure = beam.structure()
    size = force * beam.bending_stiffness / beam.length**2
    load = beam.tip_load(structure, np.array([0.0, 0.0, size]))
    state = structure.solve(np.zeros(len(structure.basis.points)), dead_load=load)
    return state.steps[-1].negative_pivots or 0


def crushed_bar(factor: float) -> float:
    """Part that a Saint-Venant-Kirchhoff bar carries of `factor` times its greatest compression."""
    bar = Beam(length=0.3, cells=1)
    structure = bar.structure()
    greatest = bar.youngs_modulus * bar.height**2 / (3.0 * np.sqrt(3.0))
    load = bar.tip_load(structure, np.array([0.0, 0.0, -factor * greatest]))
    nothing = np.zeros(len(structure.basis.points))
    return structure.solve(nothing, dead_load=load, on_failure="return").fraction


def box_buoyancy(gravity: FloatArray) -> FloatArray:
    """Force of the water on a box that is wet all around, over density times volume [m/s2]."""
    planes = np.linspace(0.0, 1.0, 3)
    mesh = box_mesh(0.3 * planes, 0.2 * planes, planes)
    wet = f"root|{SURFACE}"
    metal = IsotropicSVK("metal", 2700.0, 70e9, 0.33)
    structure = Structure(mesh, {"blade": metal}, clamped=None, wetted=wet)
    water = HydrostaticPressure(1000.0, 10.0, (gravity[0], gravity[1], gravity[2]), "frozen")
    return apply_loads(structure, [water]).force / (1000.0 * 0.06)


# -- rows -----------------------------------------------------------------------------------------

# The spring turns by a few 1e-6, far below where its linear kinematics matter; slenderness 50
# without shear deformation in the closed form: 4e-4.
for _kappa in (0.3, 3.0, 30.0):

    @check(f"structure/root-spring-tip-{_kappa:g}",
           quantity=f"w EI / (P L^3), root spring k L / EI = {_kappa:g}",
           reference=spring_beam_tip(_kappa), source=f"{_BENDING} on a rotational spring",
           tolerance=1.5e-3 * spring_beam_tip(_kappa))  # fmt: skip
    def _spring_tip(kappa: float = _kappa) -> float:
        force = 1e-6 * SLENDER.bending_stiffness / SLENDER.length**2
        load = PointForce((0.0, 0.0, SLENDER.length), (0.0, force, 0.0))
        tip = tip_deflection(SLENDER, [load], spring_of(SLENDER, kappa))
        return tip / 1e-6 / SLENDER.length

    @check(f"structure/root-spring-frequency-{_kappa:g}",
           quantity=f"(omega^2 m L^4 / EI)^(1/4), root spring k L / EI = {_kappa:g}",
           reference=spring_beam_frequency(_kappa), source=f"{_BENDING} on a rotational spring",
           tolerance=1e-3 * spring_beam_frequency(_kappa))  # fmt: skip
    def _spring_frequency(kappa: float = _kappa) -> float:
        omega = first_frequency(SLENDER, spring_of(SLENDER, kappa))
        return float(np.sqrt(omega * SLENDER.time_scale))


# Small loads on a beam of slenderness 50: shear and the clamp change the deflection by 1e-3.
def _unit_line(beam: Beam, total: float) -> LineForce:
    path = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, beam.length]])
    return LineForce(path, np.array([0.0, total / beam.length, 0.0]))


@check("structure/line-force-tip", quantity="w EI / (q L^4), uniform line force", reference=1 / 8,
       source=_BENDING, tolerance=2.5e-4)  # fmt: skip
def _line_tip() -> float:
    unit = SLENDER.bending_stiffness / SLENDER.length**2
    return tip_deflection(SLENDER, [_unit_line(SLENDER, 1e-4 * unit)]) / 1e-4 / SLENDER.length


@check("structure/weight-tip", quantity="w EI / (rho g A L^4)", reference=1 / 8,
       source=_BENDING, tolerance=2.5e-4)  # fmt: skip
def _weight_tip() -> float:
    weight = SLENDER.density * 9.81 * SLENDER.height**2
    tip = tip_deflection(SLENDER, [Gravity((0.0, 9.81, 0.0))])
    return tip * SLENDER.bending_stiffness / (weight * SLENDER.length**4)


@check("structure/buoyancy", quantity="|water's force + rho V g| / (rho V g), box wet all around",
       reference=0.0, source="Archimedes", tolerance=1e-12)  # fmt: skip
def _buoyancy() -> float:
    gravity = np.array([1.0, -2.0, -9.0])
    return float(np.linalg.norm(box_buoyancy(gravity) + gravity) / np.linalg.norm(gravity))


# The last load step that is tried is 1/256 of the way.
@check("structure/limit-point-bar", quantity="part of 1.3 times the greatest load that is carried",
       reference=1 / 1.3, source="Saint-Venant-Kirchhoff bar: N = E A / (3 sqrt(3)) at most",
       tolerance=2 / 256)  # fmt: skip
def _limit_point() -> float:
    return crushed_bar(1.3)


for _force, _pivots in ((-2.4, 0), (-2.6, 2)):

    @check(f"structure/column-pivots{_force:g}",
           quantity=f"negative pivots of a square column at N L^2 / EI = {_force:g}",
           reference=_pivots, source="Euler: -pi^2/4 = -2.467, two directions",
           tolerance=0.0)  # fmt: skip
    def _column(force: float = _force) -> float:
        return float(column_pivots(force))
