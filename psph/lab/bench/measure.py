"""The time of a problem's steps after a warm-up, block by block."""

import os
import platform
import statistics
import time
from collections.abc import Sequence
from contextlib import nullcontext
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np

from psph.case import checked
from psph.composition.pair import take
from psph.engine.jit import compiled, processor
from psph.engine.threads import threads
from psph.lab.bench import BLOCK, BOX, DAM, FALLING, GAS
from psph.lab.bench.blast import Blast
from psph.lab.bench.block import Block
from psph.lab.bench.box import FluidBox
from psph.lab.bench.falling import Falling
from psph.lab.bench.peer import Peer
from psph.lab.bench.roofline import Ceiling, roof, shares
from psph.lab.bench.tank import Tank
from psph.lab.errors import BenchError
from psph.output.ledger import Ledger
from psph.runs.setup import compile_ahead
from psph.scene import Scene
from psph.simulation.plan import make_plan
from psph.simulation.step import Simulation
from psph.vectors import dot, nearest_image, subtract

WARM_UP, REPEATS, STEPS = 20, 5, 20
"""Steps before the clock starts, blocks that are timed, and steps of a block."""

TURNS = 15
"""Blocks where two cases are compared: their difference may be small."""

LAYOUTS = {
    BOX: FluidBox.nearest,
    DAM: Tank.nearest,
    FALLING: Falling.nearest,
    BLOCK: Block.nearest,
    GAS: Blast.nearest,
}
"""For each problem: (dimensions, neighbours, particles) to what lays it out."""


OURS, PEER, AGAINST = "ours", "peer", "against"
"""The codes that run in turns; the last two are keys of a result."""

SITES = ("dimensions", "spacing", "lower", "upper", "periodic")
"""Keys of ``space`` that say where particles are."""


class BenchProblem(NamedTuple):
    """A problem by name, about how many particles, neighbours in the bulk, and the precision."""

    problem: str
    dimensions: int
    particles: int
    neighbours: int
    precision: str


def measure(
    asked: BenchProblem,
    comm,
    ceiling: Ceiling,
    peer_python: Path | None = None,
    against: Sequence[str] = (),
    turns: int | None = None,
) -> dict:
    """Figures of one problem, ready for JSON: rates are medians over blocks, of all ranks.

    With ``peer_python`` the peer takes turns with psph, block by block; with overrides ``against``,
    ``dotted.key=value``, the same particles under the case that these make.  ``turns``: blocks in
    place of REPEATS, or TURNS where two cases are compared.  Collective.
    """
    layout = LAYOUTS[asked.problem](asked.dimensions, asked.neighbours, asked.particles)
    scene = scene_of(asked, layout)
    rival_scene = scene_of(asked, layout, against) if against else None
    simulation, compiling = warmed_up(layout, scene, comm)
    rival = warmed_up(layout, rival_scene, comm)[0] if against else None
    count, pairs, entries = work(simulation, scene)
    in_bulk = layout.in_bulk(scene, simulation)
    with Peer(peer_python, scene, simulation, layout.peer) if peer_python else nullcontext() as peer:
        simulation.ledger.seconds.clear()
        rebuilds = simulation.domain.rebuilds
        runners = {OURS: partial(_timed, simulation, comm)}
        if peer:
            runners[PEER] = partial(peer.timed, STEPS)
        if rival:
            runners[AGAINST] = partial(_timed, rival, comm)
        blocks = turns or (TURNS if rival else REPEATS)
        seconds = [{name: timed() for name, timed in runners.items()} for _ in range(blocks)]
        if peer:
            peer.check()
    ours = [turn[OURS] for turn in seconds]
    phases = _mean_over_ranks(simulation.ledger, comm)
    rates = Rates.of(ours, count)
    shared = {}
    if simulation.plan.passes:  # one loop over pairs, whose operations the plan counts
        shared = shares(simulation, ceiling, pairs, entries, phases["pairs"] / (blocks * STEPS))
    cores = comm.size * threads()
    result = {
        "machine": machine(),
        **asked._asdict(),
        "particles": count,
        "neighbours": round(pairs / count, 1),
        "neighbours_in_bulk": round(in_bulk),
        "ranks": comm.size,
        "threads": threads(),
        "compile_seconds": round(compiling, 2),
        **rates.figures(pairs / count),
        "per_core": rates.per(cores).figures(pairs / count),
        "spread": rates.spread,
        "rebuilds": simulation.domain.rebuilds - rebuilds,
        "share": {k: round(v / sum(ours), 4) for k, v in sorted(phases.items())},
        "roofline": roof(ceiling) | shared,
    }
    if peer:
        result[PEER] = {**peer.described, **_beside(seconds, PEER, count, pairs / count)}
    if rival:
        within = work(rival, rival_scene)[1] / count
        result[AGAINST] = {
            "overrides": [*against],
            "neighbours": round(within, 1),
            **_beside(seconds, AGAINST, count, within),
        }
    return result


