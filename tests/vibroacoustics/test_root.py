# SPDX-License-Identifier: LGPL-2.1-or-later
"""A moving root: base motion, blocked forces, dynamic stiffness, shafts."""

from functools import cache

import ngsolve as ngs
import numpy as np
import pytest

from quietblade.linalg import make_solver
from quietblade.propulsion.tangent import compute_tangent
from quietblade.typing import ComplexArray, FloatArray
from quietblade.vibroacoustics.dtn import Dtn
from quietblade.vibroacoustics.modes import dry_modes, wet_modes
from quietblade.vibroacoustics.multipoles import SurfaceSources
from quietblade.vibroacoustics.point_loads import point_force
from quietblade.vibroacoustics.power import dissipated_by_region, power_budget, radiated_power
from quietblade.vibroacoustics.reduced import reduce_system
from quietblade.vibroacoustics.root import RootedSystem, add_root, elastic_shaft
from quietblade.vibroacoustics.transfer_functions import (
    RootPath,
    mobility,
    power_per_force,
    root_path,
)
from quietblade.vibroacoustics.vacuum import dry_operators
from verification.acoustics_excitation import PLATE
from verification.acoustics_oscillators import bar_carried, bar_stiffness, cantilever_mobility
from verification.acoustics_plate import WetPlate, solve_all
from verification.structure_models import Beam

FREQUENCY = np.array([15.0, 90.0, 210.0])
OMEGA = 2.0 * np.pi * FREQUENCY
PLACE, FORCE = np.array([0.06, 0.015, 0.2]), np.array([0.4, -1.0, 0.3])


def plate() -> WetPlate:
    return PLATE


@cache
def push() -> FloatArray:
    model = plate()
    force = point_force(model.basis, model.surface, PLACE, FORCE)
    return np.asarray(model.rooted.right_hand_side(force))


@cache
def path() -> RootPath:
    system = plate().rooted
    return root_path(
        system, OMEGA, push(), lambda loads: solve_all(system.operators, FREQUENCY, loads)
    )


def test_a_held_root_changes_nothing() -> None:
    model = plate()
    clamped = model.operators
    n = clamped.size
    load = push()[:n]
    exact = solve_all(clamped, FREQUENCY, load[None])[:, 0]
    found = path().response[:, 0]
    np.testing.assert_allclose(found[:, :n], exact, atol=1e-9 * np.abs(exact).max())
    assert np.abs(model.rooted.motion(found)).max() < 1e-12 * np.abs(exact).max()


def test_blocked_force_is_the_load_at_rest() -> None:
    system = plate().rooted
    x = solve_all(system.operators, np.array([0.05]), push()[None])
    arm = PLACE - system.about
    expected = np.concatenate([FORCE, np.cross(arm, FORCE)])
    blocked = -system.reaction(x)[0, 0]
    # 1 + i eta scales the displacement, not the force
    np.testing.assert_allclose(blocked, expected, atol=1e-4)


def test_reciprocity_of_blocked_force_and_carried_motion() -> None:
    carried = path().carried @ push()
    np.testing.assert_allclose(path().blocked[:, 0], carried, rtol=1e-7, atol=1e-9)


def test_dynamic_stiffness_is_symmetric_and_passive() -> None:
    for matrix in path().stiffness:
        scale = np.sqrt(np.outer(np.abs(np.diag(matrix)), np.abs(np.diag(matrix))))
        assert np.abs((matrix - matrix.T) / scale).max() < 1e-7
        scaled = matrix.imag / scale
        assert np.linalg.eigvalsh(0.5 * (scaled + scaled.T)).min() > -1e-9


def test_stiffness_at_low_frequency_is_the_mass_with_the_waters() -> None:
    model = plate()
    frequency = np.array([0.2])
    system = model.rooted
    carried = solve_all(system.operators, frequency, system.base_motion(np.eye(6)))
    stiffness = system.reaction(carried)[0]
    mass = -stiffness / (2.0 * np.pi * frequency[0]) ** 2
    own = model.solid.density * np.prod(model.sides)
    added = np.diag(mass).real[:3] - own
    # broadside the water of a cylinder on the width, less near the ends; edgewise little
    strip = 1000.0 * np.pi * (0.5 * model.sides[0]) ** 2 * model.sides[2]
    assert 0.5 * strip < added[1] < strip
    assert 0.0 < added[0] < 0.15 * strip
    assert 0.0 < added[2] < 0.15 * strip


def test_power_of_a_moved_root_balances() -> None:
    system = plate().rooted
    motion = np.array([0.3, -1.0, 0.2j, 0.5, 1.0j, -0.4])
    load = system.base_motion(motion)
    x = np.einsum("i,fin->fn", motion, path().carried)
    budget = power_budget(system.operators, OMEGA, x, load)
    assert budget.residual.max() < 1e-8
    assert min(budget.radiated.min(), budget.dissipated.min()) > 0.0
    work = np.sum(system.reaction(x).conj() * (1j * OMEGA[:, None] * motion), axis=1)
    np.testing.assert_allclose(budget.injected, 0.5 * work.real, rtol=1e-9)


