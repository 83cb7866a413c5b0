# SPDX-License-Identifier: LGPL-2.1-or-later
"""Meshes of spherical shells against volumes and areas in closed form."""

import ngsolve as ngs
import numpy as np
import pytest

from quietblade.errors import MeshError
from quietblade.mesh import Mesh
from quietblade.mesh.shell import Cap, ShellSpec, build_shell

CAPS = (Cap((0.0, 0.0, 2.0), np.radians(20.0)), Cap((1.0, -1.0, 0.2), np.radians(35.0)))
SPEC = ShellSpec(0.5, 0.08, 0.12, 0.2, (0.05, 0.0, -0.02), 0.75, CAPS)


@pytest.fixture(scope="module")
def mesh() -> Mesh:
    return build_shell(SPEC)


def integral(mesh: Mesh, material: str = "", boundary: str = "") -> float:
    fem = mesh.fem
    region = fem.Materials(material) if material else fem.Boundaries(boundary)
    return float(ngs.Integrate(1.0, fem, definedon=region))


def ball(radius: float) -> float:
    return 4.0 / 3.0 * np.pi * radius**3


def test_volumes(mesh: Mesh) -> None:
    assert integral(mesh, "body") == pytest.approx(ball(0.5) - ball(0.42), rel=2e-4)
    assert integral(mesh, "water") == pytest.approx(ball(0.75) - ball(0.5), rel=2e-4)


def test_areas(mesh: Mesh) -> None:
    whole = 4.0 * np.pi * 0.5**2
    caps = [0.5 * whole * (1.0 - np.cos(cap.half_angle)) for cap in CAPS]
    assert integral(mesh, boundary="excited") == pytest.approx(caps[0], rel=1e-3)
    assert integral(mesh, boundary="excited2") == pytest.approx(caps[1], rel=1e-3)
    assert integral(mesh, boundary="wet") == pytest.approx(whole - sum(caps), rel=1e-3)
    assert integral(mesh, boundary="inside") == pytest.approx(4.0 * np.pi * 0.42**2, rel=1e-3)
    assert integral(mesh, boundary="outer") == pytest.approx(4.0 * np.pi * 0.75**2, rel=2e-3)


def test_rim_of_a_cap_is_made_of_edges(mesh: Mesh) -> None:
    axis = np.array(CAPS[1].axis) / np.linalg.norm(CAPS[1].axis)
    corners = np.unique(mesh.faces["excited2"][:, :3])
    rim = np.intersect1d(corners, np.unique(mesh.faces["wet"][:, :3]))
    along = mesh.nodes[rim] @ axis
    np.testing.assert_allclose(along, 0.5 * np.cos(CAPS[1].half_angle), atol=1e-6)


def test_nodes_lie_on_their_spheres(mesh: Mesh) -> None:
    for boundary, radius in (("wet", 0.5), ("excited", 0.5), ("inside", 0.42)):
        at = np.linalg.norm(mesh.nodes[mesh.faces[boundary]], axis=-1)
        np.testing.assert_allclose(at, radius, rtol=1e-7)
    away = np.linalg.norm(mesh.nodes[mesh.faces["outer"]] - SPEC.centre, axis=-1)
    np.testing.assert_allclose(away, 0.75, rtol=1e-7)


def test_cells_are_not_inverted(mesh: Mesh) -> None:
    assert set(mesh.quality) == {"body", "water"}
    assert min(quality.worst for quality in mesh.quality.values()) > 0.01


def test_a_wall_too_thin_for_its_cells_is_refused() -> None:
    with pytest.raises(MeshError, match="thickness of the wall"):
        build_shell(ShellSpec(0.5, 0.002, 0.2, 0.3, (0.0, 0.0, 0.0), 0.75))
