# SPDX-License-Identifier: LGPL-2.1-or-later
"""Studies: words, plan, resume, failures and tables; made-up results stand for the runs."""

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from quietblade.case import Case, InvalidCaseError
from quietblade.case.presets import preset_text
from quietblade.case.study import Study
from quietblade.cli.main import execute
from quietblade.errors import ConvergenceError
from quietblade.results.files import ResultError
from quietblade.results.model import Result
from quietblade.results.store import RunFolder
from quietblade.results.study_claims import claim_table, read_claims
from quietblade.results.study_table import read_study
from quietblade.study.run import run_key
from quietblade.study.studies import StudyOutcome, plan, run_study
from quietblade.typing import Progress, silent
from tests.results.synthetic import make_result

STUDY = """
title = "Films and meshes"

[cases]
composite = "c.toml"

[common]
acoustics.step = "2 Hz"

[variants.fine]
"mesh.size" = "20 mm"

[variants.medium]
mesh.size = "26 mm"

[variants.coarse]
mesh = { size = "34 mm" }

[variants.loud]
"mesh.size" = "20 mm"
"acoustics.radiation" = "bgt1"

[claims]
variants = ["loud", "fine"]

[convergence]
variants = ["fine", "medium", "coarse"]
"""

NODES = {0.020: 30_000, 0.026: 14_000, 0.034: 6_000}


class Runner:
    """Stands for `run_case`; a smaller mesh gives a larger film shear strain."""

    def __init__(self) -> None:
        self.made: list[str] = []
        self.fails = ""

    def __call__(self, case: Case, folder: RunFolder, progress: Progress = silent) -> Result:
        name = folder.root.name
        self.made.append(name)
        if name == self.fails:
            raise ConvergenceError("no equilibrium at 60 % of the load")
        blank = make_result("aluminium" if "aluminium" in name else "composite")
        strain = blank.static.max_film_shear_strain * (1.0 - 40.0 * case.mesh.size**2)
        result = replace(
            blank,
            static=replace(blank.static, max_film_shear_strain=strain),
            mesh=replace(blank.mesh, nodes=NODES[case.mesh.size]),
            run=replace(blank.run, content_key=run_key(case)),
        )
        folder.save(result)
        return result


def write_files(folder: Path) -> Path:
    for name, blade in (("a", "aluminium"), ("c", "composite")):
        (folder / f"{name}.toml").write_text(preset_text(f"paper-{blade}"), encoding="utf-8")
    path = folder / "study.toml"
    path.write_text(STUDY, encoding="utf-8")
    return path


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return write_files(tmp_path)


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, StudyOutcome]:
    """File of a study that is finished, and what it made."""
    path = write_files(tmp_path_factory.mktemp("study"))
    return path, run_study(Study.load(path), path.parent / "out", runner=Runner())


def test_changes_may_be_dotted_quoted_or_tables(file: Path) -> None:
    runs = {run.name: run.words for run in plan(Study.load(file))}
    assert len(runs) == 4
    assert runs["composite-medium"].mesh.size == pytest.approx(0.026)
    assert runs["composite-coarse"].mesh.size == pytest.approx(0.034)
    assert runs["composite-loud"].acoustics.radiation == "bgt1"
    assert all(case.acoustics.step == 2.0 for case in runs.values())


def test_runs_that_share_mesh_and_equilibrium_stand_side_by_side(file: Path) -> None:
    names = [run.name for run in plan(Study.load(file))]
    assert names.index("composite-loud") == names.index("composite-fine") + 1


