"""Particles get the state of those of other levels of sizes whom they follow, by the shares of a fit
(:mod:`psph.simulation.level_fit`)."""

from typing import Any, NamedTuple

import numpy as np

from psph.engine.jit import elementwise
from psph.formula import helper
from psph.particles.records import aligned
from psph.simulation.surface_rows import borne, weighed
from psph.vectors import add, at, dot, multiply, put, scale, subtract

NUMBERS = 8
"""Of those who lead: one cache line."""


class OfLeaders(NamedTuple):
    """The arrays of all columns that are read of those who lead, what forces read, and written of those who
    follow (columns,)."""

    velocity: Any
    predicted: Any
    volume: Any
    pressure: Any
    density: Any


class AsLed(NamedTuple):
    """What is read of those who lead, side by side in memory: their ``density`` by their volume, kg/m³, their
    ``pressure``, Pa, ρ g times the ``depth`` at which their rows bear it, Pa, and their ``velocity``, m/s,
    components (dim,); each (n,) of some ``columns`` (n,)."""

    density: np.ndarray
    pressure: np.ndarray
    depth: np.ndarray
    velocity: tuple[np.ndarray, ...]
    columns: np.ndarray


class WhoIsLed:
    """Those who are followed by any of the particles of ``dimensions`` in ``total`` columns, numbered as they
    are first met."""

    def __init__(self, dimensions: int, total: int):
        self.dimensions, self._count = dimensions, np.zeros(1, np.int64)
        self._number, self._columns = np.full(total, -1), np.zeros(total, np.int64)

    def number(self, followed) -> None:
        """Name whom some have ``followed`` by their numbers, no longer by their columns."""
        number_leaders(followed, self._number, self._columns, self._count)

    def rows(self) -> AsLed:
        """Room for the rows of all who have numbers."""
        count = int(self._count[0])
        # Two at the least: fewer count as contiguous, and loops that are settled read what they saw first.
        numbers = aligned(max(count, 2), NUMBERS, np.dtype(float)).T
        return AsLed(*numbers[:3], tuple(numbers[3 : 3 + self.dimensions]), self._columns[:count])


@elementwise
def number_leaders(followed, number, columns, count):
    """Give numbers to those who have none; ``count`` (1,) has how many have, and ``columns`` theirs."""
    for n in range(len(followed.begin)):
        first = followed.begin[n]
        for entry in range(first, first + followed.many[n].sum() + followed.beside[n].sum()):
            k = followed.column[entry]
            if number[k] < 0:
                number[k] = count[0]
                columns[count[0]] = k
                count[0] += 1
            followed.column[entry] = number[k]


@elementwise
def tell_rows(first, last, length, rows, state, led):
    """What ``led`` says of its columns from the ``first`` to the one before the ``last``, where all have a
    smoothing ``length`` in m."""
    for n in range(first, last):
        k = led.columns[n]
        led.density[n], led.pressure[n] = 1.0 / state.volume[k], state.pressure[k]
        led.depth[n] = weighed(rows, length[k], state.pressure[k])
        put(led.velocity, n, at(state.predicted, k))


@elementwise
def follow(first, last, columns, leaders, images, weighing, followed, state, led, fall):
    """Give some ``columns`` (n,) the state of those whom they have ``followed``, as ``led`` says, from the
    ``first`` to the one before the ``last``.  Whoever has too few falls, by ``fall`` (dim,) m/s."""
    for n in range(first, last):
        k = np.uint64(columns[n])
        if followed.many[n].sum():
            take_after(k, followed, n, leaders, images, weighing.rows, state, led)
        else:
            for d in range(len(fall)):
                state.velocity[d][k] += fall[d]
    # Few are beside walls.  Were they seen to in the loop above, that one would compile to code half as fast.
    for n in range(first, last):
        k = np.uint64(columns[n])
        if followed.many[n].sum() and followed.beside[n].sum():
            across_walls(k, followed, n, images, state, led)
        put(state.predicted, k, at(state.velocity, k))


@elementwise
def bear(first, last, columns, leaders, images, weighing, followed, state, led):
    """Give walls in some ``columns`` (n,) the density and the pressure of those whom they have ``followed``,
    as ``led`` says, from the ``first`` to the one before the ``last``; whoever has too few keeps its own."""
    for n in range(first, last):
        k = np.uint64(columns[n])
        own = at(state.velocity, k)
        if followed.many[n].sum():
            take_after(k, followed, n, leaders, images, weighing.rows, state, led)
        put(state.velocity, k, own)


@helper
def take_after(k, followed, n, leaders, images, rows, state, led):
    """Column ``k`` gets the sums of the shares of row ``n`` times what each has that it follows."""
    density, seen, depth, first = 0.0, 0.0, followed.deeper[n], followed.begin[n]
    velocity = scale(at(state.velocity, k), 0.0)
    for m in range(len(images.turn[0])):
        last, flow, moving = first + followed.many[n, m], 0.0, scale(velocity, 0.0)
        for entry in range(first, last):
            j, share, part = followed.column[entry], followed.share[entry], followed.flow[entry]
            density += share * led.density[j]
            seen += share * led.pressure[j]
            depth += share * led.depth[j]
            flow += part
            moving = add(moving, scale(at(led.velocity, j), part))
        velocity = add(velocity, multiply(at(images.turn_velocity, m), moving))
        velocity = add(velocity, scale(at(images.shift_velocity, m), flow))
        for entry in range(first, last if images.deeper[m] else first):
            j, share = followed.column[entry], followed.share[entry]
            at_j = led.columns[j]
            x_j = at(leaders.position, at_j)
            shown = add(multiply(at(images.turn, m), x_j), at(images.shift, m))
            beyond = dot(images.weight, subtract(shown, x_j))
            density += share * beyond * rows.softness
            seen += share * beyond
            borne_there = weighed(rows, leaders.length[at_j], led.pressure[j] + beyond)
            depth += share * (borne_there - led.depth[j])
        first = last
    pressure = borne(rows, leaders.length[k], depth)
    density += (pressure - seen) * rows.softness
    state.density[k], state.volume[k], state.pressure[k] = density, 1.0 / density, pressure
    put(state.velocity, k, velocity)


@helper
def across_walls(k, followed, n, images, state, led):
    """The velocity of column ``k`` across the walls beside row ``n`` becomes that between fluid and these,
    and all of it as far as these let nothing slip."""
    first, own, held = followed.begin[n], at(state.velocity, k), followed.held[n]
    apart, normal = scale(own, -1.0), at(followed.normal, n)
    for lot in (followed.many, followed.beside):
        for m in range(len(images.turn[0])):
            last, flow, moving = first + lot[n, m], 0.0, scale(own, 0.0)
            for entry in range(first, last):
                share = followed.across[entry]
                flow += share
                moving = add(moving, scale(at(led.velocity, followed.column[entry]), share))
            apart = add(apart, multiply(at(images.turn_velocity, m), moving))
            apart = add(apart, scale(at(images.shift_velocity, m), flow))
            first = last
    change = add(scale(apart, held), scale(normal, (1.0 - held) * dot(normal, apart)))
    put(state.velocity, k, add(own, change))
