# SPDX-License-Identifier: LGPL-2.1-or-later
"""Quantities along the span: a constant, a table or a formula of the span fraction."""

import ast
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from scipy.interpolate import PchipInterpolator
from simpleeval import InvalidExpression, SimpleEval  # type: ignore[import-untyped]

from quietblade.errors import GeometryError
from quietblade.typing import FloatArray

SpanFunction = Callable[[FloatArray], FloatArray]
"""Span fraction s in [0, 1], any shape -> value in SI units, same shape."""


def _with_arguments(count: int, function: Callable[..., Any]) -> Callable[..., Any]:
    # a bare ufunc would take an output array as a further argument
    def call(*arguments: Any) -> Any:
        if len(arguments) != count:
            raise TypeError(f"{function.__name__}() takes {count} argument(s)")
        return function(*arguments)

    return call


_UNARY: tuple[np.ufunc, ...] = (np.sin, np.cos, np.sqrt, np.exp)
_BINARY: tuple[np.ufunc, ...] = (np.minimum, np.maximum)
_FUNCTIONS = (
    {f.__name__: _with_arguments(1, f) for f in _UNARY}
    | {f.__name__: _with_arguments(2, f) for f in _BINARY}
    | {"abs": _with_arguments(1, np.abs), "atan": _with_arguments(1, np.arctan)}
)
_OPERATORS: dict[type[ast.AST], Callable[..., Any]] = {
    ast.Add: np.add,
    ast.Sub: np.subtract,
    ast.Mult: np.multiply,
    ast.Div: np.divide,
    ast.Pow: np.float_power,
    ast.USub: np.negative,
    ast.UAdd: np.positive,
}
# no attributes, no subscripts: a formula can reach nothing but arithmetic
_NODES = (ast.UnaryOp, ast.BinOp, ast.Call, ast.Name, ast.Constant)
_ALLOWED = (
    "a formula may use the span fraction s (0 at the root, 1 at the tip), numbers, pi, "
    "+ - * / ** ( ) and the functions " + ", ".join(sorted(_FUNCTIONS))
)


@dataclass(frozen=True)
class Constant:
    """The same value at every span fraction."""

    value: float

    def __call__(self, s: FloatArray) -> FloatArray:
        """Return the value in the shape of ``s``."""
        return np.full(np.shape(s), self.value)


@dataclass(frozen=True)
class Table:
    """Values between given stations.

    Attributes
    ----------
    s : tuple of float
        Increasing span fractions, the first 0 and the last 1.
    values : tuple of float
        Values there [SI].
    kind : {"linear", "pchip"}
        Straight lines, or the monotone cubic of Fritsch and Carlson (1980), which does not
        overshoot.
    """

    s: tuple[float, ...]
    values: tuple[float, ...]
    kind: Literal["linear", "pchip"] = "linear"

    def __post_init__(self) -> None:
        s, values = np.array(self.s), np.array(self.values)
        if s.size < 2 or s.size != values.size:
            raise GeometryError(
                f"span table: {s.size} span fractions and {values.size} values; give at least "
                "two of each and as many values as span fractions"
            )
        if not np.all(np.diff(s) > 0.0) or s[0] != 0.0 or s[-1] != 1.0:
            raise GeometryError(
                f"span table: span fractions {list(self.s)} must increase from 0 (root) to 1 (tip)"
            )
        if not np.all(np.isfinite(values)):
            raise GeometryError(f"span table: values {list(self.values)} must be finite")
        if self.kind not in ("linear", "pchip"):
            raise GeometryError(f"span table: kind {self.kind!r}; use 'linear' or 'pchip'")

    def __call__(self, s: FloatArray) -> FloatArray:
        """Interpolate; shape of ``s``."""
        if self.kind == "linear":
            return np.asarray(np.interp(s, self.s, self.values), dtype=np.float64)
        return np.asarray(PchipInterpolator(self.s, self.values)(s), dtype=np.float64)


@dataclass(frozen=True)
class Formula:
    """An expression of the span fraction ``s``, times a factor.

    Attributes
    ----------
    expression : str
        For example ``"0.25 - 0.175*s"``.
    scale : float
        SI value of the expression's unit.
    """

    expression: str
    scale: float = 1.0

    def __post_init__(self) -> None:
        self(np.linspace(0.0, 1.0, 101))

    def __call__(self, s: FloatArray) -> FloatArray:
        """Evaluate; shape of ``s``.

        Raises
        ------
        GeometryError
            The expression cannot be understood, or is not a finite number somewhere.
        """
        evaluator = SimpleEval(
            operators=_OPERATORS, functions=_FUNCTIONS, names={"s": s, "pi": np.pi}
        )
        evaluator.nodes = {node: evaluator.nodes[node] for node in _NODES}
        try:
            tree = ast.parse(self.expression.strip(), mode="eval").body
            with np.errstate(all="ignore"):
                value = self.scale * np.asarray(
                    evaluator.eval(self.expression, previously_parsed=tree), dtype=np.float64
                )
        except (InvalidExpression, SyntaxError, TypeError, ValueError, OverflowError) as error:
            raise GeometryError(
                f"formula {self.expression!r} along the span: {error}; {_ALLOWED}"
            ) from error
        value = np.broadcast_to(value, np.shape(s)).copy()
        bad = ~np.isfinite(value)
        if np.any(bad):
            raise GeometryError(
                f"formula {self.expression!r} along the span is {value[bad][0]} at "
                f"s = {np.asarray(s)[bad][0]:.4g}; it must be finite for s from 0 to 1"
            )
        return value


def constant(value: float) -> Constant:
    """Span function with one value [SI]."""
    return Constant(float(value))


def table(
    s: Sequence[float] | FloatArray,
    values: Sequence[float] | FloatArray,
    kind: Literal["linear", "pchip"] = "linear",
) -> Table:
    """Span function through values [SI] at span fractions 0 ... 1.

    Raises
    ------
    GeometryError
        Span fractions do not increase from 0 to 1, or the lengths differ.
    """
    return Table(tuple(float(x) for x in s), tuple(float(x) for x in values), kind)


def formula(expression: str, scale: float = 1.0) -> Formula:
    """Span function ``scale * expression(s)`` [SI].

    Raises
    ------
    GeometryError
        The message quotes the expression and says what a formula may use.
    """
    return Formula(expression, float(scale))
