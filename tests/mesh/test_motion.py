# SPDX-License-Identifier: LGPL-2.1-or-later
import numpy as np
import pytest

from quietblade.errors import MeshError
from quietblade.mesh import Mesh
from quietblade.mesh.motion import solve_mesh_motion, sphere_gap
from quietblade.mesh.quality import tetrahedron_jacobians


def bending(mesh: Mesh, tip: float) -> np.ndarray:
    """A parabola of the span that moves the tip by ``tip`` along y."""
    s = mesh.nodes[:, 2] - 0.2
    moved = np.zeros_like(mesh.nodes)
    moved[:, 1] = tip * s**2
    return moved


def test_water_follows_the_blade_and_the_sphere_stays(coarse_mesh: Mesh) -> None:
    wanted = bending(coarse_mesh, 0.15)
    motion = solve_mesh_motion(coarse_mesh, wanted, minimum_gap=0.1)
    wetted = np.unique(coarse_mesh.interface)
    assert np.allclose(motion.displacement[wetted], wanted[wetted], atol=1e-12)
    assert np.allclose(motion.displacement[np.unique(coarse_mesh.faces["outer"])], 0.0)
    water = coarse_mesh.cells["water"][0].connectivity
    moved = tetrahedron_jacobians(coarse_mesh.nodes + motion.displacement, water)
    assert moved.min() > 0.0
    assert motion.least_jacobian > 0.0


def test_no_displacement_moves_nothing(coarse_mesh: Mesh) -> None:
    motion = solve_mesh_motion(coarse_mesh, np.zeros_like(coarse_mesh.nodes), minimum_gap=0.1)
    assert np.abs(motion.displacement).max() == 0.0
    assert motion.volume_ratio == pytest.approx((1.0, 1.0))


def test_gap_is_the_distance_to_the_sphere(coarse_mesh: Mesh) -> None:
    # the tip's trailing edge, 37.5 mm behind and 0.5 m above the centre, is the farthest point
    farthest = np.hypot(0.125, 0.5)  # of the root section's corners
    assert sphere_gap(coarse_mesh, np.zeros_like(coarse_mesh.nodes)) == pytest.approx(
        1.3 - farthest, abs=1e-4
    )


def test_blade_too_close_to_the_sphere_is_refused(coarse_mesh: Mesh) -> None:
    with pytest.raises(MeshError, match="sphere radius"):
        solve_mesh_motion(coarse_mesh, bending(coarse_mesh, 1.15), minimum_gap=0.1)
