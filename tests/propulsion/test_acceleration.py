# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fixed points of arrays: linear maps with known eigenvalues, and the bar in torsion."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from quietblade.propulsion.acceleration import (
    Aitken,
    Anderson,
    Method,
    Plain,
    SecantModel,
    make_accelerator,
    relative,
    solve_fixed_point,
)
from quietblade.typing import FloatArray
from verification.flow_coupling import (
    SHARES,
    direct_twist,
    iteration_table,
    plain_passes,
    solve_bar,
)
from verification.flow_coupling_models import TorsionBar, bar_at, divergence_pressure

ACCELERATED: tuple[Method, ...] = ("aitken", "anderson")


class Linear:
    """x -> A x + b with given eigenvalues in random, not orthogonal directions."""

    def __init__(self, eigenvalues: list[float], size: int = 12, seed: int = 0) -> None:
        random = np.random.default_rng(seed)
        values = np.zeros(size)
        values[: len(eigenvalues)] = eigenvalues
        shapes = np.eye(size) + 0.2 * random.normal(size=(size, size))
        self.matrix = shapes @ np.diag(values) @ np.linalg.inv(shapes)
        self.shift = random.normal(size=size)
        self.solution = np.linalg.solve(np.eye(size) - self.matrix, self.shift)

    def __call__(self, x: FloatArray) -> FloatArray:
        return self.matrix @ x + self.shift

    def error(self, x: FloatArray) -> float:
        return float(np.linalg.norm(x - self.solution) / np.linalg.norm(x))


@pytest.mark.parametrize("method", ["fixed-point", *ACCELERATED])
def test_contraction_is_solved_to_the_estimated_error(method: Method) -> None:
    image = Linear([0.6, -0.3, 0.1])
    run = solve_fixed_point(image, np.zeros(12), method=method, tolerance=1e-8)
    assert run.converged
    assert image.error(run.x) < 3e-8
    assert run.eigenvalue.real == pytest.approx(0.6, abs=0.01)


@settings(max_examples=40, deadline=None)
@given(
    rates=st.lists(st.floats(-4.0, 0.9), min_size=1, max_size=4),
    seed=st.integers(0, 1000),
)
def test_anderson_solves_what_the_plain_iteration_cannot(rates: list[float], seed: int) -> None:
    image = Linear(rates, seed=seed)
    run = solve_fixed_point(image, np.zeros(12), method="anderson", tolerance=1e-7)
    assert run.converged
    assert len(run.history) <= 25
    assert image.error(run.x) < 1e-5


@pytest.mark.parametrize("method", ACCELERATED)
@pytest.mark.parametrize("share", [-3.0, -1.2, 0.95])
def test_accelerated_bar(method: Method, share: float) -> None:
    bar = bar_at(share)
    run = solve_bar(bar, method, tolerance=1e-8, stop="error")
    exact = direct_twist(bar)
    assert run.converged
    assert np.linalg.norm(run.x - exact) < 1e-6 * np.linalg.norm(exact)
    assert run.eigenvalue.real == pytest.approx(bar.eigenvalue, rel=1e-3)


def test_table_of_iterations() -> None:
    """As in the notes of every coupling code: plain slows towards 1 and fails beyond -1."""
    counts = iteration_table()
    plain = [counts[share]["fixed-point"] for share in SHARES]
    assert plain[:5] == sorted(n for n in plain[:5] if n is not None)
    assert [share for share in SHARES if counts[share]["fixed-point"] is None] == [
        -0.95,
        -1.2,
        -3.0,
    ]
    for method, most in (("aitken", 10), ("anderson", 9)):
        assert all((counts[share][method] or 99) <= most for share in SHARES)


@pytest.mark.parametrize("rate", [0.1, 0.3, 0.46, 0.6, 0.8])
def test_passes_of_the_plain_iteration_follow_its_rate(rate: float) -> None:
    passes = len(solve_bar(bar_at(rate), "fixed-point").history)
    assert abs(passes - plain_passes(rate, 1e-5)) <= 1


def test_change_is_a_poor_stop_near_divergence_and_the_estimate_says_so() -> None:
    bar = bar_at(0.95)
    exact = direct_twist(bar)
    by_change = solve_bar(bar, "fixed-point")
    true = np.linalg.norm(by_change.x - exact) / np.linalg.norm(exact)
    assert by_change.converged
    assert true > 1e-4
    assert by_change.history[-1].error == pytest.approx(true, rel=1e-2)
    by_error = solve_fixed_point(
        bar.image, np.zeros(40), method="fixed-point", stop="error", max_iterations=300
    )
    assert np.linalg.norm(by_error.x - exact) < 1.1e-5 * np.linalg.norm(exact)


def test_iteration_that_is_used_up_or_runs_away_is_not_converged() -> None:
    bar = bar_at(-3.0)
    run = solve_fixed_point(bar.image, np.zeros(40), method="fixed-point", max_iterations=7)
    assert not run.converged
    assert len(run.history) == 7
    assert run.history[-1].ratio == pytest.approx(3.0, rel=1e-3)

    def explode(x: FloatArray) -> FloatArray:
        return np.full_like(x, np.inf) if x.any() else x + 1.0

    assert not solve_fixed_point(explode, np.zeros(3), method="fixed-point").converged


def test_map_that_is_solved_at_once() -> None:
    run = solve_fixed_point(lambda x: np.ones(3), np.ones(3))
    assert run.converged
    assert len(run.history) == 1
    assert run.history[0].error == 0.0


def test_shape_of_the_array_is_kept() -> None:
    run = solve_fixed_point(lambda x: 0.5 * x + 1.0, np.zeros((4, 3)))
    np.testing.assert_allclose(run.x, 2.0)
    assert run.x.shape == (4, 3)


def test_model_leaves_out_what_brings_nothing_new() -> None:
    a, b = np.array([1.0, 0.0, 0.0]), np.array([1.0, 1e-7, 0.0])
    model = SecantModel([a, b, np.zeros(3)], [2.0 * a, 2.0 * b, a])
    assert model.kept == (0,)
    assert model.dominant == pytest.approx(2.0)
    np.testing.assert_allclose(model.image(np.array([3.0, 1.0, 0.0])), [6.0, 0.0, 0.0])
    assert np.isnan(SecantModel([], []).dominant.real)
    assert SecantModel([], []).beyond(a, 0.5) == np.inf


def test_rules() -> None:
    x, image = np.zeros(2), np.array([1.0, 2.0])
    for rule in (Plain(), Aitken(), Anderson()):
        np.testing.assert_allclose(rule.propose(x, image), image)  # the first step is plain
    np.testing.assert_allclose(Plain(0.5).propose(x, image), 0.5 * image)
    with pytest.raises(ValueError, match="'aitken'"):
        make_accelerator("broyden")  # type: ignore[arg-type]
    assert relative(0.0, x) == 0.0
    assert relative(1.0, x) == np.inf


def test_bar_diverges_where_the_textbook_says() -> None:
    bar = TorsionBar(stations=200)
    assert bar.share == pytest.approx(bar.eigenvalue, rel=1e-4)
    q = divergence_pressure(bar.stiffness, bar.arm, bar.chord, bar.slope, bar.length)
    assert q * bar.share == pytest.approx(bar.pressure)
    np.testing.assert_allclose(direct_twist(bar), bar.exact_twist(), rtol=1e-4)
