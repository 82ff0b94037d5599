"""A force between neighbours that keeps their order and bears no pressure."""

import math
from itertools import product
from typing import Annotated, NamedTuple

import numpy as np
from pydantic import Field

from psph.acts import MADE_FOR_FLUIDS
from psph.engine.jit import call_by_type
from psph.formula import helper
from psph.physics.facts import SOUND_OVER_SPEED, Facts
from psph.physics.fluid.correction import DISORDER, ROUGH, half_disorder, needs_correction
from psph.vectors import excess, multiply, plus_less_last, scale

CORES = (1.6, 1.6, 1.3228)
"""Range of the repelling core in spacings, in 1D, 2D and 3D."""

RANGES = ((2.15,), (2.15,), (1.6116, 2.4496))
"""Ranges of the smooth parts in spacings."""

WEIGHTS = ((), (), (0.3207,))
"""Their weights against the core's, but for the last, which follows from the lattice.

Found by maximising the smallest eigenvalue of the potential's stiffness over all wave vectors and
the square and hexagonal, or the cubic, body-centred and face-centred lattice: none is negative."""

NEAR = 0.75
"""Distance in spacings at which the strength is told."""

AT_NEAR = (1.0, 1.0, 1.5)
"""What −ψ′ is there, over dx^-(d+1).

With 1.0 in 3D a rotating cube clumps: 5 % of its particles come nearer than 0.57 dx to another."""

SPATIAL = 3
"""Dimensions in which ``in_tension`` does nothing: a rotating cube would lose 8 % of its energy of motion by
it for 7."""

LOOSE = 0.004
"""Mean of p/ρ in a pair over (c/10)² from which on it counts as compressed.

Below it ``in_tension`` counts, the more the less there is, and all of it under tension, where a fluid
tears.  Were compressed pairs as strong, still water would move."""

Strength = Annotated[
    float,
    Field(ge=0, description="f: K over ρ₀U², U = c/10 the largest speed", json_schema_extra={"unit": "1"}),
]
"""Strength of a potential between pairs, as a case gives it."""


class NeutralPotential(NamedTuple):
    """Near neighbours repel, farther ones attract: pairs keep their distance, and no pressure is added.

    −ψ′/r of the lattice of a scene as (``core`` − ``steepness`` r)²₊/r + Σ_k ±(``heights`` − ``slopes``
    r²)²₊, the last with a minus; times 2K dx^d/ρ₀, 1/s².
    """

    core: float
    steepness: float
    heights: tuple[float, ...]
    slopes: tuple[float, ...]

    def radial(self, i, j, pair):
        """Coefficient of x_ij in the acceleration between particles of one mass, 1/s²."""
        return _repulsion(self, pair)


class LocalPotential(NamedTuple):
    """The pair potential where particles are in disorder or at a surface, and nowhere else.

    a_i = −(2K/ρ₀) dx^d Σ_j ½(g_i + g_j) ψ′(r) x_ij/r, −ψ′/r ∝ (1 − r/R)²₊/r + Σ_k w_k (1 − r²/R_k²)²₊,
    scaled to −ψ′ = dx^-(d+1) at r = ¾ dx, 1.5 times that in 3D; the last weight, negative, makes the virial
    Σ r ψ′ of the starting lattice zero: no mean pressure.  g = min(|L − 1|²/t², 1): L, which corrects
    gradients, is 1 where neighbours are in order all around.  psph's own.
    K = f ρ₀ (c/10)² is constant: a repulsion that follows the local pressure pumps energy (as the
    artificial stress of Monaghan 2000, J. Comput. Phys. 159, 290, does).  But in 2D, with a free surface, a
    pair that is not compressed has ``in_tension`` times as much of it, which falls to once while p_i/ρ_i +
    p_j/ρ_j rises from 0 to 0.008 (c/10)².  Between two masses the force is that between two of the smaller
    mass: the heavier one is moved less.  It costs a flow in good order nothing, keeps momentum and angular
    momentum, and is no potential: energy is not conserved by it.
    """

    refuses = MADE_FOR_FLUIDS

    conserves = ("momentum", "angular momentum")

    strength: Strength = 0.008
    threshold: Annotated[
        float,
        Field(
            gt=0,
            description="t: size of L − 1 from which on the whole force acts",
            json_schema_extra={"unit": "1"},
        ),
    ] = DISORDER
    in_tension: Annotated[
        float,
        Field(
            ge=1,
            description="how many times as strong where a pair is not compressed, in 2D with a surface",
            json_schema_extra={"unit": "1"},
        ),
    ] = 1.0

    def in_scene(self, scene: Facts):
        """The potential of the scene's lattice."""
        made = neutral_potential(self.strength, scene.sound_speed, scene.spacing, scene.dimensions)
        usual = self.threshold == DISORDER
        one = InDisorder(*made, UsualRoughness() if usual else OwnRoughness(0.5 / self.threshold**2))
        if self.in_tension == 1.0 or self.why_no_tension(scene):
            return one
        loose = 2.0 * LOOSE * (scene.sound_speed / SOUND_OVER_SPEED) ** 2
        return StrongerInTension(one, self.in_tension, (self.in_tension - 1.0) / loose)

    @staticmethod
    def why_no_tension(scene: Facts) -> str:
        """Why ``in_tension`` does nothing in a scene, in words; empty where it acts."""
        if scene.dimensions == SPATIAL:
            return "it acts in 2D alone"
        return "" if scene.has_free_surface else "the fluid has no free surface"

    @staticmethod
    def warns(scene: Facts):
        """A strength under tension that has no effect."""
        given = scene.physics.local_potential.in_tension
        if given != 1.0 and (why := LocalPotential.why_no_tension(scene)):
            yield f"in_tension = {given:g} has no effect here, since {why}; leave it out"

    @staticmethod
    def conflicts(physics, kernel):
        """Disorder is seen by the corrected gradients."""
        yield from needs_correction(physics)


