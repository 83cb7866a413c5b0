# SPDX-License-Identifier: LGPL-2.1-or-later
"""``quietblade export`` of shape and mesh; the files are read back in tests/mesh."""

import re
from pathlib import Path

import pytest

from quietblade.case.presets import preset_text
from quietblade.cli.main import execute


@pytest.fixture
def case(tmp_path: Path) -> Path:
    file = tmp_path / "blade.toml"
    file.write_text(preset_text("paper-aluminium"), encoding="utf-8")
    return file


def test_shape_of_a_case_or_a_run(
    case: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "blade.step"
    assert execute(["export", str(case), "--step", str(out)]) == 0
    assert capfd.readouterr().out == f"step: {out}\n"
    run = tmp_path / "run"
    run.mkdir()
    (run / "case.toml").write_text(case.read_text(encoding="utf-8"), encoding="utf-8")
    assert execute(["export", str(run), "--step", str(tmp_path / "again.step"), "--quiet"]) == 0
    texts = [file.read_text(encoding="utf-8") for file in tmp_path.glob("*.step")]
    one, other = (re.findall(r"CARTESIAN_POINT\('',\((.*?)\)\)", text) for text in texts)
    same = one == other  # outside the assertion: the difference of long lists takes minutes
    assert same
    assert len(one) > 100
    assert not list(tmp_path.glob("*.inp"))


def test_wrong_names_and_places_are_refused(
    case: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert execute(["export", str(case), "--step", str(tmp_path / "blade.obj")]) == 3
    assert "ends with .step or .stp" in capsys.readouterr().err
    assert execute(["export", str(tmp_path / "nothing"), "--step", "x.step"]) == 1
    assert not list(tmp_path.glob("*blade.obj"))
