# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command line: help, new and check; exit codes and what is shown where."""

import json
import os
import re
import subprocess
import sys
from math import pi
from pathlib import Path

import pytest

from quietblade.case.presets import PRESETS, preset_text
from quietblade.case.schema import case_schema
from quietblade.case.versions import FORMAT
from quietblade.cli.common import ExitCode, show_error
from quietblade.cli.main import COMMANDS, execute
from quietblade.errors import CaseError, ConvergenceError, MeshError

HEAVY = ("numpy", "scipy", "pydantic", "pint", "ngsolve", "gmsh", "matplotlib", "pyvista", "xarray")


@pytest.fixture(autouse=True)
def _in_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def imported_by(*arguments: str) -> set[str]:
    """Top-level modules that a command imports, in a process of its own."""
    code = (
        "import sys; from quietblade.cli.main import execute; execute(sys.argv[1:]); "
        "sys.stderr.write(' '.join({m.split('.')[0] for m in sys.modules}))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, *arguments], capture_output=True, text=True, check=True
    )
    return set(done.stderr.split())


def test_help_is_light() -> None:
    found = imported_by("--help")
    assert "typer" in found
    assert not found.intersection(HEAVY)


def test_help_takes_less_than_half_a_second_of_work() -> None:
    def work() -> float:
        before = os.times()
        subprocess.run(
            [sys.executable, "-m", "quietblade.cli.main", "--help"], capture_output=True, check=True
        )
        after = os.times()
        return (after.children_user + after.children_system) - (
            before.children_user + before.children_system
        )

    assert min(work() for _ in range(3)) < 0.5


def test_check_needs_no_mesher_and_no_finite_elements() -> None:
    assert execute(["new", "blade"]) == ExitCode.DONE
    found = imported_by("check", "blade.toml")
    assert "pydantic" in found
    assert not found.intersection(("ngsolve", "gmsh", "netgen", "pyvista", "matplotlib"))


def test_a_wrong_case_ends_before_the_geometry_is_imported(tmp_path: Path) -> None:
    (tmp_path / "blade.toml").write_text("[blade]\nspan = 1\n")
    assert not imported_by("check", "blade.toml").intersection(("scipy", "ngsolve", "gmsh"))


def test_help_lists_the_commands_that_are_there(capsys: pytest.CaptureFixture[str]) -> None:
    assert execute([]) == ExitCode.DONE
    shown = capsys.readouterr().out
    assert "quietblade" in shown
    for name in ("new", "check"):
        assert name in shown
        assert name in COMMANDS


