"""Formulas of responses: arithmetic on named numbers, and nothing else.

A formula is read as a Python expression of which only numbers, names, ``+ - * / **``, signs and the functions
below are permitted.  It is evaluated on arrays, one value per row.
"""

from __future__ import annotations

import ast
import operator
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from crumple.errors import InputError, Problem
from crumple.numeric.arrays import Floats

LONGEST = 500
"""Characters of a formula."""
_OPERATORS: dict[type[ast.AST], Callable[..., Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: np.divide,
    ast.Pow: np.power,
    ast.USub: operator.neg,
    ast.UAdd: operator.pos,
}
FUNCTIONS: dict[str, tuple[int, Callable[..., Any]]] = {
    "abs": (1, np.abs),
    "sqrt": (1, np.sqrt),
    "exp": (1, np.exp),
    "log": (1, np.log),
    "min": (2, np.minimum),
    "max": (2, np.maximum),
}
"""Number of arguments, and the function."""


class Formula:
    """A formula that was read and found sound.

    Parameters
    ----------
    text
        As written, for example ``rotation / 0.35 - 1``; quantities in it are SI.

    Raises
    ------
    InputError
        If it is not a formula of the permitted kind.
    """

    def __init__(self, text: str) -> None:
        self.text = text
        try:
            if len(text) > LONGEST:
                raise SyntaxError("it is too long")
            self._body = ast.parse(text.strip(), mode="eval").body
            self.names = frozenset(_names(self._body))
        except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
            raise _refusal(text, str(getattr(error, "msg", error))) from None

    def __call__(self, values: Mapping[str, Floats]) -> Floats:
        """Value per row, (n,); not a number where it is not defined."""
        with np.errstate(all="ignore"):
            return np.asarray(_value(self._body, values), float)


def _names(node: ast.AST) -> set[str]:
    """Names in a formula; raises SyntaxError at anything that is not permitted."""
    match node:
        case ast.Constant(value=int() | float() as value) if not isinstance(value, bool):
            return set()
        case ast.Name(id=name):
            return {name}
        case ast.UnaryOp(op=op, operand=inner) if type(op) in _OPERATORS:
            return _names(inner)
        case ast.BinOp(left=left, op=op, right=right) if type(op) in _OPERATORS:
            return _names(left) | _names(right)
        case ast.Call(func=ast.Name(id=name), args=args, keywords=[]) if name in FUNCTIONS:
            if len(args) != FUNCTIONS[name][0]:
                raise SyntaxError(f"{name} has {FUNCTIONS[name][0]} arguments")
            return set().union(*map(_names, args))
    raise SyntaxError("it contains something that is not permitted")


def _value(node: ast.AST, values: Mapping[str, Floats]) -> Any:
    match node:
        case ast.Constant(value=value):
            return np.float64(value)  # type: ignore[arg-type]  # a number, see `_names`
        case ast.Name(id=name):
            return values[name]
        case ast.UnaryOp(op=op, operand=inner):
            return _OPERATORS[type(op)](_value(inner, values))
        case ast.BinOp(left=left, op=op, right=right):
            return _OPERATORS[type(op)](_value(left, values), _value(right, values))
        case ast.Call(func=ast.Name(id=name), args=args):
            return FUNCTIONS[name][1](*(_value(inner, values) for inner in args))
    raise AssertionError(node)


def _refusal(text: str, reason: str) -> InputError:
    allowed = f"numbers, names, + - * / **, brackets, and {', '.join(FUNCTIONS)}"
    what, todo = (
        f"this is not a formula: {reason}",
        "correct it; the names are those of variables and responses",
    )
    return InputError(Problem(what, text[:60], allowed, todo))
