"""Composition: a tuple of effects becomes one loop body, selected by the tuple's type.

Each walker below exists twice: as plain Python (``NUMBA_DISABLE_JIT``, tests, the plan's trial
call) and as a recursion over the tuple's type, which numba resolves while compiling.  An effect
that lacks a method leaves no trace in the compiled loop.
"""

from typing import Any, NamedTuple

import numpy as np
from numba.core import types
from numba.extending import overload, register_jitable

from psph.jit import method_of
from psph.simd import fold, total, turning
from psph.smoothing import slope_over_r, weight
from psph.vectors import add, at, dot, put, scale, subtract, zero_like


class ParticleView(NamedTuple):
    """What effects can read of a particle: arrays of all, or the values of one.

    An entry is an array where the quantity varies, a number where the whole scene shares one
    value, and None where the scene lacks it.  Vectors are tuples of components.
    """

    position: Any
    velocity: Any = None
    pressure: Any = None
    specific_volume: Any = None
    mass: Any = None
    rest_density: Any = None
    viscosity: Any = None
    kernel_sum: Any = None
    inside: Any = None
    crowding: Any = None
    transport: Any = None
    gradient_correction: Any = None
    wall: Any = None
    no_slip: Any = None
    slip: Any = None
    sound_speed: Any = None
    smoothing_length: Any = None
    largest_speed: Any = None
    """Of all fluid particles, a step old; for displacements alone."""


class Pair(NamedTuple):
    """Geometry of an ordered pair; what no effect reads is not computed."""

    x_ij: Any
    """x_i − x_j, m, nearest periodic image."""
    u_ij: Any
    """u_i − u_j, m/s."""
    r2: Any
    """|x_ij|², m²."""
    u_dot_x: Any
    """u_ij·x_ij, m²/s."""
    w: Any
    """W_ij, 1/m^d."""
    dw_r: Any
    """W′(r)/r, so that ∇W_ij = dw_r x_ij; negative inside the support, zero outside."""


VECTORS = ("position", "velocity", "crowding", "transport", "slip", "x_ij", "u_ij")
"""Entries of a view or a pair with a number for each dimension."""

MATRICES = ("gradient_correction",)
"""Entries that are symmetric matrices."""


def components(name: str, dimensions: int) -> int | None:
    """How many components an entry of a view or a pair has; None where it is a number."""
    if name in MATRICES:
        return dimensions * (dimensions + 1) // 2
    return dimensions if name in VECTORS else None


def take(view: ParticleView, k: int) -> ParticleView:
    """The values of particle ``k``."""
    return ParticleView(*_take_each(tuple(view), k))


def _take_each(entries, k):
    return tuple(_entry(entry, k) for entry in entries)


def _entry(entry, k):
    if isinstance(entry, tuple):
        return at(entry, k)
    return entry[k] if isinstance(entry, np.ndarray) else entry


@overload(_entry)
def _typed_entry(entry, k):
    if isinstance(entry, types.BaseTuple):
        return lambda entry, k: at(entry, k)
    if isinstance(entry, types.Array):
        return lambda entry, k: entry[k]
    return lambda entry, k: entry


@overload(_take_each)
def _typed_take_each(entries, k):
    if len(entries) == 0:
        return lambda entries, k: ()
    return lambda entries, k: (_entry(entries[0], k),) + _take_each(entries[1:], k)


@overload(take)
def _typed_take(view, k):
    return lambda view, k: ParticleView(*_take_each(tuple(view), k))


def fetch(view: ParticleView, records, lists, entry: int) -> ParticleView:
    """The values of the neighbours ``lists[entry]`` and following, as lanes.

    Arrays of ``view`` say which quantities the records hold, in this order.
    """
    return ParticleView(*_dealt(tuple(view), tuple(records[lists[entry]])))


def _dealt(entries, numbers):
    """Give each array among ``entries`` the next of the numbers."""
    left = list(numbers)
    return tuple(
        tuple(left.pop(0) for _ in entry) if isinstance(entry, tuple)
        else left.pop(0) if isinstance(entry, np.ndarray) else entry
        for entry in entries
    )


