"""Walls along which what resists shear slides: they bear its stress across their face, and none along it."""

from typing import NamedTuple

from psph.acts import SOILS, UPDATED
from psph.engine.jit import call_by_type
from psph.fields import VECTOR, Field, Turned
from psph.formula import helper, where
from psph.physics.facts import Facts
from psph.physics.motion import is_rigid
from psph.vectors import add, dot, scale, times

NORMAL = Field(
    "face_normal",
    "1",
    "unit vector across the nearest face of a wall without friction, beside what resists shear; else 0",
    VECTOR,
    image=Turned,
)
DRAWN = Field("drawn_normal", "1", "the same at time zero, of a wall that moves as a whole", VECTOR)

OF_FACES = (NORMAL, DRAWN)

STEEPEST = 3.0
"""Most by which the stress of a wall without slip may exceed that of the soil before it: of a layer one row
thick the weight on the first row of the wall over that on its own."""


@helper
def steepness(i, j):
    """The pressure of i over that of j, and of j over that of i, from the tip of the cone of a soil on.

    In these proportions a wall shows a soil its stress: so friction is that at the face, not that half a
    spacing before it.
    """
    tip = i.cone_tip + j.cone_tip
    at_i, at_j = max(i.pressure, 0.0) + tip, max(j.pressure, 0.0) + tip
    return min(at_i / (at_j + NO_PRESSURE), STEEPEST), min(at_j / (at_i + NO_PRESSURE), STEEPEST)


NO_PRESSURE = 1e-30
"""Keeps no pressure from dividing by zero, Pa."""


@helper
def holds(j):
    """1 where neighbour j counts in a velocity gradient: it resists shear, or is a wall without slip."""
    return max(where(j.shear_modulus > 0.0, 1.0, 0.0), j.no_slip)


class Sticking(NamedTuple):
    """All walls beside what resists shear stick to it."""

    def across(self, j, u):
        """What counts of a velocity relative to a neighbour, m/s."""
        return scale(u, holds(j))

    def counts(self, j):
        """Whether a neighbour counts in a velocity gradient, 1 or 0."""
        return holds(j)


class Sliding(NamedTuple):
    """What resists shear slides along some walls: there its velocity across the face counts alone."""

    def across(self, j, u):
        """What counts of a velocity relative to a neighbour, m/s."""
        return add(scale(u, holds(j)), scale(j.face_normal, dot(j.face_normal, u)))

    def counts(self, j):
        """Whether a neighbour counts in a velocity gradient, 1 or 0."""
        return holds(j) + dot(j.face_normal, j.face_normal)


across, counts = call_by_type("across"), call_by_type("counts")
"""(faces, j, u) → m/s; (faces, j) → 1 or 0: see :class:`Sliding`."""


def is_smooth(one) -> bool:
    """Whether a species is a wall along which what resists shear slides."""
    return one.bearing and not one.is_fluid and not one.no_slip


def faces_of(scene: Facts):
    """How walls hold what resists shear: by the type of its answer the loops are compiled."""
    return Sliding() if any(map(is_smooth, scene.species)) else Sticking()


@helper
def mirrored(normal, s, x):
    """R s R x with R = 1 − 2nnᵀ: a stress without its shear along the face, in the mean with itself."""
    turned = times(s, add(x, scale(normal, -2.0 * dot(normal, x))))
    return add(turned, scale(normal, -2.0 * dot(normal, turned)))


class SmoothFace(NamedTuple):
    """A wall without friction bears the stress across its face of what resists shear, and none along it.

    Beside :class:`psph.physics.stress.deviator.DeviatoricForce`, a_i += Σ_w m_w R_w s_i R_w/ρ_i² ∇W_iw of
    walls that do not stick, in proportion to the pressure (:func:`steepness`), and the reaction on them.
    R_w = 1 − 2nnᵀ with the normal n of the drawn face before w, as it has turned: the image of a stress in a
    plane along which nothing rubs, as Libersky et al. (1993), J. Comput. Phys. 109, 67, have it in mirrors.
    Behind a corner any of its faces serves where they are at right angles: the shear in the frame of both is
    what is left out.  ``turns`` where such a wall moves.
    """

    acts = (SOILS, UPDATED)

    turns: bool = False

    def in_scene(self, scene: Facts):
        """With corrected gradients, the form that has them; None where no wall is smooth."""
        if isinstance(faces_of(scene), Sticking):
            return None
        turns = any(is_smooth(one) and is_rigid(one.motion) for one in scene.species)
        return (SmoothFace if scene.physics.gradient_correction is None else CorrectedSmoothFace)(turns)

    @property
    def drawn(self) -> tuple[Field, ...]:
        """The fields that come from the shapes of the case."""
        return OF_FACES if self.turns else OF_FACES[:1]

    def why_absent(self, scene: Facts):
        """What it lacks."""
        return "nothing slides along a wall that has particles"

    def push(self, i, j, pair):
        """Acceleration, m/s²."""
        n, at_i, at_j = faced(i, j)
        both = add(scale(i.deviator, at_i), scale(j.deviator, at_j))
        return scale(mirrored(n, both, pair.x_ij), pair.m_dw_r)


class CorrectedSmoothFace(NamedTuple):
    """A wall without friction bears the stress across its face of what resists shear, and none along it.

    As :class:`SmoothFace`, with the corrected gradients of
    :class:`psph.physics.stress.deviator.CorrectedDeviatoricForce`.
    """

    turns: bool = False

    drawn = SmoothFace.drawn

    def push(self, i, j, pair):
        """Acceleration, m/s²."""
        n, at_i, at_j = faced(i, j)
        x = pair.x_ij
        own = mirrored(n, i.deviator, add(x, times(i.gradient_correction, x)))
        other = mirrored(n, j.deviator, add(x, times(j.gradient_correction, x)))
        return scale(add(scale(own, at_i), scale(other, at_j)), pair.m_dw_r)


@helper
def faced(i, j):
    """The normal of the face between i and j, and the factors of s_i and s_j, m⁶/kg²; 0 without a face."""
    n = add(i.face_normal, j.face_normal)
    face = dot(n, n)
    steep_i, steep_j = steepness(i, j)
    own, other = i.specific_volume * i.specific_volume, j.specific_volume * j.specific_volume
    return n, own * (face * steep_j), other * (face * steep_i)
