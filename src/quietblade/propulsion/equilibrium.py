# SPDX-License-Identifier: LGPL-2.1-or-later
"""Equilibrium of the structure at given loads, as Newton's method sees it (theory: S1-1)."""

import ngsolve as ngs
import numpy as np

from quietblade.linalg import SparseSolver
from quietblade.mesh.assembly import csr_of
from quietblade.propulsion.forms import StructuralForms, Terms, parallel
from quietblade.propulsion.linear import FreeSystem
from quietblade.propulsion.loading import Loading
from quietblade.propulsion.newton import Solve
from quietblade.propulsion.supports import ElasticSupport
from quietblade.typing import FloatArray

# Forces below this multiple of those that rounding makes at rest are none.
_ROUNDING_MARGIN = 1e3

# Forces and displacements below this share of those at the start count as this share.
_NOTHING = 1e-3

_EPS = float(np.finfo(float).eps)


class Equilibrium:
    """Equations of a structure: compiled weak forms, the present loads and the linear systems.

    Vectors are numbered as in `StructuralForms` (displacement, then film pressure), fixed
    unknowns included; residuals and the corrections of `tangent` are of the free unknowns only.

    Parameters
    ----------
    forms : StructuralForms
        Spaces and weak forms.
    solver : SparseSolver
        Solver of the linear systems, which are symmetric but for the follower pressure.
    spins : bool
        Whether the structure ever rotates.
    support : ElasticSupport or None
        What holds a face elastically.

    Attributes
    ----------
    negative_pivots : int or None
        Negative eigenvalues of the (symmetric part of the) last factorised tangent beyond those
        that the film pressure always makes: above zero, the equilibrium is unstable.  None if the
        solver does not count them.
    """

    def __init__(
        self,
        forms: StructuralForms,
        solver: SparseSolver,
        *,
        spins: bool,
        support: ElasticSupport | None = None,
    ) -> None:
        self._forms = forms
        self._support = support
        self.negative_pivots: int | None = None
        self._n_moving = int(forms.free[: forms.n_displacement].sum())
        self._film_pivots = int(forms.free[forms.n_displacement :].sum())
        self._correction = ngs.GridFunction(forms.V)
        self._base = ngs.GridFunction(forms.V)
        loads: Terms = [*forms.pressure_terms(), *(forms.spin_terms() if spins else [])]
        self._internal = forms.form([*forms.elastic_terms(), *forms.mixed_terms()])
        self._loads = forms.form(loads)
        self._elastic_tangent = forms.form(
            forms.elastic_tangent_terms(self._base, self._correction), bilinear=True
        )
        self._other_tangent = forms.form([*forms.mixed_terms(), *loads])
        self._system = FreeSystem(
            forms.free, solver, None if support is None else support.stiffness
        )
        self._dead = np.zeros(forms.ndof)
        self._film_volumes = self._measure_film()
        self._cell = forms.cell_size
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
        """Take these loads from now on."""
        self._forms.set_loading(loading)
        self._dead[: self._forms.n_displacement] = loading.dead_load

    def internal(self, x: FloatArray) -> FloatArray:
        """Gradient of the strain energy, (ndof,) [N and m3], at every unknown."""
        return self._apply(self._internal, x)

    def external(self, x: FloatArray) -> FloatArray:
        """Pressure, centrifugal and dead forces, (ndof,) [N], at every unknown."""
        return self._dead - self._apply(self._loads, x)

    def supporting(self, x: FloatArray) -> FloatArray:
        """Return the elastic supports' forces on the structure, (ndof,) [N], at every unknown."""
        return np.zeros(len(x)) if self._support is None else self._support.force(x)

    def residual(self, x: FloatArray) -> tuple[FloatArray, float]:
        """Return internal less all other forces at the free unknowns, and their relative size.

        The size is relative to the forces at all unknowns; in the film also the volume defect
        relative to the film's volume.  It is zero if there is no force but of rounding.
        """
        internal, external = self.internal(x), self.external(x)
        n, free = self._forms.n_displacement, self._forms.free
        difference = np.where(free, internal - external - self.supporting(x), 0.0)
        force = max(float(np.linalg.norm(internal[:n])), float(np.linalg.norm(external[:n])))
        if force <= self._noise:
            return difference[free], 0.0
        size = float(np.linalg.norm(difference[:n])) / max(force, self._least_force)
        if self._forms.n_pressure:
            defect = np.linalg.norm(difference[n:]) / np.linalg.norm(self._film_volumes)
            size = max(size, float(defect))
        return difference[free], size

    def tangent(self, x: FloatArray) -> Solve:
        """Factorise the derivative of the residual.

        Its initial-stress part takes the stress that the last correction predicts, see
        `StructuralForms.elastic_tangent_terms`.

        Returns
        -------
        callable
            From the residual of the free unknowns to the step that `correct` subtracts.
        """
        factor = self._system.factor(*self._assembled(x))
        counts = factor.inertia
        self.negative_pivots = None if counts is None else counts[1] - self._film_pivots
        return factor.solve

    def correct(self, x: FloatArray, step: FloatArray) -> tuple[FloatArray, float]:
        """Subtract a step, (free unknowns,), from x; also return its size relative to x."""
        correction = np.zeros(len(x))
        correction[self._forms.free] = -step
        n = self._forms.n_displacement
        corrected = x + correction
        self._correction.vec.FV().NumPy()[:] = correction[:n]
        scale = max(float(np.linalg.norm(corrected[:n])), self._least_displacement)
        change = float(np.linalg.norm(correction[:n]))
        return corrected, change / scale if scale > 0.0 else 0.0

    def force_size(self, residual: FloatArray) -> float:
        """Size of a residual of the free unknowns [N], over those of the displacement."""
        return float(np.linalg.norm(residual[: self._n_moving]))

    def motion_size(self, step: FloatArray) -> float:
        """Largest displacement of a vertex in a step of the free unknowns [m]."""
        forms = self._forms
        moves = np.zeros(forms.ndof)
        moves[forms.free] = step
        corners = moves[: forms.n_displacement].reshape(3, -1)[:, : forms.fem.nv]
        return float(np.linalg.norm(corners, axis=0).max())

    def rounding(self, x: FloatArray) -> float:
        """Bound of the relative residual that rounding makes at x.

        The unknowns have an error of their last digit, and so has ``F = 1 + grad u``, as if they
        were of the size of a cell: ``eps |K| (|u| + h)``, relative to the forces.
        """
        n, free = self._forms.n_displacement, self._forms.free
        elastic, other = (csr_of(form) for form in self._assembled(x))
        K = abs(elastic + other)[:n, :n]
        error = (K @ (np.abs(x[:n]) + self._cell))[free[:n]]
        force = float(np.linalg.norm(self.internal(x)[:n]))
        return float(_EPS * np.linalg.norm(error)) / max(force, self._least_force)

    def _apply(self, form: ngs.BilinearForm, x: FloatArray) -> FloatArray:
        return self._forms.apply(form, x)

    def _assembled(self, x: FloatArray) -> tuple[ngs.BilinearForm, ngs.BilinearForm]:
        """Two forms whose sum is the tangent."""
        self._base.vec.FV().NumPy()[:] = x[: self._forms.n_displacement]
        with parallel():
            self._elastic_tangent.Assemble()
            self._other_tangent.AssembleLinearization(self._forms.vector(x))
        return self._elastic_tangent, self._other_tangent

    def _measure_film(self) -> FloatArray:
        """Volume that belongs to each film pressure unknown [m3]."""
        forms = self._forms
        if forms.P is None:
            return np.zeros(0)
        q = forms.P.TestFunction()
        volumes = ngs.LinearForm(forms.P)
        volumes += q * ngs.dx(definedon=forms.mixed_region)
        return np.array(volumes.Assemble().vec)
