"""A floor that moves by one's own law, and a gauge that measures what one wants to know."""

from typing import NamedTuple

import numpy as np

import psph
from psph.fields import FLUID, WALL
from psph.parallel.reductions import exact_sums
from psph.vectors import add, scale


class Steady(NamedTuple):
    """The wall moves at a constant velocity: x = X + Vt."""

    speed: tuple[float, ...]  # V, one number per axis, m/s

    kind = WALL

    def place(self, anchor, time):
        """x, m."""
        return add(anchor, scale(self.speed, time))

    def velocity(self, anchor, time):
        """V, m/s."""
        return self.speed


class Drift(NamedTuple):
    """The mean velocity of the fluid, m/s."""

    every: float  # time between rows, s

    def columns(self, scene):
        """Their names, without the time."""
        return [f"drift_{axis}" for axis in "xyz"[: scene.dimensions]]

    def row(self, simulation):
        """The values, the same on every rank."""
        store = simulation.store
        fluid = store.owned_rows("kind") == FLUID
        velocity = store.owned_rows("velocity")[fluid]
        sums = exact_sums(simulation.comm, np.column_stack([velocity, np.ones(len(velocity))]))
        return sums[:-1] / sums[-1]


layer = psph.Case(
    {
        "scheme": "sph",
        "space": {
            "dimensions": 2,
            "spacing": 0.02,
            "periodic": ["x"],
            "lower": [0, -0.1],
            "upper": [0.4, 0.3],
        },
        "time.end": 0.1,
        "physics": {"gravity": [0.0, -9.8], "sound_speed": 15.0},
        "fluids.water": {"shape.box": {"lower": [0, 0], "upper": [0.4, 0.2]}, "viscosity": 0.01},
        "walls.floor": {"shape.box": {"lower": [0, -0.08], "upper": [0.4, 0]}, "no_slip": True},
    },
    name="belt",
)
results = psph.run(
    layer,
    "results/python/belt",
    motions={"floor": Steady((0.5, 0.0))},
    gauges=[Drift(every=0.01)],
    overwrite=True,
    quiet=True,
)
drift = results.table("drift")
print(f"the floor drags the water along at {drift['drift_x'][-1]:.4f} m/s after {drift['time'][-1]:g} s")
