"""From lanes to one number: sums and joins in a fixed order."""

from typing import Any

from llvmlite import ir
from numba.core import types
from numba.extending import intrinsic

from psph.engine.jit import overload, register_jitable, tuple_of, unrolled
from psph.engine.simd.lanes import Lanes


def _on_each(function):
    """Let ``function(lanes)`` work on tuples of lanes too; in plain Python a lane is a number."""

    def each(value):
        return value

    @overload(each)
    def typed(value):
        if not isinstance(value, types.BaseTuple):
            return lambda value: function(value)
        parts = (f"each(value[{d}])" for d in range(len(value)))
        return unrolled("value", f"return {tuple_of(parts)}", each=each)

    return each


def _turned_by(builder, lanes, places: int):
    """The lanes moved down by some places, those in front to the end."""
    width = lanes.type.count
    order = ir.Constant(ir.VectorType(ir.IntType(32), width), [(t + places) % width for t in range(width)])
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

    return eight if _lanes_in(sums).width == 8 else four


def _lanes_in(kind: Any) -> Lanes:
    """The type of the first lanes in a tuple's type."""
    return kind if isinstance(kind, Lanes) else _lanes_in(kind.types[0])
