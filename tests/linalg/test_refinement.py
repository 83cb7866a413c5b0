# SPDX-License-Identifier: LGPL-2.1-or-later
import numpy as np
import pytest
from scipy.sparse import csr_matrix, diags_array
from scipy.sparse.linalg import splu

from quietblade.linalg import make_solver

wide = pytest.mark.skipif(
    np.finfo(np.longdouble).eps > 1e-18, reason="extended precision is not wider than double here"
)


def needle(n: int = 300, loss: float = 1e-8) -> csr_matrix:
    """A chain of masses, driven at its hundredth resonance, with hardly any loss."""
    stiffness = diags_array([-1.0, 2.0, -1.0], offsets=[-1, 0, 1], shape=(n, n)) * 1e6
    resonance = 4e6 * np.sin(0.5 * np.pi * 100 / (n + 1)) ** 2
    shift = resonance * (1.0 - 1j * loss) * diags_array(np.ones(n))
    return csr_matrix(stiffness.astype(complex) - shift)


def by_elimination(A: csr_matrix, b: np.ndarray) -> np.ndarray:
    """Solution of a tridiagonal system in extended precision (Thomas' algorithm)."""
    n = len(b)
    main, side = (A.diagonal(k).astype(np.clongdouble) for k in (0, 1))
    right = b.astype(np.clongdouble)
    for i in range(1, n):
        factor = side[i - 1] / main[i - 1]
        main[i] -= factor * side[i - 1]
        right[i] -= factor * right[i - 1]
    x = np.zeros(n, dtype=np.clongdouble)
    x[-1] = right[-1] / main[-1]
    for i in range(n - 2, -1, -1):
        x[i] = (right[i] - side[i] * x[i + 1]) / main[i]
    return x


@wide
def test_exact_residuals_remove_the_rounding_that_a_resonance_amplifies() -> None:
    A, b = needle(), np.zeros(300, dtype=complex)
    b[7] = 1.0
    exact = by_elimination(A, b)
    plain = splu(A.tocsc()).solve(b)
    found = make_solver(precision="double", tolerance=1e-12).factor(A).solve(b)
    size = np.linalg.norm(exact.astype(complex))
    errors = [float(np.linalg.norm((x - exact).astype(complex))) / size for x in (plain, found)]
    assert errors[1] < 1e-3 * errors[0]
