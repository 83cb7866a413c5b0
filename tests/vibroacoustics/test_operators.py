# SPDX-License-Identifier: LGPL-2.1-or-later
"""Blocks, signs and symmetry of the coupled system."""

from pathlib import Path

import gmsh
import ngsolve as ngs
import numpy as np
import pytest
from netgen import occ
from netgen.read_gmsh import ReadGmsh
from scipy.sparse import csr_matrix

from quietblade.errors import MeshError
from quietblade.mesh import Mesh
from quietblade.mesh.boundaries import boundary
from quietblade.mesh.nodal import NodalBasis
from quietblade.typing import FloatArray
from quietblade.vibroacoustics.excitation import pressure_force
from quietblade.vibroacoustics.fluid import (
    Water,
    compressibility_matrix,
    coupling_matrix,
    fluid_normal,
    kinetic_matrix,
)
from quietblade.vibroacoustics.operators import build_operators, free_unknowns, product_space
from verification.acoustics_models import LOSSY, SOFT, WATER, ball, linear_elastic, shell

POSITION = ngs.CF((ngs.x, ngs.y, ngs.z))
UNIT_WATER = Water(1.0, 1.0)


@pytest.fixture(scope="module")
def gmsh_ball(tmp_path_factory: pytest.TempPathFactory) -> ngs.Mesh:
    """The same ball in water as `ball`, meshed by gmsh and read from a file."""
    path = Path(tmp_path_factory.mktemp("gmsh") / "ball.msh")
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        kernel = gmsh.model.occ
        solid, water = kernel.addSphere(0, 0, 0, 0.5), kernel.addSphere(0, 0, 0, 1.0)
        kernel.fragment([(3, water)], [(3, solid)])
        kernel.synchronize()
        volumes = {tag: kernel.getMass(3, tag) for _, tag in gmsh.model.getEntities(3)}
        faces = {tag: kernel.getMass(2, tag) for _, tag in gmsh.model.getEntities(2)}
        inside, outside = (
            min(volumes, key=volumes.__getitem__),
            max(volumes, key=volumes.__getitem__),
        )
        for dimension, tag, name in (
            (3, inside, "blade"),
            (3, outside, "water"),
            (2, min(faces, key=faces.__getitem__), "wet"),
            (2, max(faces, key=faces.__getitem__), "outer"),
        ):
            gmsh.model.setPhysicalName(
                dimension, gmsh.model.addPhysicalGroup(dimension, [tag]), name
            )
        gmsh.option.setNumber("Mesh.MeshSizeMax", 0.25)
        gmsh.option.setNumber("Mesh.MshFileVersion", 2.2)
        gmsh.model.mesh.generate(3)
        gmsh.model.mesh.setOrder(2)
        gmsh.write(str(path))
    finally:
        gmsh.finalize()
    return ngs.Mesh(ReadGmsh(str(path)))


def radial(fem: ngs.Mesh) -> tuple[FloatArray, FloatArray]:
    """Unknowns of the displacement u = x and of the potential psi = 1."""
    basis = NodalBasis(fem)
    return basis.to_dofs(basis.points), basis.to_dofs(np.ones(len(basis.points)))


@pytest.mark.parametrize("source", ["netgen.occ", "gmsh"])
def test_normal_points_out_of_the_fluid(source: str, gmsh_ball: ngs.Mesh) -> None:
    fem = ball().fem if source == "netgen.occ" else gmsh_ball
    volume = ngs.Integrate(ngs.CF(1.0) * ngs.dx("blade"), fem)
    region = boundary(fem, "wet")
    outflow = ngs.Integrate(POSITION * fluid_normal(fem, region) * ngs.ds(definedon=region), fem)
    assert outflow == pytest.approx(-3.0 * volume, rel=1e-12)
    u, psi = radial(fem)
    assert u @ coupling_matrix(fem, UNIT_WATER) @ psi == pytest.approx(-3.0 * volume, rel=1e-12)


def test_normal_of_a_real_blade(coarse_mesh: Mesh) -> None:
    # Excited patch, root and the rest close the surface: no net area, and the blade's volume.
    fem, surface = coarse_mesh.fem, "wet|excited|root"
    region = boundary(fem, surface)
    normal = fluid_normal(fem, region)
    there = ngs.ds(definedon=region)
    area = ngs.Integrate(ngs.CF(1.0) * there, fem)
    net = [ngs.Integrate(normal[i] * there, fem) for i in range(3)]
    np.testing.assert_allclose(net, 0.0, atol=1e-12 * area)
    volume = ngs.Integrate(ngs.CF(1.0) * ngs.dx("blade|film"), fem)
    assert ngs.Integrate(POSITION * normal * there, fem) == pytest.approx(-3 * volume, rel=1e-10)


