"""Regions where particles appear or vanish: what they add to a scene (psph.kinds)."""

from collections.abc import Iterator, Mapping
from functools import cached_property

from psph.kinds import Kind
from psph.physics.region import is_sink, is_source, next_time
from psph.scene.regions import regions_in, regions_of
from psph.simulation.stages import nothing
from psph.work import Stage


class Regions(Kind):
    """Regions, each with the number of the fluid that comes."""

    name = "regions"

    @property
    def keeps_energy(self) -> bool:
        """Not that of what comes and goes."""
        return False

    @cached_property
    def regions(self) -> tuple:
        """What they do (psph.physics.region)."""
        return tuple(region for region, _ in regions_in(self.scene.case))

    @cached_property
    def _of_parts(self) -> tuple[tuple, tuple]:
        """Where particles vanish, and where they appear, each of these with the number of what comes."""
        found = regions_of(self.scene.layout)
        sinks = tuple(region for region, _ in found if is_sink(region))
        return sinks, tuple((region, group) for region, group in found if is_source(region))

    @classmethod
    def drains(cls, case) -> bool:
        """Whether particles may vanish."""
        return any(is_sink(region) for region, _ in regions_in(case))

    def lines(self, plan, dt: float) -> Iterator[tuple[str, str]]:
        """What each does."""
        for region in self.regions:
            yield "matter", f"  region      {type(region).__name__}: {type(region).__doc__.splitlines()[0]}"

    def stages(self) -> Mapping[str, Stage]:
        """Particles come and go before new lists are made."""
        return {"renew_lists": Stage(self._populate, nothing)}

    def _populate(self, simulation) -> None:
        """Take particles out and let others in, where new lists are due or a region asks for them."""
        if simulation.listed and next_time(self.regions, simulation.time) > simulation.then:
            return
        with simulation.ledger("populate"):
            simulation.population.renew(*self._of_parts, simulation.then)
        simulation.listed = False
