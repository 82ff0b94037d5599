"""PySPH's end: runs one of its examples, in its own environment, and keeps what the judge needs.

``python pysph_side.py MODULE CLASS FILE PLAN``; PLAN is JSON with ``argv`` of the example, ``times`` of
states, and perhaps ``every`` s, ``lines`` and ``probe`` of samples.  Nothing of psph is imported here.
"""

import json
import sys
import time
from importlib import import_module

import numpy as np

ACROSS = 2.0
"""Particles within so many smoothing lengths of a line are kept, within FAR of the probe."""

FAR = 3.0


class Kept:
    """States at their times, and samples of what is near lines and a probe; a callback of its solver."""

    def __init__(self, plan: dict, particles):
        self.times, self.every = list(plan["times"]), plan.get("every")
        self.lines, self.probe = plan.get("lines", {}), plan.get("probe")
        self.particles, self.due, self.spent = particles, 0.0, 0.0
        [self.fluid] = [array for array in particles if array.name == "fluid"]
        self.arrays: dict[str, np.ndarray] = {}
        self.samples: dict[str, list] = {name: [] for name in ("t", "probe", *self.lines)}

    def __call__(self, solver) -> None:
        begun = time.process_time()
        now = solver.t + solver.dt
        if self.times and now >= self.times[0] - 1e-9:
            self.times.pop(0)
            self.state(now)
        if self.every and now >= self.due - 1e-12:
            self.due += self.every
            self.sample(now)
        self.spent += time.process_time() - begun

    def state(self, now: float) -> None:
        """All of the fluid."""
        of, k = self.fluid, sum(name.startswith("time") for name in self.arrays)
        self.arrays[f"time{k}"] = np.array(now)
        for name, fields in (("position", "xyz"), ("velocity", "uvw"), ("pressure", "p")):
            self.arrays[f"{name}{k}"] = np.column_stack([of.get(field) for field in fields])

    def sample(self, now: float) -> None:
        """Near each line number of the sample, place, volume; near the probe number, place, pressure."""
        number, h = len(self.samples["t"]), float(self.fluid.h[0])
        self.samples["t"].append(now)
        x, y, z, m, rho = self.fluid.get("x", "y", "z", "m", "rho")
        for name, (x0, y0) in self.lines.items():
            near = (x - x0) ** 2 + (y - y0) ** 2 < (ACROSS * h) ** 2
            self.samples[name].append(rows(number, near, x, y, z, m / rho))
        for array in self.particles if self.probe else ():
            x, y, z, p = array.get("x", "y", "z", "p")
            near = sum((a - b) ** 2 for a, b in zip((x, y, z), self.probe)) < (FAR * h) ** 2
            self.samples["probe"].append(rows(number, near, x, y, z, p))


def rows(number: int, near, *columns):
    """The number of the sample and the columns where ``near``."""
    return np.column_stack([np.full(near.sum(), float(number)), *(column[near] for column in columns)])


def main(module: str, name: str, file: str, plan: str) -> None:
    """Run the example."""
    asked = json.loads(plan)
    app = getattr(import_module(f"pysph.examples.{module}"), name)()
    app.setup(asked["argv"])
    kept = Kept(asked, app.particles)
    app.solver.add_post_step_callback(kept)
    if asked["times"]:
        app.solver.set_output_at_times(np.array(asked["times"]))  # its steps end there
    begun = time.process_time()
    app.solve()
    run = time.process_time() - begun - kept.spent
    samples = {key: np.vstack(of) if key != "t" else np.array(of) for key, of in kept.samples.items() if of}
    h = np.array(float(kept.fluid.h[0]))
    np.savez(file, run=np.array(run), h=h, **kept.arrays, **{f"near_{k}": v for k, v in samples.items()})


if __name__ == "__main__":
    main(*sys.argv[1:])
