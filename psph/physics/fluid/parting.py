"""Whether walls hold the fluid that is under tension, or let it part from them."""

from typing import NamedTuple

from psph.engine.jit import call_by_type
from psph.formula import where
from psph.physics.facts import Facts

WHATEVER = 1e30
"""A tension that nothing reaches, Pa."""


class Holding(NamedTuple):
    """Walls pull the fluid as the fluid pulls itself: it cannot leave them."""

    def felt(self, i, j):
        """The part of p_i that the pair feels, and p_j as it feels it, Pa."""
        return 1.0, j.pressure


class Parting(NamedTuple):
    """Walls, rigid bodies and elastic solids push the fluid and do not pull it.

    max(p, 0) stands for both pressures in pairs of a fluid and something else.  Air comes in along a wall
    that a jet leaves at a sharp edge; without air there, suction would bend the jet around it.
    """

    def felt(self, i, j):
        """The part of p_i that the pair feels, and p_j as it feels it, Pa."""
        pulls = where(i.pressure < 0.0, 1.0, 0.0)
        lowest = (-WHATEVER * i.is_fluid) * j.is_fluid
        return (1.0 - pulls) + (pulls * i.is_fluid) * j.is_fluid, max(j.pressure, lowest)


class PartingBesideSoils(NamedTuple):
    """As :class:`Parting`, while soil clings to walls as far as its own strength lets it.

    The tension of a soil is bounded by its cohesion (:class:`psph.physics.stress.strength.Strength`).
    """

    def felt(self, i, j):
        """The part of p_i that the pair feels, and p_j as it feels it, Pa."""
        pulls = where(i.pressure < 0.0, 1.0, 0.0)
        clings = where(i.strength + j.strength > 0.0, 1.0, i.is_fluid * j.is_fluid)
        return (1.0 - pulls) + pulls * clings, max(j.pressure, -WHATEVER * clings)


Hold = Holding | Parting | PartingBesideSoils

felt = call_by_type("felt")
"""(hold, i, j) → the part of p_i that the pair feels, 0 or 1, and p_j as it feels it, Pa (:class:`Parting`).
A part and not a pressure, so that what p_i makes of i alone is known before the loop over j."""


def hold_of(scene: Facts) -> Hold:
    """What walls do in a scene: they let go where a free surface and a floor of the tension are."""
    floor = scene.physics.tension_floor is not None and scene.has_free_surface
    if not floor or all(one.is_fluid for one in scene.species):
        return Holding()
    return PartingBesideSoils() if scene.stressed.laws else Parting()
