# SPDX-License-Identifier: LGPL-2.1-or-later
"""Documents against the source: equation labels, commands, cases, table of the radiation page."""

import re
import subprocess
import tomllib
from pathlib import Path

import pytest

from quietblade.case import BodyCase, Case
from quietblade.case.library import NAMES, SOURCE_OF
from quietblade.study.body_preflight import body_preflight
from quietblade.study.preflight import preflight
from tools import case_reference, draw_house
from verification.acoustics_closed_forms import bgt1, power_ratio

ROOT = Path(__file__).resolve().parent.parent
LABEL = re.compile(r"\bS[12]-\d+\b")
TEXT = {".bib", ".cff", ".in", ".json", ".lock", ".md", ".py", ".svg", ".toml", ".txt", ""}


def made(part: str) -> bool:
    """Whether a folder holds what was made or installed."""
    return part in {"build", "runs", "_generated", "__pycache__"} or (
        part.startswith(".") and part != ".ci"
    )


def own_files() -> list[Path]:
    """Files of the repository: those that git knows or would add; in an archive, all."""
    command = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    try:
        done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
        found = [ROOT / name for name in done.stdout.split("\0") if name]
    except (OSError, subprocess.CalledProcessError):
        found = [
            path for path in ROOT.rglob("*") if not any(map(made, path.relative_to(ROOT).parts))
        ]
    return [path for path in found if path.is_file() and path.suffix in TEXT]


def defined_labels() -> list[str]:
    pages = (page.read_text(encoding="utf-8") for page in sorted(ROOT.glob("docs/theory*.md")))
    return [label for text in pages for label in re.findall(r"\\tag\{(S[12]-\d+)\}", text)]


def cited_labels() -> dict[str, set[str]]:
    """Labels by file, wherever source, tests and documents name one."""
    folders = ("src", "verification", "benchmarks", "tests", "docs")
    files = [
        p for folder in folders for p in (ROOT / folder).rglob("*") if p.suffix in {".py", ".md"}
    ]
    cited = {
        str(p.relative_to(ROOT)): set(LABEL.findall(p.read_text(encoding="utf-8"))) for p in files
    }
    return {name: labels for name, labels in cited.items() if labels}


def test_every_cited_equation_exists() -> None:
    defined = set(defined_labels())
    assert {
        name: labels - defined for name, labels in cited_labels().items() if labels - defined
    } == {}


def test_every_equation_is_cited_by_code_or_declared_explanatory() -> None:
    cited: set[str] = set()
    for folder in ("src", "verification"):
        for file in (ROOT / folder).rglob("*.py"):
            text = file.read_text(encoding="utf-8")
            cited |= set(LABEL.findall(text))
            for step, first, last in re.findall(r"\bS([12])-(\d+) to S[12]-(\d+)\b", text):
                cited |= {f"S{step}-{k}" for k in range(int(first), int(last) + 1)}
    explained = set()
    for page in ROOT.glob("docs/theory*.md"):
        declared = re.findall(r"^Explanatory only: (.*)\.$", page.read_text(encoding="utf-8"), re.M)
        explained |= {label for line in declared for label in LABEL.findall(line)}
    assert set(defined_labels()) - cited - explained == set()
    assert explained & cited == set()  # what code cites explains more


def test_labels_are_unique_and_have_an_anchor() -> None:
    labels = defined_labels()
    assert len(labels) == len(set(labels)) > 20
    for page in ROOT.glob("docs/theory*.md"):
        text = page.read_text(encoding="utf-8")
        assert re.findall(r"^\((S[12]-\d+)\)=$", text, re.M) == re.findall(
            r"\\tag\{(S[12]-\d+)\}", text
        )


def test_drawing_of_the_house_has_every_room_in_its_order() -> None:
    drawing = (ROOT / "docs" / "_static" / "house.svg").read_text(encoding="utf-8")
    rooms = [room for storey in draw_house.layers() for room in storey]
    places = [drawing.find(f">{room}</text>") for room in rooms]
    assert len(rooms) > 8
    assert min(places) > 0
    assert places == sorted(places)
    assert set(rooms) | {"case"} == set(draw_house.contents())


