"""The plan in words: what will be simulated, why, and its cost."""

import math
from collections.abc import Iterator

from psph.parallel.machine import free_memory
from psph.parallel.slabs import check_ranks
from psph.particles.cells import COLUMNS_PER_CUTOFF, make_grid
from psph.particles.fields import FIELDS
from psph.particles.records import record_width, recorded
from psph.particles.store import SPARE
from psph.physics.count import flops_per_pair
from psph.solver.hints import hints
from psph.solver.outlook import outlook
from psph.solver.outlay import output_lines
from psph.solver.plan import Plan, make_plan

NUMBER, IDENTITY, ROW, SORTING, ENTRY = 8, 9, 12, 24, 4
"""Bytes of a number; of a particle's id and kind; of the position of its list; of the arrays that a
rebuild sorts with; and of a neighbour in a list."""


def explain(scene, ranks: int) -> Iterator[str]:
    """Lines that describe the plan of a scene on so many ranks."""
    plan = make_plan(scene)
    counts = scene.counts()
    particles = int(counts.sum())
    yield from _scene_lines(scene, particles)
    yield from _rank_lines(scene, plan, ranks)
    yield from _pass_lines(scene, plan)
    yield from _step_lines(scene, plan)
    neighbours = _within(scene, scene.kernel.support * scene.smoothing_length)
    yield from output_lines(scene, neighbours, _steps_expected(scene, plan)[0])
    yield from outlook(scene, plan)
    for line in hints(scene, plan):
        yield f"Hint: {line}"


def slab_planes(scene) -> int:
    """Planes of cells along the slab axis: the most ranks that the scene can use."""
    grid = make_grid(scene.axis, _cutoff(scene), scene.lower, scene.upper, scene.periods)
    return grid.counts[0]


def bytes_per_particle(scene, plan: Plan) -> tuple[float, float]:
    """Memory of a particle: its fields with the arrays to sort them, and its neighbour list, bytes."""
    own = NUMBER * _rows(scene, plan.arrays) + IDENTITY
    record = record_width(_rows(scene, recorded(plan.neighbour_fields))) * plan.space.record_type.itemsize
    own += own / SPARE + record + SORTING + NUMBER * _cells_per_particle(scene)
    entries = _within(scene, _cutoff(scene)) + (plan.space.lanes - 1) / 2
    return own, (ENTRY * entries + ROW) * (1.0 + 1.0 / SPARE)


def bytes_of_rank(scene, plan: Plan, ranks: int) -> float:
    """Memory of the particles, ghosts and lists of one of so many ranks, bytes."""
    own, listed = bytes_per_particle(scene, plan)
    share = float(scene.counts().sum()) / ranks
    return own * (share + _neighbours(scene, ranks) * _ghosts_a_side(scene)) + listed * share


def bytes_per_refresh(scene, plan: Plan, ranks: int) -> tuple[int, float]:
    """Messages of a halo refresh: bytes per ghost, and bytes that a rank sends in all."""
    each = NUMBER * _rows(scene, plan.refreshed)
    return each, each * _neighbours(scene, ranks) * _ghosts_a_side(scene)


def _rows(scene, names: tuple[str, ...]) -> int:
    """Numbers that these fields take."""
    return sum(FIELDS[name].width(scene.dimensions) for name in names)


def _neighbours(scene, ranks: int) -> int:
    """Ranks, or sides, that a rank exchanges ghosts with."""
    return 2 if scene.periods[scene.axis] is not None else min(ranks - 1, 2)


def _ghosts_a_side(scene) -> float:
    """Particles of an average plane of cells: a rank holds one plane from each side."""
    return float(scene.counts().sum()) / slab_planes(scene)


def _cells_per_particle(scene) -> float:
    finest = COLUMNS_PER_CUTOFF if scene.dimensions > 1 else 1
    return finest * (scene.spacing / _cutoff(scene)) ** scene.dimensions


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
    yield from _preset_lines(case)
    names = ", ".join(m.name for m in scene.materials)
    yield f"  materials   {names}"
    yield (
        f"  kernel      {case.space.kernel}, h = {scene.smoothing_length:g} m "
        f"(h/dx {case.space.smoothing:g}), support {support:g} m, "
        f"about {_within(scene, support):.0f} neighbours"
    )


