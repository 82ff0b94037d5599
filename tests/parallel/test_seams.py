"""Parts of walls that meet where slabs do: each bears the same to the bit on any number of ranks."""

import numpy as np
import pytest
from gauging import readings, start
from mpi4py import MPI
from output.test_corners import cut, drawn, walls
from parallel.written import written

from psph.scene import Scene

COMM = MPI.COMM_WORLD
pytestmark = pytest.mark.mpi(min_size=2)


def test_what_parts_bear_does_not_depend_on_the_slabs(mpi_tmp_path):
    """With the groups that ghosts' columns had before, parts of a floor miss 7 N/m at their seam between slabs."""
    case = written(mpi_tmp_path, drawn(2, cut(walls(2), "floor", 0, 0.3)))
    scene, single, together = Scene(case), start(case, MPI.COMM_SELF), start(case, COMM)
    domain, store = together.domain, together.store
    middle = domain.lower[0] + domain.bounds[1] / domain.grid.inverse[0]
    assert COMM.size > 2 or abs(middle - 0.3) < case.space.spacing
    assert readings(together, scene) == readings(single, scene)
    whose = COMM.allgather((store.shown("position"), store.shown("group")))
    places, groups = (np.concatenate(part) for part in zip(*whose))
    seen = np.column_stack([x[: store.total] for x in store["position"]])
    nearest = ((seen[:, None] - places) ** 2).sum(axis=2).argmin(axis=1)
    assert store.total > store.owned and np.array_equal(domain.groups(), groups[nearest])
