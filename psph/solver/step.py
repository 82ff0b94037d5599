"""The simulation of one rank, and its step."""

from collections.abc import Callable

import numpy as np

from psph.case.consistency import LARGEST_LOSS
from psph.errors import Failed
from psph.output.ledger import Ledger
from psph.parallel.domain import Domain
from psph.parallel.reductions import largest
from psph.parallel.skin import Skin
from psph.particles.records import Records
from psph.particles.store import Store
from psph.particles.wetting import mark_wet
from psph.physics.space import softening
from psph.solver.integrator import kick, kick_drift_predict, state_of
from psph.solver.pairs import sum_over_neighbours
from psph.solver.plan import Plan
from psph.threads import in_threads

TOO_FAST = 100.0
"""A particle at this many speeds of sound is a run that blew up, whatever the case allows."""

CLOCK = (
    "time", "dt", "steps", "limited_by", "speed", "pace", "acceleration", "shift",
    "energy_at_start",
)
"""Numbers of a simulation that its next step reads, or its user."""


class BlowUp(Failed):
    """A run in trouble, on whatever rank; raised on all."""


class TimeLost(BlowUp):
    """A time step so short that the time cannot tell it; raised on all ranks before the step."""


class Simulation:
    """Particles, domain and clock; ``step`` advances them.

    ``store`` holds this rank's particles as created, anywhere; ``comm`` the ranks that share the
    scene.  ``time`` in s, ``dt`` the last step.  Over all ranks ``speed`` is the largest in m/s and
    ``strain`` the largest |ρ/ρ₀ − 1| of the fluid after the last step, infinite where a number is
    not finite.  ``word`` is asked at the end of each step for a number from 0 on that a rank wants
    all others to know; ``heard`` is the largest of them, the same on every rank.
    With ``saved`` it goes on from a checkpoint (psph.solver.resume), whose particles ``store``
    holds where the lists were made.
    """

    def __init__(self, scene, plan: Plan, store: Store, comm, ledger: Ledger, saved=None):
        self.plan, self.store, self.comm, self.ledger = plan, store, comm, ledger
        support = self.support = scene.kernel.support * scene.smoothing_length
        skin = scene.case.neighbours.skin * support
        self.domain = Domain(
            comm, store, scene.axis, support + skin, scene.lower, scene.upper,
            scene.periods, plan.ghost_fields, plan.refreshed, plan.space.lanes,
        )
        self.skin = Skin(self.domain, skin)
        self.records = Records(store, plan.neighbour_fields, plan.space)
        self.time, self.dt, self.steps = 0.0, 0.0, 0
        self.speed, self.pace, self.strain = 0.0, 0.0, 0.0
        self.energy_at_start: float | None = None
        self.limited_by = ""
        self.word: Callable[[], float] = float
        self.heard = 0.0
        self._paid = 0.0
        if saved is None:
            self._start()
        else:
            self._restore(saved)
        self._spent_on_pairs()  # the first passes may have loaded compiled loops

    def step(self, end: float = np.inf) -> None:
        """Advance by one time step; the last one before ``end`` (s) ends exactly there."""
        dt, limited_by, then = self._next_step(end)
        self._refuse_lost(dt)
        self.dt, self.limited_by = dt, limited_by
        with self.ledger("skin"):
            listed = self.skin.holds(self.dt, self.speed, self.acceleration, self.shift)
        with self.ledger("kick, drift, predict"):
            self._predict(self.dt)
        if listed:
            self._forces_while_refreshing()
        else:
            self._rebuild()
            self._forces()
        with self.ledger("kick"):
            self._kick(self.dt)
        self.time = then
        self.steps += 1
        self._refuse_blow_up()

    def state(self) -> dict:
        """All that the next steps rest on but for the numbers of the particles."""
        numbers = {name: getattr(self, name) for name in CLOCK}
        corners = {"lower": self.domain.lower, "upper": self.domain.upper}
        return numbers | corners | {"skin": self.skin.state()}

    def bytes_held(self) -> int:
        """Bytes of this rank's particles, records and lists."""
        arrays = (self.store.data, self.store.id, self.store.kind, self.records.table)
        return sum(a.nbytes for a in (*arrays, *self.domain.lists))

    def settle_pressure(self) -> None:
        """Pressure and 1/ρ from the density at the end of the step, for whoever reads them."""
        s = self.store
        state_of(
            s.low, s.low + s.owned, self.plan.carriers, self.plan.state, self._view(), s.kind,
            s["density"], s["specific_volume"], s["pressure"],
        )

    def _start(self) -> None:
        """First forces, from particles at rest in time: predicted is initial."""
        self._predict(0.0)
        self._rebuild()
        self._forces()
        if self.plan.starts_twice:  # its first verdict comes with the first sums
            self._kick(0.0)
            self._predict(0.0)
            self._forces_while_refreshing()
        for older in ("density_rate_1", "density_rate_2"):
            self.store[older][:] = self.store["density_rate"]
        self._kick(0.0)
        self._refuse_blow_up()

    def _restore(self, saved) -> None:
        """The lists as they were made, then everything as it was when ``saved`` was written."""
        state = saved.state
        self.domain.relist(state["lower"], state["upper"])
        saved.fill(self.store)
        self.domain.halo.refresh(self.domain.ghost_fields + self.plan.refreshed)
        self._fill_records()
        for name in CLOCK:
            setattr(self, name, state[name])
        self.skin.restore(state["skin"])

    def _rebuild(self) -> None:
        with self.ledger("rebuild"):
            self.domain.rebuild(self._spent_on_pairs())
            for effect in self.plan.marking:
                self._mark(effect)
        self.skin.renew()

    def _mark(self, effect) -> None:
        """Which walls have fluid in reach."""
        s, lists = self.store, self.domain.lists
        in_threads(
            mark_wet, s.low, s.low + s.owned, s.low, *lists, self.support**2, self.domain.periods,
            s["position"], s[effect.told_by], s[effect.marks],
        )

    def _spent_on_pairs(self) -> float:
        """Seconds of this rank's pair loop since this was last asked."""
        paid, self._paid = self._paid, self.ledger.seconds["pairs"]
        return max(self._paid - paid, 0.0)  # whoever holds the ledger may have cleared it

    def _forces(self) -> None:
        with self.ledger("records"):
            self._fill_records()
        with self.ledger("pairs"):
            self._sum(self.store.low, self.store.low + self.store.owned)

    def _fill_records(self) -> None:
        """What the pair loop reads, for new lists."""
        self.records.fill_all()
        plan, rows = self.plan, self.domain.lists.lengths[: self.store.owned]
        longest = int(rows.max(initial=0))
        self.softening = softening(plan.space, plan.smoothing_length, longest)

    def _forces_while_refreshing(self) -> None:
        """Interior particles are computed while the halo travels, then the rim."""
        first, last = self.domain.interior()
        halo, fields = self.domain.halo, self.plan.refreshed
        begin, end = self.store.low, self.store.low + self.store.owned
        with self.ledger("halo"):
            halo.start(fields)
        with self.ledger("records"):
            self.records.fill(begin, end)
        with self.ledger("pairs"):
            self._sum(first, last)
        with self.ledger("halo"):
            halo.finish(fields)
        with self.ledger("records"):
            self.records.fill(0, begin)
            self.records.fill(end, self.store.total)
        with self.ledger("pairs"):
            self._sum(begin, first)
            self._sum(last, end)

    def _predict(self, dt: float) -> None:
        s, plan = self.store, self.plan
        in_threads(
            kick_drift_predict, s.low, s.low + s.owned, dt, plan.carriers, plan.state, self._view(),
            s.kind,
            s["position"], s["velocity"], s["predicted_velocity"], s["acceleration"],
            s["density"], s["density_rate"], s["density_rate_1"], s["density_rate_2"],
            s["specific_volume"], s["pressure"],
        )
        s.rotate("density_rate", "density_rate_1", "density_rate_2")

    def _sum(self, first: int, last: int) -> None:
        if first == last:
            return
        s, plan, lists = self.store, self.plan, self.domain.lists
        written = tuple(s[e.writes] if hasattr(e, "writes") else None for e in plan.reductions)
        in_threads(
            sum_over_neighbours, first, last, plan.effects, plan.reductions, plan.kernel,
            plan.space, self.softening, s.view(), self.records.view(), self.records.table, s.low,
            lists.begin, lists.lengths, lists.lists, s["acceleration"], s["density_rate"], written,
        )

    def _kick(self, dt: float) -> None:
        """Second kick; then the largest speed, acceleration, strain, word and shift over all ranks."""
        s = self.store
        self.pace = self.speed  # the shifts of the next step are bounded before its speed is known
        parts = in_threads(
            kick, s.low, s.low + s.owned, dt, self.plan.carriers, self._view(), s.kind,
            s["position"], s["velocity"], s["acceleration"], s["density"], s["density_rate"],
        )
        *mine, shift2 = np.max(parts, axis=0)
        with self.ledger("limits"):
            sent = [*mine, self.word(), *([shift2] if self.plan.displaces else [])]
            extremes = largest(self.comm, sent)
        self.speed, self.acceleration = np.sqrt(extremes[:2]).tolist()
        self.strain, self.heard = extremes[2:4].tolist()
        self.shift = float(np.sqrt(extremes[4:]).sum())

    def _view(self):
        """The particles as the plan's carriers see them; a displacement also sees the pace."""
        changed = self.plan.uncarried
        if "largest_speed" not in changed:
            changed = changed | {"largest_speed": self.pace}
        return self.store.view()._replace(**changed)

    def _next_step(self, end: float) -> tuple[float, str, float]:
        """Δt in s, the name of the limit that sets it, and the time after the step.

        Where less than two of the longest steps are left, two equal ones follow, or one that is as
        long as what is left: so no step is shorter than half of its limit.
        """
        dt, limited_by = self.plan.longest_step(self.speed, self.acceleration)
        left = end - self.time
        if left >= 2.0 * dt:
            return dt, limited_by, self.time + dt
        if left > (1.0 + LARGEST_LOSS) * dt:  # more than the rounding of many equal steps
            return 0.5 * left, "time.end", self.time + 0.5 * left
        return left, "time.end", end

    def _refuse_lost(self, dt: float) -> None:
        """Raise TimeLost where rounding would make the time go on by another step than this."""
        told = (self.time + dt) - self.time
        if not abs(told - dt) < LARGEST_LOSS * dt:  # true for a step of zero too
            raise TimeLost(
                f"the run stands still at step {self.steps}, time {self.time:.6g} s: a step of "
                f"{dt:.3g} s is lost in the rounding of the time"
            )

    def _refuse_blow_up(self) -> None:
        """Raise BlowUp where no step can follow: the extremes are the same on every rank."""
        if not self.strain < np.inf:
            what = "a position, velocity or density is not finite"
        elif self.speed > TOO_FAST * self.plan.constants["sound_speed"]:
            what = f"a particle moves at {self.speed:.3g} m/s, over {TOO_FAST:g} speeds of sound"
        else:
            return
        raise BlowUp(f"the run blew up at step {self.steps}, time {self.time:.6g} s: {what}")
