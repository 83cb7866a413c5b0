# SPDX-License-Identifier: LGPL-2.1-or-later
"""A fixed foil in a stream, from the preset to the result: nothing divides by the rotation."""

import json
from pathlib import Path

import pytest

from quietblade.case import Case
from quietblade.case.presets import preset_text
from quietblade.results.headline import summarise
from quietblade.results.store import RunFolder
from quietblade.study.run import run_case

COARSE = {
    "mesh.size": "30 mm",
    "acoustics.configurations": ["C0"],
    "acoustics.band": ["40 Hz", "200 Hz"],
    "acoustics.step": "40 Hz",
    "acoustics.points_per_mode": 0,
    "flow.sections": 21,
    "flow.section_nodes": 81,
}


def test_a_fixed_foil_is_a_case_like_any_other(tmp_path: Path) -> None:
    case = Case.parse(preset_text("hydrofoil"), "foil.toml").varied(COARSE)
    result = run_case(case, RunFolder(tmp_path / "foil"))
    told = summarise(result)
    assert told.static.converged
    # on the preset's own mesh, and by the tables of the page on hydrofoils: 3.2 mm and 70.6 Hz
    assert told.static.tip_displacement_m[1] == pytest.approx(3.2e-3, rel=0.05)
    first = told.modes.C0[0]
    assert first.name == "B1"
    assert first.frequency_hz == pytest.approx(70.6, rel=0.08)  # large cells hold less water
    coupled = json.loads(told.performance.coupled.model_dump_json())
    assert coupled["thrust_n"] < 0.0  # the drag
    assert coupled["efficiency"] is None
