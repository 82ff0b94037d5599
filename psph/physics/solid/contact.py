"""Contact of elastic solids with each other and with walls, along the normals of the faces that are drawn."""

import math
from itertools import product
from typing import Annotated, NamedTuple

import numpy as np
from pydantic import Field as Key

from psph.acts import BODIES, SOLIDS, UPDATED
from psph.fields import VECTOR, WALL, Field
from psph.formula import helper, long_helper, where
from psph.physics.facts import Facts
from psph.vectors import add, dot, scale, subtract, zero_like

CONTACT_ENERGY = Field("contact_energy", "J", "energy of a particle's contacts with other solids")

FACE = Field(
    "face", "1", "normal of the face nearest to a particle of a solid or a wall, zeros at an edge", VECTOR
)
COVER = Field("cover", "1", "how far below that face the particle was drawn, in spacings")
TURNING = Field("turning", "J", "−∂/∂N of the energy of its contacts, N the normal of its face", VECTOR)

OF_CONTACT = (FACE, COVER)
"""What particles carry where elastic solids meet."""

MET = Field("met", "m/s2", "acceleration by contacts with elastic solids in a fluid", VECTOR)

FACE_RATE = Field("face_rate", "1/s", "rate of the normal of the face", VECTOR)
SLIP = Field("contact_slip", "m", "by how much the contacts of a particle are sheared", VECTOR)
SLIDING = Field("sliding", "N/s", "Σ k u_t of its contacts: how fast what it touches slides", VECTOR)
HOLD = Field("hold", "N/m", "Σ k of its contacts")
BORNE = Field("borne", "N", "Σ f of its contacts: what they press")

OF_FRICTION = (FACE_RATE, SLIP)
"""What they carry beside where contacts rub."""

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

STEP = 0.4
"""Δt ≤ 0.4 √(m/k): ωΔt = 0.57 of two like particles whose faces touch, and 1.5 where these overlap by 0.7
spacings; 2 is the limit.  A touch begins within a step: by that, energy is wrong by a part of (ωΔt)²."""

CALMING = 0.5
"""Over critical damping: that of what sticks.  The slip lags half a step, which feeds it by 0.2."""

NO_FORCE = 1e-300
"""N."""

NO_WAY = 1e-12
"""Of a direction, below which it is none."""


