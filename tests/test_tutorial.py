# SPDX-License-Identifier: LGPL-2.1-or-later
"""The page of the tutorial says what its case says, and what its checks compute."""

import re
import shlex
import subprocess
from pathlib import Path

import pytest

from quietblade.case import Case
from quietblade.cli.main import execute
from quietblade.study import costs
from quietblade.study.outlook import look_ahead
from quietblade.study.preflight import preflight
from tools import draw_tutorial
from verification import tutorial
from verification.registry import CHECKS

PAGE = (Path(__file__).parents[1] / "docs" / "tutorial.md").read_text(encoding="utf-8")
WORDS = " ".join(PAGE.split())


@pytest.fixture(scope="module")
def case() -> Case:
    return Case.load(tutorial.CASE)


def test_the_pieces_of_the_page_are_the_case(case: Case) -> None:
    pieces = "".join(re.findall(r"^```toml\n(.*?)^```", PAGE, re.S | re.M))
    written = Case.parse(pieces, "tutorial.md")
    assert written.content_key() == case.content_key()
    assert written.title == case.title


def test_the_other_film_is_that_of_the_checks_and_the_pictures(case: Case, tmp_path: Path) -> None:
    (command,) = re.findall(r"^(sed .*?)\nquietblade", PAGE, re.S | re.M)
    (tmp_path / "my-hydrofoil.toml").write_text(case.text, encoding="utf-8")
    words = shlex.split(command.replace("\\\n", " "))
    assert words[-2:] == [">", "my-hydrofoil-acrylic.toml"]
    done = subprocess.run(words[:-2], cwd=tmp_path, capture_output=True, text=True, check=True)
    changed = Case.parse(done.stdout, "changed")
    assert changed.title == "Acrylic film"
    assert changed.material("film") == case.varied(draw_tutorial.ACRYLIC).material("film")
    assert draw_tutorial.ACRYLIC["film.material"] == tutorial.FILMS["acrylic"]
    assert case.film is not None
    assert case.film.material == tutorial.FILMS["rubber"]


def test_what_check_tells_is_on_the_page(case: Case) -> None:
    known = preflight(case)
    assert f"about {known.elements_per_bending_wavelength:.2g} elements per bending" in WORDS
    ahead = look_ahead(case, known, trial=costs._TRIAL)
    assert f"about {round(ahead.size.nodes, -2):,} nodes".replace(",", " ") in WORDS
    assert all(assumption.notice() is None for assumption in ahead.assumptions)
    said = " ".join(assumption.said for assumption in ahead.assumptions)
    assert "incidence 2.64 deg" in said
    assert "cavitation number 2.35" in said


def test_the_numbers_of_the_page_are_those_of_the_checks() -> None:
    rows = {name: check for name, check in CHECKS.items() if "/tutorial-" in name}
    assert len(rows) == 10
    tables = "".join(line for line in PAGE.splitlines(keepends=True) if line.startswith("|"))
    told = {float(text) for text in re.findall(r"(?<=\| )\d+\.\d+", tables)}
    for name, row in rows.items():
        assert row.reference in told or name == "acoustics/tutorial-film-law", name


def test_the_commands_of_the_page_are_commands(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    lines = re.findall(r"^quietblade (\w+) ", PAGE, re.M)
    assert {"check", "run", "compare", "plot", "report"} == set(lines)
    Path("my-hydrofoil.toml").write_text(tutorial.CASE.read_text(encoding="utf-8"), "utf-8")
    assert execute(["check", "my-hydrofoil.toml"]) == 0
    assert "glass-epoxy" not in capsys.readouterr().err
