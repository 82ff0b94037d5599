"""Contacts of elastic solids in a fluid: a pass over the solids alone, within their own steps."""

import numpy as np

from psph.composition import terms
from psph.composition.loads import Pushes
from psph.composition.pair import take
from psph.composition.space import softening
from psph.engine.jit import elementwise
from psph.engine.settled import settled
from psph.engine.threads import in_threads
from psph.fields import FLUID
from psph.particles.neighbours import Neighbours
from psph.particles.others import Others
from psph.particles.records import Records
from psph.physics.solid.contact import MET
from psph.simulation.pairs import Around, Metric, Summed, Sums, sum_over_neighbours
from psph.simulation.solid_plan import TRUE_MASS
from psph.vectors import add, at, put


class WetContact:
    """The pass ``plan.met`` over the solids, bodies and walls of a rank: what they do to each other.

    The lists of the fluid name their neighbours too, farther than contacts reach; from these come lists of
    their own.  Fluid between two solids is not asked: it acts on both by its own pressure.
    """

    def __init__(self, scene, plan, store, domain, ledger):
        self._plan, self._store, self._domain, self._ledger = plan, store, domain, ledger
        self._records = Records(store, plan.met.neighbour_fields, plan.space, TRUE_MASS)
        self._due = np.array([kind != FLUID for kind in plan.materials.kinds], bool)
        self._others = Others(one.solid for one in scene.species if one.bonded is not None)
        self._sum, self._begin = settled(sum_over_neighbours), settled(begin)
        self._sent = tuple(name for name in plan.met.neighbour_fields if name not in plan.ghost_fields)
        self.lists: Neighbours = domain.lists

    def settle(self) -> None:
        """Room for the records, and lists of what may touch."""
        s = self._store
        self._records.make_room()
        self.lists = self._others.beside(
            s.low, s.owned, self._domain.lists, s["solid"], self._plan.space.lanes
        )
        longest = int(self.lists.lengths.max(initial=0))
        self._softening = softening(self._plan.space, self._plan.smoothing_length, longest)

    def sum(self) -> None:
        """What contacts do to each particle where it stands, m/s², and the sums beside it; collective."""
        s, met = self._store, self._plan.met
        with self._ledger("halo"):
            self._domain.halo.refresh(self._sent)
        with self._ledger("records"):
            self._records.fill(0, s.total)
        with self._ledger("pairs"):
            true = s.view()._replace(**{name: s[of] for name, of in TRUE_MASS.items()})
            around = Around(self._records.view(), self._records.table, s.low, self.lists, None)
            metric = Metric(self._plan.kernel, self._plan.space, self._softening)
            summed = Summed(met.effects, met.reductions, Pushes(self._due, s.group))
            sums = Sums(s[MET.name], None, tuple(map(s.arrays_of, met.stores)))
            in_threads(self._sum, s.low, s.low + s.owned, summed, metric, true, around, sums)

    def begin_forces(self, columns: np.ndarray) -> None:
        """The acceleration of the particles in ``columns`` by contacts and body forces."""
        s = self._store
        arrays = s[MET.name], s["acceleration"]
        in_threads(self._begin, 0, len(columns), columns, self._plan.pulls.bonded, s.view(), *arrays)

    def bytes_held(self) -> int:
        """Bytes of records and lists."""
        return self._records.table.nbytes + sum(array.nbytes for array in self.lists)


@elementwise
def begin(first, last, columns, effects, view, met, acceleration):
    """a = b + c of some ``columns``: the body forces of ``effects``, and contacts."""
    for k in range(np.uint64(first), np.uint64(last)):
        c = columns[k]
        put(acceleration, c, add(terms.body(effects, take(view, c)), at(met, c)))
