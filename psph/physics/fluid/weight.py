"""What a pair of particles feels as gravity."""

from typing import Any, NamedTuple

from psph.engine.jit import call_by_type
from psph.formula import where
from psph.physics.facts import Facts
from psph.physics.motion import goes_free, is_prescribed
from psph.vectors import add, along, dot, scale, subtract


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


class AtMovingWalls(NamedTuple):
    """What a fluid feels as gravity relative to a wall beside it that moves: g − a_w.

    With what the frame of reference adds, as the wall feels it.  A free body is told from a wall by its
    number: its acceleration is that of the step before, and a body that is lighter than the water that it
    would carry along so would shake.  ``gravity`` in m/s², None on an axis without.
    """

    gravity: tuple[float | None, ...]

    def down(self, i, j, pair):
        """(g + a)·x_ij, m²/s², with the ``apparent`` force a of the wall, or of the fluid beside a body."""
        body = where(max(i.solid, j.solid) > 1.0, 1.0, 0.0)
        own = where(body > 0.0, i.is_fluid, 1.0 - i.is_fluid)
        other = where(body > 0.0, j.is_fluid, 1.0 - j.is_fluid)
        felt = add(scale(i.apparent, own), scale(j.apparent, other))
        return along(pair.x_ij, self.gravity) + dot(pair.x_ij, felt)


class Central(NamedTuple):
    """A pull at walls beside a central force (:class:`psph.physics.fluid.gravity.CentralForce`) on all.

    ``steady`` is the rest of it, ``stiffness`` B² in 1/s², ``center`` X in m.
    """

    steady: Any
    stiffness: float
    center: tuple[float, ...]

    def down(self, i, j, pair):
        """(g − B² (x − X))·x_ij with x of the wall, where what turns with it feels no other force, m²/s²."""
        away = subtract(subtract(i.position, scale(pair.x_ij, i.is_fluid)), self.center)
        return down(self.steady, i, j, pair) - self.stiffness * dot(away, pair.x_ij)


Gravitation = Steady | InFrame | AtMovingWalls | Central

down = call_by_type("down")
"""(gravitation, i, j, pair) → g·x_ij of what a pair feels as gravity, m²/s²."""


def gravitation_of(scene: Facts) -> Gravitation:
    """What is felt as gravity in a scene."""
    gravity = tuple(g or None for g in scene.gravity)
    return Steady(gravity) if scene.frame is None else InFrame(gravity)


def pull_at_walls(scene: Facts) -> Gravitation:
    """What a fluid feels as gravity relative to the wall beside it."""
    gravity = tuple(g or None for g in scene.gravity)
    moving = any(is_prescribed(one.motion) and not goes_free(one.motion) for one in scene.species)
    steady = AtMovingWalls(gravity) if moving else gravitation_of(scene)
    central = scene.physics.central_force
    return Central(steady, central.frequency**2, tuple(central.center)) if central else steady
