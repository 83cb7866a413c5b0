# SPDX-License-Identifier: LGPL-2.1-or-later
"""Coupling of flow and structure: the uniform bar in torsion, and the work of transferred loads."""

from functools import cache
from math import ceil, log

import numpy as np
from scipy.interpolate import BSpline, CubicSpline

from quietblade.flow.inflow import BladeFlow, StripInflow, strip_loads
from quietblade.geometry import Blade, NacaFourDigit, constant, table
from quietblade.mesh.surface import SurfaceQuadrature
from quietblade.propulsion.acceleration import FixedPoint, Method, Stop, solve_fixed_point
from quietblade.propulsion.divergence import divergence_ratio, southwell
from quietblade.propulsion.transfer import LoadTransfer, SurfacePressure
from quietblade.typing import FloatArray
from verification.flow_coupling_models import TorsionBar, bar_at, divergence_pressure
from verification.registry import check

METHODS: tuple[Method, ...] = ("fixed-point", "aitken", "anderson")
SHARES = (0.1, 0.3, 0.46, 0.6, 0.8, 0.95, 1.1, -0.5, -0.95, -1.2, -3.0)
"""Dynamic pressures over the divergence pressure of the table of iterations."""

_BISPLINGHOFF = "Bisplinghoff, Ashley and Halfman, Aeroelasticity (1955), chapter 8: closed form"


def solve_bar(
    bar: TorsionBar, method: Method, *, tolerance: float = 1e-5, stop: Stop = "change"
) -> FixedPoint:
    """Couple lift and twist of a bar, from the untwisted bar on."""
    start = np.zeros(bar.stations)
    return solve_fixed_point(bar.image, start, method=method, tolerance=tolerance, stop=stop)


def direct_twist(bar: TorsionBar) -> FloatArray:
    """Twist of the bar in stations with linear lift, by one linear solution [rad]."""
    zero = np.zeros(bar.stations)
    load = bar.image(zero)
    matrix = np.array([bar.image(column) - load for column in np.eye(bar.stations)]).T
    return np.asarray(np.linalg.solve(np.eye(bar.stations) - matrix, load))


def plain_passes(rate: float, tolerance: float) -> int:
    """Count the passes of the plain fixed point until the relative change falls below a tolerance.

    With one mode of eigenvalue ``rate``, the change of pass n is
    ``rate^(n-1) (1 - rate) / (1 - rate^(n-1))``.
    """
    return 1 + ceil(log(tolerance / (1.0 - rate + tolerance)) / log(rate))


def iteration_table(softening: float = 0.5, limit: int = 200) -> dict[float, dict[str, int | None]]:
    """Count the passes of each method at each share; None: not converged in ``limit``."""
    counts: dict[float, dict[str, int | None]] = {}
    for share in SHARES:
        bar = bar_at(share, softening=softening)
        runs = {method: solve_bar(bar, method) for method in METHODS}
        counts[share] = {
            m: len(run.history) if run.converged and len(run.history) <= limit else None
            for m, run in runs.items()
        }
    return counts


FINE = TorsionBar(stiffness=850.0, arm=0.04, chord=0.25, length=1.2, pressure=6.0e3, stations=400)


# Finite differences with 400 stations err by (pi / 800)^2 / 12 = 1.3e-6.
@check(
    "flow/divergence-torsion-bar",
    quantity="divergence pressure from the pairs of Anderson's iteration at 0.26 of it [Pa]",
    reference=divergence_pressure(850.0, 0.04, 0.25, 2.0 * np.pi, 1.2),
    source="(pi/2)^2 GJ / (e c a0 l^2), " + _BISPLINGHOFF,
    tolerance=0.05,
)
def bar_divergence() -> float:
    """Scale the dynamic pressure by the eigenvalue that the iteration shows."""
    run = solve_bar(FINE, "anderson", tolerance=1e-10)
    return FINE.pressure * divergence_ratio(np.array([run.eigenvalue]))


# The higher modes, whose divergence pressures are 9 and 25 times higher, bend Southwell's line.
@check(
    "flow/divergence-southwell",
    quantity="divergence pressure from the twists at 0.7, 0.8 and 0.9 of it, relative",
    reference=1.0,
    source="Southwell's plot of a bar with one mode",
    tolerance=2e-3,
)
def bar_southwell() -> float:
    """Draw the line through three deflections."""
    shares = np.array([0.7, 0.8, 0.9])
    tips = np.array([bar_at(s, stations=400).exact_twist()[-1] for s in shares])
    return southwell(shares, tips)


