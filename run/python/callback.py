"""Look at a run while it goes on, and end it when what one waits for has happened."""

from pathlib import Path

import numpy as np

import psph

CASES = Path(__file__).parents[1] / "cases"


def reached(moment):
    """End the run once any particle of the fluid is past x = 0.6 m, on whatever rank it is."""
    fluid = moment["kind"] == 0
    [front] = moment.largest([moment["position"][fluid, 0].max(initial=-np.inf)])
    if moment.comm.rank == 0:
        print(f"t = {moment.time:.3f} s: front at {front:.3f} m, {moment.largest_speed:.2f} m/s")
    return front > 0.6


case = psph.load(CASES / "minimal.toml").with_({"space.spacing": 0.04, "time.end": 0.5})
results = psph.run(case, "results/python/watched", callback=reached, every=0.02, overwrite=True, quiet=True)
print(f"ended at {results.frames[-1].time:.3f} s; psph.resume({str(results.folder)!r}) would go on")
