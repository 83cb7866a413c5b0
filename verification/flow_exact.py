# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sections with exact plane potential flow: images of the circle.

References
----------
L. M. Milne-Thomson, Theoretical Hydrodynamics, 5th ed., Macmillan 1968, chapters 6 and 7
(ellipse, Joukowski and Karman-Trefftz transformations).
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from quietblade.flow import PanelSections, PanelSolution
from quietblade.flow.contours import contour_loads
from verification.registry import check

Complex = NDArray[np.complex128]
ALPHA = np.radians(4.0)


@dataclass(frozen=True)
class CircleImage:
    """A section as the image of a circle, with the exact flow on it.

    Attributes
    ----------
    contour : array (N, 2)
        Nodes in units of the chord from the trailing edge over the upper side and back.
    cp : array (N,)
        Exact pressure coefficient at the nodes.
    lift : float
        Exact lift coefficient.
    stagnation : array (2,)
        Exact place of the stagnation point at the nose.
    """

    contour: NDArray[np.float64]
    cp: NDArray[np.float64]
    lift: float
    stagnation: NDArray[np.float64]


def circle_image(
    centre: complex,
    mapping: Callable[[Complex], Complex],
    slope: Callable[[Complex], Complex],
    alpha: float,
    nodes: int,
    rear: float = 1.0,
) -> CircleImage:
    """Flow at incidence ``alpha`` that leaves the image of the circle at the point ``rear``.

    The Kutta condition fixes the circulation 4 pi R sin(alpha + beta), clockwise positive, where
    -beta is the polar angle of ``rear`` seen from the centre.
    """
    radius, beta = abs(rear - centre), -np.angle(rear - centre)
    turn = np.exp(1j * (np.linspace(0.0, 2.0 * np.pi, nodes) - beta))
    zeta = centre + radius * turn
    circulation = 4.0 * np.pi * radius * np.sin(alpha + beta)
    velocity = np.exp(-1j * alpha) - np.exp(1j * alpha) / turn**2
    velocity += 1j * circulation / (2.0 * np.pi * radius * turn)
    z = mapping(zeta)
    chord = z.real.max() - z.real.min()
    with np.errstate(divide="ignore", invalid="ignore"):  # 0 / 0 at the edge itself
        cp = 1.0 - np.abs(velocity / slope(zeta)) ** 2
    scaled = (z - z.real.min()) / chord
    scaled[-1] = scaled[0]
    contour = np.stack([scaled.real, scaled.imag], axis=-1)
    at_rest = mapping(np.array(centre + radius * np.exp(1j * (np.pi + 2.0 * alpha + beta))))
    place = (at_rest - z.real.min()) / chord
    stagnation = np.array([place.real, place.imag])
    return CircleImage(contour, cp, 2.0 * circulation / chord, stagnation)


def ellipse(thickness: float, alpha: float, nodes: int) -> CircleImage:
    """Ellipse with the rear stagnation point held at the end of its long axis."""
    c = (1.0 - thickness) / (1.0 + thickness)
    return circle_image(
        0.0, lambda zeta: zeta + c / zeta, lambda zeta: 1.0 - c / zeta**2, alpha, nodes
    )


def karman_trefftz(centre: complex, wedge: float, alpha: float, nodes: int) -> CircleImage:
    """Section with the edge angle ``wedge`` [rad]; 0 gives the cusp of Joukowski's section."""
    n = 2.0 - wedge / np.pi

    def mapping(zeta: Complex) -> Complex:
        plus, minus = (zeta + 1.0) ** n, (zeta - 1.0) ** n
        image: Complex = n * (plus + minus) / (plus - minus)
        return image

    def slope(zeta: Complex) -> Complex:
        plus, minus = (zeta + 1.0) ** n, (zeta - 1.0) ** n
        derivative: Complex = 4.0 * n**2 * plus * minus / ((zeta**2 - 1.0) * (plus - minus) ** 2)
        return derivative

    return circle_image(centre, mapping, slope, alpha, nodes)


