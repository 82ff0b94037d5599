"""PySPH: its own examples, with the options that their authors gave them."""

import json
from collections.abc import Iterator, Mapping
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from psph.lab.peers import pysph_side
from psph.lab.peers.environment import Environment
from psph.lab.peers.process import finished
from psph.lab.peers.records import Job, Outcome, State

PATIENCE = 7200.0

LINE = np.linspace(0.0, 0.9, 361)
"""Points of a line of a wave gauge, m from the floor."""


class Example(NamedTuple):
    """One of its examples: module, class, options, times of states, and the samples of gauges."""

    module: str
    of: str
    argv: tuple[str, ...]
    times: tuple[float, ...] = ()
    gauges: Mapping[str, Any] = {}


GAUGES: dict[str, Any] = {
    "every": 0.002,
    "lines": {"H2": (3.22 - 0.992, 0.0), "H4": (3.22 - 2.638, 0.0)},
    "probe": (2.42, 0.0, 0.021),
}
"""Kleefsman's, where its example has them: the water stands at x = 0 there."""

RUNS = {
    "taylor_green": {
        f"PySPH `{scheme}`{start}": Example(
            "taylor_green",
            "TaylorGreen",
            ("--nx", "50", "--tf", "1.0", "--scheme", scheme, "--perturb", jitter),
            (1.0,),
        )
        for start, jitter in (("", "0"), (", jittered", "0.2"))
        for scheme in ("tvf", "edac")
    },
    "cavity": {
        f"PySPH `{scheme}`": Example(
            "cavity",
            "LidDrivenCavity",
            ("--nx", "50", "--re", "1000", "--tf", "10.0", "--scheme", scheme),
            (5.0, 10.0),
        )
        for scheme in ("tvf", "edac")
    },
    "tank": {"PySPH": Example("hydrostatic_tank", "HydrostaticTank", ("--tf", "4.0"), (4.0,))},
    "box": {"PySPH": Example("dam_break_3d", "DamBreak3D", ("--dx", "0.05", "--tf", "2.0"), (), GAUGES)},
}


class PySPH:
    """PySPH in an environment of its own."""

    name = "PySPH"
    objections = {
        "taylor_green": "start from disorder, since on a lattice the vortices tear; the example offers "
        "shifting, remeshing and corrected kernels, all left off here.",
        "cavity": "its example runs at Re 100 as it is, and averages five outputs.",
        "tank": "its gravity grows for 1 s from uniform density, and its water sinks by the 0.5 % that "
        "this speed of sound allows: fit the level.",
        "box": "use dx 0.02, as the example does (14 hours); its walls keep water off by a spacing, and "
        "pressure sticks to those of the box; it has no density diffusion; 50 damped steps delay its start; "
        "its lattice holds 627 of 675 kg.",
    }

    def __init__(self, environment: Environment):
        self.environment = environment

    def prepare(self) -> str:
        """Install it; its version."""
        return self.environment.provide(
            "PySPH", "import pysph; print(pysph.__version__)", self.environment.pysph()
        )

    def jobs(self, benchmark: str) -> list[Job]:
        """Its runs of a benchmark."""
        return [Job(label, partial(self.run, example)) for label, example in RUNS.get(benchmark, {}).items()]

    def run(self, example: Example, folder: Path) -> Outcome:
        """An example in a process of its own, on one thread."""
        plan = {
            "argv": [*example.argv, "--no-openmp", "--disable-output", "-q", "-d", "out"],
            "times": example.times,
            **example.gauges,
        }
        words = [pysph_side.__file__, example.module, example.of, "kept.npz", json.dumps(plan)]
        python = self.environment.python
        home = {"HOME": str(self.environment.folder)}  # where it keeps what it compiles
        whole = finished(f"PySPH, {example.module}", [python, "-P", *words], folder, PATIENCE, home)
        with np.load(folder / "kept.npz") as kept:
            return Outcome(tuple(states(kept)), series(kept), float(kept["run"]), whole)


def states(kept) -> Iterator[State]:
    """Those that were kept, in the plane where it is 2D."""
    k = 0
    while f"time{k}" in kept:
        dim = 2 if not kept[f"position{k}"][:, 2].any() else 3
        place, velocity = (kept[f"{of}{k}"][:, :dim] for of in ("position", "velocity"))
        yield State(float(kept[f"time{k}"]), place, velocity, kept[f"pressure{k}"][:, 0])
        k += 1


def series(kept) -> dict[str, np.ndarray]:
    """The heights at the lines in m and the pressure of the probe in Pa at the times of the samples."""
    if "near_t" not in kept:
        return {}
    t, h = kept["near_t"], float(kept["h"])
    found = {"t": t, "P1": shepard(kept["near_probe"], len(t), np.array(GAUGES["probe"]), h)}
    for name, place in GAUGES["lines"].items():
        found[name] = wetted(kept[f"near_{name}"], len(t), place, h)
    return found


def wetted(near: np.ndarray, samples: int, place: tuple[float, float], h: float) -> np.ndarray:
    """Length of a vertical line where ΣV W is ½ or more, m, as ``wetted`` of psph; Wendland C2."""
    found = np.zeros(samples)
    for k in range(samples):
        x, y, z, volume = near[near[:, 0] == k, 1:].T
        r = np.sqrt((x - place[0]) ** 2 + (y - place[1]) ** 2 + (LINE[:, None] - z) ** 2) / h
        weight = 21.0 / (16.0 * np.pi * h**3) * np.clip(1.0 - 0.5 * r, 0.0, None) ** 4 * (1.0 + 2.0 * r)
        found[k] = ((weight @ volume) >= 0.5).sum() * (LINE[1] - LINE[0])
    return found


def shepard(near: np.ndarray, samples: int, place: np.ndarray, h: float) -> np.ndarray:
    """Mean pressure by a Gaussian over fluid, box and walls, Pa: as the example's own picture has it."""
    found = np.zeros(samples)
    for k in range(samples):
        of = near[near[:, 0] == k, 1:]
        weight = np.exp(-((of[:, :3] - place) ** 2).sum(axis=1) / h**2)
        found[k] = weight @ of[:, 3] / weight.sum() if len(of) else 0.0
    return found
