# SPDX-License-Identifier: LGPL-2.1-or-later
"""All figures of a run, and the commands that make and show them."""

import json
from pathlib import Path

import numpy as np
import pytest
from matplotlib.image import imread

from quietblade.cli.main import execute
from quietblade.results.headline import summarise
from quietblade.results.store import RunFolder
from quietblade.view.figures import draw_joint_figures

NAMES = {
    "mesh", "displacement", "deformed", "mid-section-normalised", "mid-section", "blade-angle",
    "lift-coefficient", "convergence", "mode-shapes-C0", "mode-shapes-C1", "sound-power",
    "power-paths", "power-shares", "moduli", "cavitation", "stress", "source-level", "bands",
    "directivity", "directivity-xy", "directivity-xz", "directivity-yz", "multipoles",
    "radiation-efficiency", "campbell",
    "power-by-load", "mobility", "power-per-force", "root-forces",
}  # fmt: skip


@pytest.fixture(scope="module")
def drawn(runs: tuple[RunFolder, ...]) -> tuple[Path, ...]:
    """Pictures that the command makes."""
    assert execute(["plot", str(runs[1].root), "--quiet"]) == 0
    return tuple(runs[1].figures.iterdir())


def assert_picture(file: Path) -> None:
    pixels = imread(file)[..., :3]
    assert pixels.shape[1] >= 1200  # 6.3 inches at 200 dpi
    assert 0.01 < np.mean(np.any(pixels < 0.9, axis=2)) < 0.9, file


def test_every_figure_is_drawn(drawn: tuple[Path, ...]) -> None:
    assert {file.name for file in drawn} == {f"{name}.png" for name in NAMES}
    for file in drawn:
        assert_picture(file)


def test_figures_of_several_runs(runs: tuple[RunFolder, ...], tmp_path: Path) -> None:
    told: list[tuple[str, float | None]] = []
    files = draw_joint_figures(runs, tmp_path, lambda s, f, _m: told.append((s, f)))
    assert {file.stem for file in files} == {
        "mid-section-normalised", "mid-section", "blade-angle", "lift-coefficient",
        "sound-power-at-rest", "deformed-aluminium", "deformed-composite",
    }  # fmt: skip
    for file in files:
        assert_picture(file)
    fractions = [f for s, f in told if s == "figures" and f is not None]
    assert fractions == sorted(fractions)
    assert fractions[-1] == 1.0


def test_show(runs: tuple[RunFolder, ...], capsys: pytest.CaptureFixture[str]) -> None:
    assert execute(["show", str(runs[0].root)]) == 0
    shown = capsys.readouterr().out
    for part in ("Tip displacement", "130.0", "C0 [dB]", "agrees"):
        assert part in shown, part
    assert execute(["show", str(runs[0].root), "--json"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert data == json.loads(summarise(runs[0].load()).model_dump_json())


def test_compare(runs: tuple[RunFolder, ...], capsys: pytest.CaptureFixture[str]) -> None:
    first, second = (str(run.root) for run in runs)
    assert execute(["compare", first, second, "--json"]) == 0
    found = {row["name"]: row for row in json.loads(capsys.readouterr().out)}
    assert found["C0 T2 frequency"]["change"] == pytest.approx(4.2)
    assert execute(["compare", first, second]) == 0
    assert "C0 T2 frequency" in capsys.readouterr().out


def test_joint_figures_need_two_runs(
    runs: tuple[RunFolder, ...], capsys: pytest.CaptureFixture[str]
) -> None:
    assert execute(["plot", "--joint", str(runs[0].root)]) == 1
    assert "at least two runs" in capsys.readouterr().err


@pytest.mark.parametrize("command", ["show", "plot", "report"])
def test_a_folder_without_a_result(
    command: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert execute([command, str(tmp_path)]) == 3
    captured = capsys.readouterr()
    assert "no result.nc here" in captured.err
    assert not list(tmp_path.iterdir())
