# SPDX-License-Identifier: LGPL-2.1-or-later
"""Older case files are read and rewritten, newer ones are refused."""

import tomllib

import pytest

from quietblade.case import Case, InvalidCaseError, parse_case
from quietblade.case.presets import PRESETS, preset_text
from quietblade.case.source import parse_source
from quietblade.case.versions import FORMAT, RENAMED, Renamed, migrated, migrated_text

# two keys that a later version might rename, one of them twice, and one in every material
RENAMES = (
    Renamed(2, "blade.length", "extent"),
    Renamed(3, "blade.extent", "span"),
    Renamed(3, "materials.*.youngs_modulus", "E"),
    Renamed(3, "loads.*.type", "kind"),
)
OLD = """\
# my blade
title = "a blade"

[blade]             # length = 1 is what it was
length = "1 m"      # from root to tip
[materials.metal]
youngs_modulus = "65 GPa"
[materials."the other"]
source = "a book"
youngs_modulus = "70 GPa"  # youngs_modulus of a sheet
[[loads]]
type = "pressure"
[[loads]]
"type" = "gravity"
"""


def test_an_older_file_gets_the_new_names() -> None:
    new = migrated(parse_source(OLD, "old.toml"), RENAMES, 3)
    assert new.data["format"] == 3
    assert new.data["blade"] == {"span": "1 m"}
    assert [m["E"] for m in new.data["materials"].values()] == ["65 GPa", "70 GPa"]
    assert [load["kind"] for load in new.data["loads"]] == ["pressure", "gravity"]
    assert new.line(("blade", "span")) == 5
    assert new.text == OLD


def test_only_what_is_newer_than_the_file_is_renamed() -> None:
    text = 'format = 2\n[blade]\nlength = "1 m"\nextent = "2 m"\n'
    new = migrated(parse_source(text, "old.toml"), RENAMES, 3)
    assert new.data["blade"] == {"length": "1 m", "span": "2 m"}


def test_a_file_is_rewritten_with_its_comments() -> None:
    plain = OLD.replace('"type"', "type")
    new = migrated_text(plain, "old.toml", RENAMES, 3)
    assert new == (
        plain.replace('title = "a', 'format = 3\ntitle = "a')
        .replace("\nlength =", "\nspan =")
        .replace("\nyoungs_modulus =", "\nE =")
        .replace("\ntype =", "\nkind =")
    )
    assert migrated_text(new, "old.toml", RENAMES, 3) == new


def test_what_cannot_be_rewritten_safely_is_left_to_the_user() -> None:
    with pytest.raises(InvalidCaseError, match=r"Write by hand: .*loads.*type is now kind"):
        migrated_text(OLD, "old.toml", RENAMES, 3)  # a key in quotes


def test_a_key_by_both_names_is_refused() -> None:
    text = OLD.replace("[materials.metal]", 'extent = "2 m"\n[materials.metal]')
    with pytest.raises(InvalidCaseError) as caught:
        migrated(parse_source(text, "old.toml"), RENAMES, 3)
    assert "old.toml:5: blade.length" in str(caught.value)
    assert "old name of blade.extent" in str(caught.value)


def test_a_newer_file_is_refused() -> None:
    text = preset_text("twisted").replace(f"format = {FORMAT} ", f"format = {FORMAT + 1} ")
    with pytest.raises(InvalidCaseError) as caught:
        Case.parse(text + "[surprise]\n")
    (problem,) = caught.value.problems
    assert (problem.key, problem.value) == ("format", str(FORMAT + 1))
    assert f"formats up to {FORMAT}" in problem.message
    assert "pip install --upgrade" in problem.remedy


@pytest.mark.parametrize("word", ["0", "-1", "1.0", "true", '"1"', "[1]"])
def test_a_format_is_a_whole_number(word: str) -> None:
    text = preset_text("twisted").replace(f"format = {FORMAT} ", f"format = {word} ")
    with pytest.raises(InvalidCaseError) as caught:
        Case.parse(text)
    (problem,) = caught.value.problems
    assert problem.key == "format"


def test_a_file_without_a_format_is_of_the_first() -> None:
    for name in PRESETS:
        text = preset_text(name)
        without = "".join(row for row in text.splitlines(True) if not row.startswith("format"))
        assert "format" not in tomllib.loads(without)
        assert parse_case(without).content_key() == parse_case(text).content_key()
        assert tomllib.loads(migrated_text(without, name)) == tomllib.loads(text)


def test_the_format_is_that_of_the_last_renaming() -> None:
    assert max((key.format for key in RENAMED), default=1) == FORMAT
    assert list(RENAMED) == sorted(RENAMED, key=lambda key: key.format)
