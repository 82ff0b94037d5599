"""Self-gravity by a tree: masses far away are pulled by as cells, with their second moments, near ones one
by one.

Barnes & Hut (1986), Nature 324, 446; which cells are far: Springel, Yoshida & White (2001), New Astron. 6,
79."""

from typing import Any, NamedTuple

import numpy as np

from psph.engine.jit import compiled, inside, register_jitable
from psph.engine.settled import settled
from psph.engine.simd import EIGHT, consecutive, spread, total, width_of
from psph.engine.threads import in_threads
from psph.particles.octree import PARTS, Moments, Octree, largest_in_cells, moments, octree
from psph.physics.self_gravity import softened
from psph.simulation.masses import ID, MASS, OLD, PLACE, SIZE, WHOLE, Pulled
from psph.simulation.reaching import (
    Alike,
    BySize,
    field_of,
    is_past_reach,
    note_reach,
    own_reach,
    reach_of_cells,
)
from psph.vectors import add, dot, scale, subtract

SOME = 1024
"""Entries of a list for which there is room at first."""


FARTHEST = 0.9
"""Share of a cell's distance within which all of it lies at the most, where it counts as one."""

FIRST = 0.7
"""The same at the start, where no pull is known."""


class Source(NamedTuple):
    """What pulls: the ``tree``, its ``moments``, G as ``factor``, H as ``reach``
    (psph.simulation.reaching), and which cells count as one: those within ``opening`` r at the distance r,
    where M b⁴/r⁶ < ``allowed`` (n,), kg/m², of all of the particles that are pulled, in the order of the
    tree; b is how far the cell reaches from its centre."""

    tree: Octree
    moments: Moments
    factor: float
    reach: Any
    opening: float
    allowed: np.ndarray


class TreeSum:
    """The sum by a tree over all particles, the same on each rank, with G as ``factor``, H as ``reach``, m,
    None where rows have it.

    A cell of mass M within b at the distance r counts as one where GM b⁴/r⁶ < ``accuracy`` |a|, a the pull
    of the step before.  ``pairs`` and ``cells`` are how many pairs of particles, and of particles and
    cells, this rank's last sum had."""

    turns_at_start = 2
    """It rests on the pulls of the step before."""

    def __init__(self, factor: float, reach: float | None, accuracy: float):
        self._factor, self._reach, self._accuracy = factor, reach, accuracy
        self._loop, self.pairs, self.cells = settled(pull_groups), 0, 0

    def renew(self, rows: np.ndarray, pulled: Pulled) -> int:
        """Fill the pulls of all ``rows``; returns the bytes that it holds beside them."""
        tree = octree(rows[:, PLACE])
        column = np.full(len(rows), -1)
        column[np.searchsorted(rows[:, ID], pulled.id)] = pulled.columns
        column, old = column[tree.order], rows[tree.order, OLD]
        known = bool(old.any())
        allowed = old * (self._accuracy / self._factor) if known else np.full(len(rows), np.inf)
        opening = FARTHEST if known else FIRST
        self.pairs = self.cells = held = 0
        reach = Alike(self._reach)
        if self._reach is None:
            sizes = np.ascontiguousarray(rows[tree.order, SIZE])
            reach = BySize(sizes, largest_in_cells(tree, sizes))
        for whole, pull, energy in pulled.parts:
            weights = moments(tree, np.where(rows[:, WHOLE] == whole, rows[:, MASS], 0.0))
            source = Source(tree, weights, self._factor, reach, opening, allowed)
            for pairs, cells in in_threads(self._loop, 0, len(tree.groups), source, column, pull, energy):
                self.pairs, self.cells = self.pairs + pairs, self.cells + cells
            held = sum(one.nbytes for one in (*tree, *weights, column, allowed))
        return held


@register_jitable
def softened_second(r, reach):
    """(1/r) d/dr of −g, 1/m⁵, and (1/r) d/dr of that, 1/m⁷, for the g of
    :func:`psph.physics.self_gravity.softened`; beyond the reach 3/r⁵ and −15/r⁷."""
    newton = 1.0 / max(r, reach)
    u = max(r * newton, 1e-9)
    newton2 = newton * newton
    five = newton2 * newton2 * newton
    second = 168.0 + u * (-420.0 + u * (360.0 - 105.0 * u))
    third = (-420.0 + u * (720.0 - 315.0 * u)) / u
    return five * second, five * newton2 * third


@inside
def longer(lists, room):
    """The ``lists`` (parts, n) with ``room`` for more, in whole registers."""
    held = lists.shape[1]
    if room + EIGHT <= held:
        return lists
    more = np.ones((lists.shape[0], 2 * (room + EIGHT)))
    more[:, :held] = lists
    return more


@inside
def fill_up(lists, count, heavy):
    """``count`` rounded up to whole registers; what fills them has no mass in the parts from 3 to
    ``heavy``."""
    full = (count + EIGHT - 1) // EIGHT * EIGHT
    for n in range(count, full):
        for part in range(lists.shape[0]):
            lists[part, n] = 0.0 if 3 <= part < heavy else lists[part, 0]
    return full