def test_normal_of_a_face_without_water_is_refused() -> None:
    fem = shell().fem
    with pytest.raises(MeshError, match="no side or on both sides"):
        fluid_normal(fem, boundary(fem, "inside"))
    with pytest.raises(MeshError, match="no boundary of the mesh matches 'keel'"):
        boundary(fem, "keel")


@pytest.mark.parametrize("omega", [900.0, 900.0 - 40.0j])
def test_system_is_its_terms_and_symmetric(omega: complex) -> None:
    operators = shell().operators
    matrix = operators.at(omega)
    t = operators.terms
    expected = (
        t["K"] + 1j * t["D blade"] - omega**2 * t["M"] + 1j * omega * t["C"]
        - t["H"] + omega**2 * t["G"]
        - (1j * omega + operators.sound_speed / operators.radius) * t["Q"]
    )  # fmt: skip
    scale = abs(matrix).max()
    assert abs(matrix - expected).max() < 1e-13 * scale
    assert abs(matrix - matrix.T).max() == 0.0
    np.testing.assert_array_equal(matrix.indices, operators.at(1.0).indices)


def test_coupling_blocks_are_each_others_transpose() -> None:
    # The block of the water's equation assembled on its own: rho dpsi (u . n).
    model = shell()
    fem, operators = model.fem, model.operators
    displacement, _, potential = product_space(fem).components
    u, test = displacement.TrialFunction(), potential.TestFunction()
    region = boundary(fem, "wet")
    form = ngs.BilinearForm(trialspace=displacement, testspace=potential, check_unused=False)
    flux = ngs.InnerProduct(u.Trace(), fluid_normal(fem, region))
    form += WATER.density * test.Trace() * flux * ngs.ds(definedon=region)
    values, columns, starts = form.Assemble().mat.CSR()
    lower = csr_matrix((values, columns, starts), shape=(potential.ndof, displacement.ndof))
    blocks, free = operators.blocks, operators.free
    start = product_space(fem).Range(2).start
    lower = lower[free[blocks.psi] - start][:, free[blocks.u]]
    upper = operators.terms["C"][blocks.u][:, blocks.psi]
    assert abs(upper).max() > 0.0
    assert abs(lower - upper.T).max() < 1e-14 * abs(upper).max()


def test_terms_stay_in_their_blocks() -> None:
    operators = shell().operators
    water, solid = operators.blocks.psi, operators.blocks.u
    for name in ("K", "D blade", "M"):
        assert abs(operators.terms[name][water]).nnz == 0
    for name in ("H", "G", "Q"):
        assert abs(operators.terms[name][solid]).nnz == 0
    assert operators.terms["C"][water][:, water].nnz == 0
    assert operators.terms["C"][solid][:, solid].nnz == 0


def test_energies_of_simple_fields() -> None:
    operators, fem = ball().operators, ball().fem
    basis, space = ball().basis, product_space(ball().fem)
    volume = ngs.Integrate(ngs.CF(1.0) * ngs.dx("water"), fem)
    start = space.Range(2).start
    psi = operators.free[operators.blocks.psi] - start

    def energy(name: str, values: FloatArray) -> float:
        vector = np.zeros(operators.size)
        vector[operators.blocks.psi] = basis.to_dofs(values)[psi]
        return float(vector @ operators.terms[name] @ vector)

    one = np.ones(len(basis.points))
    rho, c = WATER.density, WATER.sound_speed
    assert energy("H", basis.points[:, 2]) == pytest.approx(rho * volume, rel=1e-6)
    assert energy("G", one) == pytest.approx(rho / c**2 * volume, rel=1e-6)
    assert energy("Q", one) == pytest.approx(rho / c * 4.0 * np.pi, rel=2e-3)
    assert energy("H", one) == pytest.approx(0.0, abs=1e-9 * rho)


