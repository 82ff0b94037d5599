"""The share of the viscosity that each particle of an ideal gas has, after the sums of a step."""

from typing import NamedTuple

import numpy as np

from psph.engine.jit import elementwise
from psph.physics.gas.state import COMPRESSION, EARLIER, LENGTH, ROTATION, SHARE, SHOCKED, SOUND
from psph.physics.gas.switch import followed, nearness, straight
from psph.simulation.each_step import ends_step, step_of


class Sharing(NamedTuple):
    """Arrays by column: what is read, c, h, ∇·v and |∇×v|; what is kept, ∇·v of the step before and s; the
    share that pairs read."""

    sound: object
    length: object
    divergence: object
    rotation: object
    earlier: object
    shocked: object
    share: object


def shares_of(store) -> Sharing:
    """Those of a ``store``."""
    fields = (SOUND, LENGTH, COMPRESSION, ROTATION, EARLIER, SHOCKED, SHARE)
    return Sharing(*(store[field.name] for field in fields))


@elementwise
def find_shares(first, last, least, support, dt, own, of):
    """σ = σ₀ + (1 − σ₀) B s of the columns ``first`` to ``last``; σ₀ is the ``least``, Δt 0 at the start.

    Particles that take steps of their ``own`` have a new share as one ends, by its length in place of
    ``dt``; it stays while they sleep.  ``own`` is None where all take the same.

    Cullen & Dehnen (2010), MNRAS 408, 669, as Borrow and others (2022), MNRAS 511, 2367, simplified it, with
    the factor of Balsara (1995), J. Comput. Phys. 121, 357.
    """
    for k in range(np.uint64(first), np.uint64(last)):
        if ends_step(own, k):
            c, h, divergence, step = of.sound[k], of.length[k], of.divergence[k], step_of(own, dt, k)
            if step > 0.0:
                steepens = (of.earlier[k] - divergence) / step
                found = nearness(divergence, steepens, c, support * h)
                of.shocked[k] = followed(of.shocked[k], found, c, support * h, step)
            of.earlier[k] = divergence
            of.share[k] = least + (1.0 - least) * straight(divergence, of.rotation[k], c, h) * of.shocked[k]
