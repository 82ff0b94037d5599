"""Formulas of place in a case, such as ``1 + 0.1 * sin(2 * pi * x)``: a text that is read, not executed."""

import ast
import math
import operator
from collections.abc import Callable, Iterator
from functools import cache
from typing import Annotated, Any

import numpy as np
from pydantic import AfterValidator
from pydantic_core import PydanticCustomError

from psph.case.errors import advise
from psph.case.keys import AXES

LONGEST = 1000
"""Characters of a formula."""

LARGEST = 1e30
"""Numbers in it are smaller."""

RADIUS = "r"
"""The distance from the middle, m."""

FUNCTIONS: dict[str, tuple[Callable[..., Any], int]] = {
    name: (getattr(np, name), 1) for name in ("sin", "cos", "tan", "tanh", "exp", "log", "sqrt", "abs")
} | {"min": (np.minimum, 2), "max": (np.maximum, 2), "atan2": (np.arctan2, 2)}
"""Functions that a formula may call, with how many numbers each takes."""

OPERATORS: dict[type, Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: np.divide,
    ast.Pow: np.power,
    ast.Mod: np.mod,
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
}

KNOWN = (*AXES, RADIUS, "pi")


def _read(text: str) -> str:
    if len(text) > LONGEST:
        raise PydanticCustomError("psph", f"longer than {LONGEST} characters; give a shorter formula")
    if wrong := next(_wrong(text), ""):
        raise PydanticCustomError("psph", "{says}", {"says": wrong})
    return text


Formula = Annotated[str, AfterValidator(_read)]
"""A formula in x, y, z and r, as a case has it."""


def names_in(value: Any) -> set[str]:
    """The coordinates that a formula names; none of a number."""
    if not isinstance(value, str):
        return set()
    return {node.id for node in ast.walk(_tree(value)) if isinstance(node, ast.Name)} & {*AXES, RADIUS}


def at_places(value: Any, x: np.ndarray, middle: Any) -> np.ndarray:
    """A number, or a formula, at the places ``x`` (n, dim) m: (n,); r is the distance from the ``middle``.

    What has no value there is NaN or infinite.
    """
    if not isinstance(value, str):
        return np.full(len(x), float(value))
    known: dict[str, Any] = {axis: np.ascontiguousarray(along) for axis, along in zip(AXES, x.T)}
    known[RADIUS] = np.sqrt(sum((known[axis] - m) ** 2 for axis, m in zip(AXES, middle) if axis in known))
    with np.errstate(all="ignore"):
        found = _value(_tree(value).body, known | {"pi": math.pi})
    return np.broadcast_to(np.asarray(found, float), (len(x),)).copy()


@cache
def _tree(text: str) -> ast.Expression:
    return ast.parse(text.strip(), mode="eval")


def _wrong(text: str) -> Iterator[str]:
    """Why a text is no formula, with a cure."""
    try:
        tree = _tree(text)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        yield "is no formula; give one such as 1 + 0.1 * sin(2 * pi * x)"
        return
    called = {id(node.func) for node in ast.walk(tree) if isinstance(node, ast.Call)}
    for node in ast.walk(tree):
        match node:
            case ast.Call(func=ast.Name(id=name), args=args, keywords=[]):
                if name not in FUNCTIONS:
                    yield f"no function '{name}'; {advise(name, FUNCTIONS)}"
                elif len(args) != (count := FUNCTIONS[name][1]):
                    yield f"'{name}' has {len(args)} numbers in its brackets; give {count}"
            case ast.Name(id=name) if id(node) not in called and name not in KNOWN:
                yield f"no coordinate '{name}'; {advise(name, KNOWN)}"
            case ast.Constant(value=value) if type(value) not in (int, float) or not abs(value) < LARGEST:
                yield "holds what is no number; give numbers"
            case ast.Compare(ops=ops) if len(ops) > 1:
                yield "compares more than two numbers; write 'a if b < c else d'"
            case _ if not isinstance(node, ALLOWED):
                yield "has what no formula has; use + - * / ** % ( ), functions, and 'a if b < c else d'"


ALLOWED = (
    *(ast.Expression, ast.BinOp, ast.UnaryOp, ast.UAdd, ast.USub, ast.Call, ast.Name, ast.Load),
    *(ast.Constant, ast.IfExp, ast.Compare, *OPERATORS),
)
"""What a formula is made of."""


def _value(node: ast.AST, known: dict[str, Any]) -> Any:
    """The numbers that a part of a formula stands for."""
    match node:
        case ast.BinOp(left=left, op=op, right=right) | ast.Compare(left=left, ops=[op], comparators=[right]):
            return OPERATORS[type(op)](_value(left, known), _value(right, known))
        case ast.UnaryOp(op=op, operand=operand):
            own = _value(operand, known)
            return -own if isinstance(op, ast.USub) else own
        case ast.Call(func=ast.Name(id=name), args=args):
            return FUNCTIONS[name][0](*(_value(one, known) for one in args))
        case ast.IfExp(test=test, body=body, orelse=orelse):
            return np.where(*(_value(one, known) for one in (test, body, orelse)))
        case ast.Name(id=name):
            return known[name]
        case ast.Constant(value=value):
            return float(value)
    raise TypeError(f"{type(node).__name__} is no part of a formula")
