# SPDX-License-Identifier: LGPL-2.1-or-later
"""Flow and structure on a stiffened paper blade, so that a coarse mesh serves."""

import numpy as np
import pytest

from quietblade.errors import ConvergenceError
from quietblade.flow.inflow import StripInflow, strip_loads
from quietblade.geometry import Blade
from quietblade.materials import IsotropicSVK, MooneyRivlin
from quietblade.mesh import Mesh, MeshSpec, build_mesh
from quietblade.mesh.surface import SurfaceQuadrature
from quietblade.propulsion.coupling import Method, StaticState, solve_static
from quietblade.propulsion.divergence import divergence_pressure
from quietblade.propulsion.loading import Spin
from quietblade.propulsion.structure import Structure
from quietblade.propulsion.transfer import LoadTransfer
from tests.conftest import PATCH, make_twisted_blade

FILM = MooneyRivlin("film", 1400.0, 0.238e6, 0.523e6, 2.2e9, 0.21)
STATIONS = np.linspace(0.0, 1.0, 41)
INFLOW = StripInflow(5.0, 0.58)


def parts(mesh: Mesh, blade: Blade, modulus: float) -> tuple[Structure, LoadTransfer]:
    metal = IsotropicSVK("metal", 2500.0, modulus, 0.36)
    structure = Structure(
        mesh.fem, {"blade": metal, "film": FILM}, spin=Spin(0.58), basis=mesh.basis
    )
    surface = SurfaceQuadrature(mesh.nodes, mesh.interface)
    return structure, LoadTransfer(surface, blade, STATIONS, blade.section(STATIONS, 121))


@pytest.fixture(scope="module")
def both(coarse_mesh: Mesh, small_film_blade: Blade) -> tuple[Structure, LoadTransfer]:
    return parts(coarse_mesh, small_film_blade, 65e9)


@pytest.fixture(scope="module")
def state(both: tuple[Structure, LoadTransfer]) -> StaticState:
    return solve_static(*both, INFLOW, method="fixed-point")


@pytest.fixture(scope="module")
def fast(both: tuple[Structure, LoadTransfer]) -> StaticState:
    return solve_static(*both, INFLOW, chained=False)


def distance(a: StaticState, b: StaticState) -> float:
    size = np.linalg.norm(b.displacement)
    return float(np.linalg.norm(a.displacement - b.displacement) / size)


def test_converges_to_the_stated_tolerance(state: StaticState) -> None:
    assert state.converged
    assert state.history[-1].change < 1e-5
    assert all(step.change >= 1e-5 for step in state.history[:-1])
    assert len(state.history) < 15  # what the paper says of its own blades
    assert state.kind == "steady"
    assert state.rate < 0.5


def test_load_update_in_the_newton_iteration_finds_the_same(
    state: StaticState, fast: StaticState
) -> None:
    assert fast.converged
    assert distance(fast, state) < 2e-5
    assert fast.error < 1e-5
    assert fast.factorizations < state.factorizations
    assert fast.structure.converged
    with pytest.raises(ValueError, match="chained=True"):
        _ = fast.chained
    # the structure is in equilibrium under its pressure, to its own tolerance
    assert fast.structure.newton[-1].residual < 1e-8


def test_ramp_and_anderson_find_the_same(
    both: tuple[Structure, LoadTransfer], fast: StaticState
) -> None:
    ramped = solve_static(*both, INFLOW, method="anderson", ramp=(0.5, 1.0), chained=False)
    assert ramped.converged
    assert distance(ramped, fast) < 2e-5
    assert {step.fraction for step in ramped.history} == {0.5, 1.0}
    assert [step.iteration for step in ramped.history] == list(range(1, len(ramped.history) + 1))


def test_extra_load_acts_beside_the_flow(
    both: tuple[Structure, LoadTransfer], fast: StaticState
) -> None:
    structure, transfer = both
    nodes, n = len(structure.basis.points), structure.forms.n_displacement
    still = np.zeros(nodes), np.zeros(n)
    same = solve_static(structure, transfer, INFLOW, chained=False, extra=still)
    assert distance(same, fast) < 1e-12
    # the flow's own pressure as an extra one, in water that carries no load
    light = StripInflow(5.0, 0.58, density=1e-9)
    extra = fast.surface.values, np.zeros(n)
    pushed = solve_static(structure, transfer, light, chained=False, extra=extra)
    assert distance(pushed, fast) < 1e-6
    with pytest.raises(ValueError, match="extra has to be"):
        solve_static(structure, transfer, INFLOW, extra=(np.zeros(3), np.zeros(n)))


