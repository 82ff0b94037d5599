"""What the default scheme costs beside plain SPH: three dam breaks in turns, from the gate on."""

import math
import statistics
import time
from collections.abc import Iterable, Iterator

from psph.case.schemes import SCHEMES, STABLE
from psph.engine.threads import threads
from psph.lab.bench import DAM
from psph.lab.bench.falling import FALLEN
from psph.lab.bench.measure import LAYOUTS, BenchProblem, machine, scene_of, warmed_up
from psph.lab.bench.resolution import BALL, KERNEL
from psph.lab.bench.tank import GRAVITY, HEIGHT
from psph.lab.errors import BenchError
from psph.simulation.step import Simulation

DEFAULT, USUAL, ALIKE = "default", "usual", "alike"

SMOOTHING = {USUAL: 1.2, ALIKE: SCHEMES[STABLE]["space.smoothing"]}
"""h/dx of plain SPH as it is usually run, and for as many neighbours as the default scheme has."""

SETTINGS = {
    DEFAULT: (f"scheme={STABLE}", "physics.artificial_viscosity=off"),
    **{name: (f"space.smoothing={ratio}",) for name, ratio in SMOOTHING.items()},
}
"""The keys that each of them changes in the dam break of the bench (psph.lab.bench.tank): Wendland C2 and
artificial viscosity of 0.1."""

PARTICLES, NEIGHBOURS = {2: 20_000, 3: 100_000}, {2: 20, 3: 57}
"""How large the dam breaks are; the walls have layers enough for any of the settings."""

BLOCKS = 40
"""Parts of the fall; in each part every setting has its turn."""

FIFTHS = 5
"""The spread of a price is taken over so many parts of the fall."""


def price(comm, dimensions: int, particles: int | None = None, blocks: int | None = None) -> dict:
    """Figures of the fall in 2D or 3D, ready for JSON; collective.

    Each setting simulates the same stretch of time in each of its turns, with the time step that it
    needs: a second of flow of one has the price of a second of flow of another.
    """
    blocks = blocks or BLOCKS
    if blocks < FIFTHS:
        raise BenchError(f"bench --price --turns {blocks}: give at least {FIFTHS}")
    asked = BenchProblem(
        DAM, dimensions, particles or PARTICLES[dimensions], NEIGHBOURS[dimensions], "double"
    )
    layout = LAYOUTS[DAM](dimensions, asked.neighbours, asked.particles)
    scenes = {name: scene_of(asked, layout, keys) for name, keys in SETTINGS.items()}
    running = {name: warmed_up(layout, scene, comm)[0] for name, scene in scenes.items()}
    begun = max(simulation.time for simulation in running.values())
    for simulation in running.values():
        _go_on(simulation, begun)
    end = FALLEN * math.sqrt(HEIGHT / GRAVITY)
    turns = [
        {
            name: _timed(simulation, begun + (end - begun) * block / blocks, comm)
            for name, simulation in _rotated(running, block)
        }
        for block in range(1, blocks + 1)
    ]
    return {
        "machine": machine(),
        "dimensions": dimensions,
        "particles": int(scenes[DEFAULT].census.counts.sum()),
        "ranks": comm.size,
        "threads": threads(),
        "precision": asked.precision,
        "turns": blocks,
        "settings": {
            name: {
                "keys": [*SETTINGS[name]],
                "kernel": scenes[name].case.space.kernel,
                "smoothing": scenes[name].case.space.smoothing,
                "neighbours_in_bulk": _in_bulk(scenes[name]),
                "steps": sum(turn[name][1] for turn in turns),
                "seconds": sum(turn[name][0] for turn in turns),
            }
            for name in SETTINGS
        },
        "price": {name: _price(turns, name) for name in SMOOTHING},
    }


def _rotated(running: dict[str, Simulation], block: int) -> Iterable[tuple[str, Simulation]]:
    """Who comes first differs from turn to turn."""
    every = list(running.items())
    first = block % len(every)
    return every[first:] + every[:first]


def _go_on(simulation: Simulation, until: float) -> int:
    """So many steps it took to that time, s."""
    steps = simulation.steps
    while simulation.time < until:
        simulation.step()
    return simulation.steps - steps


def _timed(simulation: Simulation, until: float, comm) -> tuple[float, int]:
    """(seconds, steps) of a turn."""
    comm.Barrier()
    begun = time.perf_counter()
    steps = _go_on(simulation, until)
    comm.Barrier()
    return time.perf_counter() - begun, steps


def _in_bulk(scene) -> int:
    """Neighbours of a particle deep in the fluid."""
    reach = scene.support / scene.spacing
    return round(BALL[scene.dimensions] * reach**scene.dimensions) - 1


def _price(turns: list[dict], other: str) -> dict:
    """The default over another setting: the median over the parts of the fall, and the spread."""
    parts = [_over(part, other) for part in _parts(turns)]
    medians = [statistics.median(column) for column in zip(*parts)]
    spread = max((max(c) - min(c)) / m for c, m in zip(zip(*parts), medians))
    return dict(zip(("per_step", "per_second_of_flow"), medians)) | {"spread": spread}


def _parts(turns: list[dict]) -> Iterator[list[dict]]:
    ends = [len(turns) * k // FIFTHS for k in range(FIFTHS + 1)]
    return (turns[a:b] for a, b in zip(ends, ends[1:]))


def _over(turns: list[dict], other: str) -> tuple[float, float]:
    """(a step, a second of flow) of the default over that of the other."""
    (ours, our_steps), (theirs, their_steps) = (
        map(sum, zip(*(turn[name] for turn in turns))) for name in (DEFAULT, other)
    )
    return (ours / our_steps) / (theirs / their_steps), ours / theirs


def words(result: dict) -> Iterator[str]:
    """A result for the terminal."""
    yield (
        f"dam break in {result['dimensions']}D from the gate to half-way down, "
        f"{result['particles']:,} particles, {result['ranks']} ranks of {result['threads']} threads"
    )
    default = result["settings"][DEFAULT]
    yield (
        f"  default     {default['neighbours_in_bulk']} neighbours in the bulk, "
        f"{default['steps']:,} steps in {default['seconds']:.1f} s"
    )
    for name, price in result["price"].items():
        other = result["settings"][name]
        yield (
            f"  plain SPH   {KERNEL} at h/dx {other['smoothing']:g}, {other['neighbours_in_bulk']} "
            f"neighbours in the bulk, {other['steps']:,} steps in {other['seconds']:.1f} s: the default "
            f"takes {price['per_step']:.2f} times as long a step, {price['per_second_of_flow']:.2f} times as "
            f"long a second of flow (spread {100 * price['spread']:.0f} %)"
        )
