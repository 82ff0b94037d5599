"""Probes: fields interpolated at fixed points."""

import numpy as np
from mpi4py import MPI

from psph.jit import compiled
from psph.parallel.domain import Domain
from psph.particles.cells import number_cells
from psph.particles.fields import FIELDS
from psph.particles.neighbours import candidate_ranges
from psph.physics.compose import take
from psph.smoothing import weight
from psph.vectors import dot, nearest_image, subtract


class Probe:
    """Fields at one point, f = Σ_j W V_j f_j / Σ_j W V_j (Shepard 1968), walls included.

    ``position`` (dim,) m; ``fields`` names of saved fields.  The rank that owns the point's plane
    of cells sums over particles and ghosts in the global order, so that the bits do not depend on
    the number of ranks.
    """

    def __init__(self, name: str, position: tuple[float, ...], fields: tuple[str, ...]):
        self.name, self.position, self.fields = name, tuple(map(float, position)), fields

    def columns(self, dimensions: int) -> list[str]:
        """Names of the values: ``P1.pressure``, ``P1.velocity_x``."""
        return [
            f"{self.name}.{field}{suffix}"
            for field in self.fields
            for suffix in ([f"_{axis}" for axis in "xyz"[:dimensions]] if FIELDS[field].vector else [""])
        ]

    def sample(self, domain: Domain, kernel) -> np.ndarray:
        """Values in the order of :meth:`columns` on every rank, NaN where no particle is near.

        Ghosts must hold the fields of this probe.  Collective.
        """
        store, grid = domain.store, domain.grid
        rows = [row for field in self.fields for row in store.rows[field]]
        values = np.zeros(len(rows))
        point = tuple(np.array([x]) for x in self.position)
        cell = np.empty(1, np.int64)
        along = tuple(point[d] for d in grid.axes)
        number_cells(along, 0, 1, grid.lower, grid.inverse, grid.along_axes, cell)
        plane, rest = divmod(int(cell[0]), grid.plane_cells)
        local = plane - int(domain.bounds[domain.comm.rank])
        if 0 <= local < domain.planes:
            interpolate(
                self.position, kernel, domain.periods, store.view(), local + 1, *divmod(rest, grid.counts[2]), grid.counts, grid.periodic, grid.reach, domain.starts,
                store.data, np.array(rows), values,
            )
        domain.comm.Allreduce(MPI.IN_PLACE, values, MPI.SUM)  # all others add exact zeros
        return values


@compiled
def interpolate(
    point, kernel, periods, view, plane, row, column, counts, periodic, reach, starts,
    data, rows, values,
):
    """Shepard mean of some ``rows`` of ``data`` at ``point``, into ``values``."""
    from_k = np.empty(18, np.uint64)
    to_k = np.empty(18, np.uint64)
    ranges, _ = candidate_ranges(
        plane, row, column, counts[1], counts[2], periodic, reach, starts, from_k, to_k
    )
    total = 0.0
    for q in range(ranges):
        for k in range(from_k[q], to_k[q]):
            j = take(view, k)
            x = nearest_image(subtract(point, j.position), periods)
            share = weight(kernel, np.sqrt(dot(x, x))) * j.mass * j.specific_volume
            total += share
            for m in range(len(rows)):
                values[m] += share * data[rows[m], k]
    for m in range(len(rows)):
        values[m] = values[m] / total if total > 0.0 else np.nan