def _preset_lines(case) -> Iterator[str]:
    """The scheme and the profile: the keys that they set, and those that the case overrides."""
    names = dict.fromkeys((f"scheme {case.scheme}", *(name for name, _ in case.presets.values())))
    for name in names:
        keys = {key: value for key, (of, value) in case.presets.items() if of == name}
        own = [key for key in keys if not case.preset(key)]
        what, _, which = name.partition(" ")
        yield f"  {what:<11} {which}" + (f", except {', '.join(own)}" if own else "")
        for key, value in keys.items():
            if key not in own:
                yield f"              {key} = {value}"


def _rank_lines(scene, plan: Plan, ranks: int) -> Iterator[str]:
    planes = slab_planes(scene)
    check_ranks(ranks, planes)
    own, listed = bytes_per_particle(scene, plan)
    memory, free = bytes_of_rank(scene, plan, ranks), free_memory()
    each, sent = bytes_per_refresh(scene, plan, ranks)
    along = "xyz"[scene.axis]
    yield f"  ranks       {ranks}, at most {planes}: that many planes of cells along {along}"
    yield (
        f"  memory      about {memory / 2**20:.1f} MiB a rank, {own + listed:.0f} bytes a particle, "
        f"{listed:.0f} of them in its neighbour list"
    )
    if ranks * memory > free:
        yield (
            f"              too much for this machine: {ranks * memory / 2**30:.1f} GiB, and "
            f"{free / 2**30:.1f} GiB are free"
        )
    yield f"  arrays      {', '.join(plan.arrays)}"
    shared = ", ".join(f"{k} {v:g}" for k, v in plan.constants.items())
    yield f"  shared      {shared}"
    yield f"  halo        once a step: {', '.join(plan.refreshed)}"
    yield (
        f"              {each} bytes a ghost, about {_ghosts_a_side(scene):.0f} ghosts a side, "
        f"{sent:,.0f} bytes from a rank"
    )
    if plan.ghost_fields:
        yield f"              once a rebuild: {', '.join(plan.ghost_fields)}"


def _pass_lines(scene, plan: Plan) -> Iterator[str]:
    flops = flops_per_pair(
        plan.effects, plan.reductions, plan.kernel, plan.constants, scene.periods
    )
    yield f"Pass over the neighbours, one a step, {flops} flops a pair"
    for call in plan.called:
        yield f"  {type(call.effect).__name__:<22}{_first_line(call.effect)}"
        yield f"  {'':<22}because: {call.reason}"
    yield "Equation of state"
    yield f"  {type(plan.state).__name__:<22}{_first_line(plan.state)}"
    yield f"  {'':<22}because: {plan.state_reason}"
    yield "Not simulated"
    for entry in plan.absent:
        yield f"  {entry.effect.__name__:<22}the case does not say {_asked_by(entry.key)}"


def _asked_by(key: str) -> str:
    name, _, choice = key.partition("=")
    return f"{name} = \"{choice}\"" if choice else name


def _first_line(effect) -> str:
    return type(effect).__doc__.splitlines()[0]


def _step_lines(scene, plan: Plan) -> Iterator[str]:
    pull = _pull(plan)
    yield f"Time step, from the expected speed {scene.expected_speed:.3g} m/s"
    for step, name in plan.step_limits(scene.expected_speed, pull):
        yield f"  {name:<22}{step:.3g} s"
    steps, name = _steps_expected(scene, plan)
    end = scene.case.time.end
    yield f"  expected            {steps:,} steps to {end:g} s, limited by {name}"


def _pull(plan: Plan) -> float:
    """The expected acceleration, m/s²."""
    gravity = [e.acceleration for e in plan.effects if hasattr(e, "acceleration")]
    return max((math.hypot(*g) for g in gravity), default=0.0)


def _steps_expected(scene, plan: Plan) -> tuple[int, str]:
    """The approximate number of steps, and what limits the step."""
    step, name = plan.longest_step(scene.expected_speed, _pull(plan))
    return math.ceil(scene.case.time.end / step), name
