# SPDX-License-Identifier: LGPL-2.1-or-later
import numpy as np
import pytest

from quietblade.mesh import Mesh
from quietblade.mesh.motion import solve_mesh_motion
from quietblade.mesh.quality import TETRA_EDGES, jacobian_derivatives, tetrahedron_jacobians
from quietblade.mesh.relax import relax_cells


@pytest.fixture
def water(coarse_mesh: Mesh) -> np.ndarray:
    return np.concatenate([block.connectivity for block in coarse_mesh.cells["water"]])


@pytest.fixture
def held(coarse_mesh: Mesh) -> np.ndarray:
    surfaces = np.zeros(len(coarse_mesh.nodes), dtype=bool)
    surfaces[np.concatenate([faces.ravel() for faces in coarse_mesh.faces.values()])] = True
    return surfaces


def test_a_corner_pulled_through_its_cells_comes_back(
    coarse_mesh: Mesh, water: np.ndarray, held: np.ndarray
) -> None:
    before = tetrahedron_jacobians(coarse_mesh.nodes, water).mean(axis=1)
    corner = next(k for k in np.unique(water[:, :4]) if not held[water[(water == k).any(1)]].any())
    around = (water[:, :4] == corner).any(axis=1)
    nodes = coarse_mesh.nodes.copy()
    nodes[corner, 0] += 1.5 * np.cbrt(before[around].max())
    for k, (a, b) in enumerate(TETRA_EDGES):
        touched = water[(water[:, a] == corner) | (water[:, b] == corner)]
        nodes[touched[:, 4 + k]] = 0.5 * (nodes[touched[:, a]] + nodes[touched[:, b]])
    assert tetrahedron_jacobians(nodes, water).min() < 0.0
    relaxed = relax_cells(nodes, water, before, held, 0.05)
    jacobians = tetrahedron_jacobians(relaxed, water)
    assert np.all(jacobians.min(axis=1) > 0.05 * jacobians.mean(axis=1))
    assert np.array_equal(relaxed[held], nodes[held])
    assert not np.array_equal(relaxed, nodes)


def test_good_cells_are_left_alone(coarse_mesh: Mesh, water: np.ndarray, held: np.ndarray) -> None:
    jacobians = tetrahedron_jacobians(coarse_mesh.nodes, water)
    least = float((jacobians.min(axis=1) / jacobians.mean(axis=1)).min())
    relaxed = relax_cells(coarse_mesh.nodes, water, jacobians.mean(axis=1), held, 0.99 * least)
    assert relaxed is coarse_mesh.nodes


def test_water_follows_a_twist_that_inverts_cells_otherwise(coarse_mesh: Mesh) -> None:
    x, y, z = coarse_mesh.nodes.T
    s = z - 0.2
    turned = np.exp(2.6j * s) * (x + 1j * y)  # 150 degrees at the tip
    wanted = np.stack([turned.real - x, turned.imag - y + 0.4 * s**2, 0.0 * s], axis=1)
    motion = solve_mesh_motion(coarse_mesh, wanted, minimum_gap=0.05)
    assert motion.least_jacobian > 0.05
    assert motion.notices == ()


def test_derivatives_of_the_jacobians_are_those_of_differences() -> None:
    rng = np.random.default_rng(5)
    nodes, cells = rng.standard_normal((12, 3)), np.array([np.arange(10), np.arange(2, 12)])
    weights = rng.standard_normal((2, 8))
    found = np.zeros_like(nodes)
    np.add.at(found, cells, jacobian_derivatives(nodes, cells, weights))
    step = 1e-6
    for place in np.ndindex(nodes.shape):
        ends = [nodes.copy(), nodes.copy()]
        ends[0][place] += step
        ends[1][place] -= step
        ahead, behind = (np.sum(weights * tetrahedron_jacobians(n, cells)) for n in ends)
        assert found[place] == pytest.approx((ahead - behind) / (2 * step), rel=1e-6, abs=1e-7)
