"""The compiled loops of a pass: one over all particles, or one for each sort of them whose sums differ."""

from collections.abc import Iterator

from psph.composition.loads import Among, Couple, Loads, Unloaded
from psph.engine.settled import Settled, settled
from psph.fields import HELD_ACCELERATION
from psph.particles.store import Store
from psph.physics.motion import COUPLE, HELD_COUPLE, LOAD
from psph.simulation.pairs import Summed, Sums, sum_over_neighbours
from psph.simulation.passes import HELD, Pass
from psph.simulation.plan import Plan

NONE = (None, None)
"""The arrays of a pass without rates."""


class PairLoops:
    """What the passes of a ``plan`` run over the particles of a ``store``: loops, each with its arguments.

    ``kinds`` of matter may have loops of their own in the place of these.
    """

    def __init__(self, plan: Plan, store: Store, kinds: tuple):
        self.plan, self.store, self.kinds = plan, store, kinds
        self._all, self._loaded, self._driven = (
            [settled(sum_over_neighbours) for _ in plan.passes] for _ in range(3)
        )

    def of(self, one: Pass, seen: tuple) -> Iterator[tuple[Settled, tuple]]:
        """The loops of a pass, each with what it takes beside the columns; ``seen`` are the metric, the view
        of a particle and its neighbours."""
        sums = self._sums(one)
        parted = (kind.loops(one, self._all[one.place], seen, sums) for kind in self.kinds)
        if own := next(filter(None, parted), None):
            yield from own
            return
        rest = Unloaded(self._groups.driven, self.store.group) if one.free_only else None
        effects = one.effects
        if one.differs_on_driven:
            effects, rest = one.on_free, Unloaded(self._groups.driven, self.store.group)
            summed = Summed(one.effects, one.reductions, Among(*rest))
            yield self._driven[one.place], (summed, *seen, sums)
        if one.gives_rates and not one.midway and self._groups.loaded is not None:
            rest = rest or Unloaded(self._groups.loaded, self.store.group)
            yield self._loaded[one.place], self._loads(one, seen, sums)
        yield self._all[one.place], (Summed(effects, one.reductions, rest), *seen, sums)

    @property
    def _groups(self):
        return self.plan.materials

    def _sums(self, one: Pass) -> Sums:
        """Where the sums of a pass go."""
        s = self.store
        rates = [s[name] if name in s else None for name in one.gives] or NONE
        last = one.gives_rates and not one.holds
        held = [s[name] if last and own and name in s else None for name, own in zip(HELD, one.gives)] or NONE
        return Sums(*rates, tuple(map(s.arrays_of, one.stores)), *held)

    def _loads(self, one: Pass, seen: tuple, sums: Sums) -> tuple:
        """What the loop takes that sums what the fluid alone does to who is loaded."""
        s = self.store
        reductions, written = ((), ()) if one.free_only else (one.reductions, sums.written)
        couple = HELD_COUPLE.name if one.holds else COUPLE.name
        if couple in s and self.plan.loads is Loads:
            reductions, written = (*reductions, Couple(one.effects)), (*written, s[couple])
        summed = Summed(one.effects, reductions, self.plan.loads(self._groups.loaded, s.group))
        pushed = s[HELD_ACCELERATION.name if one.holds else LOAD.name]
        return summed, *seen, sums._replace(acceleration=pushed, written=written)
