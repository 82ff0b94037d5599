"""Measures of a finished run of the battery, from its files."""

import csv
import math
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import numpy as np
from scipy.optimize import minimize_scalar

from psph.fields import FLUID
from psph.lab.battery import gas_measures, solid_measures
from psph.lab.battery.order import checkerboard, nearest, pieces, voids
from psph.lab.battery.walls import lost
from psph.lab.study.experiment import path_of, read_experiment
from psph.lab.study.judge import window
from psph.output.errors import OutputError
from psph.output.interpolation import interpolated
from psph.output.reader import Run
from psph.scene import Scene

MEASURES = {
    "speed": "largest speed over the case's own",
    "late_speed": "largest speed at the end, m/s",
    "growth": "growth of the largest speed, 1/s; 0: none; inf: at once",
    "kinetic": "energy of motion at the end over that at the start",
    "energy": "change of energy over MU²/2",
    "momentum": "change of momentum over Σm|v|",
    "angular": "change of angular momentum over Σm|x||v|",
    "near_least": "smallest distance of neighbours over dx",
    "near_5": "5th percentile of the distance to the nearest over dx",
    "pieces": "pieces that are more than 1.5 dx apart",
    "voids": "empty space inside over that of the fluid",
    "noise": "p against its surroundings, rms, over ρU²/2",
    "lost": "particles lost",
    "probe_error": "probes against theory, relative",
    "probe_spread": "probes, standard deviation, Pa",
    "front_error": "front against experiment, largest relative error",
    "front_begun_later": "front against experiment, from the later start that makes the error least",
    "swing": "speed of a drop's swing after four periods over that at the start",
    "energy_left": "energy of motion over that of the exact solution, where it differs most",
    "exact_error": "velocity against the exact solution, L2",
    "ghia_error": "velocity on the centre lines against Ghia and others, rms over the lid's",
    **solid_measures.OF_SOLIDS,
    **gas_measures.OF_GASES,
}
"""Every measure in words; a run has those that apply to its case."""

LATE = 0.1
"""Last part of a run that counts as its end."""

SETTLED, SWINGING = 6.0, 0.6
"""Probes are read from this time on, s, or, in shorter runs, when this part of it is over."""

SPREAD, GROWN, FEW = 10.0, 1e3, 4
"""A speed grows that rises from the first factor times its least through the second; or it swings.
There a kick has spread over the waves and is still small.  What takes fewer rows of the log has not
grown: it was pushed."""


def measure(folder: Path, case, speed: float) -> dict[str, float]:
    """All measures of the run in ``folder``; ``speed`` is the case's own, m/s."""
    run, scene = Run(folder), Scene(case)
    if any(part.moves_freely and part.keeps_form for part in scene.layout.parts):
        return solid_measures.measure_solids(run, case)
    if case.ideal_gases:
        return gas_measures.measure_gases(run, case)
    log, frames = run.log(), [run.frame(k) for k in range(len(run.times))]
    fluids = [{n: v[f["kind"] == FLUID] for n, v in f.items()} for f in frames]
    found = _of_log(log, speed, scene)
    found["lost"] = float(lost(scene, fluids[-1]["position"]))
    if not np.isfinite(fluids[-1]["position"]).all():
        return found
    found |= _of_particles(scene, frames[-1], fluids[-1], speed)
    found |= _conserved(scene, log, fluids[0], fluids[-1], speed)
    for more in (_of_probes, _of_front, _of_exact, _of_drop, _of_cavity):
        found.update(more(run, case, fluids))
    found.update(_of_energy(run, scene, fluids))
    return found


def _of_log(log: dict, speed: float, scene) -> dict[str, float]:
    fast, time = log["largest_speed"], log["time"]
    late = fast[time >= (1.0 - LATE) * time[-1]]
    motion = log["kinetic_energy"]
    found = {
        "speed": float(fast.max()) / speed,
        "late_speed": float(late.max()),
        "growth": _growth(time, fast),
    }
    if motion[0] > 0.0:
        found["kinetic"] = float(motion[-1] / motion[0])
    return found


def _growth(time: np.ndarray, fast: np.ndarray) -> float:
    """The exponential rise of a speed through a factor of ``GROWN``, 1/s; or 0, or infinity."""
    top = int(np.argmax(fast >= 0.1 * fast.max()))
    moving = np.where(fast > 0.0, fast, np.inf)  # at the start all may be at rest
    least = int(np.argmin(moving[: top + 1]))
    low = SPREAD * moving[least]
    if not fast.max() >= GROWN * low:
        return 0.0
    begin, end = (least + int(np.argmax(fast[least:] >= v)) for v in (low, GROWN * low))
    if end - begin < FEW:
        return float("inf")
    return float(np.polyfit(time[begin:end], np.log(fast[begin:end]), 1)[0])


def _of_particles(scene, frame: dict, fluid: dict, speed: float) -> dict[str, float]:
    apart = nearest(scene, fluid["position"]) / scene.spacing
    stress = 0.5 * scene.species[0].density * speed**2
    return {
        "near_least": float(apart.min()),
        "near_5": float(np.percentile(apart, 5.0)),
        "pieces": float(pieces(scene, fluid["position"])),
        "voids": voids(scene, frame["position"], fluid["position"]),
        "noise": checkerboard(scene, frame, fluid) / stress,
    }


