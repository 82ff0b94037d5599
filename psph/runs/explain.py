"""The plan in words: what will be simulated, why, and its cost."""

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from psph.errors import Refused
from psph.kinds import TOPICS, count_of
from psph.output.tables import GAUGE
from psph.parallel.machine import free_memory
from psph.parallel.slabs import check_ranks
from psph.runs.absent import absent_lines, dropped_lines
from psph.runs.acting import matter_lines
from psph.runs.footprint import (
    bytes_of_rank,
    bytes_per_particle,
    bytes_per_refresh,
    ghosts_a_side,
    slab_planes,
)
from psph.runs.forecast import forecast, forecast_lines, pull
from psph.runs.hints import hints, unheeded
from psph.runs.output_size import output_lines
from psph.runs.stability_forecast import stability_forecast
from psph.scene.meshes.report import described
from psph.scene.sites import sites_within
from psph.simulation.midway import why_one_pass
from psph.simulation.plan import Plan, make_plan
from psph.theory.curves.catalogue import TAKEN


def explain(scene, ranks: int) -> Iterator[str]:
    """All lines that describe the plan of a scene on so many ranks."""
    plan = make_plan(scene)
    said = _said_by_kinds(scene, plan)
    width = _width(plan)
    yield from _title_lines(scene)
    yield from _preset_lines(scene.case, _keys_of)
    yield from _scene_lines(scene, said)
    yield from _rank_lines(scene, plan, ranks)
    yield from _field_lines(scene, plan, ranks, said)
    yield from _pass_lines(scene, plan, said)
    for one in acting(plan):
        yield from _acting_lines(one, width)
    yield "Equation of state"
    for one in laws_of(plan):
        yield from _acting_lines(one, width)
    yield from dropped_lines(scene, plan, width)
    yield from absent_lines(scene, plan)
    yield from matter_lines(scene.case, plan)
    yield from _step_lines(scene, plan)
    yield from said["steps"]
    yield from said["friction"]
    yield from _cost_lines(scene, plan, ranks)
    yield from stability_forecast(scene, plan)
    yield from _hint_lines(scene, plan)


def page(scene, ranks: int) -> Iterator[str]:
    """Those that a user reads first: what is in the scene, what acts, and what the run takes."""
    plan = make_plan(scene)
    said = _said_by_kinds(scene, plan)
    width = _width(plan)
    yield from _title_lines(scene)
    yield from _preset_lines(scene.case)
    yield from _scene_lines(scene, said)
    yield from _rank_lines(scene, plan, ranks)
    yield "What acts"
    for one in (*acting(plan), *laws_of(plan)):
        yield f"  {one.name:<{width}}{one.does}"
    yield from dropped_lines(scene, plan, width)
    yield from said["friction"]
    yield "What it takes"
    yield from said["steps"]
    yield from _cost_lines(scene, plan, ranks)
    yield from _hint_lines(scene, plan)
    yield "--all says what calls for each effect, what is not simulated, fields, messages, limits of the step"


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


def _title_lines(scene) -> Iterator[str]:
    yield f"{scene.case.title or scene.case.name} ({scene.case.file})"
    finest = f", {scene.case.space.finest:g} m where finest" if scene.finer else ""
    yield f"  particles   {count_of(scene):,} in {scene.dimensions}D, spacing {scene.spacing:g} m{finest}"


def _scene_lines(scene, said: dict[str, list[str]]) -> Iterator[str]:
    case = scene.case
    names = ", ".join(part.name for part in scene.layout.parts if not part.level and not part.follows)
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


def _preset_lines(case, below=lambda keys: ()) -> Iterator[str]:
    """The scheme and the profile, with those of their keys that the case overrides; ``below`` each, lines of
    the keys that it sets."""
    names = dict.fromkeys((f"scheme {case.scheme}", *(name for name, _ in case.presets.values())))
    for name in names:
        keys = {key: value for key, (of, value) in case.presets.items() if of == name}
        own = [key for key in keys if not case.preset(key)]
        what, _, which = name.partition(" ")
        yield f"  {what:<11} {which}" + (f", except {', '.join(own)}" if own else "")
        yield from below({key: value for key, value in keys.items() if key not in own})


