# SPDX-License-Identifier: LGPL-2.1-or-later
"""A small sphere in water, from its case file to everything that can be done with its run."""

import json
from pathlib import Path

import numpy as np
import pytest

from quietblade.case import BodyCase, InvalidCaseError
from quietblade.case.presets import preset_text
from quietblade.case.study import Study
from quietblade.cli.common import ExitCode
from quietblade.results.answers import answers
from quietblade.results.dataset import from_tree, to_tree
from quietblade.results.evidence import evidence_tables
from quietblade.results.headline import summarise
from quietblade.results.model import Result, path
from quietblade.results.store import RunFolder
from quietblade.results.study_figures import headline_figures
from quietblade.results.tables import summary_tables
from quietblade.study.examine import examine
from quietblade.study.outlook import look_ahead
from quietblade.study.run import finished, run_case
from quietblade.study.studies import plan
from quietblade.view.bodies import draw_body_mesh
from quietblade.view.surfaces import moving_surfaces
from tests.case.commands import command

CHANGES = {
    "mesh.size": "160 mm",
    "acoustics.band": ["800 Hz", "1100 Hz"],
    "acoustics.step": "50 Hz",
    "acoustics.points_per_mode": 0,
    "acoustics.radiation_accuracy": 0.01,
    "far_field.frequencies": ["1000 Hz"],
    "far_field.planes": ["xy", "xz"],
    "transfer.functions": ["mobility", "power-per-force"],
    "excitation": [
        {"kind": "pressure", "half_angle": "25 deg"},
        {"kind": "point-force", "at": [0, 0, -3], "force": "0.5 N"},
    ],
}
LOADS = ("pressure", "point-force")


@pytest.fixture(scope="module")
def case() -> BodyCase:
    return BodyCase.parse(preset_text("sphere"), "ball.toml").varied(CHANGES)


@pytest.fixture(scope="module")
def folder(case: BodyCase, tmp_path_factory: pytest.TempPathFactory) -> RunFolder:
    folder = RunFolder(tmp_path_factory.mktemp("ball"))
    run_case(case, folder)
    return folder


@pytest.fixture(scope="module")
def result(folder: RunFolder) -> Result:
    return folder.load()


def test_there_is_no_steady_load(result: Result) -> None:
    assert result.static is None
    assert result.converged
    with pytest.raises(ValueError, match="no steady load"):
        result.steady.lift  # noqa: B018
    assert list(result.configurations) == ["C0"]


def test_modes_are_named_by_their_degree(result: Result) -> None:
    modes, count = result.configurations["C0"].modes, result.configurations["C0"].mode_count
    rigid = tuple(f"rigid.{k}" for k in range(1, 7))
    assert modes.name == (*rigid, *(f"n2.{k}" for k in range(1, 6)))
    assert count.counted == len(modes.name)
    assert count.character == ("rigid",) * 6 + ("degree 2",) * 5
    assert np.all(np.abs(modes.frequency[:6]) < 0.01)
    assert np.all(np.isnan(modes.loss_factor[:6]))
    # five of one frequency but for what the mesh does to the symmetry
    np.testing.assert_allclose(modes.frequency[6:], modes.frequency[6:].mean(), rtol=5e-3)
    assert np.all(modes.purity[6:] > 0.99)


def test_energy_balances_and_all_of_it_is_radiated_or_lost(result: Result) -> None:
    member = result.configurations["C0"]
    assert member.spectrum.balance_residual.max() < 1e-8
    assert member.dissipation.sink == ("body", "water")
    assert np.all(member.dissipation.power > 0.0)
    assert np.sum(member.dissipation.mean_share) == pytest.approx(1.0)


def test_power_through_sphere_surface_and_by_multipoles(result: Result) -> None:
    level = result.configurations["C0"].spectrum.power_level
    others = [path("wet_surface"), path("multipoles")]
    np.testing.assert_allclose(level[others] - level[path("sphere")], 0.0, atol=0.05)


def test_loads_on_the_axis_sound_alike_all_around(result: Result) -> None:
    """Cap and point are on one axis: in the plane across it the level is the same everywhere."""
    pattern = result.configurations["C0"].directivity
    around = pattern.cut_level[:, pattern.cut.index("xy")]
    assert np.ptp(around, axis=1).max() < 0.5
    spread = np.ptp(pattern.level, axis=-1)
    loud = pattern.level.min(axis=-1) > pattern.level.max() - 15.0
    assert spread[loud].max() < 0.5


def test_loads_are_named_and_sized(result: Result) -> None:
    table = result.configurations["C0"].excitations
    assert table.name == LOADS
    cap = 2.0 * np.pi * 0.5**2 * (1.0 - np.cos(np.radians(25.0)))
    np.testing.assert_allclose(table.size, [cap, 1.0], rtol=1e-3)
    np.testing.assert_allclose(
        np.abs(table.amplitude), [[1.0], [0.5]] * np.ones(len(table.amplitude[0]))
    )
    assert np.all(table.injected >= table.radiated)


