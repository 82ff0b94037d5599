"""The plan in words: what will be simulated, why, and its cost."""

import math
from collections.abc import Iterable, Iterator
from typing import NamedTuple

from psph.errors import Refused
from psph.kinds import TOPICS, count_of
from psph.output.tables import GAUGE
from psph.parallel.domain import CELLS_A_PARTICLE
from psph.parallel.machine import free_memory
from psph.parallel.slabs import check_ranks
from psph.particles.cells import make_grid
from psph.particles.records import record_width, recorded
from psph.particles.store import SPARE
from psph.runs.absent import absent_lines
from psph.runs.acting import matter_lines
from psph.runs.forecast import forecast, forecast_lines, pull
from psph.runs.hints import hints
from psph.runs.output_size import output_lines
from psph.runs.stability_forecast import stability_forecast
from psph.scene.meshes.report import described
from psph.scene.sites import sites_within
from psph.simulation.plan import Plan, make_plan
from psph.theory.curves.catalogue import TAKEN

NUMBER, IDENTITY, ROW, SORTING, ENTRY, CELL = 8, 9, 12, 24, 4, 24
"""Bytes of a number; of a particle's id and kind; of the position of its list; of the arrays that a
rebuild sorts with; of a neighbour in a list; and of a cell of the grid during a rebuild."""


def explain(scene, ranks: int) -> Iterator[str]:
    """Lines that describe the plan of a scene on so many ranks."""
    plan = make_plan(scene)
    particles = count_of(scene)
    said = _said_by_kinds(scene, plan)
    yield from _scene_lines(scene, plan, particles, said)
    yield from _rank_lines(scene, plan, ranks, said)
    yield from _pass_lines(scene, plan, said)
    yield from matter_lines(scene.case, plan)
    yield from _step_lines(scene, plan)
    yield from said["steps"]
    yield from said["friction"]
    found = forecast(scene, plan, ranks)
    yield from forecast_lines(found, ranks, scene.case.time.end)
    neighbours = sites_within(scene, scene.support)
    yield from output_lines(scene, plan, neighbours, found.steps)
    yield from stability_forecast(scene, plan)
    for line in hints(scene, plan):
        yield f"Hint: {line}"


def _said_by_kinds(scene, plan: Plan) -> dict[str, list[str]]:
    """What the kinds of matter of a scene say, by topic."""
    longest, _ = plan.longest_step(scene.expected_speed, pull(scene))
    found: dict[str, list[str]] = {topic: [] for topic in TOPICS}
    for kind in plan.matter:
        for topic, line in kind.lines(plan, longest):
            if topic not in found:
                raise Refused(f"{kind.name}: lines: {topic}: no such topic; give one of {', '.join(TOPICS)}")
            found[topic].append(line)
    return found


def found_good(scene) -> Iterator[str]:
    """What ``check`` says of a scene that can run: its geometry files, its size."""
    yield from described(scene)
    yield f"good: {count_of(scene):,} particles, at most {slab_planes(scene)} ranks"


def slab_planes(scene) -> int:
    """Planes of cells along the slab axis: the most ranks that the scene can use."""
    return _grid(scene).counts[0]


def bytes_per_particle(scene, plan: Plan) -> tuple[float, float]:
    """Memory of a particle: its fields with the arrays to sort them, and its neighbour list, bytes."""
    own = NUMBER * _rows(scene, plan, plan.arrays) + IDENTITY
    widths = (record_width(_rows(scene, plan, recorded(p.neighbour_fields))) for p in plan.passes)
    record = sum(widths) * plan.space.record_type.itemsize
    own += own / SPARE + record + SORTING + CELL * _cells_per_particle(scene)
    entries = sites_within(scene, _cutoff(scene)) + (plan.space.lanes - 1) / 2 if plan.passes else 0.0
    listed = (ENTRY * entries + ROW) * (1.0 + 1.0 / SPARE)
    return own, listed + sum(kind.bytes_of_particle(plan) for kind in plan.matter)


def bytes_of_rank(scene, plan: Plan, ranks: int) -> float:
    """Memory of the particles, ghosts and lists of one of so many ranks, bytes."""
    own, listed = bytes_per_particle(scene, plan)
    share = count_of(scene) / ranks
    return own * (share + _neighbours(scene, ranks) * _ghosts_a_side(scene)) + listed * share


def bytes_per_refresh(scene, plan: Plan, ranks: int) -> tuple[int, float]:
    """Messages of a halo refresh: bytes per ghost, and bytes that a rank sends in all."""
    each = NUMBER * _rows(scene, plan, plan.refreshed)
    return each, each * _neighbours(scene, ranks) * _ghosts_a_side(scene)


def _rows(scene, plan: Plan, names: tuple[str, ...]) -> int:
    """Numbers that these fields take."""
    return sum(plan.fields[name].width(scene.dimensions) for name in names)


def _neighbours(scene, ranks: int) -> int:
    """Ranks, or sides, that a rank exchanges ghosts with."""
    return 2 if scene.layout.periods[scene.layout.axis] is not None else min(ranks - 1, 2)


def _ghosts_a_side(scene) -> float:
    """Particles of an average plane of cells: a rank holds one plane from each side."""
    return count_of(scene) / slab_planes(scene)


def _cells_per_particle(scene) -> float:
    """The most that the grid may come to have, when particles leave an open domain."""
    grid = _grid(scene)
    closed = all(period is not None for period in scene.layout.periods)
    return max(math.prod(grid.counts) / count_of(scene), 0.0 if closed else CELLS_A_PARTICLE)


