# SPDX-License-Identifier: LGPL-2.1-or-later
from dataclasses import dataclass, replace
from threading import Thread

import numpy as np
import pytest
import scipy.sparse as sp

from quietblade.errors import SolverError
from quietblade.linalg import make_solver
from quietblade.linalg.chain import SolverChain
from quietblade.linalg.pardiso import available
from quietblade.linalg.protocol import BackendFailed
from quietblade.linalg.refinement import equilibration
from quietblade.linalg.report import Level
from quietblade.linalg.rslab import Rslab
from quietblade.linalg.superlu import SuperLu

RNG = np.random.default_rng()
PROGRAMS = ["rslab", "superlu", *(["mkl-pardiso"] if available() else [])]


@pytest.fixture(autouse=True)
def _same_numbers_in_any_order():
    RNG.bit_generator.state = np.random.default_rng(7).bit_generator.state


def saddle(n=400, m=60, *, dtype=float, skew=0.0):
    """Indefinite block matrix with a zero block, as a mixed film or a wet pencil has."""
    K = sp.diags([-1.0, 2.5, -1.0], [-1, 0, 1], shape=(n, n)) * 1e4
    B = 1e2 * sp.random(m, n, density=0.2, random_state=RNG)
    A = sp.bmat([[K, B.T], [B, None]]).tocsr() + skew * sp.random(
        n + m, n + m, density=0.02, random_state=RNG
    )
    if np.issubdtype(dtype, np.complexfloating):
        A = A + 1j * sp.diags(1e3 * RNG.random(n + m))
    return sp.csr_matrix(A)


@pytest.mark.parametrize("program", PROGRAMS)
@pytest.mark.parametrize("precision", ["mixed", "double"])
@pytest.mark.parametrize("dtype", [float, complex])
@pytest.mark.parametrize("symmetric", [True, False])
def test_solution_agrees_with_dense(program, precision, dtype, symmetric):
    A = saddle(dtype=dtype, skew=0.0 if symmetric else 1e3)
    b = RNG.standard_normal((A.shape[0], 3)) + 1j * RNG.standard_normal((A.shape[0], 3))
    chain = make_solver(program, symmetric=symmetric, precision=precision, threads=1)
    factor = chain.factor(A)
    x = factor.solve(b)
    exact = np.linalg.solve(A.toarray(), b)
    assert np.linalg.norm(A @ x - b) < 2e-9 * np.linalg.norm(b)
    assert np.linalg.norm(x - exact) < 1e-7 * np.linalg.norm(exact)
    assert factor.residual == pytest.approx(
        max(np.linalg.norm(A @ x - b, axis=0) / np.linalg.norm(b, axis=0)), rel=0.9, abs=1e-14
    )
    assert factor.n == A.shape[0]
    assert factor.memory_bytes > 0
    assert chain.report().solves


def test_vector_real_zero_and_empty_right_hand_sides():
    A = saddle()
    factor = make_solver("rslab", threads=1).factor(A)
    b = RNG.standard_normal(A.shape[0])
    x = factor.solve(b)
    assert x.shape == b.shape
    assert x.dtype == np.float64
    assert not factor.solve(np.zeros(A.shape[0])).any()
    assert factor.solve(np.zeros((A.shape[0], 0))).shape == (A.shape[0], 0)


def test_many_columns_are_the_same_as_one_by_one():
    A = saddle(dtype=complex)
    factor = make_solver("rslab", threads=1).factor(A)
    B = RNG.standard_normal((A.shape[0], 35))
    together = factor.solve(B)
    alone = factor.solve(B[:, 20])
    np.testing.assert_allclose(together[:, 20], alone, rtol=1e-7, atol=1e-12 * np.abs(alone).max())


@pytest.mark.parametrize("program", [p for p in PROGRAMS if p != "superlu"])
def test_inertia_counts_eigenvalues(program):
    A = saddle(120, 25)
    values = np.linalg.eigvalsh(A.toarray())
    factor = make_solver(program, precision="double", threads=1).factor(A)
    assert factor.inertia == ((values > 0).sum(), (values < 0).sum(), 0)


def test_inertia_is_not_claimed_for_complex_or_single():
    assert make_solver("rslab", precision="double").factor(saddle(dtype=complex)).inertia is None
    assert make_solver("rslab", precision="mixed").factor(saddle()).inertia is None


