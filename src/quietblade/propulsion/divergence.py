# SPDX-License-Identifier: LGPL-2.1-or-later
r"""Static divergence and wash-out: eigenvalues of the linearised coupling.

A pass of flow and structure changes a small displacement v into
:math:`J v = K^{-1} B\, F'(u)\, v`, with the tangent K and the force B of a nodal pressure at a
state. Its eigenvalues :math:`\mu` grow in proportion to the dynamic pressure q as long as the
stiffness stays (theory: S1-97). A real :math:`\mu \to 1` is static divergence; negative and complex
ones never are, however large: they only make a plain fixed point diverge.
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from quietblade.flow.inflow import Inflow
from quietblade.propulsion.acceleration import Map
from quietblade.propulsion.coupling_problem import CoupledBlade, CouplingStep
from quietblade.propulsion.loading import Loading
from quietblade.propulsion.structure import Structure, StructureState
from quietblade.propulsion.transfer import LoadTransfer
from quietblade.typing import AnyArray, FloatArray

Kind = Literal["steady", "wash-out", "divergence", "post-divergence", "unresolved"]

# An eigenvalue counts as real if its imaginary part is at most this share of it.
_REAL = 0.05

# Eigenvalues below this share of the largest one are not resolved.
_RESOLVED = 1e-2

# Divergence pressures below this many times the dynamic pressure deserve a closer look.
_SUSPECT = 2.0

# Largest displacement in a finite difference of the flow, as a share of the span.
_STEP = 1e-4

# Krylov vectors of which less than this share is new end the basis.
_EXHAUSTED = 1e-6


@dataclass(frozen=True, eq=False)
class Divergence:
    """Linearised coupling at a state of the blade.

    Attributes
    ----------
    eigenvalues : complex array
        Of a pass of flow and structure, the largest first.
    fraction : float
        Fraction of the dynamic pressure at which they were taken.
    """

    eigenvalues: AnyArray
    fraction: float = 1.0

    @property
    def rate(self) -> float:
        """Contraction rate of the plain fixed point near the solution: the spectral radius."""
        return float(np.max(np.abs(self.eigenvalues), initial=0.0))

    @property
    def pressure_ratio(self) -> float:
        """Divergence pressure over the dynamic pressure of the case; infinite if none."""
        return divergence_ratio(self.eigenvalues, self.fraction)


def divergence_ratio(eigenvalues: AnyArray, fraction: float = 1.0) -> float:
    """Divergence pressure over the whole dynamic pressure (theory: S1-97).

    Parameters
    ----------
    eigenvalues : array
        Of a pass of flow and structure at a fraction of the dynamic pressure.
    fraction : float

    Returns
    -------
    float
        Fraction over the largest positive real eigenvalue; infinite if there is none.
    """
    values = np.atleast_1d(np.asarray(eigenvalues, dtype=complex))
    values = values[np.isfinite(values)]
    size = np.abs(values)
    resolved = size > _RESOLVED * np.max(size, initial=0.0)
    real = values[resolved & (np.abs(values.imag) <= _REAL * size) & (values.real > 0.0)].real
    return float(fraction / np.max(real)) if len(real) else np.inf


def southwell(pressure: FloatArray, deflection: FloatArray) -> float:
    r"""Divergence pressure from deflections below it, by Southwell's plot (theory: S1-98).

    Near divergence :math:`\delta = q\,\delta' / (1 - q/q_D)`, so that
    :math:`\delta / q = \delta' + \delta / q_D`: a straight line through the pairs.

    Parameters
    ----------
    pressure, deflection : ndarray, shape (n,)
        At least two positive pressures, in any unit, and the deflections (twists) at them.

    Returns
    -------
    float
        In the unit of the pressures; infinite or negative where the deflection grows no faster
        than the pressure.
    """
    if len(pressure) < 2:
        raise ValueError("southwell: at least two pressures with their deflections are needed")
    slope = float(np.polyfit(deflection, deflection / pressure, 1)[0])
    return 1.0 / slope if slope != 0.0 else np.inf


def divergence_pressure(
    structure: Structure,
    transfer: LoadTransfer,
    inflow: Inflow,
    state: StructureState | None = None,
    *,
    fraction: float = 1.0,
    dimension: int = 6,
) -> Divergence:
    """Eigenvalues of the linearised coupling, and the divergence pressure that they foretell.

    By Arnoldi's method with differences of the flow; one factorisation and ``dimension`` flows.

    Parameters
    ----------
    structure, transfer, inflow
        As for `solve_static`.
    state : StructureState or None
        Equilibrium at which to linearise, with its stresses and loads; default: the undeformed,
        unloaded blade, as the textbooks do.
    fraction : float
        Fraction of the dynamic pressure that the eigenvalues are for.
    dimension : int
        Size of the Krylov space. The spectrum decays fast: 6 serve for the first one or two.

    Returns
    -------
    Divergence
    """
    problem = CoupledBlade(structure, transfer, inflow)
    at = structure.rest() if state is None else state
    equations, x = structure.equations, at.unknowns
    u = structure.values(at)
    equations.begin(x)
    equations.set_loading(at.loading)
    solve = equations.tangent(x)

    def pressure(displacement: FloatArray) -> FloatArray:
        return problem.surface(problem.flow(displacement), displacement).values

    def respond(change: FloatArray) -> FloatArray:
        n = structure.forms.n_displacement
        equations.set_loading(Loading(change, np.zeros(n), 0.0))
        full = np.zeros(structure.forms.ndof)
        free = structure.forms.free
        full[free] = solve(equations.external(x)[free])
        return problem.values(full)

    here = pressure(u)
    size = _STEP * float(np.ptp(transfer.sections[..., 2]))

    def image(v: FloatArray) -> FloatArray:
        step = size / float(np.max(np.abs(v)))
        return fraction / step * respond(pressure(u + step * v.reshape(u.shape)) - here).ravel()

    return Divergence(_arnoldi(image, respond(here).ravel(), dimension), fraction)


def _arnoldi(image: Map, start: FloatArray, dimension: int) -> AnyArray:
    """Ritz values, the largest first."""
    basis = [start / np.linalg.norm(start)]
    columns = np.zeros((dimension + 1, dimension))
    for k in range(dimension):
        new = image(basis[k])
        whole = float(np.linalg.norm(new))
        for _ in range(2):
            for j, q in enumerate(basis):
                part = float(q @ new)
                columns[j, k] += part
                new = new - part * q
        columns[k + 1, k] = np.linalg.norm(new)
        if columns[k + 1, k] <= _EXHAUSTED * whole:
            break
        basis.append(new / columns[k + 1, k])
    values = np.linalg.eigvals(columns[: k + 1, : k + 1]).astype(complex)
    return np.asarray(values[np.argsort(-np.abs(values))])


def suspicious(history: tuple[CouplingStep, ...]) -> bool:
    """Whether an eigenvalue on the way comes near to divergence, so that one should look closer."""
    return any(
        divergence_ratio(np.array([step.eigenvalue]), step.fraction) < _SUSPECT for step in history
    )


def classify(
    history: tuple[CouplingStep, ...], converged: bool, at_rest: Divergence | None = None
) -> Kind:
    """Tell apart what happened (theory: S1-99).

    Parameters
    ----------
    history : tuple of CouplingStep
    converged : bool
        Whether the coupling converged at the whole pressure.
    at_rest : Divergence or None
        Eigenvalues at the undeformed blade, if they are known.

    Returns
    -------
    {"steady", "wash-out", "divergence", "post-divergence", "unresolved"}
        *steady*: an equilibrium that a plain fixed point finds too; *wash-out*: eigenvalues beyond
        1 that are negative or complex, so that an equilibrium exists but a plain fixed point
        misses it; *divergence*: a real eigenvalue beyond 1; *post-divergence*: a stable
        equilibrium that only softening lift or stiffening deformation leaves to a blade beyond its
        divergence pressure at rest; *unresolved*: not converged for another reason.
    """
    if not converged and at_rest is not None:
        if at_rest.pressure_ratio <= 1.0:
            return "divergence"
        return "wash-out" if at_rest.rate >= 1.0 else "unresolved"
    last = [step.eigenvalue for step in history if np.isfinite(step.eigenvalue)][-1:]
    if last and abs(last[0]) >= 1.0:
        return "divergence" if np.isfinite(divergence_ratio(np.array(last))) else "wash-out"
    if not converged:
        return "unresolved"
    beyond = at_rest is not None and at_rest.pressure_ratio <= 1.0
    return "post-divergence" if beyond else "steady"
