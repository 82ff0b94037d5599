"""Who leads as those of other levels of sizes see it in plane mirrors: beside a plane they follow what is on
both of its sides, not a mean of one.

What mirrors show is told here as arrays: a loop over entries would copy the tuples of a reflection at each.
"""

from typing import NamedTuple

import numpy as np

from psph.composition.reflections import Mirrors
from psph.formula import helper


class LeaderImages(NamedTuple):
    """The images of a particle at x m with v m/s, itself the first: at ``turn`` x + ``shift`` m, with
    ``turn_velocity`` v + ``shift_velocity`` m/s, components (dim,) (images,).  Nothing is seen farther than
    ``reach`` m from a plane.  The pressure of a still column changes by ``weight`` (dim,), Pa/m, along each
    axis: where an image is ``deeper`` (images,) than what it shows, or higher, it has another."""

    turn: tuple[np.ndarray, ...]
    shift: tuple[np.ndarray, ...]
    turn_velocity: tuple[np.ndarray, ...]
    shift_velocity: tuple[np.ndarray, ...]
    reach: float
    weight: tuple[float, ...]
    deeper: np.ndarray

    def shown_to(self, position: np.ndarray) -> np.ndarray:
        """How many images of others particles at ``position`` (n, dim), m, may see (n,)."""
        near = np.ones((len(position), len(self.turn[0])), bool)
        for x, turn, shift in zip(position.T, self.turn, self.shift):
            near &= (turn > 0.0) | (np.abs(2.0 * x[:, None] - shift) < 2.0 * self.reach)
        return near.sum(axis=1)


def images_in(mirrors: Mirrors | None, gravity: np.ndarray, density: float) -> LeaderImages:
    """What ``mirrors`` show of a fluid of a ``density``, kg/m³, under ``gravity`` (dim,), m/s²; without any,
    itself."""
    weight = density * gravity
    if mirrors is None:
        one, none = np.ones((len(gravity), 1)), np.zeros((len(gravity), 1))
        told = [one, none, one, none]
    else:
        names = "turn", "shift", "turn_velocity", "shift_velocity"
        told = [np.array([getattr(one, name) for one in mirrors.reflections]).T.copy() for name in names]
    turn, shift, *_ = told
    deeper = (weight[:, None] * (np.abs(shift) + np.abs(turn - 1.0))).any(axis=0)
    reach = 0.0 if mirrors is None else float(mirrors.reach)
    return LeaderImages(*map(tuple, told), reach, tuple(weight.tolist()), deeper)


@helper
def is_near(images, m, x):
    """Whether image number ``m`` of others may be near to a place ``x``, m."""
    found = True
    for d in range(len(x)):
        away = abs(2.0 * x[d] - images.shift[d][m])
        found = found and (images.turn[d][m] > 0.0 or away < 2.0 * images.reach)
    return found
