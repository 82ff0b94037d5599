"""Who passes through an open end, and who is born and dies behind it, the same on any number of ranks."""

import numpy as np

from psph.engine.settled import settled
from psph.fields import FLUID
from psph.parallel.reductions import all_rows, exact_sums, whole_sums
from psph.scene.ends import BEYOND, EndFace
from psph.simulation.end_levels import EndLevel, fit_rows
from psph.simulation.end_queues import DIES, run_queues
from psph.simulation.end_state import Books, EndState
from psph.work import Rank

ALIKE = 1e-6
"""Spacings by which depths differ that count as one."""


def within(face: EndFace, domain, rows: np.ndarray, places: str = "position") -> np.ndarray:
    """Those of some ``rows`` of owned particles whose ``places`` are between the sides of an end."""
    keep = np.ones(len(rows), bool)
    for d, x in enumerate(domain.inside(domain.store.shown(places)[rows]).T):
        if d != face.axis:
            keep &= (x >= face.lower[d]) & (x < face.upper[d])
    return rows[keep]


class Passage:
    """The particles of a ``domain`` that pass through an open end: those of the buffer of ``face`` become
    fluid where they have come in, fluid of the buffer where it has gone out, by queues
    (psph.simulation.end_queues)."""

    def __init__(self, face: EndFace, rank: Rank):
        self.face, self.domain, self.store = face, rank.domain, rank.domain.store
        self.gravity = np.array(rank.scene.gravity)
        self._queue = settled(run_queues)

    def renew(self, state: EndState, time: float, population) -> None:
        """Let particles change sides, be born and die behind the plane at a ``time`` in s; new lists have to
        follow.  Collective."""
        store, face = self.store, self.face
        plane = face.ride.place(time)
        behind = np.flatnonzero(store.of_groups(face.groups))
        depth = face.depth(store["position"][face.axis][store.inner], plane)
        deepest = (face.layers + BEYOND) * face.spacing
        fluid = (store.shown("kind") == FLUID) & (depth > 0.0) & (depth < deepest)
        out = within(face, self.domain, np.flatnonzero(fluid))
        rows = np.concatenate([behind, out])
        crossing = np.concatenate([(depth[behind] <= 0.0).astype(np.int64), np.full(len(out), -1)])
        fate, born, place, births, sites = self._queued(plane, rows, depth[rows], crossing, state.surface)
        self._book(state.books, rows, crossing, births + len(sites), fate == DIES)
        newborn = self._copied(plane, rows[born > 0.0], born[born > 0.0])
        self._change(rows[crossing == 1], rows[crossing == -1])
        staying = np.delete(np.arange(store.owned), rows[fate == DIES])
        store.reorder((store.low + staying).astype(np.uint32), 0, 0)
        store.append(population.next_id + place, *newborn)
        population.next_id += births
        if len(sites):
            velocity = np.zeros_like(sites)
            velocity[:, face.axis] = face.sign * max(state.means.speed, face.pace(time))
            population.let_in(sites, velocity, face.surface.group)

    def _queued(self, plane, rows, depth, crossing, surface: EndLevel | None):
        """Fates (n,), depths of births (n,), 0 for none, the places (births here,) of these among all, how
        many these are, and the places (m, dim), m, of those who are born as a level rises."""
        across = [d for d in range(self.store.dimensions) if d != self.face.axis]
        table = np.empty((len(rows), 3 + len(across)))
        table[:, 0] = self.store.shown("id")[rows]
        table[:, 1], table[:, 2] = depth, crossing
        table[:, 3:] = self.store.shown("position")[rows][:, across]
        everyone = all_rows(self.domain.comm, table)
        everyone = np.ascontiguousarray(everyone[np.argsort(everyone[:, 0])].T)
        fate, born = np.zeros(len(everyone.T), np.int64), np.zeros(len(everyone.T))
        periods = np.array([self.domain.periods[d] or 0.0 for d in across])
        who, size, layers = everyone[2].astype(np.int64), self.face.spacing, self.face.layers
        order = np.lexsort((everyone[0], np.rint(everyone[1] / (ALIKE * size))))
        self._queue(order, everyone[1], everyone[3:], periods, who, size, layers, fate, born)
        sites = np.zeros((0, self.store.dimensions))
        if surface is not None and surface.unfilled and surface.comes_in:
            standing = np.where(who == 1, born > 0.0, fate != DIES)
            if surface.turned:
                fate[standing & (who < 1)], born[:], standing[:] = DIES, 0.0, False
            deep = np.where(born > 0.0, born, everyone[1])
            surplus, sites = fit_rows(self.face, plane, surface.full, deep, everyone[3:], periods, standing)
            fate[surplus & (who < 1)], born[surplus] = DIES, 0.0
            surface.unfilled = surface.turned = False
        mine, comes = np.searchsorted(everyone[0], table[:, 0]), born > 0.0
        places = np.cumsum(comes) - 1
        return fate[mine], born[mine], places[mine][comes[mine]], int(np.count_nonzero(comes)), sites

    def _book(self, books: Books, rows, crossing, births: int, dies) -> None:
        comm = self.domain.comm
        came, went = crossing == 1, crossing == -1
        mass_in, mass_out, energy, momentum = self._carried(rows, came, went)
        numbers = np.count_nonzero([came, went, dies], axis=1)
        came_in, went_out, died = whole_sums(comm, numbers).tolist()
        books.number_in += came_in
        books.number_out += went_out
        books.mass_in += mass_in
        books.mass_out += mass_out
        books.energy += energy
        books.momentum += momentum
        books.born += births
        books.died += died

    def _carried(self, rows, came, went) -> list[float]:
        """Mass in and out, kg, energy of motion and height, J, and inward momentum, kg m/s, in less out."""
        store, net = self.store, came.astype(float) - went
        mass, v = store.shown("mass")[rows], store.shown("velocity")[rows]
        energy = 0.5 * (v * v).sum(axis=1) - self.domain.inside(store.shown("position")[rows]) @ self.gravity
        inward = self.face.sign * v[:, self.face.axis]
        carried = mass[:, None] * np.stack([came, went, net * energy, net * inward], axis=1)
        return exact_sums(self.domain.comm, carried).tolist()

    def _change(self, came: np.ndarray, went: np.ndarray) -> None:
        """Particles of some rows become fluid, or of the buffer."""
        store, low = self.store, self.store.low
        of_fluid, of_buffer = self.face.fluid_of, np.array(self.face.groups, np.uint8)
        store.group[low + came] = of_fluid[store.group[low + came]]
        store.group[low + went] = of_buffer[store.group[low + went]]

    def _copied(self, plane: float, parents: np.ndarray, depth: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Groups and numbers of those that are born at a ``depth`` (n,), m, as their ``parents`` are."""
        columns = self.store.low + parents
        block = self.store.data[:, columns].copy()
        block[self.store.rows["position"][self.face.axis]] = plane - self.face.sign * depth
        return self.store.group[columns].copy(), block
