# SPDX-License-Identifier: LGPL-2.1-or-later
"""Static equilibrium of the blade: finite strain, follower pressure, centrifugal force.

Find u and the film pressure p with

    d/d(u,p) [ sum W(F, p) - 1/2 rho omega^2 |P_perp (X + u)|^2 ] . (v, q)
        + int p1 cof(F) N . v dS0 - dead . v = 0

where ``F = 1 + grad u``, all over the undeformed blade (theory: S1-1).
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal

import ngsolve as ngs
import numpy as np

from quietblade.errors import ConvergenceError, Notice
from quietblade.linalg import SparseSolver
from quietblade.materials import Material
from quietblade.mesh.model import INTERFACE
from quietblade.mesh.nodal import NodalBasis
from quietblade.propulsion.contact import SurfaceCrossing
from quietblade.propulsion.equilibrium import Equilibrium
from quietblade.propulsion.forms import StructuralForms, parallel
from quietblade.propulsion.linear import newton_solver
from quietblade.propulsion.loading import Loading, Spin
from quietblade.propulsion.newton import NewtonStep, Solve, Tolerance
from quietblade.propulsion.stepping import SMALLEST_LOAD_STEP, LoadStep, Path, follow
from quietblade.propulsion.supports import ElasticSupport, Support, assemble_support
from quietblade.typing import FloatArray, Progress, silent

OnFailure = Literal["raise", "return"]

_STAGE = "structure"


@dataclass(frozen=True, eq=False)
class StructureState:
    """Equilibrium of the structure.

    Attributes
    ----------
    displacement : (n,) float array
        Unknowns of ``VectorH1(fem, order=2)`` [m], full length, one block a component.
    film_pressure : (m,) float array
        Unknowns of ``H1(fem, order=1)`` [Pa], full length; mean stress, positive in tension.
        Empty if no material is mixed.
    loading : Loading
        The loads in equilibrium with them.
    newton : tuple of NewtonStep
        Convergence table.
    converged : bool
        Whether the wanted load was reached, to the tolerance, in a state that can be.
    fraction : float
        Fraction of the way from the start's load to the wanted one at which this equilibrium is.
    steps : tuple of LoadStep
        The load steps that were tried, with the stability of each.
    notices : tuple of Notice
        What the user should know: not converged, unstable, surfaces that cross.
    """

    displacement: FloatArray
    film_pressure: FloatArray
    loading: Loading
    newton: tuple[NewtonStep, ...] = ()
    converged: bool = True
    fraction: float = 1.0
    steps: tuple[LoadStep, ...] = ()
    notices: tuple[Notice, ...] = ()

    @property
    def unstable_from(self) -> float | None:
        """Least fraction of the load at which an equilibrium on the way was unstable, if any.

        Where the tangent has negative pivots there, a limit or bifurcation point has been passed.
        """
        return min(
            (s.fraction for s in self.steps if s.converged and s.negative_pivots), default=None
        )

    @property
    def unknowns(self) -> FloatArray:
        """Displacement and film pressure in the product space's numbering."""
        return np.concatenate([self.displacement, self.film_pressure])


class EquilibriumError(ConvergenceError):
    """No equilibrium was found at the wanted load.

    Attributes
    ----------
    state : StructureState
        Last equilibrium on the way (to the waypoint tolerance).
    fraction : float
        Its fraction of the load path.
    """

    def __init__(self, message: str, state: StructureState, fraction: float) -> None:
        super().__init__(message)
        self.state, self.fraction = state, fraction


