# SPDX-License-Identifier: LGPL-2.1-or-later
"""What eigenvalues and histories are taken to mean."""

import numpy as np
import pytest

from quietblade.propulsion.coupling_problem import CouplingStep
from quietblade.propulsion.divergence import (
    Divergence,
    classify,
    divergence_ratio,
    southwell,
    suspicious,
)
from verification.flow_coupling import solve_bar
from verification.flow_coupling_models import bar_at


def history(*eigenvalues: complex, fraction: float = 1.0) -> tuple[CouplingStep, ...]:
    tip = np.zeros(3)
    return tuple(
        CouplingStep(k, 0.1, 0.5, tip, 1.0, (), 0.0, fraction, 0.1, value)
        for k, value in enumerate(eigenvalues, 1)
    )


def test_only_positive_real_eigenvalues_diverge() -> None:
    assert divergence_ratio(np.array([0.5, -3.0, 0.1 + 2.0j])) == pytest.approx(2.0)
    assert divergence_ratio(np.array([-3.0, 0.1 + 2.0j])) == np.inf
    assert divergence_ratio(np.array([-3.0, 1e-3])) == np.inf  # not resolved beside -3
    assert divergence_ratio(np.array([0.25]), fraction=0.5) == pytest.approx(2.0)
    assert divergence_ratio(np.array([complex(np.nan)])) == np.inf
    found = Divergence(np.array([-2.0, 0.5]))
    assert found.rate == 2.0
    assert found.pressure_ratio == pytest.approx(2.0)


def test_kinds() -> None:
    nan = complex(np.nan)
    assert classify(history(nan, 0.4), True) == "steady"
    assert classify(history(nan), True) == "steady"
    assert classify(history(nan), False) == "unresolved"
    assert classify(history(-0.5, -3.0), True) == "wash-out"
    assert classify(history(1.2 + 0.9j), True) == "wash-out"
    assert classify(history(0.5, 1.2), True) == "divergence"
    assert classify(history(0.5, 1.2), False) == "divergence"
    assert classify(history(0.4), False) == "unresolved"


def test_undeformed_blade_decides_what_steps_cannot_tell() -> None:
    beyond, outside = Divergence(np.array([1.3])), Divergence(np.array([-3.0, 0.5]))
    within = Divergence(np.array([0.6]))
    assert classify(history(0.4), True, beyond) == "post-divergence"
    assert classify(history(0.4), True, within) == "steady"
    assert classify(history(1.2), True, beyond) == "divergence"
    assert classify(history(0.4), False, beyond) == "divergence"
    assert classify(history(-0.9), False, outside) == "wash-out"
    assert classify(history(0.4), False, within) == "unresolved"
    assert suspicious(history(0.2, 0.6, 0.1))
    assert suspicious(history(0.3, fraction=0.5))
    assert not suspicious(history(complex(np.nan), 0.4, -3.0))


@pytest.mark.parametrize(
    ("share", "kind"), [(0.5, "steady"), (-1.2, "wash-out"), (1.1, "post-divergence")]
)
def test_bars_are_told_apart(share: float, kind: str) -> None:
    """The softening bar beyond divergence finds an equilibrium, and is known all the same."""
    bar = bar_at(share, softening=0.5)
    run = solve_bar(bar, "anderson", stop="error")
    assert run.converged
    way = history(*(line.eigenvalue for line in run.history))
    assert suspicious(way) == (share > 0.5)
    assert classify(way, True, Divergence(np.array([bar.eigenvalue]))) == kind


def test_southwell() -> None:
    q = np.array([0.2, 0.5, 0.7])
    np.testing.assert_allclose(southwell(q, 0.3 * q / (1.0 - q / 1.7)), 1.7)
    assert southwell(q, q / (1.0 + q)) < 0.0  # stiffening: no divergence
    with pytest.raises(ValueError, match="two"):
        southwell(q[:1], q[:1])
