# SPDX-License-Identifier: LGPL-2.1-or-later
from dataclasses import replace

import ngsolve as ngs
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quietblade.errors import MaterialError, MeshError
from quietblade.materials import find_material
from quietblade.mesh import INTERFACE, Mesh
from quietblade.propulsion.forms import StructuralForms
from quietblade.propulsion.structure import EquilibriumError, Spin, Structure
from quietblade.typing import FloatArray
from tests.propulsion.solid_models import ALL_FACES, bent_plate, lift, plate, plate_mesh
from verification.structure_models import SURFACE, Beam, box_mesh, uniform_pressure
from verification.structure_statics import film_block, homogeneous, nominal_stress

ALUMINIUM = find_material("aluminium-paper")
FILM = find_material("viscoelastic-paper")


def total(structure: Structure, forces: FloatArray) -> FloatArray:
    """Resultant (3,): the vertex functions alone add up to one."""
    blocks = forces[: structure.forms.n_displacement].reshape(3, -1)
    return blocks[:, : structure.forms.fem.nv].sum(axis=1)


def test_a_rigid_rotation_costs_no_force() -> None:
    structure = plate()
    rotation = Rotation.from_rotvec([0.9, -0.4, 0.6]).as_matrix()
    points = structure.basis.points
    moved = structure.basis.to_dofs(points @ (rotation - np.eye(3)).T)
    turned = replace(structure.rest(), displacement=moved)
    force = structure.internal_force(turned)
    stretched = replace(turned, displacement=1.001 * moved)
    n = structure.forms.n_displacement
    assert np.abs(force[:n]).max() < 3e-8 * np.abs(structure.internal_force(stretched)[:n]).max()
    assert np.abs(force[n:]).max() < 1e-15  # volume defect [m3]


def test_outward_normal_does_not_depend_on_the_orientation_of_faces() -> None:
    mesh = plate_mesh()
    materials = {"blade": ALUMINIUM, "film": FILM}
    forms = StructuralForms(mesh, materials, clamped=None, wetted=ALL_FACES)
    place, all_faces = ngs.CF((ngs.x, ngs.y, ngs.z)), mesh.Boundaries(ALL_FACES)
    volume = ngs.Integrate(1.0, mesh)
    mixed = ngs.Integrate(ngs.specialcf.normal(3) * place, mesh, definedon=all_faces)
    assert abs(mixed) < 2.5 * volume  # the faces of this mesh do not agree
    flux = ngs.Integrate(forms.outward_normal * place, mesh, definedon=all_faces)
    assert flux == pytest.approx(3 * volume, rel=1e-3)
    closed = [ngs.Integrate(c, mesh, definedon=all_faces) for c in forms.outward_normal]
    assert closed == pytest.approx([0.0, 0.0, 0.0], abs=1e-12)


def test_pressure_pushes_on_the_deformed_surface() -> None:
    structure, state = plate(), bent_plate()
    forms, mesh = structure.forms, structure.forms.fem
    forms.set_loading(state.loading)
    still = Structure(mesh, forms.materials, wetted=SURFACE, basis=structure.basis)
    mesh.SetDeformation(forms.displacement(state.displacement))
    on_surface = mesh.Boundaries(SURFACE)
    push = [
        ngs.Integrate(-forms.load_pressure * n, mesh, definedon=on_surface, order=8)
        for n in forms.outward_normal
    ]
    mesh.UnsetDeformation()
    assert total(structure, still.external_force(state)) == pytest.approx(push, rel=1e-10)


def test_centrifugal_force_acts_at_the_deformed_place() -> None:
    structure, state = plate(), bent_plate()
    mesh, moved = structure.forms.fem, structure.forms.displacement(state.displacement)
    mass = mesh.MaterialCF({"blade": 1500.0, "film": 1400.0})
    expected = [
        20.0**2 * ngs.Integrate(mass * (place + moved[i]), mesh)
        for i, place in ((1, ngs.y), (2, ngs.z))
    ]
    unpressed = replace(state, loading=replace(state.loading, pressure=0 * state.loading.pressure))
    force = total(structure, structure.external_force(unpressed))
    assert force == pytest.approx([0.0, *expected], abs=1e-9 * expected[1])


def test_reaction_balances_the_loads() -> None:
    structure, state = plate(), bent_plate()
    difference = structure.internal_force(state) - structure.external_force(state)
    free = structure.forms.free
    assert np.abs(difference[free]).max() < 1e-8 * np.abs(difference).max()
    assert total(structure, structure.internal_force(state)) == pytest.approx([0, 0, 0], abs=1e-6)


