"""Composition: a tuple of effects becomes one loop body, selected by the tuple's type.

Each walker below exists twice: as plain Python (``NUMBA_DISABLE_JIT``, tests, the plan's trial
call) and written out for the tuple's type (psph.engine.jit.unrolled) when numba compiles it.  An effect
that lacks a method leaves no trace in the compiled loop.
"""

import functools
import itertools
import operator
from typing import Any, NamedTuple

import numpy as np
from numba.core import types

from psph.engine.jit import method_of, overload, register_jitable, tuple_of, unrolled
from psph.engine.simd import fold, total, turning, where
from psph.smoothing import slope_over_r, weight
from psph.vectors import add, at, dot, put, scale, subtract, zero_like

FOLDED = True
"""Stands for ``wall`` in a view of neighbours whose specific volume is negative in walls."""


class Pair(NamedTuple):
    """Geometry of an ordered pair; what no effect reads is not computed."""

    x_ij: Any = None
    """x_i − x_j, m, nearest periodic image."""
    u_ij: Any = None
    """u_i − u_j, m/s."""
    r2: Any = None
    """|x_ij|², m²."""
    r: Any = None
    """|x_ij|, m."""
    inverse_r: Any = None
    """1/|x_ij|, 1/m."""
    u_dot_x: Any = None
    """u_ij·x_ij, m²/s."""
    w: Any = None
    """W_ij, 1/m^d."""
    dw_r: Any = None
    """W′(r)/r, so that ∇W_ij = dw_r x_ij; negative inside the support, zero outside."""
    m_dw_r: Any = None
    """m_j W′(r)/r: what neighbour j weighs in a sum over gradients.  All such sums share it."""


PAIR_VECTORS = ("x_ij", "u_ij")
"""Entries of a pair with a number for each axis."""


def take(view, k: int):
    """The values of particle ``k`` of a view (psph.fields.view_of) of all."""
    return type(view)(
        *(
            at(entry, k) if isinstance(entry, tuple) else entry[k] if isinstance(entry, np.ndarray) else entry
            for entry in view
        )
    )


@overload(take)
def _typed_take(view, k):
    parts = (
        tuple_of(f"view.{name}[{d}][k]" for d in range(len(kind)))
        if isinstance(kind, types.BaseTuple)
        else f"view.{name}[k]"
        if isinstance(kind, types.Array)
        else f"view.{name}"
        for name, kind in zip(view.instance_class._fields, view.types)
    )
    return unrolled("view, k", f"return View{tuple_of(parts)}", View=view.instance_class)


def fetch(view, records, lists, entry: int):
    """The values of the neighbours ``lists[entry]`` and following, as lanes.

    Arrays of ``view`` say which quantities the records hold, in this order.
    """
    left = list(records[lists[entry]])
    found = type(view)(
        *(
            tuple(left.pop(0) for _ in entry)
            if isinstance(entry, tuple)
            else left.pop(0)
            if isinstance(entry, np.ndarray)
            else entry
            for entry in view
        )
    )
    if getattr(found, "wall", None) is not FOLDED:
        return found
    signed = found.specific_volume
    return found._replace(specific_volume=abs(signed), wall=where(signed < 0.0, 1.0, 0.0))


@overload(fetch)
def _typed_fetch(view, records, lists, entry):
    places, names = itertools.count(), view.instance_class._fields
    parts = {
        name: tuple_of(f"numbers[{next(places)}]" for _ in kind)
        if isinstance(kind, types.BaseTuple)
        else f"numbers[{next(places)}]"
        if isinstance(kind, types.Array)
        else f"view.{name}"
        for name, kind in zip(names, view.types)
    }
    if "wall" in names and isinstance(view.types[names.index("wall")], types.Boolean):
        signed = parts["specific_volume"]
        parts |= {"specific_volume": f"abs({signed})", "wall": f"where({signed} < 0.0, 1.0, 0.0)"}
    return unrolled(
        "view, records, lists, entry",
        "numbers = turn(records, lists, entry)",
        f"return View{tuple_of(parts.values())}",
        View=view.instance_class,
        turn=turning(next(places)),
        where=where,
    )


@register_jitable
def geometry(kernel, x_ij, softening, i, j):
    """Pair of the particle views ``i`` and ``j``, ``x_ij`` m apart; ``softening`` (m²) keeps r from zero."""
    u_ij = subtract(i.velocity, j.velocity)
    r2 = dot(x_ij, x_ij) + softening
    r = np.sqrt(r2)
    inverse_r = 1.0 / r
    dw_r = slope_over_r(kernel, r, inverse_r)
    return Pair(x_ij, u_ij, r2, r, inverse_r, dot(u_ij, x_ij), weight(kernel, r), dw_r, j.mass * dw_r)


def _methods(effects, name: str) -> dict[int, Any]:
    """Place in the tuple's type → compiled method, of the effects that have it."""
    found = ((place, method_of(kind, name)) for place, kind in enumerate(effects))
    return {place: method for place, method in found if method is not None}


def _calls(of: str, methods: dict[int, Any], arguments: str) -> list[str]:
    """The text of each method's call; ``of`` is the name of the tuple."""
    return [f"method_{place}({of}[{place}], {arguments})" for place in methods]


def _named(methods: dict[int, Any]) -> dict[str, Any]:
    """The names that the text of :func:`_calls` refers to."""
    return {f"method_{place}": method for place, method in methods.items()}


