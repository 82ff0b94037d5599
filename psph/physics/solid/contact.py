"""Contact of elastic solids with each other and with walls, along the normals of the faces that are drawn."""

import math
from itertools import product
from typing import Annotated, NamedTuple

import numpy as np
from pydantic import Field as Key

from psph.acts import BODIES, SOLIDS, UPDATED
from psph.fields import VECTOR, WALL, Field
from psph.formula import helper, where
from psph.physics.facts import Facts
from psph.vectors import add, dot, scale, subtract

CONTACT_ENERGY = Field("contact_energy", "J", "energy of a particle's contacts with other solids")

FACE = Field(
    "face", "1", "normal of the face nearest to a particle of a solid or a wall, zeros at an edge", VECTOR
)
COVER = Field("cover", "1", "how far below that face the particle was drawn, in spacings")

OF_CONTACT = (FACE, COVER)
"""What particles carry where elastic solids meet."""

REACH = 2.5
"""Spacings within which particles of two solids may push each other."""

LAYER = 1.5
"""Spacings below its face from which a particle bears nothing of a contact."""

ALONG = 1.5
"""Spacings along the face within which a pair bears a part of a contact."""

SHARES = (0.0, 16.0 / 15.0 * ALONG, math.pi / 3.0 * ALONG**2)
"""Σ_j (1 − t²/(1.5dx)²)² over a layer of particles, by the dimension less 1: the integral over the face."""

BEHIND = 1.5
"""Spacings by which a particle may be behind another, along the normal, and still be pushed out."""

HARDENING = 0.5
"""Spacings of overlap at which a contact is twice as stiff as where the faces touch."""

FIRM = 50.0
"""Over the overlap in half spacings: where this is 1, damping is full."""

STEP = 0.6
"""Δt ≤ 0.6 √(m/k): with the waves of the solid ωΔt is about 1.1; 2 is the limit."""

AT_REST = 1e-12
"""m/s; slower than this nothing slides."""

NO_WAY = 1e-12
"""Of a direction, below which it is none."""


