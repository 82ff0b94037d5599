"""Fields that evolve within bounds: each is brought back once it is predicted, and after each kick."""

import numpy as np

from psph.composition.pair import take
from psph.engine.jit import elementwise
from psph.physics.stress.strength import admitted
from psph.simulation.rules import borne
from psph.vectors import at, put


@elementwise
def admit_predicted(first, last, effect, rules, view, value, columns):
    """Bring back the predicted ``value`` (component arrays), and the density that the forces read."""
    c = columns
    for k in range(np.uint64(first), np.uint64(last)):
        i, group = take(view, k), c.group[k]
        rho = 1.0 / c.specific_volume[k]
        found, admissible, _ = admitted(effect, i, at(value, k), rho)
        put(value, k, found)
        if admissible != rho:
            c.specific_volume[k] = 1.0 / admissible
            c.pressure[k] = borne(rules, i, group, admissible)


@elementwise
def admit_kicked(first, last, effect, view, value, density, remembered):
    """Bring back the ``value`` (component arrays) and the density of the end of a step, and add to what the
    effect remembers."""
    for k in range(np.uint64(first), np.uint64(last)):
        found, rho, more = admitted(effect, take(view, k), at(value, k), density[k])
        put(value, k, found)
        density[k] = rho
        remembered[k] += more