def test_analysis_is_used_again_and_pattern_is_guarded():
    A = saddle()
    chain = make_solver("rslab", threads=1)
    analysis = chain.analyse(A)
    b = RNG.standard_normal(A.shape[0])
    first, second = analysis.factor(A), analysis.factor(3.0 * A)
    np.testing.assert_allclose(first.solve(b), 3.0 * second.solve(b), rtol=1e-7)
    with pytest.raises(SolverError, match="another pattern"):
        analysis.factor(sp.csr_matrix(A + sp.eye(A.shape[0])))
    # the chain itself analyses a new pattern without a word
    assert chain.factor(sp.csr_matrix(A + sp.eye(A.shape[0]))).n == A.shape[0]


def test_unsorted_and_duplicate_entries():
    A = saddle(50, 5).tocoo()
    order = RNG.permutation(A.nnz)
    rows, columns = A.row[order], A.col[order]
    doubled = sp.csr_matrix(
        (
            np.tile(A.data[order] / 2, 2),
            (np.tile(rows, 2), np.tile(columns, 2)),
        ),
        shape=A.shape,
    )
    b = RNG.standard_normal(A.shape[0])
    x = make_solver("rslab", threads=1).factor(doubled).solve(b)
    np.testing.assert_allclose(A @ x, b, rtol=1e-6, atol=1e-8)


def test_wrong_input_is_named():
    A = saddle()
    with pytest.raises(SolverError, match="not symmetric"):
        make_solver("rslab").factor(saddle(skew=1e3))
    with pytest.raises(SolverError, match="square"):
        make_solver("rslab").factor(sp.csr_matrix((3, 4)))
    bad = A.copy()
    bad.data[0] = np.nan
    with pytest.raises(SolverError, match="not finite in row 0"):
        make_solver("rslab").factor(bad)
    with pytest.raises(SolverError, match="does not fit"):
        make_solver("rslab").factor(A).solve(np.ones(3))
    with pytest.raises(SolverError, match="not finite"):
        make_solver("rslab").factor(A).solve(np.full(A.shape[0], np.inf))
    with pytest.raises(SolverError, match="unknown"):
        make_solver("umfpack")
    if not available():
        with pytest.raises(SolverError, match="pip install mkl"):
            make_solver("mkl-pardiso")


def test_singular_matrix_fails_with_every_reason():
    n = 60
    A = sp.csr_matrix(sp.diags([-1.0, 2.0, -1.0], [-1, 0, 1], shape=(n, n)).tolil())
    A = A.tolil()
    A[0, 0] = A[n - 1, n - 1] = 1.0  # a free chain: rigid motion costs nothing
    factor = None
    with pytest.raises(SolverError, match=r"rslab \(mixed\).*rslab \(double\).*superlu"):
        factor = make_solver("auto", threads=1).factor(sp.csr_matrix(A))
        factor.solve(np.arange(n) + 1.0)
    if factor is not None:
        with pytest.raises(SolverError, match="no factor is left"):
            factor.solve(np.ones(n))


def test_hard_matrix_goes_from_mixed_to_double():
    # condition number near 1e12: out of reach of a factor in single precision
    n = 80
    Q, _ = np.linalg.qr(RNG.standard_normal((n, n)))
    A = Q @ np.diag(np.geomspace(1e-12, 1.0, n)) @ Q.T
    A = sp.csr_matrix(0.5 * (A + A.T))
    chain = make_solver("rslab", threads=1)
    analysis = chain.analyse(A)
    b = A @ RNG.standard_normal(n)
    factor = analysis.factor(A)
    x = factor.solve(b)
    assert np.linalg.norm(A @ x - b) < 1e-8 * np.linalg.norm(b)
    assert factor.solver == "rslab (double)"
    fallback = chain.report().fallbacks[0]
    assert (fallback.left, fallback.entered) == ("rslab (mixed)", "rslab (double)")
    # after each failure single precision rests for twice as many factorisations
    tried = []
    for _ in range(9):
        factor = analysis.factor(A)
        tried.append(factor.solver)
        factor.solve(b)
    mixed = [index for index, name in enumerate(tried) if name == "rslab (mixed)"]
    assert mixed == [1, 4]
    assert "rslab (mixed) -> rslab (double)" in str(chain.report())


