# SPDX-License-Identifier: LGPL-2.1-or-later
"""The solvers F (flow) and S (structure) of the coupling, and what they exchange (theory: S1-3)."""

from dataclasses import dataclass, fields, replace
from typing import Any, Literal

import numpy as np
from scipy.interpolate import CubicSpline

from quietblade.errors import GeometryError, SolverError
from quietblade.flow.inflow import BladeFlow, Inflow
from quietblade.flow.loads import SectionLoads, integrate
from quietblade.flow.sections import DeformedSections, section_frames
from quietblade.propulsion.loading import Loading
from quietblade.propulsion.newton import NewtonStep
from quietblade.propulsion.structure import EquilibriumError, Structure, StructureState
from quietblade.propulsion.transfer import LoadTransfer, SurfacePressure
from quietblade.typing import FloatArray, IntArray

Method = Literal["newton", "fixed-point", "aitken", "anderson"]

FAILURES = (EquilibriumError, GeometryError, SolverError)
"""What a coupled iteration may meet on its way without the program being wrong."""


@dataclass(frozen=True)
class CouplingStep:
    """One pass of the coupling; of the method "newton": one correction.

    Attributes
    ----------
    iteration : int
        From 1, over all fractions.
    change : float
        Change of the displacement over the nodes relative to its size; infinite from rest.
    rate : float
        Change over the previous one; nan in the first pass at a fraction.
    tip : (3,) float array
        Displacement of the tip section's mid-chord point after the pass [m].
    lift : float
        Lift of the load of this pass [N], of the whole dynamic pressure.
    newton : tuple of NewtonStep
        Convergence table of the structural solution.
    seconds : float
        Wall time of the pass.
    fraction : float
        Fraction of the dynamic pressure.
    error : float
        Estimated distance of the displacement to the coupled solution, relative to its size
        (theory: S1-93); infinite in the first pass at a fraction.
    eigenvalue : complex
        Dominant eigenvalue of a pass of flow and structure, linearised, as far as the steps show
        it (theory: S1-92); nan before there are two.
    """

    iteration: int
    change: float
    rate: float
    tip: FloatArray
    lift: float
    newton: tuple[NewtonStep, ...]
    seconds: float
    fraction: float = 1.0
    error: float = np.inf
    eigenvalue: complex = complex(np.nan)

    @property
    def factorizations(self) -> int:
        """Tangents factorised in this pass."""
        return sum(line.new_tangent for line in self.newton)

    def __str__(self) -> str:
        load = "" if self.fraction == 1.0 else f" at {self.fraction:.3g} of the pressure"
        return (
            f"iteration {self.iteration}{load}: change {self.change:.2e}, "
            f"error {self.error:.1e}, rate {self.rate:.2f}, "
            f"tip y {self.tip[1] * 1e3:.2f} mm, lift {self.lift:.1f} N, "
            f"{len(self.newton)} Newton iterations"
        )


@dataclass(frozen=True, eq=False)
class Point:
    """An equilibrium of the structure on the way.

    Attributes
    ----------
    state : StructureState
    displacement : (n, 3) float array
        At the nodes [m].
    surface : SurfacePressure or None
        The whole pressure of the flow, of which a fraction loads the structure; None at rest.
    """

    state: StructureState
    displacement: FloatArray
    surface: SurfacePressure | None = None

    @property
    def pressed(self) -> SurfacePressure:
        """The surface's pressure.

        Raises
        ------
        ValueError
            The point is at rest.
        """
        if self.surface is None:
            raise ValueError("the blade at rest has no pressure")
        return self.surface


@dataclass(frozen=True, eq=False)
class Stage:
    """Outcome of a coupled solution at one fraction of the dynamic pressure.

    Attributes
    ----------
    point : Point or None
        The solution; if the passes are used up, or a later one failed, the pass with the smallest
        change; None if there is no equilibrium of the structure to keep.
    history : tuple of CouplingStep
    converged : bool
    reason : str
        Why it did not converge.
    second : BladeFlow or None
        The flow of the second pass, which is the chained one if the first began at rest.
    """

    point: Point | None
    history: tuple[CouplingStep, ...]
    converged: bool
    reason: str = ""
    second: BladeFlow | None = None


@dataclass(frozen=True)
class Limits:
    """When to stop.

    Attributes
    ----------
    tolerance : float
        Of the displacement, relative.
    stop : str
        "error" or "change": what the tolerance is for.
    max_iterations : int
        Passes at one fraction.
    newton_tolerance : float
        Of the structural solutions.
    depth : int
        Differences that accelerations and estimates remember.
    """

    tolerance: float
    stop: str
    max_iterations: int
    newton_tolerance: float
    depth: int

    def done(self, change: float, error: float) -> bool:
        """Whether a pass was the last one."""
        return (change if self.stop == "change" else error) < self.tolerance