def test_grid_makes_every_combination(file: Path) -> None:
    text = '[cases]\nblade = "a.toml"\n[vary]\nfilm.thickness = ["1 mm", "1.5 mm"]\n'
    file.write_text(f'{text}"film.chord" = [[0.2, 0.6], [0.3, 0.7], [0.15, 0.8]]\n')
    runs = plan(Study.load(file))
    assert len(runs) == 6
    assert runs[0].name == "blade-thickness-1-mm+chord-0.2-0.6"
    assert {(r.words.film.thickness, r.words.film.chord) for r in runs if r.words.film} == {
        (t, c) for t in (1e-3, 1.5e-3) for c in ((0.2, 0.6), (0.3, 0.7), (0.15, 0.8))
    }


def test_finished_runs_are_kept_and_only_what_changed_is_computed(
    whole: tuple[Path, StudyOutcome], file: Path
) -> None:
    root, runner = file.parent / "out", Runner()
    assert whole[1].computed == 4
    shutil.copytree(whole[0].parent / "out", root)
    file.write_text(STUDY.replace("bgt1", "bgt2"))
    assert run_study(Study.load(file), root, runner=runner).computed == 1
    assert runner.made == ["composite-loud"]


def test_two_meshes_are_too_few(file: Path) -> None:
    file.write_text(STUDY.replace('"medium", ', ""))
    with pytest.raises(InvalidCaseError, match=r"convergence\.variants"):
        Study.load(file)


def test_failed_run_is_told_and_does_not_end_the_study(
    whole: tuple[Path, StudyOutcome], file: Path
) -> None:
    root, runner, told = file.parent / "out", Runner(), []
    shutil.copytree(whole[0].parent / "out", root)
    (root / "composite-medium" / "result.nc").unlink()
    runner.fails = "composite-medium"
    made = run_study(
        Study.load(file), root, runner=runner, announce=lambda *words: told.append(words)
    )
    assert [row.run for row in made.table.rows if row.state == "failed"] == ["composite-medium"]
    assert (3, 4, "composite-medium", "failed: no equilibrium at 60 % of the load") in told
    assert "no equilibrium" in (root / "study.txt").read_text()
    assert made.claims is not None
    assert all(row.uncertainty is None for row in made.claims.rows)  # two meshes are not enough


def test_tables_are_read_as_they_were_written(whole: tuple[Path, StudyOutcome]) -> None:
    file, made = whole
    root = file.parent / "out"
    read = read_study(root)
    assert [row.run for row in read.rows] == [row.run for row in made.table.rows]
    assert read.rows[3].changes == made.table.rows[3].changes
    assert read.rows[0].figure("film_shear_strain") == made.table.rows[0].figure(
        "film_shear_strain"
    )
    data = read.to_dataset()
    assert all(variable.attrs["units"] for variable in data.data_vars.values())
    assert read_claims(root) == made.claims
    head, *rows = (root / "study.csv").read_text().splitlines()
    assert head.startswith("case,variant,state,acoustics.step,mesh.size,")
    assert "film_shear_strain [1]" in head
    assert len(rows) == 4


def test_numerical_uncertainty_comes_from_the_meshes(whole: tuple[Path, StudyOutcome]) -> None:
    file, made = whole
    assert made.claims is not None
    row = next(r for r in made.claims.rows if r.id == "paper/composite/film-shear-strain")
    assert row.uncertainty is not None
    assert row.uncertainty.behaviour == "monotonic"
    exact = 100 * make_result("composite").static.max_film_shear_strain
    assert abs(row.uncertainty.values[0] - exact) < 2.0 * row.uncertainty.half_width
    assert [entry.variant for entry in row.entries] == ["loud", "fine"]
    lines = (file.parent / "out" / "convergence.csv").read_text().splitlines()
    assert any(line.startswith("composite,film_shear_strain,1,") for line in lines)


def results_on_meshes(*strains: float) -> dict[tuple[str, str], Result]:
    """Results on a fine, a medium and a coarse mesh with these film shear strains."""
    made = {}
    for variant, nodes, strain in zip(("f", "m", "c"), NODES.values(), strains, strict=True):
        blank = make_result("composite")
        static = replace(blank.static, max_film_shear_strain=strain)
        made["blade", variant] = replace(
            blank, static=static, mesh=replace(blank.mesh, nodes=nodes)
        )
    return made


