"""Eight candidates at once: which of them are near, as the bits of a number."""

import numpy as np
from llvmlite import ir
from numba.core import cgutils, types
from numba.extending import intrinsic, overload

from psph.vectors import at, dot, nearest_image, subtract

LANES = 8
"""Candidates of a group."""

PACKED = np.zeros((1 << LANES, LANES), np.uint32)
"""For each pattern of bits the numbers of those that are set, packed to the left."""
HOW_MANY = np.zeros(1 << LANES, np.uint64)
"""For each pattern of bits how many are set."""
for _bits in range(1 << LANES):
    _set = [t for t in range(LANES) if _bits >> t & 1]
    PACKED[_bits, : len(_set)] = _set
    HOW_MANY[_bits] = len(_set)


def near_bits(position, column: int, x_i, periods, cutoff2: float) -> int:
    """Bit t says whether particle ``column + t`` lies within the cutoff of ``x_i``.

    ``position`` tuple of component arrays; the arrays must go on for eight entries.
    """
    bits = 0
    for t in range(LANES):
        x_ij = nearest_image(subtract(x_i, at(position, column + t)), periods)
        bits |= int(dot(x_ij, x_ij) < cutoff2) << t
    return bits


@overload(near_bits)
def _typed_near_bits(position, column, x_i, periods, cutoff2):
    return lambda position, column, x_i, periods, cutoff2: _near_bits(
        position, column, x_i, periods, cutoff2
    )


@intrinsic
def _near_bits(typing, position, column, x_i, periods, cutoff2):
    """The same with explicit vectors: LLVM makes poor loops of a few groups at a time."""

    def build(context, builder, signature, args):
        vectors = _Vectors(builder)
        limit = vectors.spread(args[4])
        square = None
        for d, array_type in enumerate(signature.args[0].types):
            array = context.make_array(array_type)(
                context, builder, builder.extract_value(args[0], d)
            )
            x_j = vectors.load(array.data, args[1])
            x = builder.fsub(vectors.spread(builder.extract_value(args[2], d)), x_j)
            if not isinstance(signature.args[3].types[d], types.NoneType):
                x = vectors.wrap(x, builder.extract_value(args[3], d))
            term = builder.fmul(x, x)
            square = term if square is None else builder.fadd(square, term)
        near = builder.fcmp_ordered("<", square, limit)
        return builder.zext(builder.bitcast(near, ir.IntType(LANES)), ir.IntType(64))

    return types.uint64(position, types.uint64, x_i, periods, types.float64), build


def append_near(entries, end: int, column: int, bits: int) -> int:
    """Write ``column + t`` for each bit t that is set behind ``entries[end - 1]``; the new end.

    All eight places behind ``end`` are written: there must be room.
    """
    for t in range(LANES):
        entries[end + t] = column + PACKED[bits, t]
    return end + int(HOW_MANY[bits])


@overload(append_near)
def _typed_append_near(entries, end, column, bits):
    def append(entries, end, column, bits):
        _store_packed(entries, end, column, PACKED, bits)
        return end + HOW_MANY[bits]

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
        first = builder.insert_element(
            nothing, builder.trunc(args[2], ir.IntType(32)), ir.IntType(32)(0)
        )
        spread = builder.shuffle_vector(first, nothing, ir.Constant(lanes, [0] * LANES))
        builder.store(builder.add(row, spread), place(0, args[1])).align = 4
        return context.get_dummy_value()

    return types.none(entries, types.uint64, types.uint64, table, types.uint64), build


class _Vectors:
    """Vectors of eight doubles in LLVM's words."""

    def __init__(self, builder):
        self.builder = builder
        self.type = ir.VectorType(ir.DoubleType(), LANES)

    def load(self, pointer, first):
        """Eight consecutive numbers."""
        place = self.builder.bitcast(
            self.builder.gep(pointer, [first]), self.type.as_pointer()
        )
        value = self.builder.load(place)
        value.align = 8
        return value

    def spread(self, number):
        """One number in all lanes."""
        nothing = ir.Constant(self.type, ir.Undefined)
        one = self.builder.insert_element(nothing, number, ir.IntType(32)(0))
        zeros = ir.Constant(ir.VectorType(ir.IntType(32), LANES), [0] * LANES)
        return self.builder.shuffle_vector(one, nothing, zeros)

    def wrap(self, x, period):
        """The nearest periodic image of a difference."""
        build = self.builder
        one = ir.Constant(ir.DoubleType(), 1.0)
        turns = build.fmul(x, self.spread(build.fdiv(one, period)))
        lowest = self.spread(build.fneg(one))
        turns = build.select(build.fcmp_ordered(">", turns, lowest), turns, lowest)
        rint = cgutils.get_or_insert_function(
            build.module, ir.FunctionType(self.type, [self.type]), f"llvm.rint.v{LANES}f64"
        )
        return build.fsub(x, build.fmul(build.call(rint, [turns]), self.spread(period)))
