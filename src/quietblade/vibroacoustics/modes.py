# SPDX-License-Identifier: LGPL-2.1-or-later
"""Real modes of the blade in incompressible water, or in vacuo, none of them missed.

With psi = i omega phi and s = omega^2 the system without compressibility, loss and radiation is
the symmetric pencil (theory: S2-13)

    P(s) = [[K - s M, -s C], [-s C^T, s H']] = K_0 - s B,   B = [[M, C], [C^T, -H']].

Vectors with H' phi = C^T u satisfy x^T B x = u^T (M + C H'^-1 C^T) u > 0, and P(sigma)^-1 B x is
again such a vector, so that Lanczos' method needs the factors of P(sigma) only, not those of H'.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.linalg import ArpackNoConvergence, LinearOperator, eigsh

from quietblade.card import Card, Shown, shortened
from quietblade.errors import ConvergenceError, Notice, SolverError
from quietblade.linalg import Factorization, SparseSolver, make_solver
from quietblade.typing import AnyArray, BoolArray, FloatArray, IntArray, Progress, silent
from quietblade.vibroacoustics.loss import STREAM, Loss, Lossy, loss_term, lossy_parts
from quietblade.vibroacoustics.operators import Operators

_TOLERANCE = 1e-11  # of the solves inside Lanczos' method: they bound the modes' accuracy
_RIGID = 1e-6  # of the highest s: below it a motion takes no elastic energy
_NUDGE = 1.0 + 1e-5  # of a shift that cannot be used


@dataclass(frozen=True, eq=False, repr=False)
class WetModes(Shown):
    """Real modes below a frequency, ascending.

    Attributes
    ----------
    frequency : (m,) array
        sqrt(s) / (2 pi) [Hz]; ``-sqrt(-s) / (2 pi)`` for an unstable equilibrium (s < 0).
    vectors : (m, n) array
        Displacement, film pressure, and phi in the place of the potential psi = i omega phi, on
        the free unknowns; unit modal mass u^T (M + C H'^-1 C^T) u.
    loss_factor : (m,) array
        Loss of the material, x^T L x / x^T K x (theory: S2-14), with the complex moduli at the
        mode's frequency; nan for a rigid motion.
    residual : (m,) array
        ``||P(s) x|| / ||s B x||``, with the least elastic s for that of a rigid motion.
    highest : float
        Every mode below this frequency [Hz] is here.
    count : int
        Number of modes below it by Sylvester's law of inertia.
    solver : str
        Solver of the shifted pencil.
    notices : tuple of Notice
        What is unusual.
    """

    frequency: FloatArray
    vectors: FloatArray
    loss_factor: FloatArray
    residual: FloatArray
    highest: float
    count: int
    solver: str
    notices: tuple[Notice, ...] = field(default=())
    losses: Mapping[str, FloatArray] = field(default_factory=dict)
    """Share of each lossy region in ``loss_factor``, (m,)."""

    @property
    def rigid(self) -> BoolArray:
        """Which modes (m,) are rigid motions, which take no elastic energy."""
        return np.isnan(self.loss_factor)

    def card(self) -> Card:
        """Frequencies and material losses, and below which frequency none is missing."""
        rows = [
            (f"{k}", f"{f:.4f}", f"{eta:.3e}")
            for k, (f, eta) in enumerate(zip(self.frequency, self.loss_factor, strict=True), 1)
        ]
        title = f"{self.count} wet modes below {self.highest:g} Hz, none missed"
        columns = ("mode", "frequency [Hz]", "loss factor of the material [1]")
        return Card(title, shortened(rows), columns)


@dataclass(frozen=True, eq=False)
class Pencil:
    """K_0 - s B on the unknowns (u, p, phi), or on (u, p) in vacuo.

    Attributes
    ----------
    stiffness, inertia : (n, n) csr_matrix
        K_0 and B.
    film : (n_p,) int array
        Unknowns of film pressure: without mass, and one negative pivot each.
    water : (n_psi,) int array
        Unknowns of the water, empty in vacuo.
    """

    stiffness: csr_matrix
    inertia: csr_matrix
    film: IntArray
    water: IntArray

    def at(self, s: float) -> csr_matrix:
        """P(s)."""
        return csr_matrix(self.stiffness - s * self.inertia)


def wet_pencil(operators: Operators, moduli_at: float = 0.0) -> Pencil:
    """Pencil of the blade in incompressible water without end (theory: S2-13).

    The motion that a stream damps, and a root that is held, are left out: they come last.

    Parameters
    ----------
    operators : Operators
    moduli_at : float
        Frequency [Hz] whose storage moduli count.

    Raises
    ------
    ValueError
        If the operators have no static exterior.
    """
    if operators.exterior is None:
        raise ValueError("wet modes need the static exterior of the sphere (operators.exterior)")
    terms, blocks = operators.terms, operators.blocks
    inertia = csr_matrix(terms["M"] + terms["C"] - terms["H"] - operators.exterior)
    kept = _wet_unknowns(operators)
    stiffness = operators.stiffness(2.0 * np.pi * moduli_at)
    return Pencil(stiffness[kept][:, kept], inertia[kept][:, kept], blocks.p, blocks.water)


def dry_pencil(operators: Operators, moduli_at: float = 0.0) -> Pencil:
    """Pencil of the blade in vacuo, on its own unknowns (`_dry_unknowns`)."""
    solid, blocks = _dry_unknowns(operators), operators.blocks
    stiffness = operators.stiffness(2.0 * np.pi * moduli_at)[solid][:, solid]
    film = np.flatnonzero(np.isin(solid, blocks.p))
    return Pencil(
        stiffness, operators.terms["M"][solid][:, solid], film, np.zeros(0, dtype=np.int64)
    )


def _wet_unknowns(operators: Operators) -> IntArray:
    """All but the strips in a stream, and but a root that is held."""
    blocks = operators.blocks
    held = blocks.held if len(blocks.reaction) else blocks.reaction
    return np.arange(operators.size - len(blocks.strips) - len(held))


def _dry_unknowns(operators: Operators) -> IntArray:
    kept, blocks = _wet_unknowns(operators), operators.blocks
    return kept[np.isin(kept, np.concatenate([blocks.u, blocks.p, blocks.root]))]


def wet_modes(
    operators: Operators,
    highest: float,
    *,
    moduli_at: float = 0.0,
    solver: SparseSolver | None = None,
    progress: Progress = silent,
) -> WetModes:
    """All real modes of the blade in incompressible water below a frequency.

    Parameters
    ----------
    operators : Operators
        With the static exterior.
    highest : float
        Frequency [Hz] up to which no mode may be missing.
    moduli_at : float
        Frequency [Hz] whose storage moduli count, best near the modes that matter; at rest by
        default, which changes nothing where moduli do not depend on frequency.
    solver : SparseSolver, optional
        Symmetric, in double precision: its inertia counts the modes.
    progress : Progress
        Called before the factorisation and once the modes are counted.

    Raises
    ------
    ValueError
        If the highest frequency is not positive.
    ConvergenceError
        If a mode that was counted was not found.
    SolverError
        If the solver gives no inertia.
    """
    kept = _wet_unknowns(operators)
    modes = solve_modes(
        wet_pencil(operators, moduli_at), _loss_on(operators, kept), highest,
        solver=solver, progress=progress,
    )  # fmt: skip
    return _spread(modes, kept, operators.size)


def dry_modes(
    operators: Operators,
    highest: float,
    *,
    moduli_at: float = 0.0,
    solver: SparseSolver | None = None,
    progress: Progress = silent,
) -> WetModes:
    """All real modes of the blade in vacuo below a frequency, as `wet_modes`; phi is zero."""
    solid = _dry_unknowns(operators)
    modes = solve_modes(
        dry_pencil(operators, moduli_at), _loss_on(operators, solid), highest,
        solver=solver, progress=progress,
    )  # fmt: skip
    return _spread(modes, solid, operators.size)


def _loss_on(operators: Operators, kept: IntArray) -> Loss:
    """Lossy regions on some of the unknowns."""
    return {
        region: Lossy(operators.terms[loss_term(region)][kept][:, kept], ratio)
        for region, ratio in operators.moduli.items()
    }


def _spread(modes: WetModes, kept: IntArray, size: int) -> WetModes:
    """Modes on all unknowns, zero where they were not solved for."""
    vectors = np.zeros((len(modes.frequency), size))
    vectors[:, kept] = modes.vectors
    return replace(modes, vectors=vectors)


def solve_modes(
    pencil: Pencil,
    loss: Loss,
    highest: float,
    *,
    solver: SparseSolver | None = None,
    progress: Progress = silent,
) -> WetModes:
    """All modes of a pencil with s below ``(2 pi highest)^2``.

    The shift is that limit: its negative pivots count the modes below, and these are the negative
    end of the spectrum of the shifted and inverted pencil, where Lanczos' method converges first
    (T. Ericsson and A. Ruhe, Math. Comp. 35 (1980) 1251-1268).
    """
    if not 0.0 < highest < np.inf:
        raise ValueError(f"modes: the highest frequency, {highest:g} Hz, must be positive")
    chosen = make_solver(precision="double", tolerance=_TOLERANCE) if solver is None else solver
    shift = (2.0 * np.pi * highest) ** 2
    progress("modes", None, f"factorisation at {highest:g} Hz")
    factor, count = _counted(pencil, shift, chosen)
    progress("modes", None, f"{count} modes below {highest:g} Hz")
    try:
        vectors = _lowest(pencil, factor, shift, count)
    except SolverError:
        # The limit is a mode, or as good as one: step aside.
        factor, count = _counted(pencil, shift * _NUDGE, chosen)
        vectors = _lowest(pencil, factor, shift * _NUDGE, count)
    return _judged(pencil, loss, vectors, highest, count, factor.solver)


def _counted(pencil: Pencil, shift: float, solver: SparseSolver) -> tuple[Factorization, int]:
    """Factors of P(shift), and the number of modes below the shift."""
    factor = solver.factor(pencil.at(shift))
    if factor.inertia is None:
        raise SolverError(
            f"modes: {factor.solver} gives no inertia, so modes cannot be counted; "
            "use rslab or mkl-pardiso in double precision"
        )
    return factor, factor.inertia[1] - len(pencil.film)


def _lowest(pencil: Pencil, factor: Factorization, shift: float, count: int) -> FloatArray:
    """Vectors of the modes below the shift, (count, n)."""
    n = factor.n
    if count == 0:
        return np.zeros((0, n))

    def inverse(force: FloatArray) -> FloatArray:
        # Zero in the water's rows keeps H' phi = C^T u exactly; film pressure carries no mass.
        force = np.array(force, dtype=float).reshape(-1)
        force[pencil.water] = 0.0
        force[pencil.film] = 0.0
        return np.asarray(factor.solve(force))

    start = inverse(np.random.default_rng(0).standard_normal(n))
    moving = n - len(pencil.film) - len(pencil.water)
    steps = min(moving - 1, max(2 * count + 20, 40))
    if steps < count + 2:
        raise ConvergenceError(
            f"modes: {count} modes of {moving} moving unknowns are too many for Lanczos' method; "
            "lower the highest frequency"
        )
    try:
        _, vectors = eigsh(
            pencil.stiffness,
            k=count,
            M=pencil.inertia,
            sigma=shift,
            which="SA",
            v0=start,
            ncv=steps,
            maxiter=100,
            tol=1e-10,
            OPinv=LinearOperator((n, n), matvec=inverse, dtype=np.dtype(float)),
        )
    except ArpackNoConvergence as error:
        raise ConvergenceError(
            f"modes: only {len(error.eigenvalues)} of {count} modes converged; "
            "lower the highest frequency"
        ) from error
    # One more step removes what rounding has put where B is zero (film pressure).
    return np.array([inverse(pencil.inertia @ vector) for vector in np.asarray(vectors).T])


def _judged(
    pencil: Pencil, loss: Loss, vectors: FloatArray, highest: float, count: int, solver: str
) -> WetModes:
    """Sort, scale and check."""
    forces = _times(pencil.stiffness, vectors)
    momenta = _times(pencil.inertia, vectors)
    masses = np.einsum("ij,ij->i", vectors, momenta)
    eigenvalues = np.einsum("ij,ij->i", vectors, forces) / masses
    order = np.argsort(eigenvalues)
    scale = 1.0 / np.sqrt(masses[order])[:, None]
    s, x = eigenvalues[order], vectors[order] * scale
    x *= np.sign(x[np.arange(len(x)), np.abs(x).argmax(axis=1)])[:, None] if len(x) else 1.0
    floor = _RIGID * (2.0 * np.pi * highest) ** 2
    defect = np.linalg.norm(forces[order] * scale - s[:, None] * momenta[order] * scale, axis=1)
    size = np.maximum(np.abs(s), floor) * np.linalg.norm(momenta[order] * scale, axis=1)
    _check_complete(x, pencil, s, count, highest)
    elastic = np.abs(s) > floor
    omega = np.sqrt(np.abs(s))
    frequency = np.sign(s) * omega / (2.0 * np.pi)
    losses = {}
    for region, part in lossy_parts(loss).items():
        damping = np.array([complex(part.ratio(complex(w))).imag for w in omega])
        lost = damping * np.einsum("ij,ij->i", x, _times(part.matrix, x))
        losses[region] = np.divide(lost, s, out=np.full(len(s), np.nan), where=elastic)
    return WetModes(
        frequency=frequency,
        vectors=x,
        loss_factor=sum(losses.values(), start=np.where(elastic, 0.0, np.nan)),
        residual=defect / size,
        highest=highest,
        count=count,
        solver=solver,
        notices=_unusual(frequency[elastic]),
        losses=losses,
    )


def _times(matrix: csr_matrix, rows: FloatArray) -> FloatArray:
    return np.asarray((matrix @ rows.T).T)


def _check_complete(
    x: FloatArray, pencil: Pencil, s: FloatArray, count: int, highest: float
) -> None:
    """Confirm that the modes are as many as were counted, below the limit, and independent."""
    gram = x @ _times(pencil.inertia, x).T
    limit = (2.0 * np.pi * highest * _NUDGE) ** 2
    overlap = float(np.abs(gram - np.eye(len(x))).max(initial=0.0))
    if len(x) != count or bool(np.any(s > limit)) or overlap > 1e-4:
        raise ConvergenceError(
            f"modes: {count} modes were counted below {highest:g} Hz, but {np.sum(s <= limit)} of "
            f"{len(x)} vectors are such modes (largest overlap {overlap:.1e}); "
            "another highest frequency may help"
        )


def _unusual(frequency: FloatArray) -> tuple[Notice, ...]:
    unstable = int(np.sum(frequency < 0.0))
    if not unstable:
        return ()
    return (
        Notice(
            "modes",
            f"{unstable} of the modes grow: the equilibrium is unstable",
            float(frequency.min()),
            0.0,
            "Check the prestress and the form of the stiffness.",
        ),
    )


def unknowns(modes: WetModes, operators: Operators) -> AnyArray:
    """Vectors in the unknowns of A(omega): psi = i omega phi in the place of phi, complex.

    The motion of the strips that a stream damps follows the displacement.
    """
    vectors = modes.vectors.astype(complex)
    blocks, omega = operators.blocks, 2.0 * np.pi * modes.frequency
    vectors[:, blocks.water] *= 1j * omega[:, None]
    if len(blocks.strips):
        weights = operators.terms[loss_term(STREAM)][blocks.strips][:, blocks.u]
        vectors[:, blocks.strips] = (weights @ vectors[:, blocks.u].T).T
    return vectors
