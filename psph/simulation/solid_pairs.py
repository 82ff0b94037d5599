"""The loops over the pairs of solids, whose neighbours are those of the reference (psph.physics.solid).

Two passes a step: the first gives each particle its flux B, which its neighbours read in the second.  Sums
are in gather form and in the order of ids, so that they are the same on any number of ranks.
"""

from typing import Any, NamedTuple

import numpy as np
from numba.core import types

from psph.composition import terms
from psph.composition.pair import fetch, take
from psph.composition.space import softened
from psph.composition.terms import added
from psph.engine.jit import compiled, elementwise, overload, overload_inside, register_jitable
from psph.engine.simd import spread, total, width_of
from psph.physics.solid.deformation import ReferencePair
from psph.simulation.solid_memory import across, advanced, energy, stress, thinned
from psph.smoothing import slope_over_r
from psph.vectors import (
    add,
    adjugate,
    applied,
    at,
    cofactor,
    determinant,
    dot,
    first_row,
    less_diagonal,
    matrix_product,
    nearest_image,
    norm_squared,
    outer,
    product_transposed,
    put,
    scale,
    subtract,
    trace,
    transposed_product,
    zero_like,
)

LEAST_MOMENT = 1e-9
"""Determinant of Σ V g X Xᵀ, 1 in the bulk, below which neighbours do not span space: no stress then."""


class Matter(NamedTuple):
    """What the rows of solids are made of.

    ``laws`` are the different laws, and ``number`` has that of each row.  By the number of a solid's
    material, that of its law: ``stiffness`` αE_Y of the hourglass control in Pa, ``viscosity`` in Pa s,
    ``density`` in the reference in kg/m³.  ``sums`` are what the first pass gathers
    (psph.physics.solid.deformation).  Of each row ``intact`` is the part of its bonds that hold, None where
    none can be cut: its stress and energy are so much less (psph.physics.solid.cracks).  ``share`` is the
    part of its volume that counts for the stress, None where all of it does (psph.physics.solid.shares).
    ``following`` lets pressures follow faces, None where there are none.
    """

    laws: tuple
    sums: tuple
    number: Any
    stiffness: Any
    viscosity: Any
    density: Any
    intact: Any = None
    share: Any = None
    following: Any = None


class Following(NamedTuple):
    """Where the acceleration by loads is made up, at the ``columns`` of rows: ``drawn`` = ``pulled`` + cof F
    ``pushed``, since a face n da was cof F N dA (Nanson)."""

    columns: Any
    pulled: Any
    pushed: Any
    drawn: Any


class Weights(NamedTuple):
    """How a pair is weighed: the ``kernel`` of solids, the ``periods`` in m, and the ``softening`` of lanes
    behind the end of a row (psph.composition.space).  ``finer`` is the spacing of the lattice, of which the
    kernel is, over that of the solid of each row; None where all have that of the lattice."""

    kernel: Any
    periods: tuple
    softening: Any
    finer: Any = None


class Rows(NamedTuple):
    """The solids of a rank and their partners: ``records`` of what is read of them, as ``shown`` says, and
    the ``lists`` of rows, one for each solid particle that the rank owns."""

    shown: Any
    records: Any
    lists: Any


@register_jitable
def reference_pair(weights, k, i, j, softening):
    """The pair of the views ``i``, of row ``k``, and ``j`` in the reference."""
    apart = nearest_image(subtract(i.reference, j.reference), weights.periods)
    r = stretched(weights.finer, k, np.sqrt(dot(apart, apart) + softening))
    weight = -j.volume * slope_over_r(weights.kernel, r, 1.0 / r)
    return ReferencePair(apart, stretched(weights.finer, k, stretched(weights.finer, k, weight)))


def stretched(finer, k, value):
    """n ``value``, n the spacing of the lattice over that of the solid of row ``k``: at n r the kernel of the
    lattice weighs as that of the solid does at r, V_j g_ij = n² V g(n r), with V the volume of a cell."""
    return value if finer is None else finer[k] * value


