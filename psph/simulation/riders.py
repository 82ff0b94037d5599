"""What elastic solids do to the rigid bodies that they are fixed to."""

import numpy as np

from psph.composition import terms
from psph.composition.pair import take
from psph.engine.jit import elementwise
from psph.engine.settled import settled
from psph.engine.threads import in_threads
from psph.physics.motion import LOAD, carried_by
from psph.physics.rigid.pushes import book, moment, point
from psph.simulation.solid_plan import solid_plan
from psph.vectors import add, at, nearest_image, scale, subtract


class Riders:
    """The particles of solids of a rank that go with the bodies ``own`` of a ``plan``.

    A body bears m (a − g) of each, with the true mass m and the acceleration a that it would have if it were
    free; their weight is that of the body, which has their mass.  In a fluid it bears the push of that too.
    """

    def __init__(self, plan, own):
        self._plan, self._riding = plan, solid_plan(plan).riding
        carriers = [carried_by(one.motion) for one in plan.materials.species]
        of = [own.index(one) if riding else -1 for one, riding in zip(carriers, self._riding)]
        self._body_of, self._push = np.array(of), settled(push_riders)

    def pushes(self, solids, places: np.ndarray, units: tuple[float, float], periods: tuple) -> np.ndarray:
        """Whole numbers (bodies, 6) of the ``units`` of force, N, and of torque about ``places``, N m; the
        ``solids`` (psph.simulation.solids) know columns and masses."""
        store, wet = solids.store, solid_plan(self._plan).immersed
        columns, masses = solids.columns, solids.masses
        own = self._riding[store.group[columns]]
        loads = store[LOAD.name] if wet else store["acceleration"]
        arrays = store.group, store.view(), store["position"], store["acceleration"], loads
        told = columns[own], masses[own], wet, self._body_of, places, units, periods
        parts = in_threads(self._push, 0, int(own.sum()), *told, self._plan.pulls.bonded, *arrays)
        return sum(parts, np.zeros((len(places), 6), np.int64))


@elementwise
def push_riders(
    first,
    last,
    columns,
    mass,
    wet,
    body_of,
    places,
    units,
    periods,
    pulls,
    group,
    view,
    position,
    acceleration,
    load,
):
    """F = Σ f and T = Σ (x − X) × f, f = m (a − g) and in a fluid, where they are ``wet``, what that does."""
    found = np.zeros((len(places), 6), np.int64)
    per_force, per_torque = 1.0 / units[0], 1.0 / units[1]
    for k in range(np.uint64(first), np.uint64(last)):
        c = columns[k]
        i, body = take(view, c), body_of[group[c]]
        force = scale(subtract(at(acceleration, c), terms.body(pulls, i)), mass[k])
        if wet:
            force = add(force, scale(at(load, c), i.mass))
        arm = nearest_image(subtract(at(position, c), point(places, body, force)), periods)
        book(found, body, force, moment(arm, force), per_force, per_torque)
    return found
