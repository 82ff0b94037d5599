"""Fluids that start relaxed: whose places are still to be found, and what holds them in their shapes.

How they find them says psph.simulation.relaxing.
"""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from psph.composition.reflections import BELOW
from psph.scene.lattice import Lattice, sites_between
from psph.scene.layout import NONE, Layout

ITERATIONS = 200
"""Steps in which they find their places."""


class Held(NamedTuple):
    """Sites that stand still while fluids relax: their numbers ``id`` (n,), who has them, ``part`` (n,), NONE
    where nobody does, and where they are, ``position`` (n, dim) m."""

    id: np.ndarray
    part: np.ndarray
    position: np.ndarray


def relaxing(layout: Layout) -> list[int]:
    """The numbers of the parts that start relaxed."""
    return [part.number for part in layout.parts if part.relaxes]


def wider(layout: Layout) -> Lattice:
    """The lattice as far as a fluid of the scene feels others: to the ends of a period, to a mirror, else
    beyond its own ends by the depth of a wall that acts."""
    lattice, deep = layout.lattice, layout.wall_reach
    first, last = list(lattice.first), [k + n for k, n in zip(lattice.first, lattice.counts)]
    for d, period in enumerate(layout.periods):
        if period is not None:
            ends = layout.lower[d], layout.upper[d], lattice.origin[d], lattice.spacing
            first[d], last[d] = sites_between(*ends)
        else:
            sides = [plane.side for plane in layout.mirror_planes if plane.axis == d]
            first[d] -= 0 if BELOW in sides else deep
            last[d] += 0 if -BELOW in sides else deep
    counts = tuple(b - a for a, b in zip(first, last))
    return replace(lattice, first=tuple(first), counts=counts)


def held_sites(layout: Layout, moving: list[int], first: int, last: int) -> Held:
    """The sites of planes ``first`` to ``last - 1`` of the wider lattice that hold the ``moving`` parts in
    their shapes.

    They are of all other parts, of other ones that move too, and of none: so a free surface stays flat, and
    every wall is as one of particles.
    """
    wide = replace(layout, lattice=wider(layout))
    found = [_held(wide, moving, begin, end) for begin, end in wide.lattice.chunks(first, last)]
    empty = Held(np.empty(0, np.int64), np.empty(0, np.uint8), np.empty((0, layout.dimensions)))
    return Held(*map(np.concatenate, zip(empty, *found)))


def _held(wide: Layout, moving: list[int], begin: int, end: int) -> Held:
    lattice, deep = wide.lattice, wide.wall_reach
    around = _planes(wide, begin - deep, end + deep)
    inner = slice(deep, deep + end - begin)
    own, near = around[inner], np.zeros(around[inner].shape, bool)
    for part in moving:
        beside = around == part
        for k, d in enumerate(lattice.axes):
            beside = np.moveaxis(_spread(np.moveaxis(beside, k, 0), deep, bool(wide.periods[d])), 0, k)
        near |= beside[inner] & (own != part)
    sites = np.flatnonzero(near)
    grid = lattice.grid(begin, end)
    places = [np.broadcast_to(x, own.shape).ravel()[sites] for x in grid]
    return Held(sites + begin * lattice.sites_in_plane, own.ravel()[sites], np.stack(places, axis=1))


def _planes(wide: Layout, begin: int, end: int) -> np.ndarray:
    """Who holds the sites of some planes of the wider lattice, none beyond its ends but in a period."""
    planes, repeats = wide.lattice.planes, wide.periods[wide.axis] is not None
    nobody = np.full(wide.lattice.shape(0, 1), NONE, np.uint8)
    each = (k % planes if repeats else k for k in range(begin, end))
    return np.concatenate([wide.materials(k, k + 1) if 0 <= k < planes else nobody for k in each])


def _spread(held: np.ndarray, deep: int, repeats: bool) -> np.ndarray:
    """True along the first axis wherever True is at most ``deep`` places away."""
    ends = ((deep, deep), *[(0, 0)] * (held.ndim - 1))
    wide = np.pad(held, ends, mode="wrap" if repeats else "constant")
    return np.logical_or.reduce([wide[k : k + len(held)] for k in range(2 * deep + 1)])
