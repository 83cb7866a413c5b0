# SPDX-License-Identifier: LGPL-2.1-or-later
import numpy as np
import pytest

from quietblade.errors import MeshError
from quietblade.mesh import Mesh, resize_sphere
from quietblade.mesh.quality import tetrahedron_quality
from quietblade.vibroacoustics.radiation import check_sphere


@pytest.mark.parametrize("radius", [0.9, 1.3, 2.0])
def test_blade_stays_and_sphere_moves(coarse_mesh: Mesh, radius: float) -> None:
    resized = resize_sphere(coarse_mesh, radius)
    assert resized.cells is coarse_mesh.cells
    for region in ("blade", "film"):
        for block in coarse_mesh.cells[region]:
            kept = block.connectivity
            np.testing.assert_array_equal(resized.nodes[kept], coarse_mesh.nodes[kept])
    sphere = resized.nodes[np.unique(resized.faces["outer"])] - resized.centre
    # between curved edges the mesh of the old sphere is only nearly round
    np.testing.assert_allclose(np.linalg.norm(sphere, axis=1), radius, rtol=1e-9)
    check_sphere(resized.fem, radius, "outer")
    assert resized.quality["water"].least_jacobian > 0.0


def test_same_radius_gives_the_same_nodes(coarse_mesh: Mesh) -> None:
    same = resize_sphere(coarse_mesh, coarse_mesh.radius, 0.8)
    np.testing.assert_allclose(same.nodes, coarse_mesh.nodes, rtol=0.0, atol=1e-12)


@pytest.mark.parametrize(("radius", "fixed"), [(0.4, None), (1.0, 0.3), (1.0, 1.1), (2.0, 1.4)])
def test_impossible_spheres_are_refused(
    coarse_mesh: Mesh, radius: float, fixed: float | None
) -> None:
    with pytest.raises(MeshError, match="blade reaches"):
        resize_sphere(coarse_mesh, radius, fixed)


def test_quality_is_that_of_gmsh(coarse_mesh: Mesh) -> None:
    connectivity = np.concatenate([b.connectivity for b in coarse_mesh.cells["water"]])
    ours, theirs = (
        tetrahedron_quality(coarse_mesh.nodes, connectivity),
        coarse_mesh.quality["water"],
    )
    # gmsh looks at other points of the cells
    assert ours.mean == pytest.approx(theirs.mean, rel=0.02)
    assert ours.worst == pytest.approx(theirs.worst, abs=0.1)


def test_quality_of_a_regular_cell_and_of_a_mirrored_one() -> None:
    corners = np.array(
        [[0.0, 0, 0], [1, 0, 0], [0.5, 0.75**0.5, 0], [0.5, 12**-0.5, (2 / 3) ** 0.5]]
    )
    edges = ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))
    nodes = np.concatenate([corners, [corners[list(e)].mean(axis=0) for e in edges]])
    cell = np.arange(10)[None]
    assert tetrahedron_quality(nodes, cell).worst == pytest.approx(1.0, abs=1e-12)
    assert tetrahedron_quality(nodes * [1.0, 1.0, -1.0], cell).worst == pytest.approx(
        -1.0, abs=1e-12
    )