class SolidContact(NamedTuple):
    """The faces of two solids, or of a solid and a wall, repel each other where they overlap.

    A particle has the normal N of the face drawn nearest to it, as it is now (psph.simulation.solid_faces),
    and its depth s below that at the start; at edges it has no N.  A pair pushes along n, the
    direction of N_j − N_i, or, where neither has a face, of x_ij, with the overlap δ = s_i + s_j − x_ij·n
    of the faces: p = E δ/dx (1 + (δ/½dx)²), which has no bound.  E = s 2M_iM_j/(M_i + M_j) with the
    ``stiffness`` s and the P-wave moduli M = λ + 2μ (of a wall, the largest of all solids): that of the two
    half rows of matter before the faces, so that a contact is no softer than the solid.  The share of a pair
    in the pressure on a face is b_ib_j (1 − t²/(1.5dx)²)², b = 1.5 − s/dx, with t its distance along the
    face; the push has −∂/∂x of that too, so that energy is kept but for the turn of normals.  A plane face
    at any angle to the lattice pushes along its normal.  ``damping`` ζ: less 2ζ√(k m) u_ij·n, but no pull,
    m = m_im_j/(m_i + m_j).  ``friction`` is Coulomb's: a force μ f_ij against the sliding u_t, but never more
    than 2√(k m) |u_t|: so slowly solids creep where they would stick.
    Penalties: Belytschko & Neal (1991), Int. J. Numer. Methods Eng. 31, 547; in SPH Campbell, Vignjevic &
    Libersky (2000), Comput. Methods Appl. Mech. Eng. 184, 49; by normals of surfaces Vignjevic, De Vuyst &
    Campbell (2006), CMES 13, 35.
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
        shape = self.stiffness * dx ** (d - 2), self.damping, self.friction, dx, 1.0 / SHARES[d - 1]
        made = kind(*shape, 0.0)
        hardest = max(modulus(made, i, j) / min(i.mass, j.mass) for i, j in pairs)
        return made._replace(step=STEP / (math.sqrt(hardest) * (1.0 + self.damping)))

    def why_absent(self, scene: Facts):
        """That nothing can meet, or nothing elastic."""
        if any(one.solid > WALL and one.elastic is None for one in scene.species):
            return "rigid bodies meet by impulses, with its friction and its restitution"
        return "the scene has one solid and no wall, so nothing meets"


@helper
def modulus(contact, i, j):
    """E of a pair times dx^(d−2), N/m: the force per overlap on a particle of a face."""
    product = i.wave_modulus * j.wave_modulus
    return 2.0 * contact.stiffness * product / (i.wave_modulus + j.wave_modulus)


@helper
def dashpot(contact, i, j):
    """2√(k m) of a pair, N s/m."""
    return 2.0 * np.sqrt(modulus(contact, i, j) * ((i.mass * j.mass) / (i.mass + j.mass)))


class Meeting(NamedTuple):
    """How a pair meets: the unit vector ``out`` of j towards i, the ``overlap`` δ in m of their faces, the
    ``share`` of the pair, and −∂/∂x_i of this along the face, ``fading`` 1/m."""

    out: tuple
    overlap: float
    share: float
    fading: tuple


@helper
def bearing(contact, i):
    """b of a particle: 1 in the first row below a face, 0 in the second."""
    return min(max(LAYER - i.cover, 0.0), 1.0)


@helper
def meeting(contact, i, j, pair):
    """Of particles of different solids; a share of 0 within one solid."""
    known, its = min(dot(i.face, i.face), 1.0), min(dot(j.face, j.face), 1.0)  # 1 or 0, but for rounding
    bare = (1.0 - known) * (1.0 - its)
    way = add(subtract(j.face, i.face), scale(pair.x_ij, bare * pair.inverse_r))
    length = np.sqrt(dot(way, way)) + NO_WAY
    out = scale(way, 1.0 / length)
    apart = dot(pair.x_ij, out)
    aside = max(pair.r2 - apart * apart, 0.0) * (1.0 / (ALONG * ALONG)) / (contact.spacing * contact.spacing)
    beside = max(1.0 - aside, 0.0)
    facing = min(max(1.0 - known * its - dot(i.face, j.face), 0.0), 1.0)  # 0 from a right angle on
    other = j.solid - i.solid
    # From far behind its face a particle is not met: there is the other face of what is thin.
    facing = facing * min(max(BEHIND + apart / contact.spacing, 0.0), 1.0)
    facing = facing * min(max(2.0 * (REACH - pair.r / contact.spacing), 0.0), 1.0)
    part = bearing(contact, i) * bearing(contact, j) * facing * contact.part
    part = where(other * other > 0.0, part * beside, 0.0)
    along = subtract(pair.x_ij, scale(out, apart))
    steep = 4.0 / (ALONG * ALONG) / (contact.spacing * contact.spacing)
    overlap = max((i.cover + j.cover) * contact.spacing - apart, 0.0)
    return Meeting(out, overlap, part * beside, scale(along, steep * part))


@helper
def energy(contact, i, j, met):
    """The energy of a pair with a share of 1, J."""
    part = met.overlap / contact.spacing * (1.0 / HARDENING)
    return modulus(contact, i, j) * (met.overlap * met.overlap) * (0.5 + 0.25 * (part * part))


@helper
def pushed(contact, i, j, met, pressed):
    """The force of a pair that is ``pressed`` with so many N, N: with that by which its energy fades along
    the face."""
    return add(scale(met.out, pressed), scale(met.fading, energy(contact, i, j, met)))


@helper
def pressing(contact, i, j, pair, met):
    """f_ij, N."""
    part = met.overlap / contact.spacing * (1.0 / HARDENING)
    push = modulus(contact, i, j) * met.overlap * (1.0 + part * part)
    apart = contact.damping * dashpot(contact, i, j) * dot(pair.u_ij, met.out)
    return met.share * max(push - apart * min(part * FIRM, 1.0), 0.0)


class Touching(NamedTuple):
    """The faces of two solids, or of a solid and a wall, repel each other where they overlap.

    The form of :class:`SolidContact` in a scene: ``stiffness`` s dx^(d−2), ``damping`` ζ, ``friction`` μ,
    ``spacing`` dx in m, the ``part`` of a pair in the sum over a face, and the longest ``step`` in s.
    """

    writes = CONTACT_ENERGY

    stiffness: float
    damping: float
    friction: float
    spacing: float
    part: float
    step: float

    def push(self, i, j, pair):
        """The push of a neighbour, m/s²."""
        met = meeting(self, i, j, pair)
        return scale(pushed(self, i, j, met, pressing(self, i, j, pair, met)), 1.0 / i.mass)

    def start(self, i):
        """No energy yet."""
        return 0.0

    def gather(self, total, i, j, pair):
        """With the particle's half of the pair's energy."""
        met = meeting(self, i, j, pair)
        return total + 0.5 * met.share * energy(self, i, j, met)

    def finish_value(self, total, i, kernel):
        """The energy of its contacts, J."""
        return total

    def longest_step(self, scene):
        """Δt ≤ 0.6 √(m/k)/(1 + ζ), s, of the stiffest contact and its lighter particle."""
        return self.step


class Rubbing(NamedTuple):
    """The faces of two solids, or of a solid and a wall, push and rub each other where they overlap.

    :class:`Touching`, with friction.
    """

    writes = CONTACT_ENERGY

    stiffness: float
    damping: float
    friction: float
    spacing: float
    part: float
    step: float

    def push(self, i, j, pair):
        """The push and the friction of a neighbour, m/s²."""
        met = meeting(self, i, j, pair)
        pressed = pressing(self, i, j, pair, met)
        slip = subtract(pair.u_ij, scale(met.out, dot(pair.u_ij, met.out)))
        speed = np.sqrt(dot(slip, slip)) + AT_REST
        held = met.share * dashpot(self, i, j)
        rubbed = min(self.friction * pressed / speed, held)
        return scale(subtract(pushed(self, i, j, met, pressed), scale(slip, rubbed)), 1.0 / i.mass)

    start = Touching.start
    gather = Touching.gather
    finish_value = Touching.finish_value
    longest_step = Touching.longest_step