@overload(stretched)
def _typed_stretched(finer, k, value):
    if isinstance(finer, types.NoneType):
        return lambda finer, k, value: value
    return lambda finer, k, value: finer[k] * value


def own_volume(finer, k, i):
    """V of the particle ``i`` of row ``k``, m^d."""
    return i.volume if finer is None else i.volume / finer[k] ** len(i.reference)


@overload(own_volume)
def _typed_own_volume(finer, k, i):
    if isinstance(finer, types.NoneType):
        return lambda finer, k, i: i.volume
    return lambda finer, k, i: i.volume / finer[k] ** len(i.reference)


@register_jitable
def inner_force(weights, i, j, pair, stiffness):
    """A neighbour's share of ρ₀ a_i, N/m³: V_j g_ij [(B_i + B_j) X_ij − αE_Y x_ij]."""
    x_ij = nearest_image(subtract(i.position, j.position), weights.periods)
    push = subtract(applied(add(i.flux, j.flux), pair.apart), scale(x_ij, stiffness))
    return scale(push, pair.weight)


@compiled
def sum_moments(first, last, weights, rows, moment):
    """L_i of the rows ``first`` to ``last``, into ``moment``; zeros where neighbours do not span space."""
    records, lists = rows.records, rows.lists
    for k in range(np.uint64(first), np.uint64(last)):
        i = take(rows.shown, k)
        sums = spread(outer(zero_like(i.reference)), records)
        begin = lists.begin[k]
        end = begin + np.uint64(lists.lengths[k])
        for n in range(begin, end, width_of(records)):
            j = fetch(rows.shown, records, lists.lists, n)
            pair = reference_pair(weights, k, i, j, softened(weights.softening, end - n))
            sums = add(sums, scale(outer(pair.apart), pair.weight))
        whole = total(sums)
        spanned = determinant(whole, i.reference)
        inverse = 1.0 / spanned if spanned > LEAST_MOMENT else 0.0
        put(moment, k, scale(adjugate(whole, i.reference), inverse))


@compiled
def sum_gradients(first, last, matter, weights, rows, moment, memory, flux):
    """F_i of the rows ``first`` to ``last``, and from it B_i into ``flux``; what yields is remembered in
    ``memory`` (psph.simulation.solid_memory)."""
    records, lists = rows.records, rows.lists
    for k in range(np.uint64(first), np.uint64(last)):
        i = take(rows.shown, k)
        totals = spread(terms.start(matter.sums, i), records)
        begin = lists.begin[k]
        end = begin + np.uint64(lists.lengths[k])
        for n in range(begin, end, width_of(records)):
            j = fetch(rows.shown, records, lists.lists, n)
            pair = reference_pair(weights, k, i, j, softened(weights.softening, end - n))
            totals = terms.gather_each(matter.sums, totals, i, j, pair)
        folded = terms.fold_each(matter.sums, totals)
        number, a = matter.number[k], i.reference
        inverse = at(moment, k)
        f = matrix_product(folded[0], inverse, a)
        follow(matter.following, matter.laws, number, k, f, a)
        p = advanced(matter.laws, number, memory, k, f, a)
        p = weakened(p, matter.intact, k)
        p = added(p, drag(matter.viscosity[number], f, folded, inverse, a))
        against = matrix_product(weakened(p, matter.share, k), inverse, a)
        put(flux, k, subtract(scale(f, 0.5 * matter.stiffness[number]), against))


def follow(following, laws, number, k, f, a):
    """Let pressures push row ``k`` across its faces as they are."""
    if following is not None:
        _follow(following, laws, number, k, f, a)


def _follow(following, laws, number, k, f, a):
    column = following.columns[k]
    pushed = applied(cofactor(f, a), at(following.pushed, column))
    pushed = scale(pushed, thinned(laws, number, f, a))
    put(following.drawn, column, add(at(following.pulled, column), pushed))


