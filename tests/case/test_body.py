# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cases of a body that is no blade: values, round trip, and what a user reads if one is wrong."""

import json
from pathlib import Path

import pytest

from quietblade.case import BodyCase, Case, InvalidCaseError, load_case, parse_case
from quietblade.case.presets import preset_text
from quietblade.cli.common import ExitCode
from quietblade.study.examine import examine
from tests.case.commands import command

TEXT = preset_text("sphere")

# (what to replace, by what, key, fragments of the message)
BAD: list[tuple[str, str, str, tuple[str, ...]]] = [
    ('kind = "spherical-shell"', 'kind = "spherical-shel"', "body.kind", ('"spherical-shell"?',)),
    ('radius = "0.5 m"  ', 'radius = "-0.5 m"  ', "body.radius", ("greater than zero",)),
    ('thickness = "50 mm"', 'thickness = "0.5 m"', "body.thickness", ("500 mm", "hollow")),
    ('material = "structural-steel"', 'material = "chalk"', "body.material", ("no material",)),
    ('material = "structural-steel"', 'material = "viscoelastic-paper"', "body.material",
     ("mooney-rivlin", "isotropic")),
    ('thickness = "50 mm" ', 'thicknes = "50 mm" ', "body.thicknes", ("thickness",)),
    ("[body]  ", "[blade]\nspan = '1 m'\n[body]  ", "body", ("beside [blade]", "Remove one")),
    ("[acoustics]", "[flow]\nspeed = '1 m/s'\n[acoustics]", "flow", ("of a blade", "Remove")),
    ("[acoustics]", "[film]\nthickness = '1 mm'\n[acoustics]", "film", ("of a blade",)),
    ("[acoustics]", "[root]\nsupport = 'clamped'\n[acoustics]", "root", ("of a blade",)),
    ("[acoustics]", "[static]\n[acoustics]", "static", ("of a blade",)),
    ("[acoustics]", "[[loads]]\nkind = 'gravity'\n[acoustics]", "loads", ("of a blade",)),
    ("[acoustics]", "[campbell]\n[acoustics]", "campbell", ("of a blade",)),
    ("step = ", 'configurations = ["C0", "C1"]\nstep = ', "acoustics.configurations",
     ("has C1", '["C0"]')),
    ("step = ", "flow_damping = true\nstep = ", "acoustics.flow_damping", ("blade in a stream",)),
    ('kind = "pressure"', 'kind = "root-motion"', "excitation.kind",
     ("is not a kind of excitation", '"pressure", "point-force"')),
    ('half_angle = "20 deg"', 'half_angle = "0 deg"', "excitation.half_angle", ("zero",)),
    ('half_angle = "20 deg"', 'half_angle = "180 deg"', "excitation.half_angle", ("at most",)),
    ('half_angle = "20 deg"', "# none", "excitation.half_angle", ("is missing", "rim")),
    ("axis = [0, 0, 1]", "axis = [0, 0, 0]", "excitation.axis", ("points nowhere",)),
    ("axis = [0, 0, 1]", "span = [0.1, 0.2]", "excitation.span", ("unknown key",)),
    ("[mesh]", '[transfer]\nfunctions = ["blocked-force"]\n[mesh]', "transfer.functions",
     ("a body is free", '"mobility"')),
    ('sphere_radius = "0.7 m"', 'sphere_radius = "0.45 m"', "acoustics.sphere_radius",
     ("reaches 50 mm out", "above 0.6 m")),
    ('sphere_radius = "0.7 m"', 'sphere_radius = "0.55 m"', "acoustics.sphere_radius",
     ("within 50 mm", "the gap is 100 mm")),
    ('size = "70 mm"', 'size = "300 mm"', "mesh.size", ("too coarse", "a fifth of the radius")),
    ('size = "70 mm"', 'size = "0.1 mm"', "mesh.size", ("too fine",)),
    ('planes = ["xz", "xy"]', 'points = [["0.5 m", "0 m", "0 m"]]', "far_field.points[0]",
     ("from the wetted surface",)),
    ('frequencies = ["1040 Hz"]', 'frequencies = ["10 Hz"]', "far_field.frequencies[0]",
     ("outside the band",)),
]  # fmt: skip


def changed(old: str, new: str) -> str:
    assert old in TEXT, old
    return TEXT.replace(old, new, 1)


@pytest.mark.parametrize(("old", "new", "key", "fragments"), BAD, ids=[b[1][:40] for b in BAD])
def test_message(old: str, new: str, key: str, fragments: tuple[str, ...]) -> None:
    with pytest.raises(InvalidCaseError) as caught:
        examine(parse_case(changed(old, new), "ball.toml"))
    problems = {problem.key.replace("[0]", "", problem.key.startswith("excitation")): problem
                for problem in caught.value.problems}  # fmt: skip
    assert key in problems, str(caught.value)
    assert problems[key].file == "ball.toml"
    assert problems[key].line is not None
    assert problems[key].remedy
    for fragment in fragments:
        assert fragment in str(problems[key])


def test_caps_that_touch() -> None:
    other = '\n[[excitation]]\naxis = [0, 0.5, 1]\nhalf_angle = "10 deg"\n'
    text = changed("[excitation]", "[[excitation]]") + other
    with pytest.raises(InvalidCaseError, match=r"touches that of excitation\[0\]"):
        parse_case(text)
    apart = parse_case(text.replace("[0, 0.5, 1]", "[0, 1, 0]"))
    assert [words.kind for words in apart.excitation] == ["pressure", "pressure"]


def test_wrong_case_ends_with_its_exit_code(tmp_path: Path) -> None:
    file = tmp_path / "ball.toml"
    file.write_text(changed("[acoustics]", "[flow]\nspeed = '1 m/s'\n[acoustics]"))
    code, out, _ = command("check", str(file), "--json")
    assert code == ExitCode.CASE_WRONG
    (problem,) = json.loads(out)["problems"]
    assert problem["key"] == "flow"


def test_neither_blade_nor_body() -> None:
    without = "".join(TEXT.partition("[materials")[1:])
    with pytest.raises(InvalidCaseError, match=r"blade: this table is missing.* or \[body\]"):
        parse_case(without)


def test_a_body_is_no_blade(tmp_path: Path) -> None:
    file = tmp_path / "ball.toml"
    file.write_text(TEXT)
    with pytest.raises(InvalidCaseError, match="describes another body than a blade") as caught:
        Case.load(file)
    assert len(caught.value.problems) == 1
    with pytest.raises(InvalidCaseError, match="describes a blade"):
        BodyCase.parse(preset_text("twisted"))
    assert isinstance(load_case(file), BodyCase)
    assert isinstance(parse_case(preset_text("twisted")), Case)


def test_round_trip_and_key() -> None:
    case = BodyCase.parse(TEXT)
    again = BodyCase.from_plain(json.loads(json.dumps(case.plain())))
    assert again == case
    assert again.content_key() == case.content_key()
    assert case.varied({"title": "another"}).content_key() == case.content_key()
    assert case.varied({"body.thickness": "5 cm"}).content_key() == case.content_key()
    assert case.varied({"body.thickness": "51 mm"}).content_key() != case.content_key()
    assert case.acoustics.configurations == ("C0",)
    assert "spherical-shell" in case.card().text()


def test_material_of_the_library() -> None:
    case = BodyCase.parse(TEXT).varied({"body.material": "stainless-steel-316l"})
    notices = examine(case).notices
    assert [notice.where for notice in notices] == ["materials.structural-steel"]
