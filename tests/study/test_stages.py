# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which stages depend on which key of a case, and what a changed case computes again."""

import copy
from collections.abc import Iterator
from typing import Any

import pytest

from quietblade.case import BodyCase, Case
from quietblade.case.presets import preset_text
from quietblade.study import stages as table
from quietblade.study.stages import ALWAYS, Origin, body_stages, inputs, origins, stages

BOTH = ("C0", "C1")
SWEEPS = {"sweep C0", "sweep C1", "mode tables"}
STEP_1 = {"flow and structure", "mesh motion", "modes C1", *SWEEPS}
STEP_2 = {"modes C0", "modes C1", *SWEEPS}
ALL = {"mesh", *STEP_1, *STEP_2}


def everything() -> Case:
    """A case in which optional tables and keys are there too."""
    case = Case.parse(preset_text("paper-composite"))
    plain = case.plain()
    plain["root"] = {"support": "elastic", "translation": [1e8, 1e8, 1e8]}
    plain["loads"] = [{"kind": "gravity", "acceleration": [0.0, 0.0, -9.81]}]
    plain["limits"] = [{"name": "quiet", "frequencies": [100.0, 200.0], "levels": [90.0, 90.0]}]
    plain["campbell"] = {"speeds": [0.3, 0.6]}
    plain["acoustics"]["flow_damping"] = True
    plain["transfer"] = {"functions": ["mobility"]}
    plain["flow"]["wake"] = {"radius": [0.2, 1.2], "axial": [0.8, 0.9]}
    return Case.from_plain(plain)


def changed(case: Case, **changes: Any) -> set[str]:
    before = origins(case)
    after = origins(case.varied({key.replace("__", "."): v for key, v in changes.items()}))
    return {name for name in after if after[name].key != before[name].key}


def test_every_key_of_the_case_is_read_by_a_stage() -> None:
    known = stages(BOTH)
    for case in (
        everything(),
        *(Case.parse(preset_text(n)) for n in ("twisted", "paper-aluminium")),
    ):
        for key, _ in inputs(case):
            readers = [name for name, stage in known.items() if stage.depends_on(key)]
            assert readers or table._named(key, ALWAYS), (
                f"no stage reads {key}. Which stages compute with it? Add the key to the `reads` "
                "of each of them in quietblade/study/stages.py, or add a stage to the table; add "
                "it to ALWAYS if only what is made anew in every run depends on it."
            )


def test_every_key_of_a_body_is_read_by_a_stage() -> None:
    case = BodyCase.parse(preset_text("sphere")).varied({"transfer.functions": ["mobility"]})
    unread = {
        key
        for key, _ in inputs(case)
        if not any(stage.depends_on(key) for stage in body_stages().values())
    }
    # the gap is held against the sphere before a run, and nothing flows
    known = (*ALWAYS, "acoustics.gap", "water.kinematic_viscosity")
    assert not {key for key in unread if not table._named(key, known)}


def test_what_the_table_names_is_there() -> None:
    known = {key for key, _ in inputs(everything())} | {
        "files.blade.section",
        "files.loads[0].table",
        "files.film.loss_factor.file",
        "files.excitation[0].table",
    }
    for name, stage in stages(BOTH).items():
        for key in (*stage.reads, *stage.ignores):
            assert any(table._named(have, (key,)) for have in known), (
                f"{name} reads {key}: no such key"
            )
        assert set(stage.after) < set(stages(BOTH))


def leaves(value: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from leaves(inner, (*path, key))
    else:
        yield path


def other(value: Any) -> Any:
    match value:
        case bool():
            return not value
        case int() | float():
            return value * 1.01 + 0.001
        case str():
            return value + "'"
        case list():
            return [*value, 1]
        case None:
            return 1
    raise TypeError(type(value))


def test_each_changed_value_changes_the_keys_of_its_readers_and_of_all_that_follow(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Values need not make sense here: what counts is who notices."""
    case = everything()
    physics, before = case.physics(), origins(case)
    known = stages(BOTH)
    for path in leaves(physics):
        changed_physics = copy.deepcopy(physics)
        *outer, last = path
        inner = changed_physics
        for part in outer:
            inner = inner[part]
        inner[last] = other(inner[last])
        with monkeypatch.context() as patch:
            patch.setattr(Case, "physics", lambda _, data=changed_physics: copy.deepcopy(data))
            after = origins(case)
        key = ".".join(path)
        expected: set[str] = set()
        if key != "acoustics.sphere_centre":  # replaced by the place that it stands for
            for name, stage in known.items():
                if stage.depends_on(key) or expected & set(stage.after):
                    expected.add(name)
        assert {n for n in after if after[n].key != before[n].key} == expected, key


def test_what_a_change_touches() -> None:
    case = Case.parse(preset_text("paper-composite"))
    assert changed(case, title="another") == set()
    assert changed(case, flow__depth="3 m") == set()
    assert changed(case, acoustics__points_per_mode=5) == SWEEPS
    assert changed(case, far_field__points=[["5 m", "0 m", "0.7 m"]]) == SWEEPS
    assert changed(case, acoustics__accuracy="0.1 dB") == STEP_2
    assert changed(case, acoustics__band=["100 Hz", "210 Hz"]) == STEP_2  # same cells of water
    assert changed(case, acoustics__band=["100 Hz", "2100 Hz"]) == ALL  # finer cells
    assert changed(case, static__tolerance=1e-4) == STEP_1
    assert changed(case, flow__speed="4 m/s") == STEP_1  # the blade at rest does not know
    assert changed(case, mesh__size="30 mm") == ALL
    assert changed(case, mesh__size="0.023 m") == set()
    assert changed(case, **{"materials.polymer.loss_factor": 0.3}) == STEP_2


def test_what_a_change_of_a_body_touches() -> None:
    case = BodyCase.parse(preset_text("sphere"))
    sweeps = {"sweep C0", "mode tables"}

    def touched(key: str, value: Any) -> set[str]:
        before, after = origins(case), origins(case.varied({key: value}))
        return {name for name in after if after[name].key != before[name].key}

    assert touched("title", "another") == set()
    assert touched("far_field.planes", ["xy"]) == sweeps
    assert touched("acoustics.accuracy", "0.1 dB") == {"modes C0", *sweeps}
    assert touched("materials.structural-steel.loss_factor", 0.1) == {"modes C0", *sweeps}
    assert touched("body.thickness", "51 mm") == {"mesh", "modes C0", *sweeps}
    cap = {"kind": "pressure", "half_angle": "21 deg"}
    assert touched("excitation", cap) == {"mesh", "modes C0", *sweeps}


def test_reasons_are_told_in_words_of_the_case() -> None:
    case = Case.parse(preset_text("paper-composite"))
    before = origins(case)
    after = origins(case.varied({"flow.speed": "4 m/s", "acoustics.gap": "90 mm"}))
    assert after["mesh"].changes_from(before["mesh"]) == ""
    static, motion, sweep = ("flow and structure", "mesh motion", "sweep C0")
    assert after[static].changes_from(before[static]) == "flow.speed changed"
    assert after[motion].changes_from(before[motion]) == "acoustics.gap changed"
    assert after[sweep].changes_from(before[sweep]) == "follows from modes C1"
    newer = Origin(before["mesh"].inputs, {}, {**before["mesh"].code, "ngsolve": "7.0"})
    assert newer.changes_from(before["mesh"]) == "another version of ngsolve"
