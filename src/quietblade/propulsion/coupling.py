# SPDX-License-Identifier: LGPL-2.1-or-later
r"""Fixed point of flow and structure: the propulsion step (theory: S1-30).

The paper's iteration is ``u^0 = 0, p^k = F(u^{k-1}), u^k = S(p^k)``, ended when
``|u^k - u^{k-1}| / |u^{k-1}|`` falls below the tolerance.  Its first pass is the *chained*
computation: the load of the rigid blade, applied once.
"""

from dataclasses import dataclass
from time import perf_counter

import numpy as np

from quietblade.errors import Notice
from quietblade.flow.inflow import BladeFlow, Inflow, strip_loads
from quietblade.propulsion.newton import NewtonStep
from quietblade.propulsion.structure import EquilibriumError, Structure, StructureState
from quietblade.propulsion.transfer import LoadTransfer, SurfacePressure
from quietblade.typing import FloatArray, Progress, silent

_STAGE = "flow and structure"


@dataclass(frozen=True)
class CouplingStep:
    """One pass of the fixed point.

    Attributes
    ----------
    iteration : int
        k, from 1.
    change : float
        ``|u^k - u^{k-1}| / |u^{k-1}|`` over the nodes; infinite in the first pass.
    rate : float
        Change over the previous one, an estimate of the contraction; nan in the first two passes.
    tip : (3,) float array
        Displacement of the tip section's mid-chord point [m].
    lift : float
        Lift of F(u^{k-1}), the load of this pass [N].
    newton : tuple of NewtonStep
        Convergence table of the structural solution.
    seconds : float
        Wall time of the pass.
    """

    iteration: int
    change: float
    rate: float
    tip: FloatArray
    lift: float
    newton: tuple[NewtonStep, ...]
    seconds: float

    def __str__(self) -> str:
        return (
            f"iteration {self.iteration}: change {self.change:.2e}, rate {self.rate:.2f}, "
            f"tip y {self.tip[1] * 1e3:.2f} mm, lift {self.lift:.1f} N, "
            f"{len(self.newton)} Newton iterations"
        )


@dataclass(frozen=True, eq=False)
class StaticState:
    """Equilibrium of the blade under its own lift: the configuration C1.

    Attributes
    ----------
    structure : StructureState
        Displacement and film pressure unknowns.
    displacement : (n, 3) float array
        u1 at the nodes of the mesh [m].
    surface : SurfacePressure
        p1 on the wetted surface, with what the transfer conserves.
    rigid, chained, coupled : BladeFlow
        The flow about the undeformed blade, about the blade under the rigid blade's load, and
        about the blade in equilibrium.
    history : tuple of CouplingStep
        Passes of the fixed point.
    tolerance : float
        The wanted relative change.
    converged : bool
        Whether it was reached.
    notices : tuple of Notice
    """

    structure: StructureState
    displacement: FloatArray
    surface: SurfacePressure
    rigid: BladeFlow
    chained: BladeFlow
    coupled: BladeFlow
    history: tuple[CouplingStep, ...]
    tolerance: float
    converged: bool
    notices: tuple[Notice, ...] = ()

    @property
    def tip_displacement(self) -> FloatArray:
        """Displacement of the mid-chord point of the tip section, (3,) [m]."""
        return self.history[-1].tip


def solve_static(
    structure: Structure,
    transfer: LoadTransfer,
    inflow: Inflow,
    *,
    tolerance: float = 1e-5,
    max_iterations: int = 40,
    newton_tolerance: float = 1e-8,
    progress: Progress = silent,
) -> StaticState:
    """Find the deformed blade by the paper's fixed point.

    Parameters
    ----------
    structure : Structure
        The solver S.
    transfer : LoadTransfer
        Displacement to the sections, pressure to the structure.
    inflow : Inflow
        With the panel method, the solver F.
    tolerance : float
        Largest relative change of the displacement in the last pass.
    max_iterations : int
        Largest number of passes; beyond it the state is returned, marked as not converged.
    newton_tolerance : float
        Of each structural solution, see `Structure.solve`.
    progress : callable

    Returns
    -------
    StaticState

    Raises
    ------
    EquilibriumError
        The structure has no equilibrium under the first pass's load.
    GeometryError
        A deformed section cannot be solved by the flow.
    """

    def inner(_: str, __: float | None, message: str) -> None:
        progress(_STAGE, None, message)  # a fraction of a load step says nothing of the whole

    displacement = np.zeros_like(structure.basis.points)
    state, failure = structure.rest(), None
    flows = [_flow(transfer, inflow, displacement)]
    history: list[CouplingStep] = []
    for iteration in range(1, max_iterations + 1):
        start = perf_counter()
        flow = flows[-1]
        surface = transfer.pressure(flow.sections, flow.loads, displacement)
        try:
            state = structure.solve(
                surface.values, state, tolerance=newton_tolerance, progress=inner
            )
        except EquilibriumError as error:
            if iteration == 1:
                raise
            failure = error  # the last good state is the result, marked as not converged
            break
        moved = structure.values(state)
        flows.append(_flow(transfer, inflow, moved))
        change = _relative_change(moved, displacement)
        displacement = moved
        history.append(
            CouplingStep(
                iteration=iteration,
                change=change,
                rate=change / history[-1].change if iteration > 2 else np.nan,
                tip=flows[-1].sections.reference[-1] - flows[0].sections.reference[-1],
                lift=flow.total.lift,
                newton=state.newton,
                seconds=perf_counter() - start,
            )
        )
        progress(_STAGE, None, str(history[-1]))
        if change < tolerance:
            break
    converged = failure is None and history[-1].change < tolerance
    return StaticState(
        structure=state,
        displacement=displacement,
        surface=surface,
        rigid=flows[0],
        chained=flows[1],
        coupled=flows[-1],
        history=tuple(history),
        tolerance=tolerance,
        converged=converged,
        notices=() if converged else (_not_converged(history, tolerance, failure),),
    )


def _flow(transfer: LoadTransfer, inflow: Inflow, displacement: FloatArray) -> BladeFlow:
    return strip_loads(transfer.displaced_sections(displacement), inflow)


def _relative_change(new: FloatArray, old: FloatArray) -> float:
    size = float(np.linalg.norm(old))
    return float(np.linalg.norm(new - old)) / size if size > 0.0 else np.inf


def _not_converged(
    history: list[CouplingStep], tolerance: float, failure: EquilibriumError | None
) -> Notice:
    last = history[-1]
    why = f" ({failure})" if failure is not None else ""
    grows = last.rate > 1.0
    remedy = (
        "The change grows from pass to pass: the blade diverges, or the plain fixed point does. "
        "Lower the speed, or stiffen the blade"
        if grows
        else "Allow more passes"
    )
    return Notice(
        "flow and structure",
        f"not converged after {last.iteration} passes{why}; the last good state is kept",
        last.change,
        tolerance,
        remedy,
    )