def test_eigenvalues_agree_with_the_observed_rate(
    both: tuple[Structure, LoadTransfer], state: StaticState
) -> None:
    found = divergence_pressure(*both, INFLOW, state.structure, dimension=4)
    assert found.rate == pytest.approx(state.rate, rel=0.05)
    half = divergence_pressure(*both, INFLOW, state.structure, dimension=4, fraction=0.5)
    np.testing.assert_allclose(half.eigenvalues, 0.5 * found.eigenvalues, rtol=1e-6)


@pytest.mark.parametrize("ramp", [(), (0.5,), (0.5, 0.4, 1.0), (0.0, 1.0)])
def test_impossible_ramps(both: tuple[Structure, LoadTransfer], ramp: tuple[float, ...]) -> None:
    with pytest.raises(ValueError, match="ramp"):
        solve_static(*both, INFLOW, ramp=ramp)


def test_unknown_method(both: tuple[Structure, LoadTransfer]) -> None:
    with pytest.raises(ValueError, match="fixed-point"):
        solve_static(*both, INFLOW, method="picard")  # type: ignore[arg-type]


def test_first_pass_carries_the_rigid_blades_lift(state: StaticState) -> None:
    assert state.history[0].lift == pytest.approx(state.rigid.total.lift, rel=1e-12)
    assert state.chained.total.lift != pytest.approx(state.rigid.total.lift, rel=1e-3)


def test_solution_is_a_fixed_point(
    state: StaticState, both: tuple[Structure, LoadTransfer]
) -> None:
    _, transfer = both
    again = strip_loads(transfer.displaced_sections(state.displacement), StripInflow(5.0, 0.58))
    assert again.total.lift == pytest.approx(state.coupled.total.lift, rel=1e-12)
    # the load that holds the blade is the load of the shape it has
    assert state.history[-1].lift == pytest.approx(again.total.lift, rel=1e-4)


def test_lift_bends_the_blade_towards_its_upper_side(state: StaticState) -> None:
    tip = state.tip_displacement
    assert tip[1] > 0.05
    assert tip[2] < 0.0  # the arc is as long as the span was
    assert state.surface.mismatch < 1e-10


@pytest.mark.parametrize("method", ["newton", "fixed-point"])
def test_too_few_passes_are_kept_and_marked(
    both: tuple[Structure, LoadTransfer], method: Method
) -> None:
    state = solve_static(*both, INFLOW, method=method, max_iterations=1)
    assert not state.converged
    assert "not converged after" in str(state.notices[-1])
    assert "is kept" in str(state.notices[-1])
    assert state.structure.converged  # an equilibrium of the structure all the same


def test_blade_without_equilibrium_is_an_error(coarse_mesh: Mesh, small_film_blade: Blade) -> None:
    structure, transfer = parts(coarse_mesh, small_film_blade, 65e6)  # as soft as rubber
    with pytest.raises(ConvergenceError):
        solve_static(structure, transfer, StripInflow(15.0, 3.0), method="fixed-point")


def test_twisted_swept_cambered_blade_finds_its_equilibrium() -> None:
    blade = make_twisted_blade()
    mesh = build_mesh(blade, MeshSpec(0.035, (0.0, 0.0, 0.7), 1.3, PATCH, 0.6))
    structure, transfer = parts(mesh, blade, 120e9)
    state = solve_static(structure, transfer, StripInflow(5.0, 0.58))
    assert state.converged
    assert state.surface.mismatch < 1e-10
    # the rigid blade's angle is the one it was given, from nose to trailing edge
    given = blade.blade_angle(STATIONS)
    assert np.allclose(state.rigid.sections.blade_angle[1:-1], given[1:-1], atol=0.01)
    assert state.coupled.total.lift != pytest.approx(state.rigid.total.lift, rel=1e-3)
