# SPDX-License-Identifier: LGPL-2.1-or-later
"""What programs read: JSON on standard output and nothing else, and exit codes."""

import json
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from quietblade.case import Case
from quietblade.case.presets import preset_text
from quietblade.cli.common import ExitCode, show_json
from quietblade.cli.main import COMMANDS, execute
from quietblade.errors import ConvergenceError
from quietblade.results.store import RunFolder
from quietblade.study.run import run_key
from tests.results.synthetic import make_result

DOCS = Path(__file__).parents[2] / "docs"

STUDY = """
title = "Two meshes"
cases = { blade = "blade.toml" }
[variants.coarse]
"mesh.size" = "30 mm"
[variants.fine]
"mesh.size" = "22 mm"
"acoustics.step" = "2 Hz"
"""


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A case, a study, and a folder with a result of the case."""
    root = tmp_path_factory.mktemp("machine")
    (root / "blade.toml").write_text(preset_text("paper-aluminium"), encoding="utf-8")
    (root / "study.toml").write_text(STUDY, encoding="utf-8")
    (root / "wrong.toml").write_text("[blade]\nspan = 1\n", encoding="utf-8")
    result = make_result("aluminium", preset_text("paper-aluminium"))
    for name, converged in (("run", True), ("unsettled", False)):
        run = replace(result.run, content_key=run_key(Case.load(root / "blade.toml")))
        static = replace(result.static, converged=converged)
        RunFolder(root / name).save(replace(result, run=run, static=static))
    return root


@pytest.fixture
def ask(
    place: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> Callable[[str], tuple[int, Any]]:
    monkeypatch.chdir(place)

    def run(words: str) -> tuple[int, Any]:
        capsys.readouterr()
        code = execute([*words.split(), "--json"])
        return code, json.loads(capsys.readouterr().out)

    return run


@pytest.mark.parametrize(
    ("words", "kind", "holds"),
    [
        ("check blade.toml", dict, "forecast"),
        ("run blade.toml --out run -v", dict, "static"),
        ("cite run", list, None),
        ("study study.toml --plan", list, None),
        ("materials", dict, "aluminium-paper"),
    ],
)
def test_json_and_nothing_else(
    words: str, kind: type, holds: str | None, ask: Callable[[str], tuple[int, Any]]
) -> None:
    code, data = ask(words)
    assert code == ExitCode.DONE
    assert isinstance(data, kind)
    assert len(data) > 0
    assert holds is None or holds in data


@pytest.mark.parametrize(
    ("words", "kinds"),
    [
        ("new mine --force", {"case"}),
        ("new mine --schema --force", {"case", "schema"}),
        ("new --schema", {"schema"}),
        ("export blade.toml --step blade.step", {"step"}),
        ("export run --csv tables --msh blade.msh", {"csv", "msh"}),
    ],
)
def test_files_that_are_written(
    words: str, kinds: set[str], ask: Callable[[str], tuple[int, Any]]
) -> None:
    code, data = ask(words)
    assert (code, list(data)) == (ExitCode.DONE, ["files"])
    assert {file["kind"] for file in data["files"]} == kinds
    for file in data["files"]:
        assert list(file) == ["kind", "path", "bytes"]
        assert Path(file["path"]).stat().st_size == file["bytes"] > 0
    if "csv" in kinds:
        assert {file["path"] for file in data["files"] if file["kind"] == "csv"} == {
            str(path) for path in Path("tables").iterdir()
        }


def test_a_deck_comes_with_what_is_to_be_found_again(
    ask: Callable[[str], tuple[int, Any]],
) -> None:
    hydrofoil = preset_text("hydrofoil")
    text = re.sub(r"(?m)^size = .*", 'size = "40 mm"', hydrofoil)
    Path("foil.toml").write_text(text, encoding="utf-8")
    code, data = ask("export foil.toml --out foil.inp")
    assert (code, data["converged"]) == (ExitCode.DONE, True)
    assert [file["kind"] for file in data["files"]] == ["deck"]
    assert len(data["tip_displacement_m"]) == 3
    assert 1e-5 < max(map(abs, data["tip_displacement_m"])) < 1e-1


def test_run_and_show_print_the_same(ask: Callable[[str], tuple[int, Any]]) -> None:
    assert ask("run blade.toml --out run") == ask("show run")


def test_the_plan_of_a_study(ask: Callable[[str], tuple[int, Any]]) -> None:
    _, runs = ask("study study.toml --plan")
    assert [run["run"] for run in runs] == ["blade-coarse", "blade-fine"]
    assert runs[1]["changes"] == {"mesh.size": '"22 mm"', "acoustics.step": '"2 Hz"'}


@pytest.mark.parametrize(
    ("words", "code", "fragment"),
    [
        ("check wrong.toml", ExitCode.CASE_WRONG, "a bare number"),
        ("run wrong.toml", ExitCode.CASE_WRONG, "a bare number"),
        ("run nothing.toml", ExitCode.CASE_WRONG, "no such file"),
        ("study wrong.toml", ExitCode.CASE_WRONG, ""),
        ("materials gold", ExitCode.CASE_WRONG, "no material"),
        ("section naca2412 --thickness 0.1", ExitCode.CASE_WRONG, "in its name"),
        ("show nowhere", ExitCode.FAILED, "no result.nc"),
        ("cite nowhere", ExitCode.FAILED, "nowhere"),
        ("plot nowhere", ExitCode.FAILED, "no result.nc"),
        ("plot run --format gif", ExitCode.CASE_WRONG, "still pictures"),
        ("report nowhere", ExitCode.FAILED, "no result.nc"),
        ("new", ExitCode.CASE_WRONG, "the NAME of a case"),
        ("new --ask", ExitCode.CASE_WRONG, "somebody to answer"),
        ("new blade", ExitCode.CASE_WRONG, "exists already"),
        ("export blade.toml --vtkhdf fields", ExitCode.CASE_WRONG, "needs results"),
        ("export run --vtkhdf fields", ExitCode.FAILED, "static.vtu is missing"),
        ("show", ExitCode.CASE_WRONG, "Missing argument"),
        ("check --prest", ExitCode.CASE_WRONG, "--prest"),
    ],
)
def test_a_failure_is_json_too(
    words: str, code: ExitCode, fragment: str, ask: Callable[[str], tuple[int, Any]]
) -> None:
    ended, data = ask(words)
    assert (ended, data["exit_code"]) == (code, code)
    assert any(fragment in problem["message"] for problem in data["problems"])


def test_a_wrong_case_has_places_and_remedies(ask: Callable[[str], tuple[int, Any]]) -> None:
    _, data = ask("run wrong.toml")
    first = data["problems"][0]
    assert {"file", "line", "key", "value", "message", "remedy"} == set(first)
    assert ask("check wrong.toml")[1]["problems"] == data["problems"]


def test_every_exit_code(
    ask: Callable[[str], tuple[int, Any]], monkeypatch: pytest.MonkeyPatch
) -> None:
    assert ask("run blade.toml --out unsettled")[0] == 2
    for error, code in (
        (ConvergenceError("no solution"), 3),
        (MemoryError(), 3),
        (OSError(5, "Input/output error", "disk"), 3),
        (KeyboardInterrupt(), 130),
    ):

        def fails(*_: object, error: BaseException = error, **__: object) -> None:
            raise error

        monkeypatch.setattr("quietblade.study.run.build_mesh", fails)
        ended, data = ask("run blade.toml --out other")
        assert ended == data["exit_code"] == code
        assert data["problems"][0]["message"]


def test_the_page_tells_the_same_codes_and_all_commands() -> None:
    page = (DOCS / "command-line.md").read_text(encoding="utf-8")
    for code in ExitCode:
        assert f"| {int(code)} | {code.meaning} |" in page
    for name in COMMANDS:
        assert f"| `{name}` |" in page


def test_help_tells_the_codes(capsys: pytest.CaptureFixture[str]) -> None:
    execute(["--help"])
    shown = " ".join(capsys.readouterr().out.split())
    assert all(f"{int(code)} {code.meaning}" in shown for code in ExitCode)


def test_what_is_not_finite_is_null(capsys: pytest.CaptureFixture[str]) -> None:
    show_json({"a": [float("nan"), 1.0], "b": (float("inf"),)})
    assert json.loads(capsys.readouterr().out) == {"a": [None, 1.0], "b": [None]}


def test_a_plan_has_one_line_a_run(
    place: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(place)
    changes = {
        "acoustics.sphere_radius": "0.85 m", "acoustics.radiation": "bgt2",
        "film.thickness": "1.2 mm", "flow.inflow": "lifting-line", "static.method": "aitken",
    }  # fmt: skip
    more = "".join(f'"{key}" = "{value}"\n' for key, value in changes.items())
    (place / "long.toml").write_text(STUDY + more, encoding="utf-8")
    assert execute(["study", "long.toml", "--plan"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == ["1", "2"]
    assert max(map(len, lines)) > 140
