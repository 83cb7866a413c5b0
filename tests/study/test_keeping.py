# SPDX-License-Identifier: LGPL-2.1-or-later
"""Kept results: whole or not there, made again where they are damaged, harmless to read."""

import gc
import os
import subprocess
import sys
import weakref
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial
from pathlib import Path
from types import MappingProxyType

import numpy as np
import pytest
from scipy.sparse import csr_matrix

from quietblade.linalg import SolverReport
from quietblade.mesh.model import CellBlock, Mesh, Quality
from quietblade.results.files import ResultError
from quietblade.results.lock import locked
from quietblade.study.clock import Stages
from quietblade.study.keeping import DamagedError, Lap, StageStore
from quietblade.study.stages import Origin
from quietblade.typing import FloatArray

ORIGIN = Origin({"mesh.size": 0.1, "acoustics.band": [100.0, 200.0]}, {}, {"quietblade": "1"})
LAP = Lap(1.5, 2e8)


def mesh() -> Mesh:
    return Mesh(
        np.arange(12.0).reshape(4, 3),
        MappingProxyType({"blade": (CellBlock("tetra10", np.zeros((1, 10), dtype=np.int64)),)}),
        {"wet": np.zeros((2, 6), dtype=np.int64)},
        np.zeros(3),
        1.0,
        {"blade": Quality(0.5, 0.7, 0.9)},
    )


def test_arrays_records_and_shared_parts_come_back(tmp_path: Path) -> None:
    store, array = StageStore(tmp_path), np.linspace(0.0, 1.0, 5)
    made = {"a": array, "b": array, "z": csr_matrix(np.eye(3)), "mesh": mesh(), "x": 1 + 2j}
    store.keep("mesh", ORIGIN, LAP, made, {})
    again = store.read("mesh", {})
    assert again["a"] is again["b"]
    np.testing.assert_array_equal(again["a"], array)
    np.testing.assert_array_equal(again["z"].toarray(), np.eye(3))
    assert again["mesh"].quality == {"blade": Quality(0.5, 0.7, 0.9)}
    assert again["mesh"].cells["blade"][0].kind == "tetra10"
    known = store.known("mesh")
    assert known is not None
    assert (known.origin, known.lap) == (ORIGIN, Lap(1.5, 2e8, kept=True))


def test_what_is_made_again_is_left_out_and_caches_too(tmp_path: Path) -> None:
    store, whole = StageStore(tmp_path), mesh()
    report = SolverReport({}, {}, 0.0, 0, (), 0.0, 0)
    store.keep("modes C0", ORIGIN, LAP, [whole, whole, report], {Mesh: lambda: None})
    other = mesh()
    first, second, kept = store.read("modes C0", {Mesh: lambda: other})
    assert first is other
    assert second is other
    assert kept == report


def test_only_the_newest_result_of_a_stage_stays(tmp_path: Path) -> None:
    store = StageStore(tmp_path)
    store.keep("modes C0", ORIGIN, LAP, 1, {})
    store.keep("modes C0", Origin({"mesh.size": 0.2}, {}, {}), LAP, 2, {})
    store.keep("modes C1", ORIGIN, LAP, 3, {})
    (tmp_path / ".123-modes-C0-abc.pickle").write_bytes(b"half")
    assert store.read("modes C0", {}) == 2
    store.tidy(["modes C0"])
    assert {file.suffix for file in tmp_path.iterdir()} == {".json", ".pickle"}
    assert {file.name[:8] for file in tmp_path.iterdir()} == {"modes-C0"}


@pytest.mark.parametrize("damage", ["cut", "bit", "gone", "card"])
def test_damage_is_seen_and_the_stage_computed_again(tmp_path: Path, damage: str) -> None:
    store = StageStore(tmp_path)
    store.keep("mesh", ORIGIN, LAP, np.ones(100), {})
    (content,) = tmp_path.glob("*.pickle")
    raw = bytearray(content.read_bytes())
    match damage:
        case "cut":
            content.write_bytes(raw[:-10])
        case "bit":
            raw[-20] ^= 1
            content.write_bytes(raw)
        case "gone":
            content.unlink()
        case "card":
            (tmp_path / "mesh.json").write_text("{")
    said: list[str] = []
    stages = Stages(lambda _, __, message: said.append(message), {"mesh": ORIGIN}, store)
    made = stages.make("mesh", lambda _: np.full(100, 2.0))
    assert made[0] == 2.0
    assert bool(stages.notices) == (damage != "card")
    assert not stages.laps["mesh"].kept
    assert np.all(store.read("mesh", {}) == 2.0)


