# SPDX-License-Identifier: LGPL-2.1-or-later
"""VTU files of second-order cells, read back with VTK."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import ngsolve as ngs
import numpy as np
import pytest
import pyvista as pv
from vtkmodules.vtkCommonCore import vtkDataArray

from quietblade.mesh import Mesh
from quietblade.results.files import ResultError
from quietblade.results.vtk import (
    PointField,
    field_labels,
    field_values,
    read_fields,
    region,
    write_fields,
)
from quietblade.typing import FloatArray, IntArray
from tests.conftest import SMALL_FILM, make_paper_blade


@dataclass(frozen=True)
class Block:
    kind: str
    connectivity: IntArray


def cell_volumes(grid: pv.UnstructuredGrid, points_a_side: int = 4) -> FloatArray:
    """Isoparametric volumes with VTK's own shape functions; wrong node orders show."""
    x, w = np.polynomial.legendre.leggauss(points_a_side)
    x, w = 0.5 * (x + 1.0), 0.5 * w
    a, b, c = np.meshgrid(x, x, x, indexing="ij")
    weight = np.einsum("i,j,k->ijk", w, w, w).ravel()
    cube = np.stack([a, b, c], axis=-1).reshape(-1, 3)
    volumes = np.empty(grid.n_cells)
    for number in range(grid.n_cells):
        cell = grid.GetCell(number)
        nodes = np.array(grid.get_cell(number).points)
        places, factor = cube, np.ones(len(cube))
        if cell.GetCellType() == pv.CellType.QUADRATIC_TETRA:  # Duffy's map of the cube
            u, v, t = cube.T
            places = np.stack([u, v * (1 - u), t * (1 - u) * (1 - v)], axis=1)
            factor = (1 - u) ** 2 * (1 - v)
        total = 0.0
        for place, share in zip(places, weight * factor, strict=True):
            derivatives = [0.0] * (3 * len(nodes))
            cell.InterpolateDerivs(list(place), derivatives)
            total += share * np.linalg.det(np.reshape(derivatives, (3, -1)) @ nodes)
        volumes[number] = total
    return volumes


def brick() -> tuple[FloatArray, IntArray]:
    """A hexahedron20 of 2 x 3 x 4 m."""
    corners = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0],
                        [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]], dtype=float)  # fmt: skip
    edges = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4),
             (0, 4), (1, 5), (2, 6), (3, 7)]  # fmt: skip
    middles = [0.5 * (corners[i] + corners[j]) for i, j in edges]
    return np.array([2.0, 3.0, 4.0]) * np.vstack([corners, middles]), np.arange(20)[None]


def test_volume_of_a_brick_and_of_a_bulged_one(tmp_path: Path) -> None:
    points, cell = brick()
    write_fields(tmp_path / "a.vtu", points, {"film": [Block("hexahedron20", cell)]})
    np.testing.assert_allclose(cell_volumes(read_fields(tmp_path / "a.vtu")), [24.0], rtol=1e-12)
    bulged = points.copy()
    bulged[16:, 0] += np.where(points[16:, 0] > 1.0, 0.3, 0.0)  # two of the four upright edges
    write_fields(tmp_path / "b.vtu", bulged, {"film": [Block("hexahedron20", cell)]})
    # parabolic edges of height 0.3 on one 3 x 4 face: 2/3 of the height on average
    expected = 24.0 + 3.0 * 4.0 * 0.3 * 2.0 / 3.0
    np.testing.assert_allclose(
        cell_volumes(read_fields(tmp_path / "b.vtu")), [expected], rtol=1e-12
    )


def solid(mesh: Mesh) -> dict[str, Sequence[Block]]:
    return {name: blocks for name, blocks in mesh.cells.items() if name != "water"}  # type: ignore[misc]


def test_volume_of_a_meshed_blade(coarse_mesh: Mesh, tmp_path: Path) -> None:
    write_fields(tmp_path / "a.vtu", coarse_mesh.nodes, solid(coarse_mesh))
    grid = read_fields(tmp_path / "a.vtu")
    volumes = cell_volumes(grid, points_a_side=4)
    assert volumes.min() > 0.0
    fem = coarse_mesh.fem
    for name in ("blade", "film"):
        own = volumes[grid.cell_data["region"] == ("blade", "film").index(name)].sum()
        expected = ngs.Integrate(1.0, fem, definedon=fem.Materials(name), order=6)
        assert own == pytest.approx(expected, rel=1e-9)
    # a coarse mesh cuts the corner of the thin, curved nose
    assert volumes.sum() == pytest.approx(make_paper_blade(SMALL_FILM).volume(), rel=2e-2)


def test_fields_come_back_with_units(coarse_mesh: Mesh, tmp_path: Path) -> None:
    x = coarse_mesh.nodes
    strain = np.where(x[:, 2] > 0.7, x[:, 0], np.nan)
    shape = x * (1.0 + 2.0j)
    write_fields(
        tmp_path / "a.vtu",
        x,
        solid(coarse_mesh),
        [
            PointField("displacement", 3.0 * x),
            PointField("film_shear_strain", strain),
            PointField("mode_shape", shape, "B5"),
            PointField("mode_shape", 2.0 * shape, "T2"),
        ],
    )
    grid = read_fields(tmp_path / "a.vtu")
    np.testing.assert_array_equal(field_values(grid, "displacement"), 3.0 * np.array(grid.points))
    read = field_values(grid, "film_shear_strain")
    np.testing.assert_array_equal(np.isnan(read), grid.points[:, 2] <= 0.7)
    assert field_labels(grid, "mode_shape") == ("B5", "T2")
    np.testing.assert_array_equal(
        field_values(grid, "mode_shape", "T2"), np.array(grid.points) * (2.0 + 4.0j)
    )
    information = grid.GetPointData().GetArray("displacement").GetInformation()
    assert information.Get(vtkDataArray.UNITS_LABEL()) == "m"


def test_regions_and_unused_nodes(coarse_mesh: Mesh, tmp_path: Path) -> None:
    write_fields(tmp_path / "a.vtu", coarse_mesh.nodes, solid(coarse_mesh))
    grid = read_fields(tmp_path / "a.vtu")
    census = coarse_mesh.census()
    assert region(grid, "film").n_cells == census["film"]["hexahedron20"]
    assert region(grid, "blade").n_cells == sum(census["blade"].values())
    assert region(grid, "water").n_cells == 0
    used = {
        n for blocks in solid(coarse_mesh).values() for b in blocks for n in b.connectivity.flat
    }
    assert grid.n_points == len(used) < len(coarse_mesh.nodes)


@pytest.mark.parametrize(
    ("field", "message"),
    [
        (PointField("temperature", np.zeros(20)), "not registered"),
        (PointField("displacement", np.zeros(20)), r"shape \(20,\), expected \(20, 3\)"),
        (PointField("pressure", np.zeros(20) * 1j), "registered as real"),
    ],
)
def test_wrong_fields(field: PointField, message: str, tmp_path: Path) -> None:
    points, cell = brick()
    with pytest.raises(ResultError, match=message):
        write_fields(tmp_path / "a.vtu", points, {"film": [Block("hexahedron20", cell)]}, [field])
    assert not list(tmp_path.iterdir())


def test_a_missing_file(tmp_path: Path) -> None:
    with pytest.raises(ResultError, match="missing"):
        read_fields(tmp_path / "a.vtu")