# The twist of the bar in stations differs from the closed form by a relative 1e-6 or so; the
# iteration's own error is 1e-10.
@check(
    "flow/coupling-bar-twist",
    quantity="tip twist of the coupled bar at 0.26 of the divergence pressure [rad]",
    reference=float(FINE.exact_twist()[-1]),
    source="alpha0 (1 / cos(lambda l) - 1), " + _BISPLINGHOFF,
    tolerance=2e-7,
)
def bar_twist() -> float:
    """Couple with Aitken's factor."""
    return float(solve_bar(FINE, "aitken", tolerance=1e-10, stop="error").x[-1])


# A count: no tolerance.
@check(
    "flow/coupling-plain-passes",
    quantity="passes of the plain fixed point at 0.46 of the divergence pressure, to 1e-5",
    reference=plain_passes(0.46, 1e-5),
    source="geometric series of the dominant mode; the paper reports fewer than 15 passes",
    tolerance=0.0,
)
def plain_count() -> float:
    """Count."""
    return len(solve_bar(bar_at(0.46), "fixed-point").history)


# The stop is at an estimated error of 1e-6.
@check(
    "flow/coupling-anderson-wash-out",
    quantity="error of Anderson's solution where the plain fixed point grows threefold a pass",
    reference=0.0,
    source="direct solution of the linear bar at -3 times the divergence pressure",
    tolerance=2e-6,
)
def wash_out_error() -> float:
    """Compare with a linear solution."""
    bar = bar_at(-3.0)
    run = solve_bar(bar, "anderson", tolerance=1e-6, stop="error")
    exact = direct_twist(bar)
    return float(np.linalg.norm(run.x - exact) / np.linalg.norm(exact))


# One mode is left after 168 passes.
@check(
    "flow/coupling-error-estimate",
    quantity="estimated over true error where the change of the last pass is 20 times too small",
    reference=1.0,
    source="plain fixed point at 0.95 of the divergence pressure against the direct solution",
    tolerance=1e-3,
)
def error_estimate() -> float:
    """Stop by the change and compare the estimate of the error."""
    bar = bar_at(0.95)
    run, exact = solve_bar(bar, "fixed-point"), direct_twist(bar)
    true = float(np.linalg.norm(run.x - exact) / np.linalg.norm(exact))
    return run.history[-1].error / true


# -- load transfer ---------------------------------------------------------------------------


def tapered_blade(taper: float = 0.3) -> Blade:
    """Return a straight blade of 1 m, 250 mm at its root."""
    return Blade(
        hub_radius=0.2,
        span=1.0,
        chord=table(np.array([0.0, 1.0]), np.array([0.25, 0.25 * taper])),
        blade_angle=constant(0.1),
        sweep=constant(0.0),
        rake=constant(0.0),
        thickness=constant(0.08),
        camber=constant(0.02),
        family=NacaFourDigit(),
        trailing_edge=0.006,
        alignment=0.5,
        film=None,
    )


def side_surface(blade: Blade, along: int = 16, around: int = 16) -> SurfaceQuadrature:
    """Both sides and the trailing-edge face of a blade in six-node triangles (no tip face)."""
    nodes = blade.section(np.linspace(0.0, 1.0, 2 * along + 1), 2 * around + 1)
    edge = np.stack([nodes[:, -1], 0.5 * (nodes[:, 0] + nodes[:, -1]), nodes[:, 0]], axis=1)
    points = np.concatenate([_triangles(nodes), _triangles(edge)]).reshape(-1, 3)
    rounded = np.round(points, 10)
    _, first, number = np.unique(rounded, axis=0, return_index=True, return_inverse=True)
    return SurfaceQuadrature(points[first], number.reshape(-1, 6))


def _triangles(grid: FloatArray) -> FloatArray:
    """Two six-node triangles for each 3 x 3 patch of a grid of nodes (2 I + 1, 2 J + 1, 3)."""
    i, j = np.meshgrid(
        np.arange(0, grid.shape[0] - 2, 2), np.arange(0, grid.shape[1] - 2, 2), indexing="ij"
    )
    halves = (
        [(0, 0), (2, 0), (2, 2), (1, 0), (2, 1), (1, 1)],
        [(0, 0), (2, 2), (0, 2), (1, 1), (1, 2), (0, 1)],
    )
    return np.concatenate(
        [
            np.stack([grid[i + a, j + b] for a, b in half], axis=2).reshape(-1, 6, 3)
            for half in halves
        ]
    )