def test_newton_converges_quadratically_in_a_short_table() -> None:
    steps = bent_plate().newton
    increments = [s.increment for s in steps if s.new_tangent]
    assert bent_plate().converged
    assert len(steps) < 10
    assert increments[-1] < 100 * increments[-2] ** 2 or increments[-1] < 1e-7
    assert steps[-1].residual < 1e-10
    assert "residual" in str(steps[-1])


def test_a_restart_finds_the_same_equilibrium_faster() -> None:
    structure, whole = plate(), bent_plate()
    most = structure.solve(lift(structure, 3.9e3))
    again = structure.solve(lift(structure, 4e3), most, tolerance=1e-10)
    assert again.displacement == pytest.approx(whole.displacement, abs=1e-8)
    tangents = [sum(s.new_tangent for s in state.newton) for state in (whole, again)]
    assert tangents[1] < tangents[0]
    structure.forget()
    fresh = structure.solve(lift(structure, 4e3), most, tolerance=1e-10)
    assert fresh.displacement == pytest.approx(whole.displacement, abs=1e-8)


def test_load_steps_are_cut_back_and_the_path_does_not_matter() -> None:
    beam = Beam(cells=10)
    structure = beam.structure()
    q = 10 * beam.bending_stiffness / beam.length**3 / beam.height
    pushed = Structure(structure.forms.fem, structure.forms.materials, wetted="lower")
    pressure = uniform_pressure(pushed.basis, "lower", q)
    messages: list[str] = []
    far = pushed.solve(pressure, progress=lambda stage, done, text: messages.append(text))
    fractions = sorted({s.fraction for s in far.newton})
    assert len(fractions) > 1
    assert fractions[-1] == 1.0
    assert len(messages) >= len(fractions)
    state = None
    for part in (0.2, 0.4, 0.6, 0.8, 1.0):
        state = pushed.solve(part * pressure, state)
    assert pushed.values(state) == pytest.approx(pushed.values(far), abs=1e-6 * beam.length)


def test_a_load_beyond_all_equilibria_is_reported_with_the_last_good_state() -> None:
    # a Saint-Venant-Kirchhoff bar carries at most 0.1925 E A in compression
    beam = Beam(length=0.3, cells=1)
    structure = beam.structure()
    capacity = beam.youngs_modulus * beam.height**2 / (3 * np.sqrt(3))
    load = beam.tip_load(structure, np.array([0.0, 0.0, -1.3 * capacity]))
    nothing = np.zeros(len(structure.basis.points))
    with pytest.raises(EquilibriumError, match="no static equilibrium between") as caught:
        structure.solve(nothing, dead_load=load)
    assert caught.value.fraction == pytest.approx(1 / 1.3, abs=0.03)
    assert not caught.value.state.converged
    reached = structure.solve(nothing, dead_load=0.95 * caught.value.fraction * load)
    assert reached.converged


def test_no_load_gives_no_displacement() -> None:
    structure = plate()
    still = Structure(structure.forms.fem, structure.forms.materials, wetted=SURFACE)
    nothing = np.zeros(len(structure.basis.points))
    state = still.solve(nothing)
    assert state.converged
    assert len(state.newton) == 1
    assert np.abs(state.displacement).max() == 0.0


def test_unloading_leads_back_to_rest() -> None:
    structure = plate()
    still = Structure(structure.forms.fem, structure.forms.materials, wetted=SURFACE)
    loaded = still.solve(lift(structure, 1e3))
    back = still.solve(0.0 * lift(structure), loaded)
    assert np.abs(back.displacement).max() < 1e-8 * np.abs(loaded.displacement).max()


def test_distorted_mixed_cells_pass_the_patch_test() -> None:
    structure = film_block()
    gradient = np.array([[1.0, 0.05, -0.02], [0.1, 0.98, 0.03], [0.0, -0.04, 1.021]])
    state = homogeneous(structure, gradient)
    exact = structure.basis.points @ (gradient - np.eye(3)).T
    assert structure.values(state) == pytest.approx(exact, abs=1e-10)
    pressure = FILM.bulk_modulus * (np.linalg.det(gradient) - 1)
    film = structure.forms.free[structure.forms.n_displacement :]
    assert state.film_pressure[film] == pytest.approx(pressure, rel=1e-8)
    # stress by differentiation of the energy along a path
    unit, step = np.array([[0, 1, 0], [0, 0, 0], [0, 0, 0]]), 1e-4
    energies = [
        ngs.Integrate(
            FILM.energy(
                ngs.CF(tuple((gradient + f * step * unit).ravel()), dims=(3, 3)), ngs.CF(pressure)
            ),
            structure.forms.fem,
        )
        for f in (1, -1)
    ]
    stress = nominal_stress(structure, state)
    assert stress[0, 1] == pytest.approx((energies[0] - energies[1]) / (2 * step), rel=1e-6)


