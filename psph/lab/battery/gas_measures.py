"""Measures of a finished run of ideal gases, from its files."""

from collections.abc import Iterator

import numpy as np

from psph.lab.battery.order import nearest
from psph.output.reader import Run
from psph.scene import Scene

OF_GASES = {
    "gas_energy": "change of all energy, of heat too, over that at the start",
    "coldest": "least thermal energy by mass at the end over the least at the start",
    "density_error": "density against the exact solution, L2",
    "pressure_error": "pressure against the exact solution, L2",
    "velocity_error": "velocity against the exact solution, L2",
    "closest": "smallest distance of neighbours over the spacing that each has by its density",
}
"""Beside those of fluids."""

ENERGIES = ("kinetic_energy", "potential_energy", "thermal_energy")


def measure_gases(run: Run, case) -> dict[str, float]:
    """All measures of a run of ideal gases alone, in a domain that none of it leaves."""
    scene, log = Scene(case), run.log()
    first, last = run.frame(0), run.frame(len(run.times) - 1)
    whole = sum(log[name] for name in ENERGIES)
    found = {"lost": float(len(first["id"]) - len(last["id"])), "steps": float(log["step"][-1])}
    found["gas_energy"] = float(np.abs(whole / whole[0] - 1.0).max())
    if log["kinetic_energy"][0] > 0.0:
        found["kinetic"] = float(log["kinetic_energy"][-1] / log["kinetic_energy"][0])
    if not np.isfinite(last["position"]).all():
        return found
    found["coldest"] = float(last["thermal_energy"].min() / first["thermal_energy"].min())
    own = last["smoothing_length"] / case.space.smoothing
    found["closest"] = float((nearest(scene, last["position"]) / own).min())
    found.update(_of_exact(run))
    return found


def _of_exact(run: Run) -> Iterator[tuple[str, float]]:
    """Where the case has an exact solution."""
    errors = run.errors()
    for name in ("density", "pressure", "velocity"):
        if f"{name}_l2" in errors:
            yield f"{name}_error", float(errors[f"{name}_l2"][-1])
