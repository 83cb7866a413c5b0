# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pictures of solids: edges of second-order cells, cropping, and what is seen."""

from pathlib import Path

import numpy as np
import pytest

from quietblade.mesh import Mesh
from quietblade.results.files import ResultError
from quietblade.results.store import RunFolder
from quietblade.results.vtk import read_fields, region, write_fields
from quietblade.view import scenes
from quietblade.view.edges import outer_edges
from quietblade.view.render import FROM_ABOVE, Stage, cropped, curved_surface
from tests.results.synthetic import make_result
from tests.results.test_vtk import Block, brick


def test_edges_of_a_brick(tmp_path: Path) -> None:
    points, cell = brick()
    write_fields(tmp_path / "a.vtu", points, {"film": [Block("hexahedron20", cell)]})
    edges = outer_edges(read_fields(tmp_path / "a.vtu"))
    assert edges.n_lines == 12
    assert edges.length == pytest.approx(np.linalg.norm([2.0, 3.0, 4.0]))
    lengths = edges.compute_cell_sizes().cell_data["Length"]
    np.testing.assert_allclose(np.sort(lengths), np.repeat([2.0, 3.0, 4.0], 4), rtol=1e-6)


def test_curved_edges_pass_through_their_middle_nodes(tmp_path: Path) -> None:
    points, cell = brick()
    points[8] += [0.0, 0.0, -0.5]  # middle of the edge from (0, 0, 0) to (2, 0, 0)
    write_fields(tmp_path / "a.vtu", points, {"film": [Block("hexahedron20", cell)]})
    drawn = np.array(outer_edges(read_fields(tmp_path / "a.vtu")).points)
    parabola = drawn[drawn[:, 2] < -1e-6]
    x, z = parabola[:, 0], parabola[:, 2]
    np.testing.assert_allclose(z, -0.5 * x * (2.0 - x), atol=1e-6)
    assert len(parabola) == 3


def test_inner_faces_have_no_edges_of_their_own(coarse_mesh: Mesh, tmp_path: Path) -> None:
    cells = {name: coarse_mesh.cells[name] for name in ("blade", "film")}
    write_fields(tmp_path / "a.vtu", coarse_mesh.nodes, cells)
    edges = outer_edges(read_fields(tmp_path / "a.vtu"))
    surface = np.concatenate([coarse_mesh.faces[n] for n in ("wet", "excited", "root")])
    triangles = len(surface)
    assert edges.n_lines == 3 * triangles // 2  # Euler: a closed surface of triangles


def test_common_margins_are_cropped() -> None:
    a, b = np.full((20, 30, 3), 255, np.uint8), np.full((20, 30, 3), 255, np.uint8)
    a[5, 10], b[8, 22] = 0, 0
    small = cropped([a, b])
    assert [image.shape for image in small] == [(4, 13, 3)] * 2
    assert small[0][0, 0, 0] == 0
    assert small[1][-1, -1, 0] == 0


def test_the_planform_is_seen_to_scale(runs: tuple[RunFolder, ...]) -> None:
    grid = read_fields(runs[0].static_fields)
    stage = Stage((1200, 400))
    stage.add(curved_surface(region(grid, "blade")), color="black")
    (image,) = cropped([stage.picture(FROM_ABOVE)])
    rows, columns, _ = image.shape
    assert columns / rows == pytest.approx(1.0 / 0.25, rel=0.03)
    dark = (image < 128).all(axis=2)
    # the root on the left has the chord of 250 mm, the tip on the right that of 75 mm
    assert dark[:, 3].mean() == pytest.approx(1.0, abs=0.03)
    assert dark[:, -4].mean() == pytest.approx(0.3, abs=0.03)


@pytest.mark.parametrize("pitch", [-70.0, 0.0, 40.0])
def test_a_pitched_blade_is_seen_on_its_face(runs: tuple[RunFolder, ...], pitch: float) -> None:
    level = read_fields(runs[0].static_fields)
    turned = scenes._with_level_chord(level.rotate_z(pitch, inplace=False))
    own = scenes._with_level_chord(level)
    np.testing.assert_allclose(np.ptp(turned.points, axis=0), np.ptp(own.points, axis=0), rtol=1e-5)
    # the upper side stays up, the leading edge in front
    np.testing.assert_allclose(turned.points, own.points, atol=1e-6)


def test_the_strain_is_on_one_scale(runs: tuple[RunFolder, ...]) -> None:
    result = make_result("aluminium")
    figure = scenes.draw_deformed(runs[0], result, largest=0.09)
    bar = figure.axes[-1]
    assert bar.get_xlim() == pytest.approx((0.0, 9.0))
    assert "[%]" in bar.get_xlabel()
    assert "(0.5, 130.0, -10.1) mm" in figure.axes[0].get_title(loc="left")


def test_mode_pictures_have_one_size_and_differ(runs: tuple[RunFolder, ...]) -> None:
    pictures = scenes.mode_pictures(runs[1], "C0")
    assert set(pictures) == {"B5", "E2", "B6", "T2", "B7", "T3"}
    assert len({picture.shape for picture in pictures.values()}) == 1
    coloured = [picture for picture in pictures.values() if picture.std() > 5.0]
    assert len(coloured) == len(pictures)
    assert np.abs(pictures["B6"].astype(float) - pictures["T2"]).mean() > 1.0


def test_missing_fields_are_named(tmp_path: Path) -> None:
    with pytest.raises(ResultError, match=r"static\.vtu is missing"):
        scenes.draw_mesh(RunFolder(tmp_path))
