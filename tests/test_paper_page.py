# SPDX-License-Identifier: LGPL-2.1-or-later
"""The page of the paper: made from made-up runs, and as it lies in the documentation."""

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from quietblade.case.study_calibration import Calibration
from quietblade.mesh import Mesh
from quietblade.results.store import RunFolder
from quietblade.study.calibration import Evaluation, Fitted
from quietblade.study.fitting import write_fitted, write_sensitivities
from quietblade.study.sensitivity import Effect, Sensitivities
from tests.results.made_tables import make_decomposition, make_water
from tests.results.synthetic import make_result, write_synthetic_fields
from tools.paper_open import WORDS
from tools.paper_page import write_page
from tools.paper_runs import PaperRuns

DOCS = Path(__file__).parent.parent / "docs"


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory, coarse_mesh: Mesh) -> Path:
    """Folder of a study with two variants, tables and variants beyond."""
    root = tmp_path_factory.mktemp("study")
    for blade in ("aluminium", "composite"):
        result = make_result(blade)
        for name in ("ours", "paper", "../beyond/base", "../beyond/bgt1", "../beyond/thin-film"):
            place = root / (f"beyond/{blade}-{name[10:]}" if "/" in name else f"{blade}-{name}")
            folder = RunFolder(place)
            if name == "ours":
                write_synthetic_fields(folder, coarse_mesh, result)
            folder.save(replace(result, run=replace(result.run, case_text=_text(name))))
        make_decomposition().save(root / "beyond" / blade / "shift.nc")
    make_water().save(root / "beyond" / "composite" / "water.nc")
    write_calibration(root.parent / "paper-calibration")
    return root


def write_calibration(folder: Path) -> None:
    """Write what a search and sensitivities leave, with made-up figures."""
    words = Calibration.load(WORDS)
    moved = {p.key: p.value(p.first) for p in words.parameters if p.search}
    claim = "paper/composite/film-shear-strain"
    start = Evaluation(moved, {"composite": {claim: 9.0}})
    best = Evaluation({**moved, "film.thickness": "1.123 mm"}, {"composite": {claim: 8.0}})
    off = np.full(len(words.targets), 0.25)
    factors = {"composite/film_shear_strain": 1.0456}
    write_fitted(
        words, Fitted("", start, best, off, (9.9, 0.4), 31, 31, True, factors, (9.9, 0.4)), folder
    )
    effect = Effect("film.thickness", "1.123 mm", 0.3, best)
    write_sensitivities(words, Sensitivities(start, (effect,)), folder)


def _text(name: str) -> str:
    changed = "" if name == "ours" else "# changed in memory: acoustics.radiation = 'bgt1'\n"
    return f'title = "blade"\n{changed}'


@pytest.fixture(scope="module")
def out(study: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("docs")
    write_page(PaperRuns(study, "ours"), folder)
    return folder


def pictures_of(page: Path) -> list[Path]:
    return [page.parent / name for name in re.findall(r"!\[.*?\]\((.*?)\)", page.read_text())]


def test_page_has_every_figure_of_the_paper(study: Path, out: Path) -> None:
    drawn = pictures_of(out / "paper.md")
    assert all(file.is_file() for file in drawn)
    numbers = {"1", "2", "3", "4", "5a", "5b", "5c", "5d", "6", "7", "8"}
    assert numbers <= {file.stem.removeprefix("figure-") for file in drawn}
    assert all((study / "figures" / f"{file.stem}.pdf").is_file() for file in drawn)
    assert set(pictures_of(out / "gallery.md")) == set(drawn)


def test_page_tells_the_numbers_of_the_tables(out: Path) -> None:
    text = (out / "paper.md").read_text()
    assert "**B5** moves by +5.50 %" in text
    assert "largest step is that of the stress (+4.00 %)" in text
    assert "The stress alone would move it by +3.00 %" in text
    assert "B4** moves" not in text  # it makes no peak
    assert "The peaks agree to 0.02 %, which is within the 0.1 %" in text
    assert "`acoustics.radiation` = 'bgt1'" in text
    assert not re.search(r"\bnan\b", text)


def test_water_that_differs_is_said_to_differ(study: Path, tmp_path: Path) -> None:
    from tools.paper_steps import water  # noqa: PLC0415

    make_water(2e-3).save(tmp_path / "beyond" / "composite" / "water.nc")
    text = "\n".join(water(PaperRuns(tmp_path, "ours"), tmp_path))
    assert "The peaks agree to 0.2 %, which is NOT within the 0.1 %" in text
    assert "Not computed yet" in "\n".join(water(PaperRuns(tmp_path / "none", "ours"), tmp_path))


def test_page_tells_what_was_fitted_and_what_moves_it(out: Path) -> None:
    text = (out / "paper.md").read_text()
    assert "| `film.thickness` | 0.7 mm to 2.2 mm | 1.5 mm | 1.123 mm |" in text
    assert "31 evaluations; the search ended by itself." in text
    assert "| composite, `film_shear_strain` | 0.09 | 0.09125 | +0.25 | 1.0456 |" in text
    assert "-1 by `film.thickness` = 1.123 mm" in text
    assert "run `quietblade study --calibrate --reading tensor" in text  # there is none of it


def test_page_tells_what_a_frequency_step_shows(out: Path) -> None:
    text = (out / "paper.md").read_text()
    rows = text.partition("## What the frequency step shows")[2].partition("\n## ")[0]
    found = re.findall(r"\| B5 \| ([\d.]+) \| [\d.-]+ \(([\d.-]+)\)", rows)
    assert found
    assert all(float(true) >= float(worst) for true, worst in found)


def test_headline_figures_are_data(out: Path) -> None:
    figures = json.loads((out / "paper.json").read_text())
    assert {"aluminium-ours", "composite-paper", "beyond/composite-bgt1"} <= set(figures)
    assert figures["composite-ours"]["C0"]["B6"]["frequency_hz"] > 100.0


def test_page_of_the_documentation_is_whole_and_light() -> None:
    pages = [DOCS / "paper.md", DOCS / "gallery.md"]
    drawn = {file for page in pages for file in pictures_of(page)}
    assert len(drawn) > 10
    sizes = np.array([file.stat().st_size for file in drawn])
    assert sizes.max() < 150e3
    assert sizes.sum() < 2e6
    assert {file.name for file in drawn} == {f.name for f in (DOCS / "gallery").glob("*.png")}
    text = (DOCS / "paper.md").read_text()
    assert not re.search(r"\bnan\b", text)
    figures = json.loads((DOCS / "paper.json").read_text())
    assert all(f"| {name} |" in text for name in figures)
