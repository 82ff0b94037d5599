"""What a case does not simulate, and why: each effect as data, and all of them in a few lines."""

import textwrap
from collections.abc import Iterable, Iterator

from psph.case.profiles import OFF
from psph.simulation.calling import acts_in
from psph.simulation.plan import Plan

WIDTH = 110
"""Characters of a line of keys."""


def absent(scene, plan: Plan) -> dict[str, str]:
    """Why each effect is not simulated that the case could have asked for."""
    unnamed = {name: f"the case does not say {_spelled(key)}" for name, key in _unnamed(scene, plan).items()}
    return {name: why or unnamed[name] for name, why in _reasons(scene, plan).items()}


def dropped_lines(scene, plan: Plan, width: int) -> Iterator[str]:
    """What was left out or switched off, and why."""
    if refused := {name: why for name, why in _reasons(scene, plan).items() if why}:
        yield "Not simulated: left out or switched off"
        for name, why in refused.items():
            yield f"  {name:<{width}}{why}"


def absent_lines(scene, plan: Plan) -> Iterator[str]:
    """The keys that would bring the other effects."""
    if not plan.materials.flows:
        yield "Not simulated: what acts between fluids"
    if tables := _by_table(_unnamed(scene, plan).values()):
        yield "Not simulated: the case does not name these keys (docs/case.md)"
        for table, keys in tables.items():
            before = f"  {table:<10}"
            yield from textwrap.wrap(
                ", ".join(keys), WIDTH, initial_indent=before, subsequent_indent=" " * len(before)
            )


def _reasons(scene, plan: Plan) -> dict[str, str]:
    """Of each absent effect why the scene or the case does without it; empty where no key asks for it."""
    return {
        entry.effect.__name__: plan.dropped.get(entry.effect.__name__) or _switched_off(scene.case, entry.key)
        for entry in plan.absent
        if acts_in(scene.case, entry.effect)
    }


def _unnamed(scene, plan: Plan) -> dict[str, str]:
    """The key of the catalogue for each effect that nothing asks for."""
    keys = {entry.effect.__name__: entry.key for entry in plan.absent}
    return {name: keys[name] for name, why in _reasons(scene, plan).items() if not why}


def _switched_off(case, key: str) -> str:
    by, value = case.presets.get(key, (None, OFF))
    return "" if value == OFF else f"switched off: {by} has {key}, and the case takes it out"


def _spelled(key: str) -> str:
    """A key of the catalogue as a case spells it."""
    name, _, choice = key.partition("=")
    return f'{name} = "{choice}"' if choice else name


def _by_table(keys: Iterable[str]) -> dict[str, list[str]]:
    """Keys of the catalogue by their table of the case; choices of one key stand together."""
    found: dict[str, dict[str, list[str]]] = {}
    for alternative in (one for key in keys for one in key.split("|")):
        path, _, choice = alternative.partition("=")
        table, _, name = path.partition(".")
        choices = found.setdefault(table, {}).setdefault(name.removeprefix("*").removeprefix("."), [])
        if choice and choice not in choices:
            choices.append(choice)
    return {
        table: [_with_choices(name or f"[{table}.NAME]", choices) for name, choices in names.items()]
        for table, names in found.items()
    }


def _with_choices(name: str, choices: list[str]) -> str:
    return f"{name} = {' or '.join(choices)}" if choices else name
