"""psph in the comparison.

``python -m psph.lab.peers.own CASE FOLDER KEY=VALUE...`` runs a case and says its CPU seconds.
"""

import json
import sys
import time
from functools import partial
from pathlib import Path

import numpy as np

from psph.case import load
from psph.fields import FLUID
from psph.lab.errors import PeersError
from psph.lab.peers.process import LOG, commit, finished
from psph.lab.peers.records import Job, Outcome, State
from psph.output.reader import Run
from psph.parallel.reductions import world
from psph.runs import start
from psph.version import __version__

CASES = Path("run/cases")

PATIENCE = 3600.0

BOX = (
    "time.end=2.0",
    "space.spacing=0.05",
    "space.lower=[-0.15, 0.5, -0.15]",
    "space.upper=[3.4, 1.15, 2.0]",
    "fluids.water.shape.box.upper=[3.25, 1.0, 0.55]",
    "walls.tank.shape.difference.from.box={lower = [-0.15, -0.15, -0.15], upper = [3.4, 1.15, 1.0]}",
    "walls.tank.shape.difference.minus=[{box = {lower = [0.0, 0.0, 0.0], upper = [3.25, 1.0, 1.0]}}]",
    "walls.box.shape.box={lower = [0.65, 0.3, 0.0], upper = [0.8, 0.7, 0.15]}",
    "probes.P1.position=[0.8, 0.5, 0.021]",
    "probes.P3.position=[0.8, 0.5, 0.101]",
    "gauges.S1.sensor.position=[0.8, 0.5, 0.021]",
)
"""Kleefsman's box laid on a lattice of 0.05 m: the water stands 1.2 m from the box, as PySPH's does there."""

TANK = (
    "time.end=4.0",
    "output.frames=4.0",
    "space.spacing=0.02",
    "physics.sound_speed=9.486833",
    "physics.gravity=[0.0, -1.0]",
    "fluids.water.shape.box.upper=[2.0, 0.9]",
    "walls.tank.shape.difference.from.box={lower = [-0.1, -0.1], upper = [2.1, 1.0]}",
    "walls.tank.shape.difference.minus=[{box = {lower = [0.0, 0.0], upper = [2.0, 1.0]}}]",
)
"""The tank of PySPH's hydrostatic_tank: 2 m long, 0.9 m deep, g = 1 m/s², c = 10 √(gH)."""

RUNS: dict[str, dict[str, tuple[str, tuple[str, ...]]]] = {
    "taylor_green": {
        "psph, `taylor_green.toml`": (
            "taylor_green.toml",
            ("physics.sound_speed=10", "time.end=1.0", "output.frames=1.0"),
        ),
        "psph, default scheme": (
            "hard/taylor_green.toml",
            ("fluids.water.viscosity=0.01", "time.end=1.0", "output.frames=1.0"),
        ),
        "psph, default scheme, jittered": (
            "hard/taylor_green.toml",
            ("fluids.water.viscosity=0.01", "fluids.water.jitter=0.1", "time.end=1.0", "output.frames=1.0"),
        ),
    },
    "cavity": {"psph": ("hard/cavity.toml", ("time.end=10.0", "output.frames=5.0"))},
    "tank": {"psph": ("hard/tank.toml", TANK)},
    "box": {
        "psph, half": ("dam_break_on_box.toml", BOX),
        "psph, whole": (
            "dam_break_on_box.toml",
            (*BOX, "space.symmetry=[]", "space.origin=[0.0, 0.0, 0.0]", "space.lower=[-0.15, -0.15, -0.15]"),
        ),
    },
}
"""By benchmark and row: the case, and the keys that are changed in it."""


class Own:
    """psph itself."""

    name = "psph"
    objections: dict[str, str] = {}

    def prepare(self) -> str:
        """The commit of its sources, or its version."""
        return commit(Path(__file__).parent) or __version__

    def jobs(self, benchmark: str) -> list[Job]:
        """Its runs of a benchmark."""
        runs = RUNS.get(benchmark, {})
        return [Job(label, partial(run, CASES / case, keys)) for label, (case, keys) in runs.items()]


def run(case: Path, keys: tuple[str, ...], folder: Path) -> Outcome:
    """A case in a process of its own."""
    if not case.is_file():
        raise PeersError(f"{case}: no such file; start from the folder of psph")
    here = {"PYTHONPATH": str(Path(__file__).parents[3])}
    words = [sys.executable, "-m", "psph.lab.peers.own", case.absolute(), "out", *keys]
    whole = finished(f"psph, {case.stem}", words, folder, PATIENCE, here)
    told = json.loads((folder / LOG).read_text(encoding="utf-8").strip().splitlines()[-1])
    return Outcome(states(folder / "out"), gauges(folder / "out"), told["run"], whole)


def states(folder: Path) -> tuple[State, ...]:
    """The fluid in each frame after the first, wrapped into the unit square where it is periodic there."""
    results = Run(folder)
    found = []
    for k, time_ in enumerate(results.times):
        if k == 0:
            continue
        frame = results.frame(k, "kind", "position", "velocity", "pressure")
        fluid = frame["kind"] == FLUID
        found.append(State(float(time_), *(frame[of][fluid] for of in ("position", "velocity", "pressure"))))
    return tuple(found)


def gauges(folder: Path) -> dict[str, np.ndarray]:
    """Times, heights and the pressure of the box's case; empty: another case."""
    results = Run(folder)
    probes = results.probes()
    if "P1.pressure" not in probes or not results.gauges():
        return {}
    levels = {of: results.measured(f"{of}.wetted") for of in ("H2", "H4")}
    t = probes["time"]
    read = {of: np.interp(t, table["time"], table[f"{of}.wetted"]) for of, table in levels.items()}
    return {"t": t, "P1": probes["P1.pressure"], **read}


def main(arguments: list[str]) -> int:
    """Run a case from its first step on, and print the CPU seconds of that; the exit code."""
    case, folder, *keys = arguments
    begun: list[float] = []

    def after(simulation) -> bool:
        if not begun:
            begun.append(time.process_time())
        return False

    start.run(load(Path(case), keys), Path(folder), world(), overwrite=True, after_step=after)
    print(json.dumps({"run": time.process_time() - begun[0]}))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
