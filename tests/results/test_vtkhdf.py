# SPDX-License-Identifier: LGPL-2.1-or-later
"""VTKHDF files, read back: what the VTU files hold."""

import sys
from pathlib import Path

import h5py
import numpy as np
import pytest
import pyvista as pv

from quietblade.cli.main import execute
from quietblade.mesh import Mesh
from quietblade.results.store import RunFolder
from quietblade.results.vtk import PointField, read_fields, region, write_fields
from tests.results.synthetic import make_result, write_synthetic_fields


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory, coarse_mesh: Mesh) -> RunFolder:
    folder, result = RunFolder(tmp_path_factory.mktemp("vtkhdf") / "run"), make_result()
    folder.save(result)
    write_synthetic_fields(folder, coarse_mesh, result)
    response = PointField("response", (1.0 - 2.0j) * coarse_mesh.nodes, "136.52 Hz")
    write_fields(folder.response_fields("C0"), coarse_mesh.nodes, coarse_mesh.cells, [response])
    return folder


def test_all_fields_come_back(run: RunFolder) -> None:
    out = run.root / "hdf"
    assert execute(["export", str(run.root), "--vtkhdf", str(out), "--quiet"]) == 0
    sources = sorted((run.root / "fields").iterdir())
    assert [file.stem for file in sources] == ["modes-C0", "modes-C1", "response-C0", "static"]
    assert sorted(out.iterdir()) == [out / f"{file.stem}.vtkhdf" for file in sources]
    for source in sources:
        grid, back = read_fields(source), pv.read(out / f"{source.stem}.vtkhdf")
        np.testing.assert_array_equal(back.points, grid.points)
        np.testing.assert_array_equal(back.cells, grid.cells)
        np.testing.assert_array_equal(back.celltypes, grid.celltypes)
        assert len(back.point_data.keys()) == len(grid.point_data.keys()) > 0
        for name in grid.point_data:
            np.testing.assert_array_equal(
                back.point_data[name.replace(".", "_")], grid.point_data[name]
            )
        assert region(back, "blade").n_cells == region(grid, "blade").n_cells > 0


def test_arrays_have_units_and_are_pressed(run: RunFolder) -> None:
    out = run.root / "again"
    assert execute(["export", str(run.root), "--vtkhdf", str(out), "--quiet"]) == 0
    with h5py.File(out / "static.vtkhdf") as file:
        arrays = file["VTKHDF/PointData"]
        assert arrays["displacement"].attrs["units"] == "m"
        assert arrays["pressure"].attrs["units"] == "Pa"
        assert arrays["pressure"].compression == "gzip"
    with h5py.File(out / "response-C0.vtkhdf") as file:
        assert set(file["VTKHDF/PointData"]) == {"response 136_52 Hz re", "response 136_52 Hz im"}


def test_an_old_vtk_is_told(
    run: RunFolder,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setitem(sys.modules, "vtkmodules.vtkIOHDF", None)
    assert execute(["export", str(run.root), "--vtkhdf", str(tmp_path)]) == 3
    assert 'pip install --upgrade "vtk>=9.4"' in capsys.readouterr().err
    assert not list(tmp_path.iterdir())