def test_claim_missed_by_less_than_its_uncertainty_is_told_apart() -> None:
    results = results_on_meshes(0.066, 0.050, 0.030)
    claims = claim_table("Rough meshes", results, ("f", "none"), ("f", "m", "c"))
    row = next(r for r in claims.rows if r.id == "paper/composite/film-shear-strain")
    assert [e.verdict for e in row.entries] == ["agrees within uncertainty", "not computed"]
    page, web = claims.markdown(), claims.html()
    assert page.count("\n| ") == len(claims.rows) + 1
    assert 'id="paper/composite/film-shear-strain"' in web
    assert claims.count("f")[1] == len(claims.rows)
    assert claims.count("none") == (0, 0)


def test_meshes_must_be_named_from_fine_to_coarse() -> None:
    results = results_on_meshes(0.066, 0.050, 0.030)
    with pytest.raises(ResultError, match="finest mesh first"):
        claim_table("Upside down", results, ("f",), ("c", "m", "f"))


BAD = {
    "no cases": ("[cases]\n", "is empty"),
    "no such file": ('[cases]\na = "none.toml"\n', "no such file"),
    "name of a folder": ('[cases]\n"a/b" = "a.toml"\n', "name of a folder"),
    "unknown table": ('[cases]\na = "a.toml"\n[variant.x]\n', "unknown key"),
    "unknown key": ('[cases]\na = "a.toml"\n[variants.x]\nmesh.sizes = "9 mm"\n', "mesh.size"),
    "wrong value": (
        '[cases]\na = "a.toml"\n[variants.x]\n"mesh.size" = "9 s"\n', "study.toml:4: mesh.size",
    ),
    "no list": ('[cases]\na = "a.toml"\n[vary]\nmesh.size = "9 mm"\n', "list of values"),
    "two meshes": (
        '[cases]\na = "a.toml"\n[convergence]\nvariants = ["base", "base"]\n', "3 or more",
    ),
    "no variant": ('[cases]\na = "a.toml"\n[claims]\nvariants = ["bse"]\n', 'Did you mean "base"'),
    "too many": (
        '[cases]\na = "a.toml"\n[vary]\n'
        + "".join(f'"x.y{k}" = [1, 2, 3, 4]\n' for k in range(6)), "makes 4096 runs",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", BAD)
def test_bad_study_files_are_explained(
    name: str, file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text, message = BAD[name]
    file.write_text(text)
    out = file.parent / "out"
    assert execute(["study", str(file), "--out", str(out)]) == 1
    assert message in capsys.readouterr().err
    assert not out.exists()


def test_command_shows_what_is_there(
    whole: tuple[Path, StudyOutcome], capsys: pytest.CaptureFixture[str]
) -> None:
    file, root = whole[0], whole[0].parent / "out"
    assert execute(["study", str(file), "--out", str(root)]) == 0
    assert "4 of 4: composite-coarse, is there" in capsys.readouterr().out
    assert execute(["show", str(root)]) == 0
    assert "The paper's claims" in capsys.readouterr().out
    assert execute(["show", "--json", str(root)]) == 0
    assert '"film_shear_strain"' in capsys.readouterr().out
    assert execute(["study", str(file), "--plan"]) == 0
    assert 'acoustics.radiation = "bgt1"' in capsys.readouterr().out.replace("\n", " ")


def test_paper_study_is_one_of_both_blades() -> None:
    runs = plan(Study.load(Path(__file__).parents[2] / "cases" / "paper.toml"))
    assert {run.case for run in runs} == {"aluminium", "composite"}
    choices = {run.variant: run.words.acoustics for run in runs}
    assert (choices["paper"].radiation, choices["paper"].loss) == ("bgt1", "paper")
    assert np.unique([run.words.mesh.size for run in runs]).size == 3
