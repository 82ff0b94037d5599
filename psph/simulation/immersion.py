"""Elastic solids in a fluid: steps of their own under its push, and what they show it.

To the fluid a solid's particles are those of a wall that moves: they have the mass of the fluid that they
displace, and a density that follows.  The push m_f a_f that they feel so, divided by their true mass, is held
during a step of the fluid, in which the solid makes as many steps as it needs (kick, drift, kick); then half
of it is taken back and half of the new one added.  So it gives in a step the mean of old and new push, as the
fluid gets, and the momentum of both together is kept to rounding.
O'Connor & Rogers (2021), J. Fluids Struct. 104, 103312; Zhang, Rezavand & Hu (2021), J. Comput. Phys.
429, 110028.

The fluid sees the velocity half-way between the mean of a step and that at its end: psph's own.  The mean
alone is half a step late, and feeds slow waves too; the end alone shows more of fast waves than they move.
What then still grows are waves that a step does not resolve; the viscosity of the solid calms them
(psph.physics.solid.material.calming_viscosity).
"""

import math
from collections.abc import Iterable

import numpy as np

from psph.composition import terms
from psph.composition.pair import take
from psph.engine.jit import elementwise
from psph.engine.settled import settled
from psph.engine.threads import in_threads
from psph.physics.motion import LOAD, WORK
from psph.physics.solid.deformation import INERTIA
from psph.physics.solid.motion import Immersed
from psph.simulation.solid_plan import solid_plan
from psph.simulation.wet_contact import WetContact
from psph.vectors import add, at, dot, put, scale
from psph.work import Work


def substeps(
    solids: Iterable, smoothing_length: float, dt: float, speed: float, contact: float = math.inf
) -> int:
    """How many steps of ``solids`` (psph.physics.solid.material) with the ``smoothing_length`` in m a step of
    ``dt`` s takes, at the largest ``speed`` in m/s: the same on every rank.  Contacts stand ``contact`` s."""
    longest = min(contact, *(one.longest_step(smoothing_length, speed) for one in solids))
    return max(1, math.ceil(dt / longest))


class Immersion(Work):
    """The motion of the ``solids`` of a rank (psph.simulation.solids) in the fluid of a ``scene``."""

    name = "immersion"

    def __init__(self, solids, scene, plan, store, domain, ledger):
        self.solids, self.plan, self.store = solids, plan, store
        self.contact = WetContact(scene, plan, store, domain, ledger) if solid_plan(plan).touching else None
        self._moves = plan.materials.where(lambda one: isinstance(one.motion, Immersed))
        self._drift, self._kick, self._show, self._book = map(settled, (drift, kick, show, book))

    def begin(self) -> None:
        """True masses, and the first inner forces; collective."""
        self.store[INERTIA.name][:] = self.store.view().mass
        self.solids.fill_masses(self.store[INERTIA.name])
        self._sum(0.0, 0.0)

    def advance(self, time: float, dt: float, speed: float) -> None:
        """From ``time`` − ``dt`` to ``time``, s, under the last push of the fluid; collective.

        ``speed`` is the largest of the fluid, m/s.
        """
        if not dt > 0.0:
            return
        plan, solids, own = self.plan, self.solids, solid_plan(self.plan)
        stands = own.solids, own.smoothing_length, dt, speed, own.contact_step
        count = substeps(*stands) if own.substeps else 1
        part, columns, seen = dt / count, self._columns, self._seen
        shown = tuple(np.zeros(len(columns)) for _ in range(self.store.dimensions))
        for n in range(1, count + 1):
            self._each(self._drift, columns, part, 1.0 / count, *seen, shown)
            if solids.clamps and count > 1:
                solids.clamps.carry(time - (count - n) * part)
            self._sum(time - dt + n * part, part)
            self._each(self._kick, columns, 0.5 * part, 0.5 * part, *seen)
            if booked := plan.pulls.booked_in_bonds:
                names = ("velocity", INERTIA.name, WORK.name)
                arrays = (self.store[name] for name in names)
                self._each(self._book, columns, part, booked, self.store.view(), *arrays)
        self._each(self._show, columns, self.store["velocity"], shown, self.store["predicted_velocity"])
        self._each(self._kick, columns, 0.0, -0.5 * dt, *seen)

    def kick(self, dt: float) -> tuple[float, ...]:
        """Half of the new push of the fluid; returns what psph.simulation.integrator.kick does, of solids."""
        extremes = self._each(self._kick, self._columns, 0.0, 0.5 * dt, *self._seen)
        fastest, strain = (max(of) for of in zip(*extremes)) if extremes else (0.0, 0.0)
        return 0.0, 0.0, strain, 0.0, fastest

    def listed(self) -> None:
        """Lists of what may touch."""
        if self.contact:
            self.contact.settle()

    def bytes_held(self) -> int:
        """Bytes of what finds contacts."""
        return self.contact.bytes_held() if self.contact else 0

    def _sum(self, time: float, dt: float) -> None:
        """All forces on solids but the push of the fluid, ``dt`` s after the last; collective."""
        if not self.contact:
            return self.solids.sum(time, dt)
        self.solids.strain(dt)
        self.contact.sum()
        self.contact.begin_forces(self.solids.columns)
        self.solids.push(time, dt)

    @property
    def _columns(self) -> np.ndarray:
        """Those of the particles that move."""
        columns = self.solids.columns
        return columns[self._moves[self.store.group[columns]]]

    @property
    def _seen(self) -> tuple:
        s = self.store
        names = ("position", "velocity", "predicted_velocity", "acceleration", LOAD.name, INERTIA.name)
        return s.view(), *(s[name] for name in names)

    def _each(self, loop, columns: np.ndarray, *args) -> list:
        return in_threads(loop, 0, len(columns), columns, *args) if len(columns) else []


