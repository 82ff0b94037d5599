"""The plan in words: what will be simulated, why, and what it will take."""

import math
from collections.abc import Iterator

from psph.parallel.slabs import check_ranks
from psph.particles.cells import make_grid
from psph.particles.fields import FIELDS
from psph.solver.plan import Plan, make_plan

GHOST_PLANES = 2
"""A rank holds a plane of cells from each of its neighbours."""


def explain(scene, ranks: int) -> Iterator[str]:
    """Lines that describe the plan of a scene on so many ranks."""
    plan = make_plan(scene)
    counts = scene.counts()
    particles = int(counts.sum())
    yield from _scene_lines(scene, particles)
    yield from _rank_lines(scene, plan, particles, ranks)
    yield from _pass_lines(scene, plan)
    yield from _step_lines(scene, plan)


def slab_planes(scene) -> int:
    """Planes of cells along the slab axis: the most ranks that the scene can use."""
    grid = make_grid(scene.axis, _cutoff(scene), scene.lower, scene.upper, scene.periods)
    return grid.counts[0]


def bytes_per_particle(scene, plan: Plan) -> float:
    """Memory of a particle with its neighbour list, bytes."""
    columns = sum(scene.dimensions if FIELDS[n].vector else 1 for n in plan.arrays)
    identity, row, padding = 9, 16, 4
    sorting = 24
    return 8 * columns + identity + sorting + row + 4 * (_within(scene, _cutoff(scene)) + padding)


def _cutoff(scene) -> float:
    support = scene.kernel.support * scene.smoothing_length
    return support * (1.0 + scene.case.neighbours.skin)


def _within(scene, radius: float) -> float:
    """Lattice sites within ``radius`` m of a particle in the bulk."""
    ball = {1: 2.0, 2: math.pi, 3: 4.0 / 3.0 * math.pi}[scene.dimensions]
    return ball * (radius / scene.spacing) ** scene.dimensions - 1.0


def _scene_lines(scene, particles: int) -> Iterator[str]:
    case = scene.case
    support = scene.kernel.support * scene.smoothing_length
    yield f"{case.title or case.name} ({case.file})"
    yield f"  particles   {particles:,} in {scene.dimensions}D, spacing {scene.spacing:g} m"
    names = ", ".join(m.name for m in scene.materials)
    yield f"  materials   {names}"
    yield (
        f"  kernel      {case.space.kernel}, h = {scene.smoothing_length:g} m "
        f"(h/dx {case.space.smoothing:g}), support {support:g} m, "
        f"about {_within(scene, support):.0f} neighbours"
    )


def _rank_lines(scene, plan: Plan, particles: int, ranks: int) -> Iterator[str]:
    planes = slab_planes(scene)
    check_ranks(ranks, planes)
    each = bytes_per_particle(scene, plan)
    alone = ranks == 1 and scene.periods[scene.axis] is None
    ghosts = 0 if alone else GHOST_PLANES * particles / planes
    memory = each * (particles / ranks + ghosts) / 2**20
    refreshed = sum(scene.dimensions if FIELDS[n].vector else 1 for n in plan.refreshed)
    along = "xyz"[scene.axis]
    yield f"  ranks       {ranks}, at most {planes}: that many planes of cells along {along}"
    yield f"  memory      about {memory:.1f} MiB a rank, {each:.0f} bytes a particle"
    yield f"  arrays      {', '.join(plan.arrays)}"
    shared = ", ".join(f"{k} {v:g}" for k, v in plan.constants.items())
    yield f"  shared      {shared}"
    yield f"  halo        once a step: {', '.join(plan.refreshed)}"
    yield f"              {8 * refreshed} bytes a ghost, about {particles / planes:.0f} ghosts a side"
    if plan.ghost_fields:
        yield f"              once a rebuild: {', '.join(plan.ghost_fields)}"


def _pass_lines(scene, plan: Plan) -> Iterator[str]:
    yield "Pass over the neighbours, one a step"
    for call in plan.called:
        yield f"  {type(call.effect).__name__:<20}{_first_line(call.effect)}"
        yield f"  {'':<20}because: {call.reason}"
    yield "Equation of state"
    yield f"  {type(plan.state).__name__:<20}{_first_line(plan.state)}"
    yield f"  {'':<20}because: {plan.state_reason}"
    yield "Not simulated"
    for entry in plan.absent:
        yield f"  {entry.effect.__name__:<20}the case does not say {_asked_by(entry.key)}"


def _asked_by(key: str) -> str:
    name, _, choice = key.partition("=")
    return f"{name} = \"{choice}\"" if choice else name


def _first_line(effect) -> str:
    return type(effect).__doc__.splitlines()[0]


def _step_lines(scene, plan: Plan) -> Iterator[str]:
    gravity = [e.acceleration for e in plan.effects if hasattr(e, "acceleration")]
    pull = max((math.hypot(*g) for g in gravity), default=0.0)
    yield f"Time step, from the expected speed {scene.expected_speed:.3g} m/s"
    for step, name in plan.step_limits(scene.expected_speed, pull):
        yield f"  {name:<20}{step:.3g} s"
    step, name = plan.longest_step(scene.expected_speed, pull)
    end = scene.case.time.end
    yield f"  expected            {math.ceil(end / step):,} steps to {end:g} s, limited by {name}"
