"""Records: what the pairs read of a neighbour, side by side in memory.

A list names particles that lie scattered.  A record holds in one or two cache lines what an array
a quantity would spread over many; the pair loop turns records into lanes (psph.simd).
"""

import numpy as np

from psph.jit import compiled
from psph.particles.store import Store, seen_as
from psph.physics.compose import ParticleView
from psph.simd import GROUP

LINE = 8
"""Doubles of a cache line."""


class Records:
    """The records of one rank's particles.

    ``names`` are the fields that vary and that pairs read of a neighbour.  ``table``
    (columns, width) float64 has the columns of the store, the dummy included; a record begins with
    a cache line.
    """

    def __init__(self, store: Store, names: tuple[str, ...]):
        self.store = store
        self._names = tuple(n for n in map(seen_as, ParticleView._fields) if n in names)
        rows = [row for name in self._names for row in store.rows[name]]
        self._rows = np.array(rows, np.uint64)
        self.width = -(-len(rows) // GROUP) * GROUP
        self.table = np.zeros((0, self.width))

    def view(self) -> ParticleView:
        """A neighbour: an array for what its record holds, else the shared value or None."""
        store = self.store
        return ParticleView(
            *(
                store[seen_as(n)] if seen_as(n) in self._names else store.constants.get(n)
                for n in ParticleView._fields
            )
        )

    def fill_all(self) -> None:
        """Records of owned particles, ghosts and the dummy, after these found new columns."""
        if len(self.table) < self.store.capacity:
            self.table = _aligned(self.store.capacity, self.width)
        self.fill(0, self.store.total + 1)

    def fill(self, first: int, last: int) -> None:
        """Bring the records of the columns ``first`` to ``last`` up to date."""
        fill_records(self.store.data, self._rows, first, last, self.table)


def _aligned(records: int, width: int) -> np.ndarray:
    """Zeros (records, width) that begin with a cache line."""
    room = np.zeros(records * width + LINE)
    first = -(room.ctypes.data // room.itemsize) % LINE
    return room[first : first + records * width].reshape(records, width)


@compiled
def fill_records(data, rows, first, last, table):
    """Copy ``data[rows[f], k]`` to ``table[k, f]`` for the columns ``first`` to ``last``."""
    for k in range(np.uint64(first), np.uint64(last)):
        for f in range(np.uint64(len(rows))):
            table[k, f] = data[rows[f], k]
