# SPDX-License-Identifier: LGPL-2.1-or-later
"""Grid convergence index against the published example, and its limits."""

import numpy as np
import pytest

from quietblade.results.study_convergence import grid_convergence

# Celik et al., J. Fluids Eng. 130 (2008) 078001, table 1: cells in two dimensions, values on the
# three meshes, then p, extrapolated value, and e_a, e_ext and index in per cent
CELIK = {
    "reattachment length": (
        (18000, 8000, 4500), (6.063, 5.972, 5.863), 1.53, 6.1685, 1.5, 1.7, 2.2, "monotonic",
    ),
    "velocity, p < 1": (
        (18000, 4500, 980), (10.7880, 10.7250, 10.6050), 0.75, 10.8801, 0.6, 0.9, 1.1, "monotonic",
    ),
    "velocity, oscillatory": (
        (18000, 4500, 980), (6.0042, 5.9624, 6.0909), 1.51, 6.0269, 0.7, 0.4, 0.5, "oscillatory",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", CELIK)
def test_published_example(name: str) -> None:
    cells, values, order, extrapolated, change, error, index, behaviour = CELIK[name]
    found = grid_convergence([n**-0.5 for n in cells], values, clip=False)
    assert found.behaviour == behaviour
    assert found.order == pytest.approx(order, abs=0.006)
    assert found.extrapolated == pytest.approx(extrapolated, abs=2e-4)
    assert 100 * found.relative_error == pytest.approx(change, abs=0.05)
    assert 100 * found.extrapolated_error == pytest.approx(error, abs=0.06)
    assert 100 * found.index == pytest.approx(index, abs=0.06)


@pytest.mark.parametrize("order", [1.0, 2.0, 3.5])
def test_power_law_is_found_exactly(order: float) -> None:
    sizes = np.array([1.0, 1.3, 1.9])
    found = grid_convergence(sizes, 7.0 - 0.2 * sizes**order)
    assert found.order == pytest.approx(order, abs=1e-6)
    assert found.extrapolated == pytest.approx(7.0, rel=1e-9)
    assert found.uncertainty == pytest.approx(1.25 * 0.2, rel=1e-6)


def test_values_that_drift_apart_have_no_order_and_are_not_called_accurate() -> None:
    found = grid_convergence([1.0, 2.0, 4.0], [1.0, 1.5, 1.6])
    assert found.behaviour == "diverging"
    assert np.isnan(found.order)
    assert found.uncertainty >= 0.5


def test_lucky_orders_do_not_make_the_index_vanish() -> None:
    # the finer pair hardly differs by chance: an order of 13 would claim an error of 1e-7
    found = grid_convergence([1.0, 2.0, 4.0], [1.0, 1.0001, 2.0])
    assert found.order > 10.0
    assert found.uncertainty == pytest.approx(1.25 * 1e-4 / (2.0**4 - 1.0))


def test_same_values_are_settled() -> None:
    found = grid_convergence([1.0, 2.0, 4.0], [3.0, 3.0, 3.0])
    assert (found.behaviour, found.uncertainty) == ("settled", 0.0)


@pytest.mark.parametrize("sizes", [(2.0, 1.0, 3.0), (1.0, 1.0, 2.0), (0.0, 1.0, 2.0)])
def test_sizes_must_ascend(sizes: tuple[float, float, float]) -> None:
    with pytest.raises(ValueError, match="do not ascend"):
        grid_convergence(sizes, (1.0, 2.0, 3.0))


def test_missing_value_is_refused() -> None:
    with pytest.raises(ValueError, match="not finite"):
        grid_convergence((1.0, 2.0, 3.0), (1.0, np.nan, 3.0))
