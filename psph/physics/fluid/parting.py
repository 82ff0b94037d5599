"""Whether walls hold the fluid that is under tension, or let it part from them."""

from typing import NamedTuple

from psph.engine.jit import call_by_type
from psph.formula import helper, where
from psph.physics.facts import Facts

WHATEVER = 1e30
"""A tension that nothing reaches, Pa."""


class Holding(NamedTuple):
    """Walls pull the fluid as the fluid pulls itself: it cannot leave them."""

    def borne(self, i, j):
        """p of both as the pair feels them."""
        return i.pressure, j.pressure


class Parting(NamedTuple):
    """Walls, rigid bodies and elastic solids push the fluid and do not pull it.

    max(p, 0) stands for both pressures in pairs of a fluid and something else.  Air comes in along a wall
    that a jet leaves at a sharp edge; without air there, suction would bend the jet around it.
    """

    def borne(self, i, j):
        """p of both as the pair feels them."""
        lowest = (-WHATEVER * i.is_fluid) * j.is_fluid
        own = max(i.pressure, 0.0) + (min(i.pressure, 0.0) * i.is_fluid) * j.is_fluid
        return own, max(j.pressure, lowest)


class PartingBesideStrength(NamedTuple):
    """As :class:`Parting`, while soil clings to walls as far as its own strength lets it.

    The tension of a soil is bounded by its cohesion (:class:`psph.physics.stress.strength.Strength`).
    """

    def borne(self, i, j):
        """p of both as the pair feels them."""
        clings = where(i.strength + j.strength > 0.0, 1.0, i.is_fluid * j.is_fluid)
        own = max(i.pressure, 0.0) + min(i.pressure, 0.0) * clings
        return own, max(j.pressure, -WHATEVER * clings)


Hold = Holding | Parting | PartingBesideStrength

borne = call_by_type("borne")
"""(hold, i, j) → p_i and p_j as the pair feels them, Pa (:class:`Parting`)."""


@helper
def felt(hold, i, j):
    """p_i/ρ_i² and p_j/ρ_j² as the pair feels them, m⁵/(kg s²) in 3D."""
    own, other = borne(hold, i, j)
    return (
        own * i.specific_volume * i.specific_volume,
        other * j.specific_volume * j.specific_volume,
    )


def hold_of(scene: Facts) -> Hold:
    """What walls do in a scene: they let go where a free surface and a floor of the tension are."""
    floor = scene.physics.tension_floor is not None and scene.has_free_surface
    if not floor or all(one.is_fluid for one in scene.species):
        return Holding()
    return PartingBesideStrength() if scene.strengths else Parting()
