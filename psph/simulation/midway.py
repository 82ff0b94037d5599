"""A step with the rate of density at its middle: a leapfrog that takes two passes over the pairs.

    v½ = v + Δt/2 a,  x½ = x + Δt/2 v½                        kick, half a drift
    ρ̇ from x½, v½, ρ                                           pass
    ρ ← ρ + Δt ρ̇,  x ← x½ + Δt/2 v½,  v̂ = v½ + ηΔt a         drift
    a from x, v̂, ρ, p(ρ + εΔt ρ̇)                               pass
    v = v½ + Δt/2 a                                            kick

Density and velocity leap over each other, so sound neither grows nor decays for ωΔt < 2, where a step of one
pass (psph.simulation.integrator) is stable to 0.78.  With a ``lead`` ε the pressure is that of the density ε
steps later: sound loses ½ε(ωΔt)² of its amplitude a step, as by a bulk viscosity εc²Δt, which what keeps its
density does not feel, for no sum more; stable for (1 + 2ε)(ωΔt)² < 4.  Friction reads v̂: with η = ½ it is of
second order in time, by extrapolation, and stable for γΔt < 1; with η = 0, beside a free surface, where sound
is fastest, of first order and stable for γΔt < 2.  What moves all as one, or turns, keeps its density: x½ is
the middle of the chord from x to the new x, and v½ its length over Δt.  What moves as a whole goes along
chords too; walls that deform stand where their motion has them.  A shift beside the velocity is halved as the
drift is.  docs/theory.md derives it, tests/simulation/test_midway.py measures it.
"""

import math
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from psph.composition.pair import take
from psph.composition.terms import displacement, limit_density, limit_wall_density
from psph.engine.jit import elementwise, inside
from psph.fields import DENSITY_RATE_1, DENSITY_RATE_2, VECTOR, Field, filled
from psph.moments import fastest_wave
from psph.simulation.carried import carry, store_apparent_force
from psph.simulation.rules import borne
from psph.vectors import add, at, put, scale

HISTORY = (DENSITY_RATE_1, DENSITY_RATE_2)
"""What a step of one pass keeps of earlier ones, and this one does not."""

COMING = Field("coming", "m", "way from the middle of the step to its end", VECTOR)
"""What is left to go is known there: lists are kept by it (psph.parallel.arrivals)."""

FASTEST = 1.16
"""ωΔt of the fastest sound on the lattice in a step with a lead, at the most.  The default scheme has 1.12 in
2D and 1.15 in 3D where one fluid fills the domain: longer steps cost vortices accuracy."""

AT_A_SURFACE = 1.075
"""Steps are so many times longer beside a free surface, where friction reads v½.  There corrected gradients
make sound a quarter faster than inside, and still water boils at 1.18: tests/theory/test_surface_steps.py."""


class Ahead(NamedTuple):
    """By which part of a step what forces read is ahead: ``pressure`` of the density, ``velocity`` of the
    middle of the step."""

    pressure: float = 0.0
    velocity: float = 0.5


WORTH = 1.6
"""A step of two passes takes so many times as long as one of one pass."""


def is_midway(scene, effects, kinds, extremes) -> bool:
    """Whether the steps of a scene take their rate of density at the middle.

    Where ``time.passes`` asks for two, all kinds of matter bear it, and none of the ``effects`` evolves a
    field of its own, whose rate would have to be taken there too; by itself only where that pays.
    """
    return not why_one_pass(scene, tuple(effects), kinds, extremes)


def why_one_pass(scene, effects: tuple, kinds, extremes) -> str:
    """Why steps take one pass, in words; empty where they take two."""
    passes = scene.case.time.passes
    if passes == 1:
        return "time.passes = 1"
    if one := next((kind.name for kind in kinds if not kind.bears_midway), ""):
        return f"beside {one} there is no other way"
    if one := next(
        (type(effect).__name__ for effect in effects if any(f.evolves for f in filled(effect))), ""
    ):
        return f"{one} evolves a field in time"
    return "" if passes == 2 else _why_it_does_not_pay(scene, effects, extremes)


def cfl_of(scene, passes: int) -> float:
    """The longest step of so many ``passes`` over h/(c + max|v|): ``time.cfl`` for each, of two with a lead
    no longer than the fastest sound bears, and longer beside a free surface."""
    cfl = scene.case.time.cfl * passes
    if passes == 1:
        return cfl
    longer = AT_A_SURFACE if scene.has_free_surface else 1.0
    if scene.case.time.lead:
        fastest = fastest_wave(scene.kernel, scene.spacing, scene.dimensions)
        cfl = min(cfl, FASTEST / (scene.smoothing_length * fastest))
    return longer * cfl


def ahead_of(scene) -> Ahead:
    """What forces read ahead of time in a scene whose steps take two passes."""
    return Ahead(scene.case.time.lead, 0.0 if scene.has_free_surface else 0.5)


