"""How far the kernels of a pair reach that attracts each other: all alike, or each particle by its size.

The class of a reach selects the code when a loop is compiled.
"""

from typing import NamedTuple

import numpy as np

from psph.engine.jit import call_by_type
from psph.engine.simd import consecutive
from psph.physics.self_gravity import softened, softened_by_both


class Alike(NamedTuple):
    """One ``reach`` H for all, m: cells of a tree are softened as particles are."""

    reach: float

    def own(self, k):
        """The reach of particle ``k``, m."""
        return self.reach

    def note(self, k, row, n):
        """Write the reach of particle ``k`` into place ``n`` of a ``row``, where it has one of its own."""

    def field(self, r, own, row, n):
        """g and f at the distance ``r`` of those from ``n`` on in a ``row``, for what reaches ``own``, m."""
        return softened(r, self.reach)

    def of_cells(self):
        """The reach of cells that count as one, m."""
        return self.reach

    def is_past(self, cell, own, apart2, radius2):
        """Whether a ``cell`` within √``radius2`` of its centre is beyond all reach of what reaches ``own``
        and sees it from √``apart2``, m, where it has to be."""
        return True


class BySize(NamedTuple):
    """The ``reach`` of each particle, m, and the largest of each cell of a tree, ``farthest``: a pair has
    the mean of both fields, and cells that count as one are beyond both."""

    reach: np.ndarray
    farthest: np.ndarray

    def own(self, k):
        """The reach of particle ``k``, m."""
        return self.reach[k]

    def note(self, k, row, n):
        """Write it into place ``n`` of a ``row``."""
        row[n] = self.reach[k]

    def field(self, r, own, row, n):
        """g and f at the distance ``r`` of those from ``n`` on in a ``row``, for what reaches ``own``, m."""
        return softened_by_both(r, own, consecutive(row, n))

    def of_cells(self):
        """None: they are seen as points, m."""
        return 0.0

    def is_past(self, cell, own, apart2, radius2):
        """Whether a ``cell`` within √``radius2`` of its centre is beyond all reach."""
        far = np.sqrt(radius2) + max(self.farthest[cell], own)
        return far * far < apart2


own_reach = call_by_type("own")
note_reach = call_by_type("note")
field_of = call_by_type("field")
reach_of_cells = call_by_type("of_cells")
is_past_reach = call_by_type("is_past")
