# SPDX-License-Identifier: LGPL-2.1-or-later
import ngsolve as ngs
import numpy as np
import pytest
from netgen.csg import CSGeometry, OrthoBrick, Pnt

from quietblade.materials import (
    AnisotropicSVK,
    Depth,
    IsotropicSVK,
    Laminate,
    OrthotropicSVK,
    Ply,
    homogenised,
    layered,
    ply_number,
    surface_axes,
    surface_depth,
)
from quietblade.materials.cells import fit_in_cells
from quietblade.mesh.nodal import NodalBasis
from tests.materials.blades import FLAT, blade_basis
from verification.structure_models import box_mesh

# without Poisson's effect, so that bending about one axis is a state of uniaxial strain
STIFF = OrthotropicSVK("u", 1600.0, 140e9, 10e9, 10e9, 5e9, 3e9, 5e9, 0.0, 0.0, 0.0)
FOAM = IsotropicSVK("foam", 100.0, 0.1e9, 0.0)
HEIGHT = 0.1
AXES = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])


def bricks(cells: int) -> ngs.Mesh:
    side = np.array([-0.25, 0.25])
    return box_mesh(side, np.linspace(-0.05, 0.05, cells + 1), np.linspace(0.0, 0.5, 3))


def tetrahedra() -> ngs.Mesh:
    geometry = CSGeometry()
    geometry.Add(OrthoBrick(Pnt(-0.25, -0.05, 0.0), Pnt(0.25, 0.05, 0.5)))
    return ngs.Mesh(geometry.GenerateMesh(maxh=0.1))


def depth_of(mesh: ngs.Mesh) -> Depth:
    basis = NodalBasis(mesh)
    y = basis.points[basis.nodes_of(".*"), 1]
    return Depth.of_nodes(basis, ".*", y + 0.5 * HEIGHT, 0.5 * HEIGHT - y)


def bending(mesh: ngs.Mesh, law: AnisotropicSVK) -> float:
    """Twice the energy of unit curvature, over width and length, in second-order elements."""
    space = ngs.VectorH1(mesh, order=2)
    form = ngs.BilinearForm(space)
    F = ngs.Id(3) + ngs.Grad(space.TrialFunction())
    form += ngs.Variation(law.energy(F).Compile() * ngs.dx(bonus_intorder=law.extra_order))
    bent = ngs.GridFunction(space)
    form.AssembleLinearization(bent.vec)
    bent.Set(ngs.CF((0.0, -0.5 * ngs.z**2, ngs.y * ngs.z)))
    force = bent.vec.CreateVector()
    force.data = form.mat * bent.vec
    return float(ngs.InnerProduct(force, bent.vec)) / 0.25


def stack(*plies: tuple[object, float], drape: str = "symmetric") -> Laminate:
    made = tuple(Ply(m, np.radians(a), fraction=1 / len(plies)) for m, a in plies)
    return Laminate("stack", made, drape)


STACKS = {
    "0/90": stack((STIFF, 0), (STIFF, 90)),
    "90/0": stack((STIFF, 90), (STIFF, 0)),
    "quasi-isotropic": stack((STIFF, 0), (STIFF, 45), (STIFF, -45), (STIFF, 90)),
    "0/90 x 4": stack(*((STIFF, 0), (STIFF, 90)) * 4),
    "sandwich": Laminate("w", (Ply(STIFF, 0.0, fraction=0.1), Ply(FOAM, 0.0, fraction=0.9))),
    "one side": stack((STIFF, 0), (FOAM, 0), (FOAM, 0), drape="through"),
}


CASES = [(kind, name) for kind in ("one brick", "three bricks") for name in STACKS]
CASES += [("tetrahedra", "quasi-isotropic"), ("tetrahedra", "sandwich")]


@pytest.mark.parametrize(("kind", "name"), CASES)
def test_plies_bend_as_laminate_theory_says_however_few_the_cells(kind, name) -> None:
    laminate = STACKS[name]
    mesh = {"one brick": 1, "three bricks": 3}.get(kind)
    mesh = tetrahedra() if mesh is None else bricks(mesh)
    wanted = laminate.abd(HEIGHT).D[0, 0]
    assert bending(mesh, layered(laminate, AXES, depth_of(mesh))) == pytest.approx(wanted, rel=1e-9)


