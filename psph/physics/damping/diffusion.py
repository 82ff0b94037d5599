"""Smoothing of what noise continuity leaves in the density."""

from typing import Annotated, NamedTuple

from pydantic import Field

from psph.fields import VECTOR, StillSlope
from psph.fields import Field as Declared
from psph.formula import helper, where
from psph.moments import fastest_smoothing
from psph.physics.damping.matter import Matter, OneMatter, alike, matter_of, speed
from psph.physics.facts import Facts
from psph.physics.fluid.correction import ROUGH, half_disorder, needs_correction
from psph.physics.fluid.viscosity import inverse_square
from psph.physics.fluid.weight import Gravitation, down, gravitation_of
from psph.physics.surface.free import under_tension
from psph.theory.stability import parts
from psph.vectors import add, dot, scale, times, zero_like

STABLE = 0.15
"""S h δ c Δt must stay below; S is the fastest smoothing of the kernel on the lattice (psph.smoothing), 1/m²,
and S h² is 1.9 to 5.7.  The fastest wave decays at the rate 2 S h δ c.  Density, predicted with the weights
7/4, −1, 1/4, is stable up to a third of its value a step; a tenth of that is left for disorder."""


AT_REST = 1e-6
"""Least |1 − ρ₀/ρ| of a wall that bears a pressure; of a dry one it is rounding, in single precision 1e-7.
The density tells it, for the pass at the middle of a step fetches no pressure.  In steps of two passes the
pressure is that of a little later, so the two differ in a wall that begins to bear one; and a pressure below
1e-6 ρc² counts as none: that of 0.2 m of water at c = 1500 m/s."""


class DensityDiffusion(NamedTuple):
    """Density diffuses between neighbours: this damps the noise of the pressure.

    dρ_i/dt = 2 δ h c Σ_j (m_j/ρ_j) [(ρ_i − ρ₀_i) − (ρ_j − ρ₀_j)] x_ij·∇W_ij / max(r², 0.01 h²).
    Molteni & Colagrossi (2009), Comput. Phys. Commun. 180, 861, with max(r², η²) for r² + η²: it is
    W′/r but for the nearest, without a division.  A wall takes density from the fluid and from walls
    that bear a pressure, which a dry one does not (:class:`psph.physics.walls.DryWall`): so the wall
    behind the wet layers has their pressure, and does not draw it off.  It gives the fluid nothing: a
    drop that lies on a wall would lose to it the density that holds it off.  In the fluid it keeps
    Σ m_i/ρ_i dρ_i/dt = 0.
    """

    delta: Annotated[float, Field(ge=0, description="strength δ", json_schema_extra={"unit": "1"})] = 0.1

    def in_scene(self, scene: Facts):
        """Under gravity, beside walls or where matters differ, the form that knows of them."""
        held = any(scene.gravity) or not all(one.is_fluid for one in scene.species)
        held = held or scene.frame is not None
        pull, matter = gravitation_of(scene), matter_of(scene)
        if isinstance(matter, OneMatter) and not held:
            return self
        return TankDiffusion(self.delta, pull, matter, under_tension(scene))

    def density_rate(self, i, j, pair):
        """One neighbour's share of dρ_i/dt, kg/(m^d s)."""
        return _excess(self.delta, i, j, 0.0) * _nearness(i, pair)

    def longest_step(self, scene):
        """Δt ≤ 0.15/(S h δ c), s: see STABLE."""
        return diffusion_step(self.delta, scene)

    def linear(self, scene: Facts):
        """Its part in linear theory."""
        return parts.LinearDiffusion(self.delta)


class TankDiffusion(NamedTuple):
    """Density spreads in the fluid, but for what the weight of a still column asks for.

    As :class:`DensityDiffusion` with (ρ_i − ρ₀_i) − (ρ_j − ρ₀_j) − ρ̄₀ g·x_ij/c² in the bracket, ρ̄₀ the
    mean of the pair's two rest densities: the slope of density in a fluid at rest, linear in the
    depth, stays, and what one particle gains in volume the other loses.  Antuono, Colagrossi,
    Marrone & Molteni (2010), Comput. Phys. Commun. 181, 532, with the exact slope for theirs.
    ``gravity`` is what is felt as such; ``matter`` by :func:`matter_of`; ``tension`` 1 if walls bear one,
    else 0.
    """

    delta: float
    gravity: Gravitation
    matter: Matter = OneMatter()
    tension: float = 1.0

    def density_rate(self, i, j, pair):
        """One neighbour's share of dρ_i/dt, kg/(m^d s)."""
        taken = _excess(self.delta, i, j, _weight(self, i, j, pair)) * alike(self.matter, i, j)
        return where(_giving(self.tension, i, j) > 0.0, taken, 0.0) * _nearness(i, pair)

    def longest_step(self, scene):
        """Δt ≤ 0.15/(S h δ c), s: see STABLE."""
        return diffusion_step(self.delta, scene)

    def linear(self, scene: Facts):
        """Its part in linear theory."""
        return parts.LinearDiffusion(self.delta)


