"""Lanes: several neighbours side by side in one register, with the operators of plain numbers.

A formula of an effect is written for numbers and compiled for lanes, so that the vector width
does not hang on what LLVM makes of a loop.  In plain Python (``NUMBA_DISABLE_JIT``) a lane is a
number and everything below works on one neighbour.
"""

import math
import operator

import numba
from llvmlite import ir
from numba.core import cgutils, types
from numba.core.typing.templates import AbstractTemplate, infer_global, signature
from numba.extending import (
    intrinsic, lower_builtin, models, overload, register_jitable, register_model,
)

from psph.jit import register_bits

WIDTH = 1 if numba.config.DISABLE_JIT else register_bits() // 64
"""Doubles of a register."""


class Lanes(types.Type):
    """The numba type of ``width`` numbers of the type ``element``."""

    def __init__(self, element, width: int):
        self.element, self.width = element, width
        super().__init__(f"Lanes({element}, {width})")


class Mask(types.Type):
    """The numba type of a comparison of lanes."""

    def __init__(self, width: int):
        self.width = width
        super().__init__(f"Mask({width})")


DOUBLES = Lanes(types.float64, WIDTH)


@register_model(Lanes)
class _LanesModel(models.PrimitiveModel):
    def __init__(self, manager, kind):
        element = manager.lookup(kind.element).get_value_type()
        super().__init__(manager, kind, ir.VectorType(element, kind.width))


@register_model(Mask)
class _MaskModel(models.PrimitiveModel):
    def __init__(self, manager, kind):
        super().__init__(manager, kind, ir.VectorType(ir.IntType(1), kind.width))


def _spread(builder, number, width: int):
    """One number in all lanes."""
    nothing = ir.Constant(ir.VectorType(number.type, width), ir.Undefined)
    one = builder.insert_element(nothing, number, ir.IntType(32)(0))
    zeros = ir.Constant(ir.VectorType(ir.IntType(32), width), [0] * width)
    return builder.shuffle_vector(one, nothing, zeros)


def _as_lanes(builder, signature_, args):
    """The arguments with every number spread over the lanes."""
    width = next(kind.width for kind in signature_.args if isinstance(kind, Lanes))
    return [
        x if isinstance(kind, (Lanes, Mask)) else _spread(builder, x, width)
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


def _mask(lanes):
    return Mask(lanes.width)


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
    (operator.lt, "<"), (operator.le, "<="), (operator.gt, ">"), (operator.ge, ">="),
):
    _give(_function, _mask, _comparison(_symbol))
for _function, _name in ((math.sqrt, "sqrt"), (math.exp, "exp"), (abs, "fabs"), (round, "rint")):
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
    if isinstance(condition, Mask):
        return lambda condition, a, b: _select(condition, a, b)
    return lambda condition, a, b: a if condition else b


@intrinsic
def _select(typing, condition, a, b):
    lanes = next((kind for kind in (a, b) if isinstance(kind, Lanes)), None)
    lanes = lanes or Lanes(types.float64, condition.width)
    kinds = [lanes if kind == lanes else lanes.element for kind in (a, b)]

    def build(context, builder, sig, args):
        chosen, *values = args
        values = [
            x if isinstance(kind, Lanes) else _spread(builder, x, lanes.width)
            for x, kind in zip(values, sig.args[1:])
        ]
        return builder.select(chosen, *values)

    return lanes(condition, *kinds), build


def spread(value):
    """The same number, or each number of a tuple, in all lanes."""
    return value


@overload(spread)
def _typed_spread(value):
    if isinstance(value, types.BaseTuple):
        if len(value) == 0:
            return lambda value: ()
        return lambda value: (spread(value[0]),) + spread(value[1:])
    return lambda value: _spread_number(value)


@intrinsic
def _spread_number(typing, value):
    def build(context, builder, sig, args):
        return _spread(builder, args[0], WIDTH)

    return DOUBLES(types.float64), build


EIGHT = 8
"""Entries that ``consecutive`` loads."""


@intrinsic
def consecutive(typing, array, first):
    """The entries ``first`` to ``first + 8`` of an array."""
    lanes = Lanes(array.dtype, EIGHT)

    def build(context, builder, sig, args):
        data = context.make_array(sig.args[0])(context, builder, args[0]).data
        kind = context.get_value_type(lanes)
        place = builder.bitcast(builder.gep(data, [args[1]]), kind.as_pointer())
        value = builder.load(place)
        value.align = array.dtype.bitwidth // 8
        return value

    return lanes(array, types.uint64), build


@intrinsic
def bits(typing, mask):
    """A comparison of lanes as the bits of a number, the first lane lowest."""

    def build(context, builder, sig, args):
        whole = builder.bitcast(args[0], ir.IntType(mask.width))
        return builder.zext(whole, ir.IntType(64))

    return types.uint64(mask), build


GROUP = 4
"""Numbers of a record that are loaded and turned at once."""


