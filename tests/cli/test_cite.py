# SPDX-License-Identifier: LGPL-2.1-or-later
"""What to cite: every source that a case uses and none that it does not."""

import json
import re
from pathlib import Path
from typing import Any, get_args

import pytest

from quietblade.case import Case, parse_case, tables
from quietblade.case import flow as flow_words
from quietblade.case.presets import PRESETS, preset_text
from quietblade.cli.main import execute
from quietblade.results.bibliography import bibliography, parse_bibtex
from quietblade.results.files import ResultError
from quietblade.results.store import RunFolder
from quietblade.study import citations as module
from quietblade.study.citations import citations
from tests.results.synthetic import make_result

ROOT = Path(__file__).parents[2]


def keys(case: Case) -> set[str]:
    return {c.reference.key for c in citations(case) if c.reference}


def varied(**changes: Any) -> Case:
    case = Case.parse(preset_text("paper-composite"))
    return case.varied({key.replace("__", "."): value for key, value in changes.items()})


def test_every_entry_has_author_and_title_and_can_be_read_again() -> None:
    for entry in bibliography().values():
        assert entry.fields["author"]
        assert entry.fields["title"]
        assert not re.search(r"[{}\\]", entry.text())
        (again,) = parse_bibtex(entry.bibtex)
        assert again.fields == entry.fields


def test_text_of_an_entry() -> None:
    assert bibliography()["Everstine1981"].text() == (
        "Everstine, G. C. A symmetric potential formulation for fluid-structure interaction. "
        "Journal of Sound and Vibration. 79, 157-160. 1981"
    )


def test_a_missing_brace_is_named() -> None:
    with pytest.raises(ResultError, match="Broken2000"):
        list(parse_bibtex("@book{Broken2000,\n title = {No end\n"))


def test_there_is_one_bibliography_and_the_documentation_uses_it() -> None:
    assert [p.name for p in ROOT.glob("docs/**/*.bib")] == []
    assert "../src/quietblade/references.bib" in (ROOT / "docs/conf.py").read_text("utf-8")
    cited = set()
    for page in (ROOT / "docs").rglob("*.md"):
        for names in re.findall(r"\{cite\}`([^`]+)`", page.read_text("utf-8")):
            cited.update(name.strip() for name in names.split(","))
    assert cited <= set(bibliography())


@pytest.mark.parametrize(
    ("words", "table"),
    [
        (tables.Radiation, module._RADIATION),
        (flow_words.Inflow, module._INFLOWS),
        (flow_words.Control, module._CONTROLS),
        (flow_words.Friction, module._FRICTION),
    ],
)
def test_every_choice_of_a_case_has_its_sources(words: Any, table: dict[str, Any]) -> None:
    assert set(get_args(words)) == set(table)
    assert all(name.startswith(tuple(module._SECTIONS)) for name in get_args(tables.Section))


@pytest.mark.parametrize("preset", PRESETS)
def test_the_paper_comes_first_and_all_keys_are_known(preset: str) -> None:
    found = citations(parse_case(preset_text(preset)))
    assert found[0].reference is not None
    assert found[0].reference.key == "TwoStep"
    assert len({c.text for c in found}) == len(found)
    assert all(c.why for c in found)


def test_sources_follow_the_case() -> None:
    usual = keys(varied())
    assert {"Everstine1981", "Keller1989", "Boncoraglio2021", "Jones1999"} <= usual
    for changes, there in (
        ({"acoustics__radiation": "bgt1"}, {"Bayliss1982"}),
        ({"flow__inflow": "momentum"}, {"Ning2014"}),
        ({"flow__inflow": "lifting-line", "flow__control": "weissinger"}, {"Weissinger1947"}),
        ({"static__method": "anderson"}, {"Anderson1965"}),
        ({"acoustics__flow_damping": True}, {"Theodorsen1935"}),
        ({"blade__section": "naca-16-a10"}, {"Lindsey1948"}),
    ):
        assert not there & usual
        assert there <= keys(varied(**changes))
    assert "Keller1989" not in keys(varied(acoustics__radiation="bgt1"))
    assert "Boncoraglio2021" not in keys(varied(acoustics__configurations=["C0"]))
    assert "LuSuBai2016" not in keys(varied(acoustics__sweep="direct"))


def test_materials_of_the_library_are_cited_by_their_source() -> None:
    found = citations(varied(blade__material="nickel-aluminium-bronze"))
    (material,) = [c for c in found if c.reference is None]
    assert "nickel-aluminium-bronze" in material.why
    assert material.text


def test_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    case = tmp_path / "blade.toml"
    case.write_text(preset_text("paper-composite"), encoding="utf-8")
    assert execute(["cite", str(case)]) == 0
    text = capsys.readouterr().out
    assert "two-step method\n  The two-step paper." in text
    assert execute(["cite", str(case), "--bibtex"]) == 0
    entries = list(parse_bibtex(capsys.readouterr().out))
    assert {e.key for e in entries} == keys(Case.load(case)) | {"quietblade"}
    assert execute(["cite", str(case), "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)
    assert [row["key"] for row in rows][:2] == ["quietblade", "TwoStep"]
    assert all(row["bibtex"].startswith("@") for row in rows if row["key"])


def test_a_run_is_cited_by_its_case(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    RunFolder(tmp_path).save(make_result("aluminium", preset_text("paper-aluminium")))
    assert execute(["cite", str(tmp_path)]) == 0
    assert "The two-step paper" in capsys.readouterr().out
