"""Ideal gases: what they add to a scene (psph.kinds)."""

import math
from collections.abc import Container, Iterator, Mapping

import numpy as np

from psph.fields import VELOCITY, Field
from psph.kinds import Created, Kind, count_of
from psph.particles.sizes import GROWTH, Sizes
from psph.physics.gas.shocks import switches
from psph.physics.gas.state import (
    EVENNESS,
    HEAT,
    INVERSE_LENGTH,
    LENGTH,
    LISTED_LENGTH,
    OF_GASES,
    OF_OWN_STEPS,
    OF_SWITCH,
    SHARE,
    SOUND,
    UNEQUAL,
)
from psph.scene.mirrors import distances
from psph.scene.particles import settled_at
from psph.scene.parts.gas import GasPart
from psph.scene.parts.gas_faces import face_faults
from psph.scene.parts.gas_sides import side_warnings, sides_of, unheld_warnings
from psph.scene.sites import sites_within
from psph.scene.steps import shorter_step
from psph.simulation.each_step import OF_STEPS
from psph.simulation.gas import PREDICTED, TINY, Gases, Pace, begin_sizes, check_lists, find_sizes
from psph.simulation.gas_steps import FINER, GasSteps, Limits
from psph.simulation.near_rows import NEARER
from psph.simulation.stages import nothing
from psph.smoothing import unit_kernel, weight
from psph.theory.stability import SYMMETRIC
from psph.theory.stability.lattices import OF_SCENES
from psph.theory.stability.uniform import Settings
from psph.work import Rank, Stage, Work

FORCE_LIMIT = 0.25
"""Monaghan (1992): Δt ≤ 0.25 √(h/|a|)."""

COOLING_LIMIT = 0.3
"""Share of its heat that a particle loses in a step at the most."""

FLOPS = 40
"""Operations of a neighbour in the iteration of smoothing lengths, of about two turns."""

ROW = 12
"""Bytes of where a row begins and of how long it is."""


