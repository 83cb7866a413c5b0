# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is said of a run before it begins: size against meshes, cost against runs, assumptions."""

from typing import Any

import numpy as np
import pytest

from quietblade.case import Case
from quietblade.case.presets import preset_text
from quietblade.linalg.trial import trial_seconds, trial_system
from quietblade.mesh import build_mesh
from quietblade.study import costs, forecast, translate
from quietblade.study.assumptions import Assumption
from quietblade.study.forecast import Size
from quietblade.study.outlook import Outlook, look_ahead
from quietblade.study.preflight import preflight
from quietblade.vibroacoustics.operators import free_unknowns


def case_of(preset: str = "paper-aluminium", **changes: Any) -> Case:
    changes = {key.replace("__", "."): value for key, value in changes.items()}
    film = changes.pop("film", True)
    plain = Case.parse(preset_text(preset)).plain()
    if not film:
        plain["film"] = None
        plain["materials"] = {
            name: value
            for name, value in plain["materials"].items()
            if name == plain["blade"]["material"]
        }
    elif preset.startswith("paper"):  # the film of the meshes that are held against
        plain["film"] |= {"span": [0.05, 0.95], "chord": [0.15, 0.8], "thickness": 1.5e-3}
    return Case.from_plain(plain).varied(changes)


def size_of(case: Case) -> Size:
    blade = translate.build_blade(case)
    centre, radius = translate.sphere(case)
    return forecast.forecast(blade, case.mesh.size, centre, radius, translate.water_size(case))


def ahead_of(case: Case) -> Outlook:
    return look_ahead(case, preflight(case), trial=costs._TRIAL)


@pytest.mark.parametrize(("film", "size"), [(False, 0.06), (True, 0.04)])
def test_size_of_a_real_mesh(film: bool, size: float) -> None:
    case = case_of(film=film, mesh__size=size)
    mesh = build_mesh(translate.build_blade(case), translate.mesh_spec(case))
    _, blocks = free_unknowns(mesh.fem)
    found = size_of(case)
    statics = len(blocks.u) + len(blocks.p)
    assert found.nodes == pytest.approx(len(mesh.nodes), rel=forecast.UNCERTAINTY)
    assert found.statics == pytest.approx(statics, rel=forecast.UNCERTAINTY)
    assert found.vibration == pytest.approx(statics + len(blocks.psi), rel=forecast.UNCERTAINTY)


@pytest.mark.parametrize(
    ("changes", "nodes", "unknowns"),
    [
        ({"mesh__size": 0.022}, 24_387, 54_692),
        ({"mesh__size": 0.011}, 74_058, 184_062),
        ({"mesh__size": 0.04}, 10_260, 20_773),
        ({"mesh__size": 0.022, "film": False, "acoustics__sphere_radius": 1.6,
          "mesh__water_size": 0.1}, 124_825, None),
        ({"preset": "twisted", "mesh__size": 0.04}, 10_593, None),
        ({"preset": "twisted", "mesh__size": 0.025}, 20_671, None),
    ],
)  # fmt: skip
def test_size_of_meshes_that_were_made(
    changes: dict[str, Any], nodes: int, unknowns: int | None
) -> None:
    found = size_of(case_of(**changes))
    assert found.nodes == pytest.approx(nodes, rel=forecast.UNCERTAINTY)
    if unknowns is not None:
        assert found.vibration == pytest.approx(unknowns, rel=forecast.UNCERTAINTY)


RUNS = [
    # unknowns of step 1 and 2, nodes; statics, motion, modes C0, sweep C0 in seconds; gigabytes.
    # Two threads, on the machine of the constants, aluminium and composite.
    ((38_406, 54_692, 24_387), (11.9, 1.2, 15.7, 0.9), 2.66),
    ((38_406, 54_692, 24_387), (24.4, 1.2, 15.8, 1.4), 2.66),
    ((139_445, 184_062, 74_058), (77.0, 3.2, 64.0, 3.6), 8.44),
]


