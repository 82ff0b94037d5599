"""Starts cases in plain Python: the files named on standard input, an answer in JSON for each.

``python tests/starting.py`` in an environment with ``NUMBA_DISABLE_JIT=1``: a case is then stepped
without compiling the loops of its effects first.
"""

import json
import sys
import traceback
import warnings
from pathlib import Path

from mpi4py import MPI

from psph.case import load
from psph.errors import Foreseen
from psph.runs.start import run
from psph.scene import Scene
from psph.simulation.plan import make_plan

STEPS = 2.5
"""Lengths of the first time step until the end."""


def start(path: Path) -> tuple[str, str]:
    """How the first steps of a case end: ``done``, ``stopped`` or ``broken``, and what is said."""
    try:
        scene = Scene(load(path))
        step, _ = make_plan(scene).longest_step(scene.starting_speed, 0.0)
        case = load(path, [f"time.end={STEPS * step!r}"])
        run(case, path.parent / "out", MPI.COMM_SELF, overwrite=True, say=lambda *line: None)
    except Foreseen as trouble:
        return "stopped", str(trouble)
    except Exception:
        return "broken", traceback.format_exc()
    return "done", ""


def main() -> None:
    """Answer until there are no more names."""
    warnings.simplefilter("ignore", RuntimeWarning)  # a checksum wraps around
    for line in sys.stdin:
        print(json.dumps(start(Path(line.strip()))), flush=True)


if __name__ == "__main__":
    main()