def makefile_targets() -> set[str]:
    text = (ROOT / "Makefile").read_text(encoding="utf-8")
    return set(re.findall(r"^([a-z-]+):(?!=)", text, re.M))


@pytest.mark.parametrize("name", ["README.md", "docs/getting-started.md", "docs/architecture.md"])
def test_make_commands_of_documents_exist(name: str) -> None:
    text = (ROOT / name).read_text(encoding="utf-8")
    named = set(re.findall(r"(?:^|`)make ([a-z-]+)", text, re.M))
    assert named
    assert named <= makefile_targets()


def test_readme_begins_with_two_commands() -> None:
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    section = text.split("## Two commands")[1].split("##")[0]
    assert re.search(r"```sh\nmake demo\nmake test\n```", section)


def toml_examples(name: str) -> list[str]:
    return re.findall(r"```toml\n(.*?)```", (ROOT / name).read_text(encoding="utf-8"), re.S)


def test_readme_case_is_a_case() -> None:
    (example,) = toml_examples("README.md")
    assert Case.parse(example).blade.hub_radius == pytest.approx(0.15)


def of_body(example: str) -> bool:
    return "[body]" in example or "at = [1, 0, 0]" in example


def test_examples_of_the_case_page_of_a_body_are_cases() -> None:
    whole, force = (text for text in toml_examples("docs/case-file.md") if of_body(text))
    case = BodyCase.parse(whole)
    assert not body_preflight(case).notices
    pushed = case.varied({"excitation": tomllib.loads(force)["excitation"]})
    assert [words.kind for words in pushed.excitation] == ["point-force"]


def test_examples_of_the_case_page_fit_into_a_case() -> None:
    whole = Case.parse(toml_examples("README.md")[0])
    examples = [text for text in toml_examples("docs/case-file.md") if not of_body(text)]
    assert len(examples) > 5
    for example in examples:
        words = tomllib.loads(example)
        lists = {name: rows for name, rows in words.items() if isinstance(rows, list)}
        tables = {name: table for name, table in words.items() if name not in lists}
        keys = {f"{name}.{key}": value for name, t in tables.items() for key, value in t.items()}
        assert keys or lists
        whole.varied(keys | lists)


def test_case_of_the_page_of_modes_is_a_case() -> None:
    (example,) = toml_examples("docs/modes.md")
    case = Case.parse(example)
    assert case.campbell is not None
    assert case.acoustics.flow_damping
    preflight(case)


def test_every_key_of_a_case_is_in_its_reference() -> None:
    page = "\n".join(case_reference.keys())
    models = [*Case.model_json_schema()["$defs"].values()]
    models += BodyCase.model_json_schema()["$defs"].values()
    keys = {key for model in models for key in model.get("properties", {})}
    assert len(keys) > 80
    assert {k for k in keys if f"| `{k}` |" not in page and f".{k}]`" not in page} == set()


def test_every_material_of_the_library_is_listed_with_its_source() -> None:
    for name in NAMES:
        entry = case_reference.material(name)
        assert entry.startswith(f"`{name}`")
        assert SOURCE_OF[name] in entry


def test_readme_python_example_runs(capsys: pytest.CaptureFixture[str]) -> None:
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    code = re.findall(r"```python\n(.*?)```", text, re.S)[0]
    exec(compile(code, "README.md", "exec"), {})
    assert capsys.readouterr().out.strip()


def test_nothing_names_a_machine_or_a_workplace() -> None:
    # Joined here, so that this file does not contain them.
    forbidden = ["/" + "work/", "/" + "root/", "/" + "farm/", "shared" + "/", "file:" + "///"]
    found = {
        str(path.relative_to(ROOT)): word
        for path in own_files()
        for word in forbidden
        if word in path.read_text(encoding="utf-8", errors="replace")
    }
    assert found == {}


def test_radiation_table_of_the_theory_page() -> None:
    text = (ROOT / "docs" / "theory-step2.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| ([\d.]+) \| ([\d.]+) \| ([\d.]+) \|$", text, re.M)
    assert len(rows) >= 5
    for kr, dipole, quadrupole in (map(float, row) for row in rows):
        assert dipole == pytest.approx(power_ratio(1, kr, bgt1), rel=5e-3)
        assert quadrupole == pytest.approx(power_ratio(2, kr, bgt1), rel=5e-3)
