# SPDX-License-Identifier: LGPL-2.1-or-later
"""Several loads of a case against what is put together by hand; roots and shafts."""

from collections.abc import Mapping
from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from quietblade.case import Case
from quietblade.case.presets import preset_text
from quietblade.linalg import make_solver
from quietblade.mesh import Mesh, build_mesh
from quietblade.propulsion.structure import Structure
from quietblade.study import solids, translate
from quietblade.study.blade_vibration import solve_vibration
from quietblade.study.excitation_outcome import excitation_table, transfer_table
from quietblade.study.loads import on_face
from quietblade.study.sound import Sound, solve_sound
from quietblade.study.statics import Statics
from quietblade.study.transfer import impedance
from quietblade.study.vibration import Vibration
from quietblade.typing import silent
from quietblade.vibroacoustics.excitation import pressure_force
from quietblade.vibroacoustics.loads import Excitation, Spectrum
from quietblade.vibroacoustics.point_loads import point_force, surface_of
from quietblade.vibroacoustics.power import dissipated_by_region, power_budget
from quietblade.vibroacoustics.root import elastic_shaft
from quietblade.vibroacoustics.sweep import solve_point
from tests.study.test_run import COARSE

FREQUENCY = np.array([104.0, 119.0])
OMEGA = 2.0 * np.pi * FREQUENCY
PATCHES: list[dict[str, Any]] = [
    {"span": [0.9, 0.96], "chord": [0.3, 0.7], "pressure": "10 kPa"},
    {"span": [0.5, 0.6], "chord": [0.3, 0.7], "pressure": "5 kPa", "phase": "90 deg"},
]
PUSH = {"kind": "point-force", "at": [0.95, 0.25], "direction": [0, -2, 0], "force": "20 N"}
SHAKE = {"kind": "root-motion", "motion": "velocity", "axis": "y", "amplitude": "1 mm/s"}
SHAFT = {
    "translation": ["10 MN/m"] * 3, "rotation": ["1 MN*m/rad"] * 3,
    "translation_damping": ["5 kN*s/m"] * 3, "rotation_damping": ["50 N*m*s/rad"] * 3,
    "mass": ["5 kg"] * 3,
}  # fmt: skip
FUNCTIONS = ["mobility", "power-per-force", "blocked-force", "shaft"]
CHANGES = {
    **COARSE,
    "mesh.size": "60 mm",
    "acoustics.sphere_radius": "0.75 m",
    "acoustics.band": ["100 Hz", "120 Hz"],
    "acoustics.step": "20 Hz",
    "acoustics.configurations": ["C0"],
    "far_field.frequencies": [],
}


def vibrating(case: Case, mesh: Mesh) -> Vibration:
    blade = translate.build_blade(case)
    materials = solids.build_materials(case, blade, mesh.basis)
    # at rest nothing else of the equilibrium is looked at
    rest = cast(
        Statics, SimpleNamespace(structure=Structure(mesh.fem, materials, basis=mesh.basis))
    )
    return solve_vibration(case, blade, mesh, rest, None, silent)


@pytest.fixture(scope="module")
def case() -> Case:
    text = preset_text("paper-aluminium")
    return Case.parse(text).varied({**CHANGES, "excitation": [*PATCHES, PUSH]})


@pytest.fixture(scope="module")
def mesh(case: Case) -> Mesh:
    return build_mesh(translate.build_blade(case), translate.mesh_spec(case))


@pytest.fixture(scope="module")
def vibration(case: Case, mesh: Mesh) -> Vibration:
    return vibrating(case, mesh)


@pytest.fixture(scope="module")
def sound(case: Case, vibration: Vibration) -> Sound:
    return solve_sound(case, vibration, FREQUENCY, silent)


def test_each_patch_is_a_boundary(case: Case, mesh: Mesh) -> None:
    blade = translate.build_blade(case)
    for name, words in (("excited", PATCHES[0]), ("excited2", PATCHES[1])):
        s, xi, eta = blade.locate(mesh.nodes[np.unique(mesh.faces[name])])
        for place, extent in ((s, words["span"]), (xi, words["chord"])):
            np.testing.assert_allclose([place.min(), place.max()], extent, atol=1e-3)
        assert np.all(eta > 0.0)
    assert len(mesh.interface) == sum(
        len(mesh.faces[name]) for name in ("wet", "excited", "excited2")
    )