@overload(_dealt)
def _typed_dealt(entries, numbers):
    if len(entries) == 0:
        return lambda entries, numbers: ()
    if isinstance(entries[0], types.BaseTuple):
        n = len(entries[0])
        return lambda entries, numbers: (numbers[:n],) + _dealt(entries[1:], numbers[n:])
    if isinstance(entries[0], types.Array):
        return lambda entries, numbers: (numbers[0],) + _dealt(entries[1:], numbers[1:])
    return lambda entries, numbers: (entries[0],) + _dealt(entries[1:], numbers)


@overload(fetch)
def _typed_fetch(view, records, lists, entry):
    count = sum(
        len(kind) if isinstance(kind, types.BaseTuple) else isinstance(kind, types.Array)
        for kind in view.types
    )
    turn = turning(count)
    return lambda view, records, lists, entry: ParticleView(
        *_dealt(tuple(view), turn(records, lists, entry))
    )


@register_jitable
def geometry(kernel, x_ij, tiny, i, j):
    """Pair of the particle views ``i`` and ``j``, ``x_ij`` m apart; ``tiny`` (m²) keeps r from zero."""
    u_ij = subtract(i.velocity, j.velocity)
    r2 = dot(x_ij, x_ij) + tiny
    r = np.sqrt(r2)
    return Pair(x_ij, u_ij, r2, dot(u_ij, x_ij), weight(kernel, r), slope_over_r(kernel, r))


def _sum_of(name: str, first, join):
    """A walker: the sum of ``effect.name(*args)`` over those effects that have such a method."""
    empty, plus = register_jitable(first), register_jitable(join)

    def summed(effects, *args):
        value = first(*args)
        for effect in effects:
            if hasattr(effect, name):
                value = join(value, getattr(effect, name)(*args))
        return value

    @overload(summed)
    def typed(effects, *args):
        if len(effects) == 0:
            return lambda effects, *args: empty(*args)
        term = method_of(effects[0], name)
        if term is None:
            return lambda effects, *args: summed(effects[1:], *args)
        return lambda effects, *args: plus(summed(effects[1:], *args), term(effects[0], *args))

    return summed


def _no_number(*args):
    return 0.0


def _nothing(*args):
    return None


def _plus(a, b):
    return b if a is None else a + b


def _no_vector(i, *args):
    return zero_like(i.position)


def _plus_vector(a, b):
    return b if a is None else add(a, b)


def added(a, b):
    """a + b; a vector b that is None costs nothing."""
    return a if b is None else add(a, b)


@overload(added)
def _typed_added(a, b):
    if isinstance(b, types.NoneType):
        return lambda a, b: a
    return lambda a, b: add(a, b)


def pushed(a, direction, coefficient):
    """a + coefficient · direction; a coefficient None costs nothing."""
    return a if coefficient is None else add(a, scale(direction, coefficient))


@overload(pushed)
def _typed_pushed(a, direction, coefficient):
    if isinstance(coefficient, types.NoneType):
        return lambda a, direction, coefficient: a
    return lambda a, direction, coefficient: add(a, scale(direction, coefficient))


density_rate = _sum_of("density_rate", _no_number, _plus)
"""(effects, i, j, pair) → a neighbour's share of dρ_i/dt, kg/(m^d s)."""
radial = _sum_of("radial", _nothing, _plus)
"""(effects, i, j, pair) → coefficient of x_ij in the acceleration, 1/s², or None."""
shear = _sum_of("shear", _nothing, _plus)
"""(effects, i, j, pair) → coefficient of u_ij in the acceleration, 1/s, or None."""
push = _sum_of("push", _nothing, _plus_vector)
"""(effects, i, j, pair) → an acceleration along neither, m/s², or None."""
body = _sum_of("body", _no_vector, _plus_vector)
"""(effects, i) → acceleration from outside, m/s²."""
displacement = _sum_of("displacement", _no_vector, _plus_vector)
"""(effects, i, dt) → what a fluid particle moves beside its velocity in a step, m."""


def _limit_by(name: str):
    """A walker: ρ after ``effect.name(i, rho)`` of every effect that has such a method."""

    def limited(effects, i, rho):
        for effect in effects:
            if hasattr(effect, name):
                rho = getattr(effect, name)(i, rho)
        return rho

    @overload(limited)
    def typed(effects, i, rho):
        if len(effects) == 0:
            return lambda effects, i, rho: rho
        limit = method_of(effects[0], name)
        if limit is None:
            return lambda effects, i, rho: limited(effects[1:], i, rho)
        return lambda effects, i, rho: limited(effects[1:], i, limit(effects[0], i, rho))

    return limited