def test_a_film_of_elastic_material_has_no_pressure_unknowns() -> None:
    mesh = plate_mesh()
    solid = Structure(mesh, {"blade": ALUMINIUM, "film": ALUMINIUM}, wetted=SURFACE)
    assert solid.forms.n_pressure == 0
    plain = box_mesh(
        np.linspace(-0.05, 0.05, 4), np.array([-0.005, 0.005]), np.linspace(0.1, 0.6, 6)
    )
    layered = box_mesh(
        np.linspace(-0.05, 0.05, 4), np.array([-0.005, 0.0, 0.005]), np.linspace(0.1, 0.6, 6),
        in_film=lambda c: c[:, 1] > 0,
    )  # fmt: skip
    tips = []
    for box in (plain, layered):
        materials = dict.fromkeys(box.GetMaterials(), ALUMINIUM)
        structure = Structure(box, materials, wetted="lower")
        state = structure.solve(uniform_pressure(structure.basis, "lower", 5e3))
        tips.append(structure.values(state)[structure.basis.nodes_of("tip", 1)].mean(axis=0)[1])
    assert tips[0] == pytest.approx(tips[1], rel=2e-3)


def test_wrong_input_is_refused() -> None:
    mesh = plate_mesh()
    with pytest.raises(MaterialError, match="region 'film' of the mesh has no material"):
        Structure(mesh, {"blade": ALUMINIUM}, wetted=SURFACE)
    with pytest.raises(MaterialError, match="blade and film both"):
        Structure(mesh, {"blade": FILM, "film": FILM}, wetted=SURFACE)
    with pytest.raises(MeshError, match="region 'rib', which the mesh does not have"):
        Structure(mesh, {"blade": ALUMINIUM, "film": FILM, "rib": ALUMINIUM}, wetted=SURFACE)
    both = {"blade": ALUMINIUM, "film": FILM}
    for name in ("hub", "hub|root", "root|hub"):  # a name among others would hold nothing
        with pytest.raises(MeshError, match="no boundary of the mesh matches 'hub'"):
            Structure(mesh, both, clamped=name, wetted=SURFACE)
    with pytest.raises(MeshError, match="no boundary of the mesh matches 'hub'"):
        Structure(mesh, both, guided={"x": "root|hub"}, wetted=SURFACE)
    with pytest.raises(ValueError, match="pressure has to be"):
        plate().solve(np.zeros(3))
    with pytest.raises(ValueError, match="dead_load has to be"):
        plate().solve(lift(plate()), dead_load=np.full(7, np.nan))


def test_a_blade_in_water_is_pushed_through_its_wetted_surface_only(coarse_mesh: Mesh) -> None:
    materials = {"blade": ALUMINIUM, "film": FILM}
    structure = Structure(coarse_mesh.fem, materials, basis=coarse_mesh.basis, wetted=INTERFACE)
    root = ngs.Integrate(1.0, coarse_mesh.fem, definedon=coarse_mesh.fem.Boundaries("root"))
    uniform = np.full(len(structure.basis.points), 1e3)
    state = structure.solve(uniform)
    # the open surface is closed by the root: pressure pulls the blade into the hub
    push = total(structure, structure.external_force(state))
    assert push == pytest.approx([0.0, 0.0, -1e3 * root], abs=2e-3 * root * 1e3)
    water = np.setdiff1d(np.arange(len(coarse_mesh.nodes)), structure.basis.nodes_of("blade|film"))
    assert np.abs(structure.values(state)[water]).max() == 0.0
    inside = state.film_pressure[structure.forms.free[structure.forms.n_displacement :]]
    # the metal around the film carries a part of it near the film's edges
    assert -1.3e3 < inside.min() < inside.max() < 0.0


def test_spin_is_a_rate_about_the_rotor_axis() -> None:
    beam = Beam(length=1.0, cells=4, density=1000.0)
    still, spinning = beam.structure(), beam.structure(Spin(0.5))
    nothing = np.zeros(len(still.basis.points))
    stretch = spinning.values(spinning.solve(nothing))[:, 2].max()
    exact = 1000.0 * 0.5**2 * 1.0**3 / (3 * beam.youngs_modulus)
    assert stretch == pytest.approx(exact, rel=2e-3)
