# SPDX-License-Identifier: LGPL-2.1-or-later
"""The report: order, numbers, and that it needs nothing but itself."""

import json
import re
import shutil
import sys
from base64 import b64decode
from dataclasses import replace
from html.parser import HTMLParser
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from quietblade.case import Case
from quietblade.case.presets import preset_text
from quietblade.cli.main import execute
from quietblade.cli.report import case_words
from quietblade.results.answers import QUESTIONS, answers
from quietblade.results.evidence import evidence_tables
from quietblade.results.headline import summarise
from quietblade.results.store import RunFolder
from quietblade.results.table import Table
from quietblade.results.tables import summary_tables
from quietblade.study.citations import citation_table
from quietblade.view.report import render_report
from quietblade.view.report_order import SECTIONS, VIEW
from quietblade.view.report_pdf import PdfError, require_pdf
from tests.results.synthetic import make_result, with_static
from tests.view.test_figures import NAMES

ROOT = Path(__file__).resolve().parents[2]
CITED = citation_table(Case.parse(preset_text("paper-composite")), "1.2.3")
WEBP = "data:image/webp;base64,"


@pytest.fixture(scope="module")
def run(runs: tuple[RunFolder, ...], tmp_path_factory: pytest.TempPathFactory) -> RunFolder:
    """A run with a small picture in place of each figure."""
    copy = RunFolder(tmp_path_factory.mktemp("report") / "run")
    shutil.copytree(runs[1].root, copy.root, ignore=shutil.ignore_patterns("figures"))
    copy.figures.mkdir()
    random = np.random.default_rng(1)
    for name in sorted(NAMES):
        picture = random.integers(0, 256, (6, 9, 3), dtype=np.uint8)
        Image.fromarray(picture).save(copy.figures / f"{name}.png")
    return copy


@pytest.fixture(scope="module")
def plain(run: RunFolder) -> str:
    """The report without scripts."""
    words = [Table("Blade", (), (("span", "1000 mm <b>"),))]
    return render_report(
        run, make_result("composite"), words=words, others=[CITED], interactive=False
    )


class _Page(HTMLParser):
    def __init__(self, page: str) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.sources: list[str] = []
        self.targets: list[str] = []
        self.places: list[str] = []
        self.headings: list[str] = []
        self.feed(page)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self.sources += [v for k, v in attrs if k == "src" and v]
        self.targets += [v for k, v in attrs if k == "href" and v]
        self.places += [v for k, v in attrs if k == "id" and v]

    def handle_data(self, data: str) -> None:
        if self.tags and self.tags[-1] == "h2" and data.strip():
            self.headings.append(data)


def pixels(data: bytes) -> np.ndarray:
    with Image.open(BytesIO(data)) as image:
        return np.asarray(image.convert("RGB"))


def test_the_report_needs_nothing_else(plain: str, run: RunFolder) -> None:
    page, drawn = _Page(plain), sorted(run.figures.glob("*.png"))
    assert len(page.sources) == len(drawn)
    assert all(source.startswith(WEBP) for source in page.sources)
    assert {target[1:] for target in page.targets} <= set(page.places)
    shown = [pixels(b64decode(source.removeprefix(WEBP))) for source in page.sources]
    for file in drawn:  # every figure, pixel for pixel
        expected = pixels(file.read_bytes())
        assert any(np.array_equal(picture, expected) for picture in shown), file
    assert "script" not in page.tags
    assert "url(" not in plain
    # neither the case file nor the digits of the pictures, in which any four letters may occur
    own = re.sub(r"<pre>.*?</pre>|base64,[^\"]*|http-equiv", "", plain, flags=re.DOTALL)
    assert "http" not in own
    assert "default-src 'none'" in plain
    for part in ("The paper&#x27;s composite blade", "größe", "1182", "ngsolve", "1000 mm &lt;b"):
        assert part in plain, part


def test_sections_stand_in_the_order_in_which_people_ask(plain: str) -> None:
    headings = [h for h in _Page(plain).headings if h not in {"In short", "Case file"}]
    assert headings[: len(QUESTIONS) - 1] == list(QUESTIONS[:-1])
    assert headings[-5:] == [
        "Mesh", "What converged, and how", "Warnings", "Where it comes from", "What to cite",
    ]  # fmt: skip
    assert "More" not in headings


def test_everything_has_one_place() -> None:
    result = make_result("composite")
    tables = [*summary_tables(summarise(result)), *evidence_tables(result), CITED]
    placed = [title for section in SECTIONS for title in section.tables]
    assert len(placed) == len(set(placed))
    assert {table.title for table in tables} <= set(placed)
    figures = [name for section in SECTIONS for name in section.figures]
    assert len(figures) == len(set(figures))
    assert set(figures) == NAMES
    assert VIEW in figures


def test_what_a_user_adds_is_kept(run: RunFolder, tmp_path: Path) -> None:
    copy = RunFolder(tmp_path)
    shutil.copytree(run.figures, copy.figures)
    shutil.copy(copy.figures / "bands.png", copy.figures / "mine.png")
    assert 'id="more"' in render_report(copy, make_result("composite"), interactive=False)


