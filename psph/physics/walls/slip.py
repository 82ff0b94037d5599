"""What friction at a wall does to the fluid beside it."""

from typing import Any, NamedTuple

from psph.engine.jit import call_by_type
from psph.fields import VECTOR, Drifting, Field, Same
from psph.formula import helper
from psph.physics.facts import Facts
from psph.physics.fluid.apparent import rub_beside
from psph.physics.fluid.friction import Rub, rub, rub_of
from psph.physics.motion import is_rigid
from psph.physics.walls.conditions import CONDITIONS, STICKING
from psph.vectors import add, applied, scale, subtract, zero_like

MIRRORED = Field(
    "slip",
    "m/s",
    "a wall's velocity minus that of the fluid around it; 0 in the fluid",
    VECTOR,
    image=Drifting,
)
GRIP = Field(
    "grip", "1", "how much of what a wall mirrors counts in a rate of strain; 0 in the fluid", image=Same
)

FULL_GRIP = 4.0
"""One over the part of a kernel that fluid fills around the first layer of a wall."""

NO_FLUID = 1e-300
"""Keeps a kernel sum without any fluid from dividing by zero, 1/m^d."""


class Straight(NamedTuple):
    """No wall without slip turns."""

    def carried(self, i, j, pair):
        """The velocity of fluid j, m/s."""
        return j.velocity


class Turning(NamedTuple):
    """Walls without slip turn as they move as a whole."""

    def carried(self, i, j, pair):
        """The velocity of fluid j less what the turn of wall i makes of it between them, m/s."""
        return add(j.velocity, applied(i.whirl, pair.x_ij))


class Bending(NamedTuple):
    """What has no slip turns as it bends, each particle by itself (psph.physics.solid.turn)."""

    def carried(self, i, j, pair):
        """The velocity of fluid j less what the turn of i makes of it between them, m/s."""
        return add(j.velocity, applied(i.own_turn, pair.x_ij))


class TurningOrBending(NamedTuple):
    """Of what has no slip some turns as it moves as a whole, and some as it bends."""

    def carried(self, i, j, pair):
        """The velocity of fluid j less what the turn of i makes of it between them, m/s."""
        return add(j.velocity, applied(add(i.whirl, i.own_turn), pair.x_ij))


carried = call_by_type("carried")
"""(how walls move, i, j, pair) → the velocity of fluid j as a turn of wall i carries it to i, m/s."""


def _start(self, i):
    """No fluid yet: Σ W and Σ u W."""
    return 0.0, zero_like(i.position)


def _gather(self, total, i, j, pair):
    """Take a fluid neighbour j into both."""
    w = j.is_fluid * pair.w
    return total[0] + w, add(total[1], scale(carried(self.walls, i, j, pair), w))


@helper
def _missing(total, i):
    """v_wall − ṽ in a wall without slip, 0 elsewhere and out of reach of the fluid, m/s."""
    share = i.no_slip / max(total[0], NO_FLUID)
    return scale(subtract(scale(i.velocity, total[0]), total[1]), share)


def _push(self, i, j, pair):
    """Friction with the mirrored flow, beyond that with the wall itself, m/s²."""
    return scale(subtract(i.slip, j.slip), rub(self.friction, i, j, pair))


KNOWN = " or ".join(f'"{one}"' for one in STICKING)


class NoSlip(NamedTuple):
    """Fluid sticks to a wall: for friction the wall mirrors the flow beside it.

    A wall particle shows the velocity 2 v_wall − ṽ, ṽ = Σ_f (u_f + [ω] x_wf) W_wf / Σ_f W_wf over the fluid,
    in the viscous force alone: beside that of :class:`LaminarViscosity
    <psph.physics.fluid.viscosity.LaminarViscosity>`, a_i = Σ_j F_ij (s_i − s_j) with its coefficient F_ij,
    s = v_wall − ṽ in such a wall and 0 elsewhere.  Adami, Hu & Adams (2012), J. Comput. Phys. 231, 7057,
    eqs. (22), (23), but for [ω], the turn of a wall that moves as a whole: fluid that turns with it has
    s = 0.  ṽ is gathered in the same pass as the forces, so it is that of the step before.
    """

    refuses = {
        one: f'does nothing where condition = "{one}"; take {KNOWN}, or remove no_slip'
        for one in CONDITIONS
        if one not in STICKING
    }

    def in_scene(self, scene: Facts):
        """The form with the friction of the fluids, and that whose viscosity depends on the rate of strain;
        nothing where the fluid sticks to mirrors alone, which show it a velocity themselves, or where no
        viscosity pulls."""
        sticking = [one for one in scene.species if one.no_slip]
        if not sticking or not (scene.rheologies or any(one.viscosity for one in scene.species)):
            return None
        walls = _turning(sticking)
        if scene.rheologies:
            return GrippedFlow(rub_beside(scene), walls)
        return MirroredFlow(rub_of(scene), walls)

    def why_absent(self, scene: Facts):
        """Why it has no form in the scene."""
        if any(one.no_slip for one in scene.species):
            return "nothing has a viscosity, and the stress of what resists shear knows such walls itself"
        return "the fluid sticks to mirrors alone"


def _turning(sticking):
    """How what has no slip turns."""
    rigid = any(is_rigid(one.motion) for one in sticking)
    if any(one.bonded is not None for one in sticking):
        return TurningOrBending() if rigid else Bending()
    return Turning() if rigid else Straight()


class MirroredFlow(NamedTuple):
    """Fluid sticks to a wall: for friction the wall mirrors the flow beside it.

    The form of :class:`NoSlip` in a scene: the ``friction`` of F_ij, and how the ``walls`` move.
    """

    friction: Any = Rub()
    walls: Any = Straight()

    writes = MIRRORED
    lagged = True

    def finish_value(self, total, i, kernel):
        """v_wall − ṽ, m/s."""
        return _missing(total, i)

    start, gather, push = _start, _gather, _push


class GrippedFlow(NamedTuple):
    """Fluid sticks to a wall: for friction the wall mirrors the flow beside it.

    As :class:`MirroredFlow` beside :class:`psph.physics.fluid.apparent.ApparentViscosity`.  The grip of a
    wall particle, min(4 Σ_f V W_wf, 1), says how much of its mirrored flow counts in a rate of strain: from
    the second layer on ṽ is still the flow beside the face.
    """

    friction: Any = Rub()
    walls: Any = Straight()

    writes = (MIRRORED, GRIP)
    lagged = True

    def finish_value(self, total, i, kernel):
        """The components of v_wall − ṽ, m/s, and the grip."""
        grip = i.no_slip * min(FULL_GRIP * total[0] * i.mass * i.specific_volume, 1.0)
        return _missing(total, i) + (grip,)

    start, gather, push = _start, _gather, _push
