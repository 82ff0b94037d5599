"""The simulation of one rank, and its step."""

from collections.abc import Callable, Iterable

import numpy as np

from psph.case.consistency import LARGEST_LOSS
from psph.errors import Unbearable
from psph.output.ledger import Ledger
from psph.particles.store import Store
from psph.simulation.cpu import Engine
from psph.simulation.impacts import Impacts
from psph.simulation.passes import Pass
from psph.simulation.plan import Plan
from psph.simulation.population import Population
from psph.simulation.stages import stages_of

TOO_FAST = 100.0
"""A particle at this many speeds of sound is a run that blew up, whatever the case allows, but
where matter is soft (psph.kinds.Kind.is_stiff)."""

CLOCK = (
    "time",
    "dt",
    "steps",
    "limited_by",
    "speed",
    "fluid_speed",
    "previous_speed",
    "acceleration",
    "shift",
    "energy_at_start",
)
"""Numbers of a simulation that its next step reads, or its user."""


class BlowUp(Unbearable):
    """A run in trouble, on whatever rank; raised on all."""


class ParticleLost(BlowUp):
    """A run that a guard ended because fluid is behind a wall or has left all walls; raised on all."""


class TimeLost(BlowUp):
    """A time step so short that the time cannot tell it; raised on all ranks before the step."""


class Simulation:
    """Particles, domain and clock; ``step`` advances them.

    ``store`` holds this rank's particles as created, anywhere; ``comm`` the ranks that share the scene.
    ``time`` in s, ``dt`` the last step, ``whole`` where it ends one of the coarsest level of sizes. Over
    all ranks ``speed`` is the largest in m/s of all that moves, ``fluid_speed`` that of the fluid, and
    ``strain`` its largest |ρ/ρ₀ − 1| after the last step, infinite where a number is not finite.
    ``request`` is asked at the end of each step for a number from 0 on that a rank wants all others to
    know; ``requested`` is the largest of them, the same on every rank.
    With ``saved`` it goes on from a checkpoint (psph.runs.resume), whose particles ``store``
    holds where the lists were made.
    """

    engine_type = Engine
    """What advances and sums particles."""

    def __init__(self, scene, plan: Plan, store: Store, comm, ledger: Ledger, saved=None):
        self.plan, self.store, self.comm, self.ledger = plan, store, comm, ledger
        self.engine = self.engine_type(scene, plan, store, comm, ledger)
        self.domain, self.neighbourhood = self.engine.domain, self.engine.neighbourhood
        self.population = Population(scene, plan, self.domain)
        self.impacts = Impacts(plan.extremes.sound_speed**2 / plan.smoothing_length)
        self.stages = tuple(stages_of(plan))
        self.time, self.then, self.dt, self.steps, self.parts = 0.0, 0.0, 0.0, 0, 0
        self.listed, self.whole = False, True
        self.speed, self.fluid_speed, self.previous_speed, self.strain = 0.0, 0.0, 0.0, 0.0
        self.acceleration = self.shift = self.jolt = 0.0
        self.energy_at_start: float | None = None
        self.limited_by = ""
        self.request: Callable[[], float] = float
        self.requested = 0.0
        if saved is None:
            self._start()
        else:
            self._restore(saved)
        self.engine.spent_on_pairs()  # the first passes may have loaded compiled loops

    def step(self, end: float = np.inf) -> None:
        """Advance by one time step, or where particles have steps of their own by one of the longest, in so
        many ``parts``; the last one before ``end`` (s) ends exactly there."""
        whole, self.limited_by, then = self._next_step(end)
        self.parts = 0
        for dt, left in self.engine.parts(whole):
            self._advance(dt, left, then)
            self.parts += 1

    def _advance(self, dt: float, left: bool, end: float) -> None:
        """A step of ``dt`` s, before others that are ``left`` to an ``end``, or to it."""
        self._refuse_lost(dt)
        self.dt, self.then, self.whole = dt, self.time + dt if left else end, not left
        with self.ledger("skin"):
            self.jolt = self.engine.poses.advance(self.then, self.dt)
            self.listed = self.plan.midway is not None or self.hold(self.dt)
        for stage in self.stages:
            stage.run(self)
        self.time = self.then
        self.steps += 1
        self._refuse_blow_up()

    def passed(self, every: int) -> bool:
        """Whether the last :meth:`step` has brought the steps to a multiple of ``every``, or past one."""
        return self.steps % every < self.parts

    def is_due(self, one: Pass) -> bool:
        """Whether a pass runs in this step: as all do, or as a kind of matter says."""
        told = (kind.is_due(one) for kind in self.engine.kinds)
        usual = one.due(self.steps) or self.impacts.lasts and one.slow
        return next((due for due in told if due is not None), usual)

    def hold(self, dt: float) -> bool:
        """Whether the lists hold ``dt`` s longer; collective."""
        return self.neighbourhood.valid(dt, self.speed, max(self.acceleration, self.jolt), self.shift)

    def rebuild(self) -> None:
        """Put every particle where it belongs and list its neighbours; collective."""
        self.engine.rebuild()

    def state(self) -> dict:
        """All that the next steps rest on but for the numbers of the particles."""
        numbers = {name: getattr(self, name) for name in CLOCK}
        corners = {"lower": self.domain.lower, "upper": self.domain.upper}
        rest = {
            "skin": self.neighbourhood.state(),
            "population": self.population.state(),
            "impacts": self.impacts.state(),
            "poses": self.engine.state(),
        }
        return numbers | corners | rest

    def bytes_held(self) -> int:
        """Bytes of this rank's particles, records and lists."""
        return self.engine.bytes_held()

    def settle_pressure(self, ranges: Iterable[tuple[int, int]] | None = None) -> None:
        """Pressure and 1/ρ at the end of the step, for whoever reads them, of some
        ``ranges`` of columns, from one to before another, or of all."""
        self.engine.settle_pressure(self.previous_speed, ranges)

    def _start(self) -> None:
        """First forces, from particles at rest in time: predicted is initial."""
        for stage in self.stages:
            stage.begin(self)
        self._refuse_blow_up()

    def _restore(self, saved) -> None:
        """Everything as it was when ``saved`` was written."""
        self.engine.take_up(saved)
        for name in CLOCK:
            setattr(self, name, saved.state[name])
        self.population.restore(saved.state["population"])
        self.impacts.restore(saved.state["impacts"])

    def _next_step(self, end: float) -> tuple[float, str, float]:
        """Δt in s, of the coarsest level, the name of the limit that sets it, and the time after the step.

        Where less than two of the longest steps are left, two equal ones follow, or one that is as
        long as what is left: so no step is shorter than half of its limit.
        """
        dt, limited_by = self.plan.longest_step(self.speed, self.acceleration)
        dt *= self.plan.pace
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
        elif self.plan.is_stiff and self.fluid_speed > TOO_FAST * self.plan.extremes.sound_speed:
            what = f"a particle moves at {self.fluid_speed:.3g} m/s, over {TOO_FAST:g} speeds of sound"
        else:
            return
        raise BlowUp(f"the run blew up at step {self.steps}, time {self.time:.6g} s: {what}")