@pytest.mark.parametrize(("size", "seconds", "memory"), RUNS)
def test_cost_of_runs_that_were_made(
    size: tuple[int, int, int],
    seconds: tuple[float, ...],
    memory: float,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(costs, "default_threads", lambda: 2)
    statics, vibration, nodes = size
    case = case_of()
    cost = costs.estimate(
        case, translate.build_blade(case), Size(nodes, statics, vibration), costs._TRIAL
    )
    for stage, taken in zip(
        ("flow and structure", "mesh motion", "modes C0", "sweep C0"), seconds, strict=True
    ):
        ratio = cost.seconds[stage] / taken
        assert 1.0 / costs.TIME_FACTOR < ratio < costs.TIME_FACTOR, (stage, ratio)
    assert 1.0 / costs.MEMORY_FACTOR < cost.memory / 1e9 / memory < costs.MEMORY_FACTOR


def test_cost_follows_what_the_case_asks_for(monkeypatch: pytest.MonkeyPatch) -> None:
    def seconds(**changes: Any) -> dict[str, float]:
        return ahead_of(case_of(**changes)).cost.seconds

    usual = seconds()
    direct = seconds(acoustics__sweep="direct")
    assert direct["sweep C0"] > 20.0 * usual["sweep C0"]
    assert set(seconds(acoustics__configurations=["C0"])) == {
        "mesh", "flow and structure", "modes C0", "sweep C0", "mode tables", "files",
    }  # fmt: skip
    assert seconds(acoustics__dry_modes=True)["mode tables"] > usual["mode tables"]
    diagram = seconds(campbell={"speeds": [0.3, 0.6, 0.9]})["Campbell diagram"]
    assert diagram > 3.0 * usual["flow and structure"]
    monkeypatch.setattr(costs, "default_threads", lambda: 1)
    alone = seconds()["modes C0"]
    monkeypatch.setattr(costs, "default_threads", lambda: 4)
    assert seconds()["modes C0"] < 0.5 * alone


def test_the_stages_of_the_estimate_are_those_of_a_run() -> None:
    from quietblade.study.stages import origins  # noqa: PLC0415

    case = case_of(campbell={"speeds": [0.3, 0.6]})
    assert [*ahead_of(case).cost.seconds] == [*origins(case), "files"]


def test_the_trial_is_solved_and_timed() -> None:
    system = trial_system(6)
    assert system.shape == (216, 216)
    assert abs(system - system.T).max() == 0.0
    assert 0.0 < trial_seconds(1) < 30.0


def test_memory_that_is_not_there_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("quietblade.study.outlook.available_memory", lambda: 10**9)
    (notice,) = [n for n in ahead_of(case_of()).notices if n.where == "memory"]
    assert notice.value is not None
    assert notice.value > 1e9 == notice.limit
    assert "mesh.size" in notice.remedy


def judged(case: Case) -> dict[str, Assumption]:
    return {a.name: a for a in ahead_of(case).assumptions}


def test_every_assumption_is_told_with_its_value() -> None:
    case = case_of("twisted")
    found = judged(case)
    tip = np.hypot(case.flow.speed, case.flow.rotation * (case.blade.hub_radius + case.blade.span))
    mach = found["the flow is incompressible"]
    assert mach.value == pytest.approx(tip / case.water.sound_speed, rel=1e-3)
    assert mach.said.startswith("tip speed 8.5")
    fast = found["the vibration is much faster than the rotation"]
    ratio = 2.0 * np.pi * case.acoustics.band[0] / case.flow.rotation
    assert fast.value == pytest.approx(ratio)
    assert found["the sphere is clear of the blade"].value == preflight(case).clearance
    for name in ("the flow is attached", "the water does not cavitate"):
        assert found[name].holds
        assert "margin" in found[name].said
    assert all(a.holds for a in found.values() if "inflow" not in a.name)


@pytest.mark.parametrize(
    ("changes", "name"),
    [
        ({"flow__speed": 500.0}, "the flow is incompressible"),
        ({"flow__rotation": 60.0}, "the vibration is much faster than the rotation"),
        ({"blade__blade_angle": 0.4}, "the flow is attached"),
        ({"flow__speed": 40.0}, "the water does not cavitate"),
        ({"flow__inflow": "none"}, 'the inflow model "none" fits the blade'),
    ],
)
def test_a_doubtful_assumption_is_a_notice_with_value_limit_and_remedy(
    changes: dict[str, Any], name: str
) -> None:
    ahead = ahead_of(case_of("twisted", **changes))
    doubtful = {a.name: a for a in ahead.assumptions if not a.holds}
    assert name in doubtful
    texts = [str(notice) for notice in ahead.notices]
    for a in doubtful.values():
        assert any(f"{a.value:.4g} against {a.limit:.4g}" in text for text in texts)
        assert any(a.remedy in text for text in texts)


def test_a_blade_at_rest_turns_slowly_enough() -> None:
    found = judged(case_of("twisted", flow__rotation=0.0))
    assert found["the vibration is much faster than the rotation"].holds


@pytest.mark.parametrize(
    ("changes", "remedy"),
    [
        ({"flow__rotation": 12.0}, "Lower the incidence"),
        ({"blade__blade_angle": 1.2}, "less 90 deg"),
    ],
)
def test_the_pitch_angle_of_a_drawing_is_told_apart_from_too_much_load(
    changes: dict[str, Any], remedy: str
) -> None:
    attached = judged(case_of("twisted", **changes))["the flow is attached"]
    assert not attached.holds
    assert remedy in attached.remedy
