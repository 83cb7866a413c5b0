# SPDX-License-Identifier: LGPL-2.1-or-later
"""The quick reference checks, each as a test; and the runner's own bookkeeping."""

import json
import math
from pathlib import Path

import pytest

from verification.registry import Check, Row
from verification.run import load_checks, merge, run, select

CHECKS = load_checks()
QUICK = select(CHECKS, quick=True, only="")


def test_there_are_quick_checks() -> None:
    assert QUICK, "no quick reference check is registered"


@pytest.mark.parametrize("check", QUICK, ids=lambda check: check.id)
def test_quick_check(check: Check) -> None:
    row = check.run()
    assert row.passed, (
        f"{row.quantity}: {row.value:.9g} against {row.reference:.9g} +- {row.tolerance:.2g} "
        f"({row.source})"
    )


def test_ids_name_their_part() -> None:
    parts = {"structure", "flow", "acoustics", "paper", "runs"}
    assert {name.split("/")[0] for name in CHECKS} <= parts


def test_an_error_is_a_failure_without_a_value(capsys: pytest.CaptureFixture[str]) -> None:
    def broken() -> float:
        raise ZeroDivisionError("nothing to divide by")

    row = run(Check("flow/broken", "q", 1.0, "s", 0.1, broken))
    assert not row.passed
    assert math.isnan(row.value)
    assert "nothing to divide by" in capsys.readouterr().err


def test_record_keeps_old_rows_and_drops_unknown_ones(tmp_path: Path) -> None:
    path = tmp_path / "verification.json"
    row = Row("flow/a", "q", 1.0, "s", 1.0, 0.1, passed=True, seconds=0.0)
    gone = {"id": "flow/gone", "value": 0.0}
    kept = {"id": "flow/kept", "value": 0.0}
    path.write_text(json.dumps([gone, kept]), encoding="utf-8")
    entries = merge(path, [row], known=["flow/a", "flow/kept"])
    assert [entry["id"] for entry in entries] == ["flow/a", "flow/kept"]
    json.dumps(entries, allow_nan=False)
