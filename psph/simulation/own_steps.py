"""Groups of particles with steps of their own, each as long as several of the simulation: levels of sizes.

A group of pace r is kicked by rΔt/2 in the first step of each r, drifts by the same v½ in all, and in the
last has forces and the second kick by rΔt/2: it goes on as by one leapfrog of rΔt.  After τ of them those
who follow it at another pace see, with θ = τ/r,

    v̂ = v½ + (τ − r/2) Δt a,   ρ̂ = ρ + rΔt (θ ρ̇ₙ + θ² (3ρ̇ₙ/4 − ρ̇ₙ₋₁ + ρ̇ₙ₋₂/4)),

which at θ = 1 is what its own forces read (psph.simulation.integrator).  Where all are of pace 1 compiled
loops have these as plain numbers.  Where each particle takes a step of its own (psph.simulation.each_step)
its column says the same: ``each`` has it, else None.
"""

from typing import Any, NamedTuple

from psph.engine.jit import inside


class OwnSteps(NamedTuple):
    """Where each group is in a step of its own, arrays (groups,) that stay the same objects.

    The ``first`` and the ``last`` kick of the step that goes on take so many times Δt/2, 0 where there is
    none; velocities are seen ``ahead`` Δt after v½; ``rate``, ``rate_1`` and ``rate_2`` are the weights,
    times Δt, of the newest and of earlier rates of density in what is seen, from ρ as it stands.
    """

    first: Any
    last: Any
    ahead: Any
    rate: Any
    rate_1: Any
    rate_2: Any


@inside
def first_kick(own, group, each, k):
    """Half steps of Δt by which a ``group`` is kicked before it drifts."""
    if each is not None:
        return each[k]
    return 1.0 if own is None else own.first[group]


@inside
def last_kick(own, group, each, k):
    """Half steps of Δt by which it is kicked after the pass."""
    if each is not None:
        return each[k]
    return 1.0 if own is None else own.last[group]


@inside
def seen_ahead(own, group, each, k):
    """Steps of Δt from v½ to the velocity that is seen."""
    if each is not None:
        return each[k]
    return 0.5 if own is None else own.ahead[group]


@inside
def weights_of_rates(own, group):
    """Weights of ρ̇ₙ, ρ̇ₙ₋₁ and ρ̇ₙ₋₂, times Δt, in the density that is seen."""
    return (1.75, -1.0, 0.25) if own is None else (own.rate[group], own.rate_1[group], own.rate_2[group])


@inside
def keep_rates(own, group, k, columns):
    """Make room for a new rate of density of column ``k``, at the end of a step of its own.  Rows change
    places for that where all steps are the same."""
    if own is not None:
        now, before, oldest = columns.density_rate[k], columns.density_rate_1[k], columns.density_rate_2[k]
        ends = own.last[group] > 0.0
        columns.density_rate_2[k] = before if ends else oldest
        columns.density_rate_1[k] = now if ends else before
