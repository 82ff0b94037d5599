"""Who is close to each particle of a gas, found anew in each step among all that its list names.

Lists reach beyond the support, for motion and growth, and hold twice as many as are close.  One look at the
places of all parts these: the iteration of smoothing lengths and the forces go on with them alone.
"""

from typing import NamedTuple

import numpy as np
from numba.core import types

from psph.engine.jit import inside, overload, register_jitable
from psph.engine.simd import EIGHT, bits, consecutive, put_consecutive, turning, width_of
from psph.engine.threads import threads
from psph.particles.lanes import keep_entries, keep_lanes
from psph.vectors import dot, nearest_image, subtract

NEARER = 1.05
"""Of those in its list a particle meets who is within the larger support of both, by the h of the step
before, times this: a step seldom changes h by as much."""

ALL = 1e30
"""The same for who meets all of its list."""

AXES, NUMBERS = 3, 4
"""Of a particle in a table: its place, with zeros along axes that there are not, and h of the step before."""


class Images(NamedTuple):
    """Where images in mirrors stand: at ``turns`` x + ``shifts``, m, three numbers for each; a particle
    farther than ``reach`` m from a plane sees none."""

    turns: tuple[tuple[float, ...], ...]
    shifts: tuple[tuple[float, ...], ...]
    reach: float


def images_in(mirrors, reach: float) -> Images | None:
    """Those in ``mirrors`` (psph.composition.mirrors), seen up to ``reach`` m; None without mirrors."""
    if mirrors is None:
        return None
    seen = mirrors.reflections[1:]
    turns = tuple((*one.turn, *(1.0,) * (AXES - len(one.turn))) for one in seen)
    shifts = tuple((*one.shift, *(0.0,) * (AXES - len(one.shift))) for one in seen)
    return Images(turns, shifts, reach)


class SeenRows(NamedTuple):
    """What particles from column ``low`` on see: ``lists`` of all, and ``nearer``, rows to be filled of those
    that are close, each up to a ``multiple`` of entries; that of particle ``low`` + k begins no earlier than
    at ``room[k]``.  ``table`` (columns, 4) has places and h, m; ``mass``, kg, is one, or (columns,)."""

    low: int
    lists: object
    nearer: object
    multiple: int
    room: object
    table: object
    mass: object


class Met(NamedTuple):
    """Those close in a row: their ``entries``, ``distance``, m, and ``mass``, kg, where that differs.  All go
    on for a register."""

    entries: object
    distance: object
    mass: object


@inside
def meet(k, row, closer, beyond, end, asked, of, met):
    """Write who is within ``closer`` supports of particle ``k`` to its nearer row, from entry ``end`` on, and
    distances and masses, those of images too, to ``met``; how many there are without images, and with them.

    Lanes behind the last are ``beyond`` m away.
    """
    lists, table, begin = of.lists, of.table, of.lists.begin[row]
    listed, found, one = np.uint64(lists.lengths[row]), np.uint64(0), np.uint64(1)
    place, reach = (table[k, 0], table[k, 1], table[k, 2]), closer * asked.support
    for n in range(np.uint64(0), listed, width_of(table)):
        x, y, z, h = fetched(table, lists.lists, begin + n)
        x_ij = nearest_image(subtract(place, (x, y, z)), asked.periods)
        r2, far = dot(x_ij, x_ij), reach * max(h, table[k, AXES])
        others = (one << min(np.uint64(EIGHT), listed - n)) - one
        chosen = close_bits(r2, far) & others
        keep_entries(met.entries, found, lists.lists, begin + n, chosen, table)
        found = keep_lanes(met.distance, found, r2, chosen)
    for n in range(found):
        of.nearer.lists[end + n] = met.entries[n]
    take_masses(of.mass, of.nearer.lists, end, found, np.uint64(0), met.mass)
    for n in range(np.uint64(0), found, width_of(table)):
        put_consecutive(met.distance, n, np.sqrt(consecutive(met.distance, n)))
    many = with_images(asked.images, k, row, found, asked.periods, of, met)
    for n in range(many, many + np.uint64(EIGHT)):
        met.distance[n] = beyond
    return found, many


def close_bits(r2, far):
    """Bit t says whether the squared distance in lane t is at most that of ``far``."""
    return int(r2 <= far * far)


@overload(close_bits)
def _typed_close_bits(r2, far):
    return lambda r2, far: bits(r2 <= far * far)


def take_masses(mass, entries, begin, many, first, found):
    """Write the masses of ``many`` particles that stand in ``entries`` from ``begin`` on to ``found`` from
    ``first`` on, where they differ."""
    if np.ndim(mass):
        for n in range(many):
            found[first + n] = mass[entries[begin + n]]


