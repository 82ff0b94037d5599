"""Particles that appear and vanish while a scene runs, the same on any number of ranks."""

from collections.abc import Iterable
from typing import Any

import numpy as np

from psph.fields import FLUID
from psph.kinds import count_of
from psph.simulation.filling import block_of


class Population:
    """Who is there: ``next_id`` is the number that the next particle gets, ``asked`` the time (s) up
    to which those have been asked who take out and let in.  Both are the same on every rank.
    """

    def __init__(self, scene, plan, domain):
        self.scene, self.plan, self.domain = scene, plan, domain
        self.next_id, self.asked = count_of(scene), 0.0

    def renew(self, sinks: Iterable, sources: Iterable[tuple[Any, int]], time: float) -> None:
        """Take out what ``sinks`` say up to ``time``, s, and let in what ``sources`` say, each with the group
        of what comes (psph.physics.region); new lists have to follow."""
        for sink in sinks:
            self._take_out(sink, time)
        for source, group in sources:
            self.let_in(*source.appear(self.asked, time), group)
        self.asked = time

    def state(self) -> dict:
        """What the next steps rest on."""
        return {"next_id": self.next_id, "asked": self.asked}

    def restore(self, state: dict) -> None:
        """Go on from there."""
        self.next_id, self.asked = state["next_id"], state["asked"]

    def _take_out(self, sink, time: float) -> None:
        store = self.domain.store
        fluid = np.flatnonzero(store.shown("kind") == FLUID)
        places = self.domain.inside(store.shown("position")[fluid])
        gone = fluid[sink.vanish(places, store.shown("velocity")[fluid], time)]
        staying = np.delete(np.arange(store.owned), gone)
        store.reorder((store.low + staying).astype(np.uint32), 0, 0)

    def let_in(self, position: np.ndarray, velocity: np.ndarray, group: int) -> None:
        """Particles of a ``group`` begin at ``position`` (n, dim), m, with a ``velocity``, m/s; rank 0
        holds them until the new lists send them where they belong."""
        n, store = len(position), self.domain.store
        if n and self.domain.comm.rank == 0:
            species = np.full(n, group, np.uint8)
            density = np.full(n, self.scene.species[group].density)
            block = block_of(self.scene, self.plan.materials, store, species, position, velocity, density)
            block[store.rows["specific_volume"].start] = 1.0 / density
            store.append(self.next_id + np.arange(n), species, block)
        self.next_id += n
