"""What a pair of particles feels as gravity."""

from typing import NamedTuple

from psph.engine.jit import call_by_type
from psph.physics.facts import Facts
from psph.vectors import add, along, dot


class Steady(NamedTuple):
    """What a pair of particles feels as gravity: ``gravity`` in m/s², None on an axis without."""

    gravity: tuple[float | None, ...]

    def down(self, i, j, pair):
        """g·x_ij, m²/s²."""
        return along(pair.x_ij, self.gravity)


class InFrame(NamedTuple):
    """The same in a frame of reference that moves: forces of inertia are felt as gravity.

    The mean of what the two particles feel (:class:`psph.physics.fluid.frame.MovingFrame`): what grows with
    the distance from an axis is then exact, and the same for both.  ``gravity`` in m/s², None on an axis
    without.
    """

    gravity: tuple[float | None, ...]

    def down(self, i, j, pair):
        """(g + (a_i + a_j)/2)·x_ij with the forces of inertia a per mass, m²/s²."""
        return along(pair.x_ij, self.gravity) + 0.5 * dot(pair.x_ij, add(i.apparent, j.apparent))


Gravitation = Steady | InFrame

down = call_by_type("down")
"""(gravitation, i, j, pair) → g·x_ij of what a pair feels as gravity, m²/s²."""


def gravitation_of(scene: Facts) -> Gravitation:
    """What is felt as gravity in a scene."""
    gravity = tuple(g or None for g in scene.gravity)
    return Steady(gravity) if scene.frame is None else InFrame(gravity)
