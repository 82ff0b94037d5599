"""An octree over particles: cells in cells, each split in eight while it holds more than a few.

Cells are those of one grid over all particles, which are in the order of their cells' numbers (Morton keys)
and, within a cell, as they came.  So the tree and its moments have the same bits on every rank that is
given the same particles in the same order.  Barnes & Hut (1986), Nature 324, 446."""

from typing import NamedTuple

import numpy as np

from psph.engine.jit import elementwise, inside

BITS = 21
"""Halvings of each axis: three fill a whole number of 63 bits."""

LEAF = 8
"""Particles that a cell holds without being split."""

GROUP = 128
"""Particles at the most that see all else in the same way: those of a cell."""

PARTS = 10
"""Numbers of a cell's moments: the three of its centre, its mass, and six of its second moment."""


class Octree(NamedTuple):
    """Cells in the order of a walk that goes down first, (cells,) each.

    ``order`` (n,) are the particles as they came, in the order of their keys, ``places`` (3, n) where they
    are from the lowest corner on, m.  A cell has those from ``first`` to before ``last``; the walk goes on
    with the next cell, or, past all within this one, with that of ``skip``.  ``parent`` is -1 for the
    first; ``lower`` and ``upper`` (3, cells), m, are the box of its particles.  ``groups`` are the cells
    whose particles are summed for together: each particle is in one."""

    order: np.ndarray
    places: np.ndarray
    first: np.ndarray
    last: np.ndarray
    skip: np.ndarray
    parent: np.ndarray
    lower: np.ndarray
    upper: np.ndarray
    groups: np.ndarray


class Moments(NamedTuple):
    """What cells weigh, for one mass of the particles: ``mass`` (n,), kg, in the order of the tree.

    ``cells`` (cells, PARTS): centre of mass, m, mass, kg, and Σ m x xᵀ about the centre, kg m²: xx, xy, xz,
    yy, yz, zz.  ``radius2`` (cells,), m²: squared distance from the centre to the farthest corner of the
    box."""

    mass: np.ndarray
    cells: np.ndarray
    radius2: np.ndarray


def octree(position: np.ndarray) -> Octree:
    """The tree of particles at ``position`` (n, 3), m."""
    corner = position.min(axis=0, initial=np.inf)
    side = float((position.max(axis=0, initial=-np.inf) - corner).max(initial=0.0))
    places = np.ascontiguousarray(position.T) - corner[:, None]
    keys = np.empty(len(position), np.uint64)
    number_cells(places, 2.0**BITS / side if side > 0.0 else 0.0, keys)
    order = np.argsort(keys, kind="stable")
    keys, places = keys[order], np.ascontiguousarray(places[:, order])
    first, last, skip, parent, groups = split(keys)
    lower, upper = np.empty((2, 3, len(first)))
    find_boxes(places, first, last, skip, parent, lower, upper)
    return Octree(order, places, first, last, skip, parent, lower, upper, groups)


def moments(tree: Octree, mass: np.ndarray) -> Moments:
    """Of particles of this ``mass`` (n,), kg, as they came."""
    mass = np.ascontiguousarray(mass[tree.order])
    cells, radius2 = np.zeros((len(tree.first), PARTS)), np.zeros(len(tree.first))
    weigh(tree, mass, cells, radius2)
    return Moments(mass, cells, radius2)


@inside
def spaced(number):
    """The bits of a whole number below 2²¹, each three places from the next."""
    number = (number | number << np.uint64(32)) & np.uint64(0x1F00000000FFFF)
    number = (number | number << np.uint64(16)) & np.uint64(0x1F0000FF0000FF)
    number = (number | number << np.uint64(8)) & np.uint64(0x100F00F00F00F00F)
    number = (number | number << np.uint64(4)) & np.uint64(0x10C30C30C30C30C3)
    return (number | number << np.uint64(2)) & np.uint64(0x1249249249249249)


@elementwise
def number_cells(places, scale, keys):
    """Morton keys of the smallest cells at ``places`` (3, n), ``scale`` of them a metre."""
    for k in range(len(keys)):
        key = np.uint64(0)
        for a in range(3):
            cell = min(np.int64(places[a, k] * scale), (1 << BITS) - 1)
            key |= spaced(np.uint64(cell)) << np.uint64(2 - a)
        keys[k] = key


@inside
def shared_levels(a, b):
    """How many halvings two keys have in common."""
    differ, level = a ^ b, BITS
    while differ:
        differ >>= np.uint64(3)
        level -= 1
    return level


