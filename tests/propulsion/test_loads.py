# SPDX-License-Identifier: LGPL-2.1-or-later
from functools import cache

import ngsolve as ngs
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from quietblade.geometry import Blade
from quietblade.materials import IsotropicSVK, find_material
from quietblade.mesh import INTERFACE, Mesh
from quietblade.propulsion.loads import (
    Gravity,
    HydrostaticPressure,
    LineForce,
    LoadError,
    PointForce,
    PressureAtPoints,
    PressureTable,
    UniformPressure,
)
from quietblade.propulsion.loads_assembly import apply_loads, resultant
from quietblade.propulsion.loads_places import SolidPlaces
from quietblade.propulsion.structure import Structure
from quietblade.typing import FloatArray
from tests.propulsion.solid_models import bent_plate, plate
from verification.structure_models import SURFACE, box_mesh

ALUMINIUM = find_material("aluminium-paper")


@cache
def block() -> Structure:
    """A box from (0, 0, 0) to (0.3, 0.2, 1)."""
    planes = np.linspace(0.0, 1.0, 4)
    mesh = box_mesh(0.3 * planes, 0.2 * planes, planes)
    return Structure(mesh, {"blade": ALUMINIUM}, wetted=SURFACE)


@pytest.fixture(scope="module")
def blade_structure(coarse_mesh: Mesh) -> Structure:
    materials = {"blade": ALUMINIUM, "film": find_material("viscoelastic-paper")}
    return Structure(coarse_mesh.fem, materials, basis=coarse_mesh.basis, wetted=INTERFACE)


places = st.tuples(
    st.floats(0.0, 0.3), st.floats(0.0, 0.2), st.floats(0.0, 1.0), st.sampled_from("xyz-")
)


@settings(max_examples=25, deadline=None)
@given(places, st.tuples(*3 * [st.floats(-5.0, 5.0)]))
def test_a_point_force_keeps_force_and_moment(
    place: tuple[float, float, float, str], force: tuple[float, float, float]
) -> None:
    *point, face = place
    if face != "-":
        point["xyz".index(face)] = 0.0  # on the surface, where cells may or may not be found
    load = PointForce((point[0], point[1], point[2]), force)
    applied = apply_loads(block(), [load])
    assert applied.force == pytest.approx(np.array(force), abs=1e-9)
    assert applied.moment == pytest.approx(np.cross(point, force), abs=1e-8)


def test_a_place_near_the_blade_moves_to_its_surface(blade_structure: Structure) -> None:
    places = SolidPlaces(blade_structure.forms)
    nodes = blade_structure.basis.nodes_of(INTERFACE, 1)
    surface = blade_structure.basis.points[nodes]
    on = places.find(surface[10])
    assert on.distance < 1e-7
    assert on.place == pytest.approx(surface[10], abs=1e-7)
    assert on.shape.sum() == pytest.approx(np.array(on.shape).sum())
    tip = surface[np.argmax(surface[:, 2])] + np.array([0.0, 0.0, 0.004])
    off = places.find(tip)
    assert off.distance == pytest.approx(0.004, rel=1e-3)
    assert off.place[2] == pytest.approx(tip[2] - 0.004, abs=1e-6)


def test_a_place_off_the_blade_is_refused_with_the_distance() -> None:
    load = PointForce((0.15, 0.21, 0.5), (1.0, 0.0, 0.0))
    with pytest.raises(LoadError, match=r"0\.01 m off the blade.*nearest point is \[0\.15 0\.2 "):
        apply_loads(block(), [load])
    applied = apply_loads(block(), [PointForce(load.place, load.force, tolerance=0.02)])
    assert applied.parts[0].distance == pytest.approx(0.01)


def test_a_point_force_does_the_work_of_its_place() -> None:
    structure, state = plate(), bent_plate()
    place = (0.01, 0.002, 0.33)
    applied = apply_loads(structure, [PointForce(place, (1.0, -2.0, 3.0))])
    moved = structure.forms.displacement(state.displacement)
    expected = np.array(moved(structure.forms.fem(*place))) @ [1.0, -2.0, 3.0]
    assert applied.dead_load @ state.displacement == pytest.approx(expected, rel=1e-10)


def test_a_line_force_is_linear_between_its_corners() -> None:
    path = np.array([[0.1, 0.2, 0.1], [0.1, 0.2, 0.9], [0.25, 0.2, 0.9]])
    force = np.array([[0.0, 1.0, 0.0], [0.0, 3.0, 0.0], [2.0, 0.0, 0.0]])
    applied = apply_loads(block(), [LineForce(path, force)])
    assert applied.force == pytest.approx([0.15, 1.6 + 0.225, 0.0])
    # first part: mean 2, centre of 1 + 2 t at 7/12 of its length
    first = np.cross([0.1, 0.2, 0.1 + 0.8 * 7 / 12], [0.0, 1.6, 0.0])
    moment = np.zeros(3)
    for t, w in zip(*np.polynomial.legendre.leggauss(4), strict=True):
        share = 0.5 * (1 + t)
        at, local = path[1] + share * (path[2] - path[1]), force[1] + share * (force[2] - force[1])
        moment += 0.5 * w * 0.15 * np.cross(at, local)
    assert applied.moment == pytest.approx(first + moment, abs=1e-9)


