"""Which rows are filled where particles are of many sizes, and who looks how far."""

from typing import NamedTuple

import numpy as np

from psph.engine.jit import inside


class OwnedRows(NamedTuple):
    """Rows to fill: of the ``owned`` columns from ``low`` on, up to a ``multiple`` of entries;
    ``across`` (n,) says who of the grids looks beyond its own level.  ``own`` is 1 where a particle also sees
    as far as it reaches itself, and 0 where only as far as others do.  ``sought`` (n + 1,) is how many of the
    grids before each everyone looks for: who has none in the cells around lists nobody; empty where everyone
    lists everyone."""

    low: int
    owned: int
    multiple: int
    across: np.ndarray
    own: float
    sought: np.ndarray


@inside
def holding_sought(sought, ranges, least, most):
    """The ``ranges`` from number ``least`` to before ``most`` where they hold anyone who is ``sought``, or
    everyone is; else none."""
    found = len(sought) == 0
    for r in range(least, most):
        found = found or sought[ranges[r, 1]] > sought[ranges[r, 0]]
    return (least, most) if found else (0, 0)


@inside
def looks(rows, first, last):
    """Whether any of the particles ``first`` to ``last`` of the grids looks beyond its own level."""
    found = False
    for m in range(first, last):
        found = found or rows.across[m]
    return found
