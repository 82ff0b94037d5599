"""Softening by the sizes of particles: how far each reaches, and how the depth of its pull grows with its
number."""

import numpy as np

from psph.engine.jit import elementwise
from psph.engine.threads import in_threads
from psph.physics.gas.softening import DEEPENING
from psph.physics.gas.state import LENGTH
from psph.physics.self_gravity import growing_depth
from psph.smoothing import slope, unit_kernel
from psph.vectors import at, dot, nearest_image, subtract
from psph.work import Rank


class Deepening:
    """The reach of the particles of a ``rank``, and Y (psph.physics.gas.softening); ``factor`` is G."""

    def __init__(self, rank: Rank, factor: float):
        self._store, self._domain, self._factor = rank.store, rank.domain, factor
        self._kernel = unit_kernel(rank.scene.kernel, rank.scene.dimensions)
        self._periods = tuple(rank.scene.layout.periods)

    def reach(self, columns) -> np.ndarray:
        """H of some columns, m: the support of their kernels."""
        return self._kernel.support * self._store[LENGTH.name][columns]

    def renew(self) -> None:
        """Y of all that this rank owns, from their lists."""
        store = self._store
        mass = store.value("mass")
        mass = mass if isinstance(mass, np.ndarray) else np.full(store.total, mass)
        kernel = self._factor, self._kernel, self._kernel.support
        lists = store.low, *kernel, self._periods, self._domain.lists
        arrays = store["position"], mass, store[LENGTH.name], store[DEEPENING.name]
        in_threads(find_deepening, store.low, store.low + store.owned, *lists, *arrays)


@elementwise
def find_deepening(
    first, last, low, factor, kernel, support, periods, lists, position, mass, length, deepening
):
    """Y_i = h_i/(d n_i Ω_i) G Σ_j m_j D(r_ij/H_i)/H_i² over all others, of the columns ``first`` to
    ``last``."""
    for k in range(np.uint64(first), np.uint64(last)):
        row, h = k - np.uint64(low), length[k]
        reach, growing, depth = support * h, 0.0, 0.0
        for entry in range(lists.begin[row], lists.begin[row] + np.uint64(lists.lengths[row])):
            j = np.uint64(lists.lists[entry])
            x = nearest_image(subtract(at(position, k), at(position, j)), periods)
            r = np.sqrt(dot(x, x))
            growing -= r / h * slope(kernel, r / h)
            depth += mass[j] * growing_depth(r / reach)
        # d n Ω = growing/h^d
        share = h ** (len(position) + 1) / growing if growing > 0.0 else 0.0
        deepening[k] = factor * depth / (reach * reach) * share