def test_loads_together_are_the_sum_by_hand(
    case: Case, mesh: Mesh, vibration: Vibration, sound: Sound
) -> None:
    """Reduced sweep of the case against a direct solve of the load that is added up here."""
    operators, blade = vibration.operators, translate.build_blade(case)
    place = on_face(blade, "upper", np.array([[0.95, 0.25]]))
    surface = surface_of(mesh.basis, "wet|excited|excited2")
    force = (
        10e3 * pressure_force(mesh.fem, 1.0, surface="excited")
        + 5e3j * pressure_force(mesh.fem, 1.0, surface="excited2")
        + 20.0 * point_force(mesh.basis, surface, place, np.array([0.0, -1.0, 0.0]))
    )
    load = operators.right_hand_side(force.real) + 1j * operators.right_hand_side(force.imag)
    points = [solve_point(operators, f, load, make_solver()) for f in FREQUENCY]
    exact = power_budget(operators, OMEGA, np.array([p.solution for p in points]), load)
    for name in ("injected", "radiated", "surface", "dissipated"):
        np.testing.assert_allclose(
            getattr(sound.budget, name), getattr(exact, name), rtol=1e-3, err_msg=name
        )
    assert sound.budget.residual.max() < 1e-6
    table = excitation_table(vibration.excited, sound)
    np.testing.assert_allclose(table.injected.sum(axis=0), sound.budget.injected, rtol=1e-9)
    assert table.name == ("pressure", "pressure 2", "point-force")


def test_direct_sweep_of_several_loads(case: Case, vibration: Vibration, sound: Sound) -> None:
    direct = solve_sound(case, replace(vibration, sweep=None), FREQUENCY, silent)
    np.testing.assert_allclose(sound.budget.radiated, direct.budget.radiated, rtol=2e-3)
    np.testing.assert_allclose(sound.loads.radiated, direct.loads.radiated, rtol=2e-3)
    np.testing.assert_allclose(sound.waves[0].power, direct.waves[0].power, rtol=2e-3)
    assert direct.budget.residual.max() < 1e-6


def test_reciprocity_between_the_loads(vibration: Vibration) -> None:
    assert vibration.sweep is not None
    together = vibration.excited.combined(vibration.sweep.model, OMEGA)
    across = np.einsum("fin,jn->fij", together.each, together.loads)
    np.testing.assert_allclose(across, across.transpose(0, 2, 1), rtol=1e-8)
    assert np.all(-OMEGA[:, None] * together.work.imag > 0.0)  # Re of the mobility


def test_peaks_and_estimate_are_those_of_all_loads(case: Case, vibration: Vibration) -> None:
    sound = solve_sound(case, vibration, np.linspace(100.0, 120.0, 401), silent)
    assert vibration.sweep is not None
    assert vibration.sweep.certificate.estimate.max() <= case.acoustics.accuracy
    for top, power in zip(sound.peaks.frequency, sound.peaks.power, strict=True):
        near = np.abs(sound.frequency - top) < 0.5
        assert power >= sound.budget.radiated[near].max()


def random_sound(case: Case, vibration: Vibration, correlation: str) -> Sound:
    densities = [4.0, Spectrum(np.array([90.0, 130.0]), np.array([9.0, 1.0])), 1e-6]
    drives = tuple(
        replace(drive, load=Excitation(drive.load.name, drive.load.vector, density))
        for drive, density in zip(vibration.excited.drives, densities, strict=True)
    )
    excited = replace(vibration.excited, drives=drives, correlation=correlation)
    return solve_sound(case, replace(vibration, excited=excited), FREQUENCY, silent)


@pytest.mark.parametrize("correlation", ["none", "full"])
def test_random_loads_against_harmonic_ones(
    case: Case, vibration: Vibration, correlation: str
) -> None:
    random = random_sound(case, vibration, correlation)
    table = np.interp(FREQUENCY, [90.0, 130.0], [9.0, 1.0])
    peaks = np.sqrt(2.0 * np.column_stack([[4.0, 4.0], table, [1e-6, 1e-6]]))
    assert vibration.sweep is not None
    model = vibration.sweep.model
    if correlation == "none":
        expected = np.sum(peaks**2 * model.radiated(OMEGA), axis=1)
    else:
        expected = np.array(
            [
                model.combined(a).radiated(np.array([w]))[0]
                for a, w in zip(peaks, OMEGA, strict=True)
            ]
        )
    np.testing.assert_allclose(random.budget.radiated, expected, rtol=1e-9)
    np.testing.assert_allclose(random.loads.injected.sum(axis=1), random.budget.injected, rtol=1e-9)
    outgoing = np.sum([part.power for part in random.waves], axis=0)
    np.testing.assert_allclose(outgoing, random.budget.radiated, rtol=0.02)
    assert len(random.solutions) == (0 if correlation == "none" else len(random.snapshots))