SECTIONS: dict[str, Callable[[int], CircleImage]] = {
    "ellipse": lambda nodes: ellipse(0.2, ALPHA, nodes),
    "joukowski": lambda nodes: karman_trefftz(-0.08 + 0.08j, 0.0, ALPHA, nodes),
    "karman-trefftz": lambda nodes: karman_trefftz(-0.08 + 0.08j, np.radians(10.0), ALPHA, nodes),
}
SOURCE = "Milne-Thomson (1968), conformal transformation of the circle"


@cache
def solved(name: str, nodes: int) -> tuple[CircleImage, PanelSolution]:
    """Exact and panel solutions."""
    exact = SECTIONS[name](nodes)
    return exact, PanelSections(exact.contour[None]).solve(ALPHA)


def stagnation_error(name: str, nodes: int) -> float:
    """Distance of the panel method's stagnation point from the exact one, in chords."""
    exact, panel = solved(name, nodes)
    found = PanelSections(exact.contour[None]).stagnation_points(panel)[0]
    return float(np.linalg.norm(found - exact.stagnation))


def moment_error(name: str, nodes: int) -> float:
    """Error of the moment coefficient about the quarter chord, against the exact pressure."""
    fine = SECTIONS[name](8001)
    pressure = np.where(np.isfinite(fine.cp), fine.cp, np.roll(fine.cp, 1))
    pressure[0] = pressure[1]
    _, exact = contour_loads(fine.contour[None], pressure[None], np.array([0.25, 0.0]))
    return float(solved(name, nodes)[1].moment[0] + exact[0])


def pressure_error(name: str, nodes: int) -> float:
    """Largest error of Cp, without the edge, where the mapping is singular."""
    exact, panel = solved(name, nodes)
    ahead = exact.contour[:, 0] < 0.98
    return float(np.abs(panel.cp[0] - exact.cp)[ahead].max())


def enter(name: str, cp_error: float) -> None:
    """Register the rows of one section."""
    where = f"{name} section at 4 deg"

    # The largest error sits in the suction peak at the nose and falls with the square of the
    # panel length (row -order), so it is bounded here at the usual number of nodes.
    @check(
        f"flow/{name}-cp",
        quantity=f"largest error of Cp, {where}, 161 nodes",
        reference=0.0,
        source=SOURCE,
        tolerance=cp_error,
    )
    def error() -> float:
        return pressure_error(name, 161)

    # Asymptotic order, seen between two finite numbers of nodes: 0.1 is left for that.
    @check(
        f"flow/{name}-order",
        quantity=f"order of convergence of Cp, {where}, 161 to 321 nodes",
        reference=2.0,
        source="linear vortex strength on straight panels: second order",
        tolerance=0.1,
    )
    def order() -> float:
        return float(np.log2(pressure_error(name, 161) / pressure_error(name, 321)))

    # Second order as well: 2.7e-4 at 161 nodes on the worst of the three, 7e-5 at 321.
    @check(
        f"flow/{name}-lift",
        quantity=f"C_L over the exact one, {where}, 321 nodes",
        reference=1.0,
        source=SOURCE,
        tolerance=1e-4,
    )
    def lift() -> float:
        exact, panel = solved(name, 321)
        return float(panel.lift[0] / exact.lift)

    # Linear between nodes on a contour with a curvature: a hundredth of a panel's length.
    @check(
        f"flow/{name}-stagnation",
        quantity=f"distance of the stagnation point from the exact one / chord, {where}, 161 nodes",
        reference=0.0,
        source=SOURCE,
        tolerance=2e-4,
    )
    def stagnation() -> float:
        return stagnation_error(name, 161)

    # Second order, like the lift.
    @check(
        f"flow/{name}-moment",
        quantity=f"error of C_M about the quarter chord, {where}, 321 nodes",
        reference=0.0,
        source=f"{SOURCE}; its pressure integrated on 8001 nodes",
        tolerance=2e-4,
    )
    def moment() -> float:
        return moment_error(name, 321)


enter("ellipse", 0.02)
enter("joukowski", 0.03)
enter("karman-trefftz", 0.03)
