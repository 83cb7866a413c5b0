# SPDX-License-Identifier: LGPL-2.1-or-later
"""``quietblade new`` asks, at a terminal or when told to, and writes a case that can be run."""

import os
import pty
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from typer.testing import CliRunner

from quietblade.case import Case
from quietblade.case.presets import BLADES, PRESETS, preset_text
from quietblade.case.writing import case_text
from quietblade.cli.common import ExitCode
from quietblade.cli.main import app, execute
from quietblade.study.preflight import preflight


@pytest.fixture(autouse=True)
def _in_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def answer(*lines: str, arguments: tuple[str, ...] = ("new", "--ask")) -> str:
    """Run the command with these lines typed and return what the terminal shows."""
    ended = CliRunner().invoke(app, list(arguments), input="\n".join(lines) + "\n")
    assert ended.exit_code == 0, ended.output
    assert ended.exception is None
    return ended.output


@pytest.mark.parametrize("preset", BLADES)
def test_enter_all_the_way_gives_the_preset(preset: str) -> None:
    answer("mine", preset, *[""] * 30)
    ours, theirs = Case.load("mine.toml"), Case.parse(preset_text(preset))
    assert ours.title == "mine"
    assert ours.content_key() == theirs.content_key()
    text = Path("mine.toml").read_text(encoding="utf-8")
    assert f"starting from the preset {preset}" in text
    assert max(map(len, text.splitlines())) < 101


def test_there_are_no_questions_about_a_sphere() -> None:
    (sphere,) = set(PRESETS) - set(BLADES)
    assert execute(["new", "mine", "--ask", "--preset", sphere]) == ExitCode.CASE_WRONG
    assert not Path("mine.toml").exists()


def test_a_foil_of_glass_with_a_short_film() -> None:
    shown = answer(
        "foil", "hydrofoil", "A foil of glass", "0.4 m", "", "15 cm", "80 mm", "", "10 %", "0.08",
        "5 deg", "3 deg", "glass-epoxy-ud", "y", "0.1", "0.5", "", "", "1.2 mm", "", "8 m/s", "",
        "10 Hz", "500 Hz", "12 mm",
    )  # fmt: skip
    assert "next: quietblade check foil.toml" in shown
    case = Case.load("foil.toml")
    known = preflight(case)
    assert case.title == "A foil of glass"
    assert known.blade.span == 0.4
    assert [float(known.blade.chord(s)) for s in (0.0, 1.0)] == [0.15, 0.08]
    assert [float(known.blade.thickness(s)) for s in (0.0, 1.0)] == [0.1, 0.08]
    assert case.blade.material == "glass-epoxy-ud"
    assert case.materials == {}
    assert case.film is not None
    assert (case.film.span, case.film.thickness) == ((0.1, 0.5), 1.2e-3)
    assert (case.flow.speed, case.acoustics.band, case.mesh.size) == (8.0, (10.0, 500.0), 0.012)
    assert case.acoustics.sphere_radius == pytest.approx(0.25 * 4 / 3, rel=1e-2)
    assert case.acoustics.step == pytest.approx(10.0)
    text = Path("foil.toml").read_text(encoding="utf-8")
    for key in ("span", "pressure", "material", "loss_factor", "sphere_radius"):
        for number, row in enumerate(text.splitlines()):
            if row.startswith(f"{key} = "):
                assert "#" in row or text.splitlines()[number - 1].startswith("#"), row


def test_a_wrong_answer_is_asked_again() -> None:
    shown = answer(
        "mine", "paper", "paper-aluminium", "", "1", "1 kg", "1 m", "", "", "", "naca-7", "naca-4",
        "thick", "", "", "", "", "", "aluminum", "aluminium-6061-t6", "maybe", "n", "", "5 Hz",
        "0.58 rad/s", "200 Hz", "100 Hz", "100 Hz", "200 Hz", "",
    )  # fmt: skip
    for fragment in (
        'there is no preset "paper"', '"1": has no unit', '"1 kg": a mass where a length',
        '"naca-7": is not a section family', "cannot be read as a number", "a frequency where",
        "there is no material of this name", "the band is reversed",
    ):  # fmt: skip
        assert fragment in shown, fragment
    case = Case.load("mine.toml")
    assert case.film is None
    assert case.blade.material == "aluminium-6061-t6"
    assert case.acoustics.band == (100.0, 200.0)


def test_what_cannot_be_together_is_asked_again_at_the_end() -> None:
    shown = answer("mine", "twisted", *[""] * 11, "y", *[""] * 4, "20 mm", *[""] * 6, "2.5 mm")
    assert '"20 mm": it sticks out of the' in shown
    film = Case.load("mine.toml").film
    assert film is not None
    assert film.thickness == 2.5e-3


def test_a_file_that_is_there_is_not_replaced_unasked() -> None:
    Path("mine.toml").write_text("mine")
    shown = answer("mine", "yours", "paper-aluminium", *[""] * 30)
    assert "mine.toml exists already" in shown
    assert Path("mine.toml").read_text() == "mine"
    assert Path("yours.toml").exists()


def test_name_and_preset_need_not_be_asked_for() -> None:
    shown = answer(*[""] * 30, arguments=("new", "mine", "--ask", "--preset", "hydrofoil"))
    assert "Start from" not in shown
    assert Case.load("mine.toml").blade.span == 0.3


def test_the_end_of_the_input_stops_and_writes_nothing(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    with Path(os.devnull).open() as nothing:
        monkeypatch.setattr(sys, "stdin", nothing)
        assert execute(["new", "mine", "--ask"]) == ExitCode.STOPPED
        assert execute(["new"]) == ExitCode.CASE_WRONG
    assert "--ask" in capsys.readouterr().err
    assert list(Path().iterdir()) == []


def test_at_a_terminal_no_name_is_a_wish_to_be_asked() -> None:
    controller, terminal = pty.openpty()
    os.write(controller, b"mine\nhydrofoil\n" + b"\n" * 30)
    line = [sys.executable, "-m", "quietblade.cli.main", "new"]
    done = subprocess.run(line, stdin=terminal, capture_output=True, text=True, check=False)
    os.close(terminal)
    os.close(controller)
    assert done.returncode == ExitCode.DONE, done.stderr
    assert "Start from" in done.stdout
    assert Case.load("mine.toml").blade.span == 0.3


@pytest.mark.parametrize("name", BLADES)
def test_a_written_case_says_the_same(name: str) -> None:
    data = tomllib.loads(preset_text(name))
    data["title"] = 'a "quoted" \\ title, \t tab and é'
    data["loads"] = [
        {"kind": "gravity", "acceleration": ["0 m/s^2", "-9.81 m/s^2", "0 m/s^2"]},
        {"kind": "hydrostatic", "depth": "3 m"},
    ]
    text = case_text(data)
    assert tomllib.loads(text) == data
    comments = re.findall(r"^[a-z_A-Z0-9]+ = .*[^ ] +# .+$", text, flags=re.MULTILINE)
    assert len(comments) > 20