class SolidContact(NamedTuple):
    """The faces of two solids, or of a solid and a wall or a rigid body, repel each other where they overlap.

    A particle has the normal N of the face drawn nearest to it, as it is now (psph.simulation.solid_faces),
    and its depth s below that at the start; at edges it has no N.  A pair pushes along n, the
    direction of N_j − N_i, or, where neither has a face, of x_ij, with the overlap δ = s_i + s_j − x_ij·n
    of the faces: p = E δ/dx (1 + (δ/½dx)²), which has no bound.  E = s 2M_iM_j/(M_i + M_j) with the
    ``stiffness`` s and the P-wave moduli M = λ + 2μ (of what is rigid, the largest of all solids): that of
    the two half rows of matter before the faces, so that a contact is no softer than the solid.  The share
    of a pair in the pressure on a face is b_ib_j (1 − t²/(1.5dx)²)², b = 1.5 − s/dx, with t its distance
    along the face.  The energy of a pair depends on x_ij, N_i and N_j, and these on the places around i and
    j, or on how a body is turned: the push is −∂/∂x of it, the stress has −∂/∂N of it, and so has the moment
    of a body, so that energy and both momenta are kept.  A plane face at any angle to the lattice pushes
    along its normal.  ``damping`` ζ: less 2ζ√(k m) u_ij·n, but no pull, m = m_im_j/(m_i + m_j).  ``friction``
    is Coulomb's: a spring as stiff as the contact, sheared by the slip, with a dashpot, whose force ends at
    μ f_ij; so solids stick, and slide.
    Penalties: Belytschko & Neal (1991), Int. J. Numer. Methods Eng. 31, 547; in SPH Campbell, Vignjevic &
    Libersky (2000), Comput. Methods Appl. Mech. Eng. 184, 49; by normals of surfaces Vignjevic, De Vuyst &
    Campbell (2006), CMES 13, 35.
    """

    acts = (SOLIDS, BODIES)
    shares_key = True
    refuses = {
        UPDATED: 'updated Lagrangian solids feel each other without; remove it, or give description = "total"'
    }
    keys_of = {
        "stiffness": (SOLIDS, "rigid bodies do not give way; remove this key"),
        "damping": (SOLIDS, "rigid bodies meet by impulses; remove this key, or give restitution"),
        "restitution": (BODIES, "elastic solids swing back by themselves; remove this key, or give damping"),
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
        elastic = [one for one in scene.species if one.bonded is not None]
        pairs = [(i, j) for i, j in product(elastic, scene.species) if i.solid != j.solid]
        if not pairs:
            return None
        kind = Rubbing if self.friction else Touching
        dx, d = scene.spacing, scene.dimensions
        shape = self.stiffness * dx ** (d - 2), self.damping, self.friction, dx, 1.0 / SHARES[d - 1]
        made = kind(*shape, 0.0)
        stiffest = max(modulus(made, i, j) for i, j in pairs)
        hardest = max(modulus(made, i, j) / min(i.inertia, j.inertia) for i, j in pairs)
        # Of a particle and a body ω² is k/m + kλ at most, and 2k/m of two like particles.
        hardest = max(hardest, 0.5 * (hardest + stiffest * scene.answer(self.friction > 0.0)))
        return made._replace(step=STEP / (math.sqrt(hardest) * (1.0 + self.damping)))

    def why_absent(self, scene: Facts):
        """That nothing can meet, or nothing elastic."""
        if any(one.solid > WALL and one.bonded is None for one in scene.species):
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
    """How a pair meets: the unit vector ``out`` of j towards i; how far they are ``apart`` along it in m, and
    the rest of x_ij ``beside`` it, m; the ``overlap`` δ in m of their faces; the ``share`` S of the pair.

    What S changes by: ``sink`` ∂S/∂(x_ij·n) in 1/m, ``fade`` −∂S/∂t/t and ``rim`` −∂S/∂r/r in 1/m², ``lean``
    −∂S/∂(N_i·N_j).  ``turn`` is 1/|N_j − N_i|: by how much n turns with the normals.
    """

    out: tuple
    apart: float
    beside: tuple
    overlap: float
    share: float
    sink: float
    fade: float
    rim: float
    lean: float
    turn: float


@helper
def bearing(contact, i):
    """b of a particle: 1 in the first row below a face, 0 in the second."""
    return min(max(LAYER - i.cover, 0.0), 1.0)


@helper
def known(i):
    """1 where a particle has a face, 0 where not."""
    return min(dot(i.face, i.face), 1.0)  # but for rounding


@helper
def ramp(value):
    """``value`` within 0 and 1."""
    return min(max(value, 0.0), 1.0)


@helper
def ramps(value):
    """Its derivative: 1 between 0 and 1."""
    return where(value > 0.0, where(value < 1.0, 1.0, 0.0), 0.0)


@long_helper
def meeting(contact, i, j, pair):
    """Of particles of different solids; a share of 0 within one solid."""
    per = 1.0 / contact.spacing
    own, its = known(i), known(j)
    bare = (1.0 - own) * (1.0 - its)
    way = add(subtract(j.face, i.face), scale(pair.x_ij, bare * pair.inverse_r))
    turn = 1.0 / (np.sqrt(dot(way, way)) + NO_WAY)
    out = scale(way, turn)
    apart = dot(pair.x_ij, out)
    beside = subtract(pair.x_ij, scale(out, apart))
    steep = per * per / (ALONG * ALONG)
    layer = max(1.0 - max(pair.r2 - apart * apart, 0.0) * steep, 0.0)
    facing = 1.0 - own * its - dot(i.face, j.face)  # 0 from a right angle on
    # From far behind its face a particle is not met: there is the other face of what is thin.
    before = BEHIND + apart * per
    reached = 2.0 * (REACH - pair.r * per)
    other = j.solid - i.solid
    part = bearing(contact, i) * bearing(contact, j) * contact.part
    part = where(other * other > 0.0, part, 0.0)
    at_angle = part * ramp(before) * ramp(reached) * (layer * layer)
    faced = part * ramp(facing)
    share = at_angle * ramp(facing)
    overlap = max((i.cover + j.cover) * contact.spacing - apart, 0.0)
    return Meeting(
        out,
        apart,
        beside,
        overlap,
        share,
        faced * ramps(before) * per * ramp(reached) * (layer * layer),
        faced * ramp(before) * ramp(reached) * (4.0 * steep * layer),
        faced * ramp(before) * ramps(reached) * (2.0 * per) * pair.inverse_r * (layer * layer),
        at_angle * ramps(facing) * own * its,
        turn,
    )


@long_helper
def energy(contact, i, j, met):
    """The energy of a pair with a share of 1, J."""
    part = met.overlap / contact.spacing * (1.0 / HARDENING)
    return modulus(contact, i, j) * (met.overlap * met.overlap) * (0.5 + 0.25 * (part * part))


@long_helper
def pressing(contact, i, j, pair, met):
    """f_ij, N."""
    part = met.overlap / contact.spacing * (1.0 / HARDENING)
    push = modulus(contact, i, j) * met.overlap * (1.0 + part * part)
    apart = contact.damping * dashpot(contact, i, j) * dot(pair.u_ij, met.out)
    return met.share * max(push - apart * min(part * FIRM, 1.0), 0.0)


@long_helper
def pushed(contact, i, j, pair, met):
    """The force of a pair, N: with that by which its energy changes with its share."""
    stored = energy(contact, i, j, met)
    along = pressing(contact, i, j, pair, met) - met.sink * stored
    force = add(scale(met.out, along), scale(met.beside, met.fade * stored))
    return add(force, scale(pair.x_ij, met.rim * stored))


@long_helper
def turning(contact, i, j, pair, met):
    """What it does to N_i, J: −∂/∂N_i of the energy, and of the damped overlap alike."""
    stored = energy(contact, i, j, met)
    along = pressing(contact, i, j, pair, met) - met.sink * stored
    by_out = (along - met.apart * (met.fade * stored)) * met.turn
    return subtract(scale(j.face, met.lean * stored), scale(met.beside, by_out))


@helper
def arm(met):
    """How far before a particle, along its normal, friction acts, m: with those of both it has no moment."""
    return met.apart * met.turn


@helper
def slipping(i, j, pair, met):
    """The velocity along the face of i relative to j where they meet, m/s: none where all turns as one."""
    whole = add(pair.u_ij, scale(subtract(i.face_rate, j.face_rate), arm(met)))
    return subtract(whole, scale(met.out, dot(whole, met.out)))


@long_helper
def rubbing(contact, i, j, pair, met):
    """The friction of a pair, N: a spring that slips and a dashpot, μ f_ij at most."""
    slip = scale(subtract(i.contact_slip, j.contact_slip), 0.5)
    slip = subtract(slip, scale(met.out, dot(slip, met.out)))
    spring = scale(slip, met.share * modulus(contact, i, j))
    drag = scale(slipping(i, j, pair, met), met.share * CALMING * dashpot(contact, i, j))
    held = add(spring, drag)
    size = np.sqrt(dot(held, held)) + NO_FORCE
    return scale(held, -min(1.0, contact.friction * pressing(contact, i, j, pair, met) / size))


class Touching(NamedTuple):
    """The faces of two solids, or of a solid and what is rigid, repel each other where they overlap.

    The form of :class:`SolidContact` in a scene: ``stiffness`` s dx^(d−2), ``damping`` ζ, ``friction`` μ,
    ``spacing`` dx in m, the ``part`` of a pair in the sum over a face, and the longest ``step`` in s.
    """

    writes = (CONTACT_ENERGY, TURNING)
    written_in = True

    stiffness: float
    damping: float
    friction: float
    spacing: float
    part: float
    step: float

    def push(self, i, j, pair):
        """The push of a neighbour, m/s²."""
        met = meeting(self, i, j, pair)
        return scale(pushed(self, i, j, pair, met), 1.0 / i.mass)

    def start(self, i):
        """No energy yet, and nothing that turns."""
        return (0.0,) + zero_like(i.face)  # noqa: RUF005 - compiled code adds tuples

    def gather(self, total, i, j, pair):
        """With the particle's half of the pair's energy, and what turns its normal."""
        met = meeting(self, i, j, pair)
        half = 0.5 * met.share * energy(self, i, j, met)
        return add(total, (half,) + turning(self, i, j, pair, met))  # noqa: RUF005

    def finish_value(self, total, i, kernel):
        """The sums as they are."""
        return total

    def longest_step(self, scene):
        """Δt ≤ 0.4 √(m/k)/(1 + ζ), s, of the stiffest contact and its lighter particle."""
        return self.step


class Rubbing(NamedTuple):
    """The faces of two solids, or of a solid and what is rigid, push and rub each other where they overlap.

    :class:`Touching`, with friction.  Each particle carries the slip of its contacts (Cundall & Strack 1979,
    Géotechnique 29, 47, there of each pair): half the difference of those of a pair is the stretch of its
    spring.
    """

    writes = (CONTACT_ENERGY, TURNING, SLIDING, HOLD, BORNE)
    written_in = True

    stiffness: float
    damping: float
    friction: float
    spacing: float
    part: float
    step: float

    def push(self, i, j, pair):
        """The push and the friction of a neighbour, m/s²."""
        met = meeting(self, i, j, pair)
        force = add(pushed(self, i, j, pair, met), rubbing(self, i, j, pair, met))
        return scale(force, 1.0 / i.mass)

    def start(self, i):
        """Nothing yet: as for :class:`Touching`, then Σ k u_t in N/s, Σ k in N/m and Σ f in N."""
        return (0.0,) + zero_like(i.face) + zero_like(i.face) + (0.0, 0.0)  # noqa: RUF005

    def gather(self, total, i, j, pair):
        """With a neighbour."""
        met = meeting(self, i, j, pair)
        rubbed = scale(rubbing(self, i, j, pair, met), arm(met))
        stiff = met.share * modulus(self, i, j)
        slid = scale(slipping(i, j, pair, met), stiff)
        turned = add(turning(self, i, j, pair, met), rubbed)
        half = 0.5 * met.share * energy(self, i, j, met)
        pressed = pressing(self, i, j, pair, met)
        return add(total, (half,) + turned + slid + (stiff, pressed))  # noqa: RUF005

    finish_value = Touching.finish_value
    longest_step = Touching.longest_step
