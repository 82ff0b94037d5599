"""``python growth.py FOLDER STEPS [leak]``: runs a small box for so many steps and watches itself.

The last line is JSON: a sample at each row of the log, of what may grow in a long run, over all
ranks the most.  With ``leak`` every step loses 200 bytes, the control of the measurement.
"""

import gc
import json
import os
import sys
from pathlib import Path

from mpi4py import MPI

from psph.case import load
from psph.parallel.halo import Halo
from psph.parallel.reductions import largest
from psph.runs.record import Record
from psph.runs.start import run
from psph.simulation.step import Simulation

STEP = 1e-3
LEAK = 200
ROWS = 100

CASE = """
scheme = "sph"
title = "A small box in motion"
time = {{ end = {end!r}, step = {step!r} }}
output = {{ frames = {row!r}, probes = {row!r}, log = {row!r} }}
parallel.axis = "x"
[space]
dimensions = 2
spacing = 0.1
smoothing = 1.0
periodic = ["x", "y"]
lower = [0.0, 0.0]
upper = [{length!r}, 0.7]
[physics]
sound_speed = 20.0
artificial_viscosity = 0.1
[fluids.water]
shape.box = {{ lower = [0.0, 0.0], upper = [{length!r}, 0.7] }}
velocity = [1.0, 0.5]
pressure = 2000.0
jitter = 0.1
[probes.middle]
position = [0.3, 0.3]
fields = ["pressure"]
"""
"""49 particles on one rank, 98 on two: they drift as one, so that lists are made anew for ever."""

live_requests = 0


def count_requests():
    """Keep the number of persistent MPI requests that are made and not given back."""
    prepare, free = Halo._prepare, Halo.free

    def prepared(self, names):
        global live_requests
        requests = prepare(self, names)
        live_requests += len(requests)
        return requests

    def freed(self):
        global live_requests
        live_requests -= sum(map(len, self._requests.values()))
        free(self)

    Halo._prepare, Halo.free = prepared, freed


def resident():
    """Bytes of this process in memory."""
    [line] = [line for line in open("/proc/self/status") if line.startswith("VmRSS")]
    return 1024 * int(line.split()[1])


def sample(simulation):
    """What may grow, by name; collective."""
    gc.collect()
    found = {
        "bytes": resident(),
        "files": len(os.listdir("/proc/self/fd")),
        "requests": live_requests,
        "objects": len(gc.get_objects()),
    }
    most = largest(simulation.comm, list(found.values()))
    return {"steps": simulation.steps, **dict(zip(found, most.tolist()))}


def main(folder, steps, leak):
    samples, lost = [], []
    write_log, step = Record.write_log, Simulation.step

    def watched(self, found):
        write_log(self, found)
        samples.append(sample(self.simulation))

    def leaking(self, *end):
        step(self, *end)
        lost.append(bytes(LEAK))

    count_requests()
    Record.write_log = watched
    if leak:
        Simulation.step = leaking
    comm, end = MPI.COMM_WORLD, (steps - 0.5) * STEP
    path = folder / "small.toml"
    if comm.rank == 0:
        path.write_text(CASE.format(end=end, step=STEP, row=end / ROWS, length=0.7 * comm.size))
    comm.barrier()
    done = run(load(path), folder / "run", comm, say=lambda *_: None)
    if comm.rank == 0:
        print(json.dumps({"samples": samples, "rebuilds": done.simulation.domain.rebuilds}))


if __name__ == "__main__":
    main(Path(sys.argv[1]), int(sys.argv[2]), "leak" in sys.argv)