def test_a_result_comes_back_from_its_file(result: Result) -> None:
    again = from_tree(to_tree(result))
    assert again.static is None
    np.testing.assert_array_equal(
        again.configurations["C0"].spectrum.power, result.configurations["C0"].spectrum.power
    )


def test_a_blade_without_its_steady_load_is_refused(result: Result) -> None:
    tree = to_tree(result)
    cells = tree["mesh/cells"].to_dataset()
    tree["mesh/cells"] = cells.assign(
        region=cells["region"].where(cells["region"] != "body", "blade")
    )
    with pytest.raises(Exception, match="lacks /static"):
        from_tree(tree)


def test_summary_leaves_out_what_only_blades_have(result: Result) -> None:
    summary = summarise(result)
    assert summary.static is summary.performance is summary.strength is None
    titles = {table.title for table in summary_tables(summary)}
    assert "Wet modes and peaks of the sound power" in titles
    assert not titles & {"Steady load", "Performance", "Strength"}
    told = dict(answers(summary).rows)
    assert "n2" in told["Where are the resonances?"]
    assert "(5 modes)" in told["Where are the resonances?"]
    assert "How much does it bend?" not in told
    assert {table.title for table in evidence_tables(result)} >= {"Sweeps over frequency"}
    assert "C0: wet modes" in result.card().text()


def test_stages_are_kept(case: BodyCase, folder: RunFolder) -> None:
    assert finished(case, folder) is not None
    said: list[str] = []
    again = run_case(
        case.varied({"far_field.planes": ["yz"]}), folder, lambda *line: said.append(str(line))
    )
    assert dict(zip(again.run.cost.stage, again.run.cost.kept.tolist(), strict=True)) == {
        "mesh": True, "modes C0": True, "sweep C0": False, "mode tables": False, "files": False,
    }  # fmt: skip


def test_commands(case: BodyCase, folder: RunFolder, tmp_path: Path) -> None:
    file = tmp_path / "ball.toml"
    assert command("new", str(file.with_suffix("")), "--preset", "sphere")[0] == ExitCode.DONE
    code, out, _ = command("check", str(file), "--json")
    told = json.loads(out)
    assert code == ExitCode.DONE
    assert told["derived"]["mass_kg"] == pytest.approx(1114.0, rel=1e-3)
    assert told["notices"] == []
    assert "flow and structure" not in told["forecast"]["time_s"]
    code, out, _ = command("show", str(folder.root), "--json")
    assert code == ExitCode.DONE
    assert json.loads(out)["static"] is None
    assert command("compare", str(folder.root), str(folder.root))[0] == ExitCode.DONE
    assert command("cite", str(file))[0] == ExitCode.DONE
    tables = tmp_path / "csv"
    assert command("export", str(folder.root), "--csv", str(tables))[0] == ExitCode.DONE
    assert (tables / "index.csv").is_file()
    code, _, err = command("export", str(file), "--step", str(tmp_path / "x.step"))
    assert code == ExitCode.CASE_WRONG
    assert "describes another body than a blade" in err


def test_studies_take_bodies(tmp_path: Path, result: Result) -> None:
    (tmp_path / "ball.toml").write_text(preset_text("sphere"))
    file = tmp_path / "study.toml"
    file.write_text(
        '[cases]\nball = "ball.toml"\n[vary]\n"mesh.size" = ["90 mm", "80 mm", "9 mm/s"]\n'
    )
    with pytest.raises(InvalidCaseError, match=r"mesh\.size"):
        plan(Study.load(file))
    file.write_text(file.read_text().replace(', "9 mm/s"', ""))
    runs = plan(Study.load(file))
    assert [run.words.mesh.size for run in runs] == [0.09, 0.08]
    assert all(isinstance(run.words, BodyCase) for run in runs)
    figures = {figure.name for figure in headline_figures(result)}
    assert {"nodes", "C0_n2.1_frequency", "C0_mean_level"} <= figures
    assert not any("rigid" in name for name in figures)


def test_forecast_is_near_the_mesh(case: BodyCase, result: Result) -> None:
    size = look_ahead(case, examine(case), trial=0.06).size
    assert size.nodes == pytest.approx(
        result.mesh.nodes, rel=0.25
    )  # cells of a third of the radius
    assert size.vibration == pytest.approx(result.mesh.unknowns.count.sum(), rel=0.15)


def test_pictures(folder: RunFolder, result: Result) -> None:
    figure = draw_body_mesh(folder)
    assert "excited part" in figure.axes[0].get_title(loc="left")
    (surface,) = moving_surfaces(folder, result)
    assert [motion.name for motion in surface.motions] == list(
        result.configurations["C0"].modes.name
    )
