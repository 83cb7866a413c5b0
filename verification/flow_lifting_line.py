# SPDX-License-Identifier: LGPL-2.1-or-later
"""The lifting line against closed forms and against Glauert's Fourier series.

`planar_wing` computes a flat wing of any planform with the vortices of
`quietblade.flow.lifting_line`; `glauert_wing` and `glauert_blade` are an independent solution of
Prandtl's equation by its sine series.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from quietblade.flow import LiftingLineInflow, PanelSections, VortexLine, integrate
from quietblade.flow.lifting_line import Control, Root, line_parameter, solve_circulation
from quietblade.flow.loads import circulation_response
from verification.flow_strip import POLYNOMIAL_EDGE, ROTATION, SPEED, flow
from verification.registry import check

Array = NDArray[np.float64]
Chord = Callable[[Array], Array]
"""Chord over mean chord at fractions of the half span, 0 in the middle, 1 at the tips."""

PRANDTL = "Prandtl's lifting-line equation by Glauert's sine series (Glauert 1926), 100 terms"
SECTION = 2.0 * np.pi


def elliptic(fraction: Array) -> Array:
    """Elliptic planform."""
    return 4.0 / np.pi * np.sqrt(1.0 - fraction**2)


def trapezoid(taper: float) -> Chord:
    """Trapezoid with tip chord over root chord ``taper``."""
    return lambda fraction: 2.0 * (1.0 - (1.0 - taper) * fraction) / (1.0 + taper)


@dataclass(frozen=True)
class Wing:
    """Wing in a uniform stream at small incidence.

    Attributes
    ----------
    slope : float
        C_L per radian.
    drag_factor : float
        ``C_Di pi AR / C_L^2``, from the downwash at the control points.
    spread : float
        Relative spread of the downwash along the span.
    """

    slope: float
    drag_factor: float
    spread: float


def planar_wing(
    chord: Chord,
    aspect_ratio: float,
    *,
    sweep: float = 0.0,
    section_slope: float = SECTION,
    control: Control = "prandtl",
    root: Root = "free",
    elements: int = 100,
) -> Wing:
    """Flat wing of mean chord 1; its quarter-chord line is swept by ``sweep`` [rad].

    With ``root="mirrored"`` half of the wing is computed, the aspect ratio is that of the whole.
    """
    span = aspect_ratio if root == "free" else 0.5 * aspect_ratio
    vertices, centres = (span * part for part in line_parameter(elements, root))
    middle = 0.5 * span if root == "free" else 0.0

    def line(z: Array) -> Array:
        return np.stack([np.tan(sweep) * np.abs(z - middle), 0.0 * z, z], axis=-1)

    c = chord(np.abs(centres - middle) * 2.0 / aspect_ratio)
    x = np.array([1.0, 0.0, 0.0])
    behind = 0.5 if control == "weissinger" else 0.0
    ends = line(vertices)
    share = ((centres - vertices[:-1]) / np.diff(vertices))[:, None]
    vortex = VortexLine(
        vertices=ends,
        centres=(1.0 - share) * ends[:-1] + share * ends[1:],
        offset=behind * c[:, None] * x,
        wake=np.broadcast_to(x, (elements + 1, 3)),
        mirror=(ends[0], np.array([0.0, 0.0, 1.0])) if root == "mirrored" else None,
    )
    # the chord along the stream; with sweep the section normal to the line is shorter by cos,
    # its stream slower by cos, and the incidence larger by 1 / cos
    response = 0.5 * section_slope * np.cos(sweep) * c[:, None] * np.array([0.0, 1.0, 0.0])
    gamma, induced = solve_circulation(vortex.influence(), response, response[:, 1])
    width = np.diff(vertices)
    lift, drag = gamma @ width, -(gamma * induced[:, 1]) @ width
    slope = 2.0 * lift / span
    drag_factor = 2.0 * drag / span * np.pi * aspect_ratio / slope**2
    return Wing(float(slope), float(drag_factor), float(np.ptp(induced[:, 1]) / -induced[0, 1]))


def glauert_series(
    chord: Callable[[Array], Array], wash: Callable[[Array], Array], span: float, terms: int
) -> tuple[Array, Array]:
    """Circulation B of ``sum B_n sin(n theta)`` on the span ``z = span (1 - cos theta) / 2``.

    Collocation of ``Gamma = m(z) (v(z) - w(z))`` with ``m`` = ``chord`` (half the section's slope
    times its chord) and ``v`` = ``wash``, the normal velocity of the undisturbed stream; the
    downwash of the series is ``w = sum n B_n sin(n theta) / (2 span sin theta)``. Returns theta
    and the circulation there.
    """
    theta = (np.arange(terms) + 0.5) * np.pi / terms
    z = 0.5 * span * (1.0 - np.cos(theta))
    n = np.arange(1, terms + 1)
    sine = np.sin(np.outer(theta, n))
    m = chord(z)[:, None]
    matrix = sine * (1.0 + m * n / (2.0 * span * np.sin(theta)[:, None]))
    factors = np.linalg.solve(matrix, m[:, 0] * wash(z))
    return theta, sine @ factors


def glauert_wing(
    chord: Chord, aspect_ratio: float, section_slope: float = SECTION, terms: int = 100
) -> float:
    """Slope C_L per radian of a wing without sweep and twist, mean chord 1."""
    theta, gamma = glauert_series(
        lambda z: 0.5 * section_slope * chord(np.abs(2.0 * z / aspect_ratio - 1.0)),
        np.ones_like,
        aspect_ratio,
        terms,
    )
    return float(2.0 * np.sum(gamma * np.sin(theta)) * 0.5 * np.pi / terms)


def glauert_blade(root: Root, section_slope: float, terms: int = 200) -> float:
    """Lift of the paper's rigid blade over that of its strips, normal velocity omega z."""
    span = 1.0 if root == "free" else 2.0

    def from_root(z: Array) -> Array:
        return z if root == "free" else np.abs(z - 1.0)

    def half_slope(z: Array) -> Array:
        return 0.5 * section_slope * (0.25 - 0.175 * from_root(z))

    def wash(z: Array) -> Array:
        return ROTATION * (0.2 + from_root(z))

    theta, gamma = glauert_series(half_slope, wash, span, terms)
    z = 0.5 * span * (1.0 - np.cos(theta))
    speed = np.hypot(SPEED, wash(z))
    weight = np.sin(theta) * speed
    return float(np.sum(gamma * weight) / np.sum(half_slope(z) * wash(z) * weight))


