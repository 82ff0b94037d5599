"""Leapfrog, kick-drift-kick, with one evaluation of the forces a step.

    v½ = v + Δt/2 a,  x ← x + Δt v½,  ρ½ = ρ + Δt/2 ρ̇        kick, drift
    v̂ = v½ + Δt/2 a,  ρ̂ = ρ + Δt (7ρ̇ₙ − 4ρ̇ₙ₋₁ + ρ̇ₙ₋₂)/4      predict
    a, ρ̇ from x, v̂, ρ̂                                          one pass over the pairs
    v = v½ + Δt/2 a,  ρ = ρ½ + Δt/2 ρ̇                           kick

Forces need the new density and its rate the new velocity, so a leapfrog exact in both would take
two passes.  Predicting both to first order (v + Δt a, ρ + Δt ρ̇: Springel 2005 for v) makes sound
grow by (ωΔt)⁴/4 a step; with the weights 7/4, −1, 1/4 that term vanishes and a damping of
3/16 (ωΔt)⁶ is left: 1.2e-5 a step at ωΔt = 0.2, 1.9e-7 at 0.1; stable to ωΔt = 0.78.  The fastest
sound on a lattice has ωΔt = 1.0 to 1.1 CFL for most kernels, 1.44 for Wendland C6 in 3D.
docs/theory.md derives it, tests/simulation/test_integrator.py measures it.
"""

import numpy as np

from psph.composition.pair import take
from psph.composition.terms import displacement, limit_density, limit_wall_density
from psph.engine.jit import elementwise
from psph.simulation.carried import book_work, carry, prescribed_squares, store_apparent_force
from psph.simulation.own_steps import first_kick, keep_rates, last_kick, seen_ahead, weights_of_rates
from psph.simulation.rules import borne, density
from psph.vectors import add, at, dot, put, scale


@elementwise
def kick_drift_predict(first, last, time, dt, rules, view, columns):
    """Kick by half a step, drift to ``time``, and predict what the forces read.

    Columns ``first`` to ``last`` of ``columns``, which ``view`` shows as formulas see them; ``rules``
    say how the particles of each group move (psph.simulation.rules): fixed ones stay, those whose motion
    is prescribed stand where it has them.
    """
    c = columns
    for k in range(np.uint64(first), np.uint64(last)):
        i, group = take(view, k), c.group[k]
        half = 0.5 * dt * first_kick(rules.own, group, c.first_kick, k)
        w, w_1, w_2 = weights_of_rates(rules.own, group)
        rate = c.density_rate[k]
        rho = c.density[k] + dt * (w * rate + w_1 * c.density_rate_1[k] + w_2 * c.density_rate_2[k])
        c.density[k] += half * rate
        keep_rates(rules.own, group, k, c)
        if group < rules.free:
            a = at(c.acceleration, k)
            v = add(at(c.velocity, k), scale(a, half))
            put(c.velocity, k, v)
            move = add(scale(v, dt), displacement(rules.effects, i, dt))
            put(c.position, k, add(at(c.position, k), move))
            put(c.predicted_velocity, k, add(v, scale(a, seen_ahead(rules.own, group, c.seen_ahead, k) * dt)))
            rho = limit_density(rules.effects, i, rho)
        else:
            rho = limit_wall_density(rules.effects, i, rho)
            carry(rules, group, k, time, c)
        store_apparent_force(rules, group, k, time, dt, c)
        c.specific_volume[k] = 1.0 / rho
        c.pressure[k] = borne(rules, i, group, rho)


@elementwise
def state_of(first, last, rules, view, columns):
    """Pressure and specific volume of the columns ``first`` to ``last`` from their density."""
    c = columns
    for k in range(np.uint64(first), np.uint64(last)):
        c.specific_volume[k] = 1.0 / c.density[k]
        c.pressure[k] = borne(rules, take(view, k), c.group[k], c.density[k])