def span_weights(s: FloatArray, count: int) -> FloatArray:
    """Cubic B-splines on equal parts of the span, which sum to 1, (points, count)."""
    inner = np.linspace(0.0, 1.0, count - 2)
    knots = np.concatenate([np.zeros(3), inner, np.ones(3)])
    return np.asarray(BSpline.design_matrix(np.clip(s, 0.0, 1.0), knots, 3).toarray())


def work_of_pressure(
    surface: SurfaceQuadrature, points: FloatArray, pressure: FloatArray, motion: FloatArray
) -> float:
    """Work of a nodal pressure on small motions (n, 12, 3) of the quadrature points [J]."""
    force = -surface.positions(pressure)[..., None] * surface.area_vectors(points)
    return float(np.sum(force * motion))


def work_of_sections(flow: BladeFlow, translation: FloatArray, rotation: FloatArray) -> float:
    """Work of the sections' loads on motions of their reference points and turns (M, 3) [J]."""
    power = np.sum(flow.loads.force * translation + flow.loads.moment * rotation, axis=1)
    length = flow.sections.arc_length
    return float(CubicSpline(length, power).integrate(length[0], length[-1]))


@cache
def transferred() -> tuple[LoadTransfer, BladeFlow, SurfacePressure]:
    """Transfer the loads of the straight blade."""
    blade, s = tapered_blade(), np.linspace(0.0, 1.0, 101)
    room = LoadTransfer(side_surface(blade), blade, s, blade.section(s, 81), weights=12)
    flow = strip_loads(room.sections, StripInflow(5.0, 0.58))
    return room, flow, room.pressure(flow.sections, flow.loads, np.zeros_like(room.surface.points))


def work_ratio(seed: int = 1, weights: int = 12) -> float:
    """Work of the transferred pressure over that of the sections, for a section-wise rigid motion.

    Sections move across the span and turn about it, by random amounts between which the weight
    functions interpolate.
    """
    room, flow, result = transferred()
    random = np.random.default_rng(seed)
    across, turn = random.normal(size=(weights, 2)), random.normal(size=weights)
    points = room.surface.positions(room.surface.points)
    blade = tapered_blade()
    w = span_weights(blade.locate(points.reshape(-1, 3))[0], weights)
    motion = _motion(w @ across, w @ turn, points.reshape(-1, 3)).reshape(points.shape)
    w = span_weights(room.s, weights)
    reference = flow.sections.reference
    ours = work_of_pressure(room.surface, room.surface.points, result.values, motion)
    theirs = work_of_sections(
        flow,
        _motion(w @ across, w @ turn, reference),
        (w @ turn)[:, None] * np.array([0.0, 0.0, 1.0]),
    )
    return ours / theirs


def _motion(across: FloatArray, turn: FloatArray, points: FloatArray) -> FloatArray:
    x, y, _ = points.T
    return np.stack([across[:, 0] - turn * y, across[:, 1] + turn * x, 0.0 * x], axis=1)


# The balance is met to round-off; the sections' integral here is of the spline of the power, there
# of the product of splines: 1e-6 with 101 sections.
@check(
    "flow/transfer-work",
    quantity="work of the transferred pressure over the work of the sections' loads",
    reference=1.0,
    source="virtual work of random section-wise rigid motions between 12 weight functions",
    tolerance=2e-6,
)
def transfer_work() -> float:
    """Worst of five random motions."""
    ratios = [work_ratio(seed) for seed in range(1, 6)]
    return float(max(ratios, key=lambda r: abs(r - 1.0)))


# Rounding of the sums.
@check(
    "flow/transfer-force",
    quantity="force error across the span over the force, straight tapered blade",
    reference=0.0,
    source="conservation",
    tolerance=1e-13,
)
def transfer_force() -> float:
    """Compare the pressure's force with the sections'."""
    _, flow, result = transferred()
    return float(np.linalg.norm(result.force_error[:2]) / np.linalg.norm(flow.total.force))


# What the 12 weights do not resolve of the bending moment, and the arm of the pull along the span.
@check(
    "flow/transfer-moment",
    quantity="moment error about the origin over the moment, straight tapered blade",
    reference=0.0,
    source="conservation",
    tolerance=3e-3,
)
def transfer_moment() -> float:
    """Compare the pressure's moment with the sections'."""
    _, flow, result = transferred()
    return float(np.linalg.norm(result.moment_error) / np.linalg.norm(flow.total.moment))