def turning(count: int):
    """A compiled function ``(table, lists, entry)`` that gives records as a tuple of lanes.

    ``table`` (records, width), width the next multiple of ``GROUP`` from ``count``.  Lane t of
    number f is ``table[lists[entry + t], f]``.  Loading records whole and transposing them in
    registers takes a quarter of the loads that one array a quantity would.
    """

    @intrinsic
    def turn(typing, table, lists, entry):
        lanes = Lanes(table.dtype, WIDTH)

        def build(context, builder, sig, args):
            records, listed = (
                context.make_array(kind)(context, builder, value).data
                for kind, value in zip(sig.args[:2], args[:2])
            )
            integer = ir.IntType(64)
            places = []
            for t in range(lanes.width):
                at = builder.gep(listed, [builder.add(args[2], integer(t))])
                j = builder.zext(builder.load(at), integer)
                width = -(-count // GROUP) * GROUP
                places.append(builder.gep(records, [builder.mul(j, integer(width))]))
            found = []
            for first in range(0, count, GROUP):
                found += _transposed(builder, places, first)
            return context.make_tuple(builder, sig.return_type, found[:count])

        return types.UniTuple(lanes, count)(table, lists, types.uint64), build

    return turn


def _transposed(builder, places, first: int):
    """Lanes of the numbers ``first`` to ``first + 4`` of the records at ``places``."""

    def mix(a, b, picks):
        order = ir.Constant(ir.VectorType(ir.IntType(32), len(picks)), picks)
        return builder.shuffle_vector(a, b, order)

    def load(place):
        group = ir.VectorType(place.type.pointee, GROUP)
        at = builder.gep(place, [ir.IntType(64)(first)])
        value = builder.load(builder.bitcast(at, group.as_pointer()))
        value.align = 8
        return value

    squares = []
    for t in range(0, len(places), GROUP):
        a, b, c, d = map(load, places[t : t + GROUP])
        ab_even, ab_odd = mix(a, b, [0, 4, 2, 6]), mix(a, b, [1, 5, 3, 7])
        cd_even, cd_odd = mix(c, d, [0, 4, 2, 6]), mix(c, d, [1, 5, 3, 7])
        squares.append(
            [
                mix(ab_even, cd_even, [0, 1, 4, 5]), mix(ab_odd, cd_odd, [0, 1, 4, 5]),
                mix(ab_even, cd_even, [2, 3, 6, 7]), mix(ab_odd, cd_odd, [2, 3, 6, 7]),
            ]
        )
    while len(squares) > 1:
        width = squares[0][0].type.count
        squares = [
            [mix(a, b, list(range(2 * width))) for a, b in zip(*pair)]
            for pair in zip(squares[::2], squares[1::2])
        ]
    return squares[0]


def _on_each(function):
    """Let ``function(lanes)`` work on tuples of lanes too."""

    def each(value):
        raise NotImplementedError("compiled code only")

    @overload(each)
    def typed(value):
        if not isinstance(value, types.BaseTuple):
            return lambda value: function(value)
        if len(value) == 0:
            return lambda value: ()
        return lambda value: (each(value[0]),) + each(value[1:])

    return each


def _turned_by(builder, lanes, places: int):
    """The lanes moved down by some places, those in front to the end."""
    width = lanes.type.count
    order = ir.Constant(
        ir.VectorType(ir.IntType(32), width), [(t + places) % width for t in range(width)]
    )
    return builder.shuffle_vector(lanes, ir.Constant(lanes.type, ir.Undefined), order)


@_on_each
@intrinsic
def total(typing, lanes):
    """The sum of the lanes as a double, half added to half: always in the same order."""

    def build(context, builder, sig, args):
        double = ir.VectorType(ir.DoubleType(), lanes.width)
        sums = args[0] if args[0].type == double else builder.fpext(args[0], double)
        half = lanes.width // 2
        while half:
            sums = builder.fadd(sums, _turned_by(builder, sums, half))
            half //= 2
        return builder.extract_element(sums, ir.IntType(32)(0))

    return types.float64(lanes), build


@_on_each
@intrinsic
def _first(typing, lanes):
    """The number in the first lane, as a double."""

    def build(context, builder, sig, args):
        number = builder.extract_element(args[0], ir.IntType(32)(0))
        return context.cast(builder, number, lanes.element, types.float64)

    return types.float64(lanes), build


def _halving(half: int):
    """A function ``(join, owner, sums)`` that joins the lanes with those ``half`` places on."""

    @_on_each
    @intrinsic
    def moved(typing, lanes):
        def build(context, builder, sig, args):
            return _turned_by(builder, args[0], half)

        return lanes(lanes), build

    return register_jitable(lambda join, owner, sums: join(owner, sums, moved(sums)))


_halved_1, _halved_2, _halved_4 = map(_halving, (1, 2, 4))


def fold(join, owner, sums):
    """The lanes of ``sums`` joined into one by ``join(owner, a, b)``, in a fixed order.

    ``sums`` is lanes or a tuple of them.
    """
    return sums


@overload(fold)
def _typed_fold(join, owner, sums):
    def four(join, owner, sums):
        return _first(_halved_1(join, owner, _halved_2(join, owner, sums)))

    def eight(join, owner, sums):
        halves = _halved_4(join, owner, sums)
        return _first(_halved_1(join, owner, _halved_2(join, owner, halves)))

    return eight if WIDTH == 8 else four