def test_single_precision_works_close_to_a_light_resonance():
    # plain refinement diverges here: the factor's error exceeds the distance from the pole
    n = 400
    K = sp.csr_matrix(sp.diags([-1.0, 2.0, -1.0], [-1, 0, 1], shape=(n, n)) * 1e6)
    s = 1e6 * (2.0 - 2.0 * np.cos(7 * np.pi / (n + 1)))
    A = sp.csr_matrix(K * (1.0 + 1e-4j) - s * sp.eye(n))
    b = RNG.standard_normal(n)
    factor = make_solver("rslab", threads=1).analyse(A).factor(A)
    raw = factor._factor.apply
    x = raw(b[:, None].astype(complex))
    for _ in range(5):
        x = x + raw(b[:, None] - A @ x)
    plain = np.linalg.norm(A @ x - b[:, None]) / np.linalg.norm(b)
    x = factor.solve(b)
    assert factor.solver == "rslab (mixed)"
    assert np.linalg.norm(A @ x - b) < min(1e-6, 0.01 * plain) * np.linalg.norm(b)
    exact = np.linalg.solve(A.toarray(), b)
    np.testing.assert_allclose(x, exact, atol=1e-6 * np.abs(exact).max())


def test_equilibration_brings_rows_near_one():
    scales = 10.0 ** RNG.uniform(-6, 6, 80)
    A = sp.random(80, 80, density=0.1, random_state=RNG) + sp.eye(80)
    A = sp.csr_matrix(sp.diags(scales) @ (A + A.T) @ sp.diags(scales))
    d = equilibration(A, sweeps=10)
    largest = abs(sp.diags(d) @ A @ sp.diags(d)).max(axis=1).toarray()
    assert largest.min() > 0.5
    assert largest.max() < 2.0
    np.testing.assert_array_equal(equilibration(sp.csr_matrix((4, 4)), 3), np.ones(4))


@dataclass(frozen=True)
class Liar:
    """A program whose substitution is wrong, or which refuses."""

    refuses: bool
    name: str = "liar"
    inertia: None = None
    memory_bytes: int = 0

    def analyse(self, A):
        return self

    def factor(self, A, *, single):
        if self.refuses:
            raise BackendFailed("no memory")
        return self

    def apply(self, b):
        return np.roll(b, 1, axis=0)


@pytest.mark.parametrize("refuses", [True, False])
def test_wrong_solver_is_found_out(refuses):
    A = saddle()
    chain = make_solver("superlu")
    chain = replace(chain, levels=(Level(Liar(refuses), single=False), *chain.levels))
    b = RNG.standard_normal(A.shape[0])
    factor = chain.factor(A)
    x = factor.solve(b)
    assert np.linalg.norm(A @ x - b) < 1e-8 * np.linalg.norm(b)
    (fallback,) = chain.report().fallbacks
    assert fallback.entered == "superlu (double)"
    assert ("no memory" if refuses else "residual") in fallback.reason
    alone = SolverChain("liar", (Level(Liar(refuses), single=False),), True, 1e-9)
    with pytest.raises(SolverError, match="none could solve"):
        alone.factor(A).solve(b)


def test_rounding_level_is_accepted_where_the_residual_cannot_be_small():
    # entries of 1e14 against loads of 1: ||A|| ||x|| eps exceeds 1e-9 ||b||
    n = 300
    K = sp.diags([-1.0, 2.0, -1.0], [-1, 0, 1], shape=(n, n)).tolil()
    K[n - 1, n - 1] = 1.0
    b = np.ones(n)
    A = sp.csr_matrix(K) * 1e14
    chain = make_solver("rslab", precision="double", tolerance=1e-15, threads=1)
    x = chain.factor(A).solve(b)
    exact = (n * (n + 1) / 2 - np.arange(n)[::-1] * (np.arange(n)[::-1] + 1) / 2) / 1e14
    np.testing.assert_allclose(x, exact, rtol=1e-9)
    assert not chain.report().fallbacks


def test_threads_share_an_analysis():
    A = saddle(dtype=complex)
    chain = make_solver("rslab", threads=1)
    analysis = chain.analyse(A)
    b = RNG.standard_normal(A.shape[0])
    found = {}

    def work(scale):
        found[scale] = analysis.factor(scale * A).solve(b)

    workers = [Thread(target=work, args=(scale,)) for scale in (1.0, 2.0, 4.0, 8.0)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    for scale, x in found.items():
        np.testing.assert_allclose(scale * x, found[1.0], rtol=1e-6)
    assert sum(chain.report().factorizations.values()) == 4


def test_backends_stand_alone():
    A = saddle()
    b = RNG.standard_normal((A.shape[0], 2))
    for backend in (Rslab(True, 1), SuperLu(True)):
        x = backend.analyse(A).factor(A, single=False).apply(b)
        assert np.linalg.norm(A @ x - b) < 1e-6 * np.linalg.norm(b)
