"""What flows: fluids, soils and updated Lagrangian solids share one pair loop, one kernel and one step."""

from collections.abc import Iterator, Mapping

from psph.case.fluids import HYDROSTATIC
from psph.kinds import Kind
from psph.scene.fluid.advice import fluid_advice
from psph.scene.fluid.capillary import capillary_speed
from psph.scene.fluid.checks import fluid_warnings
from psph.scene.fluid.costs import cost_lines
from psph.scene.fluid.opening import has_free_surface
from psph.scene.fluid.periodic_gravity import creeping_speed, driven_speed
from psph.scene.fluid.rheologies import rheology_lines
from psph.scene.fluid.still import Still, stills_of
from psph.scene.relaxing import ITERATIONS, relaxing
from psph.scene.sites import sites_within
from psph.scene.waving import wave_faults

NARROWEST = 22
"""Characters of a column of names."""

FORCE_LIMIT = 0.25
"""Monaghan (1992): Δt ≤ 0.25 √(h/|a|)."""


class Fluids(Kind):
    """All that moves freely and finds its neighbours in space."""

    name = "flowing"

    @classmethod
    def has_free_surface(cls, census) -> bool:
        """Whether it has one, or can (psph.scene.fluid.opening)."""
        return has_free_surface(census)

    @classmethod
    def driven_speed(cls, census) -> float:
        """By what friction lets it (psph.scene.fluid.periodic_gravity)."""
        return driven_speed(census)

    @classmethod
    def creeping_speed(cls, census) -> float:
        """√(gH) (psph.scene.fluid.periodic_gravity), or that of a film (psph.scene.fluid.capillary)."""
        return max(creeping_speed(census), capillary_speed(census))

    @classmethod
    def layers(cls, census) -> Mapping[int, Still]:
        """Columns of fluids whose pressure is hydrostatic (psph.scene.fluid.still)."""
        parts = (part for part in census.layout.parts if part.flows)
        return stills_of(census, [part.number for part in parts if part.table.pressure == HYDROSTATIC])

    @property
    def bears_midway(self) -> bool:
        """Yes."""
        return True

    def limits(self, plan, speed: float, acceleration: float) -> Iterator[tuple[float, str]]:
        """That of sound, and that of the largest acceleration."""
        h = plan.smoothing_length
        yield plan.cfl * h / (plan.extremes.sound_speed + speed), "sound (CFL)"
        if acceleration > 0.0:
            yield FORCE_LIMIT * (h / acceleration) ** 0.5, "force"

    def faults(self) -> Iterator[str]:
        """Waves that cannot be."""
        yield from wave_faults(self.scene)

    def warnings(self) -> Iterator[str]:
        """What is likely not meant."""
        yield from fluid_warnings(self.scene)

    def advice(self, guard: str, suspect) -> Iterator[str]:
        """Of the speed of sound, pressure, walls and friction."""
        yield from fluid_advice(self.scene, guard, suspect)

    def lines(self, plan, dt: float) -> Iterator[tuple[str, str]]:
        """The kernel, viscosities, and what numerical friction stands for beside them."""
        scene, space = self.scene, self.scene.case.space
        support = scene.support
        yield (
            "reach",
            f"  kernel      {space.kernel}, h = {scene.smoothing_length:g} m "
            f"(h/dx {space.smoothing:g}), support {support:g} m, "
            f"about {sites_within(scene, support):.0f} neighbours",
        )
        if fluids := relaxing(scene.layout):
            names = ", ".join(scene.layout.parts[number].name for number in fluids)
            yield (
                "matter",
                f"  start       {names}: relaxed from a shaken lattice in {ITERATIONS} passes before the run",
            )
        for place, line in enumerate(cost_lines(scene, plan.cfl)):
            yield "matter", f"  {'fluids' if not place else '':<11} {line}"
        yield from (("friction", line) for line in self._friction(plan))

    def _friction(self, plan) -> Iterator[str]:
        for place, line in enumerate(rheology_lines(self.scene)):
            if not place:
                yield "Viscosities that depend on the rate of strain"
            yield f"  {line}"
        found = [
            (call.title, call.effect.numerical_viscosity(self.scene))
            for call in plan.called
            if hasattr(call.effect, "numerical_viscosity")
        ]
        if not any(viscosity for _, viscosity in found):
            return
        fluids = self._tables.items()
        own = [(f"fluids.{name}", fluid.viscosity) for name, fluid in fluids if not fluid.rheology]
        yield "Kinematic viscosity, and what numerical friction acts as in a shear flow"
        width = max(NARROWEST, 2 + max(len(name) for name, _ in (*own, *found)))
        for name, viscosity in own:
            yield f"  {name:<{width}}{viscosity:.3g} m²/s"
        smallest = min((viscosity for _, viscosity in own if viscosity), default=0.0)
        for name, viscosity in found:
            times = f", {viscosity / smallest:.2g} times the fluid's" if smallest else ""
            yield f"  {name:<{width}}{viscosity:.3g} m²/s{times}"

    def cure(self, limit: str) -> str:
        """Less viscosity."""
        caps = {
            fluid.rheology.law.largest / fluid.density: (name, fluid.rheology)
            for name, fluid in self._tables.items()
            if fluid.rheology
        }
        if limit == "apparent viscosity" and caps:
            name, rheology = caps[max(caps)]
            return (
                f"fluids.{name}.rheology.{rheology.name} sets the step by its largest viscosity, "
                f"{rheology.law.largest:.3g} Pa s; give less"
            )
        viscosity = max((fluid.viscosity for fluid in self._tables.values()), default=0.0)
        if not limit.endswith(("viscosity", "friction")) or not viscosity:
            return ""
        name = next(n for n, fluid in self._tables.items() if fluid.viscosity == viscosity)
        return (
            f"fluids.{name}.viscosity = {viscosity:g} m²/s sets the step: it is the kinematic viscosity, "
            "1e-6 for water and 0.01 for honey"
        )

    @property
    def _tables(self):
        return self.scene.case.flowing
