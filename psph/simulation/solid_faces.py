"""The faces of elastic solids as they deform: what contacts read of a particle."""

import numpy as np

from psph.composition import terms
from psph.composition.pair import fetch, take
from psph.composition.space import softened
from psph.engine.jit import compiled
from psph.engine.settled import settled
from psph.engine.simd import spread, width_of
from psph.physics.solid.contact import FACE
from psph.scene.solids import drawn_faces
from psph.simulation.solid_pairs import reference_pair
from psph.vectors import applied, at, cofactor, dot, matrix_product, put, scale

SMALL = 1e-9
"""Of a normal, below which a particle has none."""


class SolidFaces:
    """The normals of the faces of solids of a ``scene``, at their particles in a rank's ``store``.

    A material plane with the normal N is carried to one with the normal cof(F) N (Nanson 1878).  Depths below
    faces stay: a push that changed them would act on the neighbours that F is summed over, and not on what it
    pushes, so that it would win energy.
    """

    def __init__(self, scene, store):
        self._scene, self._store, self._loop = scene, store, settled(carry_faces)

    def settle(self, columns: np.ndarray) -> None:
        """The faces of the particles in ``columns`` as they were drawn."""
        s = self._store
        place = np.stack([of[columns] for of in s["reference"]], axis=1)
        normal, _ = drawn_faces(self._scene, s.group[columns], place)
        self._columns, self._normal = columns, tuple(np.ascontiguousarray(normal.T))

    def carry(self, each, sums, weights, rows, moment) -> None:
        """Where they are now, for the contacts of the next step: ``each`` runs a loop over all rows."""
        now = self._store[FACE.name]
        each(self._loop, 0, len(self._columns), sums, weights, rows, moment, self._columns, self._normal, now)


@compiled
def carry_faces(first, last, sums, weights, rows, moment, columns, drawn, now):
    """The normals of the rows ``first`` to ``last``, ``drawn`` in the reference, as they are ``now``."""
    records, lists = rows.records, rows.lists
    for k in range(np.uint64(first), np.uint64(last)):
        normal = at(drawn, k)
        known = np.sqrt(dot(normal, normal))
        if known < SMALL:
            continue
        i = take(rows.shown, k)
        totals = spread(terms.start(sums, i), records)
        begin = lists.begin[k]
        end = begin + np.uint64(lists.lengths[k])
        for n in range(begin, end, width_of(records)):
            j = fetch(rows.shown, records, lists.lists, n)
            pair = reference_pair(weights, i, j, softened(weights.softening, end - n))
            totals = terms.gather_each(sums, totals, i, j, pair)
        folded = terms.fold_each(sums, totals)
        f = matrix_product(folded[0], at(moment, k), i.reference)
        cof = cofactor(f, i.reference)
        turned = applied(cof, normal)
        length = np.sqrt(dot(turned, turned))
        if length > 0.0:
            put(now, columns[k], scale(turned, known / length))
