"""Run scenes on 7, 4, 3, 2 and 1 ranks of one job, each in several ways, and print a digest of each.

``mpirun -n 7 python alike.py FOLDER STEPS`` takes every ``*.toml`` in the folder; a line of JSON for
each scene: what happened, and {"WAY on N": digest}.
"""

import hashlib
import json
from contextlib import contextmanager

import numpy as np
from jobs import of_all_ranks
from mpi4py import MPI
from runs.resuming import Counted, keep, state, taken_up

from psph.case import load
from psph.engine.threads import use_threads
from psph.output.ledger import Ledger
from psph.parallel import domain
from psph.parallel.slabs import partition
from psph.runs.record import Record
from psph.runs.setup import compile_ahead, create_particles
from psph.scene import Scene
from psph.simulation.cpu import Engine
from psph.simulation.plan import make_plan
from psph.simulation.step import BlowUp

WORLD = MPI.COMM_WORLD
GROUPS = ((7,), (4, 3), (2, 1))
"""Sizes of the groups that run at the same time; those after it take up its checkpoints."""

WRITTEN_BY = {7: 7, 4: 7, 3: 7, 2: 4, 1: 3}
"""On how many ranks the checkpoint was written that so many go on from."""


class ApartEngine(Engine):
    """No overlap: the halo is there before any pair is summed."""

    def _sum_while_refreshing(self, one, fields):
        self.domain.halo.refresh(fields)
        self._sum_all(one)


class Apart(Counted):
    """A simulation with such an engine."""

    engine_type = ApartEngine


def begun(case, comm, kind=Counted):
    """A simulation before its first step."""
    scene = Scene(case)
    plan = make_plan(scene)
    return kind(scene, plan, create_particles(scene, plan, comm), comm, Ledger())


def go(simulation, steps):
    """So many steps."""
    for _ in range(steps):
        simulation.step()
    return simulation


@contextmanager
def cuts(choose):
    """Slabs by ``choose`` (as psph.parallel.slabs.rebalanced) in place of load balancing."""
    own, domain.rebalanced = domain.rebalanced, choose
    try:
        yield
    finally:
        domain.rebalanced = own


def equal_planes(costs, bounds, ranks):
    """As many planes for each rank, whatever they hold."""
    return partition(np.ones_like(costs), ranks)


def random_cuts(seed):
    """Others at each rebuild, down to a single plane; the same on all ranks."""
    rng = np.random.default_rng(seed)

    def choose(costs, bounds, ranks):
        inner = rng.choice(np.arange(1, len(costs)), ranks - 1, replace=False)
        return np.array([0, *sorted(inner.tolist()), len(costs)])

    return choose


def plain(case, comm, steps, folder):
    """As a run does it."""
    return go(begun(case, comm), steps)


def apart(case, comm, steps, folder):
    """Without overlap."""
    return go(begun(case, comm, Apart), steps)


def equal(case, comm, steps, folder):
    """Without load balancing."""
    with cuts(equal_planes):
        return go(begun(case, comm), steps)


def recut(case, comm, steps, folder):
    """With slabs that change at each rebuild."""
    with cuts(random_cuts(steps)):
        return go(begun(case, comm), steps)


def threaded(case, comm, steps, folder):
    """With two threads a rank."""
    use_threads(2)
    try:
        return go(begun(case, comm), steps)
    finally:
        use_threads(1)


def noted(case, comm, steps, folder):
    """With frames and rows at other moments on each number of ranks."""
    dt = 1e-3 * comm.size
    often = case.output.model_copy(update={"frames": 3 * dt, "log": dt, "probes": 2 * dt})
    simulation = begun(case.model_copy(update={"output": often}), comm)
    record = Record(Scene(case.model_copy(update={"output": often})), simulation, folder)
    for _ in range(steps):
        record.write_due()
        simulation.step()
    record.close()
    assert record.written > 1
    return simulation


def resumed(case, comm, steps, folder):
    """From a checkpoint, most often of another number of ranks."""
    middle = steps // 2
    simulation = go(begun(case, comm), middle)
    keep(simulation, case, folder)
    comm.Barrier()
    theirs = folder.with_name(str(WRITTEN_BY[comm.size]))
    return go(taken_up(case, theirs / f"checkpoint-{simulation.steps}.h5", comm), steps - middle)


def nudged(case, comm, steps, folder):
    """The control: the speed of sound differs in its last bit; of soils, which have their own, Young's modulus in
    its twelfth digit, of gases γ."""
    if case.ideal_gases:
        gases = {
            name: one.model_copy(update={"gamma": one.gamma * (1.0 + 1e-12)})
            for name, one in case.ideal_gases.items()
        }
        return go(begun(case.model_copy(update={"ideal_gases": gases}), comm), steps)
    if case.soils:
        soils = {
            name: one.model_copy(update={"young": one.young * (1.0 + 1e-12)})
            for name, one in case.soils.items()
        }
        return go(begun(case.model_copy(update={"soils": soils}), comm), steps)
    physics = case.physics
    faster = physics.model_copy(update={"sound_speed": float(np.nextafter(physics.sound_speed, 99.0))})
    return go(begun(case.model_copy(update={"physics": faster}), comm), steps)


WAYS = (plain, apart, equal, recut, threaded, noted, resumed, nudged)


def digest(run):
    """Of everything that the next steps rest on; or how the run ended before."""
    try:
        simulation = run()
    except BlowUp as trouble:
        return str(trouble), 0
    simulation.settle_pressure()  # an output does so too
    found = hashlib.sha256()
    for name, value in sorted(state(simulation).items()):
        found.update(name.encode() + (value.encode() if isinstance(value, str) else value))
    return found.hexdigest()[:16], simulation.domain.rebuilds


def compare(path, steps):
    """What came of a scene: on rank 0 {"WAY on N": digest}, and the rebuilds of the plain run."""
    case = load(path)
    scene = Scene(case)
    compile_ahead(scene, make_plan(scene), WORLD)
    digests, rebuilds = {}, 0
    for sizes in GROUPS:
        ends = np.cumsum(sizes)
        group = int(np.searchsorted(ends, WORLD.rank, side="right"))
        mine = {}
        comm = WORLD.Split(group, WORLD.rank)
        if group < len(sizes):
            for way in WAYS:
                folder = path.parent / path.stem / str(comm.size)
                folder.mkdir(parents=True, exist_ok=True)
                mine[f"{way.__name__} on {comm.size}"], times = digest(
                    lambda way=way: way(case, comm, steps, folder)
                )
                rebuilds = max(rebuilds, times)
        for part in WORLD.allgather(mine if comm.rank == 0 else {}):
            digests |= part
        comm.Free()
    return {
        "scene": path.stem,
        "particles": int(scene.census.counts.sum()),
        "rebuilds": rebuilds,
        "digests": digests,
    }


def main(folder, steps):
    """A line for each scene of the folder."""
    for one in sorted(folder.glob("*.toml")):
        told = compare(one, steps)
        if WORLD.rank == 0:
            print(json.dumps(told), flush=True)


if __name__ == "__main__":
    of_all_ranks(main)
