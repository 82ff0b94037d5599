"""Lanes: several neighbours side by side in one register, with the operators of plain numbers.

A formula of an effect is written for numbers and compiled for lanes, so that the vector width
does not hang on what LLVM makes of a loop.  In plain Python (``NUMBA_DISABLE_JIT``) a lane is a
number and everything below works on one neighbour.
"""

import math
import operator

import numpy as np
from llvmlite import ir
from numba.core import cgutils, types
from numba.core.typing.templates import AbstractTemplate, infer_global, signature
from numba.extending import intrinsic, lower_builtin, models, register_model

from psph.engine.jit import overload, register_bits, tuple_of, unrolled

WIDTH = register_bits() // 64
"""Doubles of a register."""

EIGHT = 8
"""Lanes in single precision, on any processor."""


class Lanes(types.Type):
    """The numba type of ``width`` numbers of the type ``element``."""

    def __init__(self, element, width: int):
        self.element, self.width = element, width
        super().__init__(f"Lanes({element}, {width})")


class Mask(types.Type):
    """The numba type of a comparison of lanes."""

    def __init__(self, lanes: Lanes):
        self.lanes, self.width = lanes, lanes.width
        super().__init__(f"Mask({lanes})")


def lanes_of(element) -> Lanes:
    """The lanes that numbers of a numba type are worked on in."""
    return Lanes(element, WIDTH if element == types.float64 else EIGHT)


@register_model(Lanes)
class _LanesModel(models.PrimitiveModel):
    def __init__(self, manager, kind):
        element = manager.lookup(kind.element).get_value_type()
        super().__init__(manager, kind, ir.VectorType(element, kind.width))


@register_model(Mask)
class _MaskModel(models.PrimitiveModel):
    def __init__(self, manager, kind):
        super().__init__(manager, kind, ir.VectorType(ir.IntType(1), kind.width))


def spread_number(builder, number, width: int):
    """LLVM code for one number in all lanes."""
    nothing = ir.Constant(ir.VectorType(number.type, width), ir.Undefined)
    one = builder.insert_element(nothing, number, ir.IntType(32)(0))
    zeros = ir.Constant(ir.VectorType(ir.IntType(32), width), [0] * width)
    return builder.shuffle_vector(one, nothing, zeros)


def _as_lanes(builder, signature_, args):
    """The arguments with every number spread over the lanes."""
    width = next(kind.width for kind in signature_.args if isinstance(kind, Lanes))
    return [
        x if isinstance(kind, (Lanes, Mask)) else spread_number(builder, x, width)
        for x, kind in zip(args, signature_.args)
    ]


def _give(function, result, build, count: int = 2) -> None:
    """Let ``function`` of numbers take lanes: ``result`` of its type, ``build`` its code."""

    class Typed(AbstractTemplate):
        def generic(self, args, keywords):
            lanes = next((a for a in args if isinstance(a, Lanes)), None)
            if lanes is None or len(args) != count:
                return None
            if any(a != lanes and not isinstance(a, types.Number) for a in args):
                return None
            kinds = [lanes if a == lanes else lanes.element for a in args]
            return signature(result(lanes), *kinds)

    infer_global(function)(Typed)

    def lower(context, builder, sig, args):
        return build(builder, *_as_lanes(builder, sig, args))

    for where_lanes in range(1, 1 << count):
        kinds = [Lanes if where_lanes >> t & 1 else types.Float for t in range(count)]
        lower_builtin(function, *kinds)(lower)


def _itself(lanes):
    return lanes


def _llvm(name: str):
    """Code that calls an LLVM intrinsic."""

    def build(builder, *args):
        kind = args[0].type
        full_name = f"llvm.{name}.v{kind.count}{kind.element.intrinsic_name}"
        call = cgutils.get_or_insert_function(
            builder.module, ir.FunctionType(kind, [kind] * len(args)), full_name
        )
        return builder.call(call, args)

    return build


def _comparison(symbol: str):
    return lambda builder, a, b: builder.fcmp_ordered(symbol, a, b)