limit_density = _limit_by("limit_density")
"""(effects, i, rho) → ρ of a fluid particle after every effect that bounds it, kg/m^d."""
limit_wall_density = _limit_by("limit_wall_density")
"""(effects, i, rho) → the same in a wall, kg/m^d."""


# A reduction is an effect with a sum of its own: start -> gather, gather, ... -> finish.


def start(reductions, i):
    """The empty sums of all reductions."""
    return tuple(effect.start(i) for effect in reductions)


@overload(start)
def _typed_start(reductions, i):
    if len(reductions) == 0:
        return lambda reductions, i: ()
    first = method_of(reductions[0], "start")
    return lambda reductions, i: (first(reductions[0], i),) + start(reductions[1:], i)


def gather_each(reductions, totals, i, j, pair):
    """All sums with the neighbours j in them."""
    return tuple(
        effect.gather(total, i, j, pair) for effect, total in zip(reductions, totals)
    )


@overload(gather_each)
def _typed_gather_each(reductions, totals, i, j, pair):
    if len(reductions) == 0:
        return lambda reductions, totals, i, j, pair: ()
    first = method_of(reductions[0], "gather")
    return lambda reductions, totals, i, j, pair: (
        (first(reductions[0], totals[0], i, j, pair),)
        + gather_each(reductions[1:], totals[1:], i, j, pair)
    )


def fold_each(reductions, totals):
    """All sums with their lanes joined, by the effect's own ``join`` or by adding."""
    return totals


@overload(fold_each)
def _typed_fold_each(reductions, totals):
    if len(reductions) == 0:
        return lambda reductions, totals: ()
    join = method_of(reductions[0], "join")
    if join is None:
        return lambda reductions, totals: (
            (total(totals[0]),) + fold_each(reductions[1:], totals[1:])
        )
    return lambda reductions, totals: (
        (fold(join, reductions[0], totals[0]),) + fold_each(reductions[1:], totals[1:])
    )


def finish_acceleration(reductions, totals, i):
    """What the finished sums add to the acceleration, m/s²."""
    acceleration = zero_like(i.position)
    for effect, total in zip(reductions, totals):
        if hasattr(effect, "finish_acceleration"):
            acceleration = add(acceleration, effect.finish_acceleration(total, i))
    return acceleration


@overload(finish_acceleration)
def _typed_finish_acceleration(reductions, totals, i):
    if len(reductions) == 0:
        return lambda reductions, totals, i: zero_like(i.position)
    finish = method_of(reductions[0], "finish_acceleration")
    if finish is None:
        return lambda reductions, totals, i: finish_acceleration(reductions[1:], totals[1:], i)
    return lambda reductions, totals, i: add(
        finish_acceleration(reductions[1:], totals[1:], i), finish(reductions[0], totals[0], i)
    )


def finish_value(reductions, totals, i, kernel, k, written):
    """Store the finished sums that are fields: ``written`` has an array or None for each."""
    for effect, total, array in zip(reductions, totals, written):
        if array is not None:
            _store(array, k, effect.finish_value(total, i, kernel))


@overload(finish_value)
def _typed_finish_value(reductions, totals, i, kernel, k, written):
    if len(reductions) == 0:
        return lambda reductions, totals, i, kernel, k, written: None
    finish = method_of(reductions[0], "finish_value")
    if finish is None:
        return lambda reductions, totals, i, kernel, k, written: finish_value(
            reductions[1:], totals[1:], i, kernel, k, written[1:]
        )

    def store(reductions, totals, i, kernel, k, written):
        _store(written[0], k, finish(reductions[0], totals[0], i, kernel))
        finish_value(reductions[1:], totals[1:], i, kernel, k, written[1:])

    return store


def _store(arrays, k, value):
    """Write a number into its array, or a vector into its component arrays."""
    if isinstance(arrays, tuple):
        put(arrays, k, value)
    else:
        arrays[k] = value


@overload(_store)
def _typed_store(arrays, k, value):
    if isinstance(arrays, types.BaseTuple):
        return lambda arrays, k, value: put(arrays, k, value)

    def number(arrays, k, value):
        arrays[k] = value

    return number
