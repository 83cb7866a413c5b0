# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whatever a file says: a case, or an error of the case with messages; never anything else."""

import re
import tomllib
from collections.abc import Iterator
from math import inf, nan
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from quietblade.case import BodyCase, Case, InvalidCaseError, parse_case
from quietblade.case.materials import OrthotropicWords
from quietblade.case.presets import BLADES, PRESETS, preset_text
from quietblade.case.problems import dotted, literal
from quietblade.cli.common import ExitCode
from tests.case.commands import command

TEXTS = tuple(preset_text(name) for name in PRESETS)
MORE = """
[materials.lay-up]
law = "laminate"
model = "plies"
plies = [{ material = "carbon-epoxy-t300", angle = "45 deg", thickness = "0.5 mm" }]
[materials.rubber]
law = "neo-hookean"
density = "1100 kg/m^3"
shear_modulus = "1.5 MPa"
bulk_modulus = "2 GPa"
[materials.rubber.loss_factor]
model = "maxwell"
strengths = [1]
relaxation_times = ["1 ms"]
temperature = "10 degC"
shift = { law = "wlf", c1 = 8.86, c2 = "101.6 K", reference = "20 degC" }
prestrain = [{ shear = 0.1, factor = 1.2, loss_factor = 0.2 }]
[[loads]]
kind = "gravity"
acceleration = ["0 m/s^2", "-9.81 m/s^2", "0 m/s^2"]
[[loads]]
kind = "line-force"
start = [0.5, 0.5]
end = [0.6, 0.5]
force = ["0 N/m", "1 N/m", "0 N/m"]
[[limits]]
name = "ours"
frequencies = ["100 Hz", "1 kHz"]
levels = ["120 dB", "110 dB"]
[transfer]
functions = ["mobility", "shaft"]
shaft = { translation_damping = ["5 kN*s/m", "5 kN*s/m", "5 kN*s/m"] }
[campbell]
speeds = ["0.4 rad/s", "0.6 rad/s"]
advance = "fixed"
[far_field]
frequencies = ["120 Hz"]
distance = "10 m"
points = [["0 m", "3 m", "0.7 m"]]
"""
MORE_OF_A_BODY = """
[transfer]
functions = ["mobility"]
[[limits]]
name = "ours"
frequencies = ["100 Hz", "1 kHz"]
levels = ["120 dB", "110 dB"]
"""
RICH = (
    *(preset_text(name) + MORE for name in BLADES),
    preset_text("sphere") + MORE_OF_A_BODY,
    preset_text("sphere").replace("[excitation]", "[[excitation]]")
    + '[[excitation]]\nkind = "point-force"\nat = [1, 0, 0]\nforce = "1 N"\n',
)
ODD = (
    nan, inf, -inf, 0, -1, 5e-324, 1e308, 10**400, True, "", "nan m", "1e308 m", "1e400 m",
    "1e-300 m", "90 deg", "1 GHz", "1 K", "-5 %", "\x00", "\u202e", "🦈", "9" * 500, [], {}, [[]],
    [{}], [0, 0], ["1 m", "0 m"], {"s": [0, 1], "values": [0, 0]}, {"formula": "1/s", "unit": "m"},
    {"formula": "1e300*s", "unit": "m"}, {"formula": "sin(1e9*s)"}, "rubber", "lay-up", "file:.",
    "file:no.dat", "momentum", "lifting-line", "random", "elastic", "boundary-layer",
)  # fmt: skip
QUANTITY = re.compile(r"-?[0-9]+(\.[0-9]+)?(e-?[0-9]+)? \S+")
TOKENS = (
    '"', "'", '"""', "[", "]", "[[", "{", "}", "=", ".", ",", "#", "\n", "0", "-1", "1e400", "nan",
    "inf", "true", "1979-05-27", "[1]", "{}", '""', '"0 m"', '"-1 m"', '"1e30 m"', '"5 kg"', '"%"',
    '"1 GPa"', '"1e-6 m"', '"90 deg"', '{ formula = "1/s", unit = "m" }', '{ formula = "s" }',
    '{ values = [1], s = [0] }', "law", "film", "materials", "0.5", "9" * 400, "\\u0000",
    "é", "\x00",
)  # fmt: skip


