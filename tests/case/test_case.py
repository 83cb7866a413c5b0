# SPDX-License-Identifier: LGPL-2.1-or-later
"""The case as an object: values, round trip, key, library, presets."""

import json
from importlib.resources import files
from math import radians
from pathlib import Path
from typing import Any, get_args

import pytest
from pydantic import BaseModel, ValidationError

from quietblade import linalg
from quietblade.case import BodyCase, Case, Problem
from quietblade.case import presets as preset_package
from quietblade.case.fields import Quantity, Words
from quietblade.case.formula import ARGUMENTS, formula_fault
from quietblade.case.library import LAW_OF, NAMES, library_material
from quietblade.case.materials import LAWS, MooneyRivlinWords, OrthotropicWords
from quietblade.case.presets import BLADES, PRESETS, preset_text
from quietblade.case.spans import ConstantSpan, FormulaSpan, Spanwise, TableSpan
from quietblade.case.tables import Precision, SolverName
from quietblade.errors import CaseError
from quietblade.geometry import spanwise
from quietblade.study.body_preflight import body_preflight
from quietblade.study.preflight import preflight

ROOT = Path(__file__).resolve().parents[2]


def preset(name: str) -> Case:
    return Case.parse(preset_text(name), f"{name}.toml")


@pytest.mark.parametrize("name", BLADES)
def test_preset_is_a_good_case(name: str) -> None:
    case = preset(name)
    known = preflight(case)
    assert case.title
    assert known.clearance > case.acoustics.gap
    assert (known.film_cover is None) == (case.film is None)
    assert known.film_cover is None or known.film_cover > 0.1e-3
    assert not known.notices


@pytest.mark.parametrize("name", ["paper-aluminium", "paper-composite"])
def test_cases_of_the_repository_are_the_presets(name: str) -> None:
    assert (ROOT / "cases" / f"{name}.toml").read_text(encoding="utf-8") == preset_text(name)


def test_every_preset_file_is_listed() -> None:
    found = {f.name.removesuffix(".toml") for f in files(preset_package).iterdir()}
    assert set(PRESETS) == {name for name in found if not name.startswith("__")}


def test_unknown_preset() -> None:
    with pytest.raises(CaseError, match='Did you mean "twisted"'):
        preset_text("twistd")


def test_values_of_the_paper() -> None:
    case = preset("paper-composite")
    assert case.blade.hub_radius == 0.2
    assert case.blade.chord == TableSpan((0.0, 1.0), (0.25, 0.075), "linear")
    assert case.blade.thickness == ConstantSpan(0.06)
    assert case.flow.rotation == 0.58
    woven, film = case.material("blade"), case.material("film")
    assert isinstance(woven, OrthotropicWords)
    assert (woven.E1, woven.E3, woven.G12, woven.G23) == (65e9, 10e9, 5e9, 3e9)
    assert (woven.ratio(1, 2), woven.ratio(2, 3), woven.ratio(1, 3)) == (0.04, 0.2, 0.2)
    assert woven.ply_angle == pytest.approx(radians(45.0))
    assert isinstance(film, MooneyRivlinWords)
    assert film.shear_modulus == pytest.approx(1.522e6)


def test_library_materials_are_those_written_out_in_the_paper_cases() -> None:
    for name, part, library in [
        ("paper-aluminium", "blade", "aluminium-paper"),
        ("paper-composite", "blade", "woven-carbon-paper"),
        ("paper-composite", "film", "viscoelastic-paper"),
    ]:
        assert preset(name).material(part) == library_material(library)
    assert set(NAMES) == set(LAW_OF)


def test_ratio_may_be_spelt_either_way() -> None:
    plain = preset("paper-composite").plain()["materials"]["woven-carbon"]
    del plain["nu13"]
    other = OrthotropicWords.model_validate(plain | {"nu31": 0.2 * 10 / 65}, context={"si": True})
    assert other.ratio(1, 3) == pytest.approx(0.2)


def test_preset_of_a_body_is_a_good_case() -> None:
    (name,) = set(PRESETS) - set(BLADES)
    case = BodyCase.parse(preset_text(name))
    known = body_preflight(case)
    assert case.title
    assert known.clearance > case.acoustics.gap
    assert not known.notices


def test_round_trip_through_si_values() -> None:
    for name in BLADES:
        case = preset(name)
        again = Case.from_plain(json.loads(json.dumps(case.plain())))
        assert again == case
        assert again.content_key() == case.content_key()


