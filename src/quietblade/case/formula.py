# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which formulas of the span fraction a case file may contain."""

import ast
from collections.abc import Mapping
from types import MappingProxyType

ARGUMENTS: Mapping[str, int] = MappingProxyType(
    {
        "sin": 1,
        "cos": 1,
        "atan": 1,
        "sqrt": 1,
        "exp": 1,
        "abs": 1,
        "minimum": 2,
        "maximum": 2,
    }
)
"""Functions and how many arguments they take."""

NAMES = ("s", "pi")
"""The span fraction, and the number."""

_OPERATORS = (ast.Add, ast.Sub, ast.Mult, ast.Div, ast.Pow)
_SIGNS = (ast.UAdd, ast.USub)
_LONGEST = 300
_LARGEST = 1e100


def formula_fault(text: str) -> str:
    """Say why a text is not a formula; empty if it is one."""
    if len(text) > _LONGEST:
        return f"is longer than {_LONGEST} characters"
    try:
        tree = ast.parse(text, mode="eval").body
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return "is not a formula"
    return _fault(tree)


def _fault(node: ast.expr) -> str:
    inner: list[ast.expr]
    match node:
        case ast.Constant(value=int() | float() as value) if not isinstance(value, bool):
            fault, inner = "" if abs(value) < _LARGEST else "has a number beyond 1e100", []
        case ast.Name(id=name):
            fault, inner = "" if name in NAMES else f"has the unknown name {name}", []
        case ast.UnaryOp(op=op, operand=operand) if isinstance(op, _SIGNS):
            fault, inner = "", [operand]
        case ast.BinOp(left=left, op=op, right=right) if isinstance(op, _OPERATORS):
            fault, inner = "", [left, right]
        case ast.Call(func=ast.Name(id=name), args=inner, keywords=[]):
            fault = _call_fault(name, len(inner))
        case _:
            fault, inner = "has something that a formula may not have", []
    return fault or next(filter(None, map(_fault, inner)), "")


def _call_fault(name: str, count: int) -> str:
    if name not in ARGUMENTS:
        return f"has the unknown function {name}"
    wanted = ARGUMENTS[name]
    return "" if count == wanted else f"gives {name} {count} arguments; it takes {wanted}"


def formula_remedy() -> str:
    """Say what a formula may use."""
    return (
        "A formula may use the span fraction s (0 at the root, 1 at the tip), numbers, pi, "
        f"+ - * / ** ( ) and {', '.join(sorted(ARGUMENTS))}"
    )
