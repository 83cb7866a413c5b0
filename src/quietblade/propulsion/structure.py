# SPDX-License-Identifier: LGPL-2.1-or-later
"""Static equilibrium of the blade: finite strain, follower pressure, centrifugal force.

Find u and the film pressure p with

    d/d(u,p) [ sum W(F, p) - 1/2 rho omega^2 |P_perp (X + u)|^2 ] . (v, q)
        + int p1 cof(F) N . v dS0 - dead . v = 0

where ``F = 1 + grad u``, all over the undeformed blade (theory: S1-1).
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import ngsolve as ngs
import numpy as np

from quietblade.errors import ConvergenceError
from quietblade.linalg import SparseSolver
from quietblade.materials import Material
from quietblade.mesh.nodal import NodalBasis
from quietblade.propulsion.forms import StructuralForms, Terms, parallel
from quietblade.propulsion.linear import FreeSystem, newton_solver
from quietblade.propulsion.loading import Loading, Spin
from quietblade.propulsion.newton import NewtonStep, Solve, solve_newton
from quietblade.typing import FloatArray, Progress, silent

_SMALLEST_LOAD_STEP = 1 / 256

# Ends of intermediate load steps only have to be good first guesses.
_WAYPOINT = 1e-2

# Forces below this multiple of those that rounding makes at rest are none.
_ROUNDING_MARGIN = 1e3

# Forces and displacements below this share of those at the start count as this share.
_NOTHING = 1e-3

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
        Whether the last line of the table meets the tolerance.
    """

    displacement: FloatArray
    film_pressure: FloatArray
    loading: Loading
    newton: tuple[NewtonStep, ...] = ()
    converged: bool = True

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
        Solver of unsymmetric linear systems; default `newton_solver()`.
    """

    def __init__(
        self,
        fem: ngs.Mesh,
        materials: Mapping[str, Material],
        *,
        clamped: str | None = "root",
        wetted: str = "wet|excited",
        spin: Spin = Spin(),  # noqa: B008  # frozen
        guided: Mapping[str, str] | None = None,
        basis: NodalBasis | None = None,
        solver: SparseSolver | None = None,
    ) -> None:
        self.forms = StructuralForms(
            fem, materials, clamped=clamped, wetted=wetted, guided=guided, basis=basis
        )
        self.spin = spin
        self.solver = newton_solver() if solver is None else solver
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
        tolerance: float = 1e-6,
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
        tolerance : float
            Largest relative residual (to the forces at all unknowns; in the film also the volume
            defect relative to the film's volume), and largest relative last increment.
        progress : callable
            Called with the stage, the fraction of the load and the last line of the table.

        Raises
        ------
        EquilibriumError
            If no equilibrium is found, with the last one found on the way.
        """
        begin = self.rest() if start is None else start
        target = self._loading(pressure, dead_load)
        problem = self._equilibrium
        problem.begin(begin.unknowns)
        tangent = self._kept_tangent if start is not None and start is self._kept_state else None
        x, done, width, table = begin.unknowns, 0.0, 1.0, list[NewtonStep]()
        while done < 1.0:
            fraction = min(1.0, done + width)
            last = fraction == 1.0
            problem.set_loading(begin.loading.towards(target, fraction))
            outcome = solve_newton(
                problem,
                x,
                fraction,
                residual_tolerance=tolerance if last else np.inf,
                increment_tolerance=tolerance if last else _WAYPOINT,
                solve=tangent,
            )
            tangent = None
            table += outcome.steps
            progress(_STAGE, fraction if outcome.converged else done, str(table[-1]))
            if outcome.converged:
                x, done, width = outcome.x, fraction, 2 * width
                continue
            width /= 2
            problem.forget()
            if width < _SMALLEST_LOAD_STEP:
                reached = begin.loading.towards(target, done)
                state = self._state(x, reached, table, False)
                raise self._failure(state, done, fraction, outcome.reason)
        state = self._state(x, target, table, True)
        self._check_volumes(state)
        self._kept_state, self._kept_tangent = state, outcome.solve
        return state

    def forget(self) -> None:
        """Free the memory of the last tangent, which the next `solve` would start with."""
        self._kept_state = self._kept_tangent = None

    def internal_force(self, state: StructureState) -> FloatArray:
        """Gradient of the strain energy, (ndof,) [N and m3], at every unknown."""
        return self._equilibrium.internal(state.unknowns)

    def external_force(self, state: StructureState) -> FloatArray:
        """Pressure, centrifugal and dead forces, (ndof,) [N], at every unknown.

        At free unknowns they balance `internal_force`; elsewhere the difference is the reaction.
        """
        self._equilibrium.set_loading(state.loading)
        return self._equilibrium.external(state.unknowns)

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

    def _state(
        self, x: FloatArray, loading: Loading, table: list[NewtonStep], converged: bool
    ) -> StructureState:
        n = self.forms.n_displacement
        return StructureState(x[:n], x[n:], loading, tuple(table), converged)

    def _failure(
        self, state: StructureState, done: float, wanted: float, reason: str
    ) -> EquilibriumError:
        largest = float(np.linalg.norm(self.values(state), axis=1).max())
        return EquilibriumError(
            f"no static equilibrium between {done:.4g} and {wanted:.4g} of the load: {reason}, "
            f"however small the load step (1/{1 / _SMALLEST_LOAD_STEP:.0f} of the way). The last "
            f"equilibrium has a largest displacement of {largest:.4g} m. Either the structure "
            "diverges or buckles there (lower the load, or stiffen it), or cells are too poor "
            "(refine the mesh).",
            state,
            done,
        )

    def _check_volumes(self, state: StructureState) -> None:
        """Refuse a state that turns material inside out somewhere."""
        forms = self.forms
        F = forms.gradient(forms.displacement(state.displacement))
        inside_out = ngs.IfPos(ngs.Det(F), 0.0, 1.0)
        with parallel():
            volume = ngs.Integrate(inside_out, forms.fem, definedon=forms.solid)
        if volume > 0.0:
            raise EquilibriumError(
                f"the equilibrium turns {volume:.3g} m3 of material inside out (det F <= 0); the "
                "strains are beyond the material law. Lower the load or use another law.",
                state,
                1.0,
            )

    @cached_property
    def _equilibrium(self) -> "_Equilibrium":
        return _Equilibrium(self.forms, self.solver, spins=self.spin.omega != 0.0)


