"""Whether walls hold the fluid that is under tension, or let it part from them."""

from typing import NamedTuple

from psph.engine.jit import call_by_type
from psph.formula import helper, where
from psph.physics.facts import Facts

WHATEVER = 1e30
"""A tension that nothing reaches, Pa m⁶/kg²."""


@helper
def over_square(one):
    """p/ρ² of a particle."""
    return one.pressure * one.specific_volume * one.specific_volume


class Holding(NamedTuple):
    """Walls pull the fluid as the fluid pulls itself: it cannot leave them."""

    def felt(self, i, j):
        """p/ρ² of both as the pair feels them."""
        return over_square(i), over_square(j)


class Parting(NamedTuple):
    """Walls, rigid bodies and elastic solids push the fluid and do not pull it.

    max(p, 0) stands for both pressures in pairs of a fluid and something else.  Air comes in along a wall
    that a jet leaves at a sharp edge; without air there, suction would bend the jet around it.
    """

    def felt(self, i, j):
        """p/ρ² of both as the pair feels them."""
        own = over_square(i)
        lowest = (-WHATEVER * i.is_fluid) * j.is_fluid
        return max(own, 0.0) + (min(own, 0.0) * i.is_fluid) * j.is_fluid, max(over_square(j), lowest)


class PartingBesideStrength(NamedTuple):
    """As :class:`Parting`, while soil clings to walls as far as its own strength lets it.

    The tension of a soil is bounded by its cohesion (:class:`psph.physics.stress.strength.Strength`).
    """

    def felt(self, i, j):
        """p/ρ² of both as the pair feels them."""
        own = over_square(i)
        clings = where(i.strength + j.strength > 0.0, 1.0, i.is_fluid * j.is_fluid)
        return max(own, 0.0) + min(own, 0.0) * clings, max(over_square(j), -WHATEVER * clings)


Hold = Holding | Parting | PartingBesideStrength

felt = call_by_type("felt")
"""(hold, i, j) → p_i/ρ_i² and p_j/ρ_j² as the pair feels them, m⁵/(kg s²) in 3D (:class:`Parting`)."""


def hold_of(scene: Facts) -> Hold:
    """What walls do in a scene: they let go where a free surface and a floor of the tension are."""
    floor = scene.physics.tension_floor is not None and scene.has_free_surface
    if not floor or all(one.is_fluid for one in scene.species):
        return Holding()
    return PartingBesideStrength() if scene.strengths else Parting()
