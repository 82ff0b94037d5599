"""What plane mirrors show: how each image stands and moves, by the planes in which it is seen.

In a right-angled corner there is an image of an image.  A plane that moves as it is told is where that says
at each moment; of those that stand nothing is computed anew.
"""

from collections.abc import Iterable, Sequence
from itertools import permutations, product
from typing import Any, NamedTuple

import numpy as np

from psph.fields import Field, view_of

BELOW, ABOVE = -1, 1
"""On which side of the particles a plane is."""


class Plane(NamedTuple):
    """A mirror across ``axis`` at ``at`` m, ``side`` (BELOW or ABOVE) of the particles.

    ``sticks``: images move so that the fluid between has the ``velocity`` of the plane, m/s, on the face;
    else they slide along it.  It is where its ``motion`` says, a rigid one, None where it stands.
    """

    axis: int
    side: int
    at: float
    sticks: bool = False
    velocity: tuple[float, ...] = ()
    motion: Any = None

    def then(self, time: float) -> "Plane":
        """The plane where it is at a ``time``, s, and as fast."""
        if self.motion is None:
            return self
        pose = self.motion.pose(time)
        way, velocity = pose.place((0.0, 0.0, 0.0)), tuple(map(float, pose.velocity))
        return self._replace(at=self.at + float(way[self.axis]), velocity=velocity[: len(self.velocity)])


class Reflection(NamedTuple):
    """An image of a particle stands at ``turn`` x + ``shift``, m, and moves with ``turn_velocity`` v +
    ``shift_velocity``, m/s.  ``turn_strain`` are the signs that the components of a rate of strain take,
    upper triangle by rows, ``turn_stress`` those of a stress.  ``sticks``: 1 where a plane does, else 0;
    ``goes_on``: 1 where none does, nor bears weight, else −1.  ``gravity`` in m/s², None on an axis without:
    a still column goes on.  ``rules``: how each field is turned (psph.fields), None where it does not say."""

    turn: tuple[float, ...]
    shift: tuple[float, ...]
    turn_velocity: tuple[float, ...]
    shift_velocity: tuple[float, ...]
    turn_strain: tuple[float, ...]
    turn_stress: tuple[float, ...]
    sticks: float
    goes_on: float
    gravity: tuple[float | None, ...]
    rules: Any

    def seen(self, point) -> tuple[float, ...]:
        """The image of a point, m."""
        return tuple(turn * float(x) + shift for turn, x, shift in zip(self.turn, point, self.shift))


class Mirrors(NamedTuple):
    """All that is seen beside a plane: a particle itself is the first of the ``reflections``.

    ``reach`` m: farther from a plane nothing is seen in it.  From entry ``own`` of the lists on each column
    stands once, in order: a particle in a row of its own.  Numbers in tuples, no arrays: for those compiled
    code would count references at every particle.
    """

    reflections: tuple[Reflection, ...]
    reach: float
    own: Any


def mirrors_of(planes: Sequence[Plane], gravity, reach: float, fields: Iterable[Field]) -> Mirrors | None:
    """What is seen of some ``fields`` beside some planes, under ``gravity`` m/s², from ``reach`` m on; None
    without planes."""
    if not planes:
        return None
    pull = tuple(float(g) or None for g in gravity)
    rule_of = {field.name: field.image and field.image() for field in fields}
    return Mirrors(_reflections(planes, pull, view_of(tuple(rule_of))(**rule_of)), reach, np.uint64(0))


def moved(mirrors: Mirrors, planes: Sequence[Plane]) -> Mirrors:
    """The same ``mirrors`` where the planes stand otherwise."""
    first = mirrors.reflections[0]
    return mirrors._replace(reflections=_reflections(planes, first.gravity, first.rules))


def _reflections(planes: Sequence[Plane], gravity: tuple[float | None, ...], rules) -> tuple[Reflection, ...]:
    """Those in no plane, in one, and in one of each of several axes."""
    beside = [[None, *(plane for plane in planes if plane.axis == d)] for d in range(len(gravity))]
    return tuple(_reflection(list(filter(None, chosen)), gravity, rules) for chosen in product(*beside))


def _reflection(chosen: list[Plane], gravity: tuple[float | None, ...], rules) -> Reflection:
    """One reflection after the other, in the planes ``chosen``.

    Where walls of several velocities meet, the velocity of the image depends on which comes first: the mean
    is taken of all orders.
    """
    dimensions = len(gravity)
    turn, shift = np.ones(dimensions), np.zeros(dimensions)
    for plane in chosen:
        turn[plane.axis], shift[plane.axis] = -1.0, 2.0 * plane.at
    seen = [_velocities(order, dimensions) for order in permutations(chosen)]
    turn_velocity, shift_velocity = np.mean(seen, axis=0)
    sticking = [plane.axis for plane in chosen if plane.sticks]
    strain = _strain_turned(sticking, turn, turn_velocity)
    sliding = np.where(np.isin(np.arange(dimensions), sticking), 1.0, turn)
    stress = np.outer(sliding, sliding)[np.triu_indices(dimensions)]
    rows = (tuple(row.tolist()) for row in (turn, shift, turn_velocity, shift_velocity, strain, stress))
    goes_on = -1.0 if sticking or any(gravity[plane.axis] for plane in chosen) else 1.0
    return Reflection(*rows, float(bool(sticking)), goes_on, gravity, rules)


def _strain_turned(sticking: list[int], turn: np.ndarray, turn_velocity: np.ndarray) -> np.ndarray:
    """Signs of the components of a rate of strain, upper triangle by rows.

    ∂v_d/∂x_e takes that of v_d times that of x_e.  Where these differ for d, e and e, d, across a plane that
    the fluid sticks to, the shear counts, ∂v/∂n along the plane: the other is zero on it.
    """
    signs = np.outer(turn_velocity, turn)
    for n in sticking:
        signs[n] = np.where(np.arange(len(turn)) == n, signs[n], signs[:, n])
    return signs[np.triu_indices(len(turn))]


def _velocities(order: Sequence[Plane], dimensions: int):
    """What turns a velocity into that of the last image, and what is added."""
    turn, shift = np.ones(dimensions), np.zeros(dimensions)
    for plane in order:
        sign = np.ones(dimensions)
        sign[: dimensions if plane.sticks else 0] = -1.0
        sign[plane.axis] = -1.0
        turn, shift = sign * turn, sign * shift
        if plane.sticks:
            shift += 2.0 * np.array(plane.velocity)
        elif plane.motion:
            shift[plane.axis] += 2.0 * plane.velocity[plane.axis]
    return turn, shift