def _chosen(symbol: str):
    """The smaller or larger of two as one instruction."""
    return lambda builder, a, b: builder.select(builder.fcmp_ordered(symbol, a, b), a, b)


for _functions, _code in (
    ((operator.add, operator.iadd), lambda builder, a, b: builder.fadd(a, b)),
    ((operator.sub, operator.isub), lambda builder, a, b: builder.fsub(a, b)),
    ((operator.mul, operator.imul), lambda builder, a, b: builder.fmul(a, b)),
    ((operator.truediv, operator.itruediv), lambda builder, a, b: builder.fdiv(a, b)),
    ((max,), _chosen(">")),
    ((min,), _chosen("<")),
):
    for _function in _functions:
        _give(_function, _itself, _code)
for _function, _symbol in (
    (operator.lt, "<"),
    (operator.le, "<="),
    (operator.gt, ">"),
    (operator.ge, ">="),
):
    _give(_function, Mask, _comparison(_symbol))
for _function, _name in (
    (math.sqrt, "sqrt"),
    (np.sqrt, "sqrt"),
    (math.exp, "exp"),
    (np.exp, "exp"),
    (abs, "fabs"),
    (round, "rint"),
):
    _give(_function, _itself, _llvm(_name), 1)
_give(operator.neg, _itself, lambda builder, a: builder.fneg(a), 1)
_give(operator.pos, _itself, lambda builder, a: a, 1)


@infer_global(operator.pow)
class _Power(AbstractTemplate):
    prefer_literal = True

    def generic(self, args, keywords):
        base, exponent = args
        if isinstance(base, Lanes) and isinstance(exponent, types.IntegerLiteral):
            return signature(base, base, exponent)
        return None


@lower_builtin(operator.pow, Lanes, types.IntegerLiteral)
def _power(context, builder, sig, args):
    """A whole power above zero by squaring."""
    square, product, left = args[0], None, sig.args[1].literal_value
    while left:
        if left & 1:
            product = square if product is None else builder.fmul(product, square)
        left >>= 1
        if left:
            square = builder.fmul(square, square)
    return product


def where(condition, a, b):
    """a where the condition holds, else b: a choice without a branch."""
    return a if condition else b


@overload(where)
def _where(condition, a, b):
    if isinstance(condition, Mask) or isinstance(a, Lanes) or isinstance(b, Lanes):
        return lambda condition, a, b: _select(condition, a, b)
    return lambda condition, a, b: a if condition else b


@intrinsic
def _select(typing, condition, a, b):
    lanes = next(k for k in (getattr(condition, "lanes", None), a, b) if isinstance(k, Lanes))
    kinds = [lanes if kind == lanes else lanes.element for kind in (a, b)]

    def build(context, builder, sig, args):
        chosen, *values = args
        values = [
            x if isinstance(kind, Lanes) else spread_number(builder, x, lanes.width)
            for x, kind in zip(values, sig.args[1:])
        ]
        return builder.select(chosen, *values)

    return lanes(condition, *kinds), build


def spread(value, table):
    """The same number, or each number of a tuple, in all lanes of the records in ``table``."""
    return value


@overload(spread)
def _typedspread_number(value, table):
    if isinstance(value, types.BaseTuple):
        parts = (f"spread(value[{d}], table)" for d in range(len(value)))
        return unrolled("value, table", f"return {tuple_of(parts)}", spread=spread)
    return lambda value, table: _spread_number(value, table)


@intrinsic
def _spread_number(typing, value, table):
    lanes = lanes_of(table.dtype)

    def build(context, builder, sig, args):
        number = context.cast(builder, args[0], types.float64, lanes.element)
        return spread_number(builder, number, lanes.width)

    return lanes(types.float64, table), build


def width_of(table) -> int:
    """Neighbours that are worked on at once when their records stand in ``table``."""
    return 1


@overload(width_of)
def _typed_width_of(table):
    width = lanes_of(table.dtype).width
    return lambda table: np.uint64(width)
