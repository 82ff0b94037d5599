"""Run a case on 4, 3, 2 and 1 of the ranks of one job, unbroken and resumed, and compare bits.

``mpirun -n 4 python together.py CASE STEPS``: rank 0 prints {"WAY on N": digest} as JSON.
"""

import hashlib
import json
from pathlib import Path

from jobs import of_all_ranks
from mpi4py import MPI
from parallel.alike import begun, go
from runs.resuming import keep, state, taken_up

from psph.case import load
from psph.runs.setup import compile_ahead
from psph.scene import Scene
from psph.simulation.plan import make_plan

WORLD = MPI.COMM_WORLD


def digest(simulation) -> str:
    """Of everything that the next steps rest on."""
    simulation.settle_pressure()
    found = hashlib.sha256()
    for name, value in sorted(state(simulation).items()):
        found.update(name.encode() + (value.encode() if isinstance(value, str) else value))
    return found.hexdigest()[:16]


def main(path: Path, steps: int) -> None:
    """Every number of ranks, one after the other; a resumed run takes up the checkpoint of another."""
    case, found, middle = load(path), {}, steps // 2
    scene = Scene(case)
    compile_ahead(scene, make_plan(scene), WORLD)
    for size in range(WORLD.size, 0, -1):
        comm = WORLD.Split(WORLD.rank >= size, WORLD.rank)
        if WORLD.rank < size:
            folder = path.parent / str(size)
            folder.mkdir(exist_ok=True)
            keep(go(begun(case, comm), middle), case, folder)
            comm.Barrier()
            other = path.parent / str(min(size + 1, WORLD.size)) / f"checkpoint-{middle}.h5"
            found[f"resumed on {size}"] = digest(go(taken_up(case, other, comm), steps - middle))
            unbroken = go(begun(case, comm), steps)
            found[f"unbroken on {size}"] = digest(unbroken)
            found["particles"] = comm.allreduce(unbroken.store.owned)
            found["next id"] = unbroken.population.next_id
        comm.Free()
        WORLD.Barrier()
    if WORLD.rank == 0:
        print(json.dumps(found), flush=True)


if __name__ == "__main__":
    of_all_ranks(main)
