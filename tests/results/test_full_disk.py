# SPDX-License-Identifier: LGPL-2.1-or-later
"""A disk that is full: no half-written file, and a message with folder and remedy."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from quietblade.results.files import ResultError, WriteError, replacing, write_text
from quietblade.results.store import RunFolder
from quietblade.study.log import logging_to
from tests.results.synthetic import make_result

resource = pytest.importorskip("resource", reason="no limit on the size of files on this system")

PROGRAM = """
import resource, sys
from pathlib import Path
import numpy as np
from quietblade.results.files import WriteError, write_text
from quietblade.results.store import RunFolder
from quietblade.mesh.model import CellBlock
from quietblade.results.vtk import write_fields
from quietblade.study.clock import Stages
from quietblade.study.keeping import StageStore
from quietblade.study.stages import Origin
from quietblade.view.figures import _save
from matplotlib.figure import Figure
from tests.results.synthetic import make_result

root, room = Path(sys.argv[1]), int(sys.argv[2])
result = make_result()
RunFolder(root / "whole").save(result)
resource.setrlimit(resource.RLIMIT_FSIZE, (room, room))

def refused(name, write):
    try:
        write()
    except WriteError as error:
        print(name, error, sep="|")

refused("result", lambda: RunFolder(root / "run").save(result))
points = np.random.default_rng(1).random((20000, 3))
cells = {"blade": [CellBlock("tetra10", np.arange(20000).reshape(-1, 10))]}
refused("fields", lambda: write_fields(root / "fields" / "a.vtu", points, cells))
picture = Figure()
picture.subplots().imshow(np.random.default_rng(1).random((300, 300)))
drawn = {"a": lambda: picture}
refused("figures", lambda: _save(root / "figures", drawn, lambda *_: None, ("png",)))
refused("report", lambda: write_text(root / "report" / "report.html", "x" * 2 * room))
stages = Stages(lambda *_: None, {"mesh": Origin({}, {}, {})}, StageStore(root / "stages"))
stages.make("mesh", lambda _: np.zeros(room))
print("stage", stages.notices[0], sep="|")
"""


def test_nothing_half_written_is_left(tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM, str(tmp_path), "20000"],
        capture_output=True, text=True, check=False, env=os.environ | {"OMP_NUM_THREADS": "1"},
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    said = dict(line.split("|", 1) for line in done.stdout.splitlines())
    assert set(said) == {"result", "fields", "figures", "report", "stage"}
    for name, folder in (
        ("result", "run"), ("fields", "fields"), ("figures", "figures"), ("report", "report"),
    ):  # fmt: skip
        assert said[name].startswith(f"{tmp_path / folder}: ")
        assert "Make room" in said[name]
    assert "could not be kept: File too large" in said["stage"]
    left = {str(p.relative_to(tmp_path)) for p in tmp_path.rglob("*") if p.is_file()}
    assert not {name for name in left if Path(name).name.startswith(".")}
    assert {name for name in left if not name.startswith("whole")} <= {
        "run/case.toml", "run/summary.txt",
    }  # fmt: skip
    assert RunFolder(tmp_path / "whole").load().title == make_result().title


def test_the_error_is_one_of_results_and_of_the_system(tmp_path: Path) -> None:
    def full() -> None:
        with replacing(tmp_path / "a.txt"):
            raise OSError(28, "No space left on device")

    with pytest.raises(WriteError, match=r"No space left on device.*Make room") as caught:
        full()
    assert isinstance(caught.value, ResultError)
    assert (caught.value.errno, caught.value.strerror) == (28, "No space left on device")
    assert not list(tmp_path.iterdir())


def test_a_folder_that_cannot_be_made(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(WriteError, match="cannot be written"):
        write_text(tmp_path / "file" / "a.txt", "x")


def test_a_log_that_cannot_be_written_ends_no_run(tmp_path: Path) -> None:
    code = (
        "import resource, sys; from pathlib import Path\n"
        "from quietblade.study.log import logging_to\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (200, 200))\n"
        "with logging_to(Path(sys.argv[1]), lambda *_: None) as report:\n"
        "    for k in range(100): report('mesh', 0.01 * k, 'on the way')\n"
        "print('done')\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, str(tmp_path / "run.log")],
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert done.stdout == "done\n"
    assert (tmp_path / "run.log").stat().st_size <= 200
    with logging_to(tmp_path / "run.log", lambda *_: None):
        pass
    assert (tmp_path / "run.log").read_text("utf-8").splitlines()[-1].endswith("done")


def test_what_killed_runs_left_is_removed(tmp_path: Path) -> None:
    folder = RunFolder(tmp_path)
    for place in (folder.root, folder.figures, folder.static_fields.parent):
        place.mkdir(exist_ok=True)
        (place / ".4711-result.nc").write_bytes(b"half")
    (tmp_path / ".lock.sqlite").write_text("")
    folder.tidy()
    assert [p.name for p in tmp_path.rglob("*") if p.is_file()] == [".lock.sqlite"]