class IdealGases(Kind):
    """Gas that shocks heat, whose particles have smoothing lengths of their own."""

    name = "ideal_gases"
    columns = ("thermal_energy",)

    @property
    def keeps_energy(self) -> bool:
        """Not where mirrors that move do work, or gas comes or goes."""
        moved = any(plane.motion for plane in self.scene.layout.mirror_planes)
        return not moved and not sides_of(self.scene.layout, self.parts)

    keeps_heat = True

    may_save = (LENGTH, HEAT, SOUND, SHARE)
    is_stiff = False

    @property
    def parts(self) -> list[GasPart]:
        """Its parts of the scene."""
        return [part for part in self.scene.layout.parts if isinstance(part, GasPart)]

    @property
    def fields(self) -> tuple[Field, ...]:
        """What their work fills."""
        own = (*OF_OWN_STEPS, *OF_STEPS) if self.scene.case.time.halvings else ()
        return (*OF_GASES, *(() if self.least is None else OF_SWITCH), *own)

    @property
    def least(self) -> float | None:
        """The share of the viscosity where nothing shocks; None where it is the same everywhere."""
        viscosity = self.scene.case.physics.shock_viscosity
        return viscosity.least if switches(viscosity) else None

    @property
    def sizes(self) -> Sizes:
        """By the smoothing length of each particle."""
        skin = self.scene.case.neighbours.skin
        pairs = distances(self.scene.layout.mirror_planes).values()
        between = min((high - low for low, high in pairs), default=math.inf)
        return Sizes(self.scene.kernel.support, skin, LENGTH.name, LISTED_LENGTH.name, between)

    def starts(
        self, fields: Container[str], species: np.ndarray, position: np.ndarray
    ) -> Iterator[tuple[str, np.ndarray]]:
        """Heat by the case, and smoothing lengths by the spacing: a first guess."""
        parts = {part.number: part for part in self.parts}
        length, heat = np.zeros((2, len(species), 1))
        for number, part in parts.items():
            own = species == number
            length[own] = self.scene.smoothing_length / part.finer
            heat[own, 0] = part.start.heat(position[own])
        if "mass" in fields:
            yield "mass", self._masses(species, position)
        yield LENGTH.name, length
        yield HEAT.name, heat
        yield PREDICTED, heat

    def _masses(self, species: np.ndarray, position: np.ndarray) -> np.ndarray:
        """Mass (n, 1), kg: by the density where a particle is in parts where masses differ."""
        found = np.array([one.mass for one in self.scene.species])[species][:, None]
        for part in (one for one in self.parts if not one.one_mass):
            own = species == part.number
            mean = self.scene.species[part.number].mass / part.table.density
            found[own, 0] = mean * part.start.density(position[own])
        return found

    def particles(self) -> Created | None:
        """Those on no sites."""
        layout, starts = self.scene.layout, self.scene.starts
        apart = [part for part in self.parts if part.number in layout.placed]
        if not apart:
            return None
        counts = [len(layout.placed[part.number]) for part in apart]
        number = np.repeat([part.number for part in apart], counts)
        position = np.concatenate([layout.placed[part.number] for part in apart])
        found = settled_at(starts, np.arange(len(number)), number, position)
        begun = self.starts(("mass",), number, found.position)
        values = {name: x[:, 0] for name, x in begun}
        for part, last in zip(apart, np.cumsum(counts)):
            rows = slice(last - len(layout.placed[part.number]), last)
            for name, own in layout.begun[part.number].items():
                if name == VELOCITY.name:
                    found.velocity[rows] += own
                else:
                    values[name][rows] = own
        return Created(number, found.position, found.velocity, found.density, values, of_parts=True)

    def faults(self) -> Iterator[str]:
        """Particles of files outside the domain, too few in all, and faces that see too far."""
        layout = self.scene.layout
        for part in self.parts:
            yield from part.faults(layout)
        count, least = count_of(self.scene), math.ceil(sites_within(self.scene, self.scene.support))
        if count <= least:
            yield (
                f"{self.parts[0].key}: {count} particle{'s' * (count != 1)} in all, and space.smoothing asks "
                f"for {least} neighbours of each; put more particles, or give a smaller space.smoothing"
            )
        yield from face_faults(layout, self.parts, self.sizes)

    @property
    def farthest(self) -> float:
        """By the largest first guess of a smoothing length."""
        return self.sizes.reach(max(float(part.guessed(self.scene.layout).max()) for part in self.parts))

    def warnings(self) -> Iterator[str]:
        """A particle that stands so far from all others that few ranks can share the run; streams slower than
        sound, and gas that leaves beside them unheld."""
        for part in self.parts:
            yield from part.stragglers(self.scene.layout)
            yield from side_warnings(self.scene.layout, part)
        yield from unheld_warnings(self.parts)

    def renews(self, passes) -> tuple[str, ...]:
        """Lengths and what follows from them, and the heat, of which too low a prediction is lifted."""
        of_lengths = LENGTH.name, INVERSE_LENGTH.name, UNEQUAL.name, EVENNESS.name, "specific_volume"
        return *of_lengths, SOUND.name, PREDICTED, "pressure"

    def stages(self) -> Mapping[str, Stage]:
        """Sizes and densities are found before the sums over pairs, which read them of neighbours."""
        return {
            "renew_lists": Stage(check_lists, nothing),
            "sum_over_pairs": Stage(find_sizes, begin_sizes),
        }

    def planned(self, plan) -> Pace:
        """What limits the step: before the first forces by sound at rest, of the start or after a fall."""
        return Pace(
            max(2.0 * max(part.quickest(self.scene.layout), self._fallen(part)) for part in self.parts)
        )

    def _fallen(self, part: GasPart) -> float:
        """c/h, 1/s, of gas that falls together under its own pull as fast as is to be expected, v, and is
        stopped: u = v²/2, so c² = γ(γ − 1) v²/2; 0 without such a pull."""
        if self.scene.case.physics.self_gravity is None:
            return 0.0
        g, v = part.table.gamma, self.scene.expected_speed
        return v * math.sqrt(0.5 * g * (g - 1.0)) / float(part.guessed(self.scene.layout).min())

    def limits(self, plan, speed: float, acceleration: float) -> Iterator[tuple[float, str]]:
        """That of the fastest signal across a smoothing length, of the largest push, and of what cools."""
        pace = plan.planned[self.name]
        times = 2.0**pace.doublings  # of a step of all, where particles take steps of their own
        yield times * 2.0 * plan.cfl / pace.signal, "signal speed (CFL)"
        if pace.push > 0.0:
            yield times * FORCE_LIMIT * pace.push**-0.5, "force"
        if pace.cooling > 0.0:
            yield times * COOLING_LIMIT / pace.cooling, "cooling"

    def work(self, rank: Rank) -> Iterator[Work]:
        """Sizes, pressure, and the longest step."""
        groups = len(rank.plan.materials.species)
        gamma = np.ones(groups)
        gamma[[part.number for part in self.parts]] = [part.table.gamma for part in self.parts]
        told = (part for part in self.parts if part.start.gas.pressure is not None)
        sides = sides_of(self.scene.layout, self.parts)
        pressures = {part.number: part.start.pressure for part in told}
        pace, halvings = rank.plan.planned[self.name], self.scene.case.time.halvings
        limits = Limits(2.0 * rank.plan.cfl, FORCE_LIMIT, COOLING_LIMIT, TINY)
        steps = GasSteps(rank, pace, halvings, limits) if halvings else None
        yield Gases(rank, gamma, pressures, pace, self.least, sides, steps)

    def forecast(self, plan) -> Iterator[tuple[str, Settings | None]]:
        """The step that sound lets each gas have at rest, and whether its lattice keeps its order."""
        space, lattice = self.scene.case.space, OF_SCENES[self.scene.dimensions]
        yield (
            (
                f"Stability of gases at the start, on a {lattice} lattice with h held, without friction "
                "(linear theory, docs/stability.md)"
            ),
            None,
        )
        for part in self.parts:
            step = plan.cfl / part.quickest(self.scene.layout)
            yield f"  {part.name:<20}Δt ≤ {step:.3g} s at rest, cfl h/c where that is shortest", None
            if part.even:
                of = part.table
                state = of.pressure, SYMMETRIC, of.density, of.sound_speed, self.scene.spacing / part.finer
                yield "", Settings(space.kernel, space.smoothing, lattice, *state)

    def lines(self, plan, dt: float) -> Iterator[tuple[str, str]]:
        """What each is, how far particles reach, and what comes before the pass over pairs."""
        scene, space = self.scene, self.scene.case.space
        farther = GROWTH + scene.case.neighbours.skin
        for part in self.parts:
            one = part.table
            yield (
                "matter",
                f"  ideal gas   {part.key}: γ = {one.gamma:g}, ρ = {one.density:g} kg/m³, "
                f"p = {one.pressure:g} Pa, c = {one.sound_speed:.4g} m/s at the start",
            )
        yield (
            "reach",
            f"  kernel      {space.kernel}, h = {space.smoothing:g} n^(-1/{scene.dimensions}) of each "
            f"particle, about {sites_within(scene, scene.support):.0f} neighbours; lists reach {farther:g} "
            "times the larger support of a pair",
        )
        yield "passes", "Before them smoothing lengths and densities by iteration, without a message"

        if halvings := scene.case.time.halvings:
            yield (
                "steps",
                f"  steps of own        a particle's step is the longest, or 2 to {2**halvings} times "
                f"shorter, and at most {FINER:g} times what its neighbours bear; who sleeps longer is woken",
            )
            yield (
                "steps",
                "                      so few have forces in a step: a run is quicker than expected",
            )
        heated = (
            f"after a fall at {scene.expected_speed:.3g} m/s, or as at the start where that is hotter"
            if scene.case.physics.self_gravity
            else "at the start"
        )
        yield (
            "steps",
            f"  not foreseen        steps are counted for gas as {heated}; shocks, and what is pressed "
            "together, take more, what cools or thins fewer",
        )

    def advice(self, guard: str, suspect) -> Iterator[str]:
        """Of heat that leaves a particle as fast as it may, and of shorter steps."""
        if guard == "clock":
            yield "start with fewer unlike masses, sizes and temperatures side by side"
        yield from shorter_step(self.scene)

    def cure(self, limit: str) -> str:
        """Coarser particles."""
        return (
            "space.spacing sets the step by the smallest smoothing length; give more"
            if "signal" in limit
            else ""
        )

    def bytes_of_particle(self, plan) -> float:
        """Lists reach farther than those of one size, and there are rows of those that are close."""
        skin, d = self.scene.case.neighbours.skin, self.scene.dimensions
        farther = (GROWTH + skin) ** d - (1.0 + skin) ** d + NEARER**d
        return 4.0 * sites_within(self.scene, self.scene.support) * farther + ROW

    def flops(self) -> float:
        """In the iteration."""
        return FLOPS

    def examples(self, plan) -> tuple:
        """The kernel with h = 1 m."""
        return (unit_kernel(self.scene.kernel, self.scene.dimensions),)

    def rehearsed(self) -> tuple[int, ...]:
        """So many in one place that each has its number of neighbours."""
        kernel = unit_kernel(self.scene.kernel, self.scene.dimensions)
        target = self.scene.case.space.smoothing**self.scene.dimensions
        return (0,) * math.ceil(target / weight(kernel, 0.0))
