"""From memory to lanes: consecutive entries, records transposed, fixed-point differences."""

import numpy as np
from llvmlite import ir
from numba.core import cgutils, types
from numba.extending import intrinsic

from psph.engine.jit import overload
from psph.engine.simd.lanes import EIGHT, Lanes, lanes_of, spread_number


def consecutive(array, first: int):
    """The entries of an array from ``first`` on, a register of them."""
    return array[first]


@overload(consecutive)
def _typed_consecutive(array, first):
    return lambda array, first: _load(array, first)


def eight(array, first: int):
    """As many entries of an array from ``first`` on as there are lanes in single precision."""
    return array[first]


@overload(eight)
def _typed_eight(array, first):
    return lambda array, first: _load_eight(array, first)


@intrinsic
def _load(typing, array, first):
    return _loaded(lanes_of(array.dtype), array)


@intrinsic
def _load_eight(typing, array, first):
    return _loaded(Lanes(array.dtype, EIGHT), array)


def _loaded(lanes: Lanes, array):
    """Signature and code of what loads such lanes from an array."""

    def build(context, builder, sig, args):
        data = context.make_array(sig.args[0])(context, builder, args[0]).data
        kind = context.get_value_type(lanes)
        place = builder.bitcast(builder.gep(data, [args[1]]), kind.as_pointer())
        value = builder.load(place)
        value.align = array.dtype.bitwidth // 8
        return value

    return lanes(array, types.uint64), build


def narrowed(lanes):
    """Lanes, rounded to single precision."""
    return np.float32(lanes)


@overload(narrowed)
def _typed_narrowed(lanes):
    return lambda lanes: _round(lanes)


@intrinsic
def _round(typing, lanes):
    single = Lanes(types.float32, lanes.width)

    def build(context, builder, sig, args):
        return builder.fptrunc(args[0], context.get_value_type(single))

    return single(lanes), build


def put_consecutive(array, first: int, lanes) -> None:
    """Write lanes to the entries of an array from ``first`` on."""
    array[first] = lanes


@overload(put_consecutive)
def _typed_put_consecutive(array, first, lanes):
    return lambda array, first, lanes: _write(array, first, lanes)


@intrinsic
def _write(typing, array, first, lanes):
    def build(context, builder, sig, args):
        data = context.make_array(sig.args[0])(context, builder, args[0]).data
        place = builder.bitcast(builder.gep(data, [args[1]]), args[2].type.as_pointer())
        builder.store(args[2], place).align = array.dtype.bitwidth // 8
        return context.get_dummy_value()

    return types.none(array, types.uint64, lanes), build


@intrinsic
def bits(typing, mask):
    """A comparison of lanes as the bits of a number, the first lane lowest."""

    def build(context, builder, sig, args):
        whole = builder.bitcast(args[0], ir.IntType(mask.width))
        return builder.zext(whole, ir.IntType(64))

    return types.uint64(mask), build


def set_bits(number: int) -> int:
    """How many bits of a number are set."""
    return int(number).bit_count()


@overload(set_bits)
def _typed_set_bits(number):
    return lambda number: _set_bits(number)


@intrinsic
def _set_bits(typing, number):
    def build(context, builder, sig, args):
        return builder.ctpop(args[0])

    return types.uint64(types.uint64), build


GROUP = 4
"""Numbers of a record that are loaded and turned at once."""


AHEAD = 32
"""Entries of a list by which records are fetched into the first cache before they are turned."""