def test_weight_acts_at_the_centre_of_mass_without_buoyancy() -> None:
    gravity = (0.5, -1.0, -9.0)
    applied = apply_loads(block(), [Gravity(gravity)])
    weight = ALUMINIUM.density * 0.06 * np.array(gravity)
    assert applied.force == pytest.approx(weight)
    assert applied.moment == pytest.approx(np.cross([0.15, 0.1, 0.5], weight))


def test_mean_hydrostatic_pressure_is_that_of_the_axial_depth() -> None:
    gravity = (-1.0, -3.0, -9.0)
    structure = block()
    mean, frozen = (
        apply_loads(structure, [HydrostaticPressure(1000.0, 20.0, gravity, position, 1e5)])
        for position in ("mean", "frozen")
    )
    nodes = structure.basis.nodes_of(SURFACE, 1)
    points = structure.basis.points[nodes]
    base = 1e5 + 1000.0 * np.linalg.norm(gravity) * 20.0
    assert mean.pressure[nodes] == pytest.approx(base - 1000.0 * points[:, 0])
    assert frozen.pressure[nodes] == pytest.approx(base + 1000.0 * points @ np.array(gravity))
    level = apply_loads(structure, [HydrostaticPressure(1000.0, 20.0)])
    assert np.ptp(level.pressure[nodes]) == 0.0


def test_a_point_above_the_water_is_refused() -> None:
    shallow = HydrostaticPressure(1000.0, 0.5, position="frozen")
    with pytest.raises(LoadError, match=r"0\.5 m above the free surface"):
        apply_loads(block(), [shallow])


def test_pressure_follows_the_surface_that_is_wet() -> None:
    structure = block()
    applied = apply_loads(structure, [UniformPressure(100.0)])
    # only the root face is dry
    assert applied.force == pytest.approx([0.0, 0.0, -100.0 * 0.06])
    dry = np.setdiff1d(np.arange(len(structure.basis.points)), structure.basis.nodes_of(SURFACE, 1))
    assert np.abs(applied.pressure[dry]).max(initial=0.0) == 0.0


def test_pressure_at_points_is_taken_from_the_nearest() -> None:
    structure = block()
    nodes = structure.basis.nodes_of(SURFACE, 1)
    points = structure.basis.points[nodes] + 1e-3
    values = np.arange(len(nodes), dtype=float)
    applied = apply_loads(structure, [PressureAtPoints(points, values, 0.01)])
    assert applied.pressure[nodes] == pytest.approx(values)
    assert applied.parts[0].distance == pytest.approx(1e-3 * np.sqrt(3))
    with pytest.raises(LoadError, match="more than the reach"):
        apply_loads(structure, [PressureAtPoints(points[:5], values[:5], 0.01)])


def test_a_table_knows_the_two_sides(blade_structure: Structure, small_film_blade: Blade) -> None:
    s, xi = np.array([0.0, 1.0]), np.array([0.0, 0.5, 1.0])
    upper = np.array([[1.0, 1.0, 1.0], [3.0, 3.0, 3.0]])
    lower = -np.array([[0.0, 5.0, 10.0], [0.0, 5.0, 10.0]])
    table = PressureTable(s, xi, upper, lower)
    applied = apply_loads(blade_structure, [table], blade=small_film_blade)
    nodes = blade_structure.basis.nodes_of(INTERFACE, 1)
    points = blade_structure.basis.points[nodes]
    at, chord, height = small_film_blade.locate(points)
    middle = (np.abs(height) > 0.01) & (chord > 0.1) & (chord < 0.9)
    expected = np.where(height > 0.0, 1.0 + 2.0 * at, -10.0 * chord)
    assert applied.pressure[nodes][middle] == pytest.approx(expected[middle], abs=1e-9)
    with pytest.raises(LoadError, match="need the blade's shape"):
        apply_loads(blade_structure, [table])


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: UniformPressure(np.nan), "nan is not a finite number"),
        (lambda: LineForce(np.zeros((1, 3)), np.zeros(3)), "at least two corners"),
        (lambda: LineForce(np.zeros((2, 3)), np.zeros(3)), "the same point"),
        (lambda: PressureAtPoints(np.zeros((2, 3)), np.zeros(3), 1.0), "do not fit"),
        (lambda: HydrostaticPressure(0.0, 1.0), "water density 0"),
        (
            lambda: PressureTable(
                np.array([0.1, 1.0]), np.array([0.0, 1.0]), np.zeros((2, 2)), np.zeros((2, 2))
            ),
            "reaches from 0.1 to 1",
        ),
        (
            lambda: PressureTable(
                np.array([0.0, 1.0]), np.array([0.0, 1.0]), np.zeros((2, 2)), np.zeros((2, 3))
            ),
            "do not fit the grid",
        ),
    ],
)
def test_impossible_loads_are_refused(make: object, message: str) -> None:
    assert callable(make)
    with pytest.raises(LoadError, match=message):
        make()


