"""Further fields of particles that evolve as density does: their part in kick, prediction and history."""

from collections.abc import Callable

import numpy as np

from psph.fields import companions
from psph.particles.store import Store
from psph.simulation.each_step import kick_own_rows, predict_own_rows, steps_of
from psph.simulation.integrator import kick_rows, predict_rows


class Evolving:
    """The ``fields`` of a ``store`` that an effect gives a rate; ``each`` takes a loop over owned columns."""

    def __init__(self, fields, store: Store, each: Callable):
        self._fields, self._store, self._each = fields, store, each

    def predict(self, dt: float) -> None:
        """The first half of the kick of ``dt`` s, and the value that forces read."""
        self._go(predict_rows, predict_own_rows, dt)

    def kick(self, dt: float) -> None:
        """The second half of the kick, with the new rates."""
        self._go(kick_rows, kick_own_rows, dt)

    def make_room(self) -> None:
        """For the next rates: those there are become those of the step before, where all take the same."""
        for field in () if steps_of(self._store) else self._fields:
            _, *rates = companions(field)
            self._store.rotate(*(rate.name for rate in rates))

    def _go(self, of_all, of_each, dt: float) -> None:
        if not self._fields:
            return
        if own := steps_of(self._store):
            self._each(of_each, dt, self._store.data, self._rows(), own)
        else:
            self._each(of_all, dt, self._store.data, self._rows())

    def _rows(self) -> np.ndarray:
        """Rows of value, prediction and three rates of each component of what evolves (n, 5)."""
        columns = [
            [self._store.rows[name] for name in (f.name, *(c.name for c in companions(f)))]
            for f in self._fields
        ]
        return np.array([row for rows in columns for row in zip(*rows)], np.int64)