@elementwise
def split(keys):
    """Cells of particles with these rising ``keys``, each with more than one part: first and last particle,
    where a walk goes on past it, its parent, and the cells that are groups."""
    room = max(2 * len(keys), 1)
    first, last = np.empty(room, np.int64), np.empty(room, np.int64)
    skip, parent = np.empty(room, np.int64), np.empty(room, np.int64)
    groups = np.empty(len(keys), np.int64)
    waiting = np.empty((8 * BITS + 8, 3), np.int64)
    waits, cells, many = 0, 0, 0
    if len(keys):
        waiting[0] = 0, len(keys), -1
        waits = 1
    while waits:
        waits -= 1
        begin, end, above = waiting[waits]
        cell, cells = cells, cells + 1
        first[cell], last[cell], parent[cell], skip[cell] = begin, end, above, 0
        level = shared_levels(keys[begin], keys[end - 1])
        whole = end - begin <= LEAF or level == BITS
        within = above >= 0 and last[above] - first[above] <= GROUP
        if (end - begin <= GROUP or whole) and not within:
            groups[many] = cell
            many += 1
        if whole:
            continue
        # From the last of the eight on, so that the first waits on top.
        shift = np.uint64(3 * (BITS - 1 - level))
        stop = end
        while stop > begin:
            octant, start = keys[stop - 1] >> shift, stop - 1
            while start > begin and keys[start - 1] >> shift == octant:
                start -= 1
            waiting[waits] = start, stop, cell
            waits += 1
            stop = start
    for cell in range(cells - 1, -1, -1):
        if skip[cell] == 0:
            skip[cell] = cell + 1
        above = parent[cell]
        if above >= 0 and skip[above] == 0:
            skip[above] = skip[cell]
    return first[:cells], last[:cells], skip[:cells], parent[:cells], groups[:many]


@elementwise
def largest_in_cells(tree, values):
    """The largest of the ``values`` (n,), in the order of the tree, in each cell."""
    largest = np.zeros(len(tree.first))
    for cell in range(len(largest)):
        for k in range(tree.first[cell], tree.last[cell]):
            largest[cell] = max(largest[cell], values[k])
    return largest


@elementwise
def find_boxes(places, first, last, skip, parent, lower, upper):
    """The boxes of the particles of all cells."""
    lower[:], upper[:] = np.inf, -np.inf
    for cell in range(len(first) - 1, -1, -1):
        for a in range(3):
            if skip[cell] == cell + 1:
                for k in range(first[cell], last[cell]):
                    lower[a, cell] = min(lower[a, cell], places[a, k])
                    upper[a, cell] = max(upper[a, cell], places[a, k])
            above = parent[cell]
            if above >= 0:
                lower[a, above] = min(lower[a, above], lower[a, cell])
                upper[a, above] = max(upper[a, above], upper[a, cell])


@elementwise
def weigh(tree, mass, cells, radius2):
    """Moments of all cells, those of the parts of a cell before its own; leaves add up particles, others
    parts."""
    for cell in range(len(cells) - 1, -1, -1):
        own, above = cells[cell], tree.parent[cell]
        if tree.skip[cell] == cell + 1:
            for k in range(tree.first[cell], tree.last[cell]):
                for a in range(3):
                    own[a] += mass[k] * tree.places[a, k]
                own[3] += mass[k]
        if above >= 0:
            for a in range(4):
                cells[above, a] += own[a]
        for a in range(3):
            own[a] = own[a] / own[3] if own[3] > 0.0 else tree.lower[a, cell]
            far = max(own[a] - tree.lower[a, cell], tree.upper[a, cell] - own[a])
            radius2[cell] += far * far
    for cell in range(len(cells) - 1, -1, -1):
        own, above = cells[cell], tree.parent[cell]
        if tree.skip[cell] == cell + 1:
            for k in range(tree.first[cell], tree.last[cell]):
                x = tree.places[0, k] - own[0], tree.places[1, k] - own[1], tree.places[2, k] - own[2]
                add_second(own, mass[k], x)
        if above >= 0:
            x = own[0] - cells[above, 0], own[1] - cells[above, 1], own[2] - cells[above, 2]
            add_second(cells[above], own[3], x)
            for part in range(4, PARTS):
                cells[above, part] += own[part]


@inside
def add_second(moment, mass, x):
    """Add to a second ``moment`` that of a ``mass`` at ``x``."""
    moment[4] += mass * x[0] * x[0]
    moment[5] += mass * x[0] * x[1]
    moment[6] += mass * x[0] * x[2]
    moment[7] += mass * x[1] * x[1]
    moment[8] += mass * x[1] * x[2]
    moment[9] += mass * x[2] * x[2]