@inside
def look(group, source, near, far):
    """Write what the particles of the cell ``group`` see: particles into ``near`` (5, n), cells into ``far``
    (PARTS, n).  Returns both, longer where that is needed, and how many of each there are."""
    tree, cells, radius2 = source.tree, source.moments.cells, source.moments.radius2
    mass, places, opening2 = source.moments.mass, tree.places, source.opening * source.opening
    allowed, own = np.inf, 0.0
    for k in range(tree.first[group], tree.last[group]):
        allowed, own = min(allowed, source.allowed[k]), max(own, own_reach(source.reach, k))
    many, much, cell = 0, 0, 0
    while cell < len(tree.first):
        apart2 = 0.0
        for a in range(3):
            x = cells[cell, a]
            away = max(tree.lower[a, group] - x, x - tree.upper[a, group], 0.0)
            apart2 += away * away
        b2, counts = radius2[cell], cells[cell, 3] > 0.0
        far_away = b2 < opening2 * apart2 and cells[cell, 3] * b2 * b2 < allowed * apart2**3
        if counts and far_away and is_past_reach(source.reach, cell, own, apart2, b2):
            far = longer(far, much + 1)
            for part in range(PARTS):
                far[part, much] = cells[cell, part]
            much += 1
            cell = tree.skip[cell]
        elif not counts:
            cell = tree.skip[cell]
        elif tree.skip[cell] == cell + 1:
            near = longer(near, many + tree.last[cell] - tree.first[cell])
            for k in range(tree.first[cell], tree.last[cell]):
                if mass[k] > 0.0:
                    for a in range(3):
                        near[a, many] = places[a, k]
                    near[3, many] = mass[k]
                    note_reach(source.reach, k, near[4], many)
                    many += 1
            cell += 1
        else:
            cell += 1
    return near, far, many, much


@inside
def pull_of_particles(x, own, near, count, reach):
    """Σ m g x and Σ m f of ``count`` particles at the place ``x`` of one that reaches ``own``."""
    a, b, c, m, row = near
    sums, held = spread((0.0, 0.0, 0.0), m), spread(0.0, m)
    for n in range(np.uint64(0), np.uint64(count), width_of(m)):
        there = consecutive(a, n), consecutive(b, n), consecutive(c, n)
        away = subtract(there, x)
        g, f = field_of(reach, np.sqrt(dot(away, away)), own, row, n)
        mass = consecutive(m, n)
        sums = add(sums, scale(away, mass * g))
        held = held + mass * f
    return total(sums), total(held)


@inside
def pull_of_cells(x, far, count, reach):
    """The same of ``count`` cells: of M + ½ S:∇∇, S their second moments.

    φ = −G [M f + ½ (tr S d₁ + yᵀSy d₂)], y from the cell's centre to ``x``, d₁ = −g, d₂ = d₁′/r, d₃ = d₂′/r.
    """
    a, b, c, m, s0, s1, s2, s3, s4, s5 = far
    sums, held = spread((0.0, 0.0, 0.0), m), spread(0.0, m)
    for n in range(np.uint64(0), np.uint64(count), width_of(m)):
        there = consecutive(a, n), consecutive(b, n), consecutive(c, n)
        y = subtract(there, x)
        r = np.sqrt(dot(y, y))
        g, f = softened(r, reach)
        second, third = softened_second(r, reach)
        xx, xy, xz = consecutive(s0, n), consecutive(s1, n), consecutive(s2, n)
        yy, yz, zz = consecutive(s3, n), consecutive(s4, n), consecutive(s5, n)
        turned = (
            xx * y[0] + xy * y[1] + xz * y[2],
            xy * y[0] + yy * y[1] + yz * y[2],
            xz * y[0] + yz * y[1] + zz * y[2],
        )
        along, trace = dot(y, turned), xx + yy + zz
        mass = consecutive(m, n)
        straight = mass * g - 0.5 * (trace * second + along * third)
        sums = add(sums, subtract(scale(y, straight), scale(turned, second)))
        held = held + mass * f + 0.5 * (along * second - trace * g)
    return total(sums), total(held)


@compiled
def pull_groups(first, last, source, column, pull, energy):
    """a = −G Σ_j m_j g x_ij and ½φ of the particles in the groups ``first`` to ``last`` whose ``column``
    (n,), in the order of the tree, is one of this rank's, else -1.  Returns how many pairs of particles,
    and of particles and cells, that took."""
    near, far = np.ones((5, SOME)), np.empty((PARTS, SOME))
    pairs, seen = 0, 0
    for number in range(first, last):
        group, due = source.tree.groups[number], 0
        for k in range(source.tree.first[group], source.tree.last[group]):
            due += column[k] >= 0
        if due == 0:
            continue
        near, far, many, much = look(group, source, near, far)
        pairs, seen = pairs + due * many, seen + due * much
        many, much = fill_up(near, many, 4), fill_up(far, much, PARTS)
        for k in range(source.tree.first[group], source.tree.last[group]):
            if column[k] < 0:
                continue
            x = source.tree.places[0, k], source.tree.places[1, k], source.tree.places[2, k]
            one, by_one = pull_of_particles(x, own_reach(source.reach, k), near, many, source.reach)
            other, by_other = pull_of_cells(x, far, much, reach_of_cells(source.reach))
            for a in range(3):
                pull[a][column[k]] = source.factor * (one[a] + other[a])
            energy[column[k]] = -0.5 * source.factor * (by_one + by_other)
    return pairs, seen