def test_stages_are_kept_and_forced(tmp_path: Path) -> None:
    def made(force: bool) -> tuple[int, bool]:
        stages = Stages(lambda *_: None, {"mesh": ORIGIN}, StageStore(tmp_path / "s"), force=force)
        value = stages.make("mesh", lambda _: next(numbers))
        return value, stages.laps["mesh"].kept

    numbers = iter(range(10))
    assert made(False) == (0, False)
    assert made(False) == (0, True)
    assert made(True) == (1, False)
    assert made(False) == (1, True)


def test_a_shelved_result_is_let_go_of_and_read_when_it_is_asked_for(tmp_path: Path) -> None:
    def shelf(store: StageStore | None) -> tuple[Callable[[], FloatArray], weakref.ref[FloatArray]]:
        made = np.full(100, 2.0)
        reference = weakref.ref(made)
        stages = Stages(lambda *_: None, {"mesh": ORIGIN}, store)
        return stages.shelve("mesh", partial(lambda array, _: array, made)), reference

    take, made = shelf(StageStore(tmp_path))
    gc.collect()
    assert made() is None
    assert np.all(take() == 2.0)
    next(tmp_path.glob("*.pickle")).write_bytes(b"")
    with pytest.raises(ResultError, match=r"stage mesh: .* damaged: .*; run again"):
        take()
    take, made = shelf(None)
    assert take() is made()


def test_the_account_says_what_was_kept_and_why_the_rest_was_not(tmp_path: Path) -> None:
    def account(**inputs: float) -> str:
        mesh, flow = Origin({"mesh.size": 0.1}, {}, {}), Origin(inputs, {}, {})
        after = Origin({}, {"flow": flow.key}, {})
        stages = Stages(
            lambda *_: None, {"mesh": mesh, "flow": flow, "sweep": after}, StageStore(tmp_path)
        )
        for name in ("mesh", "flow", "sweep"):
            stages.make(name, lambda _: 1)
        return stages.account()

    assert account(speed=5.0) == ""
    assert account(speed=5.0) == "kept: mesh, flow, sweep"
    assert account(speed=6.0) == (
        "kept: mesh; computed again: flow (speed changed), sweep (follows from flow)"
    )
    (tmp_path / "sweep.json").unlink()
    assert account(speed=6.0) == "kept: mesh, flow; computed: sweep"


def test_full_disk_ends_no_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("quietblade.results.files.os.fsync", full)
    store = StageStore(tmp_path)
    stages = Stages(lambda *_: None, {"mesh": ORIGIN}, store)
    assert stages.make("mesh", lambda _: 1) == 1
    assert "No space left" in stages.notices[0].message
    assert stages.shelve("mesh", lambda _: 2)() == 2  # from memory
    assert store.known("mesh") is None
    assert list(tmp_path.iterdir()) == []


@dataclass(frozen=True)
class Stranger:
    """Not of the package."""

    value: int = 1

    @cached_property
    def twice(self) -> int:
        return 2 * self.value


class Evil:
    def __reduce__(self) -> tuple[object, tuple[str]]:
        return os.system, ("touch evil",)


@pytest.mark.parametrize("content", [Evil(), Stranger(), print])
def test_reading_runs_nothing_of_others(tmp_path: Path, content: object) -> None:
    store = StageStore(tmp_path)
    store.keep("mesh", ORIGIN, LAP, content, {})
    with pytest.raises(DamagedError, match="no place"):
        store.read("mesh", {})
    assert not Path("evil").exists()


def test_second_run_in_a_folder_is_refused_and_a_killed_one_leaves_it_free(tmp_path: Path) -> None:
    program = (
        "import sys, time; from pathlib import Path\n"
        "from quietblade.results.lock import locked\n"
        f"with locked(Path({str(tmp_path)!r})):\n"
        "    print('held', flush=True); time.sleep(60)\n"
    )
    with subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE) as other:
        assert other.stdout is not None
        assert other.stdout.readline() == b"held\n"
        with pytest.raises(ResultError, match=f"process {other.pid} on .*--out"), locked(tmp_path):
            pass
        other.kill()
    with locked(tmp_path):
        pass
    with locked(tmp_path), pytest.raises(ResultError, match="at work"), locked(tmp_path):
        pass


def test_a_run_borrows_from_another_and_leaves_it_as_it_is(tmp_path: Path) -> None:
    lender, borrower = StageStore(tmp_path / "a"), StageStore(tmp_path / "b")
    lender.keep("mesh", ORIGIN, LAP, np.arange(3.0), {})
    borrower.borrow(tmp_path / "a")
    np.testing.assert_array_equal(borrower.read("mesh", {}), np.arange(3.0))
    other = Origin({"mesh.size": 0.2}, {}, {"quietblade": "1"})
    borrower.keep("mesh", other, LAP, np.zeros(2), {})
    np.testing.assert_array_equal(lender.read("mesh", {}), np.arange(3.0))
    borrower.borrow(tmp_path / "a")  # what it has of its own stays
    np.testing.assert_array_equal(borrower.read("mesh", {}), np.zeros(2))