@elementwise
def drift(
    first, last, columns, dt, share, view, position, velocity, predicted, acceleration, load, inertia, shown
):
    """Half a kick by all forces and a drift of ``dt`` s; a ``share`` of the velocity on the way goes to the
    mean that is ``shown`` to the fluid, and the velocity at the end is predicted."""
    for k in range(np.uint64(first), np.uint64(last)):
        c = columns[k]
        push = scale(at(load, c), take(view, c).mass / inertia[c])
        gained = scale(add(at(acceleration, c), push), 0.5 * dt)
        v = add(at(velocity, c), gained)
        put(velocity, c, v)
        put(position, c, add(at(position, c), scale(v, dt)))
        put(predicted, c, add(v, gained))
        put(shown, k, add(at(shown, k), scale(v, share)))


@elementwise
def kick(
    first, last, columns, own, by_fluid, view, position, velocity, predicted, acceleration, load, inertia
):
    """A kick of ``own`` s by inner forces, weight and loads and of ``by_fluid`` s by the push of the fluid.

    Returns the largest |v|², m²/s², and infinity where a number is not finite, else 0.
    """
    fastest = trouble = 0.0
    for k in range(np.uint64(first), np.uint64(last)):
        c = columns[k]
        a = at(acceleration, c)
        push = scale(at(load, c), take(view, c).mass / inertia[c])
        v = add(at(velocity, c), add(scale(a, own), scale(push, by_fluid)))
        put(velocity, c, v)
        x, v2 = at(position, c), dot(v, v)
        finite = v2 + dot(a, a) + dot(x, x) < np.inf  # false for NaN too
        fastest = max(fastest, v2 if finite else 0.0)
        trouble = max(trouble, 0.0 if finite else np.inf)
    return fastest, trouble


@elementwise
def book(first, last, columns, dt, effects, view, velocity, inertia, work):
    """Add m b·v dt, J, with the body forces b of ``effects`` that have no potential, m/s²."""
    for k in range(np.uint64(first), np.uint64(last)):
        c = columns[k]
        work[c] += dt * inertia[c] * dot(terms.body(effects, take(view, c)), at(velocity, c))


@elementwise
def show(first, last, columns, velocity, mean, predicted):
    """Let the fluid see what is half-way between the ``mean`` velocity of a step and that at its end, m/s."""
    for k in range(np.uint64(first), np.uint64(last)):
        c = columns[k]
        put(predicted, c, scale(add(at(mean, k), at(velocity, c)), 0.5))