def turning(count: int):
    """A compiled function ``(table, lists, entry)`` that gives records as a tuple of lanes.

    ``AHEAD`` entries behind the last must be there to be read, whatever they say.

    ``table`` (records, width), width the next multiple of ``GROUP`` from ``count``.  Lane t of
    number f is ``table[lists[entry + t], f]``.  Loading records whole and transposing them in
    registers takes a quarter of the loads that one array a quantity would.
    """

    @intrinsic
    def turn(typing, table, lists, entry):
        lanes = lanes_of(table.dtype)

        def build(context, builder, sig, args):
            records, listed = (
                context.make_array(kind)(context, builder, value).data
                for kind, value in zip(sig.args[:2], args[:2])
            )
            integer = ir.IntType(64)
            width = integer(-(-count // GROUP) * GROUP)

            def place(t):
                at = builder.gep(listed, [builder.add(args[2], integer(t))])
                j = builder.zext(builder.load(at), integer)
                return builder.gep(records, [builder.mul(j, width)])

            for t in range(lanes.width):
                _fetch_soon(builder, place(AHEAD + t))
            places = [place(t) for t in range(lanes.width)]
            found = []
            for first in range(0, count, GROUP):
                found += _transposed(builder, places, first)
            return context.make_tuple(builder, sig.return_type, found[:count])

        return types.UniTuple(lanes, count)(table, lists, types.uint64), build

    return turn


def _fetch_soon(builder, place):
    """Bring the cache line at ``place`` into the first cache; a place that is not there is no error."""
    byte, flag = ir.IntType(8).as_pointer(), ir.IntType(32)
    call = cgutils.get_or_insert_function(
        builder.module, ir.FunctionType(ir.VoidType(), [byte, flag, flag, flag]), "llvm.prefetch.p0i8"
    )
    to_read, to_keep, of_data = flag(0), flag(3), flag(1)
    builder.call(call, [builder.bitcast(place, byte), to_read, to_keep, of_data])


def _transposed(builder, places, first: int):
    """Lanes of the numbers ``first`` to ``first + 4`` of the records at ``places``."""
    doubles = isinstance(places[0].type.pointee, ir.DoubleType)

    def mix(a, b, order):
        """Lanes of a and b (those of b counted on), in an order."""
        order = ir.Constant(ir.VectorType(ir.IntType(32), len(order)), order)
        return builder.shuffle_vector(a, b, order)

    def picked(a, b, picks):
        """Pick from a and b (4 to 7) in each block of four lanes."""
        width = a.type.count
        return mix(
            a,
            b,
            [
                block + pick % GROUP + (width if pick >= GROUP else 0)
                for block in range(0, width, GROUP)
                for pick in picks
            ],
        )

    def halves(a, b, odd: int):
        """The first or the second pair in each block of four lanes of a, then of b."""
        starts = range(2 * odd, 2 * a.type.count, GROUP)
        return mix(a, b, [start + t for start in starts for t in range(2)])

    def load(place):
        group = ir.VectorType(place.type.pointee, GROUP)
        at = builder.gep(place, [ir.IntType(64)(first)])
        value = builder.load(builder.bitcast(at, group.as_pointer()))
        value.align = 4
        return value

    def row(chosen):
        """The groups of these records side by side."""
        groups = [load(place) for place in chosen]
        while len(groups) > 1:
            whole = list(range(2 * groups[0].type.count))
            groups = [mix(*two, whole) for two in zip(groups[::2], groups[1::2])]
        return groups[0]

    # In the shuffles that a processor has: for single precision within four lanes, for double within
    # two, then pairs of lanes.
    if not doubles:
        a, b, c, d = (row(places[t::GROUP]) for t in range(GROUP))
        ab, cd = picked(a, b, [0, 4, 1, 5]), picked(c, d, [0, 4, 1, 5])
        ab_high, cd_high = picked(a, b, [2, 6, 3, 7]), picked(c, d, [2, 6, 3, 7])
        return [
            picked(ab, cd, [0, 1, 4, 5]),
            picked(ab, cd, [2, 3, 6, 7]),
            picked(ab_high, cd_high, [0, 1, 4, 5]),
            picked(ab_high, cd_high, [2, 3, 6, 7]),
        ]
    half = len(places) // 2
    a, b, c, d = (row(part[t::2]) for part in (places[:half], places[half:]) for t in range(2))
    ab, cd = picked(a, b, [0, 4, 2, 6]), picked(c, d, [0, 4, 2, 6])
    ab_odd, cd_odd = picked(a, b, [1, 5, 3, 7]), picked(c, d, [1, 5, 3, 7])
    return [halves(ab, cd, 0), halves(ab_odd, cd_odd, 0), halves(ab, cd, 1), halves(ab_odd, cd_odd, 1)]


@intrinsic
def steps_between(typing, table, k, d, lanes, unit):
    """(table[k, d] − lanes) · unit, both whole numbers of 32 bits kept in single-precision places.

    Differences wrap around, so that only the range of the difference matters.
    """

    def build(context, builder, sig, args):
        data = context.make_array(sig.args[0])(context, builder, args[0])
        width = builder.extract_value(data.shape, 1)
        place = builder.gep(data.data, [builder.add(builder.mul(args[1], width), args[2])])
        whole = ir.VectorType(ir.IntType(32), lanes.width)
        own = builder.bitcast(builder.load(place), ir.IntType(32))
        other = builder.bitcast(args[3], whole)
        steps = builder.sub(spread_number(builder, own, lanes.width), other)
        length = context.cast(builder, args[4], types.float64, lanes.element)
        return builder.fmul(builder.sitofp(steps, args[3].type), spread_number(builder, length, lanes.width))

    return lanes(table, types.uint64, types.uint64, lanes, types.float64), build
