# SPDX-License-Identifier: LGPL-2.1-or-later
"""The boundary layer against exact solutions of the laminar equations, and against XFOIL.

References
----------
Schlichting, Gersten, Boundary-Layer Theory (2017), chapters 7, 8 and 18; Howarth, Proc. Royal
Society A 164 (1938) 547. Tables of XFOIL: ``tests/data/xfoil``.
"""

import csv
from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_bvp

from quietblade.flow.boundary_layer import Layer, march_layer
from quietblade.flow.polar import Polar, section_polar
from tools.make_xfoil_tables import naca
from verification.flow_xfoil import FOLDER
from verification.registry import check

Array = NDArray[np.float64]
XFOIL = "XFOIL 6.99, free transition, N = 9, the same nodes"


def wedge_flow(m: float) -> tuple[float, float, float]:
    """Falkner and Skan's layer under the speed u = x^m.

    Returns
    -------
    tuple of float
        Momentum thickness and displacement thickness times sqrt(u / (nu x)), and H.
    """

    def slope(_: Array, f: Array) -> Array:
        return np.stack([f[1], f[2], -0.5 * (m + 1.0) * f[0] * f[2] - m * (1.0 - f[1] ** 2)])

    def ends(wall: Array, far: Array) -> Array:
        return np.array([wall[0], wall[1], far[1] - 1.0])

    eta = np.linspace(0.0, 10.0, 201)
    guess = np.stack([eta - 1.0 + np.exp(-eta), 1.0 - np.exp(-eta), np.exp(-eta)])
    layer = solve_bvp(slope, ends, eta, guess, tol=1e-8, max_nodes=20000)
    speed = layer.y[1]
    theta = float(np.trapezoid(speed * (1.0 - speed), layer.x))
    displacement = float(np.trapezoid(1.0 - speed, layer.x))
    return theta, displacement, displacement / theta


def power_law_layer(m: float, reynolds: float = 1e6, stations: int = 400) -> Layer:
    """March a laminar layer under u = x^m over the unit length."""
    arc = np.linspace(0.0, 1.0, stations)[None] ** 2
    with np.errstate(divide="ignore"):
        speed, gradient = arc**m, m * np.maximum(arc, 1e-12) ** (m - 1.0)
    return march_layer(arc, speed, gradient, reynolds, n_crit=1e9)


for _m, _name in ((0.0, "blasius"), (1.0 / 3.0, "wedge"), (1.0, "hiemenz")):

    def enter(m: float, name: str) -> None:
        """Register thickness and shape of one similar layer."""
        theta, _, shape = wedge_flow(m)

        # The relations between the integrals are fits to such layers, good to 1 %.
        @check(
            f"flow/layer-{name}-theta",
            quantity=f"momentum thickness * sqrt(u / (nu x)) under u = x^{m:.3g}",
            reference=theta,
            source="Falkner and Skan's equation, solved here",
            tolerance=0.01 * theta,
        )
        def thickness() -> float:
            return float(power_law_layer(m).momentum_thickness[0, -1] * 1e3)

        @check(
            f"flow/layer-{name}-shape",
            quantity=f"shape factor under u = x^{m:.3g}",
            reference=shape,
            source="Falkner and Skan's equation, solved here",
            tolerance=0.015 * shape,
        )
        def shape_factor() -> float:
            return float(power_law_layer(m).shape[0, -1])

    enter(_m, _name)


@check(
    "flow/layer-howarth-separation",
    quantity="laminar separation under u = 1 - x",
    reference=0.1199,
    source="Howarth (1938), numerical solution",
    tolerance=0.006,  # 5 %: Thwaites' method gives 0.123
)
def howarth() -> float:
    """March to separation."""
    arc = 0.3 * np.linspace(0.0, 1.0, 400)[None] ** 2
    layer = march_layer(arc, 1.0 - arc, -np.ones_like(arc), 1e6, n_crit=1e9)
    return float(layer.laminar_separation[0])


@check(
    "flow/layer-plate-friction",
    quantity="friction coefficient of a turbulent plate at Re = 1e7",
    reference=0.00293,
    source="Schoenherr's line",
    tolerance=1.5e-4,  # 5 %: friction lines differ by 3 % among themselves
)
def plate() -> float:
    """Twice the momentum thickness at the end of a plate that is turbulent from its first 0.1 %."""
    arc = np.linspace(0.0, 1.0, 400)[None] ** 2
    layer = march_layer(arc, np.ones_like(arc), np.zeros_like(arc), 1e7, trip=1e-3)
    return float(2.0 * layer.momentum_thickness[0, -1])


@cache
def xfoil_layer() -> tuple[Array, Layer]:
    """XFOIL's layer on NACA 0012, and ours under its edge speed."""
    from scipy.interpolate import CubicSpline  # noqa: PLC0415

    table = np.loadtxt(FOLDER / "layer-naca0012.csv", delimiter=",", skiprows=1)[::-1]
    # The speed falls to 0 at the stagnation point, which lies between the last nodes.
    origin = table[0, 0] + table[0, 2] * (table[0, 0] - table[1, 0]) / (table[1, 2] - table[0, 2])
    place = np.concatenate([[0.0], origin - table[:, 0]])
    speed = CubicSpline(place, np.concatenate([[0.0], table[:, 2]]))
    arc = place[-1] * np.linspace(0.0, 1.0, 400) ** 2
    layer = march_layer(arc[None], speed(arc)[None], speed(arc, 1)[None], 1e6)
    return np.column_stack([place[1:], table[:, 1:]]), layer


