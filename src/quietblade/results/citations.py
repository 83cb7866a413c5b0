# SPDX-License-Identifier: LGPL-2.1-or-later
"""What to cite beside a result: the program, and the sources of the methods that it has used."""

from collections.abc import Callable
from dataclasses import dataclass

from quietblade.results.model import Result
from quietblade.results.table import Table

_Rule = Callable[[Result], bool]


@dataclass(frozen=True)
class Source:
    """A publication.

    Attributes
    ----------
    key : str
        Its key in ``docs/references.bib``.
    text : str
        Authors, title, year.
    reason : str
        What of it the result rests on.
    applies : callable
        Whether a result rests on it.
    """

    key: str
    text: str
    reason: str
    applies: _Rule


def _always(_result: Result) -> bool:
    return True


def _inflow(name: str) -> _Rule:
    return lambda result: result.static.performance.inflow.startswith(name)


def _coupling(name: str) -> _Rule:
    return lambda result: result.static.coupling_method == name


def _vibrates(result: Result) -> bool:
    return bool(result.configurations)


def _radiation(name: str) -> _Rule:
    return lambda result: any(
        c.radiation_condition.startswith(name) for c in result.configurations.values()
    )


SOURCES = (
    Source(
        "TwoStep",
        "Application of a two-step fluid-structure approach for the analysis of large deformations "
        "and linear vibrations of propeller blades with embedded viscoelastic material",
        "the method",
        _always,
    ),
    Source(
        "Drela1989",
        "Drela: XFOIL: an analysis and design system for low Reynolds number airfoils, 1989",
        "pressure of the sections",
        _always,
    ),
    Source(
        "Bonet2008",
        "Bonet, Wood: Nonlinear Continuum Mechanics for Finite Element Analysis, 2008",
        "large deformations",
        _always,
    ),
    Source(
        "Weissinger1947",
        "Weissinger: The Lift Distribution of Swept-Back Wings, 1947",
        "inflow lifting-line",
        _inflow("lifting-line"),
    ),
    Source(
        "Ning2014",
        "Ning: A simple solution method for the blade element momentum equations with guaranteed "
        "convergence, 2014",
        "inflow momentum",
        _inflow("momentum"),
    ),
    Source(
        "ITTC1957",
        "ITTC: Subjects 2 and 4: Skin friction and turbulence stimulation, 1957",
        "friction",
        lambda result: result.static.performance.friction.startswith("ittc"),
    ),
    Source(
        "Kuttler2008",
        "Küttler, Wall: Fixed-point fluid-structure interaction solvers with dynamic relaxation, "
        "2008",
        "coupling by Aitken's method",
        _coupling("aitken"),
    ),
    Source(
        "Anderson1965",
        "Anderson: Iterative procedures for nonlinear integral equations, 1965",
        "coupling by Anderson's method",
        _coupling("anderson"),
    ),
    Source(
        "Everstine1981",
        "Everstine: A symmetric potential formulation for fluid-structure interaction, 1981",
        "vibration in water",
        _vibrates,
    ),
    Source(
        "Allemang1982",
        "Allemang, Brown: A correlation coefficient for modal vector analysis, 1982",
        "matching of the modes",
        lambda result: len(result.configurations) > 1,
    ),
    Source(
        "Bayliss1982",
        "Bayliss, Gunzburger, Turkel: Boundary conditions for the numerical solution of elliptic "
        "equations in exterior regions, 1982",
        "condition on the sphere",
        _radiation("BGT"),
    ),
    Source(
        "Keller1989",
        "Keller, Givoli: Exact non-reflecting boundary conditions, 1989",
        "condition on the sphere",
        _radiation("DtN"),
    ),
    Source(
        "Junger1986",
        "Junger, Feit: Sound, Structures, and Their Interaction, 1986",
        "multipoles and far field",
        _vibrates,
    ),
)


def citation_table(result: Result) -> Table:
    """List the program, and what of `SOURCES` the result rests on."""
    program = f"quietblade {result.run.code_version}: flexible propeller blades in water"
    rows = [("the computation", program)]
    rows += [(source.reason, source.text) for source in SOURCES if source.applies(result)]
    note = "the documentation lists every source with the equation that takes it"
    return Table("What to cite", ("For", "Source"), tuple(rows), note)
