"""The walls of a rank that have fluid in reach, and the rows of the others, which rest."""

import numpy as np

from psph.engine.settled import settled
from psph.engine.threads import in_threads
from psph.parallel.domain import Domain
from psph.particles.reach import Reach
from psph.particles.store import Store
from psph.particles.wetting import (
    DryRows,
    find_beside_fluid,
    find_felt,
    find_resting,
    find_undecided,
    mark_wet,
)
from psph.simulation.plan import Plan


class Wetting:
    """Fills the field that ``effect`` marks (:class:`psph.physics.walls.dry.DryWall`) in the particles of
    ``store``, by their lists in ``domain``.

    A step looks only at those which may become wet or dry while the lists last, and nothing is summed for
    those that are dry.  Between 0.95 of the support and its end fluid feels a dry wall all the same: of one
    whose load is asked for that is summed (:meth:`dry_beside_fluid`), and nothing else, so that asking
    changes nothing.
    """

    def __init__(self, effect, plan: Plan, store: Store, domain: Domain, reach: Reach):
        self.effect, self.plan, self.store, self.domain, self.reach = effect, plan, store, domain, reach
        species = plan.materials.species
        self._serves = np.array([effect.served(one, species) for one in species])
        self._undecided = self._loaded = np.zeros(0, np.uint64)
        self._rows = DryRows(np.zeros(0, np.uint32), np.zeros(0, bool))
        self._find_undecided, self._find_resting = settled(find_undecided), settled(find_resting)
        self._find_beside, self._find_felt = settled(find_beside_fluid), settled(find_felt)
        self._mark_wet = settled(mark_wet)

    def settle(self) -> None:
        """Lists are new, or taken up: the rows of dry walls become empty."""
        s, materials, lists = self.store, self.plan.materials, self.domain.lists
        undecided, self._rows = (
            np.zeros(s.owned, bool),
            DryRows(lists.lengths.copy(), np.zeros(s.owned, bool)),
        )
        safe, wet = 2.0 * self.reach.support - self.domain.reach, s[self.effect.marks.name]
        self._each(
            self._find_undecided, safe, self.domain.periods, s["listed_position"], *self._kinds, undecided
        )
        self._undecided = np.uint64(s.low) + np.flatnonzero(undecided).astype(np.uint64)
        self._each(self._find_resting, s.group, materials.free, self._rows.rest)
        if materials.loaded is not None and not self.plan.finer:
            beside = np.zeros(s.owned, bool)
            self._each(self._find_beside, materials.loaded, s.group, s[self.effect.told_by], beside)
            self._loaded = np.uint64(s.low) + np.flatnonzero(beside & self._rows.rest).astype(np.uint64)
        lists.lengths[: s.owned][self._rows.rest & (wet[s.inner] == 0.0)] = 0

    def begin(self) -> None:
        """Decide of all; lists have to be there."""
        s = self.store
        self._mark(np.arange(s.low, s.low + s.owned, dtype=np.uint64))

    def mark(self) -> None:
        """Decide by the places of this step, ghosts as they were brought for its sums."""
        self._mark(self._undecided)

    def dry_beside_fluid(self, first: int, last: int) -> tuple[np.ndarray, np.ndarray]:
        """The columns from ``first`` to ``last`` that are dry, bear a load, and have fluid in reach; and the
        whole lengths of all rows."""
        s, lengths = self.store, self._rows.lengths
        walls = self._loaded[(self._loaded >= first) & (self._loaded < last)]
        walls = walls[s[self.effect.marks.name][walls] == 0.0]
        felt, reach = np.zeros(len(walls), bool), (self.reach.support, self.domain.periods)
        seen = s["position"], s[self.effect.told_by]
        in_threads(
            self._find_felt, 0, len(walls), walls, s.low, self.domain.lists, lengths, *reach, *seen, felt
        )
        return walls[felt], lengths

    @property
    def longest(self) -> int:
        """Entries of the longest row when nothing rests."""
        return int(self._rows.lengths[: self.store.owned].max(initial=0))

    @property
    def _kinds(self) -> tuple:
        """What the loops read of a particle but its place."""
        s = self.store
        return s.group, self._serves, s[self.effect.told_by], s[self.effect.marks.name]

    def _mark(self, walls: np.ndarray) -> None:
        s, reach = self.store, (self.reach.support, self.domain.periods)
        rest = s.low, self.domain.lists, self._rows, *reach, s["position"], *self._kinds
        in_threads(self._mark_wet, 0, len(walls), walls, *rest)

    def _each(self, loop, *args) -> None:
        s = self.store
        in_threads(loop, s.low, s.low + s.owned, s.low, self.domain.lists, *args)