class FourthOrderDiffusion(NamedTuple):
    """Density diffuses between neighbours, except for the part of a smooth field: this damps noise alone.

    As :class:`DensityDiffusion` with s′ = s − g in the bracket, s = (ρ_i − ρ₀_i) − (ρ_j − ρ₀_j) and
    g = ½(∇ρ_i + ∇ρ_j)·x_ij: zero pair by pair where the density is linear or quadratic.  Antuono,
    Colagrossi, Marrone & Molteni (2010), Comput. Phys. Commun. 181, 532.  ∇ρ_i = −Σ_j V_j [(ρ − ρ₀)_i −
    (ρ − ρ₀)_j] L_i∇W_ij is that of the step before.  Walls and weight as in :class:`TankDiffusion`, whose
    slope is taken from s and from g.  Psph's own: g is clipped between 0 and s, so that nothing ever flows
    to where there is more, and fades in disorder and at a surface, as :class:`LocalPotential
    <psph.physics.order.potential.LocalPotential>` sees it with t = 0.2.
    """

    delta: Annotated[
        float, Field(ge=0, le=0.2, description="strength δ", json_schema_extra={"unit": "1"})
    ] = 0.1

    def in_scene(self, scene: Facts):
        """The form that knows gravity."""
        return BesideSmoothDensity(self.delta, gravitation_of(scene), matter_of(scene), under_tension(scene))

    @staticmethod
    def conflicts(physics, kernel):
        """The gradient of the density is a corrected one."""
        yield from needs_correction(physics)
        if physics.density_diffusion is not None:
            yield 'takes the place of physics.density_diffusion; set that to "off"'


class BesideSmoothDensity(NamedTuple):
    """Density diffuses between neighbours, except for the part of a smooth field: this damps noise alone.

    The form of :class:`FourthOrderDiffusion` in a scene; ``gravity`` is what is felt as such;
    ``matter`` by :func:`matter_of`; ``tension`` 1 if walls bear one, else 0.
    """

    delta: float
    gravity: Gravitation
    matter: Matter = OneMatter()
    tension: float = 1.0

    writes = Declared(
        "density_gradient", "kg/m4", "gradient of the density over its rest density", VECTOR, image=StillSlope
    )
    lagged = True
    slow = True

    def start(self, i):
        """No neighbour yet."""
        return zero_like(i.position)

    def gather(self, total, i, j, pair):
        """Add −V_j [(ρ − ρ₀)_i − (ρ − ρ₀)_j] ∇W_ij."""
        level = 1.0 / i.specific_volume + (j.rest_density - i.rest_density)
        rise = (level * j.specific_volume - 1.0) * alike(self.matter, i, j)
        return add(total, scale(pair.x_ij, -rise * pair.m_dw_r))

    def finish_value(self, total, i, kernel):
        """∇ρ_i, kg/m^(d+1)."""
        return add(total, times(i.gradient_correction, total))

    def density_rate(self, i, j, pair):
        """One neighbour's share of dρ_i/dt, kg/(m^d s)."""
        # Over ρ_j, so that nothing is divided by 1/ρ_j.
        weight = _weight(self, i, j, pair)
        level = 1.0 / i.specific_volume + (j.rest_density - i.rest_density) - weight
        slope = 0.5 * dot(add(i.density_gradient, j.density_gradient), pair.x_ij) - weight
        rise, smooth = level * j.specific_volume - 1.0, slope * j.specific_volume
        smooth = min(max(smooth, min(rise, 0.0)), max(rise, 0.0))
        ordered = 1.0 - half_disorder(ROUGH, i) - half_disorder(ROUGH, j)
        mixing = 2.0 * self.delta * i.smoothing_length * i.sound_speed * alike(self.matter, i, j)
        flux = mixing * (rise - ordered * smooth)
        nearness = min(pair.r2 * (100.0 / (i.smoothing_length * i.smoothing_length)), 1.0)
        return where(_giving(self.tension, i, j) > 0.0, flux, 0.0) * (nearness * pair.m_dw_r)

    def longest_step(self, scene):
        """Δt ≤ 0.15/(S h δ c), s: see STABLE."""
        return diffusion_step(self.delta, scene)

    def linear(self, scene: Facts):
        """Its part in linear theory, of the shortest waves."""
        return parts.LinearDiffusion(self.delta)


@helper
def _weight(effect, i, j, pair):
    """ρ̄₀ g·x_ij/c², kg/m^d: what the weight of a still column asks for."""
    mean = 0.5 * (i.rest_density + j.rest_density)
    c = speed(effect.matter, i)
    return mean / (c * c) * down(effect.gravity, i, j, pair)


@helper
def _giving(tension, i, j):
    """Above 0 where j gives density to i: a fluid takes nothing from a wall, and a wall nothing from one
    without pressure."""
    denser = 1.0 - j.specific_volume * j.rest_density
    return j.is_fluid + (1.0 - i.is_fluid) * (max(denser, -tension * denser) - AT_REST)


@helper
def _excess(delta, i, j, weight):
    """2δhc [(ρ_i − ρ₀_i) − (ρ_j − ρ₀_j) − ``weight``]/ρ_j, m²/s."""
    strength = 2.0 * delta * i.smoothing_length * i.sound_speed
    # (a − ρ_j)/ρ_j as a/ρ_j − 1: no division by 1/ρ_j.
    level = 1.0 / i.specific_volume + (j.rest_density - i.rest_density) - weight
    return (strength * level) * j.specific_volume - strength


@helper
def _nearness(i, pair):
    """m_j x_ij·∇W_ij/max(r², 0.01 h²), kg/m^(d+2)."""
    return pair.r2 * inverse_square(pair, i.smoothing_length) * pair.m_dw_r


def diffusion_step(delta: float, scene) -> float:
    """Δt ≤ 0.15/(S h δ c), s: see STABLE."""
    spread = fastest_smoothing(scene.kernel, scene.spacing, scene.dimensions)
    rate = spread * scene.smoothing_length * delta * scene.sound_speed
    return STABLE / rate if rate > 0.0 else float("inf")
