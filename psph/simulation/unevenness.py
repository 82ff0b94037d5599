"""How unevenly a fluid flows: what it does beside what all of it may do alike."""

import math

import numpy as np

from psph.parallel.reductions import largest
from psph.physics.motion import is_prescribed

ALIKE = 1e-9
"""Part of their speed by which velocities of what goes along as one differ, by rounding."""


class Unevenness:
    """Velocities of ``some`` groups (groups,) beside that of all of them along axes on which these may
    stream, since they repeat, or lie between open ends, or since nothing stands there; and beside that of all
    walls and bodies along the others, where these go as one."""

    def __init__(self, rank, some: np.ndarray):
        scene, plan, self.store, self.domain, _ = rank
        species = plan.materials.species
        self._some, self._others = some, np.array([not one.is_fluid for one in species])
        ends, mirrors = ([one.axis for one in each] for each in (scene.case.ends.values(), plan.planes))
        self.free = np.array(
            [
                period is not None or axis in ends or not (self._others.any() or axis in mirrors)
                for axis, period in enumerate(scene.layout.periods)
            ]
        )
        self._may = self.free.any() or any(is_prescribed(one.motion) for one in species)

    def uneven(self) -> float:
        """The largest of those velocities, m/s; infinity where nothing but what they are is taken off."""
        if not self._may:
            return math.inf
        comm, store, dimensions = self.domain.comm, self.store, self.store.dimensions
        group = store.group[store.inner]
        velocity = [one[store.inner] for one in store["velocity"]]
        parts = [[one[which[group]] for one in velocity] for which in (self._some, self._others)]
        tops = [way * one for part in parts for way in (1.0, -1.0) for one in part]
        ends = largest(comm, [one.max(initial=-math.inf) for one in tops]).reshape(2, 2, dimensions)
        (most, least), (most_of_others, least_of_others) = ends * [[[1.0], [-1.0]]]
        wide = most_of_others - least_of_others  # minus infinity where there is nothing else
        alike = (wide >= 0.0) & (wide <= ALIKE * np.abs(most_of_others))
        along = np.where(self.free, 0.5 * (most + least), np.where(alike, most_of_others, 0.0))
        if not along.any():
            return math.inf
        apart2 = sum((one - v) ** 2 for one, v in zip(parts[0], along))
        return math.sqrt(largest(comm, [np.max(apart2, initial=0.0)])[0])
