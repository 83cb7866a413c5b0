# SPDX-License-Identifier: LGPL-2.1-or-later
"""Calibration: words, search on a made-up blade, replay of what is kept, sensitivities."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from quietblade.case import Case, InvalidCaseError
from quietblade.case.presets import preset_text
from quietblade.case.study_calibration import Calibration, ParameterWords, changed
from quietblade.cli.main import execute
from quietblade.errors import ConvergenceError, QuietbladeError
from quietblade.results.model import Result
from quietblade.results.store import RunFolder
from quietblade.study.calibration import calibrate, case_figures, stored_evaluations
from quietblade.study.fitting import write_closest, write_fitted, write_sensitivities
from quietblade.study.run import run_key
from quietblade.study.sensitivity import sensitivities
from quietblade.typing import Progress, silent
from tests.results.synthetic import make_result

FILE = """
title = "A film"

[cases]
composite = "c.toml"

[common]
"mesh.size" = "34 mm"

[fine]
"mesh.size" = "20 mm"

[[parameters]]
key = "film.thickness"
low = "0.8 mm"
high = "1.8 mm"
start = "1.5 mm"
reason = "it must fit"

[[parameters]]
key = "film.span[0]"
low = 0.02
high = 0.30
start = 0.05

[[parameters]]
key = "blade.alignment"
low = 0.25
high = 0.6
start = 0.5
search = false

[[choices]]
key = "excitation.side"
values = ["lower"]

[[targets]]
case = "composite"
figure = "film_shear_strain"
value = 0.09
scale = 0.005
readings = { tensor = 0.18 }

