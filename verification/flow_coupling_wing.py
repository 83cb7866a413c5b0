# SPDX-License-Identifier: LGPL-2.1-or-later
"""A small solid wing in finite elements, whose sweep makes it diverge or wash out."""

from functools import cache

import numpy as np

from quietblade.flow.inflow import StripInflow
from quietblade.geometry import Blade, NacaFourDigit, constant, formula
from quietblade.materials import IsotropicSVK
from quietblade.mesh import MeshSpec, Patch, build_mesh
from quietblade.mesh.surface import SurfaceQuadrature
from quietblade.propulsion.coupling import Method, StaticState, solve_static
from quietblade.propulsion.divergence import Divergence, divergence_pressure
from quietblade.propulsion.structure import Structure
from quietblade.propulsion.transfer import LoadTransfer
from verification.registry import check

SPEED = 6.0


def plastic_wing(
    sweep: float,
    *,
    modulus: float = 1e9,
    poisson_ratio: float = 0.0,
    incidence: float = 0.0175,
    span: float = 0.6,
    chord: float = 0.2,
    size: float = 0.1,
    stations: int = 21,
) -> tuple[Structure, LoadTransfer]:
    """Build a solid wing of constant chord, NACA 0010, clamped at its root.

    Parameters
    ----------
    sweep : float
        Of the tip, positive downstream [m].
    modulus, poisson_ratio : float
        Of the material [Pa], density 1000 kg/m3.
    incidence : float
        To the axis [rad].
    span, chord, size : float
        Of the wing, and element size [m].
    stations : int
        Sections of the flow.

    Returns
    -------
    Structure, LoadTransfer
    """
    blade = Blade(
        hub_radius=0.2,
        span=span,
        chord=constant(chord),
        blade_angle=constant(incidence),
        sweep=formula(f"{sweep}*s", 1.0),
        rake=constant(0.0),
        thickness=constant(0.1),
        camber=constant(0.0),
        family=NacaFourDigit(),
        trailing_edge=0.02,
        alignment=0.5,
        film=None,
    )
    centre = 0.2 + 0.5 * span
    patch = Patch(1, (0.8, 0.96), (0.3, 0.7))
    mesh = build_mesh(blade, MeshSpec(size, (0.0, 0.0, centre), 1.5 * span, (patch,), 0.8 * span))
    plastic = IsotropicSVK("plastic", 1000.0, modulus, poisson_ratio)
    structure = Structure(mesh.fem, {"blade": plastic}, basis=mesh.basis)
    surface = SurfaceQuadrature(mesh.nodes, mesh.interface)
    s = np.linspace(0.0, 1.0, stations)
    return structure, LoadTransfer(surface, blade, s, blade.section(s, 61), weights=8)


@cache
def wing(sweep: float) -> tuple[Structure, LoadTransfer]:
    """Build a wing once."""
    return plastic_wing(sweep)


@cache
def at_rest(sweep: float) -> Divergence:
    """Compute the eigenvalues at the undeformed wing at 6 m/s."""
    return divergence_pressure(*wing(sweep), StripInflow(SPEED, 0.0))


@cache
def coupled(sweep: float, share: float, method: Method) -> StaticState:
    """Couple at a share of the magnitude-one eigenvalue's pressure."""
    eigenvalue = abs(at_rest(sweep).eigenvalues[0])
    speed = SPEED * (share / eigenvalue) ** 0.5
    return solve_static(
        *wing(sweep), StripInflow(speed, 0.0), method=method, chained=False, tolerance=1e-7
    )


def distance(sweep: float, share: float, one: Method, other: Method) -> float:
    """Distance of two methods' displacements, relative."""
    a, b = coupled(sweep, share, one).displacement, coupled(sweep, share, other).displacement
    return float(np.linalg.norm(a - b) / np.linalg.norm(b))


# At half of the divergence pressure the wing has bent by 3 % of its span, which alters the
# eigenvalue by a few parts in a thousand.
@check(
    "flow/coupling-wing-rate",
    quantity="contraction rate of the plain fixed point of a swept-forward wing",
    reference=0.5,
    source="half of the divergence pressure by Arnoldi's eigenvalues at rest",
    tolerance=5e-3,
    quick=False,
)
def wing_rate() -> float:
    """Observe the ratio of successive changes."""
    return coupled(-0.4, 0.5, "fixed-point").history[-2].rate


# Both are stopped at an error of 1e-7, the plain one at such a change.
@check(
    "flow/coupling-wing-newton",
    quantity="load update in Newton's iteration against the plain fixed point, relative distance",
    reference=0.0,
    source="the same equations, swept-forward wing at half of its divergence pressure",
    tolerance=3e-7,
    quick=False,
)
def wing_newton() -> float:
    """Compare displacements."""
    return distance(-0.4, 0.5, "newton", "fixed-point")


# Each is right to 1e-7 times what a pass amplifies.
@check(
    "flow/coupling-wing-wash-out",
    quantity="Newton against Anderson where the plain fixed point grows 5 times a pass",
    reference=0.0,
    source="the same equations, swept-back wing",
    tolerance=1e-6,
    quick=False,
)
def wing_wash_out() -> float:
    """Compare displacements."""
    return distance(0.4, 5.0, "newton", "anderson")