def test_frozen() -> None:
    case = preset("paper-aluminium")
    with pytest.raises(ValidationError):
        case.mesh.size = 1.0
    assert case.mesh.size == 0.023


def test_key_does_not_depend_on_spelling() -> None:
    case = preset("paper-aluminium")
    key = case.content_key()
    for changes in [
        {"title": "another"},
        {"blade.span": "1000 mm"},
        {"flow.speed": "18 km/h"},
        {"blade.material": "aluminium-paper"},
        {"materials.spare": {"law": "isotropic", "density": "1 kg/m^3", "E": "1 GPa", "nu": 0}},
    ]:
        assert case.varied(changes).content_key() == key, changes


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("mesh.size", "26 mm"),
        ("blade.thickness", 0.061),
        ("flow.speed", "5.0001 m/s"),
        ("materials.aluminium.E", "66 GPa"),
        ("materials.polymer.loss_factor", 0.2),
        ("acoustics.band", ["100 Hz", "201 Hz"]),
        ("acoustics.configurations", ["C0"]),
        ("excitation.side", "lower"),
        ("solver.precision", "mixed"),
    ],
)
def test_key_depends_on_every_part(key: str, value: Any) -> None:
    case = preset("paper-aluminium")
    assert case.varied({key: value}).content_key() != case.content_key()


def test_varied_leaves_the_case_alone_and_takes_the_film_away() -> None:
    case = preset("paper-aluminium")
    finer = case.varied({"mesh.size": "20 mm", "mesh.water_size": "0.2 m"})
    assert (case.mesh.size, finer.mesh.size, finer.mesh.water_size) == (0.023, 0.02, 0.2)
    assert case.mesh.water_size is None


def test_film_is_optional() -> None:
    text = preset_text("paper-aluminium")
    without = text[: text.index("[film]")] + text[text.index("[materials.aluminium]") :]
    case = Case.parse(without)
    assert case.film is None
    assert preflight(case).film_cover is None
    with pytest.raises(KeyError):
        case.material("film")
    assert case.content_key() != preset("paper-aluminium").content_key()


def models() -> set[type[BaseModel]]:
    found: set[type[BaseModel]] = {Case, *LAWS.values()}
    for info in Case.model_fields.values():
        candidates = (info.annotation, *get_args(info.annotation))
        found |= {c for c in candidates if isinstance(c, type) and issubclass(c, Words)}
    return found


@pytest.mark.parametrize("model", sorted(models(), key=lambda m: m.__name__))
def test_every_key_is_described(model: type[BaseModel]) -> None:
    assert model.model_config["frozen"]
    assert model.model_config["extra"] == "forbid"
    schema = model.model_json_schema()
    for name, info in model.model_fields.items():
        assert info.title, name
        assert info.description, name
        if any(isinstance(note, Quantity | Spanwise) for note in info.metadata):
            assert "unit" in schema["properties"][name], name


def test_formula_language_is_that_of_the_geometry() -> None:
    calls = {name: f"{name}({', '.join(['s'] * count)})" for name, count in ARGUMENTS.items()}
    assert set(ARGUMENTS) == set(spanwise._FUNCTIONS)
    for text in [*calls.values(), "-s**2/3 + 2*pi - (1 - s)", "+1e3"]:
        assert formula_fault(text) == ""
        spanwise.formula(text)


@pytest.mark.parametrize(
    "text",
    ["", "s.real", "s[0]", "[1]", "lambda: 1", "s if s else 1", "'a'*3", "True", "1j", "s < 1",
     "s // 2", "s % 2", "~s", "__import__('os')", "sin(x=1)", "sin(*s)", "1" + "0" * 200,
     "(" * 200 + "s" + ")" * 200, "s" * 400, "s\x00"],
)  # fmt: skip
def test_formula_refuses(text: str) -> None:
    assert formula_fault(text)


def test_solver_names_are_those_of_the_solvers() -> None:
    assert set(get_args(SolverName)) == set(get_args(linalg.SolverName))
    assert set(get_args(Precision)) == set(get_args(linalg.Precision))


def test_formula_span_keeps_its_words() -> None:
    case = preset("twisted")
    assert case.blade.sweep == FormulaSpan("60*s**2", "mm", 1e-3)
    assert case.blade.camber == FormulaSpan("0.02 - 0.01*s", "", 1.0)


def test_problem_without_value() -> None:
    assert str(Problem("a.toml", None, "", "", "is empty", "")) == "a.toml: is empty"
