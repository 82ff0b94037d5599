"""Walls along which what resists shear slides: they bear its stress across their face, and none along it."""

from typing import Any, NamedTuple

from psph.acts import SOILS, UPDATED
from psph.engine.jit import call_by_type
from psph.fields import VECTOR, Field, Same, Turned
from psph.formula import helper, where
from psph.physics.facts import Facts
from psph.physics.motion import drift, is_rigid
from psph.vectors import add, along, dot, scale, subtract, times

NORMAL = Field(
    "face_normal",
    "1",
    "unit vector across the nearest face of a wall without friction, beside what resists shear, or the mean "
    "of two as near; along an edge of others; else 0",
    VECTOR,
    image=Turned,
)
SIDE = Field(
    "face_side", "1", "half the difference of the unit vectors of two faces as near", VECTOR, image=Turned
)
EDGE = Field(
    "face_edge", "1", "1 behind a hollow edge or corner of faces, −1 behind a round one; else 0", image=Same
)
DRAWN = Field("drawn_normal", "1", "face_normal at time zero, of a wall that moves as a whole", VECTOR)
DRAWN_SIDE = Field("drawn_side", "1", "face_side at time zero, of a wall that moves as a whole", VECTOR)

STILL_FACES, TURNING_FACES = (NORMAL, SIDE, EDGE), (DRAWN, DRAWN_SIDE)
"""What all such walls carry, and what those that move do besides."""

STEEPEST = 3.0
"""Most by which the stress of a wall without slip may exceed that of the soil before it: of a layer one row
thick the weight on the first row of the wall over that on its own."""


class StillColumn(NamedTuple):
    """A wall's pressure beside soil is what it has, within bounds by the weight of a still column.

    ``gravity`` in m/s², None on an axis without.  Down a column at rest it grows by (1 + 2K₀)/3 of the
    weight, as the mean stress does; it may by TWICE of it.  Without these bounds a wall shows a grain that
    rises, whose pressure falls, more of its stress, which lifts it further: rows on a floor with friction
    came loose at rest.
    """

    gravity: tuple[float | None, ...] = ()

    def grown(self, at_i, at_j, i, j, pair):
        """That of i over that of j, and of j over that of i."""
        deeper, own = along(pair.x_ij, self.gravity), grown(OwnPressure(), at_i, at_j, i, j, pair)
        by_j, by_i = deeper / (at_j + NO_PRESSURE), -deeper / (at_i + NO_PRESSURE)
        return within_column(own[0], j, by_j), within_column(own[1], i, by_i)


class OwnPressure(NamedTuple):
    """A wall's pressure is what it has: what moves may press on soil beyond any weight, as may a frame."""

    def grown(self, at_i, at_j, i, j, pair):
        """That of i over that of j, and of j over that of i."""
        return at_i / (at_j + NO_PRESSURE), at_j / (at_i + NO_PRESSURE)


class BesideBodies(NamedTuple):
    """That of a body is what it has, and that of a wall is as :class:`StillColumn` has it."""

    still: StillColumn

    def grown(self, at_i, at_j, i, j, pair):
        """That of i over that of j, and of j over that of i."""
        column, own = grown(self.still, at_i, at_j, i, j, pair), grown(OwnPressure(), at_i, at_j, i, j, pair)
        of_body = max(i.solid, j.solid) > WALLS
        return where(of_body, own[0], column[0]), where(of_body, own[1], column[1])


WALLS = 1.0
"""The number of all walls among solids."""

grown = call_by_type("grown")
"""(column, at_i, at_j, i, j, pair) → the ratios of pressures ``at_i`` and ``at_j``, Pa above a cone's tip."""


@helper
def within_column(ratio, j, deeper):
    """A ``ratio`` of pressures to that of soil j, within that at rest and that of TWICE its weight.

    ``deeper`` is (x − x_j)·g over its pressure, m³/kg.
    """
    weight = j.rest_density * deeper
    at_rest = (1.0 + 2.0 * j.rest_coefficient) / 3.0 * weight
    return 1.0 + min(max(ratio - 1.0, min(at_rest, TWICE * weight)), max(at_rest, TWICE * weight))