def _why_it_does_not_pay(scene, effects: tuple, extremes) -> str:
    """Why steps of two passes are not so much longer that they cost less; empty where they are.

    Held rates of friction (psph.simulation.paces) shorten them, so these go with one pass.
    """
    one, two = (_longest(scene, effects, extremes, passes) for passes in (1, 2))
    fixed = scene.case.time.step
    if scene.case.time.damping_every > 1:
        return "friction is summed in some steps alone (time.damping_every)"
    if fixed and fixed <= one:
        return "time.step is no longer than one bears"
    if not fixed and two <= WORTH * one:
        return f"with two a step is {two / one:.2g} times as long, since friction limits it"
    return ""


def _longest(scene, effects: tuple, extremes, passes: int) -> float:
    """The longest step of so many ``passes`` that sound and the ``effects`` allow at rest, s."""
    limited = [effect for effect in effects if hasattr(effect, "longest_step")]
    frictions = [effect.longest_step(extremes) for effect in limited if pushes(effect)]
    limits = [room(effect, passes) * effect.longest_step(extremes) for effect in limited]
    limits += [together(frictions)] * (passes == 2)
    return min(cfl_of(scene, passes) * scene.smoothing_length / extremes.sound_speed, *limits)


FORCES = ("radial", "shear", "push", "body", "finish_acceleration")
"""Methods of effects that push."""


def pushes(effect) -> bool:
    """Whether an effect changes velocities: one with a limit of the time step then is a friction."""
    return any(hasattr(effect, name) for name in FORCES)


def room(effect, passes: int) -> float:
    """By how much the limit of an effect is longer in a step of so many ``passes`` than in one of one.

    In two passes 3 for what changes the density alone at a rate λ, as diffusion does: predicted from its
    history it is stable for λΔt < 1/3, here for λΔt < 2 − (ωΔt)²/2 beside sound of the frequency ω, that is
    0.96 at the largest ωΔt = 1.44; else 1.
    """
    return 3.0 if passes == 2 and hasattr(effect, "density_rate") and not pushes(effect) else 1.0


def together(limits: Iterable[float]) -> float:
    """The limit of the step, s, of frictions with these ``limits`` at once: decays add, 1/Δt = Σ 1/Δt_i.

    In steps of one pass sound keeps the damping of disorder at a third of its limit, which the margin of
    another friction bears; twice as much it does not.
    """
    rates = sum(1.0 / limit for limit in limits)
    return 1.0 / rates if rates > 0.0 else math.inf


@inside
def half_a_move(rules, i, v, dt):
    """What particle ``i`` with velocity ``v`` goes in half of a step, m, shifts included."""
    return add(scale(v, 0.5 * dt), displacement(rules.effects, i, 0.5 * dt))


@elementwise
def kick_to_middle(first, last, time, dt, rules, view, columns):
    """Kick by half a step and drift to the middle of it, ``time``.

    Columns ``first`` to ``last`` of ``columns``, which ``view`` shows as formulas see them; ``rules`` say
    how the particles of each group move: what is rigid by its poses at the middle.
    """
    c = columns
    for k in range(np.uint64(first), np.uint64(last)):
        i, group = take(view, k), c.group[k]
        if group < rules.free:
            v = add(at(c.velocity, k), scale(at(c.acceleration, k), 0.5 * dt))
            put(c.velocity, k, v)
            put(c.predicted_velocity, k, v)
            put(c.position, k, add(at(c.position, k), half_a_move(rules, i, v, dt)))
        else:
            carry(rules, group, k, time, c)
        # Behind the branch, with no shift of a wall in it: in both branches it took three times as long.
        put(c.coming, k, half_a_move(rules, i, at(c.velocity, k), dt))


@elementwise
def drift_to_end(first, last, time, dt, rules, view, columns):
    """Drift to ``time``, the end of the step, with the density there, and predict what friction reads."""
    c, kept = columns, 1.0 if rules.ahead.velocity == 0.0 else 0.0
    for k in range(np.uint64(first), np.uint64(last)):
        i, group = take(view, k), c.group[k]
        before = at(c.predicted_velocity, k)
        rate = dt * c.density_rate[k]
        rho = c.density[k] + rate
        ahead = rho + rules.ahead.pressure * rate
        if group < rules.free:
            v = at(c.velocity, k)
            put(c.predicted_velocity, k, add(v, scale(at(c.acceleration, k), rules.ahead.velocity * dt)))
            put(c.position, k, add(at(c.position, k), half_a_move(rules, i, v, dt)))
            rho, ahead = limit_density(rules.effects, i, rho), limit_density(rules.effects, i, ahead)
        else:
            rho, ahead = (
                limit_wall_density(rules.effects, i, rho),
                limit_wall_density(rules.effects, i, ahead),
            )
            carry(rules, group, k, time, c)
        # What moves as it is told shows friction its velocity of the same time as a fluid does: what falls
        # with that is not braked by it.  Behind the branch, as above.
        now = at(c.predicted_velocity, k)
        put(c.predicted_velocity, k, add(scale(before, kept), scale(now, 1.0 - kept)))
        store_apparent_force(rules, group, k, time, dt, c)
        c.density[k] = rho
        c.specific_volume[k] = 1.0 / rho
        c.pressure[k] = borne(rules, i, group, ahead)
