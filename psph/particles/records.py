"""Records: what the pairs read of a neighbour, side by side in memory.

A list names particles that lie scattered.  A record holds in one or two cache lines what an array
a quantity would spread over many; the pair loop turns records into lanes (psph.engine.simd).
"""

from collections.abc import Collection, Mapping

import numpy as np

from psph.composition.pair import FOLDED
from psph.composition.space import FixedPoint
from psph.engine.jit import elementwise, overload, register_jitable, tuple_of, unrolled
from psph.engine.simd import GROUP
from psph.engine.threads import in_threads
from psph.particles.store import Store

LINE = 64
"""Bytes of a cache line."""

FEW, BLOCK = 4, 64
"""Numbers that are copied at once where but some of a record are, and particles before the next few: these
are still in the first cache.  Whole records are a third faster one by one where they come from memory."""

NO_SIGN = (-1, -1)
"""Row and place of a sign, where no record has one."""

FLAG, CARRIER = "is_fluid", "specific_volume"
"""What is no fluid shows in the sign of a number that is positive: the flag takes no place of its own."""


def recorded(names: tuple[str, ...]) -> tuple[str, ...]:
    """The fields among ``names`` that take a place in a record."""
    return tuple(name for name in names if name != FLAG or CARRIER not in names)


def record_width(numbers: int) -> int:
    """Places of a record that holds so many numbers: whole groups."""
    return -(-numbers // GROUP) * GROUP


class Records:
    """The records of one rank's particles.

    ``names`` are the fields that vary and that pairs read of a neighbour; what is no fluid has
    a negative specific volume (:data:`CARRIER`).  ``table`` (columns, width) has the columns of the
    store; a record begins with a cache line, or shares it with one other.
    ``in_place`` names the field that is shown for another.  Fields that are written ``seldom`` are not copied
    again after :meth:`settle`, until :meth:`renew` is told that one of them has been written.
    Where ``space`` is fixed point all is in single precision, but for positions: whole steps of
    32 bits, modulo their range.
    """

    def __init__(
        self,
        store: Store,
        names: tuple[str, ...],
        space,
        in_place: Mapping[str, str] = {},
        seldom: Collection[str] = (),
    ):
        self.store, self._seldom, self._settled = store, frozenset(seldom), False
        placed = recorded(names)
        entries = store.view()._fields
        self._seen = {name: in_place.get(name, store.seen_as(name)) for name in entries}
        self._names = tuple(n for n in self._seen.values() if n in placed)
        self._shown = tuple((name, self._seen[name] in self._names) for name in entries)
        rows = [row for name in self._names for row in store.rows[name]]
        again = [name not in self._seldom for name in self._names for _ in store.rows[name]]
        self._all = np.array(rows, np.uint64), np.arange(len(rows), dtype=np.uint64)
        self._again = tuple(_in_fours(numbers[again]) for numbers in self._all)
        self._folded = FLAG in names and FLAG not in placed
        self._sign = (
            (store.rows[FLAG].start, rows.index(store.rows[CARRIER].start)) if self._folded else NO_SIGN
        )
        self._fixed = isinstance(space, FixedPoint)
        self._steps_per_metre = 1.0 / np.array(space.units) if self._fixed else None
        self.width = record_width(len(rows))
        self._type = space.record_type
        self.table = np.zeros((0, self.width), self._type)
        self._of, self._view = None, None

    def view(self):
        """A neighbour: an array for what its record holds, else the shared value, FOLDED or None."""
        store = self.store
        # The store makes a new view whenever it replaces its arrays: the old one names memory that is gone.
        if self._of is not store.view():
            seen = type(store.view())(
                *(
                    store[self._seen[name]] if placed else store.constants.get(name)
                    for name, placed in self._shown
                )
            )
            self._view = seen._replace(is_fluid=FOLDED) if self._folded else seen
            self._of = store.view()
        return self._view

    def make_room(self) -> None:
        """Room for owned particles and ghosts, after these found new columns."""
        self._settled = False
        if len(self.table) < self.store.capacity:
            self.table = aligned(self.store.capacity, self.width, self._type)

    def settle(self) -> None:
        """All columns have been filled since there were new ones."""
        self._settled = True

    def renew(self, written: Collection[str]) -> None:
        """Fields have been ``written``: if any of them seldom is, the next filling copies all numbers."""
        self._settled = self._settled and self._seldom.isdisjoint(written)

    def fill(self, first: int, last: int) -> None:
        """Bring the records of the columns ``first`` to ``last`` up to date."""
        told = self.store.data, *(self._again if self._settled else self._all), *self._sign
        if self._fixed:
            whole = self.table.view(np.int32)
            in_threads(fill_fixed, first, last, *told, self._steps_per_metre, self.table, whole)
        else:
            fill = fill_some if self._settled else fill_records
            in_threads(fill, first, last, *told, self.table)


def _in_fours(numbers: np.ndarray) -> np.ndarray:
    """The ``numbers`` of rows or places, the last again until they are a multiple of FEW."""
    return np.pad(numbers, (0, -len(numbers) % FEW), mode="edge")


def aligned(records: int, width: int, kind) -> np.ndarray:
    """Zeros (records, width) that begin with a cache line."""
    line = LINE // kind.itemsize
    room = np.zeros(records * width + line, kind)
    first = -(room.ctypes.data // room.itemsize) % line
    return room[first : first + records * width].reshape(records, width)


def numbers_at(numbers, first: int, like: tuple) -> tuple:
    """As many of the ``numbers`` from the ``first`` on as a vector ``like`` that has components."""
    return tuple(numbers[first + d] for d in range(len(like)))


@overload(numbers_at)
def _numbers_at(numbers, first, like):
    parts = (f"numbers[first + {d}]" for d in range(len(like)))
    return unrolled("numbers, first, like", f"return {tuple_of(parts)}")


@elementwise
def fill_records(first, last, data, rows, places, flag, place, table):
    """Copy ``data[rows[f], k]`` to ``table[k, places[f]]`` for the columns ``first`` to ``last``.

    ``table[k, place]`` is negative where ``data[flag, k]`` is zero, else positive; any with NO_SIGN.
    """
    for k in range(np.uint64(first), np.uint64(last)):
        for f in range(np.uint64(len(rows))):
            table[k, places[f]] = data[rows[f], k]
        _fold(k, data, flag, place, table)


@elementwise
def fill_some(first, last, data, rows, places, flag, place, table):
    """As :func:`fill_records`; ``rows`` and ``places`` come in fours."""
    one, two, three = np.uint64(1), np.uint64(2), np.uint64(3)
    for begin in range(np.uint64(first), np.uint64(last), np.uint64(BLOCK)):
        end = min(begin + np.uint64(BLOCK), np.uint64(last))
        for f in range(np.uint64(0), np.uint64(len(rows)), np.uint64(FEW)):
            of_a, of_b, of_c, of_d = rows[f], rows[f + one], rows[f + two], rows[f + three]
            at_a, at_b, at_c, at_d = places[f], places[f + one], places[f + two], places[f + three]
            for k in range(begin, end):
                table[k, at_a] = data[of_a, k]
                table[k, at_b] = data[of_b, k]
                table[k, at_c] = data[of_c, k]
                table[k, at_d] = data[of_d, k]
        for k in range(begin, end):
            _fold(k, data, flag, place, table)


@elementwise
def fill_fixed(first, last, data, rows, places, flag, place, steps_per_metre, table, whole):
    """The same in single precision, positions, which come first, as whole steps; ``whole`` shows the table's
    bits."""
    axes = np.uint64(len(steps_per_metre))
    for k in range(np.uint64(first), np.uint64(last)):
        for f in range(axes):
            whole[k, f] = np.int32(np.int64(np.rint(data[rows[f], k] * steps_per_metre[f])))
        for f in range(axes, np.uint64(len(rows))):
            table[k, places[f]] = np.float32(data[rows[f], k])
        _fold(k, data, flag, place, table)


@register_jitable
def _fold(k, data, flag, place, table):
    if flag >= 0:  # a fluid whose density has become negative stays one
        size = abs(table[k, np.uint64(place)])
        table[k, np.uint64(place)] = size if data[np.uint64(flag), k] > 0.0 else -size
