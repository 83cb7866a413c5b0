# SPDX-License-Identifier: LGPL-2.1-or-later
"""What other programs get is what is computed: read back and measured."""

from pathlib import Path

import gmsh
import ngsolve as ngs
import numpy as np
import pytest

from quietblade.errors import MeshError
from quietblade.geometry import Blade
from quietblade.mesh import Mesh
from quietblade.mesh.build import gmsh_session
from quietblade.mesh.exchange import write_msh, write_step
from quietblade.typing import FloatArray
from tests.conftest import make_paper_blade, make_twisted_blade


def read_step(file: Path) -> dict[str, tuple[int, int]]:
    """Solids by name, in millimetres, in the current model."""
    solids = gmsh.model.occ.importShapes(str(file))
    gmsh.model.occ.synchronize()
    return {gmsh.model.getEntityName(*solid).rsplit("/", 1)[-1]: solid for solid in solids}


def distances(points: FloatArray, solids: list[tuple[int, int]]) -> FloatArray:
    """Distance of points to the nearest face of solids [m]."""
    found = np.full(len(points), np.inf)
    for face in gmsh.model.getBoundary(solids, oriented=False):
        closest, _ = gmsh.model.getClosestPoint(*face, 1e3 * points.ravel())
        away = np.linalg.norm(1e-3 * closest.reshape(-1, 3) - points, axis=1)
        found = np.minimum(found, away)
    return found


@pytest.mark.parametrize("kind", ["straight", "twisted", "solid"])
def test_step_has_named_solids_with_the_faces_of_the_blade(
    kind: str, small_film_blade: Blade, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    blade = {
        "straight": small_film_blade, "twisted": make_twisted_blade(), "solid": make_paper_blade(),
    }[kind]  # fmt: skip
    file = tmp_path / "blade.step"
    write_step(blade, file)
    assert capfd.readouterr().out == ""
    assert "SI_UNIT(.MILLI.,.METRE.)" in file.read_text(encoding="utf-8")
    with gmsh_session():
        solids = read_step(file)
        assert set(solids) == ({"blade", "film"} if blade.film else {"blade"})
        contours = blade.section(np.linspace(0.03, 0.97, 4), 21).reshape(-1, 3)
        assert distances(contours, [solids["blade"]]).max() < 2e-5 * blade.span  # of the loft
        if blade.film is None:
            return
        s, xi = np.meshgrid(np.linspace(*blade.film.span, 7), np.linspace(*blade.film.chord, 7))
        for side in (1, -1):
            surface = blade.film_surface(side, s, xi).reshape(-1, 3)
            assert distances(surface, [solids["film"]]).max() < 2e-5 * blade.span


def test_step_has_the_volume_of_the_mesh(
    small_film_blade: Blade, coarse_mesh: Mesh, tmp_path: Path
) -> None:
    file = tmp_path / "blade.stp"
    write_step(small_film_blade, file)
    with gmsh_session():
        solids = read_step(file)
        volumes = {name: 1e-9 * gmsh.model.occ.getMass(*solid) for name, solid in solids.items()}
    fem = coarse_mesh.fem
    meshed = {name: ngs.Integrate(1.0, fem, definedon=fem.Materials(name)) for name in volumes}
    assert volumes["film"] == pytest.approx(meshed["film"], rel=1e-9)
    # both cut the nose: the mesh by a few quadratic edges, the kernel's integration by few points
    assert volumes["blade"] == pytest.approx(meshed["blade"], rel=0.03)


def test_msh_is_the_mesh_again(coarse_mesh: Mesh, tmp_path: Path) -> None:
    file = tmp_path / "blade.msh"
    write_msh(coarse_mesh, file)
    with gmsh_session():
        gmsh.open(str(file))
        tags, places, _ = gmsh.model.mesh.getNodes()
        order = np.argsort(tags)
        assert np.allclose(places.reshape(-1, 3)[order], coarse_mesh.nodes, rtol=1e-14, atol=1e-15)
        found = {
            gmsh.model.getPhysicalName(*group): group for group in gmsh.model.getPhysicalGroups()
        }
        assert set(found) == set(coarse_mesh.cells) | set(coarse_mesh.faces)
        for region in coarse_mesh.cells:
            assert volume(found[region]) == pytest.approx(
                ngs.Integrate(1.0, coarse_mesh.fem, definedon=coarse_mesh.fem.Materials(region)),
                rel=1e-9,
            )
        for name, triangles in coarse_mesh.faces.items():
            (entity,) = gmsh.model.getEntitiesForPhysicalGroup(*found[name])
            (elements,) = gmsh.model.mesh.getElements(2, entity)[1]
            assert len(elements) == len(triangles)


def volume(group: tuple[int, int]) -> float:
    total = 0.0
    for entity in gmsh.model.getEntitiesForPhysicalGroup(*group):
        for kind in gmsh.model.mesh.getElementTypes(3, entity):
            points, weights = gmsh.model.mesh.getIntegrationPoints(kind, "Gauss8")
            _, determinants, _ = gmsh.model.mesh.getJacobians(kind, points, entity)
            assert determinants.min() > 0.0
            total += float(np.sum(determinants.reshape(-1, len(weights)) * weights))
    return total


def test_names_that_say_another_format_are_refused(coarse_mesh: Mesh, tmp_path: Path) -> None:
    with pytest.raises(MeshError, match=r"ends with \.step or \.stp"):
        write_step(make_paper_blade(), tmp_path / "blade.iges")
    with pytest.raises(MeshError, match=r"ends with \.msh"):
        write_msh(coarse_mesh, tmp_path / "blade.vtu")
    with pytest.raises(MeshError, match="could not write"):
        write_msh(coarse_mesh, tmp_path / "nowhere" / "blade.msh")