def _keys_of(keys: dict) -> Iterator[str]:
    for key, value in keys.items():
        yield f"              {key} = {value}"


def _rank_lines(scene, plan: Plan, ranks: int) -> Iterator[str]:
    planes = slab_planes(scene)
    check_ranks(ranks, planes)
    own, listed = bytes_per_particle(scene, plan)
    memory, free = bytes_of_rank(scene, plan, ranks), free_memory()
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


def _field_lines(scene, plan: Plan, ranks: int, said: dict[str, list[str]]) -> Iterator[str]:
    """What is kept of each particle, and what travels."""
    each, sent = bytes_per_refresh(scene, plan, ranks)
    yield f"  arrays      {', '.join(plan.arrays)}"
    shared = ", ".join(f"{k} {v:g}" for k, v in plan.constants.items())
    yield f"  shared      {shared}"
    if plan.passes:
        if plan.midway:
            yield f"  halo        at the middle of a step: {', '.join(plan.midway.moved)}"
        at_its_end = "at its end" if plan.midway else "once a step"
        yield f"  {'' if plan.midway else 'halo':<11} {at_its_end}: {', '.join(plan.refreshed)}"
        yield (
            f"              {each} bytes a ghost, about {ghosts_a_side(scene):.0f} ghosts a side, "
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
        if scene.case.time.passes != 1 and not plan.midway:
            effects = tuple(call.effect for call in plan.called)
            often += f", since {why_one_pass(scene, effects, plan.matter, plan.extremes)}"
        yield f"Pass over the neighbours, {often}, {flops} flops a pair"
    yield from said["passes"]


def _cost_lines(scene, plan: Plan, ranks: int) -> Iterator[str]:
    """Steps, time and bytes of files."""
    found = forecast(scene, plan, ranks)
    yield from forecast_lines(found, ranks, scene.case.time.end)
    yield from output_lines(scene, plan, sites_within(scene, scene.support), found.steps)


def _hint_lines(scene, plan: Plan) -> Iterator[str]:
    for line in hints(scene, plan):
        yield f"Hint: {line}"


class Acting(NamedTuple):
    """An effect or an equation of state of a scene: what it does, what calls for it, and the numbers that a
    scene gives it in place of those of the key, if any."""

    name: str
    does: str
    because: str
    in_force: str = ""


def acting(plan: Plan) -> list[Acting]:
    """The effects of the scene."""
    return [
        Acting(call.name, _first_line(call.effect), call.reason, getattr(call.effect, "in_force", ""))
        for call in plan.called
    ]


def laws_of(plan: Plan) -> list[Acting]:
    """The equations of state of the scene."""
    return [
        Acting(type(law).__name__, _first_line(law), why)
        for law, why in zip(plan.materials.laws, plan.materials.law_reasons)
    ]


def _acting_lines(one: Acting, width: int) -> Iterator[str]:
    yield f"  {one.name:<{width}}{one.does}"
    yield f"  {'':<{width}}because: {one.because}"
    if one.in_force:
        yield f"  {'':<{width}}in force: {one.in_force}"


def _width(plan: Plan) -> int:
    """Width of the column of effects' names."""
    names = [one.name for one in (*acting(plan), *laws_of(plan))]
    return _column(names + [entry.effect.__name__ for entry in plan.absent])


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
    limits = [
        (step, name if level is None else f"{name}, level {level}")
        for level, step, name in plan.limits_by_level(scene.expected_speed, pull(scene))
    ]
    width = _column(name for _, name in limits)
    for step, name in limits:
        yield f"  {name:<{width}}{step:.3g} s"
    if plan.fixed_step is not None:
        told = (f"{name} {step:.3g} s" for step, name in unheeded(scene, plan))
        yield f"  not heeded: {', '.join(told)}"