@pytest.mark.parametrize("preset", PRESETS)
def test_new_then_check(preset: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert execute(["new", "mine", "--preset", preset]) == ExitCode.DONE
    assert "quietblade check mine.toml" in capsys.readouterr().out
    assert Path("mine.toml").read_text(encoding="utf-8") == preset_text(preset)
    assert execute(["check", "mine.toml"]) == ExitCode.DONE
    seen = capsys.readouterr()
    for fragment in ("kR = ", "elements per wavelength", "mm", "Hz"):
        assert fragment in seen.out
    assert execute(["check", "mine.toml", "--json"]) == ExitCode.DONE


def test_new_does_not_replace_a_file_unasked(capsys: pytest.CaptureFixture[str]) -> None:
    Path("mine.toml").write_text("mine")
    assert execute(["new", "mine.toml"]) == ExitCode.CASE_WRONG
    assert "exists already" in capsys.readouterr().err
    assert Path("mine.toml").read_text() == "mine"
    assert execute(["new", "mine.toml", "--force"]) == ExitCode.DONE
    assert Path("mine.toml").read_text(encoding="utf-8") == preset_text("paper-aluminium")


def test_new_with_an_unknown_preset(capsys: pytest.CaptureFixture[str]) -> None:
    assert execute(["new", "mine", "--preset", "paper-aluminum"]) == ExitCode.CASE_WRONG
    assert 'Did you mean "paper-aluminium"?' in capsys.readouterr().err
    assert not Path("mine.toml").exists()


def test_new_with_the_schema_for_editors(capsys: pytest.CaptureFixture[str]) -> None:
    assert execute(["new", "blades/mine", "--schema"]) == ExitCode.DONE
    text = Path("blades/mine.toml").read_text(encoding="utf-8")
    first, rest = text.split("\n", 1)
    assert first == "#:schema ./quietblade.schema.json"
    assert rest == preset_text("paper-aluminium")
    written = json.loads(Path("blades/quietblade.schema.json").read_text(encoding="utf-8"))
    assert written == case_schema()
    assert execute(["check", "blades/mine.toml"]) == ExitCode.DONE
    capsys.readouterr()
    assert execute(["new", "--schema"]) == ExitCode.DONE
    assert "quietblade.schema.json" in capsys.readouterr().out
    assert [path.name for path in Path().glob("*.*")] == ["quietblade.schema.json"]


def test_check_rewrites_an_older_file(capsys: pytest.CaptureFixture[str]) -> None:
    text = preset_text("twisted")
    older = "".join(row for row in text.splitlines(True) if not row.startswith("format"))
    Path("mine.toml").write_text(older, encoding="utf-8")
    assert execute(["check", "mine.toml"]) == ExitCode.DONE
    assert Path("mine.toml").read_text(encoding="utf-8") == older
    assert execute(["check", "--migrate", "mine.toml"]) == ExitCode.DONE
    new = Path("mine.toml").read_text(encoding="utf-8")
    assert new == older.replace("title = ", f"format = {FORMAT}\ntitle = ")
    Path("mine.toml").write_text(new.replace(f"format = {FORMAT}", "format = 99"))
    capsys.readouterr()
    assert execute(["check", "mine.toml", "--migrate"]) == ExitCode.CASE_WRONG
    assert "of a newer quietblade" in capsys.readouterr().err


def test_migration_leaves_alone_what_is_not_a_case(capsys: pytest.CaptureFixture[str]) -> None:
    text = 'title = "mine"\n'
    Path("mine.toml").write_text(text)
    assert execute(["check", "--migrate", "mine.toml"]) == ExitCode.CASE_WRONG
    assert "mine.toml: mesh: this table is missing" in capsys.readouterr().err
    assert Path("mine.toml").read_text() == text
    Path("link.toml").symlink_to("blade.toml")
    Path("blade.toml").write_text(preset_text("twisted").replace("format = 1", "# none"))
    assert execute(["check", "--migrate", "link.toml"]) == ExitCode.DONE
    assert Path("link.toml").is_symlink()
    assert f"\nformat = {FORMAT}\n" in Path("blade.toml").read_text(encoding="utf-8")


def test_only_files_are_replaced(capsys: pytest.CaptureFixture[str]) -> None:
    os.mkfifo("pipe.toml")
    assert execute(["new", "pipe", "--force"]) == ExitCode.CASE_WRONG
    assert "pipe.toml is not a file that could be replaced" in capsys.readouterr().err
    assert Path("pipe.toml").is_fifo()


def test_what_the_system_refuses_is_told_in_a_line(capsys: pytest.CaptureFixture[str]) -> None:
    for arguments in (["new", "a" * 300], ["show", "a" * 300], ["report", "a" * 300]):
        assert execute(arguments) in (ExitCode.CASE_WRONG, ExitCode.FAILED)
        (row,) = capsys.readouterr().err.splitlines()
        assert row.startswith("error aaa")
        assert row.endswith("File name too long")


def test_presets_are_named_in_the_help(capsys: pytest.CaptureFixture[str]) -> None:
    assert execute(["new", "--help"]) == ExitCode.DONE
    shown = capsys.readouterr().out
    assert all(name in shown for name in PRESETS)


def test_new_in_a_place_that_cannot_be_written(capsys: pytest.CaptureFixture[str]) -> None:
    Path("file").write_text("")
    assert execute(["new", "file/mine"]) == ExitCode.CASE_WRONG
    assert "cannot be written" in capsys.readouterr().err


def test_check_lists_all_problems(capsys: pytest.CaptureFixture[str]) -> None:
    text = preset_text("paper-aluminium")
    text = text.replace('span = "1 m"', "span = 1").replace('"23 mm"', '"23 kg"')
    Path("mine.toml").write_text(text, encoding="utf-8")
    assert execute(["check", "mine.toml"]) == ExitCode.CASE_WRONG
    seen = capsys.readouterr()
    assert seen.out == ""
    rows = seen.err.splitlines()
    assert rows[0] == "2 problems"
    line = 1 + text.splitlines().index("span = 1")
    assert rows[1].startswith(f"error mine.toml:{line}: blade.span = 1: a bare number where")
    assert 'mesh.size = "23 kg"' in rows[2]


def test_brackets_in_a_message_are_shown(capsys: pytest.CaptureFixture[str]) -> None:
    Path("mine.toml").write_text("[blade]\n")
    assert execute(["check", "mine.toml"]) == ExitCode.CASE_WRONG
    assert "Add [mesh] with size" in capsys.readouterr().err


def test_film_that_does_not_fit(capsys: pytest.CaptureFixture[str]) -> None:
    text = re.sub('^thickness = ".* mm"', 'thickness = "3 mm"', preset_text("paper-aluminium"),
                  flags=re.MULTILINE)  # fmt: skip
    Path("mine.toml").write_text(text, encoding="utf-8")
    assert execute(["check", "mine.toml"]) == ExitCode.CASE_WRONG
    shown = capsys.readouterr().err
    assert 'film.thickness = "3 mm": it sticks out' in shown
    assert re.search(r"by 0\.\d+ mm", shown)


def test_check_as_json(capsys: pytest.CaptureFixture[str]) -> None:
    execute(["new", "mine"])
    capsys.readouterr()
    assert execute(["check", "mine.toml", "--json"]) == ExitCode.DONE
    data = json.loads(capsys.readouterr().out)
    assert data["valid"]
    assert data["case"]["blade"]["span"] == 1.0
    assert data["derived"]["kr"] == pytest.approx([0.3351, 0.7372], abs=1e-4)
    forecast = data["forecast"]
    assert forecast["unknowns_step_2"] == pytest.approx(54_692, rel=forecast["size_uncertainty"])
    assert forecast["total_time_s"] == pytest.approx(sum(forecast["time_s"].values()))
    doubts = [a for a in data["assumptions"] if not a["holds"]]
    # of the paper's blade: stall, cavitation and strip theory at its tip
    assert len(data["notices"]) == len(doubts) == 3
    assert all(notice["remedy"] for notice in data["notices"])


def test_check_predicts_size_cost_and_assumptions(capsys: pytest.CaptureFixture[str]) -> None:
    execute(["new", "mine", "--preset", "twisted"])
    capsys.readouterr()
    assert execute(["check", "mine.toml"]) == ExitCode.DONE
    seen = capsys.readouterr()
    for fragment in (
        "in step 1", "in step 2", "GB, within a factor", "modes C1", "tip speed", "Mach",
        "times the rotation rate", "stall near", "cavitation number", "mm at rest", "DOUBTFUL",
        "1 blade, diameter 2.2 m, V/nD 2.27",
    ):  # fmt: skip
        assert fragment in seen.out
    assert "strip theory" in seen.err


def test_check_of_a_wrong_case_as_json(capsys: pytest.CaptureFixture[str]) -> None:
    Path("mine.toml").write_text(preset_text("twisted").replace('"60 rpm"', '"60 Hz"'))
    assert execute(["check", "mine.toml", "--json"]) == ExitCode.CASE_WRONG
    data = json.loads(capsys.readouterr().out)
    assert not data["valid"]
    (problem,) = data["problems"]
    assert (problem["key"], problem["value"]) == ("flow.rotation", '"60 Hz"')


@pytest.mark.parametrize(
    ("arguments", "fragment"),
    [
        (["chek", "mine.toml"], 'Did you mean "check"?'),
        (["check"], "Missing argument"),
        (["check", "no.toml"], "there is no such file"),
        (["new", "x", "--prest", "twisted"], "--preset"),
    ],
)
def test_wrong_commands(
    arguments: list[str], fragment: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert execute(arguments) == ExitCode.CASE_WRONG
    assert fragment in capsys.readouterr().err


def test_the_shell_completes_commands_and_options() -> None:
    for words, wanted in (("quietblade ru", "run"), ("quietblade run --fo", "--force")):
        ask = {"COMP_WORDS": words, "COMP_CWORD": str(words.count(" "))}
        environment = os.environ | ask | {"_QUIETBLADE_COMPLETE": "complete_bash"}
        line = [sys.executable, "-m", "quietblade.cli.main"]
        asked = subprocess.run(line, env=environment, capture_output=True, text=True, check=True)
        assert asked.stdout.split() == [wanted]


def test_version(capsys: pytest.CaptureFixture[str]) -> None:
    assert execute(["--version"]) == ExitCode.DONE
    assert capsys.readouterr().out.startswith("quietblade 0.")


def test_exit_codes_of_errors(capsys: pytest.CaptureFixture[str]) -> None:
    assert show_error(CaseError("wrong")) == ExitCode.CASE_WRONG
    assert show_error(MeshError("inverted")) == ExitCode.FAILED
    assert show_error(ConvergenceError("no solution")) == ExitCode.FAILED
    assert [int(code) for code in ExitCode] == [0, 1, 2, 3, 130]
    assert "error inverted" in capsys.readouterr().err


def test_check_tells_the_moduli_at_the_ends_of_the_band(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    model = (
        'loss_factor = { model = "fractional-zener", stiffening = 12.0, '
        'relaxation_time = "0.2 ms", exponent = 0.7, temperature = "10 degC", '
        'shift = { law = "wlf", c1 = 8.86, c2 = "101.6 K", reference = "20 degC" } }'
    )
    text = preset_text("paper-composite").replace("loss_factor = 0.21", model)
    (tmp_path / "blade.toml").write_text(text)
    assert execute(["check", "blade.toml"]) == ExitCode.DONE
    shown = " ".join(capsys.readouterr().out.split())
    assert "fractional-zener at 10 degC (a_T = 9.27): storage modulus 6.9 to 8.8" in shown
    assert "from 100 to 220 Hz" in shown
    assert execute(["check", "blade.toml", "--json"]) == ExitCode.DONE
    (film,) = json.loads(capsys.readouterr().out)["derived"]["moduli"]
    assert film["frequency_hz"] == [100.0, 220.0]
    shift = 10.0 ** (8.86 * 10.0 / 91.6)
    z = [(2j * pi * f * shift * 2e-4) ** 0.7 for f in (100.0, 220.0)]
    g = [(1.0 + 12.0 * x) / (1.0 + x) for x in z]
    assert film["loss_factor"] == pytest.approx([x.imag / x.real for x in g])
    assert film["storage_ratio"] == pytest.approx([x.real for x in g])
    assert film["fit_error"] is None
