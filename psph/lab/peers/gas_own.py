"""psph's own pace in the blast: ``python -m psph.lab.peers.gas_own`` prints what its bench's steps take."""

import json
import os
import sys
import time
from pathlib import Path

from psph.lab.bench.measure import go_on, warmed_up, work
from psph.lab.peers.gas import LONG, PARTICLES, SHORT, GasPace, GasStart, blast
from psph.lab.peers.own import HERE, Own
from psph.lab.peers.process import LOG, finished
from psph.parallel.reductions import alone
from psph.scene import Scene

PATIENCE = 3600.0


class OwnGas(Own):
    """psph itself, in a process of its own."""

    scheme = "`gas`: lists of neighbours, one step for all; double precision"

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
    return GasPace(made * there, seconds, f"{pairs / there:.0f}")


if __name__ == "__main__":
    print(json.dumps(timed(PARTICLES, LONG - SHORT)._asdict()))
