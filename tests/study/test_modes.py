# SPDX-License-Identifier: LGPL-2.1-or-later
"""Damping by the stream, dry modes and the Campbell diagram of one coarse case."""

import numpy as np
import pytest
from scipy.sparse import csr_matrix

from quietblade.case import Case
from quietblade.case.presets import preset_text
from quietblade.case.problems import InvalidCaseError
from quietblade.flow.inflow import strip_loads
from quietblade.mesh import Mesh, build_mesh
from quietblade.results.model import Result
from quietblade.results.store import RunFolder
from quietblade.study import translate
from quietblade.study.campbell import solve_campbell
from quietblade.study.frames import SectionFrames
from quietblade.study.outcome import static_result
from quietblade.study.preflight import preflight
from quietblade.study.run import run_case
from quietblade.study.statics import solve_statics
from quietblade.study.stream import with_stream
from quietblade.typing import silent
from quietblade.vibroacoustics.operators import build_operators
from quietblade.vibroacoustics.power import dissipated_by_region

SPEEDS = np.array([0.4, 0.58])


@pytest.fixture(scope="module")
def case() -> Case:
    return Case.parse(preset_text("paper-aluminium")).varied(
        {
            "film.span": [0.2, 0.8],
            "film.chord": [0.3, 0.6],
            "film.thickness": "1 mm",
            "mesh.size": "55 mm",
            "acoustics.sphere_radius": "0.8 m",
            "acoustics.band": ["40 Hz", "110 Hz"],
            "acoustics.step": "35 Hz",
            "acoustics.points_per_mode": 1,
            "acoustics.configurations": ["C1"],
            "acoustics.flow_damping": True,
            "acoustics.dry_modes": True,
            "campbell.speeds": [f"{speed} rad/s" for speed in SPEEDS],
            "campbell.orders": [300, 600],
            "campbell.advance": "fixed",
            "flow.sections": 21,
            "flow.section_nodes": 81,
        }
    )


@pytest.fixture(scope="module")
def mesh(case: Case) -> Mesh:
    return build_mesh(preflight(case).blade, translate.mesh_spec(case))


@pytest.fixture(scope="module")
def result(case: Case, tmp_path_factory: pytest.TempPathFactory) -> Result:
    return run_case(case, RunFolder(tmp_path_factory.mktemp("modes") / "blade"))


def test_strips_of_a_blade_take_what_its_sections_say(case: Case, mesh: Mesh) -> None:
    """Every node moved by one along the normal of its section: int pi rho W b dz / 2."""
    blade = preflight(case).blade
    stations = np.linspace(0.0, 1.0, case.flow.sections)
    flow = strip_loads(blade.section(stations, case.flow.section_nodes), translate.inflow(case))
    size = 3 * mesh.basis.ndof
    nothing = csr_matrix((size, size))
    operators = build_operators(
        mesh.fem, stiffness=nothing, mass=nothing, water=translate.water(case),
        radius=mesh.radius,
    )  # fmt: skip
    frames = SectionFrames.of(blade, mesh, None)
    damped, notices = with_stream(case, mesh, operators, flow, mesh.nodes, frames)
    (slow,) = notices  # at the tip, at the lower end of the band
    # half the chord across the mid-chord line, which the alignment of the chords sweeps
    swept = np.arctan((case.blade.alignment - 0.5) * (0.25 - 0.075) / case.blade.span)
    half = 0.0375 * np.cos(swept)
    assert slow.value == pytest.approx(2.0 * np.pi * 40.0 * half / flow.loads.speed[-1])
    heave = np.zeros((1, len(frames.nodes), 3))
    heave[..., 1] = 1.0
    moved = np.zeros_like(mesh.nodes)
    moved[frames.nodes] = frames.placed(heave)[0]
    x = np.zeros(damped.size, dtype=complex)
    u, strips = damped.blocks.u, damped.blocks.strips
    x[u] = mesh.basis.to_dofs(moved)[damped.free[u]]
    x[strips] = damped.terms["D stream"][strips][:, u] @ x[u]
    omega = 100.0
    found = float(dissipated_by_region(damped, np.array(omega), x)["stream"])
    sections, speed = flow.sections, flow.loads.speed
    per_length = 0.5 * np.pi * case.water.density * speed * sections.chord
    expected = 0.5 * omega**2 * np.trapezoid(per_length, sections.arc_length)
    # the clamped nodes at the root, where the chord is largest, do not move
    assert found == pytest.approx(expected, rel=0.06)