@pytest.mark.parametrize("name", ["0/90", "90/0", "sandwich"])
def test_the_homogenised_laminate_is_off_by_what_it_says(name) -> None:
    laminate = STACKS[name]
    D, A = laminate.abd(HEIGHT).D, laminate.abd(HEIGHT).A
    found = bending(bricks(1), homogenised(laminate, AXES))
    assert found == pytest.approx(HEIGHT**2 / 12 * A[0, 0], rel=1e-9)
    error = abs(found - D[0, 0]) / np.abs(D).max()
    assert 0.1 < error <= laminate.bending_error() * (1 + 1e-9)


def test_identical_plies_in_their_places_are_the_homogenised_laminate() -> None:
    laminate = stack((STIFF, 20), (STIFF, 20), (STIFF, 20))
    mesh = bricks(2)
    law = layered(laminate, AXES, depth_of(mesh))
    C = np.reshape(law.stiffness(mesh(0.1, 0.02, 0.3)), (6, 6))
    assert laminate.stiffness == pytest.approx(C, rel=1e-9, abs=10.0)
    assert law.density == 1600.0


def test_thick_plies_are_laid_off_from_the_faces_and_the_last_fills() -> None:
    mesh = bricks(1)
    faced = Laminate("w", (Ply(STIFF, 0.0, thickness=5e-3), Ply(FOAM, 0.0, thickness=1e-3)))
    law = layered(faced, AXES, depth_of(mesh))
    wanted = (140e9 * (0.1**3 - 0.09**3) + 0.1e9 * 0.09**3) / 12
    assert bending(mesh, law) == pytest.approx(wanted, rel=1e-6)
    mass = ngs.Integrate(law.density, mesh, order=4) / 0.25
    assert mass == pytest.approx(1600.0 * 0.01 + 100.0 * 0.09, rel=1e-9)
    # out of the plane the local stack in series
    shear = np.reshape(law.stiffness(mesh(0.0, 0.0, 0.2)), (6, 6))[4, 4]
    assert 1 / shear == pytest.approx(0.1 / 5e9 + 0.9 / 0.05e9)


def test_plies_too_thick_for_the_blade_leave_no_room_for_the_next() -> None:
    mesh = bricks(2)
    faced = Laminate("w", (Ply(STIFF, 0.0, thickness=60e-3), Ply(FOAM, 0.0, thickness=1e-3)))
    law = layered(faced, AXES, depth_of(mesh))
    assert bending(mesh, law) == pytest.approx(140e9 * 0.1**3 / 12, rel=1e-9)
    number = ply_number(faced, depth_of(mesh))
    assert number(mesh(0.0, 0.0, 0.2)) == 0.0


@pytest.mark.parametrize(
    ("drape", "numbers"), [("symmetric", [0, 1, 2, 2, 1, 0]), ("through", [0, 0, 1, 1, 2, 2])]
)
def test_ply_number_counts_the_list(drape, numbers) -> None:
    mesh = bricks(2)
    number = ply_number(stack((STIFF, 0), (FOAM, 0), (STIFF, 90), drape=drape), depth_of(mesh))
    heights = HEIGHT * ((np.arange(6) + 0.5) / 6 - 0.5)
    assert [number(mesh(0.1, y, 0.3)) for y in heights] == numbers


def test_a_step_in_all_kinds_of_cells_keeps_its_moments() -> None:
    geometry = CSGeometry()
    geometry.Add(OrthoBrick(Pnt(0, 0, 0), Pnt(1, 1, 1)))
    for mesh in (bricks(1), ngs.Mesh(geometry.GenerateMesh(maxh=0.6))):
        level = ngs.y + 0.3 * ngs.x - 0.1 * ngs.z - 0.013
        (fit,) = fit_in_cells(mesh, ".*", [level], np.array([[2.0, 3.0]]))
        jump = ngs.IfPos(level, 5.0, 2.0)
        for weight in (ngs.CF(1.0), ngs.x, ngs.y * ngs.z, ngs.y**2):
            exact = ngs.Integrate(jump * weight, mesh, order=40)
            assert ngs.Integrate(fit * weight, mesh, order=6) == pytest.approx(exact, rel=2e-3)


def test_a_blade_of_plies_has_the_mass_and_the_axes_of_its_plies() -> None:
    basis = blade_basis(FLAT, (24, 2, 4))
    axes = surface_axes(FLAT, basis, "blade")
    depth = surface_depth(FLAT, basis, "blade")
    halves = Laminate("h", (Ply(STIFF, 0.0, fraction=0.25), Ply(FOAM, 0.0, fraction=0.75)))
    law = layered(halves, axes, depth)
    assert law.axes is axes
    volume = ngs.Integrate(1.0, basis.fem, order=6)
    assert ngs.Integrate(law.density, basis.fem, order=6) == pytest.approx(
        volume * halves.density, rel=3e-3
    )
