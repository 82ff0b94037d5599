"""The particles of one rank as a structure of arrays: [low ghosts | owned | high ghosts]."""

import numpy as np

from psph.errors import Refused
from psph.jit import compiled
from psph.particles.fields import FIELDS
from psph.physics.compose import ParticleView

SLACK = 64
"""Entries past the last particle: a vector load may touch them."""

SPARE = 64
"""One place in so many is kept free for particles and list entries to come."""

MOST = 2**32 - SLACK
"""Particles and ghosts that a rank can hold: neighbour lists name them by 32-bit columns."""


def seen_as(name: str) -> str:
    """The field that effects see under a name of a particle view."""
    return "predicted_velocity" if name == "velocity" else name


class TooManyParticles(Refused):
    """More particles than the ranks can hold."""


def check_room(particles: int, ranks: int) -> None:
    """Raise TooManyParticles, with the number of ranks that works, where one could not hold its share."""
    if particles > ranks * MOST:
        raise TooManyParticles(
            f"{particles:,} particles on {ranks} ranks: a rank holds {MOST:,} at the most, its "
            f"ghosts included; use {particles // MOST + 1} ranks or more"
        )


class Store:
    """All numbers of this rank's particles in one block, a row a component.

    ``data`` (rows, capacity) float64 holds the fields named; ``id`` (int64) and ``kind`` (uint8)
    stand beside it.  Owned particles fill columns ``low`` to ``low + owned``, ghosts lie before
    and behind.  ``constants`` are quantities that
    the whole scene shares: they need no array.
    """

    def __init__(self, dimensions: int, names: tuple[str, ...], constants: dict[str, float]):
        self.dimensions = dimensions
        self.constants = dict(constants)
        self.rows: dict[str, range] = {}
        first = 0
        for name in names:
            width = FIELDS[name].width(dimensions)
            self.rows[name] = range(first, first + width)
            first += width
        self.low = self.owned = self.high = 0
        self._view: ParticleView | None = None
        self.data = np.zeros((first, SLACK))
        self.id = np.zeros(SLACK, np.int64)
        self.kind = np.zeros(SLACK, np.uint8)

    def __contains__(self, name: str) -> bool:
        return name in self.rows

    def __getitem__(self, name: str):
        """The field over all columns: an array, or a tuple of component arrays."""
        rows = self.rows[name]
        if FIELDS[name].composed:
            return tuple(self.data[row] for row in rows)
        return self.data[rows.start]

    def rotate(self, *names: str) -> None:
        """Each field takes the rows of the one before, the first those of the last; no copy.

        For fields that no effect sees and no halo carries: both keep the rows that they know.
        """
        rows = [self.rows[name] for name in names]
        self.rows.update(zip(names, [rows[-1], *rows[:-1]]))

    @property
    def total(self) -> int:
        """Owned particles and ghosts."""
        return self.low + self.owned + self.high

    @property
    def capacity(self) -> int:
        """Columns of ``data``."""
        return self.data.shape[1]

    @property
    def inner(self) -> slice:
        """Columns of the owned particles."""
        return slice(self.low, self.low + self.owned)

    def value(self, name: str):
        """Array(s) of a field, its constant, or None where the scene lacks it."""
        return self[name] if name in self.rows else self.constants.get(name)

    def view(self) -> ParticleView:
        """What effects see of the particles; their velocity is the predicted one."""
        if self._view is None:
            self._view = ParticleView(*(self.value(seen_as(n)) for n in ParticleView._fields))
        return self._view

    def owned_rows(self, name: str) -> np.ndarray:
        """This rank's values as people read them: ``(owned,)`` or ``(owned, dim)``, a copy."""
        return self.shown(name).copy(order="C")

    def shown(self, name: str) -> np.ndarray:
        """What :meth:`owned_rows` copies, to be read and not to be kept: the next step changes it."""
        if name in ("id", "kind"):
            values = getattr(self, name)[self.inner]
        elif name in self.rows:
            rows = self.rows[name]
            block = self.data[rows.start : rows.stop, self.inner]
            values = block.T if FIELDS[name].composed else block[0]
        else:
            values = np.full(self.owned, self.constants[name])
        values.flags.writeable = False
        return values

    def reserve(self, columns: int) -> None:
        """Make room for so many particles; contents stay.

        Raises TooManyParticles where their columns would not fit into 32 bits.
        """
        if columns > MOST:
            raise TooManyParticles(
                f"{columns:,} particles and ghosts on one rank: it holds {MOST:,} at the most; "
                "use more ranks"
            )
        if columns + SLACK <= self.capacity:
            return
        wide = columns + columns // SPARE + SLACK
        for name in ("data", "id", "kind"):
            old = getattr(self, name)
            new = np.zeros((*old.shape[:-1], wide), old.dtype)
            new[..., : old.shape[-1]] = old
            setattr(self, name, new)
        self._view = None  # it shows the old arrays

    def append(self, ids: np.ndarray, kinds: np.ndarray, block: np.ndarray) -> None:
        """Add owned particles behind the last; ``block`` (rows, n).  Ghosts are lost."""
        n = len(ids)
        end = self.low + self.owned
        self.high = 0
        self.reserve(end + n)
        self.data[:, end : end + n] = block
        self.id[end : end + n] = ids
        self.kind[end : end + n] = kinds
        self.owned += n

    def reorder(self, order: np.ndarray, low: int, high: int) -> None:
        """Let the owned columns become the columns ``order``, behind ``low`` ghosts to come."""
        n = len(order)
        self.reserve(max(low + n + high, self.total))
        permute(self.data, order, low, np.empty(n))
        for array in (self.id, self.kind):
            array[low : low + n] = array[order]
        self.low, self.owned, self.high = low, n, high


@compiled
def permute(data, order, low, spare):
    """Move the columns ``order`` of every row to the columns from ``low`` on."""
    for row in range(len(data)):
        for k in range(len(order)):
            spare[k] = data[row, np.uint64(order[k])]
        for k in range(len(order)):
            data[row, np.uint64(low + k)] = spare[k]
