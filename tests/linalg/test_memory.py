# SPDX-License-Identifier: LGPL-2.1-or-later
import re
from pathlib import Path

import numpy as np
import pytest
from scipy.sparse import csr_matrix

from quietblade.errors import SolverError
from quietblade.linalg import make_solver, memory
from quietblade.linalg.memory import available_memory


def test_a_factor_that_does_not_fit_is_refused_before_it_is_made(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    system = csr_matrix(np.eye(50) + 0.1)
    solver = make_solver(precision="double")
    monkeypatch.setattr(memory, "available_memory", lambda: 10_000)
    with pytest.raises(SolverError, match=re.escape("50 unknowns needs")) as refused:
        solver.factor(system)
    assert "1e-05 GB of memory are free; use larger cells (mesh.size)" in str(refused.value)
    assert not solver.report().factorizations  # nor did another program try
    monkeypatch.setattr(memory, "available_memory", lambda: None)  # unknown: no reason to refuse
    np.testing.assert_allclose(system @ solver.factor(system).solve(np.ones(50)), np.ones(50))


def test_what_the_system_tells(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "meminfo"
    monkeypatch.setattr(memory, "_MEMINFO", file)
    assert available_memory() is None
    file.write_text("MemTotal:       24000000 kB\nMemAvailable:   12000000 kB\n", encoding="ascii")
    assert available_memory() == 12_288_000_000


def test_the_prediction_bounds_the_factor() -> None:
    """A dense system: LDL^T of n unknowns has n (n + 1) / 2 entries."""
    from quietblade.linalg.rslab import Rslab  # noqa: PLC0415

    n = 400
    analysis = Rslab(symmetric=True, threads=1).analyse(csr_matrix(np.eye(n) + 0.1))
    plan = analysis.symbolic.memory_plan("float64")
    assert plan["factor_bytes"] > 8 * n * (n + 1) / 2
    assert plan["peak_bytes"] - plan["analysis_bytes"] < 8 * 8 * n * n
