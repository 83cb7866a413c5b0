# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tables of a result: nothing is missing, and the numbers are the same."""

from pathlib import Path

import numpy as np
import pytest

from quietblade.cli.main import execute
from quietblade.results.curves import PLACES, read_curves, write_curves
from quietblade.results.model import Result
from quietblade.results.quantities import DIMENSIONS, LABELS, QUANTITIES
from quietblade.results.store import RunFolder
from tests.results.synthetic import make_result


@pytest.fixture(scope="module")
def result() -> Result:
    return make_result()


@pytest.fixture(scope="module")
def folder(result: Result, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("tables")
    write_curves(result, folder)
    return folder


def test_every_array_is_in_one_file_with_the_same_numbers(result: Result, folder: Path) -> None:
    tables = {file.stem: read_curves(file) for file in folder.glob("*.csv") if file.stem != "index"}
    checked = 0
    for node in result.to_xarray().subtree:
        for name, variable in node.to_dataset(inherit=False).data_vars.items():
            own = [str(d) for d in variable.dims if d not in LABELS]
            stem = "-".join(
                [*(node.path.strip("/").split("/") if node.path != "/" else ["case"]), *own]
            )
            if variable.size == 0 or f"{node.path}/{name}" == "/run/case_text":
                continue
            table = tables[stem]
            if not own:
                values = dict(zip(table["name"], table["value"], strict=True))
                found = [v for key, v in values.items() if key.partition("(")[0] == name]
                values_of = variable
            else:
                heads = [h for h in table if h.partition(" [")[0].partition("(")[0] == name]
                columns = np.array([table[head] for head in heads])
                named = [d for d in variable.dims if d in LABELS]
                found = list(columns.ravel())
                values_of = variable.transpose(*named, *own)
            assert len(found) == variable.size, f"{node.path}/{name}"
            for text, value in zip(found, values_of.values.ravel(), strict=True):
                if variable.dtype.kind == "f":
                    assert text == "" if np.isnan(value) else float(text) == value
                else:
                    assert text == str(value)
            checked += 1
    assert checked > 250


def test_heads_say_unit_and_reference(folder: Path) -> None:
    table = read_curves(folder / "C1-spectrum-frequency.csv")
    assert next(iter(table)) == "frequency [Hz]"
    assert "power_level(sphere) [dB re 1 pW]" in table
    text = (folder / "C1-spectrum-frequency.csv").read_text(encoding="utf-8")
    assert "# power_level: radiated sound power level: 10 log10(W / 1 pW); symbol L_W" in text


def test_rows_over_two_dimensions_name_both(result: Result, folder: Path) -> None:
    table = read_curves(folder / "C1-dissipation-sink-frequency.csv")
    found = result.configurations["C1"]
    frequency = found.spectrum.frequency
    assert table["sink"][: len(frequency)] == [found.dissipation.sink[0]] * len(frequency)
    assert [float(f) for f in table["frequency [Hz]"][: len(frequency)]] == frequency.tolist()


def test_places_are_registered_along_their_dimension() -> None:
    assert set(PLACES) <= set(DIMENSIONS)
    for dim, key in PLACES.items():
        assert QUANTITIES[key].dims == (dim,), key


def test_command_writes_tables_and_asks_for_a_run(
    result: Result, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    RunFolder(tmp_path / "run").save(result)
    out = tmp_path / "tables"
    assert execute(["export", str(tmp_path / "run"), "--csv", str(out)]) == 0
    assert "listed in index.csv" in capsys.readouterr().out
    names = read_curves(out / "index.csv")["file"]
    assert sorted([*names, "index.csv"]) == sorted(file.name for file in out.iterdir())
    assert execute(["export", str(tmp_path / "run" / "case.toml"), "--csv", str(out)]) == 1
    assert "needs results" in capsys.readouterr().err
    assert execute(["export", str(tmp_path), "--csv", str(out)]) == 3
    assert "no result.nc here" in capsys.readouterr().err
