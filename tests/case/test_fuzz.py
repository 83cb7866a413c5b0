# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whatever a file says: a case, or an error of the case with messages; never anything else."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from quietblade.case import Case, InvalidCaseError
from quietblade.case.materials import OrthotropicWords
from quietblade.case.presets import PRESETS, preset_text
from quietblade.study.preflight import preflight

TEXTS = tuple(preset_text(name) for name in PRESETS)
TOKENS = (
    '"', "'", '"""', "[", "]", "[[", "{", "}", "=", ".", ",", "#", "\n", "0", "-1", "1e400", "nan",
    "inf", "true", "1979-05-27", "[1]", "{}", '""', '"0 m"', '"-1 m"', '"1e30 m"', '"5 kg"', '"%"',
    '"1 GPa"', '"1e-6 m"', '"90 deg"', '{ formula = "1/s", unit = "m" }', '{ formula = "s" }',
    '{ values = [1], s = [0] }', "law", "film", "materials", "0.5", "9" * 400, "\\u0000",
    "é", "\x00",
)  # fmt: skip


def assert_case_or_messages(text: str, *, with_geometry: bool) -> None:
    try:
        case = Case.parse(text, "fuzz.toml")
        case.content_key()
        if with_geometry:
            preflight(case)
    except InvalidCaseError as error:
        assert error.problems
        rows = len(text.split("\n"))
        for problem in error.problems:
            assert problem.message
            assert problem.file == "fuzz.toml"
            assert problem.line is None or 1 <= problem.line <= rows
            assert "\n" not in str(problem)


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
    assert_case_or_messages(text, with_geometry=False)


@settings(max_examples=60, deadline=None)
@given(mutated())
def test_slips_as_far_as_the_geometry(text: str) -> None:
    assert_case_or_messages(text, with_geometry=True)


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
