"""How fast this machine is: particle-steps and pairs per second on a standard problem."""

import json
import math
import platform
import statistics
import time

import numpy as np

from psph.jit import compiled
from psph.output.ledger import Ledger
from psph.physics.compose import take
from psph.scene import Scene
from psph.smoothing import WendlandC2
from psph.solver.plan import make_plan
from psph.solver.setup import compile_ahead, create_particles
from psph.solver.step import Simulation
from psph.vectors import dot, nearest_image, subtract

WARM_UP, REPEATS, STEPS = 20, 5, 20
"""Steps before the clock starts, blocks that are timed, and steps of a block."""

JITTER, SPEED = 0.25, 50.0
"""Random shift in spacings (a perfect lattice flatters the caches), and c in m/s."""

NEIGHBOURS = {2: 20, 3: 57}
"""Neighbours inside the support where none are asked for."""

BALL = {2: math.pi, 3: 4.0 / 3.0 * math.pi}


def bench(
    comm, dimensions: int | None, particles: int, neighbours: int | None, as_json: bool
) -> None:
    """Time the jittered periodic box in 2D, 3D or both, and print what each gave; collective."""
    for dim in (dimensions,) if dimensions else (2, 3):
        result = measure(comm, dim, particles, neighbours or NEIGHBOURS[dim])
        if comm.rank != 0:
            continue
        if as_json:
            print(json.dumps(result), flush=True)
        else:
            print("\n".join(_lines(result)), flush=True)


def measure(comm, dimensions: int, particles: int, neighbours: int) -> dict:
    """Figures of one problem: rates are medians over blocks, per rank and in all."""
    scene = Scene(_box(dimensions, particles, neighbours))
    plan = make_plan(scene)
    compiling = compile_ahead(scene, plan, comm)
    ledger = Ledger()
    simulation = Simulation(scene, plan, create_particles(scene, plan, comm), comm, ledger)
    count = comm.allreduce(simulation.store.owned)
    pairs = comm.allreduce(_pairs_inside(simulation, scene))
    for _ in range(WARM_UP):
        simulation.step()
    ledger.seconds.clear()
    blocks = [_timed(simulation, comm) for _ in range(REPEATS)]
    rates = [count * STEPS / seconds for seconds in blocks]
    median = statistics.median(rates)
    return {
        "machine": f"{platform.machine()} {platform.processor()}".strip(),
        "problem": "jittered periodic box",
        "dimensions": dimensions,
        "particles": count,
        "neighbours": round(pairs / count, 1),
        "ranks": comm.size,
        "threads": 1,
        "precision": "double",
        "compile_seconds": round(compiling, 2),
        "particle_steps_per_second": median,
        "pairs_per_second": median * pairs / count,
        "per_rank": {
            "particle_steps_per_second": median / comm.size,
            "pairs_per_second": median * pairs / count / comm.size,
        },
        "spread": (max(rates) - min(rates)) / median,
        "rebuilds": simulation.domain.rebuilds,
        "share": {k: round(v / sum(blocks), 4) for k, v in sorted(ledger.seconds.items())},
    }


def _box(dimensions: int, particles: int, neighbours: int):
    from psph.case import Case

    reach = ((neighbours + 1) / BALL[dimensions]) ** (1 / dimensions)  # in spacings
    sides = max(16, round(particles ** (1 / dimensions)))
    corners = {"lower": [0.0] * dimensions, "upper": [1.0] * dimensions}
    return Case.model_validate(
        {
            "space": {
                "dimensions": dimensions,
                "spacing": 1.0 / sides,
                "smoothing": reach / WendlandC2.support,
                "kernel": "wendland-c2",
                "periodic": ["x", "y", "z"][:dimensions],
                **corners,
            },
            "time": {"end": 1.0},
            "physics": {"sound_speed": SPEED, "artificial_viscosity": 0.1},
            "fluids": {"water": {"shape": {"box": corners}, "jitter": JITTER, "seed": 1}},
        }
    )


def _timed(simulation: Simulation, comm) -> float:
    comm.Barrier()
    begun = time.perf_counter()
    for _ in range(STEPS):
        simulation.step()
    comm.Barrier()
    return time.perf_counter() - begun


def _pairs_inside(simulation: Simulation, scene) -> int:
    """Ordered pairs inside the kernel's support among this rank's particles."""
    store, lists = simulation.store, simulation.domain.lists
    support = scene.kernel.support * scene.smoothing_length
    return count_inside(
        store.view(), simulation.domain.periods, support * support, store.low, store.owned,
        lists.begin, lists.blocks, lists.lists,
    )


@compiled
def count_inside(view, periods, support2, low, owned, begin, blocks, lists):
    """Entries of the lists that lie within the support."""
    inside = 0
    for k in range(owned):
        i = take(view, low + k)
        for n in range(begin[k], begin[k] + np.uint64(blocks[k]) * np.uint64(4)):
            x_ij = nearest_image(subtract(i.position, take(view, lists[n]).position), periods)
            inside += dot(x_ij, x_ij) < support2
    return inside


def _lines(result: dict) -> list[str]:
    rate, pairs = (result["per_rank"][k] for k in ("particle_steps_per_second", "pairs_per_second"))
    shares = ", ".join(f"{k} {100 * v:.1f} %" for k, v in result["share"].items() if v > 5e-4)
    return [
        f"{result['problem']}, {result['dimensions']}D, {result['particles']:,} particles, "
        f"{result['neighbours']:.0f} neighbours, {result['ranks']} ranks, double precision",
        f"  per rank    {rate / 1e6:.2f} M particle-steps/s, {pairs / 1e6:.0f} M pairs/s "
        f"(spread {100 * result['spread']:.0f} %)",
        f"  in all      {result['particle_steps_per_second'] / 1e6:.2f} M particle-steps/s",
        f"  share       {shares}",
        f"  compiled    in {result['compile_seconds']} s, not counted",
    ]
