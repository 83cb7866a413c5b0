# SPDX-License-Identifier: LGPL-2.1-or-later
r"""Flow and structure in equilibrium: the propulsion step (theory: S1-30).

The paper's iteration is ``u^0 = 0, p^k = F(u^{k-1}), u^k = S(p^k)``, ended when
``|u^k - u^{k-1}| / |u^{k-1}|`` falls below the tolerance.  Its first pass is the *chained*
computation: the load of the rigid blade, applied once. It is here by the name "fixed-point";
"aitken" and "anderson" accelerate it, and "newton", the default, updates the load in every
correction of the structure.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import get_args

import numpy as np

from quietblade.card import Card, Shown
from quietblade.errors import Notice
from quietblade.flow.inflow import BladeFlow, Inflow
from quietblade.propulsion import acceleration
from quietblade.propulsion.coupling_problem import CoupledBlade, CouplingStep, Limits, Method
from quietblade.propulsion.coupling_ramp import Ramp
from quietblade.propulsion.divergence import (
    Kind,
    classify,
    divergence_pressure,
    divergence_ratio,
    suspicious,
)
from quietblade.propulsion.structure import Structure, StructureState
from quietblade.propulsion.transfer import LoadTransfer, SurfacePressure
from quietblade.typing import FloatArray, Progress, silent

__all__ = ["CouplingStep", "Method", "StaticState", "Stop", "solve_static"]

Stop = acceleration.Stop

# Divergence pressure over dynamic pressure below which a notice is given.
_NEAR = 1.5

_WHERE = "flow and structure"

_MEANING: dict[Kind, str] = {
    "wash-out": "the lift falls with bending and twist so much that a plain fixed point would "
    "diverge; this is no static divergence, and the equilibrium is sound",
    "divergence": "the equilibrium is unstable: the lift that deformation adds outruns the "
    "stiffness (static divergence)",
    "post-divergence": "the blade has diverged: the undeformed blade is beyond its divergence "
    "pressure, and only softening lift or stiffening deformation holds it",
}

_REMEDY: dict[Kind, str] = {
    "steady": "Allow more passes",
    "unresolved": "Allow more passes, ramp the dynamic pressure, or use the method 'anderson'",
    "wash-out": "Use the method 'newton' or 'anderson'; the equilibrium exists",
    "divergence": "Lower the speed, stiffen the blade in torsion, or move the elastic axis forward",
    "post-divergence": "Lower the speed or stiffen the blade; check the sections for stall",
}


@dataclass(frozen=True, eq=False, repr=False)
class StaticState(Shown):
    """Equilibrium of the blade under its own lift: the configuration C1.

    Attributes
    ----------
    structure : StructureState
        Displacement and film pressure unknowns.
    displacement : (n, 3) float array
        u1 at the nodes of the mesh [m].
    surface : SurfacePressure
        p1 on the wetted surface, with what the transfer conserves.
    rigid, coupled : BladeFlow
        The flow about the undeformed blade, and about the blade in equilibrium.
    chained_flow : BladeFlow or None
        The flow about the blade under the rigid blade's load, if it was asked for and exists.
    history : tuple of CouplingStep
        Passes of the coupling.
    tolerance : float
        The wanted relative change or error.
    converged : bool
        Whether it was reached, at the whole dynamic pressure.
    notices : tuple of Notice
    method, stop : str
        As given to `solve_static`.
    fraction : float
        Fraction of the dynamic pressure that the state is for: below 1 if the rest of the way to
        1 has failed, so that this is the last good state.
    kind : str
        What the coupling is like, see `quietblade.propulsion.divergence.classify`.
    flows : float
        Solutions of the flow, counted in those of all sections.
    """

    structure: StructureState
    displacement: FloatArray
    surface: SurfacePressure
    rigid: BladeFlow
    chained_flow: BladeFlow | None
    coupled: BladeFlow
    history: tuple[CouplingStep, ...]
    tolerance: float
    converged: bool
    notices: tuple[Notice, ...] = ()
    method: str = "fixed-point"
    stop: str = "change"
    fraction: float = 1.0
    kind: Kind = "steady"
    flows: float = 0.0

    def card(self) -> Card:
        """Tip, lift, and how the coupling ended."""
        along = ", ".join(f"{1e3 * u:.2f}" for u in self.tip_displacement)
        end = "converged" if self.converged else "NOT CONVERGED"
        rows = (
            ("tip displacement x, y, z", f"{along} mm"),
            ("lift, rigid blade", f"{self.rigid.total.lift:.5g} N"),
            ("lift, in equilibrium", f"{self.coupled.total.lift:.5g} N"),
            ("coupling", f"{end} in {len(self.history)} passes, {self.method}; {self.kind}"),
            ("fraction of the dynamic pressure", f"{self.fraction:g}"),
            ("notices", f"{len(self.notices)}"),
        )
        return Card("Static state: blade in equilibrium with the flow", rows)

    @property
    def chained(self) -> BladeFlow:
        """The flow about the blade under the rigid blade's load.

        Raises
        ------
        ValueError
            It was not asked for, or the blade has no equilibrium there (see the notices).
        """
        if self.chained_flow is None:
            raise ValueError(
                "there is no chained computation: it was left out (use solve_static(chained=True)) "
                "or has no equilibrium"
            )
        return self.chained_flow

    @property
    def tip_displacement(self) -> FloatArray:
        """Displacement of the mid-chord point of the tip section, (3,) [m]."""
        sections = self.coupled.sections.reference[-1] - self.rigid.sections.reference[-1]
        return np.asarray(sections)

    @property
    def eigenvalue(self) -> complex:
        """Dominant eigenvalue of a pass of flow and structure, as the history shows it."""
        known = [s.eigenvalue for s in self.history if np.isfinite(s.eigenvalue)]
        return known[-1] if known else complex(np.nan)

    @property
    def rate(self) -> float:
        """Contraction rate of the plain fixed point at the solution: the eigenvalue's size."""
        return abs(self.eigenvalue)

    @property
    def error(self) -> float:
        """Estimated distance to the coupled solution, relative to the displacement."""
        return self.history[-1].error

    @property
    def factorizations(self) -> int:
        """Tangents factorised."""
        return sum(step.factorizations for step in self.history)

    @property
    def divergence(self) -> float:
        """Estimated divergence pressure over the dynamic pressure; infinite if none is in sight.

        From the dominant eigenvalue at the last fraction; `divergence_pressure` computes it
        better.
        """
        return divergence_ratio(np.array([self.eigenvalue]), self.history[-1].fraction)