def assert_case_or_messages(text: str) -> None:
    try:
        parse_case(text, "fuzz.toml").content_key()
    except InvalidCaseError as error:
        assert error.problems
        rows = len(text.split("\n"))
        for problem in error.problems:
            assert problem.message
            assert problem.file == "fuzz.toml"
            assert problem.line is None or 1 <= problem.line <= rows
            assert str(problem).isprintable()


def assert_checked(file: bytes) -> None:
    """The command says what is wrong, or what it has understood; and nothing else happens."""
    with TemporaryDirectory() as folder:
        path = Path(folder, "fuzz.toml")
        path.write_bytes(file)
        code, out, told = command("check", str(path))
    if code == ExitCode.DONE:
        assert "Blade" in out or "Body" in out
    else:
        assert (code, out) == (ExitCode.CASE_WRONG, "")
        rows = told.splitlines()
        assert all(row.startswith("error ") for row in rows[0 if len(rows) == 1 else 1 :])


@st.composite
def mutated(draw: st.DrawFn) -> str:
    """A preset with a few slips of a few kinds."""
    text = draw(st.sampled_from(TEXTS))
    for _ in range(draw(st.integers(1, 4))):
        rows = text.split("\n")
        at = draw(st.integers(0, len(rows) - 1))
        token = draw(st.one_of(st.sampled_from(TOKENS), st.text(max_size=4)))
        match draw(st.sampled_from(["drop", "double", "swap", "value", "insert", "cut"])):
            case "drop":
                del rows[at]
            case "double":
                rows.insert(at, rows[at])
            case "swap":
                other = draw(st.integers(0, len(rows) - 1))
                rows[at], rows[other] = rows[other], rows[at]
            case "value":
                rows[at] = rows[at].split("=")[0] + "= " + token
            case "insert":
                column = draw(st.integers(0, len(rows[at])))
                rows[at] = rows[at][:column] + token + rows[at][column:]
            case "cut":
                column = draw(st.integers(0, len(rows[at])))
                rows[at] = rows[at][:column]
        text = "\n".join(rows)
    return text


@settings(max_examples=400, deadline=None)
@given(mutated())
def test_slips(text: str) -> None:
    assert_case_or_messages(text)


@settings(max_examples=60, deadline=None)
@given(mutated())
def test_slips_on_the_command_line(text: str) -> None:
    assert_checked(text.encode("utf-8", "surrogatepass"))


@settings(max_examples=60, deadline=None)
@given(st.sampled_from(TEXTS), st.binary(max_size=12), st.integers(0, 4000), st.booleans())
def test_any_bytes_on_the_command_line(text: str, more: bytes, at: int, cut: bool) -> None:
    whole = text.encode()
    assert_checked(more if at == 0 else whole[:at] + more + (b"" if cut else whole[at:]))


def places(value: Any, path: tuple[str | int, ...] = ()) -> Iterator[tuple[str | int, ...]]:
    """Every key and entry of a case's data."""
    entries = value.items() if isinstance(value, dict) else enumerate(value)
    for key, inner in entries:
        yield (*path, key)
        if isinstance(inner, dict | list):
            yield from places(inner, (*path, key))


