# SPDX-License-Identifier: LGPL-2.1-or-later
"""``quietblade run`` and its progress display; the computation itself is tested in tests/study."""

import io
from dataclasses import replace
from pathlib import Path

import pytest
from rich.console import Console

from quietblade.case import Case
from quietblade.case.presets import preset_text
from quietblade.cli.main import execute
from quietblade.cli.progress import ProgressDisplay
from quietblade.results.lock import locked
from quietblade.results.store import RunFolder
from quietblade.study.keeping import Lap, StageStore
from quietblade.study.run import run_key
from quietblade.study.stages import origins
from tests.results.synthetic import make_result


@pytest.fixture
def case(tmp_path: Path) -> Path:
    file = tmp_path / "blade.toml"
    file.write_text(preset_text("paper-aluminium"), encoding="utf-8")
    return file


def stored(case: Path, folder: Path, *, converged: bool) -> None:
    """Put a result of this very case into a folder."""
    result = make_result("aluminium")
    run = replace(result.run, content_key=run_key(Case.load(case)))
    static = replace(result.static, converged=converged)
    RunFolder(folder).save(replace(result, run=run, static=static))


def test_result_that_is_there_is_not_computed_again(
    case: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    stored(case, tmp_path / "run", converged=True)
    assert execute(["run", str(case), "--out", str(tmp_path / "run")]) == 0
    said = capsys.readouterr().out
    assert "--force" in said
    assert "Lift" in said
    assert "other code" not in said


def test_result_of_other_code_is_told(
    case: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = RunFolder(tmp_path / "run")
    stored(case, folder.root, converged=True)
    mesh = origins(Case.load(case))["mesh"]
    changed = replace(mesh, code={**mesh.code, "quietblade": "of last year"})
    StageStore(folder.stages).keep("mesh", changed, Lap(1.0, 1e6), "a mesh", {})
    assert execute(["run", "--brief", str(case), "--out", str(folder.root)]) == 0
    assert "by other code than is installed" in " ".join(capsys.readouterr().out.split())


def test_kept_result_that_did_not_converge_has_its_own_exit_code(
    case: Path, tmp_path: Path
) -> None:
    stored(case, tmp_path / "run", converged=False)
    assert execute(["run", "--brief", str(case), "--out", str(tmp_path / "run")]) == 2


def test_wrong_case_ends_before_anything_is_made(
    case: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = case.read_text(encoding="utf-8").replace('size = "23 mm"', 'size = "-23 mm"')
    case.write_text(text, encoding="utf-8")
    assert execute(["run", str(case), "--out", str(tmp_path / "run")]) == 1
    assert "mesh.size" in capsys.readouterr().err
    assert not (tmp_path / "run").exists()


def test_plain_progress_tells_stage_and_time_left() -> None:
    out = io.StringIO()
    with ProgressDisplay(Console(file=out, width=100)) as progress:
        progress("sweep C0", 0.0, "")
        progress("sweep C0", 0.25, "120 Hz")  # too soon after the last line
        progress("sweep C0", 1.0, "12.0 s")
    assert out.getvalue().splitlines() == ["sweep C0: ...", "sweep C0: 12.0 s"]


def test_quiet_progress_says_nothing() -> None:
    out = io.StringIO()
    with ProgressDisplay(Console(file=out), quiet=True) as progress:
        progress("mesh", 0.0, "")
        progress("mesh", 1.0, "2 s")
    assert out.getvalue() == ""


def test_verbose_progress_tells_every_step() -> None:
    out = io.StringIO()
    with ProgressDisplay(Console(file=out, width=100), verbose=True) as progress:
        progress("modes C0", 0.0, "acoustics.band changed")
        progress("modes C0", None, "11 modes")
        progress("modes C0", 1.0, "12.0 s")
    assert out.getvalue().splitlines() == [
        "modes C0: acoustics.band changed",
        "modes C0: 11 modes",
        "modes C0: 12.0 s",
    ]


def test_stopped_run_says_how_to_go_on(
    case: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def stopped(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("quietblade.study.run.build_mesh", stopped)
    out = tmp_path / "run"
    assert execute(["run", str(case), "--out", str(out)]) == 130
    assert "goes on from there" in capsys.readouterr().err
    assert "ended by KeyboardInterrupt" in (out / "run.log").read_text(encoding="utf-8")
    assert not (out / "result.nc").exists()


def test_two_runs_into_one_folder_are_refused(
    case: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with locked(tmp_path / "run"):
        assert execute(["run", str(case), "--out", str(tmp_path / "run")]) == 3
    assert "a run is at work here" in capsys.readouterr().err
