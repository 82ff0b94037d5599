"""psph's own pace in the blast: ``python -m psph.lab.peers.gas_own`` prints what its bench's steps take."""

import json
import os
import sys
import time
from pathlib import Path

from psph.lab.bench import GAS
from psph.lab.bench.measure import BenchProblem, go_on, scene_of, warmed_up, work
from psph.lab.peers.gas import DIMENSIONS, END, LONG, NEIGHBOURS, PARTICLES, SHORT, GasPace, GasStart, blast
from psph.lab.peers.own import HERE, Own
from psph.lab.peers.process import LOG, finished
from psph.output.ledger import Ledger
from psph.parallel.reductions import alone
from psph.runs.setup import compile_ahead
from psph.scene import Scene
from psph.simulation.plan import make_plan
from psph.simulation.step import Simulation

PATIENCE = 3600.0

OWN_STEPS = "time.halvings=3"
"""Its key for steps of each particle's own, as `run/cases/gas/sedov_octant.toml` has them."""


class OwnGas(Own):
    """psph itself, in a process of its own."""

    scheme = "`gas`, α = 1, lists of neighbours; double precision"

    def pace(self, start: GasStart, folder: Path) -> GasPace:
        """Its pace; it makes the particles of ``start`` by itself."""
        words = [sys.executable, "-m", "psph.lab.peers.gas_own"]
        finished("psph, gas", words, folder, PATIENCE, {"PYTHONPATH": os.fspath(HERE)})
        return told((folder / LOG).read_text(encoding="utf-8"))


def told(log: str) -> GasPace:
    """The pace that the last line says."""
    return GasPace(**json.loads(log.strip().splitlines()[-1]))


def timed(particles: int, steps: int) -> GasPace:
    """So many steps after the bench's warm-up, by the clock of this process."""
    problem, comm = blast(particles), alone()
    scene = Scene(problem.case())
    simulation, _ = warmed_up(problem, scene, comm)
    begun = time.process_time()
    made = go_on(simulation, steps)
    seconds = time.process_time() - begun
    there, pairs, _ = work(simulation, scene)
    return GasPace(made * there, seconds, f"{pairs / there:.0f}", own_steps(particles, END))


def own_steps(particles: int, end: float) -> float:
    """CPU seconds until ``end`` with steps of their own, without what is compiled."""
    problem, comm = blast(particles), alone()
    scene = scene_of(BenchProblem(GAS, DIMENSIONS, particles, NEIGHBOURS, "double"), problem, [OWN_STEPS])
    plan = make_plan(scene)
    compile_ahead(scene, plan, comm)
    begun = time.process_time()
    simulation = Simulation(scene, plan, problem.create(scene, plan, comm), comm, Ledger())
    while simulation.time < end:
        simulation.step(end)
    return time.process_time() - begun


if __name__ == "__main__":
    print(json.dumps(timed(PARTICLES, LONG - SHORT)._asdict()))