@overload(take_masses)
def _typed_take_masses(mass, entries, begin, many, first, found):
    if not isinstance(mass, types.Array):
        return lambda mass, entries, begin, many, first, found: None

    def take(mass, entries, begin, many, first, found):
        for n in range(many):
            found[first + n] = mass[entries[begin + n]]

    return take


def own_mass(mass, k):
    """The mass of particle ``k``, kg."""
    return mass[k] if np.ndim(mass) else mass


@overload(own_mass)
def _typed_own_mass(mass, k):
    if isinstance(mass, types.Array):
        return lambda mass, k: mass[k]
    return lambda mass, k: mass


def meets_all(images, table, k):
    """Whether a particle meets all of its list: one that sees images, which may be nearer than who casts
    them while some have passed a plane."""
    return images is not None and _sees(images, table, k)


@overload(meets_all)
def _typed_meets_all(images, table, k):
    if isinstance(images, types.NoneType):
        return lambda images, table, k: False
    return lambda images, table, k: _sees(images, table, k)


@register_jitable
def _sees(images, table, k):
    found = False
    for one in range(len(images.turns)):
        found = found or is_seen(images.turns[one], images.shifts[one], images.reach, table, k)
    return found


@register_jitable
def is_seen(turn, shift, reach, table, k):
    """Whether particle ``k`` is near all planes of an image."""
    seen = True
    for d in range(AXES):
        seen = seen and (turn[d] > 0.0 or abs(2.0 * table[k, d] - shift[d]) < 2.0 * reach)
    return seen


def with_images(images, k, row, many, periods, of, met):
    """Write those of images in mirrors behind the ``many`` that are there; how many there are then."""
    return many if images is None else _with_images(images, k, row, many, periods, of, met)


@overload(with_images)
def _typed_with_images(images, k, row, many, periods, of, met):
    if isinstance(images, types.NoneType):
        return lambda images, k, row, many, periods, of, met: many
    return lambda images, k, row, many, periods, of, met: _with_images(images, k, row, many, periods, of, met)


@inside
def _with_images(images, k, row, many, periods, of, met):
    lists, table, begin = of.lists, of.table, of.lists.begin[row]
    listed, place = np.uint64(lists.lengths[row]), (table[k, 0], table[k, 1], table[k, 2])
    for one in range(len(images.turns)):
        turn, shift = images.turns[one], images.shifts[one]
        if not is_seen(turn, shift, images.reach, table, k):
            continue
        # Its distance from the image of j is that of its own image from j.
        image = turn[0] * place[0] + shift[0], turn[1] * place[1] + shift[1], turn[2] * place[2] + shift[2]
        for n in range(np.uint64(0), listed, width_of(table)):
            x, y, z, _ = fetched(table, lists.lists, begin + n)
            x_ij = nearest_image(subtract(image, (x, y, z)), periods)
            put_consecutive(met.distance, many + n, np.sqrt(dot(x_ij, x_ij)))
        take_masses(of.mass, lists.lists, begin, listed, many, met.mass)
        many += listed
        x_ij = nearest_image(subtract(image, place), periods)
        met.distance[many], met.mass[many] = np.sqrt(dot(x_ij, x_ij)), own_mass(of.mass, k)
        many += np.uint64(1)
    return many


def fetched(table, lists, entry):
    """The numbers of the particles ``lists[entry]`` and following, as lanes."""
    return tuple(table[lists[entry]])


@overload(fetched)
def _typed_fetched(table, lists, entry):
    turn = turning(NUMBERS)
    return lambda table, lists, entry: turn(table, lists, entry)


def table_of(position, inverse, columns: int) -> np.ndarray:
    """Places and smoothing lengths, m, of so many columns side by side (columns, 4), by ``inverse`` lengths,
    1/m: those are what ghosts have."""
    table = np.zeros((columns, NUMBERS))
    for d, x in enumerate(position):
        table[:, d] = x[:columns]
    table[:, AXES] = 1.0 / inverse[:columns]
    return table


def rooms_for(lists, images: Images | None, owned: int) -> list[tuple[Met]]:
    """Room for whom a particle meets, for each thread; images with them."""
    longest = int(lists.lengths[:owned].max(initial=0))
    most = longest if images is None else (1 + len(images.turns)) * (longest + 1)
    return [
        (Met(np.zeros(longest + EIGHT, np.uint32), np.zeros(most + EIGHT), np.zeros(most + EIGHT)),)
        for _ in range(threads())
    ]
