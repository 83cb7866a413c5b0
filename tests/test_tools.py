# SPDX-License-Identifier: LGPL-2.1-or-later
"""The check of the machine before an installation, and the tables of the documentation."""

import platform
import shutil
import sys
from pathlib import Path

import pytest

from benchmarks.run import complete
from tools import check_system
from verification.report import page


@pytest.mark.parametrize("version", [(3, 11), (3, 13)])
def test_supported_pythons(version: tuple[int, int]) -> None:
    assert check_system.python_problem(version) is None


@pytest.mark.parametrize("version", [(3, 10), (3, 14)])
def test_other_pythons_are_refused_with_a_remedy(version: tuple[int, int]) -> None:
    problem = check_system.python_problem(version)
    assert problem is not None
    assert f"Python {version[0]}.{version[1]}" in problem
    assert "make PYTHON=" in problem


def test_platforms_without_wheels_are_named() -> None:
    glibc = ("glibc", "2.36")
    assert check_system.platform_problem("Linux", "x86_64", glibc) is None
    assert "aarch64" in (check_system.platform_problem("Linux", "aarch64", glibc) or "")
    assert "2.17" in (check_system.platform_problem("Linux", "x86_64", ("glibc", "2.17")) or "")
    assert "glibc" in (check_system.platform_problem("Linux", "x86_64", ("", "")) or "")
    assert check_system.platform_problem("Darwin", "arm64", ("", "")) is None


def test_missing_libraries_are_named_with_their_packages(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(platform, "system", lambda: "Linux")
    monkeypatch.setattr(check_system, "loads", lambda soname: soname != "libGLU.so.1")
    monkeypatch.setattr(sys, "argv", ["check_system.py"])
    monkeypatch.setattr(shutil, "which", lambda name: None)
    assert check_system.main() == 1
    said = capsys.readouterr().err
    assert "libGLU.so.1 is missing (needed by gmsh)" in said
    assert "apt-get install --no-install-recommends libglu1-mesa" in said
    assert "dnf install mesa-libGLU" in said
    assert "libGL.so.1" not in said


def test_a_library_that_does_not_exist_is_noticed() -> None:
    assert not check_system.loads("libquietblade-that-nobody-has.so.7")


def test_pages_without_a_record_say_which_command_makes_it(tmp_path: Path) -> None:
    assert "make verify" in page("verification", tmp_path)
    assert "make bench" in page("benchmarks", tmp_path)


def test_pages_show_failures_and_empty_values(tmp_path: Path) -> None:
    (tmp_path / "verification.json").write_text(
        '[{"id": "flow/a", "quantity": "q|r", "reference": 1.0, "source": "s", "value": null,'
        ' "tolerance": 0.1, "passed": false, "seconds": 0.5}]',
        encoding="utf-8",
    )
    text = page("verification", tmp_path)
    assert "**Failed: flow/a.**" in text
    assert r"| `flow/a` | q\|r | - | 1 | 0.1 | s | **no** | 0.50 |" in text


def test_a_benchmark_row_must_be_complete() -> None:
    row = dict.fromkeys(("id", "size", "ours_s", "other", "other_s", "ratio", "peak_mb", "notes"))
    assert complete(row) == row
    with pytest.raises(ValueError, match="keys"):
        complete({"id": "flow/x"})