@overload_inside(follow)
def _typed_follow(following, laws, number, k, f, a):
    if isinstance(following, types.NoneType):
        return lambda following, laws, number, k, f, a: None
    return _follow


def weakened(values, intact, k):
    """What the law of row ``k`` gives, as far as its bonds hold, or as its share counts."""
    return values if intact is None else scale(values, intact[k])


@overload(weakened)
def _typed_weakened(values, intact, k):
    if isinstance(intact, types.NoneType):
        return lambda values, intact, k: values
    return lambda values, intact, k: scale(values, intact[k])


def drag(viscosity, f, folded, inverse, a):
    """F η Ė of Kelvin and Voigt, Ė = sym(FᵀḞ), Pa; None where no rate was summed."""
    if len(folded) == 1:
        return None
    rate = matrix_product(folded[1], inverse, a)
    return matrix_product(f, scale(transposed_product(f, rate, a), viscosity), a)


@overload(drag)
def _typed_drag(viscosity, f, folded, inverse, a):
    if len(folded) == 1:
        return lambda viscosity, f, folded, inverse, a: None
    return _voigt if len(a) < SPATIAL else None


@overload_inside(drag)
def _typed_drag_in_3d(viscosity, f, folded, inverse, a):
    return _voigt if len(folded) > 1 and len(a) == SPATIAL else None


def _voigt(viscosity, f, folded, inverse, a):
    rate = matrix_product(folded[1], inverse, a)
    return matrix_product(f, scale(transposed_product(f, rate, a), viscosity), a)


SPATIAL = 3
"""Dimensions in which LLVM would leave the friction of a solid as a call."""


@compiled
def sum_inner_forces(first, last, matter, weights, rows, force):
    """ρ₀ a_i of the rows ``first`` to ``last`` by the stress and the hourglass control, N/m³."""
    records, lists = rows.records, rows.lists
    for k in range(np.uint64(first), np.uint64(last)):
        i = take(rows.shown, k)
        stiffness = matter.stiffness[matter.number[k]]
        sums = spread(zero_like(i.reference), records)
        begin = lists.begin[k]
        end = begin + np.uint64(lists.lengths[k])
        for n in range(begin, end, width_of(records)):
            j = fetch(rows.shown, records, lists.lists, n)
            pair = reference_pair(weights, k, i, j, softened(weights.softening, end - n))
            sums = add(sums, inner_force(weights, i, j, pair, stiffness))
        put(force, k, total(sums))


@compiled
def measure(first, last, matter, weights, rows, moment, memory, found):
    """Energy in J and Cauchy stress in Pa of the rows ``first`` to ``last``.

    ``found``: arrays of the energy, the components of the stress, the von Mises stress, and σ_zz of plane
    strain.
    """
    records, lists = rows.records, rows.lists
    for k in range(np.uint64(first), np.uint64(last)):
        i = take(rows.shown, k)
        totals = spread(terms.start(matter.sums, i), records)
        begin = lists.begin[k]
        end = begin + np.uint64(lists.lengths[k])
        for n in range(begin, end, width_of(records)):
            j = fetch(rows.shown, records, lists.lists, n)
            pair = reference_pair(weights, k, i, j, softened(weights.softening, end - n))
            totals = terms.gather_each(matter.sums, totals, i, j, pair)
        folded = terms.fold_each(matter.sums, totals)
        number, a = matter.number[k], i.reference
        f = matrix_product(folded[0], at(moment, k), a)
        misfit = spread(0.0, records)
        for n in range(begin, end, width_of(records)):
            j = fetch(rows.shown, records, lists.lists, n)
            pair = reference_pair(weights, k, i, j, softened(weights.softening, end - n))
            x_ij = nearest_image(subtract(i.position, j.position), weights.periods)
            off = subtract(applied(f, pair.apart), x_ij)
            misfit = misfit + pair.weight * dot(off, off)
        held = 0.25 * matter.stiffness[number] * total(misfit)
        dilated = dot(first_row(f, a), first_row(cofactor(f, a), a))
        if dilated == 0.0:  # its neighbours do not span space
            found[0][k] = own_volume(weights.finer, k, i) * held
            put(found[1], k, scale(outer(a), 0.0))
            found[2][k] = found[3][k] = 0.0
            continue
        dilated *= thinned(matter.laws, number, f, a)
        stored = weakened((energy(matter.laws, number, memory, k, f, a),), matter.intact, k)
        stored = weakened(stored, matter.share, k)
        found[0][k] = own_volume(weights.finer, k, i) * (stored[0] + held)
        p = weakened(stress(matter.laws, number, memory, k, f, a), matter.intact, k)
        cauchy = scale(product_transposed(p, f, a), 1.0 / dilated)
        put(found[1], k, cauchy)
        sigma_zz = weakened((across(matter.laws, number, memory, k, f, a) / dilated,), matter.intact, k)
        found[2][k] = mises(cauchy, sigma_zz[0], a)
        found[3][k] = sigma_zz[0]


