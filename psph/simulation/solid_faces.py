"""The faces of elastic solids as they deform: what contacts read of a particle, and what they do to it."""

import numpy as np

from psph.composition import terms
from psph.composition.pair import fetch, take
from psph.composition.space import softened
from psph.engine.jit import compiled, elementwise
from psph.engine.settled import settled
from psph.engine.simd import spread, width_of
from psph.engine.threads import in_threads
from psph.physics.solid.contact import BORNE, FACE, FACE_RATE, HOLD, SLIDING, SLIP, TURNING
from psph.scene.faces import drawn_faces
from psph.simulation.solid_pairs import reference_pair
from psph.vectors import (
    add,
    applied,
    at,
    cofactor,
    dot,
    dyad,
    first_row,
    matrix_product,
    put,
    scale,
    subtract,
    times,
    transposed,
)

SMALL = 1e-9
"""Of a normal, below which a particle has none."""


class SolidFaces:
    """The normals of the faces of solids of a ``scene``, at their particles in a rank's ``store``.

    A material plane with the normal N₀ is carried to one with the normal N along F⁻ᵀN₀ (Nanson 1878).  So the
    energy U of contacts depends on F by N, and has the stress ∂U/∂F = N ⊗ F⁻¹T, T = −∂U/∂N across N.  Depths
    below faces stay: a push that changed them would act on the neighbours that F is summed over, and not on
    what it pushes, so that it would win energy.
    """

    def __init__(self, scene, store):
        self._scene, self._store, self._loop = scene, store, settled(carry_faces)
        self._turn, self._slide = settled(turn_faces), settled(slide)
        contact = scene.physics.contact
        self._friction = contact.friction if SLIP.name in store else 0.0

    def settle(self, columns: np.ndarray) -> None:
        """The faces of the particles in ``columns`` as they were drawn."""
        s, count = self._store, len(columns)
        place = np.stack([of[columns] for of in s["reference"]], axis=1)
        normal, _ = drawn_faces(self._scene.layout, s.group[columns], place)
        self._columns, self._normal = columns, tuple(np.ascontiguousarray(normal.T))
        self._inverse = tuple(np.zeros(count) for _ in range(s.dimensions**2))

    def carry(self, each, dt: float, sums, weights, rows, moment) -> None:
        """Where they are now, ``dt`` s after they were carried last; ``each`` runs a loop over all rows."""
        s, columns = self._store, self._columns
        rate = s[FACE_RATE.name] if self._friction else None
        per = 1.0 / dt if dt > 0.0 else 0.0
        told = columns, self._normal, s[FACE.name], self._inverse, rate, per
        each(self._loop, 0, len(columns), sums, weights, rows, moment, *told)
        if self._friction:
            arrays = (s[of.name] for of in (SLIP, SLIDING, HOLD, BORNE, FACE))
            in_threads(self._slide, s.low, s.low + s.owned, dt, self._friction, *arrays)

    def turn(self, each, moment, volume: float, flux) -> None:
        """Add what contacts do to the normals to the ``flux`` of the rows."""
        s = self._store
        told = self._columns, s[FACE.name], s[TURNING.name], self._inverse
        each(self._turn, 0, len(self._columns), moment, *told, volume, flux)


@compiled
def carry_faces(first, last, sums, weights, rows, moment, columns, drawn, now, inverse, rate, per):
    """The normals of the rows ``first`` to ``last``, ``drawn`` in the reference, as they are ``now``, and F⁻¹
    there; their ``rate`` in 1/s, if it is asked for, with the time 1/``per`` s since then."""
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
            pair = reference_pair(weights, k, i, j, softened(weights.softening, end - n))
            totals = terms.gather_each(sums, totals, i, j, pair)
        folded = terms.fold_each(sums, totals)
        f = matrix_product(folded[0], at(moment, k), i.reference)
        cof = cofactor(f, i.reference)
        turned = applied(cof, normal)
        length = np.sqrt(dot(turned, turned))
        if length > 0.0:
            turned = scale(turned, known / length)
            if rate is not None:
                put(rate, columns[k], scale(subtract(turned, at(now, columns[k])), per))
            put(now, columns[k], turned)
        dilated = dot(first_row(f, i.reference), first_row(cof, i.reference))
        back = 1.0 / dilated if dilated > 0.0 else 0.0
        put(inverse, k, scale(transposed(cof, i.reference), back))


@compiled
def turn_faces(first, last, moment, columns, face, turning, inverse, volume, flux):
    """B less ∂U/∂F L/V, of the rows ``first`` to ``last``."""
    for k in range(np.uint64(first), np.uint64(last)):
        normal, turn = at(face, columns[k]), at(turning, columns[k])
        across = subtract(turn, scale(normal, dot(normal, turn)))
        drawn = times(at(moment, k), applied(at(inverse, k), across))
        put(flux, k, subtract(at(flux, k), scale(dyad(normal, drawn), 1.0 / volume)))


@elementwise
def slide(first, last, dt, friction, slip, sliding, hold, borne, face):
    """The slip of contacts ``dt`` s later, along their faces, of the columns ``first`` to ``last``: no more
    than what the ``friction`` of what they press holds."""
    for k in range(np.uint64(first), np.uint64(last)):
        stiff = hold[k]
        if stiff <= 0.0:
            put(slip, k, scale(at(slip, k), 0.0))
            continue
        moved = add(at(slip, k), scale(at(sliding, k), dt / stiff))
        normal = at(face, k)
        moved = subtract(moved, scale(normal, dot(normal, moved)))
        size, most = np.sqrt(dot(moved, moved)), friction * borne[k] / stiff
        put(slip, k, scale(moved, most / size) if size > most else moved)
