"""Measures of a finished run of elastic solids, from its files, and what a step of it costs."""

from collections.abc import Iterator

import numpy as np

from psph.composition.count import flops_of
from psph.fields import WALL
from psph.lab.battery.order import nearest, pieces
from psph.output.reader import Run
from psph.physics.solid.deformation import KERNEL, Gradient, support_of
from psph.physics.stress.invariants import j2
from psph.runs.footprint import bytes_per_particle
from psph.scene import Scene
from psph.scene.sites import sites_within
from psph.simulation.plan import make_plan
from psph.simulation.solid_pairs import Weights, inner_force, reference_pair
from psph.simulation.solid_plan import solid_plan
from psph.smoothing import kernel

OF_SOLIDS = {
    "drift": "change of the energy of motion, deformation and height over the largest energy of motion",
    "flight": "energy of the solids' flight at the end over that at the start",
    "period_error": "mean period of the swing against that of a beam, relative",
    "swing_kept": "last swing over the first",
    "steps": "time steps",
    "operations": "operations of a particle in a step",
    "bytes": "bytes of a particle",
}
"""Beside those of fluids."""

PERIODS = {"oscillating_plate": 0.2565}
"""Of a beam by Timoshenko, by the name of the case, s."""


def measure_solids(run: Run, case) -> dict[str, float]:
    """All measures of a run of solids alone."""
    scene, log = Scene(case), run.log()
    plan = make_plan(scene)
    frames = [run.frame(k) for k in range(len(run.times))]
    last = _moving(frames[-1])
    found = {"lost": 0.0, "steps": float(log["step"][-1])}
    found["operations"] = operations(scene, plan)
    found["bytes"] = sum(bytes_per_particle(scene, plan))
    if not np.isfinite(last["position"]).all():
        return found
    apart = nearest(scene, last["position"]) / scene.spacing
    found |= {
        "near_least": float(apart.min()),
        "near_5": float(np.percentile(apart, 5.0)),
        "pieces": float(pieces(scene, last["position"])),
        "kinetic": float(log["kinetic_energy"][-1] / max(log["kinetic_energy"][0], 1e-300)),
    }
    found["drift"] = _drift(scene, plan, log, frames)
    found.update(_momenta(scene, _moving(frames[0]), last))
    found.update(_swings(run, case))
    return found


def operations(scene, plan) -> float:
    """Operations of a particle in a step: those of its pairs, in every pass that comes each step."""
    of_passes = 0.0
    if plan.passes:
        around = sites_within(scene, scene.support)
        of_passes = around * plan.flops_per_pair(scene.layout.periods)
    own_plan = solid_plan(plan)
    if not own_plan.solids:
        return of_passes
    h = own_plan.smoothing_length
    own, d = kernel(KERNEL, h, scene.dimensions), scene.dimensions
    apart = (0.5 * h / d**0.5,) * d
    shown = {"reference": apart, "position": apart, "flux": (1.0,) * d * d}
    gradient = Gradient(scene.layout.periods)

    def first(weighed, i, j):
        pair = reference_pair(Weights(weighed, scene.layout.periods, 0.0), 0, i, j, 0.0)
        return gradient.gather((0.0,) * d * d, i, j, pair)

    def second(weighed, i, j):
        weights = Weights(weighed, scene.layout.periods, 0.0)
        return inner_force(weights, i, j, reference_pair(weights, 0, i, j, 0.0), 1.0)

    of_pair = sum(flops_of(each, own, shown, {"volume": 1.0}) for each in (first, second))
    return of_passes + sites_within(scene, support_of(h)) * of_pair


def _moving(frame: dict) -> dict:
    return {name: values[frame["kind"] != WALL] for name, values in frame.items()}


def _drift(scene, plan, log: dict, frames: list[dict]) -> float:
    """Of the sum of all energies that are known."""
    motion = log["kinetic_energy"]
    held = motion + log["potential_energy"]
    if "stored_energy" in log:
        ends = (held + log["stored_energy"])[[0, -1]]
    else:
        ends = held[[0, -1]] + [_stored(scene, plan, frames[k]) for k in (0, -1)]
    return float((ends[1] - ends[0]) / motion.max())


def _stored(scene, plan, frame: dict) -> float:
    """Energy of compression and of shear, Σ m [∫p/ρ² dρ + J₂/(2Gρ)], J: of small elastic strains."""
    density, like = frame["density"], (0.0,) * scene.dimensions
    total = 0.0
    for number, one in enumerate(scene.species):
        own = frame["group"] == number
        if not one.shear_modulus or not own.any():
            continue
        rho = density[own]
        sheared = j2(tuple(frame["deviator"][own].T), like) / (2.0 * one.shear_modulus * rho)
        pressed = one.law.energy(rho, one.density, scene.sound_speed)
        total += one.mass * float((sheared + pressed).sum())
    return total


def _momenta(scene, first: dict, last: dict) -> Iterator[tuple[str, float]]:
    """Momenta where nothing acts from outside, and the energy of the solids' flight."""
    if scene.layout.parts.clamps or scene.layout.parts.walls or any(scene.gravity):
        return
    pace = np.linalg.norm(first["velocity"], axis=1).sum()
    yield (
        "momentum",
        float(np.linalg.norm(last["velocity"].sum(axis=0) - first["velocity"].sum(axis=0)) / pace),
    )
    yield "angular", abs(_spin(last) - _spin(first)) / _lever(first)
    if len(scene.layout.parts) > 1:
        flights = [sum(_flight(frame, n) for n in range(len(scene.layout.parts))) for frame in (first, last)]
        yield "flight", flights[1] / flights[0]


def _flight(frame: dict, group: int) -> float:
    """Σ|v|²/2 of a solid's mean velocity, per mass of a particle."""
    v = frame["velocity"][frame["group"] == group]
    return 0.5 * len(v) * float((v.mean(axis=0) ** 2).sum())


def _spin(frame: dict) -> float:
    """Σ x × v about z."""
    x, v = frame["position"], frame["velocity"]
    return float((x[:, 0] * v[:, 1] - x[:, 1] * v[:, 0]).sum())


def _lever(frame: dict) -> float:
    far, fast = (np.linalg.norm(frame[name], axis=1) for name in ("position", "velocity"))
    return float((far * fast).sum())


def _swings(run: Run, case) -> Iterator[tuple[str, float]]:
    """Period and size of the swing of the gauge ``tip``."""
    if case.name not in PERIODS:
        return
    table = run.gauges()["tip"]
    time, tip = table["time"], table[next(name for name in table if name.endswith("_y"))]
    turns = list(_turns(time, tip))
    if len(turns) < 3:
        return
    times, heights = np.array(turns).T
    yield "period_error", float(2.0 * np.diff(times).mean() / PERIODS[case.name] - 1.0)
    sizes = np.abs(np.diff(heights))
    yield "swing_kept", float(sizes[-1] / sizes[0])


def _turns(time: np.ndarray, y: np.ndarray) -> Iterator[tuple[float, float]]:
    """Where a curve turns, by parabolas through three points: time and value."""
    for k in range(1, len(y) - 1):
        if (y[k] - y[k - 1]) * (y[k + 1] - y[k]) < 0.0:
            a, b, c = np.polyfit(time[k - 1 : k + 2] - time[k], y[k - 1 : k + 2], 2)
            yield float(time[k] - 0.5 * b / a), float(c - 0.25 * b * b / a)
