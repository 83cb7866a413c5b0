# SPDX-License-Identifier: LGPL-2.1-or-later
"""All figures of a run, and the commands that make and show them."""

import json
import re
import sys
from collections.abc import Iterator
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.image import imread
from matplotlib.lines import Line2D
from PIL import Image

from quietblade.cli.main import execute
from quietblade.results.headline import summarise
from quietblade.results.store import RunFolder
from quietblade.view.figures import draw_joint_figures
from tests.results.synthetic import make_result

NAMES = {
    "mesh", "displacement", "deformed", "mid-section-normalised", "mid-section", "blade-angle",
    "lift-coefficient", "convergence", "mode-shapes-C0", "mode-shapes-C1", "sound-power",
    "power-paths", "power-shares", "moduli", "cavitation", "stress", "source-level", "bands",
    "directivity", "directivity-xy", "directivity-xz", "directivity-yz", "multipoles",
    "radiation-efficiency", "campbell",
    "power-by-load", "mobility", "power-per-force", "root-forces",
}  # fmt: skip


@pytest.fixture(scope="module")
def drawn(runs: tuple[RunFolder, ...]) -> dict[str, Figure]:
    """Figures that the command draws, by the name of their file."""
    figures: dict[str, Figure] = {}
    save = Figure.savefig

    def kept(figure: Figure, target: Path, **options: Any) -> None:
        figures[target.name.split("-", 1)[1]] = figure  # after the number of the process
        save(figure, target, **options)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Figure, "savefig", kept)
        assert execute(["plot", str(runs[1].root), "--quiet"]) == 0
    return figures


def assert_picture(file: Path) -> None:
    pixels = imread(file)[..., :3]
    assert pixels.shape[1] >= 1200  # 6.3 inches at 200 dpi
    assert 0.01 < np.mean(np.any(pixels < 0.9, axis=2)) < 0.9, file


def test_every_figure_is_drawn(drawn: dict[str, Figure], runs: tuple[RunFolder, ...]) -> None:
    expected = {f"{name}.png" for name in NAMES}
    assert {file.name for file in runs[1].figures.iterdir()} == expected == set(drawn)
    for file in runs[1].figures.iterdir():
        assert_picture(file)


def _labels(axes: Axes) -> Iterator[str]:
    """Labels of the axes that show numbers, without which these say nothing."""
    if not axes.axison:
        return
    for axis in (axes.xaxis, axes.yaxis):
        directions = axes.name == "polar" and axis is axes.xaxis
        numbers = [tick for tick in axis.get_ticklabels() if tick.get_visible() and tick.get_text()]
        if axis.get_visible() and numbers and not directions:
            yield axis.get_label_text()


def test_every_axis_has_its_unit_and_every_level_its_reference(drawn: dict[str, Figure]) -> None:
    seen = set()
    for name, figure in drawn.items():
        for label in (label for axes in figure.axes for label in _labels(axes)):
            unit = re.search(r"\[([^\]]+)\]$", label)
            assert unit is not None, f"{name}: {label!r} has no unit, nor says [–]"
            assert unit[1] != "1", f"{name}: {label!r}: dimensionless is [–]"
            assert "dB" not in unit[1] or unit[1].startswith("dB re "), f"{name}: {label!r}"
            seen.add(unit[1])
    assert {"Hz", "–", "mm", "MPa", "dB re 1 pW", "dB re 1 µPa m", "N", "N m"} <= seen


def test_rest_and_load_are_apart_by_more_than_colour(drawn: dict[str, Figure]) -> None:
    compared = 0
    for name, figure in drawn.items():
        for axes in figure.axes:
            looks: dict[str, set[tuple[str, str]]] = {"C0": set(), "C1": set()}
            for handle, label in zip(*axes.get_legend_handles_labels(), strict=True):
                if isinstance(handle, Line2D) and label[:2] in looks:
                    dashes = str(handle._unscaled_dash_pattern)  # has no public name
                    looks[label[:2]].add((dashes, str(handle.get_marker())))
            if all(looks.values()):
                compared += 1
                assert not looks["C0"] & looks["C1"], name
    assert compared >= 4