def test_shaft_in_the_system_and_behind_it_agree() -> None:
    system = plate().rooted
    generator = np.random.default_rng(1)

    def positive(scale: float) -> FloatArray:
        part = generator.standard_normal((6, 6))
        return scale * (part @ part.T + np.eye(6))

    K, C, M = positive(3e5), positive(40.0), positive(0.5)
    impedance = np.array([C + 1j * (w * M - K / w) for w in OMEGA])
    held = elastic_shaft(system, K, C, M)
    load = held.right_hand_side(point_force(plate().basis, plate().surface, PLACE, FORCE))
    x = solve_all(held.operators, FREQUENCY, load[None])[:, 0]
    behind = path().supported(impedance)[:, 0]
    np.testing.assert_allclose(
        system.motion(behind), path().motion(impedance)[:, 0], rtol=1e-9, atol=1e-15
    )
    np.testing.assert_allclose(held.motion(x), system.motion(behind), rtol=1e-7, atol=1e-15)
    n = plate().operators.size
    np.testing.assert_allclose(behind[:, :n], x[:, :n], atol=1e-8 * np.abs(x).max())
    into = dissipated_by_region(held.operators, OMEGA, x)
    np.testing.assert_allclose(path().power(impedance)[:, 0], into["shaft"], rtol=1e-7)
    budget = power_budget(held.operators, OMEGA, x, load)
    assert budget.residual.max() < 1e-8
    assert np.all(path().power(np.full(6, 1e3)) > 0.0)
    with pytest.raises(ValueError, match="symmetric"):
        elastic_shaft(system, np.triu(np.ones((6, 6))), C, M)
    with pytest.raises(ValueError, match="shape"):
        path().power(np.ones(5))


def test_modes_of_a_held_root_are_those_of_the_clamped_blade() -> None:
    model = plate()
    held, clamped = model.rooted.operators, model.operators
    for modes in (wet_modes, dry_modes):
        one, other = modes(held, 400.0), modes(clamped, 400.0)
        assert one.count == other.count >= 2
        np.testing.assert_allclose(one.frequency, other.frequency, rtol=1e-8)
        np.testing.assert_allclose(one.loss_factor, other.loss_factor, rtol=1e-6)


def test_modes_on_a_shaft() -> None:
    _, system, _ = bar()
    stiff, nothing = 1e6 * np.abs(np.diag(system.operators.terms["K"].toarray())[-12:-6]), 0.0
    held = dry_modes(elastic_shaft(system, stiff, nothing * stiff, nothing * stiff).operators, 60.0)
    clamped = dry_modes(system.operators, 60.0)
    np.testing.assert_allclose(held.frequency, clamped.frequency, rtol=1e-4)
    soft = 1e-8 * stiff
    loose = dry_modes(elastic_shaft(system, soft, nothing * stiff, nothing * stiff).operators, 60.0)
    assert loose.count > clamped.count
    assert np.all(loose.frequency[: clamped.count] < clamped.frequency)


def test_reduced_model_of_base_motion_and_reaction() -> None:
    system = plate().rooted
    loads = np.stack([push(), system.base_motion(np.array([0.0, 1.0, 0.0, 0.1, 0.0, 0.0]))])
    solver = make_solver(precision="double", tolerance=1e-12)
    sweep = reduce_system(
        system.operators, loads, np.linspace(60.0, 240.0, 19), tolerance=1e-3, solver=solver
    )
    exact = solve_all(system.operators, FREQUENCY[1:], loads)
    found = sweep.model.solution(OMEGA[1:])
    forces = system.reaction(exact)
    np.testing.assert_allclose(system.reaction(found), forces, atol=1e-3 * np.abs(forces).max())
    np.testing.assert_allclose(
        system.motion(found)[:, 1], [[0.0, 1.0, 0.0, 0.1, 0.0, 0.0]] * 2, atol=1e-9
    )
    assert sweep.model.budget(OMEGA).residual.max() < 1e-7


def test_mobility_is_passive_and_reciprocal() -> None:
    model = plate()
    forces = np.stack([
        point_force(model.basis, model.surface, PLACE, FORCE),
        point_force(model.basis, model.surface, np.array([-0.05, -0.015, 0.1]), np.ones(3)),
    ])  # fmt: skip
    operators = model.operators
    loads = operators.right_hand_side(forces.T).T
    x = solve_all(operators, FREQUENCY, loads)
    there, back = mobility(OMEGA, x[:, 0], loads[1]), mobility(OMEGA, x[:, 1], loads[0])
    np.testing.assert_allclose(there, back, rtol=1e-8)
    drive = mobility(OMEGA, x[:, 0], loads[0])
    budget = power_budget(operators, OMEGA, x[:, 0], loads[0])
    assert np.all(drive.real > 0.0)
    np.testing.assert_allclose(budget.injected, 0.5 * drive.real, rtol=1e-9)
    np.testing.assert_allclose(
        mobility(OMEGA, x[:, 0], loads[0], acceleration=True), 1j * OMEGA * drive, rtol=1e-12
    )
    np.testing.assert_allclose(power_per_force(budget.radiated, 2.0), 0.5 * budget.radiated)


