"""The particles of one rank as a structure of arrays: [low ghosts | owned | high ghosts]."""

from collections.abc import Iterable, Sequence

import numpy as np

from psph.engine.jit import compiled
from psph.errors import Refused
from psph.fields import FLUID, WALL, Field

SLACK = 64
"""Entries past the last particle: a vector load may touch them."""

SPARE = 64
"""One place in so many is kept free for particles and list entries to come."""

MOST = 2**32 - SLACK
"""Particles and ghosts that a rank can hold: neighbour lists name them by 32-bit columns."""


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

    ``data`` (rows, capacity) float64 holds the ``fields``; ``id`` (int64) and ``group`` (uint8),
    the number of a species, stand beside it.  Owned particles fill columns ``low`` to ``low +
    owned``, ghosts lie before and behind.  ``constants`` are quantities that the whole scene shares:
    they need no array.  ``view`` is the NamedTuple in which formulas see the particles, ``kinds`` has
    the kind of each group.
    """

    def __init__(
        self,
        dimensions: int,
        fields: Iterable[Field],
        constants: dict[str, float],
        view: type,
        kinds: Sequence[int] = (FLUID, WALL),
    ):
        self.dimensions = dimensions
        self.fields = {field.name: field for field in fields}
        self.constants = dict(constants)
        self.rows: dict[str, range] = {}
        first = 0
        for name, field in self.fields.items():
            width = field.width(dimensions)
            self.rows[name] = range(first, first + width)
            first += width
        # Numbers of ghosts below, owned particles and ghosts above: whoever writes them moves columns too.
        self.low = self.owned = self.high = 0
        self._seen_in, self._view = view, None
        self._arrays: dict[int, np.ndarray | tuple[np.ndarray, ...]] = {}  # by the first row
        self.blocks = 0
        """How often all arrays were replaced by longer ones: who keeps some compares this number."""
        self.data = np.zeros((first, SLACK))
        self.id = np.zeros(SLACK, np.int64)
        self.group = np.zeros(SLACK, np.uint8)
        self.kinds = np.array(kinds, np.uint8)

    def __contains__(self, name: str) -> bool:
        return name in self.rows

    def __getitem__(self, name: str):
        """The field over all columns: an array, or a tuple of component arrays."""
        rows = self.rows[name]
        if (shown := self._arrays.get(rows.start)) is None:
            arrays = tuple(self.data[row] for row in rows)
            shown = self._arrays[rows.start] = arrays if self.fields[name].composed else arrays[0]
        return shown

    def arrays_of(self, stored: str | tuple[str, ...] | None):
        """What takes a sum: the array of a number, those of several numbers in a row, or None."""
        if not isinstance(stored, tuple):
            return stored and self[stored]
        entries = (self[name] for name in stored)
        return tuple(array for one in entries for array in (one if isinstance(one, tuple) else (one,)))

    def rotate(self, *names: str) -> None:
        """Each field takes the rows of the one before, the first those of the last; no copy.

        For fields that no effect sees and no halo carries: both keep the rows that they know.
        """
        rows = [self.rows[name] for name in names]
        self.rows.update(zip(names, [rows[-1], *rows[:-1]]))

    @property
    def kind(self) -> np.ndarray:
        """The kind of the particle in each column."""
        return self.kinds[self.group]

    def of_groups(self, groups) -> np.ndarray:
        """Which of this rank's particles are of some ``groups`` (owned,)."""
        among = np.zeros(len(self.kinds), bool)
        among[list(groups)] = True
        return among[self.shown("group")]

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

    def seen_as(self, name: str) -> str:
        """The field that formulas see under a name: the predicted one of what evolves."""
        predicted = f"predicted_{name}"
        return predicted if predicted in self.rows else name

    def view(self):
        """What formulas see of the particles (psph.fields.view_of)."""
        if self._view is None:
            self._view = self._seen_in(*(self.value(self.seen_as(n)) for n in self._seen_in._fields))
        return self._view

    def owned_rows(self, name: str) -> np.ndarray:
        """This rank's values as people read them: ``(owned,)`` or ``(owned, dim)``, a copy."""
        return self.shown(name).copy(order="C")

    def shown(self, name: str) -> np.ndarray:
        """What :meth:`owned_rows` copies, to be read and not to be kept: the next step changes it."""
        if name in ("id", "group"):
            values = getattr(self, name)[self.inner]
        elif name == "kind":
            values = self.kind[self.inner]
        elif name in self.rows:
            rows = self.rows[name]
            block = self.data[rows.start : rows.stop, self.inner]
            values = block.T if self.fields[name].composed else block[0]
        else:
            values = np.full(self.owned, self.constants[name])
        # A view: what writes through it would change particles behind the step's back.
        values.flags.writeable = False
        return values

    def reserve(self, columns: int) -> None:
        """Make room for so many particles; contents stay.

        Raises TooManyParticles where their columns would not fit into 32 bits.
        """
        if columns > MOST:
            raise TooManyParticles(
                f"{columns:,} particles and ghosts on one rank: it holds {MOST:,} at the most; use more ranks"
            )
        if columns + SLACK <= self.capacity:
            return
        # Spare room, or each rebuild with a few ghosts more would make all arrays anew.
        wide = columns + columns // SPARE + SLACK

        def widened(old: np.ndarray) -> np.ndarray:
            new = np.zeros((*old.shape[:-1], wide), old.dtype)
            new[..., : old.shape[-1]] = old
            return new

        self.hold(*map(widened, (self.data, self.id, self.group)))

    def hold(self, data: np.ndarray, ids: np.ndarray, groups: np.ndarray) -> None:
        """Keep the particles in these arrays from now on; nobody may use the old ones."""
        self.data, self.id, self.group = data, ids, groups
        self._arrays.clear()
        self._view = None
        self.blocks += 1

    def append(self, ids: np.ndarray, groups: np.ndarray, block: np.ndarray) -> None:
        """Add owned particles behind the last; ``block`` (rows, n).  Ghosts are lost."""
        n = len(ids)
        end = self.low + self.owned
        self.high = 0  # the ghosts above stood in these columns
        self.reserve(end + n)
        self.data[:, end : end + n] = block
        self.id[end : end + n] = ids
        self.group[end : end + n] = groups
        self.owned += n

    def reorder(self, order: np.ndarray, low: int, high: int) -> None:
        """Let the owned columns become the columns ``order``, behind ``low`` ghosts to come."""
        n = len(order)
        self.reserve(max(low + n + high, self.total))
        # In place, a row at a time: a second block would double the memory of a run.
        permute(self.data, order, low, np.empty(n))
        for array in (self.id, self.group):
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