class Structure:
    """The solid of a mesh with its materials, supports and spin.

    Parameters
    ----------
    fem : ngsolve.Mesh
        Mesh with the named regions and boundaries.
    materials : mapping
        Law of each solid region, by region name.
    clamped : str or None
        Name pattern of the boundaries that are held, if any.
    wetted : str
        Name pattern of the boundaries that carry pressure.
    spin : Spin
        Rotation about the x axis.
    guided : mapping or None
        Boundary name patterns by axis ("x", "y", "z") where only that displacement is held, as
        planes of symmetry are.
    basis : NodalBasis or None
        Nodal basis of the mesh, if there is one already.
    solver : SparseSolver or None
        Solver of the linear systems, which are symmetric but for the follower pressure; default
        `newton_solver()`.
    support : Support or None
        Elastic support of a boundary, which `clamped` then must not name.
    """

    def __init__(
        self,
        fem: ngs.Mesh,
        materials: Mapping[str, Material],
        *,
        clamped: str | None = "root",
        wetted: str = INTERFACE,
        spin: Spin = Spin(),  # noqa: B008  # frozen
        guided: Mapping[str, str] | None = None,
        basis: NodalBasis | None = None,
        solver: SparseSolver | None = None,
        support: Support | None = None,
    ) -> None:
        self.forms = StructuralForms(
            fem, materials, clamped=clamped, wetted=wetted, guided=guided, basis=basis
        )
        self.spin = spin
        self.solver = newton_solver() if solver is None else solver
        self.support = support
        self._kept_state: StructureState | None = None
        self._kept_tangent: Solve | None = None

    @property
    def basis(self) -> NodalBasis:
        """Nodes of pressures and displacements."""
        return self.forms.basis

    def rest(self) -> StructureState:
        """Return the unloaded, undeformed state."""
        n = self.forms.n_displacement
        nothing = Loading(np.zeros(len(self.basis.points)), np.zeros(n), 0.0)
        return StructureState(np.zeros(n), np.zeros(self.forms.n_pressure), nothing)

    def values(self, state: StructureState) -> FloatArray:
        """Displacement at the nodes, (nodes, 3) [m]; zero outside the solid."""
        values = np.zeros((len(self.basis.points), 3))
        solid = self.forms.solid_nodes
        values[solid] = self.basis.to_values(state.displacement)[solid]
        return values

    def solve(
        self,
        pressure: FloatArray,
        start: StructureState | None = None,
        *,
        dead_load: FloatArray | None = None,
        tolerance: float | Tolerance = 1e-6,
        on_failure: OnFailure = "raise",
        progress: Progress = silent,
    ) -> StructureState:
        """Find the equilibrium under a pressure, by load steps of automatic size.

        The load goes straight from the start's to the wanted one, in one step if Newton's method
        converges; otherwise the step is halved, and doubled again after a success.

        Parameters
        ----------
        pressure : (nodes,) float array
            Pressure p - p_inf [Pa] at the nodes of `basis`, of which those on the wetted surface
            count; it follows the deformed surface.
        start : StructureState or None
            Known equilibrium; default at rest.  Held displacements keep the start's values.  If
            it is the last result, its tangent serves for the first correction.
        dead_load : (displacement unknowns,) float array or None
            Forces [N] of fixed direction, work-conjugate to the displacement unknowns.
        tolerance : float or Tolerance
            Largest relative residual (to the forces at all unknowns; in the film also the volume
            defect relative to the film's volume), and largest relative last increment; or both by
            themselves, also in N and m.
        on_failure : {"raise", "return"}
            What to do if there is no equilibrium at the wanted load: raise, or return the last one
            found on the way, with ``converged = False`` and a notice.
        progress : callable
            Called with the stage, the fraction of the load and the last line of the table.

        Raises
        ------
        EquilibriumError
            If no equilibrium is found, with the last one found on the way.
        """
        begin = self.rest() if start is None else start
        target = self._loading(pressure, dead_load)
        wanted = tolerance if isinstance(tolerance, Tolerance) else Tolerance(tolerance, tolerance)
        equations = self.equations
        equations.begin(begin.unknowns)
        path = follow(
            equations,
            begin.unknowns,
            lambda fraction: equations.set_loading(begin.loading.towards(target, fraction)),
            wanted,
            solve=None if start is None else self.kept(start),
            progress=progress,
        )
        state = self._state(path, begin.loading.towards(target, path.fraction), wanted)
        failure = self._failure(state) if not path.converged else self._inverted(state)
        if failure is not None:
            self.forget()
            if on_failure == "raise":
                raise failure
            return failure.state
        self.keep(state, path.solve)
        return state

    def keep(self, state: StructureState, tangent: Solve | None) -> None:
        """Keep the factored tangent of a state, for a solution that starts from it."""
        self._kept_state, self._kept_tangent = state, tangent

    def kept(self, state: StructureState) -> Solve | None:
        """Return the tangent that is kept for this very state, if there is one."""
        return self._kept_tangent if state is self._kept_state else None

    def forget(self) -> None:
        """Free the memory of the last tangent, which the next `solve` would start with."""
        self._kept_state = self._kept_tangent = None

    def internal_force(self, state: StructureState) -> FloatArray:
        """Gradient of the strain energy, (ndof,) [N and m3], at every unknown."""
        return self.equations.internal(state.unknowns)

    def external_force(self, state: StructureState) -> FloatArray:
        """Pressure, centrifugal and dead forces, (ndof,) [N], at every unknown.

        At free unknowns they balance `internal_force`; elsewhere, and at elastic supports, the
        difference is the reaction.
        """
        self.equations.set_loading(state.loading)
        return self.equations.external(state.unknowns)

    def support_force(self, state: StructureState) -> FloatArray:
        """Return the elastic support's forces on the structure, (ndof,) [N], at every unknown."""
        return self.equations.supporting(state.unknowns)

    def _loading(self, pressure: FloatArray, dead_load: FloatArray | None) -> Loading:
        n = self.forms.n_displacement
        dead = np.zeros(n) if dead_load is None else np.asarray(dead_load, dtype=float)
        for name, array, size in (
            ("pressure", pressure, len(self.basis.points)),
            ("dead_load", dead, n),
        ):
            if array.shape != (size,) or not np.isfinite(array).all():
                raise ValueError(f"{name} has to be {size} finite numbers, got shape {array.shape}")
        return Loading(np.asarray(pressure, dtype=float), dead, self.spin.omega**2)

    def _state(self, path: Path, loading: Loading, wanted: Tolerance) -> StructureState:
        n = self.forms.n_displacement
        state = StructureState(
            path.x[:n], path.x[n:], loading, path.table, path.converged, path.fraction, path.steps
        )
        rounded = () if path.rounding is None else (_rounded(state, path.rounding, wanted),)
        return replace(state, notices=(*rounded, *self._instability(state), *self._crossing(state)))

    def _instability(self, state: StructureState) -> tuple[Notice, ...]:
        fraction = state.unstable_from
        if fraction is None:
            return ()
        return (
            Notice(
                _STAGE,
                f"the equilibrium is unstable from {fraction:.4g} of the load on: the tangent has "
                "negative pivots, so a limit or bifurcation point lies before",
                fraction,
                remedy="Lower the load or stiffen the structure; a real one leaves this state",
            ),
        )

    def _crossing(self, state: StructureState) -> tuple[Notice, ...]:
        crossing = self._surface.find(state.displacement)
        if crossing is None:
            return ()
        return (
            Notice(
                _STAGE,
                f"the deformed surface crosses itself: {np.round(crossing.places[0], 4)} m and "
                f"{np.round(crossing.places[1], 4)} m of the undeformed blade meet; contact is not "
                "modelled",
                float(crossing.pairs),
                remedy="Lower the load or stiffen the structure",
            ),
        )

    def _failure(self, state: StructureState) -> EquilibriumError:
        """Say where and why the path ended."""
        largest = float(np.linalg.norm(self.values(state), axis=1).max())
        last = next(step for step in reversed(state.steps) if not step.converged)
        cause = (
            "The structure diverges or buckles there (lower the load, or stiffen it), or cells are "
            "too poor (refine the mesh)."
        )
        if last.negative_pivots:
            cause = (
                f"The tangent has {last.negative_pivots} negative pivots there: a limit point, "
                "beyond which this load has no equilibrium nearby (lower the load, or stiffen the "
                "structure)."
            )
        message = (
            f"no static equilibrium between {state.fraction:.4g} and {last.fraction:.4g} of the "
            f"load: {last.reason}, however small the load step (1/{1 / SMALLEST_LOAD_STEP:.0f} of "
            f"the way). The last equilibrium has a largest displacement of {largest:.4g} m. {cause}"
        )
        return self._error(state, message, state.fraction, "part of the load that was reached")

    def _inverted(self, state: StructureState) -> EquilibriumError | None:
        """Refuse a state that turns material inside out somewhere."""
        forms = self.forms
        F = forms.gradient(forms.displacement(state.displacement))
        inside_out = ngs.IfPos(ngs.Det(F), 0.0, 1.0)
        with parallel():
            volume = ngs.Integrate(inside_out, forms.fem, definedon=forms.solid)
        if volume == 0.0:
            return None
        message = (
            f"the equilibrium turns {volume:.3g} m3 of material inside out (det F <= 0); the "
            "strains are beyond the material law. Lower the load or use another law."
        )
        return self._error(state, message, 1.0, "material inside out")

    @staticmethod
    def _error(state: StructureState, message: str, fraction: float, what: str) -> EquilibriumError:
        notice = Notice(_STAGE, f"not converged ({what}): {message}", fraction, 1.0)
        marked = replace(state, converged=False, notices=(notice, *state.notices))
        return EquilibriumError(message, marked, fraction)

    @cached_property
    def _surface(self) -> SurfaceCrossing:
        return SurfaceCrossing(self.forms)

    @cached_property
    def equations(self) -> Equilibrium:
        """Equilibrium at given loads as Newton's method sees it."""
        return Equilibrium(
            self.forms,
            self.solver,
            spins=self.spin.omega != 0.0,
            support=self.elastic_support,
        )

    @cached_property
    def elastic_support(self) -> ElasticSupport | None:
        """The elastic support's forces and stiffness, if there is one."""
        return None if self.support is None else assemble_support(self.forms, self.support)


def _rounded(state: StructureState, level: float, wanted: Tolerance) -> Notice:
    reached = state.newton[-1].residual
    return Notice(
        _STAGE,
        f"the residual stays at {reached:.1e} of the forces, where rounding is up to {level:.1e}: "
        f"the tolerance {wanted.residual:.1e} (of increments {wanted.increment:.1e}) cannot be "
        "reached in double precision",
        reached,
        wanted.residual,
        remedy="Ask for a larger tolerance, or give a smallest force and motion in N and m",
    )
