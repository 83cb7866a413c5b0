# SPDX-License-Identifier: LGPL-2.1-or-later
"""Iterative refinement with a measured residual."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_matrix

from quietblade.typing import AnyArray, FloatArray

_ROUNDING = 8.0 * float(np.finfo(float).eps)
_LOOSEST = 1e-4  # relative residual above which a solution is wrong, however large it is
_COLUMNS = 32  # right-hand sides refined together; bounds the memory
_PATIENCE = 6  # steps in a row that may fail to make the residual smaller


@dataclass(frozen=True)
class Refined:
    """Solution of a refinement, and what is known of it.

    Attributes
    ----------
    x : array (n, k)
        Solutions.
    residual : float
        Worst ``||A x - b|| / ||b||`` over the columns.
    steps : int
        Substitutions used, the first solve included.
    accepted : bool
        Whether each column reached the tolerance or the level of rounding.
    """

    x: AnyArray
    residual: float
    steps: int
    accepted: bool


def equilibration(A: csr_matrix, sweeps: int = 1) -> FloatArray:
    """Scales d for which the rows of diag(d) |A| diag(d) have largest entries near one.

    D. Ruiz, A scaling algorithm to equilibrate both rows and columns norms in matrices, Rutherford
    Appleton Laboratory report RAL-TR-2001-034.
    """
    filled = np.diff(A.indptr) > 0
    starts = A.indptr[:-1][filled]
    size = np.abs(A.data)
    scale = np.ones(A.shape[0])
    for _ in range(sweeps):
        largest = np.ones(A.shape[0])
        if size.size:
            largest[filled] = scale[filled] * np.maximum.reduceat(size * scale[A.indices], starts)
        largest[largest == 0.0] = 1.0
        scale /= np.sqrt(largest)
    return scale


@dataclass(frozen=True, eq=False)
class System:
    """A matrix with the row scales in which its residual is judged.

    The rows of a coupled system have different units, so that the plain norm sees one field only.
    Rows are divided by the square root of their largest entry, as in a symmetric equilibration.
    """

    A: csr_matrix
    scale: FloatArray

    @classmethod
    def of(cls, A: csr_matrix) -> "System":
        """Scale the rows of a canonical matrix."""
        return cls(A, equilibration(A))

    def rounding(self, x: AnyArray, b: AnyArray) -> FloatArray:
        """Scaled residual (k,) that rounding alone leaves: ``8 eps || |A| |x| + |b| ||``.

        A residual below it is exact for a matrix changed in its last digits (Oettli and Prager,
        Numerische Mathematik 6, 1964), so that no solver in double precision can do better.
        """
        size = abs(self.A) @ np.abs(x) + np.abs(b)
        return _ROUNDING * _norms(self.scale[:, None] * size)


def _norms(columns: AnyArray) -> FloatArray:
    return np.asarray(np.linalg.norm(columns, axis=0), dtype=float)


def refined(
    system: System,
    apply: Callable[[AnyArray], AnyArray],
    b: AnyArray,
    *,
    symmetric: bool,
    tolerance: float,
    steps: int,
) -> Refined:
    """Solve ``A x = b`` with an inexact inverse, to a residual that is measured.

    For a symmetric matrix, real or complex, these are conjugate orthogonal conjugate gradients
    (H. A. van der Vorst and J. B. M. Melissen, IEEE Trans. Magn. 26 (1990) 706-708) with the
    factor as preconditioner: with a good factor the first step is the plain solve and the next ones
    are iterative refinement; with a factor in single precision close to a resonance, where
    refinement diverges and minimal-residual methods stall, they still converge.  For other
    matrices it is plain refinement.

    Parameters
    ----------
    system : System
        The matrix in double precision.
    apply : callable
        The substitution ``b (n, k) -> x (n, k)``, symmetric if the matrix is.
    b : array (n, k)
        Right-hand sides.
    symmetric : bool
        Whether ``A = A^T``.
    tolerance : float
        Wanted ``||A x - b|| / ||b||`` of each column.
    steps : int
        Most substitutions allowed.
    """
    parts = [
        _refined_block(system, apply, b[:, first : first + _COLUMNS], symmetric, tolerance, steps)
        for first in range(0, b.shape[1], _COLUMNS)
    ]
    return Refined(
        np.concatenate([part.x for part in parts], axis=1),
        max(part.residual for part in parts),
        max(part.steps for part in parts),
        all(part.accepted for part in parts),
    )


def _refined_block(
    system: System,
    apply: Callable[[AnyArray], AnyArray],
    b: AnyArray,
    symmetric: bool,
    tolerance: float,
    steps: int,
) -> Refined:
    scale = system.scale[:, None]
    size = _norms(b)
    size[size == 0.0] = 1.0
    x = np.zeros(b.shape, dtype=np.result_type(system.A.dtype, b.dtype))
    direction = np.zeros_like(x)
    residual = b.astype(x.dtype)
    rho = np.zeros(b.shape[1], dtype=x.dtype)
    missed = np.ones(b.shape[1], dtype=bool)
    history: list[float] = []
    while len(history) < steps:
        z = apply(residual)
        if not np.isfinite(z).all():
            break
        rho_old, rho = rho, _products(residual, z)
        direction = z + _ratio(rho, rho_old) * direction if symmetric else z
        ahead = system.A @ direction
        length = _ratio(rho, _products(direction, ahead)) if symmetric else 1.0
        # A column that is good enough stays as it is: more steps would only stir its rounding.
        x += np.where(missed, length, 0.0) * direction
        residual = b - system.A @ x
        relative = _norms(residual) / size
        history.append(float(relative.max()))
        missed = relative > tolerance
        if missed.any():
            rounded = _norms(scale * residual) <= system.rounding(x, b)
            missed &= ~rounded | (relative > _LOOSEST)
        if not missed.any():
            if history[-1] > tolerance:
                x = _polished(system.A, apply, b, x)
            return Refined(x, history[-1], len(history), accepted=True)
        if len(history) > _PATIENCE and min(history[-_PATIENCE:]) >= min(history[:-_PATIENCE]):
            break
    return Refined(x, history[-1] if history else np.inf, len(history), accepted=False)


def _polished(
    A: csr_matrix, apply: Callable[[AnyArray], AnyArray], b: AnyArray, x: AnyArray
) -> AnyArray:
    """Refine with residuals in extended precision, where rounding ends what double can do.

    Close to a light resonance the solution is large and its own rounding hides the residual, but
    the solution still carries the resonance's amplification of that rounding. A step with an
    exact residual removes it (J. Demmel et al., ACM Trans. Math. Softw. 32 (2006) 325-351). Where
    extended precision is not wider than double it changes nothing.
    """
    wide = np.result_type(x.dtype, np.longdouble)
    residual = b - A.astype(wide) @ x.astype(wide)
    return np.asarray(x + apply(np.asarray(residual, dtype=x.dtype)))


def _products(left: AnyArray, right: AnyArray) -> AnyArray:
    """``l^T r`` of each pair of columns, without conjugation."""
    return np.asarray((left * right).sum(axis=0))


def _ratio(above: AnyArray, below: AnyArray) -> AnyArray:
    """``above / below``; zero where both vanish, as for a column that is solved or empty."""
    return np.asarray(np.where(below == 0.0, 0.0, above / np.where(below == 0.0, 1.0, below)))
