# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a user reads when a case is wrong: file, line, key, value, fault and remedy.

All through the command line: exit code 1, each problem on a line of its own, never a traceback.
"""

import json
import re
from collections.abc import Callable
from pathlib import Path

import pytest

from quietblade.case import Case, InvalidCaseError, Problem
from quietblade.cli.common import ExitCode
from quietblade.study.preflight import preflight
from tests.case.commands import command

CASE = """\
title = "test"
[blade]
hub_radius = "200 mm"
span = "1 m"
chord = { s = [0, 1], values = ["250 mm", "75 mm"] }
thickness = 0.06
material = "woven"
[film]
span = [0.05, 0.95]
chord = [0.15, 0.80]
thickness = "1.5 mm"
material = "viscoelastic-paper"
[materials.woven]
law = "orthotropic"
density = "1500 kg/m^3"
E1 = "65 GPa"
E2 = "65 GPa"
E3 = "10 GPa"
G12 = "5 GPa"
G23 = "3 GPa"
G13 = "3 GPa"
nu12 = 0.04
nu23 = 0.2
nu13 = 0.2
ply_angle = "45 deg"
[flow]
speed = "5 m/s"
rotation = "0.58 rad/s"
[acoustics]
band = ["100 Hz", "200 Hz"]
sphere_radius = "1.3 m"
[excitation]
span = [0.9, 0.96]
chord = [0.3, 0.7]
[mesh]
size = "25 mm"
"""

# (what to replace, by what, key, fragments of the message)
BAD: list[tuple[str, str, str, tuple[str, ...]]] = [
    # unknown and missing keys
    ("thickness = 0.06", "thicknes = 0.06", "blade.thicknes",
     ("unknown key", 'Did you mean "thickness"?')),
    ("[flow]", "[flwo]", "flwo", ("unknown key", 'Did you mean "flow"?')),
    ('size = "25 mm"', 'size = "25 mm"\nspeed = "5 m/s"', "mesh.speed",
     ("unknown key here", "Did you mean flow.speed?")),
    ('size = "25 mm"', 'size = "25 mm"\nqqq = 1', "mesh.qqq", ("Known here: size, water_size",)),
    ('span = "1 m"\n', "", "blade.span", ("is missing", "Distance from the root", 'span = "')),
    ("thickness = 0.06\n", "", "blade.thickness", ("is missing", "thickness = 0.06")),
    ('[mesh]\nsize = "25 mm"\n', "", "mesh", ("table is missing", "Add [mesh] with size")),
    ("[mesh]", "[[mesh]]", "mesh", ("a table is needed",)),
    # units
    ('span = "1 m"', "span = 1", "blade.span",
     ("bare number", "a length with its unit", '"250 mm"')),
    ('span = "1 m"', 'span = "1"', "blade.span", ("has no unit", '"250 mm"')),
    ('span = "1 m"', 'span = "1 kg"', "blade.span", ("a length is needed",)),
    ('span = "1 m"', 'span = "1 m\u202e"', "blade.span", ('"m\\u202e" is not a unit',)),
    ('span = "1 m"', 'span = "1 metr"', "blade.span", ('"metr" is not a known unit',)),
    ('ply_angle = "45 deg"', "ply_angle = 45", "materials.woven.ply_angle",
     ("bare number", "an angle", '"8 deg"')),
    ('rotation = "0.58 rad/s"', 'rotation = "0.58 Hz"', "flow.rotation",
     ("a frequency where an angular speed is needed", '"60 rpm"')),
    ('band = ["100 Hz", "200 Hz"]', 'band = [100, "200 Hz"]', "acoustics.band[0]",
     ("bare number", '"100 Hz"')),
    ('values = ["250 mm", "75 mm"]', 'values = ["250 mm", 0.075]', "blade.chord.values[1]",
     ("bare number",)),
    ('E1 = "65 GPa"', 'E1 = "65 Gpa"', "materials.woven.E1", ('Did you mean "GPa"?',)),
    # span functions
    ('values = ["250 mm", "75 mm"]', 'values = ["250 mm"]', "blade.chord",
     ("2 span fractions and 1 values", "as many values")),
    ("s = [0, 1]", "s = [0, 0.9]", "blade.chord.s", ("do not increase from 0 to 1",)),
    ("s = [0, 1]", 's = [0, 1], interpolation = "cubic"', "blade.chord.interpolation",
     ("not an interpolation", "pchip")),
    ("s = [0, 1]", "s = [0, 1], kind = 1", "blade.chord.kind", ("unknown key", "interpolation")),
    ("thickness = 0.06", 'thickness = { formula = "0.06*z" }', "blade.thickness.formula",
     ("unknown name z", "span fraction s")),
    ("thickness = 0.06", 'thickness = { formula = "tan(s)" }', "blade.thickness.formula",
     ("unknown function tan", "sqrt")),
    ("thickness = 0.06", 'thickness = { formula = "sin(s, s)" }', "blade.thickness.formula",
     ("gives sin 2 arguments; it takes 1",)),
    ("thickness = 0.06", 'thickness = { formula = "0.06 s" }', "blade.thickness.formula",
     ("is not a formula",)),
    ("thickness = 0.06", 'thickness = { formula = "0.06 - 0.1*s" }', "blade.thickness",
     ("-0.04 at span fraction 1", "greater than zero")),
    ("thickness = 0.06", 'thickness = { formula = "0.06 + 0.01/s" }', "blade.thickness.formula",
     ("inf at s = 0", "finite")),
    ("thickness = 0.06", 'thickness = 0.06\nrake = { formula = "0.1*s" }', "blade.rake",
     ("formula has no unit", 'unit = "m"')),
    ("thickness = 0.06", 'thickness = 0.06\nblade_angle = { formula = "8 - 10*s" }',
     "blade.blade_angle", ("formula has no unit", 'unit = "deg"')),
    ("thickness = 0.06", 'thickness = 0.06\nrake = { formula = "s", unit = "s" }',
     "blade.rake.unit", ("a length is needed",)),
    # impossible values
    ("thickness = 0.06", "thickness = -0.06", "blade.thickness", ("greater than zero",)),
    ("thickness = 0.06", "thickness = 0.006", "blade.thickness",
     ("span fraction 0", "above the trailing edge's, 0.006")),
    ('span = "1 m"', 'span = "-1 m"', "blade.span", ("greater than zero",)),
    ('span = "1 m"', 'span = "1 Gm"', "blade.span", ("absurdly large for a length", "unit")),
    ('density = "1500 kg/m^3"', 'density = "0 kg/m^3"', "materials.woven.density",
     ("greater than zero", '"2500 kg/m^3"')),
    ('band = ["100 Hz", "200 Hz"]', 'band = ["200 Hz", "100 Hz"]', "acoustics.band",
     ("reversed", "Swap")),
    ('band = ["100 Hz", "200 Hz"]', 'band = ["200 Hz", "200 Hz"]', "acoustics.band",
     ("is empty", "Widen")),
    ('band = ["100 Hz", "200 Hz"]', 'band = ["200 Hz"]', "acoustics.band",
     ("has 1 entries and needs 2",)),
    ('band = ["100 Hz", "200 Hz"]', 'band = ["100 Hz", "200 Hz"]\nstep = "1 kHz"',
     "acoustics.step", ("wider than the band",)),
    ('band = ["100 Hz", "200 Hz"]', 'band = ["100 Hz", "200 Hz"]\nstep = "0.001 mHz"',
     "acoustics.step", ("absurdly small",)),
    ("chord = [0.3, 0.7]", "chord = [0.3, 1.7]", "excitation.chord[1]",
     ("at most 1", "0 (root, leading edge) to 1 (tip, trailing edge)")),
    ("span = [0.9, 0.96]", "span = [0.96, 0.9]", "excitation.span", ("reversed",)),
    ("span = [0.05, 0.95]", "span = [0, 0.95]", "film.span",
     ("must end inside", "root and tip")),
    # the film
    ('thickness = "1.5 mm"', 'thickness = "3 mm"', "film.thickness",
     ("sticks out", "span fraction 0.95", "chord fraction 0.8", "by 0.243 mm", "Use a film below")),
    ('thickness = "1.5 mm"', 'thickness = "1.5 mm"\nminimum_cover = "1 mm"', "film.thickness",
     ("only 0.507 mm of material remain", "minimum cover of 1 mm")),
    # materials
    ('material = "woven"', 'material = "wovn"', "blade.material",
     ("no material of this name", 'Did you mean "woven"?', "[materials.wovn]")),
    ('material = "viscoelastic-paper"', 'material = "woven"', "film.material",
     ("has the law orthotropic", "mooney-rivlin")),
    ('law = "orthotropic"', 'law = "ortotropic"', "materials.woven.law",
     ("not a material law", '"isotropic", "orthotropic", "mooney-rivlin"')),
    ('law = "orthotropic"\n', "", "materials.woven.law", ("is missing", "Known:")),
    ('law = "orthotropic"', "law = [1]", "materials.woven.law", ("not a material law",)),
    ("[materials.woven]", "[materials.aluminium-paper]", "materials.aluminium-paper",
     ("name of a library material", "Choose another")),
    ("nu13 = 0.2", "nu13 = 0.2\nnu31 = 0.03", "materials.woven.nu31",
     ("both nu13 and nu31", "Give one", "strain j from stress i")),
    ("nu13 = 0.2\n", "", "materials.woven", ("nu13 is missing", "(or nu31)")),
    ("nu12 = 0.04", "nu12 = 1.2", "materials.woven.nu12",
     ("not positive definite", "|nu12| < sqrt(E1 / E2) = 1 fails")),
    ("nu13 = 0.2", "nu31 = 0.5", "materials.woven.nu31",
     ("|nu31| < sqrt(E3 / E1) = 0.3922 fails",)),
    ("nu12 = 0.04\nnu23 = 0.2\nnu13 = 0.2", "nu12 = 0.9\nnu23 = 1.0\nnu13 = 1.0",
     "materials.woven", ("1 - nu12 nu21 - nu23 nu32", "together are too large")),
    # choices
    ('sphere_radius = "1.3 m"', 'sphere_radius = "1.3 m"\nradiation = "bgt3"',
     "acoustics.radiation", ("not a radiation condition", 'Known: "dtn", "bgt1"')),
    ('size = "25 mm"', 'size = "25 mm"\n[solver]\nname = "pardiso"', "solver.name",
     ("is not a solver", 'Known: "auto", "rslab"')),
    ('sphere_radius = "1.3 m"', 'sphere_radius = "1.3 m"\nconfigurations = []',
     "acoustics.configurations", ("1 or more entries",)),
    ('sphere_radius = "1.3 m"', 'sphere_radius = "1.3 m"\nconfigurations = ["C0", "C3"]',
     "acoustics.configurations[1]", ("not a configuration", '"C1"')),
    ('speed = "5 m/s"', 'speed = "5 m/s"\nsections = 40.0', "flow.sections",
     ("whole number", "without quotes")),
    ('speed = "5 m/s"', 'speed = "5 m/s"\nsections = 3', "flow.sections", ("from 5 to 2001",)),
    ('speed = "5 m/s"', 'speed = "5 m/s"\nsection_nodes = 160', "flow.section_nodes",
     ("is even", "161")),
    ('size = "25 mm"', 'size = "25 mm"\n[static]\ntolerance = nan', "static.tolerance",
     ("not a finite number",)),
    ('title = "test"', "title = 3", "title", ("text is needed", "in quotes")),
    # mesh and sphere
    ('size = "25 mm"', 'size = "0 mm"', "mesh.size", ("greater than zero",)),
    ('size = "25 mm"', 'size = "1 m"', "mesh.size", ("too coarse", 'size = "25 mm"')),
    ('size = "25 mm"', 'size = "0.1 mm"', "mesh.size", ("too fine", "triangles")),
    ('size = "25 mm"', 'size = "25 mm"\nwater_size = "1 mm"', "mesh.water_size",
     ("between the size on the surface and the sphere's radius",)),
    ('sphere_radius = "1.3 m"', 'sphere_radius = "0.4 m"', "acoustics.sphere_radius",
     ("out of the sphere", "A radius above")),
    ('sphere_radius = "1.3 m"', 'sphere_radius = "0.53 m"', "acoustics.sphere_radius",
     ("within 14.61 mm of the sphere", "gap is 50 mm", "A radius above 0.5654 m")),
    # format and loads
    ('title = "test"', "format = 99", "format", ("newer quietblade", "pip install --upgrade")),
    ('title = "test"', "format = 0", "format", ("must be from 1",)),
    ("[flow]", '[[loads]]\nkind = "weight"\n[flow]', "loads[0].kind",
     ("not a kind of load", '"gravity"')),
    ("[flow]", '[[loads]]\nkind = "hydrostatic"\ndepth = 3\n[flow]', "loads[0].depth",
     ("bare number", "a length")),
    ("[flow]", '[[loads]]\nkind = "pressure"\n[flow]', "loads[0]", ("either a value or a table",)),
    ("[flow]", '[[loads]]\nkind = "pressure"\ntable = "no.csv"\n[flow]', "loads[0].table",
     ("no.csv not found", "Write the columns span, chord")),
    ("[flow]", '[[loads]]\nkind = "line-force"\nstart = [0.1, 0.5]\nend = [0.1, 0.5]\n'
     'force = ["0 N/m", "1 N/m", "0 N/m"]\n[flow]', "loads[0].end", ("no length",)),
    ("[flow]", '[root]\nsupport = "springs"\n[flow]', "root.support", ('Known: "clamped"',)),
    ("[flow]", '[root]\nsupport = "elastic"\n[flow]', "root", ("needs a stiffness", "MN*m/rad")),
    # laminates and losses
    ('law = "orthotropic"', 'law = "laminate"\nmodel = "plies"\nplies = []\n[materials.spare]\n'
     'law = "orthotropic"', "materials.woven.plies", ("1 or more entries",)),
    ('law = "orthotropic"', 'law = "laminate"\nmodel = "plies"\nplies = [{ material = "spare", '
     'fraction = 0.5, angle = "0 deg" }]\n[materials.spare]\nlaw = "orthotropic"',
     "materials.woven.plies", ("sum to 0.5 and must sum to 1",)),
    ('law = "orthotropic"', 'law = "laminate"\nmodel = "plies"\nplies = [{ material = "glass", '
     'fraction = 1.0, angle = "0 deg" }]\n[materials.spare]\nlaw = "orthotropic"',
     "materials.woven.plies[0].material", ("no material of this name",)),
    ("nu13 = 0.2", 'nu13 = 0.2\nloss_factor = { model = "maxwel" }',
     "materials.woven.loss_factor.model", ('Did you mean "maxwell"?',)),
    ("nu13 = 0.2", "nu13 = 0.2\nloss_factor = -0.1", "materials.woven.loss_factor",
     ("must be from 0 to 10",)),
    ("nu13 = 0.2", 'nu13 = 0.2\nXt = "1 GPa"', "materials.woven.Xt", ("of the five strengths",)),
    # water, operation and what is asked for
    ("[flow]", '[water]\ndensity = "1 g/cm^2"\n[flow]', "water.density", ("a density is needed",)),
    ('speed = "5 m/s"', 'speed = "0 m/s"', "flow.speed", ("greater than zero",)),
    ('speed = "5 m/s"', 'speed = "5 m/s"\ninflow = "bem"', "flow.inflow", ('"momentum"',)),
    ('speed = "5 m/s"', 'speed = "5 m/s"\nwake = { radius = ["1 m", "0.2 m"], axial = [1, 0.8] }',
     "flow.wake.radius", ("do not increase", "Sort")),
    ("span = [0.9, 0.96]", 'kind = "push"\nspan = [0.9, 0.96]', "excitation.kind",
     ("not a kind of excitation", '"point-force"')),
    ('size = "25 mm"', 'size = "25 mm"\n[transfer]\nfunctions = ["mobilty"]',
     "transfer.functions[0]", ('Did you mean "mobility"?',)),
    ('size = "25 mm"', 'size = "25 mm"\n[far_field]\npoints = [["0 m", "0 m", "0.7 m"]]',
     "far_field.points[0]", ("less than a cell",)),
    ('size = "25 mm"', 'size = "25 mm"\n[bands]\nkind = "octave"', "bands.kind",
     ('Did you mean "third-octave"?',)),
    ('size = "25 mm"', 'size = "25 mm"\n[[limits]]\nname = "a"\nfrequencies = ["1 kHz", "10 Hz"]\n'
     'levels = ["90 dB", "80 dB"]', "limits[0].frequencies", ("does not ascend",)),
    ('size = "25 mm"', 'size = "25 mm"\n[campbell]\nspeeds = ["3 rad/s", "2 rad/s"]',
     "campbell.speeds", ("do not increase",)),
]  # fmt: skip


@pytest.fixture(autouse=True)
def _in_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def problems_of(text: str) -> tuple[Problem, ...]:
    """Problems that `check` finds, the same as text for people and as JSON for programs."""
    Path("my.toml").write_text(text, encoding="utf-8")
    code, out, _ = command("check", "my.toml", "--json")
    assert code == ExitCode.CASE_WRONG
    data = json.loads(out)
    assert not data["valid"]
    found = tuple(Problem(**problem) for problem in data["problems"])
    code, out, told = command("check", "my.toml")
    assert (code, out) == (ExitCode.CASE_WRONG, "")
    rows = told.splitlines()[0 if len(found) == 1 else 1 :]  # their number comes first
    assert rows == [f"error {problem}" for problem in found]
    return found


def replaced(old: str, new: str) -> str:
    assert CASE.count(old) == 1, f"{old!r} must stand once in the case"
    return CASE.replace(old, new)


def test_the_good_case_is_good() -> None:
    assert preflight(Case.parse(CASE)).clearance > 0.7


@pytest.mark.parametrize(("old", "new", "key", "fragments"), BAD, ids=[b[1][-40:] for b in BAD])
def test_message(old: str, new: str, key: str, fragments: tuple[str, ...]) -> None:
    text = replaced(old, new)
    problems = problems_of(text)
    found = [problem for problem in problems if problem.key == key]
    assert len(found) == 1, "one message for one problem"
    allowed = 2 if old == "[materials.woven]" else 1  # the name is then missing, too
    assert len(problems) <= allowed, [str(p) for p in problems]
    problem = found[0]
    assert problem.file == "my.toml"
    assert problem.remedy
    for fragment in fragments:
        assert fragment in str(problem)
    assert str(problem).startswith("my.toml:")
    if problem.line is None:
        assert "missing" in problem.message  # there is no line to point at
        return
    row = text.splitlines()[problem.line - 1]
    *table, last = re.sub(r"\[\d\]", "", key).split(".")
    assert last in row or f"[{'.'.join(table)}]" == row or table[-1] in row
    if problem.value and "{" not in problem.value:
        assert problem.value.strip("[]") in row


def test_the_table_speaks_of_every_table_of_the_case() -> None:
    spoken = {re.split(r"[.\[]", key)[0] for _, _, key, _ in BAD}
    assert set(Case.model_fields) <= spoken | {"root"}, "root is told of at what it excludes"


def test_all_problems_at_once_in_the_order_of_the_file() -> None:
    text = CASE
    for old, new in [
        ('hub_radius = "200 mm"', "hub_radius = 200"),
        ('material = "viscoelastic-paper"', 'material = "rubber"'),
        ("nu12 = 0.04", "nu12 = 2.0"),
        ('speed = "5 m/s"', 'sped = "5 m/s"'),
        ('size = "25 mm"', 'size = "-25 mm"'),
    ]:
        text = text.replace(old, new)
    found = problems_of(text)
    assert [p.key for p in found] == [
        "blade.hub_radius", "film.material", "materials.woven.nu12", "flow.sped", "mesh.size",
    ]  # fmt: skip
    lines = [p.line for p in found]
    assert lines == sorted(lines, key=lambda n: n or 0)


def test_several_wrong_formulas_at_once() -> None:
    text = replaced(
        "thickness = 0.06",
        'thickness = { formula = "0.06 - s" }\ncamber = { formula = "1/s" }\n'
        'sweep = { formula = "1e6*s", unit = "m" }',
    )
    assert [p.key for p in problems_of(text)] == [
        "blade.thickness", "blade.camber.formula", "blade.sweep",
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("text", "line", "fragments"),
    [
        ("[blade]\nspan = 1 m\n", 2, ("not valid TOML", 'stands in quotes, as in speed = "5 m/s"')),
        ("[blade]\nspan = 1\nspan = 2\n", 3, ("not valid TOML", "stand only once")),
        ("[blade]\n[flow]\n[blade]\n", 3, ("not valid TOML", "stand only once")),
        ("a = [1, 2\n", 1, ("not valid TOML",)),
        ("\n\n= 3\n", 3, ("not valid TOML", "Look at: = 3")),
        ("a = \x1b[2J 1\n", 1, ("not valid TOML", "Look at: a = \\x1b[2J 1")),
        ("x = " + "9" * 5000, None, ("not valid TOML",)),
        ("x = " + "[" * 5000, None, ("nested too deeply",)),
    ],
)
def test_not_toml(text: str, line: int | None, fragments: tuple[str, ...]) -> None:
    (problem,) = problems_of(text)
    assert problem.line == line
    for fragment in fragments:
        assert fragment in str(problem)


@pytest.mark.parametrize(
    ("make", "fragment"),
    [
        (lambda path: None, "there is no such file. quietblade new NAME writes one"),
        (Path.mkdir, "is a folder. Name the case file in it"),
        (lambda path: path.write_bytes(b"\xff\xfe\x00"), "is not a text file in UTF-8"),
        (lambda path: path.write_text('title = "a"', encoding="utf-16"), "not a text file"),
        (lambda path: path.write_bytes(b"\x89PNG\r\n\x1a\n\x00\x00"), "not a text file"),
        (lambda path: path.write_bytes(b"\x00" * 100), "is not valid TOML"),
        (lambda path: path.write_text(""), "[blade] with hub_radius"),
        (lambda path: path.write_text("{}"), "is not valid TOML"),
        (lambda path: path.write_text("<xml/>"), "is not valid TOML"),
        (lambda path: path.symlink_to(path), "cannot be read: Too many levels"),
    ],
)
def test_no_case_file_at_all(make: Callable[[Path], object], fragment: str) -> None:
    make(Path("my.toml"))
    code, out, told = command("check", "my.toml")
    assert (code, out) == (ExitCode.CASE_WRONG, "")
    assert "error my.toml:" in told
    assert fragment in told


def test_byte_order_mark_is_accepted(tmp_path: Path) -> None:
    path = tmp_path / "case.toml"
    path.write_text(CASE, encoding="utf-8-sig")
    assert Case.load(path) == Case.parse(CASE)


def test_problem_as_data() -> None:
    (problem,) = problems_of(replaced('span = "1 m"', "span = 1"))
    data = problem.as_dict()
    assert (data["file"], data["line"], data["key"], data["value"]) == (
        "my.toml", 4, "blade.span", "1",
    )  # fmt: skip


def test_varied_case_points_at_lines_only_where_the_file_still_says_it() -> None:
    case = Case.parse(CASE, "my.toml")
    with pytest.raises(InvalidCaseError) as caught:
        case.varied({"mesh.size": 25, "flow.depth": "3 kg"})
    first, second = caught.value.problems
    assert (first.key, first.line) == ("flow.depth", 26)  # the line of its table
    assert (second.key, second.line) == ("mesh.size", 35)
