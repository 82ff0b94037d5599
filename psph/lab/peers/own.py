"""psph in the comparison, as it is and as older sources had it."""

import json
import sys
from functools import partial
from pathlib import Path

import numpy as np

from psph.fields import FLUID
from psph.lab.errors import PeersError, RunBlewUp
from psph.lab.peers.own_runs import EARLIER, RUNS
from psph.lab.peers.process import LOG, commit, finished
from psph.lab.peers.records import Job, Outcome, State
from psph.output.reader import Run
from psph.version import __version__

HERE = Path(__file__).parents[3]
CASES = Path("run/cases")

PATIENCE = 3600.0

BLOWN = "the run blew up"
"""In the last words of a run that a guard has ended."""


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
        return [Job(label, partial(run, HERE, CASES / case, keys)) for label, (case, keys) in runs.items()]


class Earlier:
    """psph of older ``sources``, a folder: its default scheme, in the cases that it had."""

    name = "psph before"
    objections: dict[str, str] = {}

    def __init__(self, sources: Path):
        self.sources = sources.absolute()
        if not (self.sources / CASES).is_dir():
            raise PeersError(f"--before {sources}: no {CASES} there; give a folder of older sources of psph")

    def prepare(self) -> str:
        """The commit of the sources.  PeersError: they have none."""
        found = commit(self.sources)
        if not found:
            raise PeersError(f"--before {self.sources}: no commit; give a checkout by git")
        return found

    def jobs(self, benchmark: str) -> list[Job]:
        """Its runs of a benchmark."""
        runs = EARLIER.get(benchmark, {})
        return [
            Job(f"{self.name}, {words}", partial(run, self.sources, self.sources / CASES / case, keys))
            for words, (case, keys) in runs.items()
        ]


def run(sources: Path, case: Path, keys: tuple[str, ...], folder: Path) -> Outcome:
    """A case in a process of its own, by these ``sources`` of psph."""
    if not case.is_file():
        raise PeersError(f"{case}: no such file; start from the folder of psph")
    words = [sys.executable, "-P", Path(__file__).with_name("timed.py"), case.absolute(), "out", *keys]
    try:
        whole = finished(f"psph, {case.stem}", words, folder, PATIENCE, {"PYTHONPATH": str(sources)})
    except PeersError as failed:
        raise (RunBlewUp(str(failed)) if BLOWN in str(failed) else failed) from None
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