class UsualRoughness(NamedTuple):
    """Disorder by the size of L − 1 that all other parts take: a pair works it out once for all."""

    def roughness(self, i, j):
        """½ min(|L − 1|²/t², 1) of both ends together."""
        return half_disorder(ROUGH, i) + half_disorder(ROUGH, j)


class OwnRoughness(NamedTuple):
    """Disorder by a size t of its own; ``half`` is 1/(2t²)."""

    half: float

    def roughness(self, i, j):
        """½ min(|L − 1|²/t², 1) of both ends together."""
        return half_disorder(self.half, i) + half_disorder(self.half, j)


_roughness = call_by_type("roughness")


class InDisorder(NamedTuple):
    """The pair potential where particles are in disorder or at a surface, and nowhere else.

    The form of :class:`LocalPotential` for the lattice of a scene; ``rough`` says what disorder is.
    """

    conserves = ("momentum", "angular momentum")
    held = True

    core: float
    steepness: float
    heights: tuple[float, ...]
    slopes: tuple[float, ...]
    rough: UsualRoughness | OwnRoughness

    def radial(self, i, j, pair):
        """Coefficient of x_ij in the acceleration, 1/s²."""
        return _in_disorder(self, i, j, pair)


class StrongerInTension(NamedTuple):
    """The pair potential in disorder, stronger where particles are not compressed.

    The form of :class:`LocalPotential` with ``in_tension`` k, not below 1: ``most`` − ``slope`` (p_i/ρ_i +
    p_j/ρ_j), between 1 and most, times ``ordinary``; most = k, slope in s²/m².
    """

    conserves = ("momentum", "angular momentum")
    held = True

    ordinary: InDisorder
    most: float
    slope: float

    def radial(self, i, j, pair):
        """Coefficient of x_ij in the acceleration, 1/s²."""
        own = self.most - self.slope * (i.pressure * i.specific_volume)
        other = self.slope * j.pressure * j.specific_volume
        times = min(max(own - other, 1.0), self.most)
        return _in_disorder(self.ordinary, i, j, pair) * times


@helper
def _in_disorder(potential, i, j, pair):
    """−ψ′/r of a pair in its disorder, 1/s²."""
    g = _roughness(potential.rough, i, j)
    return min(1.0, j.mass * (1.0 / i.mass)) * g * _repulsion(potential, pair)


@helper
def _repulsion(potential, pair):
    """−ψ′/r of a pair of one mass, 1/s²."""
    near = max(potential.core - pair.r * potential.steepness, 0.0)
    parts = excess(potential.heights, scale(potential.slopes, pair.r2))
    return plus_less_last(near * near * pair.inverse_r, multiply(parts, parts))


repulsion = _repulsion
"""The same for files of users.  psph's own loops name the other, and so stay as they are compiled."""


def neutral_potential(strength: float, sound_speed: float, dx: float, dimensions: int) -> NeutralPotential:
    """The potential whose virial vanishes on the row, square or cube lattice of spacing dx, m;
    ``strength`` f, ``sound_speed`` m/s."""
    core, ranges = CORES[dimensions - 1], np.array(RANGES[dimensions - 1])
    sites = (k for k in product(range(-3, 4), repeat=dimensions) if any(k))
    r2 = np.array([sum(n * n for n in k) for k in sites], float)
    forces = _forces_over_r(core, ranges, r2)
    virials = forces @ r2
    weights = np.array([1.0, *WEIGHTS[dimensions - 1]])
    weights = np.append(weights, -(weights @ virials[:-1]) / virials[-1])
    near = NEAR * float(weights @ _forces_over_r(core, ranges, np.array([NEAR**2]))[:, 0])
    weights *= 2.0 * strength * (sound_speed / SOUND_OVER_SPEED) ** 2
    weights *= AT_NEAR[dimensions - 1] / (near * dx**2)
    height = math.sqrt(float(weights[0]) * dx)
    heights = np.sqrt(np.abs(weights[1:]))  # the last is below zero, the others are not
    slopes = heights / (ranges * dx) ** 2
    return NeutralPotential(height, height / (core * dx), tuple(heights.tolist()), tuple(slopes.tolist()))


def _forces_over_r(core: float, ranges: np.ndarray, r2: np.ndarray) -> np.ndarray:
    """−ψ′/r of each part with weight one, (1 + parts, n); lengths in spacings."""
    r = np.sqrt(r2)
    smooth = np.maximum(1.0 - r2 / ranges[:, None] ** 2, 0.0) ** 2
    return np.concatenate([[np.maximum(1.0 - r / core, 0.0) ** 2 / r], smooth])