class _Equilibrium:
    """The equilibrium as Newton's method sees it; holds the compiled forms and the loads."""

    def __init__(self, forms: StructuralForms, solver: SparseSolver, *, spins: bool) -> None:
        self._forms = forms
        self._correction = ngs.GridFunction(forms.V)
        loads: Terms = [*forms.pressure_terms(), *(forms.spin_terms() if spins else [])]
        self._internal = forms.form([*forms.elastic_terms(), *forms.mixed_terms()])
        self._loads = forms.form(loads)
        self._tangent = forms.form(
            [*forms.newton_elastic_terms(self._correction), *forms.mixed_terms(), *loads]
        )
        self._system = FreeSystem(forms.free, solver)
        self._dead = np.zeros(forms.ndof)
        self._film_volumes = self._measure_film()
        at_rest = self.internal(np.zeros(forms.ndof))[: forms.n_displacement]
        self._noise = _ROUNDING_MARGIN * float(np.linalg.norm(at_rest))
        self._least_force = self._least_displacement = 0.0

    def begin(self, x: FloatArray) -> None:
        """Prepare a path that starts at a state: its sizes bound those that count as nothing."""
        self.forget()
        n = self._forms.n_displacement
        self._least_force = _NOTHING * float(np.linalg.norm(self.internal(x)[:n]))
        self._least_displacement = _NOTHING * float(np.linalg.norm(x[:n]))

    def forget(self) -> None:
        """Forget the last correction: take the stresses from the displacement."""
        self._correction.vec[:] = 0.0

    def set_loading(self, loading: Loading) -> None:
        self._forms.set_loading(loading)
        self._dead[: self._forms.n_displacement] = loading.dead_load

    def internal(self, x: FloatArray) -> FloatArray:
        return self._apply(self._internal, x)

    def external(self, x: FloatArray) -> FloatArray:
        return self._dead - self._apply(self._loads, x)

    def residual(self, x: FloatArray) -> tuple[FloatArray, float]:
        internal, external = self.internal(x), self.external(x)
        n, free = self._forms.n_displacement, self._forms.free
        difference = np.where(free, internal - external, 0.0)
        force = max(float(np.linalg.norm(internal[:n])), float(np.linalg.norm(external[:n])))
        if force <= self._noise:
            return difference[free], 0.0
        size = float(np.linalg.norm(difference[:n])) / max(force, self._least_force)
        if self._forms.n_pressure:
            defect = np.linalg.norm(difference[n:]) / np.linalg.norm(self._film_volumes)
            size = max(size, float(defect))
        return difference[free], size

    def tangent(self, x: FloatArray) -> Solve:
        with parallel():
            self._tangent.AssembleLinearization(self._forms.vector(x))
        return self._system.factor(self._tangent).solve

    def correct(self, x: FloatArray, step: FloatArray) -> tuple[FloatArray, float]:
        correction = np.zeros(len(x))
        correction[self._forms.free] = -step
        n = self._forms.n_displacement
        corrected = x + correction
        self._correction.vec.FV().NumPy()[:] = correction[:n]
        scale = max(float(np.linalg.norm(corrected[:n])), self._least_displacement)
        change = float(np.linalg.norm(correction[:n]))
        return corrected, change / scale if scale > 0.0 else 0.0

    def _apply(self, form: ngs.BilinearForm, x: FloatArray) -> FloatArray:
        vector = self._forms.vector(x)
        result = vector.CreateVector()
        with parallel():
            form.Apply(vector, result)
        return np.array(result)

    def _measure_film(self) -> FloatArray:
        """Volume that belongs to each film pressure unknown [m3]."""
        forms = self._forms
        if forms.P is None:
            return np.zeros(0)
        q = forms.P.TestFunction()
        volumes = ngs.LinearForm(forms.P)
        volumes += q * ngs.dx(definedon=forms.mixed_region)
        return np.array(volumes.Assemble().vec)
