# SPDX-License-Identifier: LGPL-2.1-or-later
"""Loads and supports of a case, from its words to the equilibrium."""

from pathlib import Path

import numpy as np
import pytest

from quietblade.case import Case, InvalidCaseError
from quietblade.case.presets import preset_text
from quietblade.mesh import Mesh, build_mesh
from quietblade.propulsion.loads import (
    Gravity,
    HydrostaticPressure,
    LineForce,
    PointForce,
    PressureTable,
    UniformPressure,
)
from quietblade.study import translate
from quietblade.study.blade_vibration import solve_vibration
from quietblade.study.loads import steady_loads, support
from quietblade.study.statics import solve_statics
from quietblade.typing import silent
from tests.study.test_run import COARSE

LOADS = [
    {"kind": "pressure", "value": "10 kPa"},
    {"kind": "point-force", "at": [1.0, 0.5], "force": ["0 N", "20 N", "0 N"]},
    {
        "kind": "line-force", "start": [0.5, 0.5], "end": [1.0, 0.5],
        "force": ["0 N/m", "10 N/m", "0 N/m"],
    },
    {"kind": "gravity", "acceleration": ["0 m/s^2", "-9.81 m/s^2", "0 m/s^2"]},
    {"kind": "hydrostatic", "depth": "20 m"},
]  # fmt: skip
SPRING = {
    "support": "elastic",
    "rotation": ["20 kN*m/rad", "20 kN*m/rad", "20 kN*m/rad"],
}


@pytest.fixture(scope="module")
def case() -> Case:
    return Case.parse(preset_text("paper-aluminium")).varied({**COARSE, "mesh.size": "60 mm"})


@pytest.fixture(scope="module")
def mesh(case: Case) -> Mesh:
    return build_mesh(translate.build_blade(case), translate.mesh_spec(case))


def test_words_become_loads(case: Case) -> None:
    blade = translate.build_blade(case)
    pressure, point, line, weight, water = steady_loads(case.varied({"loads": LOADS}), blade)
    assert isinstance(pressure, UniformPressure)
    assert pressure.pressure == 10e3
    assert isinstance(point, PointForce)
    assert point.place[2] == pytest.approx(1.2)
    assert isinstance(line, LineForce)
    np.testing.assert_allclose(line.path[[0, -1], 2], [0.7, 1.2])
    assert isinstance(weight, Gravity)
    assert weight.acceleration == (0.0, -9.81, 0.0)
    assert isinstance(water, HydrostaticPressure)
    assert (water.depth, water.position) == (20.0, "mean")


def test_table_of_pressures_beside_the_case(case: Case, tmp_path: Path) -> None:
    text = preset_text("paper-aluminium") + '\n[[loads]]\nkind = "pressure"\ntable = "p.csv"\n'
    file = tmp_path / "case.toml"
    file.write_text(text)
    rows = [f"{s}, {xi}, {100 * s}, {-50 * xi}" for s in (0, 0.5, 1) for xi in (0, 1)]
    (tmp_path / "p.csv").write_text("span, chord, upper, lower\n" + "\n".join(rows) + "\n")
    loaded = Case.load(file)
    (load,) = steady_loads(loaded, translate.build_blade(loaded))
    assert isinstance(load, PressureTable)
    np.testing.assert_allclose(load.upper[:, 0], [0.0, 50.0, 100.0])
    np.testing.assert_allclose(load.lower[0], [0.0, -50.0])
    before = loaded.content_key()
    (tmp_path / "p.csv").write_text("span, chord, upper, lower\n" + "\n".join(rows[:-1]) + "\n")
    assert loaded.content_key() != before  # what the file says counts
    with pytest.raises(InvalidCaseError, match=r"loads\[0\]\.table.*5 rows are not a grid"):
        steady_loads(loaded, translate.build_blade(loaded))
    (tmp_path / "p.csv").unlink()
    with pytest.raises(InvalidCaseError, match=r"p\.csv"):
        steady_loads(loaded, translate.build_blade(loaded))


def test_root_is_clamped_or_on_springs(case: Case) -> None:
    assert support(case) is None
    spring = support(case.varied({"root": SPRING}))
    assert spring is not None
    assert spring.rotation == (20e3, 20e3, 20e3)
    assert np.isinf(spring.translation).all()


def test_equilibrium_with_loads_on_springs(case: Case, mesh: Mesh) -> None:
    clamped = solve_statics(case, translate.build_blade(case), mesh, silent)
    words = case.varied({"root": SPRING, "loads": LOADS[1:4]})
    statics = solve_statics(words, translate.build_blade(words), mesh, silent)
    assert statics.state.converged
    assert statics.loads is not None
    point, line, weight = statics.loads.parts
    assert point.force[1] == pytest.approx(20.0)
    assert line.force[1] == pytest.approx(5.0, rel=1e-3)
    volume = translate.build_blade(words).volume()
    assert weight.force[1] == pytest.approx(-9.81 * 2500.0 * volume, rel=0.1)  # film, coarse mesh
    assert statics.stress.reaction.force_imbalance < 1e-5
    # step 2 stands on the springs too
    rest, sprung = (
        solve_vibration(c, translate.build_blade(c), mesh, s, None, silent).modes.frequency[0]
        for c, s in ((case, clamped), (words, statics))
    )
    assert 0.2 * rest < sprung < 0.95 * rest
    # the springs alone turn the blade by its root moment over their stiffness
    assert statics.state.tip_displacement[1] > 1.2 * clamped.state.tip_displacement[1]
