# SPDX-License-Identifier: LGPL-2.1-or-later
"""Section families against published ordinates, and mean lines against thin-section theory.

References
----------
Abbott, von Doenhoff, Theory of Wing Sections (1959), chapter 4 and appendices I and II.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from quietblade.flow import PanelSections
from quietblade.geometry import NacaSixteen, NacaSixtySix, section_family
from quietblade.geometry.mean_lines import DesignLoad, FiveDigitLine
from verification.registry import check

Array = NDArray[np.float64]
TABLES = "Abbott, von Doenhoff (1959)"

# NACA 16-009, in % of the chord
NACA_16_009 = np.array(
    [
        [1.25, 0.969], [2.5, 1.354], [5.0, 1.882], [7.5, 2.274], [10.0, 2.593], [15.0, 3.101],
        [20.0, 3.498], [30.0, 4.063], [40.0, 4.391], [50.0, 4.500], [60.0, 4.376], [70.0, 3.952],
        [80.0, 3.149], [90.0, 1.888], [95.0, 1.061], [100.0, 0.090],
    ]
)  # fmt: skip

# Brockett, DTMB Report 1780 (1966): half thickness / largest thickness of NACA 66 (DTMB modified)
NACA_66_MODIFIED = np.array(
    [
        [0.0125, 0.1044], [0.05, 0.2066], [0.10, 0.2907], [0.20, 0.4000], [0.30, 0.4637],
        [0.40, 0.4952], [0.45, 0.5000], [0.50, 0.4962], [0.60, 0.4653], [0.70, 0.4035],
        [0.80, 0.3110], [0.90, 0.1877], [0.95, 0.1143], [1.0, 0.0333],
    ]
)  # fmt: skip

# Mean line a = 0.8 at the ideal lift coefficient 1, in % of the chord
MEAN_LINE_08 = np.array(
    [
        [0.5, 0.287], [1.25, 0.616], [2.5, 1.077], [5.0, 1.841], [10.0, 3.043], [20.0, 4.748],
        [30.0, 5.863], [40.0, 6.528], [50.0, 6.790], [60.0, 6.644], [70.0, 6.037], [80.0, 4.771],
        [90.0, 2.435], [95.0, 1.163], [100.0, 0.0],
    ]
)  # fmt: skip


@dataclass(frozen=True)
class ThinSection:
    """What thin-section theory says of a mean line; angles in rad."""

    ideal_incidence: float
    ideal_lift: float
    zero_lift_incidence: float
    moment: float


def thin_section(height: Callable[[Array], Array], points: int = 4001) -> ThinSection:
    """Glauert's integrals over a mean line, given by its height at chord fractions.

    With x = (1 - cos t) / 2, the coefficients A_n = (2 / pi) int (dy/dx) cos(n t) dt of the slope
    are integrated by parts, so that slopes that are infinite at the ends do no harm.

    Parameters
    ----------
    height : callable
        Height / chord at chord fractions (P,); 0 at both ends.
    points : int
        Of the quadrature.

    Returns
    -------
    ThinSection
        The moment is that about the quarter chord.
    """
    # Midpoints, because dy/dx dt = dy / (sin(t) / 2) is not defined at the ends.
    t = (np.arange(points) + 0.5) * np.pi / points
    edge = np.linspace(0.0, np.pi, points + 1)
    slope = np.diff(height(0.5 * (1.0 - np.cos(edge)))) / np.diff(0.5 * (1.0 - np.cos(edge)))
    zero, one, two = (
        (2.0 if n else 1.0) / points * float(np.sum(slope * np.cos(n * t))) for n in range(3)
    )
    return ThinSection(
        ideal_incidence=zero,
        ideal_lift=np.pi * one,
        zero_lift_incidence=zero - 0.5 * one,
        moment=-0.25 * np.pi * (one - two),
    )


def design_load_moment(a: float) -> float:
    """Moment about the quarter chord of the mean line ``a`` at the ideal lift coefficient 1."""
    tail = 0.5 * (1.0 - a) if a == 1.0 else (1.0 / 6.0 - a**2 / 2.0 + a**3 / 3.0) / (1.0 - a)
    return 0.25 - 2.0 / (1.0 + a) * (0.5 * a**2 + tail)


def ordinate_error(table: Array, computed: Callable[[Array], Array]) -> float:
    """Largest difference from a table of places and ordinates."""
    return float(np.abs(computed(table[:, 0]) - table[:, 1]).max())


@check(
    "flow/naca-16-ordinates",
    quantity="largest difference of the half thickness of NACA 16-009 (% of the chord)",
    reference=0.0,
    source=f"{TABLES}, appendix I",
    tolerance=5.5e-4,  # half the last digit printed
)
def naca_16() -> float:
    """Half thickness with the family's own edge."""
    own_edge = 0.02 * 0.09
    return ordinate_error(
        NACA_16_009,
        lambda x: 100.0 * NacaSixteen().half_thickness(x / 100.0, 0.09, own_edge),
    )


