"""Contact of elastic solids with each other and with walls."""

import math
from itertools import product
from typing import Annotated, NamedTuple

import numpy as np
from pydantic import Field as Key

from psph.acts import BODIES, SOLIDS, UPDATED
from psph.fields import WALL, Field
from psph.formula import helper, where
from psph.physics.facts import Facts
from psph.vectors import dot

CONTACT_ENERGY = Field("contact_energy", "J", "energy of a particle's contacts with other solids")

REACH = 2.0
"""Spacings within which particles of two solids push each other."""

STEP = 0.6
"""Δt ≤ 0.6 √(m/k): with the waves of the solid ωΔt is about 1.1; 2 is the limit."""

AT_REST = 1e-12
"""m/s; slower than this nothing slides."""


class SolidContact(NamedTuple):
    """Particles of two solids, or of a solid and a wall, repel each other where nearer than two spacings.

    f_ij = ¼k dx q² along x_ij/r, q = 2 − r/dx: the derivative of the pair's energy k dx² q³/12. k = s
    2M_iM_j/(M_i + M_j) dx^(d−2) with the ``stiffness`` s and the P-wave moduli M = λ + 2μ (of a wall, the
    largest of all solids). Faces a spacing apart feel nothing; where they touch they bear 0.36 sM in 2D,
    0.52 sM in 3D. The reach of two spacings makes a lattice smooth: it holds back what slides on it by 2
    to 8 % of the push, where a reach of one would by 30 %. Without damping and friction the push depends
    on places alone, so that it keeps energy and both momenta. ``damping`` ζ: max(f_ij − 2ζ√(k m) q
    u_ij·x_ij/r, 0), m = m_im_j/(m_i + m_j). ``friction`` is Coulomb's: a force μ f_ij against the sliding
    u_t, but never more than 2√(k m) |u_t|; it keeps the momentum alone. Penalties by pairs: Belytschko &
    Neal (1991), Int. J. Numer. Methods Eng. 31, 547; in SPH Campbell, Vignjevic & Libersky (2000),
    Comput. Methods Appl. Mech. Eng. 184, 49.
    """

    acts = (SOLIDS, BODIES)
    refuses = {
        UPDATED: 'updated Lagrangian solids feel each other without; remove it, or give description = "total"'
    }

    stiffness: Annotated[
        float,
        Key(gt=0, le=10, description="s: stiffness over that of the solids", json_schema_extra={"unit": "1"}),
    ] = 1.0
    damping: Annotated[
        float,
        Key(
            ge=0,
            le=1,
            description="ζ: damping over that from which on two particles do not swing back",
            json_schema_extra={"unit": "1"},
        ),
    ] = 0.0
    friction: Annotated[
        float, Key(ge=0, description="Coulomb's coefficient μ", json_schema_extra={"unit": "1"})
    ] = 0.0
    restitution: Annotated[
        float,
        Key(
            ge=0,
            le=1,
            description="of rigid bodies: speed after an impact over that before",
            json_schema_extra={"unit": "1"},
        ),
    ] = 0.3

    def in_scene(self, scene: Facts):
        """With the spacing of the scene; nothing where there is but one solid, and no wall."""
        elastic = [one for one in scene.species if one.elastic is not None]
        pairs = [(i, j) for i, j in product(elastic, scene.species) if i.solid != j.solid]
        if not pairs:
            return None
        kind = Rubbing if self.friction else Touching
        dx, d = scene.spacing, scene.dimensions
        made = kind(self.stiffness * dx ** (d - 2), self.damping, self.friction, dx, 0.0)
        hardest = max(spring(made, i, j) / min(i.mass, j.mass) for i, j in pairs)
        return made._replace(step=STEP / (math.sqrt(hardest) * (1.0 + self.damping)))

    def why_absent(self, scene: Facts):
        """That nothing can meet, or nothing elastic."""
        if any(one.solid > WALL and one.elastic is None for one in scene.species):
            return "rigid bodies meet by impulses, with its friction and its restitution"
        return "the scene has one solid and no wall, so nothing meets"


@helper
def spring(contact, i, j):
    """k of a pair, N/m."""
    product = i.wave_modulus * j.wave_modulus
    return 2.0 * contact.stiffness * product / (i.wave_modulus + j.wave_modulus)


@helper
def dashpot(contact, i, j):
    """2√(k m) of a pair, N s/m."""
    return 2.0 * np.sqrt(spring(contact, i, j) * ((i.mass * j.mass) / (i.mass + j.mass)))


@helper
def nearness(contact, i, j, pair):
    """q, by how many spacings two solids are nearer than two; 0 beyond that and within one solid."""
    other = j.solid - i.solid
    return where(other * other > 0.0, max(REACH - pair.r / contact.spacing, 0.0), 0.0)


@helper
def pressing(contact, i, j, pair):
    """f_ij, N."""
    q = nearness(contact, i, j, pair)
    apart = dashpot(contact, i, j) * (contact.damping * q * (pair.u_dot_x * pair.inverse_r))
    return max(0.25 * spring(contact, i, j) * contact.spacing * (q * q) - apart, 0.0)


class Touching(NamedTuple):
    """Particles of two solids, or of a solid and a wall, repel each other where nearer than two spacings.

    The form of :class:`SolidContact` in a scene: ``stiffness`` s dx^(d−2), ``damping`` ζ, ``friction`` μ,
    ``spacing`` dx in m, and the longest ``step`` in s.
    """

    writes = CONTACT_ENERGY

    stiffness: float
    damping: float
    friction: float
    spacing: float
    step: float

    def radial(self, i, j, pair):
        """Coefficient of x_ij in the acceleration, 1/s²."""
        return pressing(self, i, j, pair) * pair.inverse_r / i.mass

    def start(self, i):
        """No energy yet."""
        return 0.0

    def gather(self, total, i, j, pair):
        """With the particle's half of the pair's energy."""
        q = nearness(self, i, j, pair)
        return total + spring(self, i, j) * (self.spacing * self.spacing / 24.0) * (q * q * q)

    def finish_value(self, total, i, kernel):
        """The energy of its contacts, J."""
        return total

    def longest_step(self, scene):
        """Δt ≤ 0.6 √(m/k)/(1 + ζ), s, of the stiffest contact and its lighter particle."""
        return self.step


@helper
def rubbing(contact, i, j, pair):
    """What the force against sliding is over its speed, N s/m."""
    along = pair.u_dot_x * pair.inverse_r
    slides = np.sqrt(max(dot(pair.u_ij, pair.u_ij) - along * along, 0.0)) + AT_REST
    held = where(nearness(contact, i, j, pair) > 0.0, dashpot(contact, i, j), 0.0)
    return min(contact.friction * pressing(contact, i, j, pair) / slides, held)


class Rubbing(NamedTuple):
    """Particles of two solids, or of a solid and a wall, push and rub each other: they are nearer
    than two spacings.

    :class:`Touching`, with friction.
    """

    writes = CONTACT_ENERGY

    stiffness: float
    damping: float
    friction: float
    spacing: float
    step: float

    def radial(self, i, j, pair):
        """Coefficient of x_ij in the acceleration, 1/s²: the push, and u_ij along it that does not rub."""
        along = rubbing(self, i, j, pair) * (pair.u_dot_x * pair.inverse_r)
        return (pressing(self, i, j, pair) + along) * pair.inverse_r / i.mass

    def shear(self, i, j, pair):
        """Coefficient of u_ij in the acceleration, 1/s."""
        return -rubbing(self, i, j, pair) / i.mass

    start = Touching.start
    gather = Touching.gather
    finish_value = Touching.finish_value
    longest_step = Touching.longest_step
