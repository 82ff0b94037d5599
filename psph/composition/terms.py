"""The terms of the effects of a scene: a tuple of effects becomes one loop body, by the tuple's type.

Each walker below exists twice: as plain Python (``NUMBA_DISABLE_JIT``, tests, the plan's trial
call) and written out for the tuple's type (psph.engine.jit.unrolled) when numba compiles it.  An effect
that lacks a method leaves no trace in the compiled loop.
"""

import functools
import operator
from typing import Any

from numba.core import types

from psph.engine.jit import method_of, overload, overload_walker, register_jitable, tuple_of, unrolled
from psph.engine.simd import fold, total
from psph.vectors import add, at, put, scale, zero_like


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

    @overload_walker(summed)
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
potential = _sum_of("potential", "i", lambda i: 0.0, operator.add)
"""(effects, i) → potential energy of a particle by its mass, J/kg."""
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


def asked(arrays, effects):
    """The ``effects`` where there are ``arrays`` for what they give; none where these are None."""
    return () if arrays is None else effects


@overload(asked)
def _typed_asked(arrays, effects):
    if isinstance(arrays, types.NoneType):
        return lambda arrays, effects: ()
    return lambda arrays, effects: effects


# A reduction is an effect with a sum of its own: start -> gather, gather, ... -> finish.


def start(reductions, i):
    """The empty sums of all reductions."""
    return tuple(effect.start(i) for effect in reductions)


@overload_walker(start)
def _typed_start(reductions, i):
    methods = _methods(reductions, "start")
    sums = tuple_of(_calls("reductions", methods, "i"))
    return unrolled("reductions, i", f"return {sums}", **_named(methods))


def concerns(effects, reductions, i):
    """Whether a pass has a sum for particle i: ``effects``, which give rates, have one for each."""
    if effects:
        return True
    return any(not hasattr(effect, "has_sum") or effect.has_sum(i) > 0.0 for effect in reductions)


@overload(concerns)
def _typed_concerns(effects, reductions, i):
    methods = _methods(reductions, "has_sum")
    if len(effects) or len(methods) < len(reductions):
        return lambda effects, reductions, i: True
    asked = " or ".join(f"{call} > 0.0" for call in _calls("reductions", methods, "i"))
    return unrolled("effects, reductions, i", f"return {asked}", **_named(methods))


def gather_each(reductions, totals, i, j, pair):
    """All sums with the neighbours j in them."""
    return tuple(effect.gather(total, i, j, pair) for effect, total in zip(reductions, totals))


@overload_walker(gather_each)
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


@overload_walker(finish_acceleration)
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
            store(array, k, effect.finish_value(gathered, i, kernel))


@overload_walker(finish_value)
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
        store=store,
        **_named(methods),
    )


def plus_held(arrays, k, value):
    """A number, or a vector, and what an array, or the component arrays, hold besides; None holds nothing."""
    if arrays is None:
        return value
    return add(value, at(arrays, k)) if isinstance(arrays, tuple) else value + arrays[k]


@overload(plus_held)
def _typed_plus_held(arrays, k, value):
    if isinstance(arrays, types.NoneType):
        return lambda arrays, k, value: value
    if isinstance(arrays, types.BaseTuple):
        return lambda arrays, k, value: add(value, at(arrays, k))
    return lambda arrays, k, value: value + arrays[k]


def store(arrays, k, value):
    """Write a number into its array, or a vector into its component arrays; nothing where there is none."""
    if isinstance(arrays, tuple):
        put(arrays, k, value)
    elif arrays is not None:
        arrays[k] = value


@overload(store)
def _typed_store(arrays, k, value):
    if isinstance(arrays, types.BaseTuple):
        return lambda arrays, k, value: put(arrays, k, value)
    if isinstance(arrays, types.NoneType):
        return lambda arrays, k, value: None

    def number(arrays, k, value):
        arrays[k] = value

    return number