def test_water_matrices_on_the_moved_mesh() -> None:
    # Swelling of the whole mesh by 20 %: areas, lengths and volumes follow.
    fem, basis = ball().fem, ball().basis
    motion = ngs.GridFunction(ngs.VectorH1(fem, order=2))
    motion.vec.FV().NumPy()[:] = basis.to_dofs(0.2 * basis.points)
    for matrix, power in (
        (coupling_matrix, 2),
        (kinetic_matrix, 1),
        (compressibility_matrix, 3),
    ):
        at_rest, moved = matrix(fem, WATER), matrix(fem, WATER, motion=motion)
        assert abs(moved - 1.2**power * at_rest).max() < 1e-12 * abs(moved).max()
    rest = pressure_force(fem, 1.0, surface="wet")
    np.testing.assert_allclose(
        pressure_force(fem, 1.0, surface="wet", motion=motion),
        1.44 * rest,
        atol=1e-12 * np.abs(rest).max(),
    )


def test_positive_pressure_pushes_into_the_blade() -> None:
    model = ball()
    inward = -model.radial_motion(0)
    load = model.operators.right_hand_side(pressure_force(model.fem, 3.0, surface="wet"))
    work = float(inward @ load[model.operators.blocks.u])
    assert work == pytest.approx(3.0 * np.pi, rel=2e-3)
    assert np.count_nonzero(load[model.operators.blocks.psi]) == 0


def test_free_unknowns_of_a_blade_with_film(coarse_mesh: Mesh) -> None:
    fem = coarse_mesh.fem
    free, blocks = free_unknowns(fem)
    space = product_space(fem)
    assert len(free) == len(blocks.u) + len(blocks.p) + len(blocks.psi)
    assert np.all(np.diff(free) > 0)
    film_vertices = {v.nr for e in fem.Materials("film").Elements() for v in e.vertices}
    pressure = free[blocks.p] - space.Range(1).start
    assert set(pressure.tolist()) == film_vertices
    # Nodes of the root face are held in all three directions.
    scalar = space.components[0].ndof // 3
    held = coarse_mesh.basis.nodes_of("root", codimension=1)
    mark = np.zeros(len(coarse_mesh.basis.points))
    mark[held] = 1.0
    on_root = np.flatnonzero(coarse_mesh.basis.to_dofs(mark)[: fem.nv])
    for component in range(3):
        assert not np.isin(on_root + component * scalar, free[blocks.u]).any()
    # Every node that touches the water carries potential, and no other one.
    wet = coarse_mesh.basis.nodes_of("water")
    assert len(blocks.psi) == len(wet)


def test_losses_add_up_and_keep_their_names() -> None:
    operators = shell().operators
    assert set(operators.moduli) == {"blade"}
    assert abs(operators.loss(3.0) - operators.terms["D blade"]).max() == 0.0
    assert (
        abs(operators.loss(3.0) - LOSSY.loss * operators.terms["K"]).max()
        < 1e-12 * abs(operators.terms["K"]).max()
    )
    assert ball().operators.loss(3.0).count_nonzero() == 0


def test_what_build_operators_refuses() -> None:
    fem = ball().fem
    stiffness, mass = linear_elastic(fem, SOFT, "blade")

    def build(**changes: object) -> None:
        free = {"clamped": None}  # a ball
        arguments = {"stiffness": stiffness, "mass": mass, "water": WATER, "radius": 1.0} | free
        build_operators(fem, **(arguments | changes))  # type: ignore[arg-type]

    with pytest.raises(MeshError, match=r"not a sphere of radius 1\.3"):
        build(radius=1.3)
    for name in ("root", "outer|root"):
        with pytest.raises(MeshError, match="no boundary of the mesh matches 'root'"):
            build(clamped=name)
    with pytest.raises(MeshError, match="matches 'hull'"):
        build(outer="hull")
    with pytest.raises(ValueError, match="'K' has shape"):
        build(stiffness=csr_matrix((5, 5)))
    skew = stiffness.tolil()
    skew[0, 1] += abs(stiffness).max()
    with pytest.raises(ValueError, match="'K' is not symmetric"):
        build(stiffness=skew.tocsr())
    motion = ngs.GridFunction(ngs.VectorH1(fem, order=2))
    motion.Set(ngs.CF((0.01, 0.0, 0.0)))
    with pytest.raises(MeshError, match=r"outer sphere moves by 0\.01 m"):
        build(motion=motion)


def test_mesh_without_water_is_refused() -> None:
    box = occ.Box(occ.Pnt(0, 0, 0), occ.Pnt(1, 1, 1)).mat("blade")
    fem = ngs.Mesh(occ.OCCGeometry(box).GenerateMesh(maxh=1.0))
    with pytest.raises(MeshError, match="no free unknown in the material 'water'"):
        free_unknowns(fem, clamped=None)