def test_figures_of_several_runs(runs: tuple[RunFolder, ...], tmp_path: Path) -> None:
    told: list[tuple[str, float | None]] = []
    kinds = ("png", "pdf", "svg")
    files = draw_joint_figures(runs, tmp_path, lambda s, f, _m: told.append((s, f)), kinds)
    assert {file.stem for file in files} == {
        "mid-section-normalised", "mid-section", "blade-angle", "lift-coefficient",
        "sound-power-at-rest", "deformed-aluminium", "deformed-composite",
    }  # fmt: skip
    starts = {".pdf": b"%PDF-", ".svg": b"<?xml"}
    for file in files:
        if file.suffix == ".png":
            assert_picture(file)
        else:
            assert file.read_bytes().startswith(starts[file.suffix])
    assert len(files) == 3 * 7
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


@pytest.fixture
def moving(tmp_path: Path, runs: tuple[RunFolder, ...]) -> RunFolder:
    """A run of one configuration with one mode."""
    result = make_result("composite")
    first = result.configurations["C1"]
    few = replace(
        first.modes, **{f.name: getattr(first.modes, f.name)[:1] for f in fields(first.modes)}
    )
    folder = RunFolder(tmp_path)
    folder.save(replace(result, configurations={"C1": replace(first, modes=few)}))
    (tmp_path / "fields").symlink_to(runs[1].root / "fields")
    return folder


def test_animations_move(moving: RunFolder) -> None:
    assert execute(["plot", str(moving.root), "--animate", "--quiet"]) == 0
    files = sorted(moving.figures.iterdir())
    assert [file.name for file in files] == ["mode-C1-B5.gif", "steady.gif"]
    for file in files:
        assert file.stat().st_size < 2e6
        with Image.open(file) as picture:
            assert picture.n_frames == 16
            frames = []
            for index in (0, 8):
                picture.seek(index)
                frames.append(np.asarray(picture.convert("RGB")).astype(float))
        assert picture.info["loop"] == 0
        assert np.any(np.abs(frames[0] - frames[1]) > 50.0)


def test_films_show_what_the_animations_show(
    moving: RunFolder, capsys: pytest.CaptureFixture[str]
) -> None:
    ffmpeg = pytest.importorskip("imageio_ffmpeg")
    words = ["plot", str(moving.root), "--animate", "-f", "gif", "-f", "mp4", "--json"]
    assert execute(words) == 0
    files = json.loads(capsys.readouterr().out)["files"]
    assert {file["kind"] for file in files} == {"animation"}
    for gif, mp4 in zip(files[::2], files[1::2], strict=True):
        assert mp4["path"] == gif["path"].replace(".gif", ".mp4")
        assert 1000 < mp4["bytes"] == Path(mp4["path"]).stat().st_size < 1e6
        film = ffmpeg.read_frames(mp4["path"])
        about = next(film)
        width, height = about["size"]
        frames = [np.frombuffer(frame, np.uint8).reshape(height, width, 3) for frame in film]
        assert (len(frames), about["fps"], about["codec"]) == (4 * 16, 10.0, "h264")
        with Image.open(gif["path"]) as picture:
            picture.seek(5)
            still = np.asarray(picture.convert("RGB"))
        assert 0 <= width - still.shape[1] <= 1
        assert 0 <= height - still.shape[0] <= 1
        film_frame = frames[16 + 5][: still.shape[0], : still.shape[1]]
        assert np.mean(np.abs(film_frame.astype(float) - still)) < 4.0
        assert np.mean(np.abs(frames[0].astype(float) - frames[8])) > 1.0


def test_a_film_without_its_program_is_refused_before_anything_is_drawn(
    moving: RunFolder, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    assert execute(["plot", str(moving.root), "--animate", "--format", "mp4"]) == 3
    assert 'pip install "quietblade[mp4]"' in " ".join(capsys.readouterr().err.split())
    assert not moving.figures.exists()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("--animate --format pdf", "pdf: moving pictures are gif, mp4"),
        ("--format mp4", "mp4: still pictures are png, pdf, svg; --animate"),
        ("--animate --joint", "--joint"),
    ],
)
def test_kinds_of_pictures_that_do_not_go_together(
    words: str, said: str, runs: tuple[RunFolder, ...], capsys: pytest.CaptureFixture[str]
) -> None:
    assert execute(["plot", *words.split(), *(str(run.root) for run in runs)]) == 1
    shown = capsys.readouterr().err.replace("\u2502", " ")
    assert said in " ".join(shown.split())
