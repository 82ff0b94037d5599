"""How the particles of each group move and bear: their motion and their equation of state."""

from typing import Any, NamedTuple

from psph.composition.terms import bearing_density
from psph.engine.jit import call_by_number, register_jitable

density = call_by_number("density")
"""(laws, number, pressure, rest_density, sound_speed) → ρ, kg/m^d."""
pressure = call_by_number("pressure")
"""(laws, number, density, rest_density, sound_speed) → p, Pa."""


class Rules(NamedTuple):
    """What kick, drift and equation of state do with a particle, by its group.

    ``effects`` are those with a part in them.  ``laws`` are the scene's equations of state and
    ``law_of`` has the number of each group's.  The first ``free`` groups move freely; ``motion_of`` has
    the number of each group's motion (psph.physics.motion), from PRESCRIBED on one of ``motions``;
    ``poses`` are the maps of what is rigid (psph.simulation.poses) and ``pose_of`` the row of each group, or
    None; ``frame`` is what a moving frame of reference adds to gravity, or None.  ``periods`` m, None for
    an open axis.  ``given_pressure`` are the groups to which a pass gives their pressure; ``booked`` are
    effects whose work on particles is booked; ``own`` are steps of their own that groups take
    (psph.simulation.own_steps), or None.  ``ahead``: by which parts of a step what forces read is ahead
    where the rate of density is that of its middle (psph.simulation.midway), else None.
    """

    effects: tuple
    laws: tuple
    law_of: Any
    given_pressure: Any
    free: Any
    motions: tuple
    motion_of: Any
    poses: Any
    pose_of: Any
    frame: Any
    periods: tuple
    booked: tuple = ()
    own: Any = None
    ahead: Any = None


class Columns(NamedTuple):
    """The arrays of a rank's particles that the step advances; vectors are tuples of component arrays.

    ``coming`` is what is left of their way from the middle of a step (psph.simulation.midway); the last three
    are of particles that take steps of their own (psph.simulation.each_step).
    """

    group: Any
    anchor: Any
    position: Any
    velocity: Any
    predicted_velocity: Any
    acceleration: Any
    density: Any
    density_rate: Any
    density_rate_1: Any
    density_rate_2: Any
    specific_volume: Any
    pressure: Any
    apparent: Any = None
    load: Any = None
    couple: Any = None
    work: Any = None
    whirl: Any = None
    face_normal: Any = None
    drawn_normal: Any = None
    face_side: Any = None
    drawn_side: Any = None
    coming: Any = None
    first_kick: Any = None
    last_kick: Any = None
    seen_ahead: Any = None


@register_jitable
def borne(rules, i, group, rho):
    """Pressure of a particle of ``group`` and density ``rho``, Pa."""
    bearing = rho if group < rules.free else bearing_density(rules.effects, i, rho)
    return pressure(rules.laws, rules.law_of[group], bearing, i.rest_density, i.sound_speed)