def _sum_of(name: str, arguments: str, empty, plus):
    """A walker: the sum of ``effect.name(arguments)`` over those effects that have such a method.

    ``empty(arguments)`` where none has.
    """

    def summed(effects, *args):
        terms = [getattr(effect, name)(*args) for effect in effects if hasattr(effect, name)]
        return functools.reduce(plus, terms) if terms else empty(*args)

    @overload(summed, strict=False)
    def typed(effects, *args):
        methods = _methods(effects, name)
        terms = _calls("effects", methods, arguments) or [f"empty({arguments})"]
        # The last first: the pair loop of plain SPH is two instructions shorter so.
        whole = functools.reduce(lambda a, b: f"plus({a}, {b})", reversed(terms))
        return unrolled(
            f"effects, {arguments}",
            f"return {whole}",
            plus=plus,
            empty=register_jitable(empty),
            **_named(methods),
        )

    return summed


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


def _no_vector(i, *args):
    return zero_like(i.position)


density_rate = _sum_of("density_rate", "i, j, pair", lambda i, j, pair: 0.0, operator.add)
"""(effects, i, j, pair) → a neighbour's share of dρ_i/dt, kg/(m^d s)."""
radial = _sum_of("radial", "i, j, pair", lambda i, j, pair: None, operator.add)
"""(effects, i, j, pair) → coefficient of x_ij in the acceleration, 1/s², or None."""
shear = _sum_of("shear", "i, j, pair", lambda i, j, pair: None, operator.add)
"""(effects, i, j, pair) → coefficient of u_ij in the acceleration, 1/s, or None."""
push = _sum_of("push", "i, j, pair", lambda i, j, pair: None, add)
"""(effects, i, j, pair) → an acceleration along neither, m/s², or None."""
body = _sum_of("body", "i", _no_vector, add)
"""(effects, i) → acceleration from outside, m/s²."""
displacement = _sum_of("displacement", "i, dt", _no_vector, add)
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
        methods = _methods(effects, name)
        lines = (f"rho = {call}" for call in _calls("effects", methods, "i, rho"))
        return unrolled("effects, i, rho", *lines, "return rho", **_named(methods))

    return limited


limit_density = _limit_by("limit_density")
"""(effects, i, rho) → ρ of a fluid particle after every effect that bounds it, kg/m^d."""
limit_wall_density = _limit_by("limit_wall_density")
"""(effects, i, rho) → the same in a wall, kg/m^d."""
bearing_density = _limit_by("bearing_density")
"""(effects, i, rho) → ρ that gives a wall its pressure, kg/m^d."""

OF_A_PARTICLE = ("displacement", "limit_density", "limit_wall_density", "bearing_density")
"""Methods that are called for a particle by itself, in kick, drift and the equation of state."""


# A reduction is an effect with a sum of its own: start -> gather, gather, ... -> finish.


def start(reductions, i):
    """The empty sums of all reductions."""
    return tuple(effect.start(i) for effect in reductions)


@overload(start)
def _typed_start(reductions, i):
    methods = _methods(reductions, "start")
    sums = tuple_of(_calls("reductions", methods, "i"))
    return unrolled("reductions, i", f"return {sums}", **_named(methods))


def gather_each(reductions, totals, i, j, pair):
    """All sums with the neighbours j in them."""
    return tuple(effect.gather(total, i, j, pair) for effect, total in zip(reductions, totals))


@overload(gather_each)
def _typed_gather_each(reductions, totals, i, j, pair):
    methods = _methods(reductions, "gather")
    sums = (f"method_{place}(reductions[{place}], totals[{place}], i, j, pair)" for place in methods)
    return unrolled("reductions, totals, i, j, pair", f"return {tuple_of(sums)}", **_named(methods))


def fold_each(reductions, totals):
    """All sums with their lanes joined, by the effect's own ``join`` or by adding."""
    return totals


@overload(fold_each)
def _typed_fold_each(reductions, totals):
    joins = _methods(reductions, "join")
    sums = (
        f"fold(method_{place}, reductions[{place}], totals[{place}])"
        if place in joins
        else f"total(totals[{place}])"
        for place in range(len(reductions))
    )
    return unrolled("reductions, totals", f"return {tuple_of(sums)}", fold=fold, total=total, **_named(joins))


def finish_acceleration(reductions, totals, i):
    """What the finished sums add to the acceleration, m/s²."""
    acceleration = zero_like(i.position)
    for effect, gathered in zip(reductions, totals):
        if hasattr(effect, "finish_acceleration"):
            acceleration = add(acceleration, effect.finish_acceleration(gathered, i))
    return acceleration


@overload(finish_acceleration)
def _typed_finish_acceleration(reductions, totals, i):
    methods = _methods(reductions, "finish_acceleration")
    lines = (f"a = add(a, method_{place}(reductions[{place}], totals[{place}], i))" for place in methods)
    return unrolled(
        "reductions, totals, i",
        "a = zero_like(i.position)",
        *lines,
        "return a",
        add=add,
        zero_like=zero_like,
        **_named(methods),
    )


def finish_value(reductions, totals, i, kernel, k, written):
    """Store the finished sums that are fields: ``written`` has an array or None for each."""
    for effect, gathered, array in zip(reductions, totals, written):
        if array is not None:
            _store(array, k, effect.finish_value(gathered, i, kernel))


@overload(finish_value)
def _typed_finish_value(reductions, totals, i, kernel, k, written):
    methods = _methods(reductions, "finish_value")
    lines = (
        f"store(written[{place}], k, method_{place}(reductions[{place}], totals[{place}], i, kernel))"
        for place in methods
    )
    return unrolled(
        "reductions, totals, i, kernel, k, written",
        *lines,
        "return",
        store=_store,
        **_named(methods),
    )


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