@check(
    "flow/naca-66-ordinates",
    quantity="largest difference of the half thickness / thickness of NACA 66 (DTMB modified)",
    reference=0.0,
    source="Brockett, DTMB Report 1780 (1966)",
    tolerance=1e-12,  # the spline goes through the table
)
def naca_66() -> float:
    """Half thickness with the family's own edge."""
    return ordinate_error(
        NACA_66_MODIFIED, lambda x: NacaSixtySix().half_thickness(x, 1.0, 2.0 * 0.0333)
    )


@check(
    "flow/naca-66-nose",
    quantity="nose radius / (chord * thickness^2) of NACA 66 (DTMB modified)",
    reference=0.448,
    source="Brockett, DTMB Report 1780 (1966)",
    tolerance=2e-3,  # follows from ordinates of four decimals
)
def naca_66_nose() -> float:
    """Limit of y^2 / (2 x)."""
    y = NacaSixtySix().half_thickness(1e-8, 1.0, 0.0666)
    return float(y**2 / 2e-8)


@check(
    "flow/mean-line-08-ordinates",
    quantity="largest difference of the mean line a = 0.8 at ideal lift 1 (% of the chord)",
    reference=0.0,
    source=f"{TABLES}, appendix II",
    tolerance=5.5e-4,  # half the last digit printed
)
def mean_line() -> float:
    """Heights of the formula."""
    line = DesignLoad(0.8)
    return ordinate_error(MEAN_LINE_08, lambda x: 100.0 * line.at_unit_lift(x / 100.0)[0])


@check(
    "flow/mean-line-08-incidence",
    quantity="ideal incidence of the mean line a = 0.8 at ideal lift 1 [deg]",
    reference=1.54,
    source=f"{TABLES}, appendix II",
    tolerance=5e-3,  # half the last digit printed
)
def incidence() -> float:
    """Evaluate the closed form."""
    return float(np.degrees(DesignLoad(0.8).ideal_incidence))


for _a in (0.5, 0.8, 1.0):

    def enter(a: float) -> None:
        """Register the integrals of one mean line."""
        line = DesignLoad(a)

        # The midpoint rule converges slowly at the logarithms of the ends.
        @check(
            f"flow/mean-line-{10 * a:02.0f}-lift",
            quantity=f"ideal lift coefficient of the mean line a = {a:g} made for 1",
            reference=1.0,
            source="Glauert's integral over its heights",
            tolerance=1e-3,
        )
        def lift() -> float:
            return thin_section(lambda x: line.at_unit_lift(x)[0]).ideal_lift

        @check(
            f"flow/mean-line-{10 * a:02.0f}-moment",
            quantity=f"moment about the quarter chord, mean line a = {a:g} at ideal lift 1",
            reference=design_load_moment(a),
            source="integral of the load that defines the line",
            tolerance=1e-3,
        )
        def moment() -> float:
            return thin_section(lambda x: line.at_unit_lift(x)[0]).moment

    enter(_a)


@check(
    "flow/five-digit-design-lift",
    quantity="ideal lift coefficient of the NACA mean line 230",
    reference=0.3,
    source="NACA Report 537 (1935)",
    tolerance=2e-3,  # published constants have four digits
)
def five_digit() -> float:
    """Thin-section theory of the published line."""
    line = FiveDigitLine(3)
    return thin_section(lambda x: line.camber_at_design_lift * line.unit(x)[0]).ideal_lift


@check(
    "flow/five-digit-reflex-moment",
    quantity="moment about the quarter chord of the NACA mean line 231",
    reference=0.0,
    source="NACA Report 537 (1935): made to have none",
    tolerance=2e-3,  # published constants have three digits; the straight line has -0.013
)
def reflexed() -> float:
    """Thin-section theory of the published line."""
    line = FiveDigitLine(3, reflexed=True)
    return thin_section(lambda x: line.camber_at_design_lift * line.unit(x)[0]).moment


def panel_over_thin(family: str, thickness: float, camber: float, nodes: int) -> tuple[float, ...]:
    """Zero-lift incidence [rad] and moment of a thin section by the panel method."""
    contour = section_family(family).contour(thickness, camber, 0.0, nodes)
    solution = PanelSections(contour[None]).solve(np.radians([[-1.0], [0.0]]))
    low, high = solution.lift[:, 0]
    zero = np.radians(-1.0) - low * np.radians(1.0) / (high - low)
    at_zero = PanelSections(contour[None]).solve(zero).moment.item()
    return float(zero), float(at_zero)


# Thickness changes the flow about the camber by its own order: 2 % thick, 4 % is left.
for _index, _name in enumerate(("zero-lift incidence [rad]", "moment at no lift")):

    def enter_panel(index: int, name: str) -> None:
        """Register a figure of a thin section on the line a = 0.8."""
        camber = 0.02
        line = DesignLoad(0.8)
        theory = thin_section(lambda x: camber * line.unit(x)[0])
        reference = (theory.zero_lift_incidence, theory.moment)[index]

        @check(
            f"flow/thin-66-{('zero-lift', 'moment')[index]}",
            quantity=f"{name}, NACA 66, a = 0.8, camber 2 %, thickness 2 %",
            reference=reference,
            source="thin-section theory",
            tolerance=0.04 * abs(reference),
        )
        def panel() -> float:
            return panel_over_thin("naca-66-a08", 0.02, camber, 321)[index]

    enter_panel(_index, _name)
