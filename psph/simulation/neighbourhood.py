"""Who is near whom on a rank, and for how long the lists of that hold."""

from collections.abc import Iterable, Iterator

import numpy as np

from psph.composition.mirrors import with_own_rows
from psph.composition.reflections import moved
from psph.fields import APART, WALL
from psph.parallel.arrivals import Arrivals
from psph.parallel.domain import Domain, Extent, Travels
from psph.parallel.skin import Bounds, Skin, Unlisted
from psph.parallel.straying import Straying
from psph.particles.apart import part
from psph.particles.neighbours import Neighbours, empty
from psph.particles.planes import bring_back, check_apart
from psph.particles.reach import Reach
from psph.particles.store import Store
from psph.simulation.midway import COMING
from psph.simulation.passes import Pass
from psph.simulation.plan import Plan
from psph.simulation.wetting import Wetting
from psph.work import Work


class Neighbourhood:
    """The neighbours of the particles of ``store``, of several sorts, as ``plan`` asks for them.

    Ordinary pairs stand in the lists of ``domain``.  Particles that are apart (psph.particles.apart)
    have lists of their own, images in mirrors come after the entries of all, and rows of dry walls rest.
    Lists are made anew by :meth:`update` once they are no longer :meth:`valid`; in between all is read as it
    stands.  ``domain`` also has the ghosts.
    """

    def __init__(self, scene, plan: Plan, store: Store, comm):
        layout = scene.layout
        self.plan, self.store = plan, store
        self.planes, self.mirrors = plan.planes, plan.mirrors
        self.domain = Domain(
            comm,
            store,
            Extent(layout.axis, layout.lower, layout.upper, layout.periods),
            layout.reach.cutoff,
            Travels(plan.ghost_fields, plan.refreshed, _sought(scene, plan), plan.sizes),
            plan.space.lanes if plan.passes else None,
        )
        self.skin = self._skin(layout.reach)
        self.wetting = [Wetting(one, plan, store, self.domain, layout.reach) for one in plan.marking]
        self._apart = empty(0, 0)
        self._mirrors, self._lists = self.mirrors, self._apart
        self._columns: dict[tuple[float, ...], tuple[int, int]] = {}
        self.fit()

    def _skin(self, reach: Reach) -> Skin | Straying | Unlisted:
        """What tells how long lists hold that reach so far where sizes are the same."""
        if not self.plan.passes:
            return Unlisted()
        if self.plan.sizes is not None:
            return Straying(self.domain, self.plan.sizes, self.planes)
        bounds, self.domain.reach = None, reach.support + reach.first
        if reach.least is not None:
            passes = 1 if self.plan.midway is None else 2
            bounds = Bounds(reach.least, reach.skin, reach.support, self.store.dimensions, passes)
        known = self.domain, reach.first, self.plan.planes, bounds
        return Skin(*known) if self.plan.midway is None else Arrivals(*known, COMING.name)

    def valid(self, dt: float, speed: float, acceleration: float, shift: float) -> bool:
        """Whether the lists hold to the end of a step of ``dt`` s, by the largest speed, m/s, acceleration,
        m/s², and speed of a shift, m/s, of all ranks; collective where it must measure.  Asked before a step
        of one pass, and at the middle of one of two."""
        return self.skin.holds(dt, speed, acceleration, shift)

    def update(self, spent: float, kinds: Iterable[Work]) -> None:
        """Put every particle where it belongs and list its neighbours; collective.

        ``spent`` are the seconds that this rank's pairs took since it was last done, by which slabs are cut;
        ``kinds`` of matter take out what is not to be met.
        """
        bring_back(self.store, self.planes, self.plan.materials.free)
        self.skin.choose()
        self.domain.rebuild(spent)
        self.sort_out(kinds)
        self.skin.renew()

    def take_up(self, lower, upper, state) -> None:
        """List them where they stand, in the domain of an earlier run between these corners, m, as far as it
        did in this ``state`` of its lists."""
        self.skin.reach_as(state)
        self.domain.relist(lower, upper)

    def sort_out(self, kinds: Iterable[Work]) -> None:
        """New lists name everyone: part what is apart, take out what rests and what is not to be met."""
        self._columns.clear()
        if APART.name in self.store and self.plan.passes:
            apart = self.store[APART.name] > 0.0
            self._apart = part(self.domain.lists, self.store, apart, self.plan.space.lanes)
        for kind in kinds:
            kind.listed()
        for wetting in self.wetting:
            wetting.settle()
        self.fit()

    def move_mirrors(self, time: float) -> None:
        """Those that move stand where they are at a ``time``, s; raises TooLarge where two come too near."""
        if not any(plane.motion for plane in self.plan.planes):
            return
        self.planes = tuple(plane.then(time) for plane in self.plan.planes)
        check_apart(self.planes, self.domain.cutoff)
        self.mirrors = moved(self.plan.mirrors, self.planes)
        self._mirrors = self._mirrors._replace(reflections=self.mirrors.reflections)

    def fit(self) -> None:
        """Room for the images of every particle behind the entries of the lists."""
        self.meet(self.domain.lists)

    def meet(self, rows: Neighbours) -> None:
        """Passes that are not across go through these ``rows``."""
        mirrors = self.mirrors
        if mirrors is not None and self.plan.sizes is not None:
            mirrors = mirrors._replace(reach=self.domain.cutoff)
        self._mirrors, self._lists = with_own_rows(mirrors, self.store.total, rows)

    def begin(self) -> None:
        """Which walls are dry at the start; lists are there."""
        for wetting in self.wetting:
            wetting.begin()

    def mark(self) -> None:
        """Which walls are dry by the places of this step."""
        for wetting in self.wetting:
            wetting.mark()

    def of(self, one: Pass) -> tuple[Neighbours, object]:
        """The lists that a pass goes through, and the mirrors in which it looks at them once more."""
        return (self._apart, None) if one.across else (self._lists, self._mirrors)

    @property
    def reach(self) -> float:
        """How far a point sees particles, m, at the most."""
        kernel = self.plan.kernel
        return kernel.support / kernel.inverse_h if self.plan.sizes is None else self.domain.cutoff

    def columns_near(self, point, radius: float) -> tuple[int, int]:
        """The first owned column, and that after the last, between which all stand that are now within
        ``radius`` m of a ``point`` (dim,) m, among others."""
        return self.columns_across(point[self.domain.axis], radius)

    def columns_across(self, place: float, reach: float) -> tuple[int, int]:
        """The same of all that are now within ``reach`` m of a ``place`` m along the slab axis."""
        seen = (place, reach)
        if seen not in self._columns:
            self._columns[seen] = self.domain.columns_near(place, reach + self.skin.farthest)
        return self._columns[seen]

    def dry_beside_fluid(self, first: int, last: int) -> Iterator[tuple[np.ndarray, Neighbours]]:
        """The columns from ``first`` to ``last`` of dry walls whose load is asked for, and lists with their
        rows."""
        for wetting in self.wetting:
            columns, lengths = wetting.dry_beside_fluid(first, last)
            if len(columns):
                yield columns, self._lists._replace(lengths=lengths)

    @property
    def longest(self) -> int:
        """Entries of the longest row when nothing rests."""
        kept = (self.domain.lists, self._apart)
        listed = [int(lists.lengths[: self.store.owned].max(initial=0)) for lists in kept]
        return max([*listed, *(wetting.longest for wetting in self.wetting)])

    @property
    def arrays(self) -> tuple[np.ndarray, ...]:
        """All lists as they are held."""
        return (*self.domain.lists, *self._apart)

    def state(self) -> dict[str, float | None]:
        """What :meth:`valid` rests on beside the particles."""
        return self.skin.state()

    def restore(self, state: dict[str, float | None]) -> None:
        """Go on as if the lists had been in use since they were made."""
        self.skin.restore(state)


def _sought(scene, plan: Plan) -> str | None:
    """The field that tells those whom walls and rigid bodies look for: fluids, where there is nothing else
    and they rest while none is near."""
    walls = all(one.is_fluid or one.kind == WALL for one in scene.species)
    return next((one.told_by for one in plan.marking), None) if walls else None
