"""Neighbours in the reference: rows of ids that never change, and the lists that loops read."""

from typing import NamedTuple

import numpy as np

from psph.engine.jit import compiled
from psph.engine.simd import AHEAD
from psph.particles.neighbours import Neighbours


class ReferenceRows(NamedTuple):
    """The partners of particle ``ids[k]`` are ``partners[begin[k] : begin[k + 1]]``, ids in rising order.

    ``ids`` (n,) rise too; all are int64.
    """

    ids: np.ndarray
    begin: np.ndarray
    partners: np.ndarray

    @classmethod
    def of(cls, ids: np.ndarray, counts: np.ndarray, partners: np.ndarray) -> "ReferenceRows":
        """Rows in any order, ``counts`` (n,) partners each, one after another, put into order."""
        # Ids that rise let :meth:`places` search by halves; partners keep their order, and sums their bits.
        order = np.argsort(ids, kind="stable")
        begin = np.concatenate([[0], np.cumsum(counts)])
        chosen = _entries(begin[:-1][order], counts[order])
        ends = np.concatenate([[0], np.cumsum(counts[order])])
        return cls(ids[order], ends, partners[chosen])

    @property
    def counts(self) -> np.ndarray:
        """Partners of each row."""
        return np.diff(self.begin)

    def places(self, ids: np.ndarray) -> np.ndarray:
        """The rows of these ids, −1 where there is none."""
        if not len(self.ids):
            return np.full(len(ids), -1)
        places = np.minimum(np.searchsorted(self.ids, ids), len(self.ids) - 1)
        return np.where(self.ids[places] == ids, places, -1)

    def chosen(self, ids: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """How many partners each of these ids has, and these one after another; every id has a row."""
        rows = self.places(ids)
        counts = self.counts[rows]
        return counts, self.partners[_entries(self.begin[rows], counts)]


def _entries(first: np.ndarray, counts: np.ndarray) -> np.ndarray:
    """``first[k]``, ``first[k] + 1`` … so many each, one row after another."""
    ends = np.cumsum(counts)
    return np.arange(ends[-1] if len(ends) else 0) + np.repeat(first - (ends - counts), counts)


def padded_lists(counts: np.ndarray, entries: np.ndarray, multiple: int, first: int = 0) -> Neighbours:
    """Lists of ``counts[k]`` ``entries`` each for the rows of columns from ``first`` on, each filled up with
    the column itself."""
    padded = -(-counts // multiple) * multiple
    begin = np.cumsum(padded) - padded
    room = np.zeros(int(padded.sum()) + AHEAD, np.uint32)
    fill_padded(first, counts, begin, entries, room)
    return Neighbours(begin.astype(np.uint64), counts.astype(np.uint32), room[: len(room) - AHEAD])


@compiled
def fill_padded(first, counts, begin, entries, room):
    """Write the entries of each row from ``begin[k]`` on, and its column ``first`` + k behind them."""
    done = 0
    for k in range(len(counts)):
        end = begin[k + 1] if k + 1 < len(begin) else len(room)
        for n in range(begin[k], end):
            room[n] = entries[done + n - begin[k]] if n < begin[k] + counts[k] else first + k
        done += counts[k]