@check(
    "flow/layer-own-speed-transition",
    quantity="transition of NACA 0012 at Re = 1e6 under XFOIL's own edge speed (x/c)",
    reference=0.6868,
    source=XFOIL,
    tolerance=0.01,  # no interaction left: relations alike, steps different
)
def own_transition() -> float:
    """Chord fraction of transition."""
    table, layer = xfoil_layer()
    return float(np.interp(layer.transition[0], table[:, 0], table[:, 1]))


@check(
    "flow/layer-own-speed-theta",
    quantity="momentum thickness at x/c = 0.5 over XFOIL's, under its own edge speed",
    reference=1.0,
    source=XFOIL,
    tolerance=0.01,
)
def own_thickness() -> float:
    """Ratio of the laminar momentum thickness."""
    table, layer = xfoil_layer()
    place = float(np.interp(0.5, table[:, 1], table[:, 0]))
    ours = np.interp(place, layer.arc[0], layer.momentum_thickness[0])
    return float(ours / np.interp(place, table[:, 0], table[:, 3]))


@cache
def viscous_rows() -> dict[tuple[str, float], Array]:
    """XFOIL's polars by section and Reynolds number.

    Columns: incidence [rad], C_L, C_D, C_M, transition on the upper and on the lower side.
    """
    found: dict[tuple[str, float], list[list[float]]] = {}
    with (FOLDER / "viscous.csv").open(encoding="utf-8", newline="") as file:
        for name, reynolds, alpha, *rest in list(csv.reader(file))[1:]:
            row = [np.radians(float(alpha)), *map(float, rest)]
            found.setdefault((name[4:], float(reynolds)), []).append(row)
    return {key: np.array(rows) for key, rows in found.items()}


@cache
def our_polar(section: str, reynolds: float) -> Polar:
    """Our polar at XFOIL's incidences."""
    return section_polar(naca(section, "sharp"), viscous_rows()[section, reynolds][:, 0], reynolds)


def drag_ratios(section: str) -> Array:
    """Our drag over XFOIL's, at all Reynolds numbers and incidences of the table."""
    return np.concatenate(
        [
            our_polar(name, reynolds).drag_coefficient / rows[:, 2]
            for (name, reynolds), rows in viscous_rows().items()
            if name == section
        ]
    )


def transition_errors(reynolds: float) -> Array:
    """Our transition less XFOIL's (x/c), both sides of all sections at one Reynolds number."""
    errors = []
    for (name, number), rows in viscous_rows().items():
        if number == reynolds:
            polar = our_polar(name, number)
            errors += [polar.transition_upper - rows[:, 4], polar.transition_lower - rows[:, 5]]
    return np.concatenate(errors)


for _section in ("0006", "0009", "0012", "2412"):

    def enter_drag(section: str) -> None:
        """Register the drag of one section."""
        where = f"NACA {section}, Re = 4e5 to 3e6, 0 to {'4' if section == '0006' else '6'} deg"

        # One way: the inviscid speed is up to 1 % above that with the layer's displacement.
        @check(
            f"flow/layer-drag-{section}",
            quantity=f"worst C_D over XFOIL's, {where}",
            reference=1.0,
            source=XFOIL,
            tolerance=0.15,
        )
        def worst() -> float:
            ratios = drag_ratios(section)
            return float(ratios[np.argmax(np.abs(ratios - 1.0))])

        @check(
            f"flow/layer-mean-drag-{section}",
            quantity=f"mean C_D over XFOIL's, {where}",
            reference=1.0,
            source=XFOIL,
            tolerance=0.07,
        )
        def mean() -> float:
            return float(drag_ratios(section).mean())

    enter_drag(_section)


# Where the layer is thick against the section, its displacement moves transition downstream.
for _reynolds, _tolerance in ((4e5, 0.14), (1e6, 0.10), (3e6, 0.07)):

    def enter_transition(reynolds: float, tolerance: float) -> None:
        """Register the transition at one Reynolds number."""

        @check(
            f"flow/layer-transition-{reynolds:.0e}".replace("+0", ""),
            quantity=f"worst error of the transition (x/c), four sections at Re = {reynolds:g}",
            reference=0.0,
            source=XFOIL,
            tolerance=tolerance,
        )
        def worst() -> float:
            return float(np.abs(transition_errors(reynolds)).max())

    enter_transition(_reynolds, _tolerance)


def stall_incidence(section: str, reynolds: float, step: float = 0.25) -> float:
    """First incidence [deg] at which a section counts as stalled."""
    alpha = np.arange(4.0, 22.0, step)
    stalled = section_polar(naca(section, "sharp"), np.radians(alpha), reynolds).stalled
    return float(alpha[np.argmax(stalled)]) if stalled.any() else np.inf


@check(
    "flow/layer-stall",
    quantity="worst error of the stall incidence, NACA 0006, 0009, 0012 at three Re [deg]",
    reference=0.0,
    source="XFOIL 6.99, greatest lift; the limits were adjusted to these nine",
    tolerance=1.0,
    quick=False,
)
def stall() -> float:
    """Over the table of greatest lift."""
    with (FOLDER / "stall-reynolds.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    errors = [
        stall_incidence(row["section"][4:], float(row["reynolds"])) - float(row["alpha_deg"])
        for row in rows
    ]
    return float(np.abs(errors).max())
