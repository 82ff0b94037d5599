"""From a scene to this rank's particles, and the compiled loops made ready."""

import time

import numpy as np

from psph.jit import CACHE, many_loops, marker
from psph.output.checkpoint import checksum
from psph.output.ledger import Ledger
from psph.parallel.reductions import alone
from psph.particles.store import Store
from psph.scene.particles import ParticleSet
from psph.solver.plan import PER_MATERIAL, PER_SITE, Plan, material_value
from psph.solver.record import probes_of
from psph.solver.step import Simulation

NOT_YET_SUMMED = 2.0
"""A kernel sum that no threshold calls a surface, until the first pass knows better."""

NOT_YET_LISTED = 1.0
"""Every wall counts as wet until the neighbours are listed."""


def create_particles(scene, plan: Plan, comm) -> Store:
    """This rank's share of the scene's particles in a store.

    Where they belong is for the first rebuild to say.
    """
    return store_of(scene, plan, lattice_particles(scene, comm))


def lattice_particles(scene, comm) -> ParticleSet:
    """This rank's share of the scene's particles, by lattice planes; ids in lattice order."""
    reached = np.concatenate([[0], np.cumsum(scene.counts())])
    goals = reached[-1] * np.arange(comm.size + 1) // comm.size
    cuts = np.searchsorted(reached, goals)
    cuts[-1] = scene.planes
    first, last = int(cuts[comm.rank]), int(cuts[comm.rank + 1])
    return scene.particles(first, last, int(reached[first]))


def store_of(scene, plan: Plan, found: ParticleSet) -> Store:
    """A store of these particles of a scene, with the arrays that its plan asks for."""
    store = Store(scene.dimensions, plan.arrays, plan.constants)
    block = np.zeros((len(store.data), len(found.id)))
    for name in ("position", "velocity"):
        block[list(store.rows[name])] = getattr(found, name).T
    block[list(store.rows["predicted_velocity"])] = found.velocity.T  # a wall's stays
    block[store.rows["density"].start] = found.density
    for name in PER_MATERIAL:
        if name in store:
            values = np.array([material_value(m, name) for m in scene.materials])
            block[store.rows[name].start] = values[found.material]
    for name in PER_SITE:
        if name in store:
            block[store.rows[name].start] = scene.lattice.odd(found.position)
    if "kernel_sum" in store:
        block[store.rows["kernel_sum"].start] = NOT_YET_SUMMED
    for effect in plan.marking:
        block[store.rows[effect.marks].start] = NOT_YET_LISTED
    store.append(found.id, found.kind, block)
    return store


def compile_ahead(scene, plan: Plan, comm) -> float:
    """Every loop of the plan, ready to run: compiled, or loaded from the cache.

    Where the cache holds them all, the ranks load together; else rank 0 compiles while the others
    wait, and they load when they need one.  Without a cache all compile.  Returns the seconds it took.
    Collective.
    """
    begun = time.perf_counter()
    store = Store(scene.dimensions, plan.arrays, plan.constants)
    ready = marker(
        "step and probes" if scene.case.probes else "step",
        plan.effects, plan.kernel, plan.state, plan.space, scene.periods, store.view(),
    )
    together = comm.bcast(ready is None or ready.exists())
    if together or comm.rank == 0:
        with many_loops():
            _rehearse(scene, plan, store)
    if comm.rank == 0 and not together:
        ready.touch()
        CACHE.prune()
    comm.Barrier()
    return time.perf_counter() - begun


def _rehearse(scene, plan: Plan, store: Store) -> None:
    """One step of two particles of the first fluid in ``store``: it has the types of the whole run."""
    block, fluid = np.zeros((len(store.data), 2)), scene.materials[0]
    block[store.rows["density"].start] = fluid.density
    for name in PER_MATERIAL:
        if name in store:
            block[store.rows[name].start] = material_value(fluid, name)
    middle = [0.5 * (a + b) for a, b in zip(scene.lower, scene.upper)]
    block[list(store.rows["position"])] = np.array(middle)[:, None]
    store.append(np.arange(2), np.zeros(2, np.uint8), block)
    rehearsal = Simulation(scene, plan, store, alone(), Ledger())
    rehearsal.step()
    rehearsal.settle_pressure()
    for probe in probes_of(scene.case):
        probe.sample(rehearsal.domain, scene.kernel)
    checksum(store.id, 0)  # a run that is told to end may have a second for its checkpoint
