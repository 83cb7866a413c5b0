# SPDX-License-Identifier: LGPL-2.1-or-later
import dataclasses

import ngsolve as ngs
import numpy as np
import pytest

from quietblade.errors import InvertedCellError, MeshError
from quietblade.geometry import Blade
from quietblade.mesh import INTERFACE, Mesh, MeshSpec, build, build_mesh
from quietblade.mesh.cad import Solids
from quietblade.mesh.quality import tetrahedron_jacobians
from quietblade.typing import FloatArray
from tests.conftest import PAPER_FILM, PATCH, make_paper_blade, make_twisted_blade


def volume(mesh: Mesh, region: str) -> float:
    return ngs.Integrate(1.0, mesh.fem, definedon=mesh.fem.Materials(region))


def area(mesh: Mesh, boundary: str) -> float:
    return ngs.Integrate(1.0, mesh.fem, definedon=mesh.fem.Boundaries(boundary))


def test_regions_have_the_volumes_of_the_blade(coarse_mesh: Mesh, small_film_blade: Blade) -> None:
    film_chord = 0.4 * np.mean([0.2325, 0.0925])  # chords at 10 % and 90 % of the span
    assert volume(coarse_mesh, "film") == pytest.approx(0.8 * film_chord * 1.0e-3, rel=1e-9)
    # a few quadratic edges around the section: the nose is cut by about 1 %
    solid = volume(coarse_mesh, "blade|film")
    assert solid == pytest.approx(small_film_blade.volume(), rel=0.02)
    sphere = 4.0 / 3.0 * np.pi * 1.3**3
    assert solid + volume(coarse_mesh, "water") == pytest.approx(sphere, rel=1e-3)


def test_boundaries_cover_the_blade_and_the_sphere(coarse_mesh: Mesh) -> None:
    assert area(coarse_mesh, "outer") == pytest.approx(4.0 * np.pi * 1.3**2, rel=2e-3)
    root_area = 0.25**2 * 0.0412  # thin blunt NACA 0006: about 0.68508 t c
    assert area(coarse_mesh, "root") == pytest.approx(root_area, rel=0.06)
    chord = 0.25 - 0.175 * 0.93
    assert area(coarse_mesh, "excited") == pytest.approx(0.06 * 0.4 * chord, rel=2e-3)


def test_film_is_one_layer_of_hexahedra_covered_by_pyramids(coarse_mesh: Mesh) -> None:
    census = coarse_mesh.census()
    hexahedra = census["film"]["hexahedron20"]
    spanwise, chordwise = 16, hexahedra // 16
    assert census["film"] == {"hexahedron20": spanwise * chordwise}
    assert census["blade"]["pyramid13"] == 2 * hexahedra + 2 * (spanwise + chordwise)
    assert set(census["water"]) == {"tetra10"}


def test_nodes_of_the_finite_element_mesh_are_the_nodes_of_the_file(coarse_mesh: Mesh) -> None:
    assert np.abs(coarse_mesh.basis.points - coarse_mesh.nodes).max() < 1e-12
    quadratic = coarse_mesh.nodes[:, 0] ** 2 - coarse_mesh.nodes[:, 1] * coarse_mesh.nodes[:, 2]
    dofs = coarse_mesh.basis.to_dofs(quadratic)
    assert np.allclose(coarse_mesh.basis.to_values(dofs), quadratic)
    wetted = coarse_mesh.basis.nodes_of(INTERFACE, codimension=1)
    assert np.array_equal(wetted, np.unique(coarse_mesh.interface))


def test_wetted_triangles_lie_on_the_blade(coarse_mesh: Mesh, small_film_blade: Blade) -> None:
    triangles = np.concatenate([coarse_mesh.faces["wet"], coarse_mesh.faces["excited"]])
    points = coarse_mesh.nodes[np.unique(triangles)]
    s, xi, eta = small_film_blade.locate(points)
    faces = np.array([small_film_blade.face_height(side, s, np.clip(xi, 0, 1)) for side in (1, -1)])
    inside_edge = (eta < faces[0] + 1e-6) & (eta > faces[1] - 1e-6)
    on_face = np.abs(eta - faces).min(axis=0) < 1e-4  # spline through 81 nodes
    at_end = (s > 1.0 - 1e-9) | (xi > 1.0 - 1e-6)
    assert np.all(on_face | (at_end & inside_edge))


def test_twisted_swept_cambered_blade_meshes() -> None:
    blade = make_twisted_blade()
    mesh = build_mesh(blade, MeshSpec(0.035, (0.0, 0.0, 0.7), 1.3, (PATCH,), 0.6))
    assert volume(mesh, "blade|film") == pytest.approx(blade.volume(), rel=0.03)
    assert min(q.least_jacobian for q in mesh.quality.values()) > 0.0
    assert len(mesh.faces["excited"]) > 0


def test_blade_without_film_meshes() -> None:
    mesh = build_mesh(make_paper_blade(), MeshSpec(0.05, (0.0, 0.0, 0.7), 1.3, (PATCH,), 0.6))
    assert set(mesh.cells) == {"blade", "water"}


def test_film_that_pierces_the_blade_is_refused() -> None:
    film = dataclasses.replace(PAPER_FILM, thickness=8e-3)
    with pytest.raises(MeshError, match="film"):
        build_mesh(make_paper_blade(film), MeshSpec(0.05, (0.0, 0.0, 0.7), 1.3, (PATCH,), 0.6))


@pytest.fixture
def sizes(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """Sizes of the cells that are tried."""
    tried: list[float] = []
    build_once = build._mesh

    def watched(blade: Blade, solids: Solids, spec: MeshSpec, centre: FloatArray) -> Mesh:
        tried.append(spec.size)
        return build_once(blade, solids, spec, centre)

    monkeypatch.setattr(build, "_mesh", watched)
    return tried


def test_other_sizes_are_tried_after_an_inverted_cell(sizes: list[float]) -> None:
    with pytest.raises(InvertedCellError, match="inverted at x"):
        build_mesh(make_twisted_blade(), MeshSpec(0.1, (0.0, 0.0, 0.7), 1.3, (PATCH,), 0.6))
    np.testing.assert_allclose(sizes, [0.1, 0.098, 0.096, 0.094])


def test_what_gmsh_refuses_is_refused_at_once(
    sizes: list[float], monkeypatch: pytest.MonkeyPatch
) -> None:
    # solids that gmsh cannot mesh: the cells on the faces may be as large as the blade
    monkeypatch.setattr(build, "clear_size", lambda blade: lambda at: np.inf)
    film = dataclasses.replace(PAPER_FILM, thickness=2.3e-3)
    with pytest.raises(MeshError, match=r"gmsh could not mesh the blade with cells of 0\.2 m"):
        build_mesh(make_paper_blade(film), MeshSpec(0.2, (0.0, 0.0, 0.7), 1.3, (PATCH,), 0.6))
    assert sizes == [0.2]


def test_jacobians_tell_an_inverted_tetrahedron() -> None:
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    edges = ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))
    nodes = np.array([*corners, *(0.5 * (corners[i] + corners[j]) for i, j in edges)])
    straight = tetrahedron_jacobians(nodes, np.arange(10)[None])
    assert np.allclose(straight, 1.0)
    nodes[4] += [0.3, 0.0, 0.0]  # a mid-edge node past the quarter point folds the corner
    assert tetrahedron_jacobians(nodes, np.arange(10)[None]).min() < 0.0
