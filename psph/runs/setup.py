"""From a scene to this rank's particles, and the compiled loops made ready."""

import time
from contextlib import suppress

import numpy as np

from psph.engine.beside import beside
from psph.engine.jit import CACHE, many_loops, marker
from psph.kinds import Created
from psph.output.checkpoint import checksum
from psph.output.gauges import gauges_of
from psph.output.ledger import Ledger
from psph.parallel.reductions import alone
from psph.particles.store import Store
from psph.physics.motion import OF_MOTION
from psph.runs.record import probes_of
from psph.runs.uncompiled import in_one_line
from psph.scene.particles import ParticleSet
from psph.simulation.cpu import Engine
from psph.simulation.filling import block_of
from psph.simulation.fitting import fitted
from psph.simulation.plan import Plan
from psph.simulation.relaxing import relaxed
from psph.simulation.step import Simulation


def create_particles(scene, plan: Plan, comm) -> Store:
    """This rank's share of the scene's particles in a store.

    Where they belong is for the first rebuild to say.
    """
    store = store_of(scene, plan, lattice_particles(scene, comm))
    first, groups = int(scene.census.counts.sum()), len(scene.species)
    for kind in plan.matter:
        if made := kind.particles():
            _append(scene, plan, store, made, 0 if made.of_parts else groups, first, comm)
            first += len(made.group)
        groups += len(kind.groups())
    return store


def _append(scene, plan: Plan, store: Store, made: Created, first_group: int, first_id: int, comm) -> None:
    """Add this rank's share of the particles of a kind of matter."""
    begin, end = (len(made.group) * rank // comm.size for rank in (comm.rank, comm.rank + 1))
    group = (made.group[begin:end] + first_group).astype(np.uint8)
    block = block_of(
        scene,
        plan.materials,
        store,
        group,
        made.position[begin:end],
        made.velocity[begin:end],
        made.density[begin:end],
    )
    for name, values in ((name, values) for name, values in made.values.items() if name in store):
        block[list(store.rows[name])] = values[begin:end].reshape(end - begin, -1).T
    store.append(first_id + np.arange(begin, end), group, block)


def lattice_particles(scene, comm) -> ParticleSet:
    """This rank's share of the scene's particles, by lattice planes; ids in lattice order."""
    reached = np.concatenate([[0], np.cumsum(scene.census.counts)])
    goals = reached[-1] * np.arange(comm.size + 1) // comm.size
    cuts = np.searchsorted(reached, goals)
    cuts[-1] = scene.layout.planes
    first, last = int(cuts[comm.rank]), int(cuts[comm.rank + 1])
    found = fitted(scene, scene.particles(first, last, int(reached[first])), comm)
    return relaxed(scene, found, comm)


def store_of(scene, plan: Plan, found: ParticleSet) -> Store:
    """A store of these particles of a scene, with the arrays that its plan asks for."""
    store = _empty(scene, plan)
    block = block_of(
        scene, plan.materials, store, found.material, found.position, found.velocity, found.density
    )
    store.append(found.id, found.material, block)
    return store


def compile_ahead(scene, plan: Plan, comm) -> float:
    """Every loop of the plan, ready to run: compiled, or loaded from the cache.

    Where the cache holds them all, the ranks load together.  Else the others compile the loops over pairs,
    which take longest, while rank 0 compiles the rest; then all load what they need.  One rank has a process
    beside it do so.  Without a cache all compile.  Returns the seconds it took.  Collective.
    """
    begun = time.perf_counter()
    store = _empty(scene, plan)
    examples = (
        tuple((one.effects, one.reductions) for one in plan.passes),
        plan.kernel,
        plan.materials.laws,
        plan.space,
        plan.materials.motions,
        plan.materials.loaded is not None,
        (
            bool(plan.materials.rigid) or None,
            bool(scene.frame) or None,
            *(f.name in plan.arrays or None for f in OF_MOTION),
        ),
        *(kind.examples(plan) for kind in plan.matter),
        scene.layout.periods,
        store.view(),
    )
    measured = "step and probes" if scene.case.probes or scene.case.gauges else "step"
    ready = marker(measured, *examples)
    together = comm.bcast(ready is None or ready.exists())
    with many_loops(), in_one_line():
        if not together:
            (_share if comm.size > 1 else _share_with_copy)(scene, plan, comm)
        if together or comm.rank == 0:
            _rehearse(scene, plan, store)
    if comm.rank == 0 and not together:
        with suppress(OSError):  # the folder is gone, or full: loops are compiled once more
            ready.touch()
        CACHE.prune()
    comm.Barrier()
    return time.perf_counter() - begun


class _NoSums(Engine):
    """The engine of rank 0 while others compile the loops over pairs."""

    def sum(self, *when, **how) -> None:
        """Nothing: others are at it."""

    sum_midway = sum


class _AllButSums(Simulation):
    """A rehearsal of all other loops."""

    engine_type = _NoSums


def _share(scene, plan: Plan, comm) -> None:
    """Compile this rank's share of the loops; collective."""
    if comm.rank == 0:
        _compile_all_but_sums(scene, plan)
    else:
        _engine(scene, plan).prepare_sums(comm.rank - 1, comm.size - 1)
    comm.Barrier()


def _share_with_copy(scene, plan: Plan, comm) -> None:
    """The same of one rank, where a core is free: a copy of this process compiles the loops over pairs."""
    engine = _engine(scene, plan)
    with beside(lambda: engine.prepare_sums(0, 1)) as shared:
        if shared:
            _compile_all_but_sums(scene, plan)


def _engine(scene, plan: Plan) -> Engine:
    """The engine of a rank without particles."""
    return Engine(scene, plan, _empty(scene, plan), alone(), Ledger())


def _compile_all_but_sums(scene, plan: Plan) -> None:
    """A step without sums over pairs."""
    store = _empty(scene, plan)
    _few_particles(scene, plan, store)
    _AllButSums(scene, plan, store, alone(), Ledger()).step()


def _rehearse(scene, plan: Plan, store: Store) -> None:
    """One step, and all that may be measured after it."""
    _few_particles(scene, plan, store)
    rehearsal = Simulation(scene, plan, store, alone(), Ledger())
    rehearsal.step()
    rehearsal.settle_pressure()
    for probe in probes_of(scene.case):
        probe.sample(rehearsal)
    for gauge in gauges_of(scene).values():
        gauge.row(rehearsal)
    checksum(store.id, 0)  # a run that is told to end may have a second for its checkpoint


def _empty(scene, plan: Plan) -> Store:
    """A store with the arrays that a plan asks for."""
    return Store(scene.dimensions, plan.stored, plan.constants, plan.view, plan.materials.kinds)


def _few_particles(scene, plan: Plan, store: Store) -> None:
    """A few particles in ``store``, two of the first material or one, and what else kinds of matter ask for:
    it has the types of the whole run."""
    further = [group for kind in plan.matter for group in kind.rehearsed()] or [0]
    groups = np.array([0, *further], np.uint8)
    middle = [0.5 * (a + b) for a, b in zip(scene.layout.lower, scene.layout.upper)]
    middle = np.tile(scene.layout.parts[0].somewhere(middle), (len(groups), 1))
    density = np.full(len(groups), scene.species[0].density)
    block = block_of(scene, plan.materials, store, groups, middle, np.zeros_like(middle), density)
    store.append(np.arange(len(groups)), groups, block)