class CoupledBlade:
    """Flow and structure of a blade.

    Parameters
    ----------
    structure : Structure
    transfer : LoadTransfer
    inflow : Inflow
    extra : tuple of (nodes,) and (displacement unknowns,) arrays, or None
        Pressure [Pa] and dead load [N] beside the flow's, which do not grow with the dynamic
        pressure.

    Attributes
    ----------
    solved_sections : int
        Sections whose flow was solved so far, each time they were.
    """

    def __init__(
        self,
        structure: Structure,
        transfer: LoadTransfer,
        inflow: Inflow,
        extra: tuple[FloatArray, FloatArray] | None = None,
    ) -> None:
        self.structure, self.transfer, self.inflow = structure, transfer, inflow
        nodes, n = len(structure.basis.points), structure.forms.n_displacement
        self.solved_sections = 0
        self._last: tuple[FloatArray, BladeFlow] | None = None
        self.still, self.dead_load = extra or (np.zeros(nodes), np.zeros(n))
        if self.still.shape != (nodes,) or self.dead_load.shape != (n,):
            raise ValueError(
                f"extra has to be a pressure of {nodes} nodes and a dead load of {n} unknowns, got "
                f"shapes {self.still.shape} and {self.dead_load.shape}"
            )

    def rest(self) -> Point:
        """Return the undeformed blade without load."""
        return Point(self.structure.rest(), np.zeros_like(self.structure.basis.points))

    def flow(self, displacement: FloatArray, *, every: int = 1) -> BladeFlow:
        """Solve the flow about the displaced blade.

        Parameters
        ----------
        displacement : ndarray, shape (n, 3)
            At the nodes [m].
        every : int
            Solve the flow of each so many sections only, and of the last, and interpolate the
            loads of the others by cubic splines of the arc length.

        Returns
        -------
        BladeFlow
        """
        if every == 1 and self._last is not None and np.array_equal(displacement, self._last[0]):
            return self._last[1]
        sections = section_frames(self.transfer.displaced_sections(displacement))
        chosen = np.unique([*range(0, len(sections.chord), every), len(sections.chord) - 1])
        self.solved_sections += len(chosen)
        loads = self.inflow.loads(_rows(sections, chosen))
        if every > 1:
            loads = _interpolated(loads, sections.arc_length[chosen], sections.arc_length)
        flow = BladeFlow(sections, loads, integrate(sections, loads))
        if every == 1:
            self._last = displacement, flow
        return flow

    def values(self, x: FloatArray) -> FloatArray:
        """Displacement at the nodes (n, 3) of the structure's unknowns."""
        nothing = Loading(self.still, self.dead_load, 0.0)
        return self.structure.values(self.state(x, nothing))

    def state(self, x: FloatArray, loading: Loading) -> StructureState:
        """Name the structure's unknowns and loads."""
        n = self.structure.forms.n_displacement
        return StructureState(x[:n], x[n:], loading)

    def surface(self, flow: BladeFlow, displacement: FloatArray) -> SurfacePressure:
        """Transfer the pressure of the flow to the surface."""
        return self.transfer.pressure(flow.sections, flow.loads, displacement)

    def pressure(self, surface: SurfacePressure, fraction: float) -> FloatArray:
        """Nodal pressure [Pa] of a fraction of the flow's, with the extra one."""
        return fraction * surface.values + self.still

    def loading(self, surface: SurfacePressure, fraction: float) -> Loading:
        """All loads of the structure."""
        return Loading(
            self.pressure(surface, fraction), self.dead_load, self.structure.spin.omega**2
        )

    def tip(self, displacement: FloatArray) -> FloatArray:
        """Displacement of the mid-chord point of the tip section, (3,) [m]."""

        def middle(section: FloatArray) -> FloatArray:
            edge = 0.5 * (section[0] + section[-1])
            return np.asarray(0.5 * (edge + section[len(section) // 2]))

        moved = self.transfer.displaced_sections(displacement)[-1]
        return middle(moved) - middle(self.transfer.sections[-1])


def _rows(sections: DeformedSections, chosen: IntArray) -> DeformedSections:
    """Choose some of the sections."""
    names = (f.name for f in fields(sections))
    return replace(sections, **{name: getattr(sections, name)[chosen] for name in names})


def _interpolated(loads: SectionLoads, known: FloatArray, wanted: FloatArray) -> SectionLoads:
    """Interpolate loads to other arc lengths."""
    arrays: dict[str, Any] = {f.name: getattr(loads, f.name) for f in fields(loads)}
    for name, values in arrays.items():
        if isinstance(values, np.ndarray):
            arrays[name] = CubicSpline(known, values)(wanted)
    return SectionLoads(**arrays)
