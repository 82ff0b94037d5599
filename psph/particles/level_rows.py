"""Which rows are filled where particles are of many sizes, and who looks how far."""

from typing import NamedTuple

import numpy as np

from psph.engine.jit import inside


class Sought(NamedTuple):
    """Those whom each row must name or stay empty: whether a column is ``one`` of them (columns,), and how
    many of the grids are before each (n + 1,), ``before``; both empty where all rows are filled."""

    one: np.ndarray
    before: np.ndarray

    @classmethod
    def none(cls) -> "Sought":
        """All rows are filled."""
        return cls(np.zeros(0, bool), np.zeros(0, np.int64))

    @classmethod
    def among(cls, one: np.ndarray, columns: np.ndarray) -> "Sought":
        """Each column that is ``one`` (columns,), of grids with some ``columns`` (n,)."""
        before = np.zeros(len(columns) + 1, np.int64)
        np.cumsum(one[columns], out=before[1:])
        return cls(one, before)


class OwnedRows(NamedTuple):
    """Rows to fill: of the ``owned`` columns from ``low`` on, up to a ``multiple`` of entries;
    ``across`` (n,) says who of the grids looks beyond its own level.  ``own`` is 1 where a particle also sees
    as far as it reaches itself, and 0 where only as far as others do.  ``sought`` are those whom each row
    must name, counted in the order of the grids."""

    low: int
    owned: int
    multiple: int
    across: np.ndarray
    own: float
    sought: Sought


@inside
def holds_sought(sought, ranges, least, most):
    """Whether ``ranges`` from number ``least`` to before ``most`` hold anyone, by how many are ``sought``
    before each (n + 1,); True where nobody is told."""
    found = len(sought) == 0
    for r in range(least, most):
        found = found or sought[ranges[r, 1]] > sought[ranges[r, 0]]
    return found


@inside
def owns(rows, columns, first, last):
    """Whether the rank owns any of the particles ``first`` to ``last`` of the grids."""
    found = False
    for m in range(first, last):
        found = found or 0 <= np.int64(columns[m]) - rows.low < rows.owned
    return found


@inside
def looks(rows, first, last):
    """Whether any of the particles ``first`` to ``last`` of the grids looks beyond its own level."""
    found = False
    for m in range(first, last):
        found = found or rows.across[m]
    return found


@inside
def finds(sought, k, columns, first, end):
    """Whether column ``k`` or one of the ``columns`` from place ``first`` to before ``end`` is ``sought``;
    True where nobody is told."""
    found = len(sought.one) == 0 or sought.one[k]
    n = np.uint64(first)
    while not found and n < np.uint64(end):
        found = sought.one[np.uint64(columns[n])]
        n += np.uint64(1)
    return found