def test_no_load_at_all_is_nothing() -> None:
    applied = apply_loads(block(), [])
    assert np.abs(applied.force).max() == np.abs(applied.dead_load).max() == 0.0


# -- equilibrium under all of them ----------------------------------------------------------------


def bar(rotation: FloatArray) -> tuple[Structure, FloatArray, FloatArray]:
    """A loaded bar, turned as a whole."""
    mesh = box_mesh(
        np.linspace(-0.05, 0.05, 2), np.linspace(-0.02, 0.02, 2), np.linspace(0.0, 0.5, 6),
        move=lambda p: p @ rotation.T,
    )  # fmt: skip
    structure = Structure(mesh, {"blade": IsotropicSVK("soft", 1000.0, 1e7, 0.3)}, wetted=SURFACE)

    def turned(*vector: float) -> tuple[float, float, float]:
        a, b, c = rotation @ np.array(vector)
        return float(a), float(b), float(c)

    path = np.array([turned(0.0, 0.02, 0.1), turned(0.0, 0.02, 0.5)])
    loads = [
        UniformPressure(2e4),
        PointForce(turned(0.05, 0.02, 0.5), turned(3.0, 8.0, -2.0)),
        LineForce(path, rotation @ np.array([0.0, 10.0, 4.0])),
        Gravity(turned(0.0, 2.0, -9.0)),
        HydrostaticPressure(1000.0, 3.0, turned(0.0, 2.0, -9.0), "frozen"),
    ]
    applied = apply_loads(structure, loads)
    state = structure.solve(applied.pressure, dead_load=applied.dead_load, tolerance=1e-10)
    difference = structure.internal_force(state) - structure.external_force(state)
    assert np.abs(difference[structure.forms.free]).max() < 1e-7 * np.abs(difference).max()
    # what the clamp carries balances the loads on the deformed bar, force and moment
    loads_now = resultant(
        structure.forms, structure.external_force(state), displacement=state.displacement
    )
    reactions = resultant(structure.forms, difference, displacement=state.displacement)
    for load, reaction in zip(loads_now, reactions, strict=True):
        assert reaction == pytest.approx(-load, rel=1e-6, abs=1e-7)
    return structure, structure.values(state), np.concatenate(loads_now)


@settings(max_examples=3, deadline=None)
@given(st.tuples(*3 * [st.floats(-2.0, 2.0)]))
def test_a_rotation_of_the_whole_problem_turns_its_solution(
    vector: tuple[float, float, float],
) -> None:
    rotation = Rotation.from_rotvec(vector).as_matrix()
    _, still, _ = bar(np.eye(3))
    _, turned, _ = bar(rotation)
    assert np.abs(still).max() > 0.02
    assert turned == pytest.approx(still @ rotation.T, abs=1e-7)


def test_curved_tetrahedra_pyramids_and_hexahedra_pass_the_patch_test(coarse_mesh: Mesh) -> None:
    everywhere = f"root|{INTERFACE}"
    structure = Structure(
        coarse_mesh.fem, {"blade": ALUMINIUM, "film": ALUMINIUM}, basis=coarse_mesh.basis,
        clamped=everywhere, wetted=INTERFACE,
    )  # fmt: skip
    kinds = {str(e.type) for e in coarse_mesh.fem.Elements(ngs.VOL) if e.mat in ("blade", "film")}
    assert len(kinds) == 3
    gradient = np.array([[0.01, 0.02, -0.01], [0.03, -0.02, 0.0], [0.01, 0.02, 0.015]])
    exact = structure.basis.points @ gradient.T
    free = structure.forms.free
    noise = 1e-5 * np.random.default_rng(3).standard_normal(len(free))
    begin = structure.rest()
    unknowns = structure.basis.to_dofs(exact) + np.where(free, noise, 0.0)
    start = type(begin)(unknowns, begin.film_pressure, begin.loading)
    state = structure.solve(np.zeros(len(exact)), start, tolerance=1e-9)
    solid = structure.forms.solid_nodes
    # the mapping of curved pyramids and hexahedra is rational: quadrature leaves 1e-5 of a strain
    assert structure.values(state)[solid] == pytest.approx(exact[solid], abs=2e-8)