def solve_static(
    structure: Structure,
    transfer: LoadTransfer,
    inflow: Inflow,
    *,
    method: Method = "newton",
    tolerance: float = 1e-5,
    stop: Stop | None = None,
    max_iterations: int = 40,
    newton_tolerance: float = 1e-8,
    depth: int = 5,
    ramp: Sequence[float] = (1.0,),
    chained: bool = True,
    extra: tuple[FloatArray, FloatArray] | None = None,
    progress: Progress = silent,
) -> StaticState:
    """Find the deformed blade under its own lift.

    Parameters
    ----------
    structure : Structure
        The solver S.
    transfer : LoadTransfer
        Displacement to the sections, pressure to the structure.
    inflow : Inflow
        With the panel method, the solver F.
    method : {"newton", "fixed-point", "aitken", "anderson"}
        "fixed-point" is the paper's.
    tolerance : float
        Of the displacement, relative.
    stop : {"error", "change"} or None
        What the tolerance is for: the estimated true error, or the change of the last pass as in
        the paper. Default: the change for "fixed-point", otherwise the error.
    max_iterations : int
        Largest number of passes at a fraction of the pressure; beyond it the state is returned,
        marked as not converged.
    newton_tolerance : float
        Of the structural solutions, see `Structure.solve`.
    depth : int
        Differences of passes that accelerations and estimates remember.
    ramp : sequence of float
        Increasing fractions of the dynamic pressure, ending with 1. The method "newton" adds more
        where it fails.
    chained : bool
        Whether to compute the flow about the blade under the rigid blade's load. With "newton"
        this costs an uncoupled solution, less what the coupled one gains from its start.
    extra : tuple of arrays or None
        Pressure at the nodes [Pa] and dead load on the displacement unknowns [N] beside the
        flow's; they do not change along the ramp.
    progress : callable

    Returns
    -------
    StaticState

    Raises
    ------
    EquilibriumError
        No equilibrium was found at any fraction of the load.
    GeometryError
        Not even the undeformed sections can be solved by the flow.
    ValueError
        Unknown method, or a ramp that does not increase from above 0 to 1.
    """
    _check(method, ramp)
    problem = CoupledBlade(structure, transfer, inflow, extra)
    rigid = problem.flow(np.zeros_like(structure.basis.points))
    limits = Limits(
        tolerance,
        stop or ("change" if method == "fixed-point" else "error"),
        max_iterations,
        newton_tolerance,
        depth,
    )
    way = Ramp(problem, method, limits, progress)
    if chained and (method == "newton" or len(ramp) > 1):
        way.chain(rigid, start_there=len(ramp) == 1)
    way.climb(ramp)
    if chained:
        way.miss_chained()
    good = way.good
    history, at_rest = tuple(way.history), None
    if not way.converged or suspicious(history):
        at_rest = divergence_pressure(structure, transfer, inflow)
    state = StaticState(
        structure=good.state,
        displacement=good.displacement,
        surface=good.pressed,
        rigid=rigid,
        chained_flow=way.chained_flow if chained else None,
        coupled=problem.flow(good.displacement),
        history=history,
        tolerance=tolerance,
        converged=way.converged,
        method=method,
        stop=limits.stop,
        fraction=way.reached,
        kind=classify(history, way.converged, at_rest),
        flows=problem.solved_sections / len(transfer.s),
    )
    return replace(state, notices=(*way.notices, *good.state.notices, *_notices(state, way.reason)))


def _check(method: str, ramp: Sequence[float]) -> None:
    if method not in get_args(Method):
        raise ValueError(f"method {method!r}: use one of {', '.join(get_args(Method))}")
    fractions = np.array(ramp, dtype=np.float64)
    if not len(fractions) or np.any(np.diff([0.0, *fractions]) <= 0.0) or fractions[-1] != 1.0:
        raise ValueError(
            f"ramp {tuple(ramp)}: fractions of the pressure increase from above 0 to 1"
        )


def _notices(state: StaticState, reason: str) -> Iterator[Notice]:
    last = state.history[-1]
    if not state.converged:
        kept = f"the last good state, at {state.fraction:.3g} of the dynamic pressure, is kept"
        value = last.change if state.stop == "change" else last.error
        yield Notice(
            _WHERE,
            f"not converged after {last.iteration} passes ({reason}); {kept}",
            value,
            state.tolerance,
            _REMEDY[state.kind],
        )
    elif state.kind != "steady":
        yield Notice(_WHERE, _MEANING[state.kind], state.rate, 1.0, _REMEDY[state.kind])
    elif state.divergence < _NEAR:
        yield Notice(
            _WHERE,
            "the blade is close to static divergence: divergence pressure over dynamic pressure",
            state.divergence,
            _NEAR,
            _REMEDY["divergence"],
        )
