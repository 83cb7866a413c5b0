# SPDX-License-Identifier: LGPL-2.1-or-later
"""The fixed point on a stiffened paper blade, so that a coarse mesh serves."""

import numpy as np
import pytest

from quietblade.errors import ConvergenceError
from quietblade.flow.inflow import StripInflow, strip_loads
from quietblade.geometry import Blade
from quietblade.materials import IsotropicSVK, MooneyRivlin
from quietblade.mesh import Mesh, MeshSpec, build_mesh
from quietblade.mesh.surface import SurfaceQuadrature
from quietblade.propulsion.coupling import StaticState, solve_static
from quietblade.propulsion.loading import Spin
from quietblade.propulsion.structure import Structure
from quietblade.propulsion.transfer import LoadTransfer
from tests.conftest import PATCH, make_twisted_blade

FILM = MooneyRivlin("film", 1400.0, 0.238e6, 0.523e6, 2.2e9, 0.21)
STATIONS = np.linspace(0.0, 1.0, 41)


def parts(mesh: Mesh, blade: Blade, modulus: float) -> tuple[Structure, LoadTransfer]:
    metal = IsotropicSVK("metal", 2500.0, modulus, 0.36)
    structure = Structure(
        mesh.fem, {"blade": metal, "film": FILM}, spin=Spin(0.58), basis=mesh.basis
    )
    surface = SurfaceQuadrature(mesh.nodes, mesh.interface)
    return structure, LoadTransfer(surface, blade, STATIONS, blade.section(STATIONS, 121))


@pytest.fixture(scope="module")
def state(coarse_mesh: Mesh, small_film_blade: Blade) -> StaticState:
    structure, transfer = parts(coarse_mesh, small_film_blade, 65e9)
    return solve_static(structure, transfer, StripInflow(5.0, 0.58))


def test_converges_to_the_stated_tolerance(state: StaticState) -> None:
    assert state.converged
    assert state.history[-1].change < 1e-5
    assert all(step.change >= 1e-5 for step in state.history[:-1])
    assert len(state.history) < 15  # what the paper says of its own blades


def test_first_pass_carries_the_rigid_blades_lift(state: StaticState) -> None:
    assert state.history[0].lift == pytest.approx(state.rigid.total.lift, rel=1e-12)
    assert state.chained.total.lift != pytest.approx(state.rigid.total.lift, rel=1e-3)


def test_solution_is_a_fixed_point(
    state: StaticState, coarse_mesh: Mesh, small_film_blade: Blade
) -> None:
    _, transfer = parts(coarse_mesh, small_film_blade, 65e9)
    again = strip_loads(transfer.displaced_sections(state.displacement), StripInflow(5.0, 0.58))
    assert again.total.lift == pytest.approx(state.coupled.total.lift, rel=1e-12)
    # the load that holds the blade is the load of the shape it has
    assert state.history[-1].lift == pytest.approx(again.total.lift, rel=1e-4)


def test_lift_bends_the_blade_towards_its_upper_side(state: StaticState) -> None:
    tip = state.tip_displacement
    assert tip[1] > 0.05
    assert tip[2] < 0.0  # the arc is as long as the span was
    assert state.surface.mismatch < 1e-10


def test_too_few_passes_are_kept_and_marked(coarse_mesh: Mesh, small_film_blade: Blade) -> None:
    structure, transfer = parts(coarse_mesh, small_film_blade, 65e9)
    state = solve_static(structure, transfer, StripInflow(5.0, 0.58), max_iterations=1)
    assert not state.converged
    assert "not converged after 1 passes" in str(state.notices[0])


def test_blade_without_equilibrium_is_an_error(coarse_mesh: Mesh, small_film_blade: Blade) -> None:
    structure, transfer = parts(coarse_mesh, small_film_blade, 65e6)  # as soft as rubber
    with pytest.raises(ConvergenceError):
        solve_static(structure, transfer, StripInflow(15.0, 3.0))


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