@elementwise
def settle_given_pressure(first, last, rules, view, columns):
    """Density and specific volume of the columns ``first`` to ``last`` whose pressure a pass has given."""
    c = columns
    for k in range(np.uint64(first), np.uint64(last)):
        i, group = take(view, k), c.group[k]
        if rules.given_pressure[group]:
            law = rules.law_of[group]
            rho = density(rules.laws, law, c.pressure[k], i.rest_density, i.sound_speed)
            c.density[k] = rho
            c.specific_volume[k] = 1.0 / rho
            c.pressure[k] = borne(rules, i, group, rho)


@elementwise
def kick(first, last, time, dt, lag, rules, view, columns):
    """Kick by the second half of the step, with the new rates; the density by ``lag`` s, or not at all where
    that is None: it then stays the one that the forces have read, and the next rates of density will.

    Over the columns ``first`` to ``last``, returns the largest |v|² of the fluid, |a|² of all that
    moves, |ρ/ρ₀ − 1| and square of a displacement over its time step, m²/s², of the fluid, and |v|² of
    walls whose motion is prescribed; the strain is infinite where any particle has a number that is not
    finite.
    """
    c = columns
    v2_max = 0.0
    a2_max = 0.0
    strain_max = 0.0
    shift2_max = 0.0
    wall_v2_max = 0.0
    for k in range(np.uint64(first), np.uint64(last)):
        i, group = take(view, k), c.group[k]
        share = last_kick(rules.own, group, c.last_kick, k)
        rho = c.density[k] if lag is None else c.density[k] + lag * share * c.density_rate[k]
        if group < rules.free:
            a = at(c.acceleration, k)
            v = add(at(c.velocity, k), scale(a, 0.5 * dt * share))
            put(c.velocity, k, v)
            rho = rho if lag is None else limit_density(rules.effects, i, rho)
            v2, a2 = dot(v, v), dot(a, a)
            x = at(c.position, k)
            strain = abs(rho / i.rest_density - 1.0)
            finite = v2 + a2 + dot(x, x) + strain < np.inf  # false for NaN too
            v2_max = max(v2_max, v2 if finite else 0.0)
            a2_max = max(a2_max, a2 if finite else 0.0)
            strain_max = max(strain_max, strain if finite else np.inf)
            shift = displacement(rules.effects, i, 1.0)
            shift2_max = max(shift2_max, dot(shift, shift))
        else:
            rho = rho if lag is None else limit_wall_density(rules.effects, i, rho)
            strain_max = max(strain_max, 0.0 if abs(rho) < np.inf else np.inf)
            v2, a2 = prescribed_squares(rules, group, k, time, dt, at(c.velocity, k), c.anchor)
            wall_v2_max, a2_max = max(wall_v2_max, v2), max(a2_max, a2)
        book_work(rules, i, group, k, dt, c.work, c.load, at(c.velocity, k))
        c.density[k] = rho
    return v2_max, a2_max, strain_max, shift2_max, wall_v2_max


@elementwise
def predict_rows(first, last, dt, data, rows):
    """Evolve further fields as density is: half a kick, and the value that the forces read.

    Each row of ``rows`` (n, 5) names those of ``data`` that hold a component: its value, the predicted
    one, its rate, that of the step before and that of two steps before.
    """
    for n in range(len(rows)):
        value, predicted, rate, rate_1, rate_2 = rows[n]
        for k in range(np.uint64(first), np.uint64(last)):
            change = 1.75 * data[rate, k] - data[rate_1, k] + 0.25 * data[rate_2, k]
            data[predicted, k] = data[value, k] + dt * change
            data[value, k] += 0.5 * dt * data[rate, k]


@elementwise
def kick_rows(first, last, dt, data, rows):
    """The second half of the kick of these fields, with the new rates."""
    for n in range(len(rows)):
        value, rate = rows[n, 0], rows[n, 2]
        for k in range(np.uint64(first), np.uint64(last)):
            data[value, k] += 0.5 * dt * data[rate, k]