# The discrete downwash is smaller by (2 N / pi) sin(pi / 2 N): 4e-5 of itself for 100 elements.
@check(
    "flow/lifting-line-elliptic-slope",
    quantity="C_L per 2 pi rad of an elliptic wing of aspect ratio 6",
    reference=6.0 / 8.0,
    source="AR / (AR + 2), exact for Prandtl's equation",
    tolerance=1e-4,
)
def elliptic_slope() -> float:
    """Flat-plate sections."""
    return planar_wing(elliptic, 6.0).slope / SECTION


# The spacing by cosines keeps the property of the integral exactly; rounding is left.
@check(
    "flow/lifting-line-elliptic-downwash",
    quantity="relative spread of the downwash along an elliptic wing",
    reference=0.0,
    source="constant downwash of elliptic circulation (Prandtl)",
    tolerance=1e-9,
)
def elliptic_downwash() -> float:
    """Solved, not prescribed circulation."""
    return planar_wing(elliptic, 6.0).spread


# Twice the discretisation error of the slope.
@check(
    "flow/lifting-line-elliptic-drag",
    quantity="C_Di pi AR / C_L^2 of an elliptic wing of aspect ratio 6",
    reference=1.0,
    source="C_Di = C_L^2 / (pi AR), exact for Prandtl's equation",
    tolerance=2e-4,
)
def elliptic_drag() -> float:
    """Lift tilted by the downwash."""
    return planar_wing(elliptic, 6.0).drag_factor


def _trapezoid_row(name: str, slope: float) -> None:
    """Half foil of Zarruk et al. (2014) on a wall: aspect ratio 2 x 300 / 90, taper 0.5."""

    # The series and the vortices both err by some 1e-4 of the slope at the kink in the middle.
    @check(
        f"flow/lifting-line-zarruk{name}",
        quantity=f"C_L per rad of the mirrored trapezoid AR 6.67, taper 0.5, a0 = {slope:.4g}",
        reference=glauert_wing(trapezoid(0.5), 20.0 / 3.0, slope),
        source=PRANDTL,
        tolerance=3e-3,
    )
    def row() -> float:
        return planar_wing(trapezoid(0.5), 20.0 / 3.0, section_slope=slope, root="mirrored").slope


_trapezoid_row("", SECTION)
_trapezoid_row("-thick", 6.6)


def lift_ratio(root: Root, control: Control = "prandtl", edge: float = POLYNOMIAL_EDGE) -> float:
    """Lift of the paper's rigid blade with a lifting line over its strip lift."""
    strip = flow(edge, 161)
    panels = PanelSections(strip.sections.contours)
    model = LiftingLineInflow(SPEED, ROTATION, root=root, control=control)
    return integrate(strip.sections, model.loads(strip.sections, panels)).lift / strip.total.lift


def section_slope() -> float:
    """Lift slope of the blade's sections by the panel method, per radian."""
    sections = flow(POLYNOMIAL_EDGE, 161).sections
    response = circulation_response(sections, PanelSections(sections.contours))
    return float(2.0 * np.linalg.norm(response[0]) / sections.chord[0])


# 0.754 and 0.854 for the series. The deformed-blade code has the exact wake directions and loses
# up to 1e-3 of the lift where a spline through 101 sections meets the tip.
for _root in ("free", "mirrored"):
    check(
        f"flow/lifting-line-paper-{_root}",
        quantity=f"lift of the paper's rigid blade over its strip lift, root {_root}",
        reference=glauert_blade(_root, section_slope()),  # type: ignore[arg-type]
        source=PRANDTL,
        tolerance=3e-3,
    )(lambda root=_root: lift_ratio(root))


# The matrix of the reversed wing is the transpose only for one element; the forms converge to
# equal lift.
@check(
    "flow/lifting-line-reverse-flow",
    quantity="slope of a wing swept back by 30 deg over that swept forward, three-quarter points",
    reference=1.0,
    source="reverse-flow theorem of linear wing theory (von Karman 1935, Munk 1950)",
    tolerance=1e-3,
)
def reverse_flow() -> float:
    """Aspect ratio 8, rectangular."""
    back, forward = (
        planar_wing(
            np.ones_like, 8.0, sweep=sign * np.radians(30.0), control="weissinger", elements=200
        )
        for sign in (1.0, -1.0)
    )
    return back.slope / forward.slope


# One vortex along the chord cannot be exact; Weissinger's points give the limit within a few
# per cent, Prandtl's a slope that is too high by a factor of 2.
@check(
    "flow/lifting-line-slender",
    quantity="slope over pi AR / 2 of an elliptic wing of aspect ratio 0.2, three-quarter points",
    reference=1.0,
    source="slender-wing theory (Jones, NACA Report 835, 1946)",
    tolerance=0.03,
)
def slender() -> float:
    """Limit of small aspect ratio."""
    return planar_wing(elliptic, 0.2, control="weissinger", elements=40).slope / (0.1 * np.pi)