def _grid(scene):
    """The grid over the scene at its start."""
    return make_grid(
        scene.layout.axis, _cutoff(scene), scene.layout.lower, scene.layout.upper, scene.layout.periods
    )


def _cutoff(scene) -> float:
    return scene.layout.reach.cutoff


def _scene_lines(scene, plan: Plan, particles: int, said: dict[str, list[str]]) -> Iterator[str]:
    case = scene.case
    yield f"{case.title or case.name} ({case.file})"
    yield f"  particles   {particles:,} in {scene.dimensions}D, spacing {scene.spacing:g} m"
    yield from _preset_lines(case)
    names = ", ".join(m.name for m in scene.species)
    yield f"  materials   {names}"
    yield from said["matter"]
    for line in described(scene):
        yield f"  mesh        {line}"
    for name, table in scene.tables.items():
        yield f"  table       {name}.csv: {_first_line(table)}"
    for name, gauge in case.gauges.items():
        measures = _first_line(getattr(gauge, gauge.kind))
        yield f"  gauge       {name}: {measures} Every {gauge.every:g} s in {GAUGE.format(name)}"
    for name, number in case.numbers.items():
        yield f"  number      {name}: {number.take} of {number.of}: {TAKEN[number.take].says}"
    yield from said["reach"]


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


def _rank_lines(scene, plan: Plan, ranks: int, said: dict[str, list[str]]) -> Iterator[str]:
    planes = slab_planes(scene)
    check_ranks(ranks, planes)
    own, listed = bytes_per_particle(scene, plan)
    memory, free = bytes_of_rank(scene, plan, ranks), free_memory()
    each, sent = bytes_per_refresh(scene, plan, ranks)
    along = "xyz"[scene.layout.axis]
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
    if plan.passes:
        if plan.midway:
            yield f"  halo        at the middle of a step: {', '.join(plan.midway.moved)}"
        at_its_end = "at its end" if plan.midway else "once a step"
        yield f"  {'' if plan.midway else 'halo':<11} {at_its_end}: {', '.join(plan.refreshed)}"
        yield (
            f"              {each} bytes a ghost, about {_ghosts_a_side(scene):.0f} ghosts a side, "
            f"{sent:,.0f} bytes from a rank"
        )
    yield from said["messages"]
    if plan.ghost_fields:
        yield f"              once a rebuild: {', '.join(plan.ghost_fields)}"


def _pass_lines(scene, plan: Plan, said: dict[str, list[str]]) -> Iterator[str]:
    yield from _early_passes(plan)
    if plan.passes:
        flops = plan.flops_per_pair(scene.layout.periods)
        often = "one at the middle of a step for the density, one at its end" if plan.midway else "one a step"
        yield f"Pass over the neighbours, {often}, {flops} flops a pair"
    yield from said["passes"]
    if scene.case.time.passes == 2 and not plan.midway:
        yield "Steps of one pass, for not all that is in the scene bears time.passes = 2"
    effects, laws = acting(plan), laws_of(plan)
    width = _column([one.name for one in (*effects, *laws)] + [e.effect.__name__ for e in plan.absent])
    for one in effects:
        yield from _acting_lines(one, width)
    yield "Equation of state"
    for one in laws:
        yield from _acting_lines(one, width)
    yield from absent_lines(scene, plan, width)


class Acting(NamedTuple):
    """An effect or an equation of state of a scene: what it does, and what calls for it."""

    name: str
    does: str
    because: str


def acting(plan: Plan) -> list[Acting]:
    """The effects of the scene."""
    return [Acting(call.name, _first_line(call.effect), call.reason) for call in plan.called]


def laws_of(plan: Plan) -> list[Acting]:
    """The equations of state of the scene."""
    return [
        Acting(type(law).__name__, _first_line(law), why)
        for law, why in zip(plan.materials.laws, plan.materials.law_reasons)
    ]


def _acting_lines(one: Acting, width: int) -> Iterator[str]:
    yield f"  {one.name:<{width}}{one.does}"
    yield f"  {'':<{width}}because: {one.because}"


def _column(names: Iterable[str]) -> int:
    """Width of a column of names, with room behind the longest."""
    return max(NARROWEST, 2 + max(map(len, names)))


NARROWEST = 22
"""Characters of a column of names."""


def _early_passes(plan: Plan) -> Iterator[str]:
    """The passes that gather sums for the one that gives the rates."""
    passes = [one for one in plan.passes if not one.midway]
    for early, later in zip(passes, passes[1:]):
        own, what = (early.effects, "rates") if early.holds else (early.reductions, "sums")
        names = ", ".join(type(effect).__name__ for effect in own)
        often = "one a step" if early.every == 1 else f"one in {early.every} steps"
        midway = plan.midway.brought if plan.midway else ()
        brought = dict.fromkeys((*later.brought, *(name for name in midway if name in early.written)))
        sent = f"; ghosts then get {', '.join(brought)}" if brought else ""
        yield f"Pass over the neighbours, {often}, before the next: {what} of {names}{sent}"


def _first_line(effect) -> str:
    return type(effect).__doc__.splitlines()[0]


def _step_lines(scene, plan: Plan) -> Iterator[str]:
    yield f"Time step, from the expected speed {scene.expected_speed:.3g} m/s"
    limits = list(plan.step_limits(scene.expected_speed, pull(scene)))
    width = _column(name for _, name in limits)
    for step, name in limits:
        yield f"  {name:<{width}}{step:.3g} s"