[[targets]]
case = "composite"
figure = "lift"
value = 1200.0
scale = 20.0
"""


class Made:
    """A blade whose film strain and lift are smooth functions of thickness and root of the film.

    The coarse mesh tells 4 % too little strain.
    """

    def __init__(self, *, saves: bool = False) -> None:
        self.runs = 0
        self.stops_after = 10**6
        self.saves = saves

    def __call__(self, case: Case, folder: RunFolder, progress: Progress = silent) -> Result:
        if self.runs >= self.stops_after:
            raise KeyboardInterrupt
        self.runs += 1
        assert case.film is not None
        if case.film.span[0] > 0.29:
            raise ConvergenceError("no equilibrium")
        thickness, root = 1e3 * case.film.thickness, case.film.span[0]
        strain = 0.126 / thickness * (1.0 - 0.6 * root) * (0.96 if case.mesh.size > 0.03 else 1.0)
        lift = 1000.0 + 300.0 * np.exp(-3.0 * root) + 40.0 * thickness
        blank = make_result("composite")
        static = replace(
            blank.static,
            max_film_shear_strain=strain,
            lift=np.array([950.0, 1000.0, lift]),
        )
        run = replace(blank.run, content_key=run_key(case))
        result = replace(blank, static=static, run=run)
        if self.saves:
            folder.save(result)
        return result


@pytest.fixture
def file(tmp_path: Path) -> Path:
    (tmp_path / "c.toml").write_text(preset_text("paper-composite"), encoding="utf-8")
    path = tmp_path / "calibration.toml"
    path.write_text(FILE, encoding="utf-8")
    return path


def test_search_meets_its_targets_on_the_fine_scale(file: Path) -> None:
    words, made = Calibration.load(file), Made()
    found = calibrate(words, file.parent / "out", runner=made)
    assert found.settled
    assert found.cost[1] < 1e-2 < found.cost[0]
    assert found.correction["composite/film_shear_strain"] == pytest.approx(1 / 0.96)
    thickness, root = (found.best.values[k] for k in ("film.thickness", "film.span[0]"))
    fine = 0.126 / float(thickness.split()[0]) * (1.0 - 0.6 * root)
    assert fine == pytest.approx(0.09, abs=5e-4)
    assert found.evaluations == found.computed == made.runs - 1  # and one on the fine mesh


def test_interrupted_search_replays_and_goes_on(file: Path) -> None:
    words, root = Calibration.load(file), file.parent / "out"
    whole = calibrate(words, file.parent / "other", runner=Made())
    made = Made()
    made.stops_after = 5
    with pytest.raises(KeyboardInterrupt):
        calibrate(words, root, runner=made)
    made.stops_after = 10**6
    found = calibrate(words, root, runner=made)
    assert made.runs == whole.computed + 1
    assert found.computed == whole.computed - 4
    assert found.best == whole.best
    assert found.path == whole.path
    assert calibrate(words, root, runner=made).computed == 0


def test_search_stops_where_its_evaluations_end(file: Path) -> None:
    file.write_text(f"{FILE}\n[search]\nevaluations = 3\n")
    found = calibrate(Calibration.load(file), file.parent / "out", runner=Made())
    assert not found.settled
    assert found.evaluations == 3


def test_spread_evaluations_are_the_same_each_time(file: Path) -> None:
    file.write_text(f"{FILE}\n[search]\nevaluations = 6\nsamples = 4\nseed = 3\n")
    words = Calibration.load(file)
    paths = [calibrate(words, file.parent / name, runner=Made()).path for name in ("a", "b")]
    assert paths[0] == paths[1]


def test_other_reading_has_its_own_target_and_reaches_a_bound(file: Path) -> None:
    words, root = Calibration.load(file), file.parent / "out"
    found = calibrate(words, root, "tensor", runner=Made())
    tables = write_fitted(words, found, root)
    assert found.best.values["film.thickness"] == "0.8 mm"
    assert "at its low bound" in (root / "calibration-tensor.txt").read_text()
    assert json.loads((root / "calibration-tensor.json").read_text())["reading"] == "tensor"
    assert tables[1].rows[0][2] == "0.18"
    with pytest.raises(QuietbladeError, match="known: tensor"):
        calibrate(words, root, "tensr", runner=Made())


def test_closest_run_to_each_claim_is_named(file: Path) -> None:
    file.write_text(f"{FILE}\n[search]\nevaluations = 2\n")
    words, root = Calibration.load(file), file.parent / "out"
    calibrate(words, root, runner=Made(saves=True))
    rows = {row[0]: row for row in write_closest(root).rows}
    met, of = rows["paper/composite/film-shear-strain"][3].split(" of ")
    assert 0 < int(met) <= int(of)
    assert rows["paper/composite/film-shear-strain"][4].startswith("evaluations/")
    assert (root / "closest.csv").read_text().startswith("claim,paper,closest,met by,run\n")


def test_failed_evaluations_are_kept_with_their_reason(file: Path) -> None:
    words, root, made = Calibration.load(file), file.parent / "out", Made()
    found = sensitivities(words, root, runner=made)
    failed = [e for e in found.effects if e.evaluation.failure]
    assert [(e.key, e.value) for e in failed] == [("film.span[0]", "0.3")]
    assert "no equilibrium" in failed[0].evaluation.failure
    before = made.runs
    again = sensitivities(words, root, runner=made)
    assert [e.evaluation for e in again.effects] == [e.evaluation for e in found.effects]
    assert made.runs == before
    assert len(stored_evaluations(root / "sensitivities")) == before


def test_sensitivities_have_the_right_signs(file: Path) -> None:
    words, root = Calibration.load(file), file.parent / "out"
    found = sensitivities(words, root, runner=Made())
    assert found.slope("film.thickness", "composite", "film_shear_strain") < 0.0
    assert found.slope("film.thickness", "composite", "lift") == pytest.approx(40.0, rel=1e-6)
    assert found.slope("blade.alignment", "composite", "lift") == 0.0
    assert np.isnan(found.slope("excitation.side", "composite", "lift"))
    write_sensitivities(words, found, root)
    heads, *lines = (root / "sensitivities.csv").read_text().splitlines()
    assert heads == "key,value,case,figure,start,there,change,slope,failure"
    assert any(line.startswith("film.thickness,") for line in lines)


def test_entries_of_lists_are_changed_one_by_one() -> None:
    case = Case.parse(preset_text("paper-composite"))
    both = changed(case, {"film.span[0]": 0.1, "film.span[1]": 0.8, "film.thickness": "1 mm"})
    assert both.film is not None
    assert both.film.span == (0.1, 0.8)
    width = both.film.chord[1] - both.film.chord[0]
    assert case_figures(both)["film_aspect"] == pytest.approx(0.7 / (width * 0.17125))
    with pytest.raises(InvalidCaseError, match="not an entry of a list"):
        changed(case, {"film.thickness[0]": 1.0})


def test_values_keep_their_unit() -> None:
    words = ParameterWords(key="film.thickness", low="0.8 mm", high="1.8 mm")
    assert words.value(0.25) == "1.05 mm"
    assert words.place("1.3 mm") == pytest.approx(0.5)


BAD = {
    "reversed": ('low = "0.8 mm"', 'low = "2 mm"', "is not above low"),
    "two units": ('high = "1.8 mm"', 'high = "1.8 cm"', "another unit"),
    "start": ('start = "1.5 mm"', 'start = "2.5 mm"', "does not lie between"),
    "no number": ("low = 0.02", 'low = "thin"', "is not a number"),
    "no case": ('case = "composite"', 'case = "steel"', "is not a case"),
    "twice": ('key = "film.span[0]"', 'key = "film.thickness"', "is there twice"),
    "scale": ("scale = 20.0", "scale = 0", "must be above 0"),
    "key": ('key = "film.span[0]"', 'key = "film.spam[0]"', "not an entry of a list"),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_calibration_files_are_explained(
    name: str, file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    old, new, message = BAD[name]
    assert old in FILE
    file.write_text(FILE.replace(old, new))
    code = execute(["study", "--calibrate", str(file), "--out", str(file.parent / "out")])
    assert code in (1, 3)
    assert message in capsys.readouterr().err


def test_calibration_of_the_paper_can_be_read() -> None:
    words = Calibration.load(Path(__file__).parents[2] / "cases" / "paper-calibration.toml")
    assert words.readings == ("tensor",)
    assert all(p.reason for p in words.parameters)
    for name in words.cases:
        changed(words.base(name), {p.key: p.value(p.first) for p in words.parameters})