def mises(cauchy, sigma_zz, a):
    """√(3/2 s:s) of the deviator s, Pa; ``sigma_zz`` counts in 2D alone."""
    return _mises_in_plane(cauchy, sigma_zz, a) if len(a) < 3 else _mises(cauchy, sigma_zz, a)


def _mises(cauchy, sigma_zz, a):
    mean = trace(cauchy, a) / 3.0
    return np.sqrt(1.5 * norm_squared(less_diagonal(cauchy, mean, a), a))


def _mises_in_plane(cauchy, sigma_zz, a):
    mean = (trace(cauchy, a) + sigma_zz) / 3.0
    inside = norm_squared(less_diagonal(cauchy, mean, a), a)
    return np.sqrt(1.5 * (inside + (sigma_zz - mean) ** 2))


@overload(mises)
def _typed_mises(cauchy, sigma_zz, a):
    assert isinstance(a, types.BaseTuple)
    return _mises_in_plane if len(a) < 3 else _mises


@elementwise
def fill_places(first, last, data, rows, columns, table, place):
    """Copy ``data[rows[f], columns[k]]`` to ``table[k, place + f]`` for the rows ``first`` to ``last``."""
    for k in range(np.uint64(first), np.uint64(last)):
        for f in range(np.uint64(len(rows))):
            table[k, place + f] = data[rows[f], columns[k]]


@elementwise
def push_solids(first, last, effects, view, columns, inverse_density, force, drawn, share, acceleration):
    """a of the rows ``first`` to ``last`` into their columns: body forces, loads, and inner forces.

    ``effects`` None: a pass over neighbours in space has put contacts and body forces there.  The ``share``
    (n,) of the loads ``drawn`` acts now; both are None where there are none.
    """
    for k in range(np.uint64(first), np.uint64(last)):
        column = columns[k]
        a = begun(effects, view, column, acceleration)
        a = added(a, pulled(drawn, share, column, k))
        put(acceleration, column, add(a, scale(at(force, k), inverse_density[k])))


def begun(effects, view, column, acceleration):
    """The acceleration of a particle but for that by its own solid, m/s²."""
    return at(acceleration, column) if effects is None else terms.body(effects, take(view, column))


@overload(begun)
def _typed_begun(effects, view, column, acceleration):
    if isinstance(effects, types.NoneType):
        return lambda effects, view, column, acceleration: at(acceleration, column)
    return lambda effects, view, column, acceleration: terms.body(effects, take(view, column))


def pulled(drawn, share, column, k):
    """The loads on a particle, m/s²; None where there are none."""
    return None if drawn is None else scale(at(drawn, column), share[k])


@overload(pulled)
def _typed_pulled(drawn, share, column, k):
    if isinstance(drawn, types.NoneType):
        return lambda drawn, share, column, k: None
    return lambda drawn, share, column, k: scale(at(drawn, column), share[k])
