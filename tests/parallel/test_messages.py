"""Every message of a step is one that the plan asks for, and it travels behind the interior."""

from types import SimpleNamespace

import numpy as np
import pytest
from gauging import start
from mpi4py import MPI
from parallel.test_simulation import box

from psph.output.ledger import Ledger
from psph.parallel import halo as halo_module
from psph.runs.record import Record
from psph.scene import Scene

COMM = MPI.COMM_WORLD
pytestmark = pytest.mark.mpi(min_size=2)


class Watched:
    """A communicator that writes down each call; messages count when they are started."""

    def __init__(self, comm, events):
        self.comm, self.events = comm, events
        self.rank, self.size = comm.rank, comm.size

    def __getattr__(self, name):
        method = getattr(self.comm, name)

        def call(*args, **named):
            result = method(*args, **named)
            if name.endswith("_init"):  # local: nothing travels yet
                [_, count, kind], partner, _ = args
                message = (name, partner, count * kind.Get_size())
                self.events.prepared.append((result, message))
            else:
                size = args[1].nbytes if name == "Allreduce" else None
                self.events.append((name, size))
            return result

        return call


class Events(list):
    """What happened on this rank, in order."""

    def __init__(self):
        super().__init__()
        self.prepared = []

    def start_all(self, requests):
        """Write down the messages of persistent requests."""
        self.extend(message for known, message in self.prepared if known in requests)
        MPI.Prequest.Startall(requests)

    def wait_all(self, requests):
        """Write down that a refresh is waited for."""
        self.append(("wait", len(requests)))
        MPI.Request.Waitall(requests)


class Watch(Ledger):
    """A ledger that also tells the events which pass over the pairs begins."""

    def __init__(self, events):
        super().__init__()
        self.events = events

    def __call__(self, name):
        if name == "pairs":
            self.events.append(("pairs", None))
        return super().__call__(name)


@pytest.fixture
def watched(monkeypatch):
    """A function: case → (simulation, its events)."""

    def make(case):
        events = Events()
        counting = SimpleNamespace(
            PROC_NULL=MPI.PROC_NULL,
            DOUBLE=MPI.DOUBLE,
            Comm=MPI.Comm,
            Datatype=MPI.Datatype,
            Prequest=SimpleNamespace(Startall=events.start_all),
            Request=SimpleNamespace(Waitall=events.wait_all),
        )
        monkeypatch.setattr(halo_module, "MPI", counting)
        return start(case, Watched(COMM, events), Watch(events)), events

    return make


PLAINLY, MEASURING, REBUILDING = "no more", "drift measured", "lists made"


def events_of_a_step(simulation, events, kind):
    """The events of the next step of this kind."""
    for _ in range(60):
        rebuilds = simulation.domain.rebuilds
        events.clear()
        simulation.step()
        measured = simulation.neighbourhood.skin._since <= simulation.dt
        found = MEASURING if measured else PLAINLY
        if (REBUILDING if simulation.domain.rebuilds > rebuilds else found) == kind:
            return list(events)
    raise AssertionError("no such step")


def expected_sends(simulation, names):
    """(partner, bytes) of one refresh, from what the neighbours hold as ghosts."""
    store, domain = simulation.store, simulation.domain
    rows = sum(simulation.store.fields[n].width(simulation.store.dimensions) for n in names)
    ghosts = COMM.allgather((store.low, store.high))
    below, above = domain._partner(-1), domain._partner(1)
    sends = [(below, 8 * rows * ghosts[below][1])] if below != MPI.PROC_NULL else []
    return sends + ([(above, 8 * rows * ghosts[above][0])] if above != MPI.PROC_NULL else [])


SKIN = 0.4
"""So wide that a list lasts for some steps."""

PLAIN = ("position", "predicted_velocity", "pressure", "specific_volume")

