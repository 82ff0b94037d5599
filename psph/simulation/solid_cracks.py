"""The bonds of a rank's solids that are cut: where they are, and which are cut in a step."""

import numpy as np

from psph.composition.pair import take
from psph.engine.jit import compiled, elementwise
from psph.engine.settled import settled
from psph.engine.threads import in_threads
from psph.particles.partners import padded_lists
from psph.physics.solid.cracks import BITS, CUT, DAMAGE, FEWEST, FLATTEST, strengths
from psph.simulation.solid_plan import solid_plan
from psph.vectors import at, determinant, dot, nearest_image, subtract


class Cracks:
    """The cut bonds of the rows of solids (psph.simulation.solids) in a ``scene``.

    The bits of a row stand in its particle's field ``cut``; ``places`` (entries,) tell of each entry of the
    lists which bit is its.  Lists lose their cut entries, and a rebuild leaves these out again.  ``intact``
    (rows,) is the part of its bonds that each row has left.
    """

    def __init__(self, scene, plan, store):
        self.store, self.periods = store, scene.layout.periods
        self._solids = solid_plan(plan).solids
        self._seeds = [table.seed for table in scene.case.solids.values()]
        self._critical = np.array([one.critical_stretch for one in self._solids])
        self._cut, self._weaken = settled(cut_bonds), settled(weaken)

    def left(self, columns: np.ndarray, counts: np.ndarray, entries: np.ndarray, multiple: int):
        """Of ``counts`` entries a row, one row after another, those whose bonds hold: how many, and which."""
        self._counts = counts
        ends = np.cumsum(counts)
        place = np.arange(len(entries)) - np.repeat(ends - counts, counts)
        words = np.array([word[columns] for word in self.store[CUT.name]])
        if len(place) and int(place.max()) >= BITS * len(words):
            raise ValueError(f"{place.max() + 1} bonds of a particle are more than {BITS * len(words)}")
        row = np.repeat(np.arange(len(columns)), counts)
        cut = words[place // BITS, row].astype(np.int64) >> (place % BITS) & 1
        holds = cut == 0
        held = np.bincount(row[holds], minlength=len(columns))
        self._places = padded_lists(held, place[holds], multiple).lists
        self.intact = np.ones(len(columns))
        return held, entries[holds]

    def strengths(self, ids: np.ndarray, number: np.ndarray) -> np.ndarray:
        """Of the particles ``ids`` (n,) of the solids ``number`` (n,)."""
        factors = np.ones(len(ids))
        for n, (one, seed) in enumerate(zip(self._solids, self._seeds)):
            if one.flaws:
                factors[number == n] = strengths(ids[number == n], seed, one.flaws)
        return factors

    def cut(self, around, columns: np.ndarray, number: np.ndarray) -> bool:
        """Cut the bonds of the rows ``around`` that are stretched too far; whether there were any here."""
        if not len(columns):
            return False
        own = self._critical, number, self.periods, around, self._places, columns
        return any(in_threads(self._cut, 0, len(columns), *own, self.store[CUT.name]))

    def weaken(self, around, moment: tuple) -> None:
        """Tell of each row, by its L in ``moment``, what it has left, and whether it lets go of that."""
        if len(self.intact):
            view = around.shown
            own = self._counts, around.lists.lengths, view.reference, moment, self.intact, view.loosened
            in_threads(self._weaken, 0, len(self.intact), *own)

    def measure(self, columns: np.ndarray) -> None:
        """The part of its bonds that each row has lost."""
        self.store[DAMAGE.name][columns] = 1.0 - self.intact


@compiled
def cut_bonds(first, last, critical, number, periods, rows, places, columns, cut):
    """Take the bonds that are stretched too far, or of a particle that lets go, out of the rows ``first`` to
    ``last``, and set their bits; returns how many.

    Both ends of a bond find the same, since what they compare is the same to the last bit.
    """
    lists, found = rows.lists, 0
    for k in range(np.uint64(first), np.uint64(last)):
        most = critical[number[k]]
        if most == np.inf:
            continue
        i = take(rows.shown, k)
        begin = lists.begin[k]
        end = begin + np.uint64(lists.lengths[k])
        kept = begin
        for n in range(begin, end):
            entry = np.uint64(lists.lists[n])
            j = take(rows.shown, entry)
            before = nearest_image(subtract(i.reference, j.reference), periods)
            now = nearest_image(subtract(i.position, j.position), periods)
            longest = 1.0 + most * min(i.strength, j.strength)
            if dot(now, now) > longest * longest * dot(before, before) or max(i.loosened, j.loosened) > 0.0:
                set_bit(cut, columns[k], places[n])
                found += 1
            else:
                lists.lists[kept], places[kept] = entry, places[n]
                kept += np.uint64(1)
        for n in range(kept, end):
            lists.lists[n] = k
        lists.lengths[k] = kept - begin
    return found


@compiled
def set_bit(cut, column, place):
    """Set the bit ``place`` of a particle's bonds."""
    for word in range(len(cut)):
        if word == place // BITS:
            cut[word][column] += 2.0 ** (place % BITS)


@elementwise
def weaken(first, last, counts, lengths, reference, moment, intact, loosened):
    """Of the rows ``first`` to ``last`` the part of ``counts`` that is left, and whether it is too little."""
    for k in range(np.uint64(first), np.uint64(last)):
        left = lengths[k] / counts[k] if counts[k] > 0 else 1.0
        intact[k] = left
        a = at(reference, k)
        inverse = determinant(at(moment, k), a)  # 0 where bonds span no space
        flat = inverse == 0.0 or inverse * FLATTEST ** len(a) > 1.0
        loosened[k] = 1.0 if left < FEWEST or (flat and left < 1.0) else 0.0
