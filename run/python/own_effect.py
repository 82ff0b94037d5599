"""A force and a smoothing kernel of one's own: a drop flies through a porous medium that brakes it."""

import math
from typing import NamedTuple

import psph
from psph.vectors import scale


class Drag(NamedTuple):
    """A porous medium brakes the fluid: a_i = −k v_i.

    H. Darcy, Les fontaines publiques de la ville de Dijon (1856).
    """

    rate: float  # k, 1/s

    def body(self, i):
        """Acceleration, m/s²."""
        return scale(i.velocity, -self.rate)


class Lucy(NamedTuple):
    """Lucy's kernel, W = α(1 + 3s/2)(1−s/2)³₊: Lucy (1977), Astron. J. 82, 1013."""

    inverse_h: float
    alpha: float

    support = 2.0
    norm = (5 / 8, 5 / (4 * math.pi), 105 / (128 * math.pi))

    def w(self, r):
        """W(r)."""
        s = r * self.inverse_h
        a = max(1.0 - 0.5 * s, 0.0)
        return self.alpha * a * a * a * (1.0 + 1.5 * s)

    def dw(self, r):
        """dW/dr, 1/m more than W."""
        s = r * self.inverse_h
        a = max(1.0 - 0.5 * s, 0.0)
        return -3.0 * self.alpha * self.inverse_h * s * a * a


drop = psph.Case(
    {
        "scheme": "sph",
        "space": {"dimensions": 2, "spacing": 0.02, "smoothing": 1.4},
        "time.end": 0.2,
        "physics.sound_speed": 10.0,
        "fluids.drop.shape.disc": {"center": [0.0, 0.0], "radius": 0.2},
        "fluids.drop.velocity": [1.0, 0.0],
    },
    name="drop",
)


def speed(results):
    """The mean velocity of the drop along x at the end, m/s."""
    return results.frames[-1].velocity[:, 0].mean()


free = psph.run(drop, "results/python/free", kernel=Lucy, overwrite=True, quiet=True)
held = psph.run(drop, "results/python/held", effects=[Drag(5.0)], kernel=Lucy, overwrite=True, quiet=True)
print(f"{speed(free):.4f} m/s without drag, {speed(held):.4f} m/s with it; exp(-1) is {math.exp(-1):.4f}")
