"""What of a case has no influence on its scene, or less than it asks for."""

from collections.abc import Iterator
from dataclasses import replace

from psph.runs.forecast import long_run, pull
from psph.simulation.paces import is_held
from psph.simulation.plan import Plan

TOO_LONG = 1.2
"""So many times as long as its limits a given time step may be before it is said."""


def hints(scene, plan: Plan) -> Iterator[str]:
    """One line for each effect that finds itself idle: why, and what to remove; and one where friction serves
    for fewer passes than asked for.
    """
    for call in plan.called:
        if hasattr(call.effect, "idle") and (why := call.effect.idle(scene, plan.effects)):
            yield f"{call.title}: {why}"
    asked, served = scene.case.time.damping_every, plan.steps_held * plan.rate_passes
    if served < asked and _bears_held(plan):
        yield (
            f"time.damping_every = {asked}: friction serves for {served} here; its limit of the step bears "
            "no more"
        )


def plan_warnings(scene, plan: Plan, ranks: int) -> Iterator[str]:
    """For `check`, what only the plan of a scene tells: keys that do nothing in it, and a run on
    so many ``ranks`` that takes long.
    """
    for line in _served_in_vain(scene, plan):
        yield f"{scene.case.file}: {line}"
    if plan.fixed_step is not None and (limits := [*unheeded(scene, plan)]):
        step, name = min(limits)
        if plan.fixed_step > TOO_LONG * step:
            yield (
                f"{scene.case.file}: time.step: {plan.fixed_step:g} s is {plan.fixed_step / step:.2g} times "
                f"as long as {name} allows; remove it, or give at most {step:.2g}"
            )
    yield from long_run(scene, plan, ranks)


def unheeded(scene, plan: Plan) -> Iterator[tuple[float, str]]:
    """The limits, s, that a given time step does not heed, at the expected speed, with their names."""
    free = replace(plan, fixed_step=None)
    for _, step, name in free.limits_by_level(scene.expected_speed, pull(scene)):
        yield step, name


def _served_in_vain(scene, plan: Plan) -> Iterator[str]:
    time = scene.case.time
    if time.passes == 2 and not plan.midway:
        yield (
            "time.passes: 2 does nothing: not all that is in the scene bears it, so steps have one pass; "
            "remove it"
        )
    if time.lead and not plan.midway and not scene.case.preset("time.lead"):
        yield f"time.lead: {time.lead:g} does nothing in steps of one pass; set time.passes = 2, or remove it"
    yield from _left_out(scene, plan)
    if time.damping_every > plan.rate_passes and not _bears_held(plan):
        yield (
            f"time.damping_every: {time.damping_every} does nothing: what is in the scene needs friction in "
            "each step, or has none; remove it"
        )


def _left_out(scene, plan: Plan) -> Iterator[str]:
    """Keys of [physics] that the case itself gives and of which no effect is in the scene."""
    absent, case = {entry.key: entry.effect for entry in plan.absent}, scene.case
    served = {one.key for one in case.catalogue.effects if one not in plan.absent}
    for key, effect in absent.items():
        table, _, name = key.partition(".")
        why = plan.dropped.get(effect.__name__, "").partition(": ")[2]
        alone = key not in served and not getattr(effect, "shares_key", False)
        given = table == "physics" and name in case.physics.model_fields_set and not case.preset(key)
        if why and given and alone:
            yield f"{key} does nothing here: {why}; remove it"


def _bears_held(plan: Plan) -> bool:
    """Whether there is friction whose rates may serve for several steps, and all matter bears that."""
    return any(is_held(call.effect) for call in plan.called) and all(kind.bears_held for kind in plan.matter)
