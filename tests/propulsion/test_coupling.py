# SPDX-License-Identifier: LGPL-2.1-or-later
"""Flow and structure on a stiffened paper blade, so that a coarse mesh serves."""

import numpy as np
import pytest

from quietblade.errors import ConvergenceError, GeometryError
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
from verification.flow_coupling_wing import plastic_wing

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
def both() -> tuple[Structure, LoadTransfer]:
    return plastic_wing(0.0, poisson_ratio=0.3, incidence=0.07)


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
    assert tip[1] > 0.02
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
    if method == "fixed-point":  # the flow about the first shape was not asked for any more
        assert state.chained_flow is None
        assert "no chained computation" in " ".join(map(str, state.notices))


def test_blade_without_equilibrium_is_an_error() -> None:
    structure, transfer = plastic_wing(0.0, modulus=1e5)  # softer than rubber
    with pytest.raises((ConvergenceError, GeometryError)):
        solve_static(structure, transfer, StripInflow(15.0, 3.0), method="fixed-point")


def test_wash_out_is_no_divergence() -> None:
    """Swept back, bending takes lift away: an equilibrium that a plain fixed point misses."""
    wing = plastic_wing(0.4)
    stream = StripInflow(6.0, 0.0)
    state = solve_static(*wing, stream, chained=False)
    assert state.converged
    assert state.kind == "wash-out"
    assert state.eigenvalue.real < -3.0
    assert state.divergence == np.inf
    assert 0.0 < state.tip_displacement[1] < 0.05
    assert state.factorizations < 12
    assert "no static divergence" in str(state.notices[-1])
    mixed = solve_static(*wing, stream, method="anderson", chained=False)
    assert mixed.converged
    assert distance(mixed, state) < 1e-4  # each is right to 1e-5 times what a pass amplifies
    plain = solve_static(
        *wing, stream, method="fixed-point", max_iterations=2, newton_tolerance=1e-3
    )
    assert not plain.converged
    assert plain.kind == "wash-out"
    assert "equilibrium exists" in str(plain.notices[-1])


def test_equilibrium_beyond_divergence_is_said_to_be_unstable() -> None:
    """Swept forward, bending adds lift; the equilibrium that is left is upside down."""
    wing = plastic_wing(-0.4)
    state = solve_static(*wing, StripInflow(6.0, 0.0), chained=False)
    assert state.kind == "divergence"
    assert state.divergence < 0.3
    assert state.tip_displacement[1] < 0.0
    assert "unstable" in str(state.notices[-1])
    at_rest = divergence_pressure(*wing, StripInflow(6.0, 0.0))
    assert at_rest.pressure_ratio == pytest.approx(state.divergence, rel=0.1)
    slow = solve_static(*wing, StripInflow(6.0 * (0.5 * at_rest.pressure_ratio) ** 0.5, 0.0))
    assert slow.kind == "steady"
    assert slow.eigenvalue.real == pytest.approx(0.5, abs=0.02)
    assert slow.divergence == pytest.approx(2.0, rel=0.05)
    assert slow.chained.total.lift > slow.rigid.total.lift


def test_twisted_swept_cambered_blade_finds_its_equilibrium() -> None:
    blade = make_twisted_blade()
    mesh = build_mesh(blade, MeshSpec(0.035, (0.0, 0.0, 0.7), 1.3, (PATCH,), 0.6))
    structure, transfer = parts(mesh, blade, 120e9)
    state = solve_static(structure, transfer, StripInflow(5.0, 0.58))
    assert state.converged
    assert state.surface.mismatch < 1e-10
    # the rigid blade's angle is the one it was given, from nose to trailing edge
    given = blade.blade_angle(STATIONS)
    assert np.allclose(state.rigid.sections.blade_angle[1:-1], given[1:-1], atol=0.01)
    assert state.coupled.total.lift != pytest.approx(state.rigid.total.lift, rel=1e-3)
