# SPDX-License-Identifier: LGPL-2.1-or-later
"""The folder of a run: whole files or none."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from quietblade.results import dataset
from quietblade.results.files import ResultError, replacing, write_text
from quietblade.results.store import RunFolder
from tests.results.synthetic import make_result
from tests.results.test_dataset import assert_same


def test_save_and_load(tmp_path: Path) -> None:
    folder = RunFolder(tmp_path / "runs" / "one")
    result = make_result()
    folder.save(result)
    assert_same(folder.load(), result)
    assert folder.case.read_text(encoding="utf-8") == result.run.case_text
    assert "Tip displacement" in folder.summary.read_text(encoding="utf-8")
    assert sorted(p.name for p in folder.root.iterdir()) == [
        "case.toml", "result.nc", "summary.txt",
    ]  # fmt: skip


def test_a_later_run_that_has_not_finished_is_known(tmp_path: Path) -> None:
    folder = RunFolder(tmp_path)
    assert not folder.overtaken()
    stage = folder.stages / "mesh.json"
    write_text(stage, "{}")
    assert not folder.overtaken()
    folder.save(make_result())
    made = folder.result.stat().st_mtime
    os.utime(stage, (made - 1.0, made - 1.0))
    assert not folder.overtaken()
    os.utime(stage, (made + 1.0, made + 1.0))
    assert folder.overtaken()


def test_a_failure_leaves_the_old_file_and_nothing_else(tmp_path: Path) -> None:
    file = tmp_path / "a.txt"
    write_text(file, "old")

    def fail() -> None:
        with replacing(file) as temporary:
            temporary.write_text("half of the n")
            raise RuntimeError("power cut")

    with pytest.raises(RuntimeError, match="power cut"):
        fail()
    assert file.read_text() == "old"
    assert [p.name for p in tmp_path.iterdir()] == ["a.txt"]


def test_a_failed_save_leaves_no_result(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def half(tree: object, path: Path) -> None:
        path.write_bytes(b"half")
        raise OSError("No space left on device")

    monkeypatch.setattr(dataset, "write", half)
    folder = RunFolder(tmp_path)
    with pytest.raises(OSError, match="No space"):
        folder.save(make_result())
    assert not folder.result.exists()
    assert not [p for p in tmp_path.iterdir() if p.name.startswith(".")]


def test_a_writer_that_writes_nothing_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError), replacing(tmp_path / "a.txt"):
        pass
    assert not list(tmp_path.iterdir())


def test_the_temporary_file_keeps_the_suffix(tmp_path: Path) -> None:
    with replacing(tmp_path / "new" / "a.vtu") as temporary:
        temporary.write_text("x")
        assert temporary.suffix == ".vtu"
        assert temporary.parent == tmp_path / "new"


def test_no_result(tmp_path: Path) -> None:
    with pytest.raises(ResultError, match=r"no result\.nc here.*quietblade run"):
        RunFolder(tmp_path).load()


def test_a_damaged_result_is_named(tmp_path: Path) -> None:
    (tmp_path / "result.nc").write_text("not netCDF")
    with pytest.raises(ResultError, match=r"result\.nc: not a readable netCDF file"):
        RunFolder(tmp_path).load()


def test_loading_needs_no_programs_that_compute(tmp_path: Path) -> None:
    RunFolder(tmp_path).save(make_result())
    code = (
        "import sys, quietblade; quietblade.load(sys.argv[1]);"
        "print(sorted(set(sys.modules) & {'ngsolve', 'gmsh', 'pyvista', 'matplotlib'}))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, str(tmp_path)], capture_output=True, text=True, check=True
    )
    assert done.stdout.strip() == "[]"