def test_a_report_without_sound_links_only_to_what_it_has(run: RunFolder, tmp_path: Path) -> None:
    few = RunFolder(tmp_path)
    few.figures.mkdir()
    shutil.copy(run.figures / f"{VIEW}.png", few.figures)
    still = replace(make_result("composite"), configurations={})
    page = _Page(render_report(few, still, interactive=False))
    assert {target[1:] for target in page.targets} <= set(page.places)
    assert len(page.targets) >= 3


def test_the_case_text_cannot_break_the_report(run: RunFolder) -> None:
    result = make_result("composite", case_text="# $title <script>alert(1)</script>")
    result = replace(result, title="</script><script>alert(2)</script>")
    page = render_report(run, result)
    assert "<script>alert" not in page
    assert "# $title &lt;script&gt;" in page


def test_answers_are_those_of_the_result() -> None:
    result = make_result("composite")
    summary = summarise(result)
    found = dict(answers(summary).rows)
    assert list(found) == list(QUESTIONS)
    tip = 1e3 * np.linalg.norm(result.static.tip_displacement)
    assert f"{tip:.1f} mm" in found[QUESTIONS[0]]
    assert f"{summary.static.lift_n:.1f} N" in found[QUESTIONS[1]]
    modes = result.configurations["C1"].modes
    assert f"{modes.name[2]} {modes.frequency[2]:.1f}" in found[QUESTIONS[2]]
    top = max(summary.far_field.C0.peaks, key=lambda peak: peak.level_db or -1e9)
    assert f"{top.level_db:.1f} dB at {top.frequency_hz:.2f} Hz" in found[QUESTIONS[3]]
    assert "re 1 pW" in found[QUESTIONS[3]]
    share = 100.0 * summary.power_paths.C1.mean["water"]
    assert f"{share:.3g} % radiated into the water" in found[QUESTIONS[4]]
    assert "2 warnings" in found[QUESTIONS[5]]


def test_answers_of_a_static_run_that_failed_say_so() -> None:
    result = with_static(replace(make_result("aluminium"), configurations={}), converged=False)
    found = dict(answers(summarise(result)).rows)
    assert "did NOT converge" in found[QUESTIONS[0]]
    assert "did NOT converge" in found[QUESTIONS[5]]
    assert [found[question] for question in QUESTIONS[2:5]] == ["not computed"] * 3


def test_evidence_shows_each_pass() -> None:
    result = make_result("composite")
    tables = {table.title: table for table in evidence_tables(result)}
    passes = tables["Passes between flow and structure"]
    assert len(passes.rows) == result.static.iterations
    assert passes.rows[-1][4] == f"{result.static.history.lift[-1]:.2f}"
    unknowns = tables["Free unknowns of step 2"]
    assert unknowns.rows[-1] == ("all", str(result.mesh.unknowns.count.sum()))


def test_the_command_says_where_and_how_large(
    run: RunFolder, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "a.html"
    assert execute(["report", str(run.root), "--plain", "--out", str(file)]) == 0
    assert re.search(r"a\.html \(\d+\.\d MB\)", capsys.readouterr().out)
    # the text of the made-up run is no case
    assert "case.toml cannot be told in words" in file.read_text(encoding="utf-8")


def test_the_case_is_told_in_words_as_it_was_run(tmp_path: Path) -> None:
    from quietblade.case import Case  # noqa: PLC0415
    from quietblade.study.run import run_key  # noqa: PLC0415

    case = Case.load(ROOT / "cases/paper-composite.toml").varied({"mesh.size": "17 mm"})
    (tmp_path / "case.toml").write_text(case.text, encoding="utf-8")
    run = make_result("composite", case_text=case.text).run
    its = replace(run, content_key=run_key(case, run.code_version))
    words, (cited,) = case_words(tmp_path / "case.toml", its)
    told = {row for table in words for row in table.rows}
    assert cited == citation_table(case, run.code_version)
    assert any("17 mm on the blade" in value for _, value in told)
    (other,), cited_of_other = case_words(tmp_path / "case.toml", run)  # another key
    assert cited_of_other == ()
    assert "not the case of this result" in other.rows[0][1]


def test_pdf(run: RunFolder, capsys: pytest.CaptureFixture[str]) -> None:
    try:
        require_pdf()
    except PdfError as error:
        pytest.skip(str(error))
    assert execute(["report", str(run.root), "--pdf", "--json"]) == 0
    data = (run.root / "report.pdf").read_bytes()
    told = {"kind": "report", "path": str(run.root / "report.pdf"), "bytes": len(data)}
    assert json.loads(capsys.readouterr().out) == {"files": [told]}
    assert data.startswith(b"%PDF-")
    assert data.count(b"/Subtype /Image") >= len(NAMES)  # every figure is in it


def test_pdf_without_its_library_is_refused_before_anything_is_drawn(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "weasyprint", None)
    assert execute(["report", str(tmp_path), "--pdf"]) == 3
    assert 'pip install "quietblade[pdf]"' in " ".join(capsys.readouterr().err.split())
    assert not list(tmp_path.iterdir())
