# SPDX-License-Identifier: LGPL-2.1-or-later
import numpy as np
import pytest

from quietblade.errors import GeometryError
from quietblade.geometry import constant, formula, table

S = np.linspace(0.0, 1.0, 21).reshape(3, 7)


def test_constant_has_the_shape_of_the_argument() -> None:
    np.testing.assert_array_equal(constant(0.3)(S), np.full((3, 7), 0.3))


def test_linear_table_is_exact_for_a_line() -> None:
    np.testing.assert_allclose(table([0, 0.3, 1], [1, 1.6, 3])(S), 1 + 2 * S, rtol=1e-15)


def test_monotone_table_passes_its_points_and_does_not_overshoot() -> None:
    s, values = [0.0, 0.4, 0.5, 1.0], [0.0, 0.0, 1.0, 1.0]
    smooth = table(s, values, "pchip")
    np.testing.assert_allclose(smooth(np.array(s)), values, atol=1e-15)
    dense = smooth(np.linspace(0, 1, 501))
    assert dense.min() >= 0.0 and dense.max() <= 1.0
    assert np.all(np.diff(dense) >= 0.0)


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        ("0.25 - 0.175*s", 0.25 - 0.175 * S),
        ("sqrt(1 - s**2) * cos(pi*s/2)", np.sqrt(1 - S**2) * np.cos(np.pi * S / 2)),
        ("maximum(minimum(s, 0.6), 0.2)", np.clip(S, 0.2, 0.6)),
        ("-exp(-abs(s)) + sin(s)", -np.exp(-S) + np.sin(S)),
        ("7", np.full_like(S, 7.0)),
    ],
)
def test_formula(expression: str, expected: np.ndarray) -> None:
    np.testing.assert_allclose(formula(expression, scale=1e-3)(S), 1e-3 * expected, rtol=1e-14)


@pytest.mark.parametrize(
    "expression",
    [
        "s.tofile('x')",
        "__import__('os')",
        "s[0]",
        "lambda: s",
        "tan(s)",
        "r",
        "s +",
        "",
        "s; s",
        "sin()",
        "sin(s, s)",
        "sin(s, out=s)",
        "'a'",
        "1" + 400 * "0",
    ],
)
def test_bad_formula_quotes_itself_and_says_what_is_allowed(expression: str) -> None:
    with pytest.raises(GeometryError) as caught:
        formula(expression)
    assert repr(expression) in str(caught.value)
    assert "maximum, minimum, sin, sqrt" in str(caught.value)


@pytest.mark.parametrize(("expression", "place"), [("1/s", "s = 0"), ("sqrt(0.5 - s)", "s = 0.51")])
def test_formula_without_value_says_where(expression: str, place: str) -> None:
    with pytest.raises(GeometryError, match=place):
        formula(expression)


@pytest.mark.parametrize(
    ("s", "values", "kind"),
    [
        ([0, 1], [1, 2, 3], "linear"),
        ([0], [1], "linear"),
        ([0, 0.5], [1, 2], "linear"),
        ([0, 0.7, 0.6, 1], [1, 2, 3, 4], "linear"),
        ([0, 1], [1, np.nan], "linear"),
        ([0, 1], [1, 2], "cubic"),
    ],
)
def test_bad_table(s, values, kind) -> None:
    with pytest.raises(GeometryError, match="span table"):
        table(s, values, kind)


def test_functions_compare_and_show_their_content() -> None:
    assert formula("s", 2.0) == formula("s", 2.0)
    assert hash(table([0, 1], [1, 2])) == hash(table([0, 1], [1, 2]))
    assert "0.25 - s" in repr(formula("0.25 - s"))
