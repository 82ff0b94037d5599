"""Eight candidates at once: which of them are near, as the bits of a number."""

import numpy as np
from llvmlite import ir
from numba.core import cgutils, types
from numba.extending import intrinsic

from psph.engine.jit import overload, register_jitable, tuple_of, unrolled
from psph.engine.simd import consecutive, lanes_of, set_bits
from psph.vectors import at

LANES = 8
"""Candidates of a group."""

PACKED = np.zeros((1 << LANES, LANES), np.uint32)
"""For each pattern of bits the numbers of those that are set, packed to the left."""
for _bits in range(1 << LANES):
    _set = [t for t in range(LANES) if _bits >> t & 1]
    PACKED[_bits, : len(_set)] = _set


def consecutive_each(arrays, first):
    """Eight entries of each array, as lanes."""
    return at(arrays, first)


@overload(consecutive_each)
def _typed_consecutive_each(arrays, first):
    parts = (f"consecutive(arrays[{d}], first)" for d in range(len(arrays)))
    return unrolled("arrays, first", f"return {tuple_of(parts)}", consecutive=consecutive)


def append_near(entries, end: int, column: int, bits: int) -> int:
    """Write ``column + t`` for each bit t that is set behind ``entries[end - 1]``; the new end.

    All eight places behind ``end`` are written: there must be room.
    """
    for t in range(LANES):
        entries[end + t] = column + PACKED[bits, t]
    return end + set_bits(bits)


@overload(append_near)
def _typed_append_near(entries, end, column, bits):
    def append(entries, end, column, bits):
        _store_packed(entries, end, column, PACKED, bits)
        return end + set_bits(bits)

    return append


@intrinsic
def _store_packed(typing, entries, end, column, table, bits):
    """One vector from the table to the list: LLVM fears that the two overlap."""

    def build(context, builder, signature, args):
        lanes = ir.VectorType(ir.IntType(32), LANES)

        def place(k, index):
            array = context.make_array(signature.args[k])(context, builder, args[k])
            return builder.bitcast(builder.gep(array.data, [index]), lanes.as_pointer())

        row = builder.load(place(3, builder.mul(args[4], ir.IntType(64)(LANES))))
        row.align = 4
        nothing = ir.Constant(lanes, ir.Undefined)
        first = builder.insert_element(nothing, builder.trunc(args[2], ir.IntType(32)), ir.IntType(32)(0))
        spread = builder.shuffle_vector(first, nothing, ir.Constant(lanes, [0] * LANES))
        builder.store(builder.add(row, spread), place(0, args[1])).align = 4
        return context.get_dummy_value()

    return types.none(entries, types.uint64, types.uint64, table, types.uint64), build


def keep_lanes(array, end: int, lanes, bits: int) -> int:
    """Write those lanes of which a bit is set behind ``array[end - 1]``; the new end.

    A whole register behind ``end`` is written: there must be room.
    """
    if bits:
        array[end] = lanes
    return end + int(bits != 0)


@overload(keep_lanes)
def _typed_keep_lanes(array, end, lanes, bits):
    def keep(array, end, lanes, bits):
        _store_kept(array, end, lanes, bits)
        return end + set_bits(bits)

    return keep


def keep_each(into, end, x, chosen):
    """Write each component of those places ``x`` of which a bit is ``chosen`` from ``end`` on."""
    if chosen:
        for kept, component in zip(into, x):
            kept[end] = component


@overload(keep_each)
def _typed_keep_each(into, end, x, chosen):
    lines = (f"keep_lanes(into[{d}], end, x[{d}], chosen)" for d in range(len(into)))
    return unrolled("into, end, x, chosen", *lines, keep_lanes=keep_lanes)


def keep_lines(lines, end: int, long: int, parts, bits: int) -> None:
    """Write such lanes of each of the ``parts`` behind place ``end`` of a line of its own, from the second
    on, as far as there are any; ``lines`` are ``long`` and stand one behind another."""
    for d, lanes in enumerate(parts):
        if bits and (1 + d) * int(long) < len(lines):
            lines[(1 + d) * int(long) + int(end)] = lanes


@overload(keep_lines)
def _typed_keep_lines(lines, end, long, parts, bits):
    def keep(lines, end, long, line, lanes, bits):
        if line * long < np.uint64(len(lines)):
            keep_lanes(lines, line * long + end, lanes, bits)

    each = (f"keep(lines, end, long, np.uint64({1 + d}), parts[{d}], bits)" for d in range(len(parts)))
    return unrolled("lines, end, long, parts, bits", *each, np=np, keep=register_jitable(keep))


def keep_entries(array, end: int, source, first: int, bits: int, like) -> None:
    """The same of ``source[first + t]``, for each bit t of as many as ``like`` has lanes."""
    if bits:
        array[end] = source[first]


@overload(keep_entries)
def _typed_keep_entries(array, end, source, first, bits, like):
    return lambda array, end, source, first, bits, like: _store_kept_entries(
        array, end, source, first, bits, like
    )


def _compressed(builder, value, bits):
    """Lanes of ``value`` of which a bit is set, packed to the left."""
    width, whole = value.type.count, ir.IntType(1)
    mask = builder.bitcast(builder.trunc(bits, ir.IntType(width)), ir.VectorType(whole, width))
    kind = value.type.element.intrinsic_name
    call = cgutils.get_or_insert_function(
        builder.module,
        ir.FunctionType(value.type, [value.type, mask.type, value.type]),
        f"llvm.experimental.vector.compress.v{width}{kind}",
    )
    return builder.call(call, [value, mask, ir.Constant(value.type, ir.Undefined)])


@intrinsic
def _store_kept(typing, array, end, lanes, bits):
    """Lanes that are kept, written at ``end``."""

    def build(context, builder, signature, args):
        data = context.make_array(signature.args[0])(context, builder, args[0]).data
        place = builder.bitcast(builder.gep(data, [args[1]]), args[2].type.as_pointer())
        builder.store(_compressed(builder, args[2], args[3]), place).align = 8
        return context.get_dummy_value()

    return types.none(array, types.uint64, lanes, types.uint64), build


@intrinsic
def _store_kept_entries(typing, array, end, source, first, bits, like):
    """Entries that are kept, of so many as a register of ``like`` has lanes, written at ``end``."""
    width = lanes_of(like.dtype).width

    def build(context, builder, signature, args):
        kind = ir.VectorType(ir.IntType(32), width)

        def place(k, index):
            data = context.make_array(signature.args[k])(context, builder, args[k]).data
            return builder.bitcast(builder.gep(data, [index]), kind.as_pointer())

        value = builder.load(place(2, args[3]))
        value.align = 4
        builder.store(_compressed(builder, value, args[4]), place(0, args[1])).align = 4
        return context.get_dummy_value()

    return types.none(array, types.uint64, source, types.uint64, types.uint64, like), build