@st.composite
def with_odd_values(draw: st.DrawFn) -> str:
    """A case that says much, with a few values of the wrong type, size or unit, or left out."""
    data = tomllib.loads(draw(st.sampled_from(RICH)))
    for _ in range(draw(st.integers(1, 3))):
        *tables, last = draw(st.sampled_from([p for p in places(data) if len(p) > 1]))
        table: Any = data
        for key in tables:
            table = table[key]
        value = draw(st.one_of(st.sampled_from(ODD), st.floats(), st.integers(), st.text()))
        scale = draw(st.sampled_from([None, -1.0, 0.0, 1e-3, 0.1, 0.5, 2.0, 10.0, 1e3]))
        match table[last]:
            case str(text) if scale is not None and QUANTITY.fullmatch(text):
                number, unit = text.split(" ", 1)
                table[last] = f"{float(number) * scale:g} {unit}"
            case float(number) if scale is not None:
                table[last] = number * scale
            case _ if scale == -1.0:
                del table[last]
            case _:
                table[last] = value
    return "".join(f"{dotted((key,))} = {literal(value)}\n" for key, value in data.items())


@settings(max_examples=60, deadline=None)
@given(with_odd_values())
def test_odd_values_on_the_command_line(text: str) -> None:
    assert_checked(text.encode("utf-8", "surrogatepass"))


plain = st.recursive(
    st.one_of(
        st.none(), st.booleans(), st.integers(), st.floats(), st.sampled_from(TOKENS), st.text()
    ),
    lambda inner: st.one_of(
        st.lists(inner, max_size=3),
        st.dictionaries(st.sampled_from(["s", "values", "formula", "law", "E"]), inner, max_size=3),
    ),
    max_leaves=6,
)
keys = st.sampled_from(
    [
        (table, key)
        for table, info in Case.model_fields.items()
        for key in getattr(info.annotation, "model_fields", {"": None})
    ]
)
SI = Case.parse(TEXTS[1]).plain()


@settings(max_examples=300, deadline=None)
@given(keys, plain)
def test_any_value_at_any_key(key: tuple[str, str], value: Any) -> None:
    table, name = key
    data = SI | {table: (SI.get(table, {}) | {name: value}) if name else value}
    try:
        Case.from_plain(data, "fuzz.toml")
    except InvalidCaseError as error:
        assert all(problem.message for problem in error.problems)


SPHERE = BodyCase.parse(preset_text("sphere")).plain()
keys_of_a_body = st.sampled_from(
    [
        (table, key)
        for table, info in BodyCase.model_fields.items()
        for key in getattr(info.annotation, "model_fields", {"": None})
    ]
)


@settings(max_examples=150, deadline=None)
@given(keys_of_a_body, plain)
def test_any_value_at_any_key_of_a_body(key: tuple[str, str], value: Any) -> None:
    table, name = key
    inner = SPHERE.get(table, {}) if table != "excitation" else {}
    data = SPHERE | {table: (inner | {name: value}) if name else value}
    try:
        BodyCase.from_plain(data, "fuzz.toml")
    except InvalidCaseError as error:
        assert all(problem.message for problem in error.problems)


moduli = st.floats(1e8, 1e12)
ratios = st.floats(-1.5, 1.5)


@settings(max_examples=200, deadline=None)
@given(st.tuples(moduli, moduli, moduli), st.tuples(ratios, ratios, ratios))
def test_stiffness_is_refused_exactly_if_it_is_indefinite(
    e: tuple[float, float, float], nu: tuple[float, float, float]
) -> None:
    scaled = np.eye(3)
    for (i, j), ratio in zip(((0, 1), (1, 2), (0, 2)), nu, strict=True):
        scaled[i, j] = scaled[j, i] = -ratio * np.sqrt(e[j] / e[i])
    least = float(np.linalg.eigvalsh(scaled)[0])
    if abs(least) < 1e-9:
        return  # on the border, where rounding decides
    data = {
        "law": "orthotropic", "density": 1500.0, "E1": e[0], "E2": e[1], "E3": e[2],
        "G12": 1e9, "G23": 1e9, "G13": 1e9, "nu12": nu[0], "nu23": nu[1], "nu13": nu[2],
    }  # fmt: skip
    if least > 0.0:
        OrthotropicWords.model_validate(data, context={"si": True})
    else:
        with pytest.raises(ValueError, match="not positive definite"):
            OrthotropicWords.model_validate(data, context={"si": True})