def scene_of(asked: BenchProblem, layout, against: Sequence[str] = ()) -> Scene:
    """The problem's scene, with overrides; BenchError where its particles are not the same then."""
    scene = Scene(
        checked(
            f"bench --problem {asked.problem}",
            layout.tables() | {"precision": asked.precision},
            against,
            "--against",
        )
    )
    if not against:
        return scene
    like = Scene(layout.case())
    moved = [name for name in SITES if getattr(scene.case.space, name) != getattr(like.case.space, name)]
    if moved or scene.census.counts.tolist() != like.census.counts.tolist():
        what = f"space.{moved[0]}" if moved else "the shapes"
        raise BenchError(
            f"bench --against {' '.join(against)}: not the same particles any more; leave {what} as in the "
            "problem"
        )
    return scene


def warmed_up(layout, scene: Scene, comm) -> tuple[Simulation, float]:
    """The problem after its first steps, and the seconds that were compiled; collective."""
    plan = make_plan(scene)
    compiling = compile_ahead(scene, plan, comm)
    simulation = Simulation(scene, plan, layout.create(scene, plan, comm), comm, Ledger())
    go_on(simulation, WARM_UP)
    return simulation, compiling


def go_on(simulation: Simulation, steps: int) -> int:
    """Make so many ``steps``, or a few more where particles take steps of their own, whose shortest count;
    returns how many."""
    begun = simulation.steps
    while simulation.steps - begun < steps:
        simulation.step()
    return simulation.steps - begun


class Rates(NamedTuple):
    """Particle-steps/s, the median over blocks, and (largest − smallest)/median."""

    particle_steps: float
    spread: float

    @classmethod
    def of(cls, blocks: list[float], particles: int) -> "Rates":
        """From the seconds of each block."""
        rates = [particles * STEPS / seconds for seconds in blocks]
        median = statistics.median(rates)
        return cls(median, (max(rates) - min(rates)) / median)

    def per(self, cores: int) -> "Rates":
        """The share of one core."""
        return self._replace(particle_steps=self.particle_steps / cores)

    def figures(self, neighbours: float) -> dict[str, float]:
        """Particle-steps and pairs per second."""
        return {
            "particle_steps_per_second": self.particle_steps,
            "pairs_per_second": self.particle_steps * neighbours,
        }


def machine() -> str:
    """The processor by its name, and as loops are compiled for it."""
    name = platform.processor() or platform.machine()
    try:
        described = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
        name = next(line.partition(":")[2] for line in described if line.startswith("model name"))
    except (OSError, StopIteration):
        pass  # not Linux, or a processor that is described in other words
    return f"{name.strip()} ({processor()}), {os.cpu_count()} cores"


def _timed(simulation: Simulation, comm) -> float:
    """Seconds of a block of steps; of as many where it makes more."""
    comm.Barrier()
    begun = time.perf_counter()
    made = go_on(simulation, STEPS)
    comm.Barrier()
    return (time.perf_counter() - begun) * STEPS / made


def _mean_over_ranks(ledger: Ledger, comm) -> dict[str, float]:
    """Seconds of each phase, a rank's on average."""
    parts = comm.allgather(dict(ledger.seconds))
    names = {name for part in parts for name in part}
    return {name: sum(part.get(name, 0.0) for part in parts) / comm.size for name in names}


def work(simulation: Simulation, scene) -> tuple[int, int, int]:
    """Particles, ordered pairs inside the kernel's support and entries of the lists, in all."""
    store, lists, comm = simulation.store, simulation.domain.lists, simulation.comm
    if not simulation.plan.passes:
        pairs = sum(kind.pairs() for kind in simulation.engine.kinds)
        return tuple(comm.allreduce(n) for n in (store.owned, pairs, pairs))
    sizes = simulation.plan.sizes
    support = np.full(store.total, scene.support) if sizes is None else sizes.support * store[sizes.length]
    inside = count_inside(
        store.view(),
        simulation.domain.periods,
        support * support,
        store.low,
        store.owned,
        lists.begin,
        lists.lengths,
        lists.lists,
    )
    entries = int(lists.lengths[: store.owned].sum())
    return tuple(comm.allreduce(n) for n in (store.owned, int(inside), entries))


@compiled
def count_inside(view, periods, support2, low, owned, begin, lengths, lists):
    """Entries of the lists that lie within the support of the particle that lists them, whose squares, m²,
    are ``support2`` (columns,)."""
    inside = 0
    for k in range(owned):
        i = take(view, low + k)
        for n in range(begin[k], begin[k] + np.uint64(lengths[k])):
            x_ij = nearest_image(subtract(i.position, take(view, lists[n]).position), periods)
            inside += dot(x_ij, x_ij) < support2[low + k]
    return inside


def _beside(turns: list[dict], name: str, particles: int, neighbours: float) -> dict:
    """The figures of another code or setting; ``ratio`` is its seconds over ours, a median of the turns."""
    ratios = [turn[name] / turn[OURS] for turn in turns]
    rates = Rates.of([turn[name] for turn in turns], particles)
    ratio = statistics.median(ratios)
    return {
        **rates.figures(neighbours),
        "spread": rates.spread,
        "ratio": ratio,
        "ratio_spread": (max(ratios) - min(ratios)) / ratio,
    }