@pytest.fixture(scope="module")
def rooted_case(case: Case) -> Case:
    words: Mapping[str, Any] = {"functions": FUNCTIONS, "shaft": SHAFT}
    return case.varied({"excitation": [PATCHES[0], SHAKE, PATCHES[1]], "transfer": words})


@pytest.fixture(scope="module")
def rooted(rooted_case: Case, mesh: Mesh) -> Vibration:
    return vibrating(rooted_case, mesh)


def test_moved_root_balances_and_is_heard_outside(rooted_case: Case, rooted: Vibration) -> None:
    sound = solve_sound(rooted_case, rooted, FREQUENCY, silent)
    assert sound.budget.residual.max() < 1e-6
    np.testing.assert_allclose(sound.waves[0].power, sound.budget.radiated, rtol=0.02)
    np.testing.assert_allclose(sound.budget.surface, sound.budget.radiated, rtol=1e-4)
    # the root's own velocity, over the force that it takes
    assert rooted.excited.root is not None
    assert rooted.sweep is not None
    moved = rooted.sweep.model.solution(OMEGA)[:, 1]
    velocity = 1j * OMEGA * rooted.excited.root.motion(moved)[:, 1]
    force = rooted.excited.root.reaction(moved)[:, 1]
    assert sound.transfer is not None
    np.testing.assert_allclose(sound.transfer.mobility[:, 1], velocity / force, rtol=1e-6)
    amplitude = rooted.excited.parts(FREQUENCY)[0, :, 1]
    np.testing.assert_allclose(np.abs(amplitude * velocity), 1e-3, rtol=1e-9)


def test_blocked_force_and_shaft(rooted_case: Case, rooted: Vibration, mesh: Mesh) -> None:
    """The path by blocked force and root stiffness against the shaft put into the system."""
    only = rooted.excited.drives[::2]
    probes = rooted.excited.probes
    pushed = rooted_case.varied({"excitation": PATCHES})
    excited = replace(rooted.excited, drives=only)
    direct = replace(rooted, excited=excited, sweep=None)
    sound = solve_sound(pushed, direct, FREQUENCY, silent)
    assert sound.transfer is not None
    assert len(probes) == 6
    root = excited.root
    assert root is not None
    shaft = elastic_shaft(
        root, np.repeat([10e6, 1e6], 3), np.repeat([5e3, 50.0], 3), np.repeat([5.0, 0.0], 3)
    )
    force = 10e3 * pressure_force(mesh.fem, 1.0, surface="excited")
    force = force + 5e3j * pressure_force(mesh.fem, 1.0, surface="excited2")
    load = shaft.right_hand_side(force.real) + 1j * shaft.right_hand_side(force.imag)
    points = [solve_point(shaft.operators, f, load, make_solver()) for f in FREQUENCY]
    x = np.array([p.solution for p in points])
    taken = dissipated_by_region(shaft.operators, OMEGA, x)["shaft"]
    np.testing.assert_allclose(sound.transfer.shaft_power, taken, rtol=1e-5)
    table = transfer_table(sound.transfer)
    assert table.blocked_force.shape == (2, 3, 2)
    together = 10e3 * table.blocked_force[0] + 5e3j * table.blocked_force[1]
    np.testing.assert_allclose(table.root_force, np.abs(together), rtol=1e-9)
    diagonal = np.diagonal(impedance(pushed.transfer.shaft, OMEGA), axis1=1, axis2=2)  # type: ignore[union-attr, arg-type]
    np.testing.assert_allclose(diagonal[:, 5], 50.0 - 1e6j / OMEGA)


def test_a_root_that_is_not_asked_for_is_not_there(vibration: Vibration, sound: Sound) -> None:
    assert vibration.excited.root is None
    assert sound.transfer is None
    assert transfer_table(None).functions == ()
