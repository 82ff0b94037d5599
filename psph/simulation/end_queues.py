"""Who comes and who goes behind an open end: queues in strips across its face.

Behind the plane particles stand in strips along its normal, some ``layers`` of them one behind the other.
Whoever crosses in leaves a place, and one is born behind the last of the strip, unless there are as many as
there should be; whoever crosses out takes one, and the last of the strip dies where there are too many.  A
twin for each that crosses in overfills the buffer where
particles go to and fro through the plane.
"""

import numpy as np

from psph.engine.jit import elementwise
from psph.formula import helper

SLACK = 1.5
"""Spacings behind the last layer where a particle dies in any case."""

STAYS, DIES = 0, 1


@elementwise
def run_queues(order, depth, across, periods, crossing, dx, layers, fate, born):
    """What becomes of the particles behind the plane of an end, who takes a place in the ``order`` (n,) of
    depths, so that it is the same however a scene is turned.

    ``depth`` (n,) m behind it, ``across`` (axes, n) m along the face with ``periods`` there, 0 where it does
    not repeat; ``crossing`` (n,) is 1 for those that have come in, −1 for those that have gone out and now
    stand behind the plane, 0 for the rest.  ``fate`` (n,) gets DIES, ``born`` (n,) the depth of the one that
    is born with the numbers of this, 0 for none.
    """
    n = len(depth)
    for k in range(n):
        fate[k] = DIES if crossing[k] < 1 and depth[k] > (layers + SLACK) * dx else STAYS
        born[k] = 0.0
    for k in order:
        if crossing[k] == -1 and fate[k] == STAYS:
            count, last = 0, k
            for j in range(n):
                if fate[j] == STAYS and crossing[j] < 1 and _beside(across, periods, k, j, dx):
                    count += 1
                    if depth[j] > depth[last]:
                        last = j
            if count > layers:
                fate[last] = DIES
    for k in order:
        if crossing[k] == 1:
            count, deepest = 0, depth[k]
            for j in range(n):
                if _beside(across, periods, k, j, dx):
                    if crossing[j] < 1 and fate[j] == STAYS:
                        count += 1
                        deepest = max(deepest, depth[j])
                    if born[j] > 0.0:
                        count += 1
                        deepest = max(deepest, born[j])
            if count < layers:
                born[k] = deepest + dx if count else depth[k] + layers * dx


@helper
def _beside(across, periods, k, j, dx):
    """Whether j is in the strip around k."""
    for d in range(across.shape[0]):
        t = across[d, j] - across[d, k]
        if periods[d] > 0.0:
            t -= periods[d] * np.rint(t / periods[d])
        if abs(t) > 0.5 * dx:
            return False
    return True
