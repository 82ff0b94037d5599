"""What the tests of checkpoints share: a small scene that rebuilds often, states, files."""

import h5py
import numpy as np
from mpi4py import MPI

from psph.output.checkpoint import Saved
from psph.output.ledger import Ledger
from psph.runs.record import Record
from psph.runs.resume import case_digest, listed_particles, write_checkpoint
from psph.runs.setup import create_particles
from psph.runs.watch import Call, Watch
from psph.scene import Scene
from psph.simulation.plan import make_plan
from psph.simulation.step import Simulation

BOX = """
scheme = "sph"
time = { end = 0.2, cfl = 0.4 }
neighbours.skin = 0.3
output = { frames = 0.02, probes = 0.005, log = 0.01 }
parallel.axis = "x"
checkpoint.every = 30
guards = { speed = 10.0, density = 5.0, energy = 1e6 }
[space]
dimensions = 2
spacing = 0.1
smoothing = 1.2
kernel = "hyperbolic"
periodic = ["x"]
lower = [0.0, 0.0]
upper = [3.0, 1.5]
[physics]
sound_speed = 10.0
artificial_viscosity = 0.1
pressure_gradient = "minimum"
free_surface = 0.9
[fluids.left]
shape.box = { lower = [0.0, 0.0], upper = [1.5, 1.5] }
velocity = [3.0, -2.0]
pressure = 3000.0
jitter = 0.2
[fluids.right]
shape.box = { lower = [1.5, 0.0], upper = [3.0, 1.5] }
velocity = [-3.0, 2.0]
pressure = 3000.0
jitter = 0.2
[probes.middle]
position = [1.5, 0.7]
fields = ["pressure", "velocity"]
"""
"""Two halves of a box run against each other, periodic along x, open along y: 90 steps."""


def fill_records(simulation):
    """Bring all records up to date, as new lists and a pass do."""
    for records in simulation.engine.records:
        records.make_room()
        records.fill(0, simulation.store.total)


class Counted(Simulation):
    """A simulation that knows in which step its lists were made: ``rebuilt``."""

    rebuilt = 0

    def rebuild(self):
        super().rebuild()
        self.rebuilt = self.steps


def stop_after(monkeypatch, count):
    """Have the next runs told to stop by a signal during step ``count`` of each."""

    class Told(Watch):
        def call(self):
            self.asked = getattr(self, "asked", 0) + 1
            return Call.SIGUSR1 if self.asked >= count else super().call()

    monkeypatch.setattr("psph.runs.start.Watch", Told)


def steps(case, comm, count):
    """The simulation of a case after so many steps."""
    scene = Scene(case)
    plan = make_plan(scene)
    simulation = Counted(scene, plan, create_particles(scene, plan, comm), comm, Ledger())
    for _ in range(count):
        simulation.step()
    return simulation


def keep(simulation, case, folder):
    """The path of a checkpoint of the simulation, with the files of its record in ``folder``."""
    record = Record(Scene(case), simulation, folder)
    record.write_due()
    try:
        return write_checkpoint(simulation, record, case, folder)
    finally:
        record.close()


def taken_up(case, path, comm):
    """The simulation that goes on from a checkpoint."""
    scene = Scene(case)
    plan = make_plan(scene)
    saved = Saved(path, comm, case_digest(case))
    particles = listed_particles(scene, plan, saved)
    return Counted(scene, plan, particles, comm, Ledger(), saved)


def control(case, path, comm):
    """The same on one rank, but its lists are made from where the particles are now.

    All that is measured of the older lists stays, so that they are made anew in the same step.
    """
    simulation = taken_up(case, path, comm)
    store, domain = simulation.store, simulation.domain
    listed = dict(zip(store.owned_rows("id").tolist(), store.owned_rows("listed_position")))
    domain.relist(domain.lower, domain.upper)
    back = np.array([listed[k] for k in store.owned_rows("id").tolist()])
    for row, values in zip(store["listed_position"], back.T):
        row[store.inner] = values
    domain.halo.refresh(("listed_position",))
    fill_records(simulation)
    return simulation


def velocity_by_id(simulation):
    """The velocities of one rank's particles."""
    return simulation.store.owned_rows("velocity")[np.argsort(simulation.store.owned_rows("id"))]


def state(simulation):
    """Everything that the next steps rest on, on rank 0's side of all ranks: text and bytes."""
    store, comm = simulation.store, simulation.comm
    names = ("id", "kind", *sorted(store.rows))
    mine = [store.owned_rows(name) for name in names]
    parts = comm.allgather([part.tobytes() for part in mine])
    rows = {name: b"".join(part[k] for part in parts) for k, name in enumerate(names)}
    return rows | {"state": repr(simulation.state())}


def unlike(one, other):
    """What two states (:func:`state`) do not share: of a column how many numbers, and by how much at most."""
    assert list(one) == list(other)
    found = {}
    for name, mine in one.items():
        if mine != other[name]:
            found[name] = mine, other[name]
            if isinstance(mine, bytes) and len(mine) == len(other[name]) and name not in ("id", "kind"):
                a, b = np.frombuffer(mine), np.frombuffer(other[name])
                found[name] = f"{np.count_nonzero(a != b)} of {len(a)}, by {np.abs(a - b).max():g}"
    return found


def go_on_alike(simulation, again, count, rebuilds=1):
    """Assert the same bits in two simulations, now and after so many steps and new lists."""
    assert not unlike(state(again), state(simulation))
    for _ in range(count):
        simulation.step()
        again.step()
    assert again.domain.rebuilds >= rebuilds
    assert not unlike(state(again), state(simulation))


def go_on_elsewhere(case, before, after, folder, many=14):
    """So ``many`` steps on ``before`` ranks of two, a checkpoint, and as many more: on ``after`` ranks the same."""
    world = MPI.COMM_WORLD
    comms = {1: MPI.COMM_SELF, 2: world}
    own = folder / (f"rank{world.rank}" if before == 1 else "all")
    own.mkdir(exist_ok=True)
    world.Barrier()
    simulation = steps(case, comms[before], many)
    keep(simulation, case, own)
    world.Barrier()
    written = folder / ("rank0" if before == 1 else "all") / f"checkpoint-{simulation.steps}.h5"
    go_on_alike(simulation, taken_up(case, written, comms[after]), many, rebuilds=0)


def same_files(folder, other):
    """Whether two runs left the same tables and XDMF to the byte, and the same frames."""
    for name in ("log.csv", "probes.csv", "box.xdmf"):
        if (folder / name).read_bytes() != (other / name).read_bytes():
            return False
    with h5py.File(folder / "box.h5") as one, h5py.File(other / "box.h5") as two:
        if list(one["frames"]) != list(two["frames"]) or list(one) != list(two):
            return False
        return all(
            np.array_equal(one["frames"][k][name], two["frames"][k][name])
            and dict(one["frames"][k].attrs) == dict(two["frames"][k].attrs)
            for k in one["frames"]
            for name in {*one["frames"][k], *two["frames"][k]}
        )
