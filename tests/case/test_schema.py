# SPDX-License-Identifier: LGPL-2.1-or-later
"""The JSON schema takes every good case file and finds the slips that an editor can find."""

import json
import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator

from quietblade.case import BodyCase, Case
from quietblade.case.presets import PRESETS, preset_text
from quietblade.case.schema import case_schema
from tests.case.test_messages import CASE

ROOT = Path(__file__).resolve().parents[2]
SCHEMA = case_schema()
VALIDATOR = Draft202012Validator(SCHEMA)
FILES = {
    **{f"preset {name}": preset_text(name) for name in PRESETS},
    **{
        path.name: path.read_text(encoding="utf-8")
        for path in sorted((ROOT / "cases").glob("*.toml"))
        if "cases" not in tomllib.loads(path.read_text(encoding="utf-8"))  # a study
    },
}
RICH = """
[materials.lay-up]
law = "laminate"
model = "plies"
plies = [
    { material = "carbon-epoxy-t300", angle = "0 deg", thickness = "0.5 mm" },
    { material = "carbon-epoxy-t300", angle = "45 deg", fraction = 0.5 },
]
loss_factor = { model = "maxwell", strengths = [1], relaxation_times = ["1 ms"] }
[materials.rubber]
law = "neo-hookean"
density = "1100 kg/m^3"
shear_modulus = "1.5 MPa"
bulk_modulus = "2 GPa"
loss_factor = { model = "constant", value = 0.2, prestrain = [
    { shear = 0.1, loss_factor = { model = "constant", value = 0.3 } } ] }
[[loads]]
kind = "gravity"
acceleration = ["0 m/s^2", "-9.81 m/s^2", "0 m/s^2"]
[[limits]]
name = "ours"
frequencies = ["100 Hz", "1 kHz"]
levels = ["120 dB", "110 dB"]
[transfer]
functions = ["mobility"]
"""


def problems(text: str) -> list[str]:
    return [error.message for error in VALIDATOR.iter_errors(tomllib.loads(text))]


def test_it_is_a_schema() -> None:
    Draft202012Validator.check_schema(SCHEMA)
    assert SCHEMA["$schema"] == "https://json-schema.org/draft/2020-12/schema"
    assert "null" not in json.dumps(SCHEMA)


@pytest.mark.parametrize("name", FILES)
def test_good_files_are_valid(name: str) -> None:
    assert problems(FILES[name]) == []


def test_tables_inside_tables_are_known() -> None:
    assert problems(CASE + RICH) == []
    for old, new in [
        ('angle = "45 deg"', "angle = 45"),
        ('thickness = "0.5 mm"', 'thicknes = "0.5 mm"'),
        ('relaxation_times = ["1 ms"]', "relaxation_times = [1]"),
        ("shear = 0.1", "shear = 20.0"),
        ("value = 0.3", "value = 0.3, temperature = 3"),
        ('levels = ["120 dB", "110 dB"]', 'levels = ["120 dB", 110]'),
        ('"-9.81 m/s^2", ', ""),
    ]:
        assert RICH.count(old) == 1
        assert problems(CASE + RICH.replace(old, new)), new


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("thickness = 0.06", "thicknes = 0.06"),
        ("[flow]", "[flwo]"),
        ('size = "25 mm"', "size = 25"),
        ('size = "25 mm"', 'size = "25"'),
        ('size = "25 mm"', 'size = "25 mm"\nqqq = 1'),
        ('span = "1 m"\n', ""),
        ('values = ["250 mm", "75 mm"]', 'values = ["250 mm", 0.075]'),
        ("s = [0, 1]", 's = [0, 1], interpolation = "cubic"'),
        ("s = [0, 1]", "s = [0, 1], kind = 1"),
        ('material = "woven"', 'material = "woven"\nsection = "naca-7"'),
        ('law = "orthotropic"', 'law = "ortotropic"'),
        ("nu12 = 0.04", 'nu12 = "0.04"'),
        ('band = ["100 Hz", "200 Hz"]', 'band = ["100 Hz"]'),
        ('sphere_radius = "1.3 m"', 'sphere_radius = "1.3 m"\nradiation = "bgt3"'),
        ('speed = "5 m/s"', 'speed = "5 m/s"\nsections = 3'),
        ('speed = "5 m/s"', 'speed = "5 m/s"\nsections = 40.5'),
        ('title = "test"', "title = 3"),
        ('title = "test"', "format = 99"),
    ],
)
def test_slips_are_found(old: str, new: str) -> None:
    assert CASE.count(old) == 1
    assert problems(CASE.replace(old, new))


def test_one_excitation_or_several() -> None:
    one = "[excitation]\nspan = [0.9, 0.96]\nchord = [0.3, 0.7]\n"
    force = 'kind = "point-force"\nforce = "1 N"\ndirection = [0, 1, 0]\nat = [0.5, 0.5]\n'
    for new in (f"[[excitation]]\n{force}", f"[excitation]\n{force}"):
        assert problems(CASE.replace(one, new)) == []
        assert problems(CASE.replace(one, new.replace('"1 N"', "1")))


def properties(node: Any) -> Iterator[tuple[str, Mapping[str, Any]]]:
    if isinstance(node, dict):
        yield from (p for p in node.get("properties", {}).items() if isinstance(p[1], dict))
    for inner in node.values() if isinstance(node, dict) else ():
        yield from properties(inner)


def test_every_key_is_explained_and_defaults_are_written_as_in_a_file() -> None:
    for name, table in {"Case": SCHEMA, **SCHEMA["$defs"]}.items():
        for key, said in table["properties"].items():
            assert said["title"], (name, key)
            assert said["description"], (name, key)
            if said.get("unit"):
                assert f"[{said['unit']}]" in said["description"]
    assert SCHEMA["$defs"]["AcousticsWords"]["properties"]["gap"]["default"] == "0.05 m"
    assert SCHEMA["$defs"]["AcousticsWords"]["properties"]["radiation"]["default"] == "dtn"
    assert SCHEMA["$defs"]["BladeWords"]["properties"]["camber"]["default"] == 0.0
    for key, said in properties(SCHEMA):
        if "default" in said:
            assert Draft202012Validator({**said, "$defs": SCHEMA["$defs"]}).is_valid(
                said["default"]
            ), key


def test_every_table_of_the_case_is_there() -> None:
    assert set(SCHEMA["properties"]) == set(Case.model_fields) | set(BodyCase.model_fields)


def test_a_file_is_of_a_blade_or_of_another_body() -> None:
    ball = preset_text("sphere")
    assert problems(ball.replace('kind = "spherical-shell"', 'kind = "cube"'))
    assert problems(ball.replace("half_angle", "half_angel"))
    assert problems(ball[ball.index("[materials") :])
    assert problems(CASE[CASE.index("[materials") :])