@cache
def bar() -> tuple[Beam, RootedSystem, ComplexArray]:
    """A dry bar with loss and what frequencies to look at."""
    beam = Beam(length=2.0, height=0.1, cells=20, youngs_modulus=1e9)
    structure = beam.structure()
    tangent = compute_tangent(structure, structure.rest())
    matrices = {"stiffness": tangent.stiffness(), "mass": tangent.mass}
    loss = {"blade": 0.05 * tangent.region_material["blade"]}
    operators = dry_operators(
        **matrices, free=tangent.free, displacements=structure.forms.n_displacement, loss=loss
    )
    system = add_root(operators, structure.forms.fem, structure.basis, **matrices, loss=loss)
    return beam, system, np.array([50.0, 124.0, 260.0])


def test_bar_moved_at_its_end_in_closed_form() -> None:
    beam, system, frequency = bar()
    omega, young = 2.0 * np.pi * frequency, beam.youngs_modulus * (1.0 + 0.05j)
    x = solve_all(system.operators, frequency, system.base_motion(np.eye(6)[2])[None])[:, 0]
    structure = beam.structure()
    tip = system.right_hand_side(beam.tip_load(structure, np.array([0.0, 0.0, 1.0])))
    exact = bar_carried(omega, beam.length, beam.length, young, beam.density)
    np.testing.assert_allclose(x @ tip, exact, rtol=1e-4)
    stiffness = bar_stiffness(omega, beam.length, beam.height**2, young, beam.density)
    np.testing.assert_allclose(system.reaction(x)[:, 2], stiffness, rtol=1e-4)
    budget = power_budget(system.operators, omega, x, system.base_motion(np.eye(6)[2]))
    assert budget.residual.max() < 1e-8
    assert np.all(budget.radiated == 0.0)


def test_rigid_mass_of_a_dry_bar() -> None:
    beam, system, _ = bar()
    frequency = np.array([0.05])
    x = solve_all(system.operators, frequency, system.base_motion(np.eye(6)))
    mass = -system.reaction(x)[0].real / (2.0 * np.pi * frequency[0]) ** 2
    own = beam.density * beam.height**2 * beam.length
    np.testing.assert_allclose(np.diag(mass)[:3], own, rtol=1e-3)
    turning = own * (beam.length**2 / 3.0 + beam.height**2 / 12.0)
    assert mass[3, 3] == pytest.approx(turning, rel=1e-3)
    assert mass[5, 5] == pytest.approx(own * beam.height**2 / 6.0, rel=1e-3)


def test_mobility_of_a_beam_in_closed_form() -> None:
    beam, system, _ = bar()
    structure = beam.structure()
    tip = system.right_hand_side(beam.tip_load(structure, np.array([0.0, 1.0, 0.0])))
    frequency = np.array([1.5, 3.0, 8.0])
    omega = 2.0 * np.pi * frequency
    x = solve_all(system.operators, frequency, tip[None])[:, 0]
    exact = cantilever_mobility(
        omega, beam.length, beam.bending_stiffness * (1.0 + 0.05j), beam.density * beam.height**2
    )
    # the beam is 20 times as long as high: shear and rotary inertia take part
    np.testing.assert_allclose(mobility(omega, x, tip), exact, rtol=0.03)


def test_what_add_root_refuses() -> None:
    beam, system, _ = bar()
    structure = beam.structure()
    empty = system.operators.terms["K"]
    with pytest.raises(ValueError, match="once"):
        add_root(system.operators, structure.forms.fem, structure.basis, stiffness=empty,
                 mass=empty)  # fmt: skip
    model = plate()
    stiffness, mass = model.matrices
    with pytest.raises(ValueError, match="lossy regions"):
        add_root(model.operators, model.fem, model.basis, stiffness=stiffness, mass=mass)
    assert isinstance(model.fem, ngs.Mesh)


@pytest.mark.parametrize("axis", [1, 2])
def test_far_field_of_a_moving_root_is_what_passes_the_sphere(axis: int) -> None:
    model = WetPlate(condition=Dtn(6))
    system, omega = model.rooted, OMEGA[1:2]
    response = solve_all(
        system.operators, FREQUENCY[1:2], system.base_motion(np.eye(6)[axis])[None]
    )
    through = radiated_power(system.operators, omega, response[:, 0])

    def difference(sources: SurfaceSources) -> float:
        return float(np.abs(sources.multipoles(omega, response[:, 0]).power / through - 1.0)[0])

    moving = SurfaceSources.of(model.fem, model.basis, system.operators, carried=system.carried)
    still = SurfaceSources.of(model.fem, model.basis, system.operators)
    assert difference(moving) < 0.02
    assert difference(still) > 5.0 * difference(moving)
