# SPDX-License-Identifier: LGPL-2.1-or-later
"""Real modes of the blade in incompressible water, or in vacuo, none of them missed.

With psi = i omega phi and s = omega^2 the system without compressibility, loss and radiation is
the symmetric pencil (theory: S2-13)

    P(s) = [[K - s M, -s C], [-s C^T, s H']] = K_0 - s B,   B = [[M, C], [C^T, -H']].

Vectors with H' phi = C^T u satisfy x^T B x = u^T (M + C H'^-1 C^T) u > 0, and P(sigma)^-1 B x is
again such a vector, so that Lanczos' method needs the factors of P(sigma) only, not those of H'.
"""

from dataclasses import dataclass, field

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.linalg import ArpackNoConvergence, LinearOperator, eigsh

from quietblade.errors import ConvergenceError, Notice, SolverError
from quietblade.linalg import Factorization, SparseSolver, make_solver
from quietblade.typing import AnyArray, FloatArray, IntArray, Progress, silent
from quietblade.vibroacoustics.operators import Operators

_TOLERANCE = 1e-11  # of the solves inside Lanczos' method: they bound the modes' accuracy
_RIGID = 1e-6  # of the highest s: below it a motion takes no elastic energy
_NUDGE = 1.0 + 1e-5  # of a shift that cannot be used


@dataclass(frozen=True, eq=False)
class WetModes:
    """Real modes below a frequency, ascending.

    Attributes
    ----------
    frequency : (m,) array
        sqrt(s) / (2 pi) [Hz]; ``-sqrt(-s) / (2 pi)`` for an unstable equilibrium (s < 0).
    vectors : (m, n) array
        Displacement, film pressure, and phi in the place of the potential psi = i omega phi, on
        the free unknowns; unit modal mass u^T (M + C H'^-1 C^T) u.
    loss_factor : (m,) array
        Loss of the material, x^T L x / x^T K x (theory: S2-14); nan for a rigid motion.
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
        Unknowns of potential, empty in vacuo.
    """

    stiffness: csr_matrix
    inertia: csr_matrix
    film: IntArray
    water: IntArray

    def at(self, s: float) -> csr_matrix:
        """P(s)."""
        return csr_matrix(self.stiffness - s * self.inertia)


def wet_pencil(operators: Operators) -> Pencil:
    """Pencil of the blade in incompressible water without end (theory: S2-13).

    Raises
    ------
    ValueError
        If the operators have no static exterior.
    """
    if operators.exterior is None:
        raise ValueError("wet modes need the static exterior of the sphere (operators.exterior)")
    terms, blocks = operators.terms, operators.blocks
    inertia = terms["M"] + terms["C"] - terms["H"] - operators.exterior
    return Pencil(terms["K"], csr_matrix(inertia), blocks.p, blocks.psi)


def dry_pencil(operators: Operators) -> Pencil:
    """Pencil of the blade in vacuo, on displacement and film pressure."""
    blocks = operators.blocks
    solid = np.concatenate([blocks.u, blocks.p])
    stiffness, mass = (csr_matrix(operators.terms[name][solid][:, solid]) for name in "KM")
    film = len(blocks.u) + np.arange(len(blocks.p))
    return Pencil(stiffness, mass, film, np.zeros(0, dtype=np.int64))


def wet_modes(
    operators: Operators,
    highest: float,
    *,
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
    solver : SparseSolver, optional
        Symmetric, in double precision: its inertia counts the modes.
    progress : Progress
        Called before the factorisation and once the modes are counted.

    Raises
    ------
    ConvergenceError
        If a mode that was counted was not found.
    SolverError
        If the solver gives no inertia.
    """
    return solve_modes(
        wet_pencil(operators), operators.terms["L"], highest, solver=solver, progress=progress
    )


def dry_modes(
    operators: Operators,
    highest: float,
    *,
    solver: SparseSolver | None = None,
    progress: Progress = silent,
) -> WetModes:
    """All real modes of the blade in vacuo below a frequency, as `wet_modes`; phi is zero."""
    pencil, blocks = dry_pencil(operators), operators.blocks
    solid = np.concatenate([blocks.u, blocks.p])
    loss = csr_matrix(operators.terms["L"][solid][:, solid])
    modes = solve_modes(pencil, loss, highest, solver=solver, progress=progress)
    vectors = np.zeros((len(modes.frequency), operators.size))
    vectors[:, solid] = modes.vectors
    return WetModes(
        modes.frequency, vectors, modes.loss_factor, modes.residual, modes.highest,
        modes.count, modes.solver, modes.notices,
    )  # fmt: skip


def solve_modes(
    pencil: Pencil,
    loss: csr_matrix,
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
    pencil: Pencil, loss: csr_matrix, vectors: FloatArray, highest: float, count: int, solver: str
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
    lost = np.einsum("ij,ij->i", x, _times(loss, x))
    elastic = np.abs(s) > floor
    frequency = np.sign(s) * np.sqrt(np.abs(s)) / (2.0 * np.pi)
    return WetModes(
        frequency=frequency,
        vectors=x,
        loss_factor=np.divide(lost, s, out=np.full(len(s), np.nan), where=elastic),
        residual=defect / size,
        highest=highest,
        count=count,
        solver=solver,
        notices=_unusual(frequency[elastic]),
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
    """Vectors in the unknowns of A(omega): psi = i omega phi in the place of phi, complex."""
    vectors = modes.vectors.astype(complex)
    omega = 2.0 * np.pi * modes.frequency
    vectors[:, operators.blocks.psi] *= 1j * omega[:, None]
    return vectors
