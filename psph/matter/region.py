"""Regions where particles appear or vanish: what they add to a scene (psph.kinds)."""

from collections.abc import Mapping

from psph.kinds import Kind, Stage
from psph.physics.region import next_time
from psph.simulation.stages import nothing


class Regions(Kind):
    """Regions, each with the number of the fluid that comes."""

    name = "regions"
    keeps_energy = False

    def stages(self) -> Mapping[str, Stage]:
        """Particles come and go before new lists are made."""
        return {"renew_lists": Stage(self._populate, nothing)}

    def _populate(self, simulation) -> None:
        """Take particles out and let others in, where new lists are due or a region asks for them."""
        regions = [region for region, _ in self.scene.layout.regions]
        if simulation.listed and next_time(regions, simulation.time) > simulation.then:
            return
        with simulation.ledger("populate"):
            simulation.population.renew(simulation.then)
        simulation.listed = False
