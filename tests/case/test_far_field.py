# SPDX-License-Identifier: LGPL-2.1-or-later
"""Far field, bands and limits as a user writes them."""

from pathlib import Path

import numpy as np
import pytest

from quietblade.case import Case, InvalidCaseError
from quietblade.case.presets import preset_text
from quietblade.cli.describe import case_tables
from quietblade.study.limits import bands_of, limits
from quietblade.study.preflight import preflight

BASE = preset_text("paper-aluminium")

ASKED = """
[far_field]
frequencies = ["120 Hz"]
distance = "10 m"
planes = ["yz", "xy"]
points = [["0 m", "3 m", "0.7 m"]]

[bands]
kind = "third-octave"

[[limits]]
name = "hull"
quantity = "source-level"
bands = "decidecade"
frequencies = ["50 Hz", "500 Hz"]
levels = ["120 dB", "-5 dB"]
"""


def test_a_case_without_them_has_the_defaults() -> None:
    case = Case.parse(BASE)
    assert case.far_field.planes == ("xy", "xz", "yz")
    assert case.far_field.distance is None
    assert (case.bands.kind, case.limits) == ("decidecade", ())


def test_what_is_asked_is_read_and_told() -> None:
    case = Case.parse(BASE + ASKED)
    assert case.far_field.points == ((0.0, 3.0, 0.7),)
    assert case.limits[0].levels == (120.0, -5.0)
    assert Case.from_plain(case.plain()) == case
    (limit,) = limits(case)
    assert limit.at(np.array([np.sqrt(50.0 * 500.0)])) == pytest.approx(57.5)  # straight over lg f
    told = dict(dict(case_tables(case, preflight(case)))["Sound far away"])
    assert told["directivity"] == "at 10 m, planes yz, xy, at the peaks, 120 Hz"
    assert told["limit"] == "hull: source-level, bands decidecade, 2 levels"


@pytest.mark.parametrize(
    ("old", "new", "key", "part"),
    [
        ('["yz", "xy"]', '["yx"]', "far_field.planes[0]", 'Known: "xy", "xz", "yz"'),
        ('["yz", "xy"]', '["yz", "yz"]', "far_field.planes", "names a plane twice"),
        ('"10 m"', '"10 Hz"', "far_field.distance", "a length is needed"),
        ('"third-octave"', '"octave"', "bands.kind", 'Did you mean "third-octave"?'),
        ('name = "hull"', 'nam = "hull"', "limits[0].nam", 'Did you mean "name"?'),
        ('"source-level"', '"pressure"', "limits[0].quantity", '"sound-power", "source-level"'),
        ('"120 dB", "-5 dB"', '"120 dB"', "limits[0].levels", "1 levels for 2 frequencies"),
        ('"120 dB"', '"120 Pa"', "limits[0].levels[0]", "a pressure where a level is needed"),
        ('"50 Hz", "500 Hz"', '"500 Hz", "50 Hz"', "limits[0].frequencies", "does not ascend"),
        ('levels = ["120 dB", "-5 dB"]', 'table = "x.csv"', "limits[0]", "either frequencies"),
        ("[[limits]]", "[limits]", "limits", "[[ ]]"),
    ],
)  # fmt: skip
def test_wrong_words_are_refused(old: str, new: str, key: str, part: str) -> None:
    assert old in ASKED
    with pytest.raises(InvalidCaseError) as error:
        Case.parse(BASE + ASKED.replace(old, new))
    assert any(p.key == key and part in str(p) for p in error.value.problems), str(error.value)


@pytest.mark.parametrize(
    ("old", "new", "key", "part"),
    [
        ('"120 Hz"', '"1200 Hz"', "far_field.frequencies[0]", "outside the band"),
        ('"10 m"', '"0.5 m"', "far_field.distance", "inside the sphere"),
        ('"3 m", "0.7 m"', '"0 m", "0.7 m"', "far_field.points[0]", "less than a cell"),
    ],
)
def test_impossible_places_are_refused_before_a_run(
    old: str, new: str, key: str, part: str
) -> None:
    with pytest.raises(InvalidCaseError) as error:
        preflight(Case.parse(BASE + ASKED.replace(old, new)))
    assert any(p.key == key and part in str(p) for p in error.value.problems), str(error.value)


def with_table(folder: Path, text: str | None) -> Case:
    """Case whose limit is a file with this text, or without the file."""
    if text is not None:
        (folder / "limit.csv").write_text(text, encoding="utf-8")
    words = '\n[[limits]]\nname = "hull"\ntable = "limit.csv"\n'
    file = folder / "case.toml"
    file.write_text(BASE + words, encoding="utf-8")
    return Case.load(file)


def test_limit_of_a_file(tmp_path: Path) -> None:
    case = with_table(tmp_path, "frequency, level\n10, 130\n1000, 110\n")
    (limit,) = limits(case)
    assert limit.at(np.array([100.0])) == pytest.approx(120.0)
    key = case.content_key()
    changed = with_table(tmp_path, "frequency, level\n10, 130\n1000, 111\n")
    assert changed.content_key() != key  # what the file says counts


@pytest.mark.parametrize(
    ("text", "part"),
    [
        (None, "No such file"),
        ("", "columns are unnamed"),
        ("f;L\n1;2\n", "columns are f;L"),
        ("frequency,level\n10,x\n", "'10,x' is not two numbers"),
        ("frequency,level\n10,3,4\n", "'10,3,4' is not two numbers"),
        ("frequency,level\n", "positive ascending frequencies"),
        ("frequency,level\n20,3\n10,3\n", "positive ascending frequencies"),
        ("frequency,level\n20,nan\n", "one finite level"),
    ],
)
def test_unreadable_files_are_refused(tmp_path: Path, text: str | None, part: str) -> None:
    with pytest.raises(InvalidCaseError) as error:
        preflight(with_table(tmp_path, text))
    (problem,) = error.value.problems
    assert problem.key == "limits[0].table"
    assert part in str(problem)


def test_a_limit_that_does_not_touch_the_band_is_noticed() -> None:
    elsewhere = ASKED.replace('"50 Hz", "500 Hz"', '"1 Hz", "5 Hz"')
    notices = preflight(Case.parse(BASE + elsewhere)).notices
    assert any("'hull' holds for no frequency" in n.message for n in notices)


def test_kinds_of_bands() -> None:
    ten, two = (bands_of(kind, 90.0, 2100.0) for kind in ("decidecade", "third-octave"))
    assert ten.centre[0] == pytest.approx(100.0)
    assert ten.centre[-1] == pytest.approx(1995.262, rel=1e-6)
    assert two.centre[-1] == pytest.approx(2000.0)
    np.testing.assert_allclose(two.upper / two.lower, 2.0 ** (1.0 / 3.0))
    np.testing.assert_allclose(two.lower[1:], two.upper[:-1])
