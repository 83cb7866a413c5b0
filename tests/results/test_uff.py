# SPDX-License-Identifier: LGPL-2.1-or-later
"""Universal files, read back by pyuff."""

import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from quietblade.cli.main import execute
from quietblade.mesh import Mesh
from quietblade.results.store import RunFolder
from quietblade.results.vtk import field_values, read_fields
from tests.results.synthetic import make_result, write_synthetic_fields

pyuff = pytest.importorskip("pyuff")
RESULT = make_result()


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory, coarse_mesh: Mesh) -> RunFolder:
    folder = RunFolder(tmp_path_factory.mktemp("uff") / "run")
    folder.save(RESULT)
    write_synthetic_fields(folder, coarse_mesh, RESULT)
    return folder


@pytest.fixture(scope="module")
def sets(run: RunFolder) -> dict[int, list[dict[str, Any]]]:
    out = run.root / "uff"
    assert execute(["export", str(run.root), "--uff", str(out), "--quiet"]) == 0
    assert sorted(file.name for file in out.iterdir()) == ["C0.uff", "C1.uff"]
    found: dict[int, list[dict[str, Any]]] = {}
    for one in pyuff.UFF(str(out / "C1.uff")).read_sets():
        found.setdefault(one["type"], []).append(one)
    return found


def test_nodes_and_surface(run: RunFolder, sets: dict[int, list[dict[str, Any]]]) -> None:
    assert sets[164][0]["units_code"] == 1
    grid = read_fields(run.mode_fields("C1"))
    (nodes,) = sets[2411]
    numbers = nodes["node_nums"].astype(int) - 1
    places = np.stack([nodes["x"], nodes["y"], nodes["z"]], axis=1)
    assert np.allclose(places, grid.points[numbers], atol=1e-12)
    triangles = np.array([row["nodes_nums"] for row in sets[2412][0][91]])
    assert set(triangles.ravel()) == set(numbers + 1)
    edges = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    assert np.all(np.unique(edges, axis=0, return_counts=True)[1] == 2)  # a closed surface


def test_mode_shapes(run: RunFolder, sets: dict[int, list[dict[str, Any]]]) -> None:
    modes = RESULT.configurations["C1"].modes
    grid = read_fields(run.mode_fields("C1"))
    assert len(sets[55]) == len(modes.name)
    for shape, name, frequency, loss in zip(
        sets[55], modes.name, modes.frequency, modes.loss_factor, strict=True
    ):
        assert name in shape["id2"]
        assert shape["eig"].imag / (2.0 * np.pi) == pytest.approx(frequency, rel=1e-5)
        assert -2.0 * shape["eig"].real / shape["eig"].imag == pytest.approx(loss, rel=1e-4)
        stored = field_values(grid, "mode_shape", name)[shape["node_nums"].astype(int) - 1]
        read = np.stack([shape["r1"], shape["r2"], shape["r3"]], axis=1)
        assert np.allclose(read, stored, atol=2e-6)


def test_functions_of_frequency(sets: dict[int, list[dict[str, Any]]]) -> None:
    spectrum = RESULT.configurations["C1"].spectrum
    named = {one["id1"]: one for one in sets[58] if one["id2"].strip() in {"-", "sphere"}}
    mobility = named["spectrum/mobility [m/(s N)]"]
    assert (mobility["func_type"], mobility["ordinate_spec_data_type"]) == (4, 11)
    assert mobility["orddenom_spec_data_type"] == 13
    assert np.allclose(mobility["x"], spectrum.frequency, rtol=1e-5)  # six digits
    assert np.allclose(mobility["data"], spectrum.mobility, rtol=1e-9)
    level = named["spectrum/power_level [dB re 1 pW]"]
    assert np.allclose(level["data"], spectrum.power_level[0], rtol=1e-9)


def test_without_pyuff_the_remedy_is_named(
    run: RunFolder, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    monkeypatch.setitem(sys.modules, "pyuff", None)
    assert execute(["export", str(run.root), "--uff", str(tmp_path)]) == 3
    assert 'pip install "quietblade[uff]"' in capsys.readouterr().err
