"""What friction at a wall does to the fluid beside it."""

from typing import Any, NamedTuple

from psph.fields import VECTOR, Drifting, Field, Same
from psph.formula import helper
from psph.physics.facts import Facts
from psph.physics.fluid.apparent import rub, rub_of
from psph.physics.fluid.viscosity import corrected_friction, friction, newtonian
from psph.physics.walls.conditions import CONDITIONS, STICKING
from psph.vectors import add, scale, subtract, zero_like

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


def _start(self, i):
    """No fluid yet: Σ W and Σ u W."""
    return 0.0, zero_like(i.position)


def _gather(self, total, i, j, pair):
    """Take a fluid neighbour j into both."""
    w = j.is_fluid * pair.w
    return total[0] + w, add(total[1], scale(j.velocity, w))


@helper
def _finish_value(self, total, i, kernel):
    """v_wall − ṽ in a wall without slip, 0 elsewhere and out of reach of the fluid, m/s."""
    share = i.no_slip / max(total[0], NO_FLUID)
    return scale(subtract(scale(i.velocity, total[0]), total[1]), share)


KNOWN = " or ".join(f'"{one}"' for one in STICKING)


class NoSlip(NamedTuple):
    """Fluid sticks to a wall: for friction the wall mirrors the flow beside it.

    A wall particle shows the velocity 2 v_wall − ṽ, ṽ = Σ_f u_f W_wf / Σ_f W_wf over the fluid, in
    the viscous force alone: beside that of :class:`LaminarViscosity`, a_i = Σ_j F_ij (s_i − s_j)
    with its coefficient F_ij, s = v_wall − ṽ in such a wall and 0 elsewhere.  Adami, Hu & Adams
    (2012), J. Comput. Phys. 231, 7057, eqs. (22), (23).  ṽ is gathered in the same pass as the
    forces, so it is that of the step before.
    """

    refuses = {
        one: f'does nothing where condition = "{one}"; take {KNOWN}, or remove no_slip'
        for one in CONDITIONS
        if one not in STICKING
    }

    writes = MIRRORED
    lagged = True

    def in_scene(self, scene: Facts):
        """With corrected gradients, the form whose friction has them too, and that whose viscosity depends on
        the rate of strain; nothing where the fluid sticks to mirrors alone, which show it a velocity
        themselves, or where no viscosity pulls."""
        if not any(one.no_slip for one in scene.species):
            return None
        if not scene.rheologies and not any(one.viscosity for one in scene.species):
            return None
        if scene.rheologies:
            return ApparentNoSlip(rub_of(scene))
        return self if scene.physics.gradient_correction is None else CorrectedNoSlip()

    def why_absent(self, scene: Facts):
        """Why it has no form in the scene."""
        if any(one.no_slip for one in scene.species):
            return "nothing has a viscosity, and the stress of what resists shear knows such walls itself"
        return "the fluid sticks to mirrors alone"

    def push(self, i, j, pair):
        """Friction with the mirrored flow, beyond that with the wall itself, m/s²."""
        return scale(subtract(i.slip, j.slip), friction(newtonian(i, j), i, j, pair, pair.r2))

    start, gather, finish_value = _start, _gather, _finish_value


class CorrectedNoSlip(NamedTuple):
    """Fluid sticks to a wall: for friction the wall mirrors the flow beside it.

    As :class:`NoSlip` beside :class:`psph.physics.fluid.viscosity.CorrectedViscosity`, with its coefficient
    F_ij: both see one velocity of the wall, 2 v_wall − ṽ.
    """

    writes = MIRRORED
    lagged = True

    def push(self, i, j, pair):
        """Friction with the mirrored flow, beyond that with the wall itself, m/s²."""
        return scale(subtract(i.slip, j.slip), corrected_friction(newtonian(i, j), i, j, pair))

    start, gather, finish_value = _start, _gather, _finish_value


class ApparentNoSlip(NamedTuple):
    """Fluid sticks to a wall: for friction the wall mirrors the flow beside it.

    As :class:`NoSlip` beside :class:`psph.physics.fluid.apparent.ApparentViscosity`, with the coefficient
    F_ij of its form ``friction``.  The grip of a wall particle, min(4 Σ_f V W_wf, 1), says how much of its
    mirrored flow counts in a rate of strain: from the second layer on ṽ is still the flow beside the face.
    """

    friction: Any

    writes = (MIRRORED, GRIP)
    lagged = True

    def push(self, i, j, pair):
        """Friction with the mirrored flow, beyond that with the wall itself, m/s²."""
        return scale(subtract(i.slip, j.slip), rub(self.friction, i, j, pair))

    def finish_value(self, total, i, kernel):
        """The components of v_wall − ṽ, m/s, and the grip."""
        grip = i.no_slip * min(FULL_GRIP * total[0] * i.mass * i.specific_volume, 1.0)
        return _finish_value(self, total, i, kernel) + (grip,)

    start, gather = _start, _gather