def test_stream_is_the_largest_loss_and_in_the_balance(result: Result) -> None:
    configuration = result.configurations["C1"]
    losses = configuration.loss_shares
    assert losses.name == ("film", "stream", "radiation")
    film, stream, _ = losses.share.T
    bending = [k for k, kind in enumerate(configuration.mode_count.character) if kind == "bending"]
    assert len(bending) > 1
    assert np.all(stream[bending] > 10.0 * film[bending])
    np.testing.assert_allclose(
        np.nansum(losses.share, axis=1), configuration.modes.loss_factor, rtol=1e-12
    )
    spectrum = configuration.spectrum
    assert np.all(spectrum.balance_residual < 1e-6)
    assert np.all(spectrum.dissipated > 0.9 * spectrum.injected)


def test_dry_modes_are_faster_and_know_their_wet_partners(result: Result) -> None:
    configuration = result.configurations["C1"]
    wet, dry = configuration.modes, configuration.dry_modes
    assert np.all(np.diff(dry.frequency) >= 0.0)
    pairs = [(k, wet.name.index(name)) for k, name in enumerate(dry.partner) if name]
    assert len({row for _, row in pairs}) == len(pairs)
    assert len(pairs) >= len(wet.frequency) - 1
    for k, row in pairs:
        assert dry.frequency[k] > wet.frequency[row]
        assert dry.partner_mac[k] > 0.3
    first = dict(pairs)
    assert dry.frequency[0] > 2.0 * wet.frequency[first[0]]  # the water weighs more than the blade


def test_campbell_diagram_passes_through_the_modes_of_the_run(result: Result) -> None:
    diagram, modes = result.campbell, result.configurations["C1"].modes
    np.testing.assert_allclose(diagram.rotation, SPEEDS)
    np.testing.assert_allclose(diagram.advance_speed, 5.0)
    branches = dict(zip(diagram.name, diagram.frequency[:, 1], strict=True))
    for name, frequency in zip(modes.name, modes.frequency, strict=True):
        assert branches[name] == pytest.approx(frequency, rel=1e-4)
    np.testing.assert_allclose(
        diagram.tip_displacement[1], result.static.tip_displacement, rtol=1e-3, atol=1e-6
    )
    assert diagram.tip_displacement[0, 1] < diagram.tip_displacement[1, 1]
    rate = np.outer([300, 600], SPEEDS) / (2.0 * np.pi)
    np.testing.assert_allclose(diagram.blade_rate, rate)
    met = set(zip(diagram.crossing_mode, diagram.crossing_order.tolist(), strict=True))
    for name, row in zip(diagram.name, diagram.frequency, strict=True):
        for order, ray in zip((300, 600), rate, strict=True):
            gap = row - ray
            assert ((name, order) in met) == bool(gap[0] * gap[1] < 0.0)


def test_run_without_a_chained_computation_has_nan_in_its_rows(case: Case, mesh: Mesh) -> None:
    hasty = case.varied({"static.method": "fixed-point", "static.max_iterations": 1})
    statics = solve_statics(hasty, preflight(case).blade, mesh, silent)
    assert statics.state.chained_flow is None
    assert any("no chained computation" in str(n) for n in statics.notices(hasty))
    static = static_result(hasty, statics)
    rigid, chained, coupled = static.lift
    assert np.isnan(chained)
    assert np.isfinite([rigid, coupled]).all()
    for curves in (static.sections.lift_coefficient, static.performance.thrust):
        assert np.isnan(curves[1]).all()
        assert np.isfinite(curves[[0, 2]]).all()


def test_speeds_without_an_equilibrium_are_left_out_with_a_notice(case: Case, mesh: Mesh) -> None:
    hasty = case.varied({"static.method": "fixed-point", "static.max_iterations": 1})
    assert hasty.campbell is not None
    diagram, notices = solve_campbell(hasty, hasty.campbell, preflight(case).blade, mesh, silent)
    assert diagram.name == ()
    assert len(diagram.rotation) == 0
    for speed, notice in zip(SPEEDS, notices, strict=True):
        assert f"{speed:.4g} rad/s" in notice.where
        assert "left out" in notice.message
        assert "not converged" in notice.message


def test_words_of_the_diagram_are_checked(case: Case) -> None:
    for changes, words in (
        ({"campbell.speeds": ["2 rad/s", "1 rad/s"]}, "do not increase"),
        ({"campbell.speeds": ["1 rad/s"]}, "2 or more"),
        ({"campbell.orders": [1, 1]}, "twice"),
        ({"campbell.advance": "free"}, "speed of advance"),
        ({"acoustics.dry_modes": "yes"}, "neither true nor false"),
    ):
        with pytest.raises(InvalidCaseError, match=words):
            case.varied(changes)
    for changes, words in (
        ({"flow.rotation": "0 rad/s", "campbell.advance": "scaled"}, "stands still"),
        ({"campbell.speeds": ["0 rad/s", "1 rad/s"], "campbell.advance": "scaled"}, "at rest"),
    ):
        with pytest.raises(InvalidCaseError, match=words):
            preflight(case.varied(changes))
    preflight(case.varied({"campbell.speeds": ["0 rad/s", "1 rad/s"]}))
