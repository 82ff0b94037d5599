"""One material point of soil: its stress under a velocity gradient that is given, by the formulas of a run."""

import numpy as np

from psph.physics.stress.bulk import Hooke
from psph.physics.stress.deviator import jaumann_rate
from psph.physics.stress.invariants import j2


class Point:
    """Stress of a material point: ``s`` from the diagonal on and ``rho``; ``like`` tells the dimension."""

    def __init__(self, soil, dimensions, pressure=0.0, position=None):
        up = (0.0,) * (dimensions - 1) + (1.0,)
        self.soil, self.law = soil, soil.law(up, 9.81)
        self.like = (0.0,) * dimensions
        self.position = position or self.like
        self.rest_density = soil.density
        self.state = Hooke(soil.bulk_modulus, soil.tip)
        self.s = (0.0,) * (dimensions * (dimensions + 1) // 2)
        self.rho = self.state.density(pressure, soil.density, 0.0)
        self.plastic = 0.0

    @property
    def p(self):
        """Pressure, Pa."""
        return self.state.pressure(self.rho, self.rest_density, 0.0)

    @property
    def root(self):
        """√J₂, Pa."""
        return np.sqrt(j2(self.s, self.like))

    def strained(self, gradient, steps=1, dt=1.0, bounded=True):
        """The point after so many steps under a velocity gradient (dim, dim)."""
        gradient = np.asarray(gradient, float)
        for _ in range(steps):
            rate = jaumann_rate(tuple(gradient.ravel()), self.s, self.soil.shear_modulus, self.like)
            self.s = tuple(s + dt * ds for s, ds in zip(self.s, rate))
            self.rho *= np.exp(-dt * np.trace(gradient))
            if bounded:
                self.s, self.rho, more = self.law.returned(self, self.s, self.rho)
                self.plastic += more
        return self