def _conserved(scene, log: dict, first: dict, last: dict, speed: float) -> dict[str, float]:
    """Energy everywhere, momenta where nothing from outside changes them."""
    mass = scene.species[0].mass
    energy = [log["kinetic_energy"][k] + log["potential_energy"][k] for k in (0, -1)]
    scale = 0.5 * mass * len(first["id"]) * speed**2
    found = {"energy": float(energy[1] - energy[0]) / scale}
    if scene.case.walls or any(scene.gravity) or scene.case.physics.central_force:
        return found
    pace = np.linalg.norm(first["velocity"], axis=1).sum() or speed
    found["momentum"] = float(
        np.linalg.norm(last["velocity"].sum(axis=0) - first["velocity"].sum(axis=0)) / pace
    )
    if not any(scene.layout.periods):
        found["angular"] = float(np.linalg.norm(_spin(last) - _spin(first)) / max(_lever(first), 1e-300))
    return found


def _spin(fluid: dict) -> np.ndarray:
    """Σ x × v."""
    missing = ((0, 0), (0, 3 - fluid["position"].shape[1]))
    x, v = (np.pad(fluid[name], missing) for name in ("position", "velocity"))
    return np.cross(x, v).sum(axis=0)


def _lever(fluid: dict) -> float:
    """Σ |x| |v|."""
    far, fast = (np.linalg.norm(fluid[name], axis=1) for name in ("position", "velocity"))
    return float((far * fast).sum())


def _of_probes(run: Run, case, fluids) -> Iterator[tuple[str, float]]:
    told = {name: p.theory["pressure"] for name, p in case.probes.items() if "pressure" in p.theory}
    if not told:
        return
    table = run.probes()
    late = table["time"] >= min(SETTLED, SWINGING * table["time"][-1])
    values = {name: table[f"{name}.pressure"][late] for name in told}
    yield "probe_error", float(max(abs(values[n].mean() / told[n] - 1.0) for n in told))
    yield "probe_spread", float(max(v.std() for v in values.values()))


def _of_front(run: Run, case, fluids) -> Iterator[tuple[str, float]]:
    for name, experiment in case.experiments.items():
        time, value = read_experiment(case, name, path_of(case).parent)
        table = run.probes()
        seen = window(case.study, time) & (time <= table["time"][-1])
        if not seen.any():
            continue
        error = partial(_front_error, time[seen], value[seen], table["time"], table[experiment.probe])
        yield "front_error", error(0.0)
        # A gate takes its time: what it costs the experiment is not known.
        later = minimize_scalar(error, bounds=(0.0, time[seen][0]), method="bounded")
        yield "front_begun_later", float(later.fun)


def _front_error(measured_times, measured, times, front, late: float) -> float:
    """The largest relative difference to a measured front, if the water began ``late`` s later."""
    ours = np.interp(measured_times - late, times, front)
    return float(np.abs(ours / measured - 1.0).max())


def _of_exact(run: Run, case, fluids) -> Iterator[tuple[str, float]]:
    if "velocity_l2" in (errors := run.errors()):
        yield "exact_error", float(errors["velocity_l2"][-1])


def _of_energy(run: Run, scene, fluids) -> Iterator[tuple[str, float]]:
    if not hasattr(scene.layout.exact, "velocity"):
        return
    ratios = []
    for time, fluid in zip(run.times, fluids):
        theirs = scene.layout.exact.velocity(fluid["position"], time, scene.starts.setting)
        if (expected := float((theirs**2).sum())) > 0.0:
            ratios.append(float((fluid["velocity"] ** 2).sum()) / expected)
    if ratios:
        yield "energy_left", max(ratios, key=lambda ratio: abs(ratio - 1.0))


DROP, PERIOD, PERIODS = "drop", 4.827, 4
"""The case of a drop in a central force, its period times the frequency of the force (Monaghan and
Rafiee 2013, for a first swing as fast as that), and after how many of them its swing is looked at."""


def _of_drop(run: Run, case, fluids) -> Iterator[tuple[str, float]]:
    if case.name != DROP:
        return
    log = run.log()
    turns = log["time"] * case.physics.central_force.frequency / PERIOD
    near = np.abs(turns - PERIODS) <= 0.25  # twice in a period it is round, and as fast as ever
    if turns[-1] >= PERIODS + 0.25:
        motion = log["kinetic_energy"]
        yield "swing", math.sqrt(float(motion[near].max() / motion[0]))


CAVITY, SIDE, OVER = "cavity", 1.0, 5
"""The case that Ghia and others computed, its side in m, and how many frames count."""


def _of_cavity(run: Run, case, fluids) -> Iterator[tuple[str, float]]:
    if case.name != CAVITY:
        return
    lid = max(np.linalg.norm(wall.velocity) for wall in case.walls.values())
    squares, periods = [], Scene(case).layout.periods
    for axis, name in ((0, "u"), (1, "v")):
        along, theirs = ghia(path_of(case).parent / f"experiments/ghia_1982_{name}.csv")
        at = np.full((len(along), 2), 0.5 * SIDE)
        at[:, 1 - axis] = along * SIDE
        ours = [
            interpolated(f["position"], f["velocity"][:, axis], at, case.space.spacing, periods)
            for f in fluids[-OVER:]
        ]
        squares.append((np.mean(ours, axis=0) / lid - theirs) ** 2)
    yield "ghia_error", math.sqrt(float(np.concatenate(squares).mean()))


def ghia(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Places on a centre line between the walls and the velocity there at Re 1000, over the lid's.

    Raises OutputError where the file is not there.
    """
    try:
        lines = [line for line in path.read_text(encoding="utf-8").splitlines() if line[:1] != "#"]
    except OSError as error:
        raise OutputError(f"{path}: {error.strerror}; it belongs beside the case") from None
    places, *_, values = zip(*list(csv.reader(lines))[1:])
    table = np.array([places, values], float)
    return tuple(table[:, (table[0] > 0.0) & (table[0] < 1.0)])