CASES = {
    "plain": (box(2, False, 0, SKIN, artificial_viscosity=None), PLAIN),
    "periodic": (box(2, True, 0, SKIN), PLAIN),
    "3D": (box(3, True, 0, SKIN), PLAIN),
    "p- and surface": (box(2, False, 1, SKIN, pressure_gradient="minimum", free_surface=0.9), PLAIN),
    "shifts and matrices": (
        box(2, True, 0, SKIN, particle_shifting=0.1, gradient_correction=0.5),
        (*PLAIN, "gradient_correction"),
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_a_step_sends_one_message_a_neighbour_and_reduces_once(name, watched):
    case, fields = CASES[name]
    simulation, events = watched(case)
    assert set(simulation.plan.refreshed) == set(fields)
    found = events_of_a_step(simulation, events, PLAINLY)
    sends = [event[1:] for event in found if event[0] == "Send_init"]
    assert sorted(sends) == sorted(expected_sends(simulation, fields))
    assert 0 < len(sends) <= 2 and all(size > 0 for _, size in sends)
    received = [event for event in found if event[0] == "Recv_init"]
    assert len(received) == len(sends)
    assert sum(e[2] for e in received) == 8 * (simulation.store.low + simulation.store.high) * sum(
        simulation.store.fields[n].width(simulation.store.dimensions) for n in fields
    )
    rest = [e for e in found if e[0] not in ("Send_init", "Recv_init", "wait", "pairs")]
    assert rest == [("Allreduce", (4 + simulation.plan.displaces) * 8)]
    assert sum(s for _, s in sends) == simulation.domain.halo.bytes(simulation.plan.refreshed)


@pytest.mark.parametrize("name", CASES)
def test_the_halo_travels_while_the_interior_is_computed(name, watched):
    simulation, events = watched(CASES[name][0])
    found = [event[0] for event in events_of_a_step(simulation, events, PLAINLY)]
    started = [k for k, what in enumerate(found) if what in ("Send_init", "Recv_init")]
    interior, rim = (k for k, what in enumerate(found) if what == "pairs")
    assert max(started) < interior < found.index("wait") < rim
    first, last = simulation.domain.interior()
    # There is something to hide it behind, but for the few planes of the small box in 3D.
    assert COMM.allreduce(last - first) > 0 or name == "3D"
    store, lists = simulation.store, simulation.domain.lists
    for k in range(first - store.low, last - store.low):
        begin, n = int(lists.begin[k]), int(lists.lengths[k])
        row = lists.lists[begin : begin + n]
        row = row[row < store.total]
        assert ((row >= store.low) & (row < store.low + store.owned)).all()


def test_a_rebuild_sends_what_does_not_change_too_and_no_more(watched):
    case = box(2, True, 0, SKIN)
    water = case.fluids["left"]
    halves = [[0.0, 0.0], [2.0, 0.7]], [[0.0, 0.7], [2.0, 1.5]]
    fluids = {
        name: water.model_dump(exclude_unset=True)
        | {"shape": {"box": {"lower": low, "upper": up}}, "density": density}
        for name, density, (low, up) in zip(("water", "oil"), (1000.0, 800.0), halves)
    }
    case = type(case).model_validate(case.model_dump(exclude_unset=True) | {"fluids": fluids})
    simulation, events = watched(case)
    assert simulation.plan.ghost_fields == ("mass", "rest_density")  # of two fluids
    found = events_of_a_step(simulation, events, REBUILDING)
    sends = [event[1:] for event in found if event[0] == "Send_init"]
    assert sorted(sends) == sorted(expected_sends(simulation, (*PLAIN, "mass", "rest_density")))
    names = [e[0] for e in found if e[0] not in ("Send_init", "Recv_init", "wait", "pairs")]
    # drift, extent, planes, movers; the counts of the ghost planes below and above; the limits
    moving = ["Alltoall", *(n for n in names if n in ("Irecv", "Isend"))]
    asked = ["Allreduce"] * 4 + ["Sendrecv"] * 2 + ["Allreduce"]
    assert names == asked or names == asked[:4] + moving + asked[4:]
    again = events_of_a_step(simulation, events, PLAINLY)
    sends = [event[1:] for event in again if event[0] == "Send_init"]
    assert sorted(sends) == sorted(expected_sends(simulation, PLAIN))
    assert np.isfinite(simulation.store["density"]).all()


def test_measuring_the_drift_is_one_reduction_more(watched):
    simulation, events = watched(CASES["plain"][0])
    found = events_of_a_step(simulation, events, MEASURING)
    assert [e for e in found if e[0] == "Allreduce"] == [("Allreduce", n * 8) for n in (3, 4)]


def with_body(case):
    """The same with a disc in the middle of the fluid, which floats there."""
    disc = {"shape": {"disc": {"center": [1.0, 0.7], "radius": 0.3}}, "density": 1000.0}
    return type(case).model_validate(case.model_dump(exclude_unset=True) | {"bodies": {"disc": disc}})


def test_bodies_are_one_reduction_more_and_one_number_of_another(watched):
    """Six whole numbers a body, and the largest speed of walls; the halo stays as it is."""
    case, fields = CASES["plain"]
    simulation, events = watched(with_body(case))
    found = events_of_a_step(simulation, events, PLAINLY)
    sends = [event[1:] for event in found if event[0] == "Send_init"]
    assert sorted(sends) == sorted(expected_sends(simulation, fields))
    rest = [e for e in found if e[0] not in ("Send_init", "Recv_init", "wait", "pairs")]
    assert rest == [("Allreduce", 6 * 8), ("Allreduce", (5 + simulation.plan.displaces) * 8)]


def test_rows_that_are_due_together_are_three_reductions(watched, mpi_tmp_path):
    """The largest terms and how many there are, then whole numbers: of three probes, a front and the log."""
    case, _ = CASES["plain"]
    probes = {f"P{k}": {"position": [0.5 * k, 0.5]} for k in range(3)} | {"tip": {"front": "x"}}
    case = type(case).model_validate(case.model_dump(exclude_unset=True) | {"probes": probes})
    simulation, events = watched(case)
    record = Record(Scene(case), simulation, mpi_tmp_path)
    events.clear()
    record.write_due()
    record.close()
    columns = 3 * 3 + 4
    assert [size for name, size in events if name == "Allreduce"] == [8 * (columns + 2), 8 * 5, 8 * columns]