def column_of(scene: Facts):
    """How the pressure of walls is told: by the type of its answer the loops are compiled.

    Where all walls drift alike the scene is as where they rest.
    """
    drifts = {drift(one.motion) for one in scene.species if one.solid == WALLS}
    if scene.frame or None in drifts or len(drifts) > 1:
        return OwnPressure()
    still = StillColumn(tuple(g or None for g in scene.gravity))
    return BesideBodies(still) if any(one.solid > WALLS for one in scene.species) else still


@helper
def steepness(column, i, j, pair):
    """The pressure of i over that of j, and of j over that of i, from the tip of the cone of a soil on.

    In these proportions a wall shows a soil its stress: so friction is that at the face, not that half a
    spacing before it.
    """
    tip = i.cone_tip + j.cone_tip
    at_i, at_j = max(i.pressure, 0.0) + tip, max(j.pressure, 0.0) + tip
    of_i, of_j = grown(column, at_i, at_j, i, j, pair)
    return min(max(of_i, 0.0), STEEPEST), min(max(of_j, 0.0), STEEPEST)


TWICE = 2.0
"""Most of the weight of a still column by which a pressure grows in it: soil that slides is at about all."""

NO_PRESSURE = 1e-30
"""Keeps no pressure from dividing by zero, Pa."""

NO_LENGTH = 1e-30
"""The same for a normal without length."""


@helper
def holds(j):
    """1 where neighbour j counts in a velocity gradient: it resists shear, or is a wall without slip."""
    return max(where(j.shear_modulus > 0.0, 1.0, 0.0), j.no_slip)


@helper
def facing(normal, side, edge, pair):
    """The unit normal of the face between two particles; 0 without one.

    Of two faces as near it is that on whose side the particle before them is, and fades to 0 where that is as
    far to either side.  A round edge has the normal towards that particle.
    """
    x, turned = pair.x_ij, max(min(2.0 * dot(side, pair.x_ij) * pair.inverse_r, 1.0), -1.0)
    two, off = dot(side, side) > 0.0, where(edge < 0.0, -dot(normal, x) * pair.inverse_r, 1.0)
    first = scale(normal, where(two, max(turned, -turned), off))
    return add(add(first, scale(side, turned)), scale(x, max(-edge, 0.0) * pair.inverse_r))


@helper
def behind(n, edge):
    """How far what bears ``n`` counts, 0 to 1: all of a face or a hollow."""
    return max(dot(n, n), edge)


class Sticking(NamedTuple):
    """All walls beside what resists shear stick to it."""

    def across(self, j, pair):
        """What counts of the velocity relative to a neighbour, m/s."""
        return scale(pair.u_ij, holds(j))

    def counts(self, j, pair):
        """How far a neighbour counts in a velocity gradient, 0 to 1."""
        return holds(j)


class Sliding(NamedTuple):
    """What resists shear slides along some walls: there its velocity across the face counts alone, and in a
    hollow all but that along the edge."""

    def across(self, j, pair):
        """What counts of the velocity relative to a neighbour, m/s."""
        hollow, n = max(j.face_edge, 0.0), facing(j.face_normal, j.face_side, j.face_edge, pair)
        along = dot(n, pair.u_ij) * (1.0 - 2.0 * hollow)
        return add(scale(pair.u_ij, holds(j) + hollow), scale(n, along))

    def counts(self, j, pair):
        """How far a neighbour counts in a velocity gradient, 0 to 1."""
        return holds(j) + behind(facing(j.face_normal, j.face_side, j.face_edge, pair), j.face_edge)


across, counts = call_by_type("across"), call_by_type("counts")
"""(faces, j, pair) → m/s, and 0 to 1: see :class:`Sliding`."""


def is_smooth(one) -> bool:
    """Whether a species is a wall along which what resists shear slides."""
    return one.bearing and not one.is_fluid and not one.no_slip


