# SPDX-License-Identifier: LGPL-2.1-or-later
import ngsolve as ngs
import numpy as np
import pytest

from quietblade.mesh import Mesh
from quietblade.mesh.motion import MeshMotion
from quietblade.mesh.quality import tetrahedron_jacobians
from quietblade.mesh.remesh import remesh_water


def bent(mesh: Mesh) -> np.ndarray:
    """Displacement that bends the blade on a parabola and twists it; only the solid's is used."""
    s = mesh.nodes[:, 2] - 0.2
    angle = -0.2 * s
    x, y = mesh.nodes[:, 0], mesh.nodes[:, 1]
    moved = np.zeros_like(mesh.nodes)
    moved[:, 0] = (np.cos(angle) - 1.0) * x - np.sin(angle) * y
    moved[:, 1] = np.sin(angle) * x + (np.cos(angle) - 1.0) * y + 0.3 * s**2
    return moved


@pytest.fixture(scope="module")
def made(coarse_mesh: Mesh) -> tuple[Mesh, MeshMotion]:
    return remesh_water(coarse_mesh, bent(coarse_mesh), size=0.045, water_size=0.3)


def test_new_water_fills_the_space_around_the_deformed_blade(
    coarse_mesh: Mesh, made: tuple[Mesh, MeshMotion]
) -> None:
    mesh, motion = made
    field = ngs.GridFunction(ngs.VectorH1(mesh.fem, order=2))
    field.vec.FV().NumPy()[:] = mesh.basis.to_dofs(motion.displacement)

    def volume(regions: str) -> float:
        return float(ngs.Integrate(ngs.CF(1.0) * ngs.dx(regions, deformation=field), mesh.fem))

    ball = float(ngs.Integrate(ngs.CF(1.0), coarse_mesh.fem))  # of the same triangles
    assert volume("water") + volume("blade|film") == pytest.approx(ball, rel=1e-7)
    water = mesh.cells["water"][0].connectivity
    assert tetrahedron_jacobians(mesh.nodes + motion.displacement, water).min() > 0.0
    assert motion.least_jacobian > 0.1
    assert mesh.quality["water"].least_jacobian == motion.least_jacobian


def test_solid_and_surfaces_stay_as_they_are(
    coarse_mesh: Mesh, made: tuple[Mesh, MeshMotion]
) -> None:
    mesh, motion = made
    wanted = bent(coarse_mesh)
    for region in ("blade", "film"):
        for old, new in zip(coarse_mesh.cells[region], mesh.cells[region], strict=True):
            np.testing.assert_array_equal(
                mesh.nodes[new.connectivity], coarse_mesh.nodes[old.connectivity]
            )
            np.testing.assert_allclose(
                motion.displacement[new.connectivity], wanted[old.connectivity], atol=1e-14
            )
    for name, triangles in coarse_mesh.faces.items():
        np.testing.assert_array_equal(mesh.nodes[mesh.faces[name]], coarse_mesh.nodes[triangles])
    assert np.all(motion.displacement[mesh.faces["outer"]] == 0.0)


def test_new_cells_are_not_those_that_were_moved(
    coarse_mesh: Mesh, made: tuple[Mesh, MeshMotion]
) -> None:
    mesh, _ = made
    old = np.unique(coarse_mesh.cells["water"][0].connectivity)
    inner = np.setdiff1d(old, np.unique(np.concatenate(list(coarse_mesh.faces.values()))))
    new = np.unique(mesh.cells["water"][0].connectivity)
    own = np.setdiff1d(new, np.unique(np.concatenate(list(mesh.faces.values()))))
    assert 0.3 < len(own) / len(inner) < 3.0
    same = (mesh.nodes[own][:, None] == coarse_mesh.nodes[inner][None]).all(axis=2).sum()
    assert same == 0
