# SPDX-License-Identifier: LGPL-2.1-or-later
"""``quietblade section``: words, files, tables, mistakes."""

import csv
import json
from pathlib import Path

import numpy as np
import pytest

from quietblade.cli.common import ExitCode
from quietblade.cli.main import execute
from quietblade.cli.section_words import angle_range
from quietblade.errors import CaseError
from quietblade.geometry import NacaFourDigit


@pytest.fixture(autouse=True)
def _in_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def test_pictures_and_tables_of_a_family(capsys: pytest.CaptureFixture[str]) -> None:
    words = ["section", "naca-66-a08", "--thickness", "9 %", "--camber", "0.02"]
    more = ["--angles", "-1:2:1 deg", "--at", "1 deg", "--reynolds", "1e6", "--out", "here"]
    assert execute([*words, *more, "--format", "svg"]) == ExitCode.DONE
    shown = capsys.readouterr().out
    assert "one-way boundary layer" in shown
    assert "alpha [deg]" in shown
    made = {file.name for file in Path("here").iterdir()}
    assert made == {"pressure.svg", "polars.svg", "bucket.svg", "pressure.csv", "polars.csv"}
    with Path("here/polars.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["alpha_deg"]) for row in rows] == [-1.0, 0.0, 1.0, 2.0]
    assert all(0.002 < float(row["cd"]) < 0.01 for row in rows)
    pressure = np.loadtxt("here/pressure.csv", delimiter=",", skiprows=1)
    assert pressure.shape == (161, 3)
    assert 0.9 < pressure[:, 2].max() <= 1.0


def test_numbers_as_json_without_a_layer(capsys: pytest.CaptureFixture[str]) -> None:
    assert execute(["section", "NACA 2412", "--angles", "4 deg", "--json"]) == ExitCode.DONE
    data = json.loads(capsys.readouterr().out)
    assert data["section"] == "NACA 2412"
    (row,) = data["polars"]
    assert row["cl"] == pytest.approx(0.7415, abs=2e-3)  # XFOIL: tests/data/xfoil
    assert row["cd"] is None
    assert all(Path(file).is_file() for file in data["files"])


def test_a_file_with_another_thickness(capsys: pytest.CaptureFixture[str]) -> None:
    points = NacaFourDigit().contour(0.12, 0.0, 0.002, 81)
    Path("mine.dat").write_text("mine\n" + "\n".join(f"{x:.6f} {y:.6f}" for x, y in points))
    words = ["section", "mine.dat", "--thickness", "0.06", "--angles", "4 deg", "--json"]
    assert execute(words) == ExitCode.DONE
    data = json.loads(capsys.readouterr().out)
    assert data["thickness"] == 0.06
    assert data["polars"][0]["cl"] == pytest.approx(0.460, abs=2e-3)


WRONG = {
    "needs a thickness": ["naca-66-a08"],
    "is no file": ["nonsense"],
    "has its thickness": ["naca0012", "--thickness", "0.1"],
    "first:last:step": ["naca0012", "--angles", "0:4 deg"],
    "no unit": ["naca0012", "--at", "4"],
    "at most 500": ["naca0012", "--angles", "0:10:0.001 deg"],
    "odd number": ["naca0012", "--nodes", "160"],
    "unresolved nose": ["naca0012", "--nodes", "31"],
    "must lie between the trailing": ["naca-4", "--thickness", "0.1", "--trailing-edge", "20 %"],
    "use png": ["naca0012", "--format", "bmp"],
    "between 1e3": ["naca0012", "--reynolds", "10"],
    "--n-crit": ["naca0012", "--n-crit", "0"],
    "Write 0.06": ["naca-4", "--thickness", "6 mm"],
}


@pytest.mark.parametrize("message", WRONG)
def test_mistakes_are_named(message: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert execute(["section", *WRONG[message]]) == ExitCode.CASE_WRONG
    assert message in capsys.readouterr().err
    assert list(Path().iterdir()) == []


def test_ranges_of_angles() -> None:
    np.testing.assert_allclose(np.degrees(angle_range("-1:1:0.5 deg")), [-1, -0.5, 0, 0.5, 1])
    np.testing.assert_allclose(np.degrees(angle_range("0:0.3:0.1 deg")), [0, 0.1, 0.2, 0.3])
    np.testing.assert_allclose(angle_range("0.1 rad"), [0.1])
    with pytest.raises(CaseError, match="before the first"):
        angle_range("4:0:1 deg")