def faces_of(scene: Facts):
    """How walls hold what resists shear: by the type of its answer the loops are compiled."""
    return Sliding() if any(map(is_smooth, scene.species)) else Sticking()


@helper
def mirrored(normal, twice, s, x):
    """R s R x with R = 1 − 2nnᵀ/n²: a stress without its shear along the face, in the mean with itself.
    ``twice`` is 2/n²."""
    turned = times(s, add(x, scale(normal, -twice * dot(normal, x))))
    return add(turned, scale(normal, -twice * dot(normal, turned)))


class SmoothFace(NamedTuple):
    """A wall without friction bears the stress across its face of what resists shear, and none along it.

    Beside :class:`psph.physics.stress.deviator.DeviatoricForce`, a_i += Σ_w m_w R_w s_i R_w/ρ_i² ∇W_iw of
    walls that do not stick, in proportion to the pressure (:func:`steepness`), and the reaction on them.
    R_w = 1 − 2nnᵀ with the normal n of the drawn face before w, as it has turned: the image of a stress in a
    plane along which nothing rubs, as Libersky et al. (1993), J. Comput. Phys. 109, 67, have it in mirrors.
    Of several faces as near none is chosen (:func:`facing`); in a hollow s_i counts whole, but for its shear
    along the edge: across the faces it has none.  All turns as the scene does.  ``turns``: such a wall moves.
    """

    acts = (SOILS, UPDATED)

    turns: bool = False
    column: Any = OwnPressure()

    def in_scene(self, scene: Facts):
        """With corrected gradients, the form that has them; None where no wall is smooth."""
        if isinstance(faces_of(scene), Sticking):
            return None
        turns = any(is_smooth(one) and is_rigid(one.motion) for one in scene.species)
        return (SmoothFace if scene.physics.gradient_correction is None else CorrectedSmoothFace)(
            turns, column_of(scene)
        )

    @property
    def drawn(self) -> tuple[Field, ...]:
        """The fields that come from the shapes of the case."""
        return STILL_FACES + TURNING_FACES if self.turns else STILL_FACES

    def why_absent(self, scene: Facts):
        """What it lacks."""
        return "nothing slides along a wall that has particles"

    def push(self, i, j, pair):
        """Acceleration, m/s²."""
        n, twice, at_i, at_j = faced(self.column, i, j, pair)
        both = add(scale(i.deviator, at_i), scale(j.deviator, at_j))
        return scale(mirrored(n, twice, both, pair.x_ij), pair.m_dw_r)


class CorrectedSmoothFace(NamedTuple):
    """A wall without friction bears the stress across its face of what resists shear, and none along it.

    As :class:`SmoothFace`, with the corrected gradients of
    :class:`psph.physics.stress.deviator.CorrectedDeviatoricForce`.
    """

    turns: bool = False
    column: Any = OwnPressure()

    drawn = SmoothFace.drawn

    def push(self, i, j, pair):
        """Acceleration, m/s²."""
        n, twice, at_i, at_j = faced(self.column, i, j, pair)
        x = pair.x_ij
        own = mirrored(n, twice, i.deviator, add(x, times(i.gradient_correction, x)))
        other = mirrored(n, twice, j.deviator, add(x, times(j.gradient_correction, x)))
        return scale(add(scale(own, at_i), scale(other, at_j)), pair.m_dw_r)


@helper
def faced(column, i, j, pair):
    """The normal n of the face between i and j, 2/n², the factors of s_i and s_j, m⁶/kg²; 0 without one."""
    edge, normal = i.face_edge + j.face_edge, subtract(j.face_normal, i.face_normal)
    n = facing(normal, subtract(j.face_side, i.face_side), edge, pair)
    face, (steep_i, steep_j) = behind(n, edge), steepness(column, i, j, pair)
    own, other = i.specific_volume * i.specific_volume, j.specific_volume * j.specific_volume
    return n, 2.0 / max(dot(n, n), NO_LENGTH), own * (face * steep_j), other * (face * steep_i)
