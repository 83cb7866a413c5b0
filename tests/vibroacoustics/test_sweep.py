# SPDX-License-Identifier: LGPL-2.1-or-later
"""Direct sweep against dense solutions, and grids that resolve needles."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from quietblade.errors import SolverError
from quietblade.linalg import make_solver
from quietblade.typing import ComplexArray
from quietblade.vibroacoustics.complex_modes import complex_modes
from quietblade.vibroacoustics.grid import refined_grid
from quietblade.vibroacoustics.modes import wet_modes
from quietblade.vibroacoustics.operators import Operators
from quietblade.vibroacoustics.power import power_budget
from quietblade.vibroacoustics.sweep import solve_response, sweep

from .small_systems import random_operators

FREQUENCIES = np.array([20.0, 3.0, 11.0, 7.5])


def load_on(operators: Operators, count: int | None = None) -> np.ndarray:
    rng = np.random.default_rng(3)
    load = np.zeros((operators.size,) if count is None else (count, operators.size))
    load[..., operators.blocks.u] = rng.standard_normal((*load.shape[:-1], len(operators.blocks.u)))
    return load


@pytest.mark.parametrize("workers", [1, 2])
@pytest.mark.parametrize("count", [None, 3])
def test_response_is_that_of_dense_solves(workers: int, count: int | None) -> None:
    operators = random_operators()
    load = load_on(operators, count)
    messages: list[tuple[str, float | None, str]] = []
    response = solve_response(
        operators,
        FREQUENCIES,
        load,
        workers=workers,
        progress=lambda *said: messages.append(said),
    )
    assert response.solution is not None
    for frequency, solution in zip(FREQUENCIES, response.solution, strict=True):
        exact = np.linalg.solve(operators.at(2.0 * np.pi * frequency).toarray(), load.T).T
        np.testing.assert_allclose(solution, exact, atol=1e-8 * np.abs(exact).max())
    assert response.residual.max() < 1e-8
    assert not response.failures
    assert [said[1] for said in messages] == [0.25, 0.5, 0.75, 1.0]
    assert "left" in messages[0][2]
    np.testing.assert_allclose(response.omega, 2.0 * np.pi * FREQUENCIES)
    assert sum(response.report.factorizations.values()) == 4


def test_points_come_in_the_order_asked_for() -> None:
    operators = random_operators()
    points = list(sweep(operators, FREQUENCIES, load_on(operators), workers=2))
    assert [point.frequency for point in points] == FREQUENCIES.tolist()
    assert all(point.solver.startswith("rslab") for point in points)


def test_observer_keeps_only_what_is_asked() -> None:
    operators = random_operators()
    load = load_on(operators)
    stored = solve_response(operators, FREQUENCIES, load)
    assert stored.solution is not None

    def observe(frequency: float, solution: ComplexArray) -> dict[str, np.ndarray | complex]:
        return {"tip": complex(solution[0]), "few": solution[:3], "twice": 2.0 * frequency}

    response = solve_response(operators, FREQUENCIES, load, observe=observe)
    assert response.solution is None
    np.testing.assert_allclose(response.observed["tip"], stored.solution[:, 0])
    np.testing.assert_allclose(response.observed["few"], stored.solution[:, :3])
    np.testing.assert_allclose(response.observed["twice"], 2.0 * FREQUENCIES)


class Fragile(Operators):
    """Operators that are singular at one frequency."""

    def at(self, omega: complex) -> sp.csr_matrix:
        matrix = super().at(omega)
        return 0.0 * matrix if abs(omega - 2.0 * np.pi * 11.0) < 1e-6 else matrix


def test_failed_frequency_is_recorded_and_not_fatal() -> None:
    good = random_operators()
    fragile = Fragile(**{name: getattr(good, name) for name in good.__dataclass_fields__})
    load = load_on(good)
    solver = make_solver("rslab", threads=1)
    response = solve_response(fragile, FREQUENCIES, load, solver=solver)
    assert response.solution is not None
    assert list(response.failures) == [11.0]
    assert "rslab" in response.failures[11.0]
    assert np.isnan(response.residual[2])
    assert np.isnan(response.solution[2]).all()
    assert np.isfinite(response.solution[[0, 1, 3]]).all()
    with pytest.raises(SolverError, match="none of 1 frequencies"):
        solve_response(fragile, np.array([11.0]), load, solver=solver)


def test_grid_resolves_a_needle() -> None:
    operators = random_operators(loss=1e-4)
    terms = {name: term for name, term in operators.terms.items() if name != "Q"}
    operators = replace(operators, terms={**terms, "Q": 0.001 * operators.terms["Q"]})
    modes = wet_modes(operators, 30.0)
    needles = complex_modes(operators, modes, (8.0, 18.0))
    assert needles.loss_factor.min() < 1e-3
    frequencies = refined_grid((8.0, 18.0), 1.0, (needles.frequency, needles.loss_factor))
    load = load_on(operators)
    response = solve_response(operators, frequencies, load)
    assert response.solution is not None
    budget = power_budget(operators, response.omega, response.solution, load)
    level = 10.0 * np.log10(budget.injected)
    # The peak in the grid is the peak of a grid a hundred times finer, within 0.05 dB.
    for frequency, loss in zip(needles.frequency, needles.loss_factor, strict=True):
        width = frequency * loss
        fine = frequency + width * np.linspace(-1.0, 1.0, 201)
        exact = solve_response(operators, fine, load)
        assert exact.solution is not None
        injected = power_budget(operators, exact.omega, exact.solution, load).injected
        peak = 10.0 * np.log10(injected.max())
        there = np.abs(frequencies - frequency) < width
        assert level[there].max() == pytest.approx(peak, abs=0.05)
        # at least three points within the half-power width
        assert np.sum(level[there] > peak - 3.1) >= 3
    assert budget.residual.max() < 1e-6


@settings(max_examples=60, deadline=None)
@given(
    low=st.floats(10.0, 200.0),
    span=st.floats(0.0, 150.0),
    step=st.floats(0.2, 20.0),
    modes=st.lists(st.tuples(st.floats(5.0, 400.0), st.floats(-0.01, 0.3)), max_size=6),
    points=st.integers(1, 25),
)
def test_grid_is_ascending_within_the_band_and_holds_the_peaks(
    low: float, span: float, step: float, modes: list[tuple[float, float]], points: int
) -> None:
    band = (low, low + span)
    pairs = np.array(modes).reshape(-1, 2)
    grid = refined_grid(band, step, (pairs[:, 0], pairs[:, 1]), points)
    assert grid[0] == band[0]
    assert grid[-1] == band[1]
    assert (np.diff(grid) > 0.0).all()
    assert np.diff(grid).max(initial=0.0) <= step * (1.0 + 1e-9)
    inside = pairs[(pairs[:, 0] >= band[0]) & (pairs[:, 0] <= band[1]), 0]
    assert np.isin(inside, grid).all()


def test_grid_without_modes_and_wrong_input() -> None:
    np.testing.assert_allclose(refined_grid((100.0, 200.0), 25.0), [100, 125, 150, 175, 200])
    np.testing.assert_allclose(refined_grid((100.0, 200.0), 30.0), [100, 125, 150, 175, 200])
    np.testing.assert_allclose(refined_grid((100.0, 100.0), 30.0), [100])
    for band, step in (((200.0, 100.0), 1.0), ((0.0, 10.0), 1.0), ((1.0, 2.0), 0.0)):
        with pytest.raises(ValueError, match="no grid"):
            refined_grid(band, step)


def test_points_of_a_mode_are_dense_at_the_peak() -> None:
    frequency, loss = 152.4, 1e-4
    grid = refined_grid((100.0, 200.0), 1.0, (np.array([frequency]), np.array([loss])), 15)
    assert frequency in grid
    around = np.sort(np.abs(grid - frequency))
    half_width = 0.5 * frequency * loss
    assert np.sum(around <= 1.01 * half_width) >= 3
    # level of the needle between neighbours, 10 log10(1 + (d / half width)^2): steps under 8 dB
    level = 10.0 * np.log10(1.0 + ((grid - frequency) / half_width) ** 2)
    near = np.abs(grid - frequency) < 1.5
    assert np.abs(np.diff(level[near])).max() < 8.0
