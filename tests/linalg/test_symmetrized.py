# SPDX-License-Identifier: LGPL-2.1-or-later
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse import csr_matrix, diags, random_array

from quietblade.errors import SolverError
from quietblade.linalg import make_nearly_symmetric_solver


def matrix(n: int, skew: float, seed: int, shift: float = 0.0) -> csr_matrix:
    """Symmetric matrix of unit size with some negative eigenvalues, plus a skew part."""
    generator = np.random.default_rng(seed)
    part = random_array((n, n), density=0.05, rng=generator, data_sampler=generator.standard_normal)
    part = csr_matrix(part)
    signs = np.where(np.arange(n) < n // 4, -1.0, 1.0)
    symmetric = 0.02 * (part + part.T) + diags(signs * (1.0 + generator.random(n)) + shift)
    return csr_matrix(symmetric + skew * (part - part.T))


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 1000), st.sampled_from([0.0, 1e-12, 1e-3, 0.1, 10.0]))
def test_any_skew_part_is_solved(seed: int, skew: float) -> None:
    solver, A = make_nearly_symmetric_solver(), matrix(60, skew, seed)
    b = np.random.default_rng(seed).standard_normal((60, 2))
    factor = solver.factor(A)
    x = factor.solve(b)
    assert np.linalg.norm(A @ x - b) < 1e-7 * np.linalg.norm(b)
    assert factor.solve(b[:, 0]) == pytest.approx(x[:, 0], rel=1e-6, abs=1e-9)
    assert factor.residual < 1e-7


@settings(max_examples=10, deadline=None)
@given(st.integers(0, 1000), st.sampled_from([0.0, 1e-3, 0.1]))
def test_an_accuracy_of_the_solution_takes_fewer_substitutions(seed: int, skew: float) -> None:
    A = matrix(60, skew, seed)
    b = np.random.default_rng(seed).standard_normal(60)
    solver = make_nearly_symmetric_solver(accuracy=1e-5)
    exact, factor = np.linalg.solve(A.toarray(), b), solver.factor(A)
    assert np.linalg.norm(factor.solve(b) - exact) < 1e-3 * np.linalg.norm(exact)
    assert factor.residual <= 1e-5
    assert solver.report().fallbacks == ()


def test_inertia_is_that_of_the_symmetric_part() -> None:
    A = matrix(80, 0.05, 3)
    positive, negative, zero = make_nearly_symmetric_solver().factor(A).inertia or (0, 0, 0)
    values = np.linalg.eigvalsh(0.5 * (A + A.T).toarray())
    assert (positive, negative, zero) == ((values > 0).sum(), (values < 0).sum(), 0)


def test_a_large_skew_part_takes_the_whole_matrix_and_says_so() -> None:
    solver, A = make_nearly_symmetric_solver(), matrix(300, 30.0, 5)
    x = solver.factor(A).solve(np.ones(300))
    assert np.linalg.norm(A @ x - 1.0) < 1e-6
    fallbacks = solver.report().fallbacks
    assert len(fallbacks) == 1
    assert "symmetric part" in fallbacks[0].left
    assert "Krylov" in fallbacks[0].reason
    assert sum(solver.report().factorizations.values()) == 2


def test_the_analysis_of_a_pattern_is_used_again() -> None:
    solver, A = make_nearly_symmetric_solver(), matrix(200, 0.01, 7)
    solver.factor(A)
    first = solver.symmetric._last[0]
    B = A.copy()
    B.data = 1.1 * B.data
    solver.factor(B)
    assert solver.symmetric._last[0] is first
    solver.factor(matrix(200, 0.01, 8))
    assert solver.symmetric._last[0] is not first


def test_a_pattern_that_is_not_symmetric_is_refused() -> None:
    A = csr_matrix(np.array([[1.0, 2.0], [0.0, 1.0]]))
    with pytest.raises(SolverError, match="pattern of the matrix is not symmetric"):
        make_nearly_symmetric_solver().factor(A)
